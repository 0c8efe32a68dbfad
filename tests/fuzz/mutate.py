# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Mutates cases. The only varying argument of a mutator is a random.Random, so that a case follows from
(kind, seed, number)."""
from __future__ import annotations

import copy
import json
import random
import re
import struct
from collections.abc import Callable

from case import OUTSIDE, Case, Entry, Raw, sign_manifest

NUMBERS = [
    "0",
    "-0.0",
    "-1",
    "1",
    "2",
    "127",
    "255",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "99999999999999999999999999999999999999999",
    "1e300",
    "-1e300",
    "1e308",
    "1e-300",
    "5e-324",
    "1e400",
    "-1e400",
    "1e38",
    "1e39",
    "1e10",
    "1e-10",
    "0.5",
    "1.5",
    "3.0000001",
    "nan",
    "inf",
    "-inf",
    ".nan",
    ".inf",
    "-.inf",
    "NaN",
    "Infinity",
    "1/0",
    "0/1",
    "1/9223372036854775807",
    "9223372036854775807/1",
    "0x7fffffff",
    "0o17",
    "1_000",
    "1,5",
    "1e",
    "+1",
    "--1",
    "1e99999999999",
    "",
    "٣",
]
TEXTS = [
    "",
    " ",
    ".",
    "..",
    "-",
    "\x1b[31mred\x1b[0m",
    "\x07",
    "a\x00b",
    "a\nb",
    "a\rb",
    "\u009b31m",
    "\udcff\udcfe",
    "\udcc3",
    "\u202etxt.exe",
    "\ufeff",
    "%s%n%x",
    "{}",
    "{:1000000000}",
    "x" * 300,
    "y" * 100000,
    "../" * 8 + "etc/passwd",
    "../outside/secret.txt",
    f"{OUTSIDE}/secret.txt",
    "/dev/zero",
    "/dev/stdin",
    "/proc/self/mem",
    "file:///etc/passwd",
    "CON",
    "~root",
    "$HOME",
    "$(id)",
    "a/b",
    "a\\b",
    "index.npy",
    "manifest.json",
    "static",
    "poses",
    "null",
    "true",
    "ÿ",
    "𝄞",
]
NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")


def scalar(rng: random.Random, old: object) -> object:
    roll = rng.random()
    if isinstance(old, str) and roll < 0.6:
        return rng.choice(TEXTS)
    if isinstance(old, int | float) and roll < 0.7:
        return Raw(rng.choice([n for n in NUMBERS if n]))
    if roll < 0.8:
        return rng.choice(
            [
                Raw(rng.choice(NUMBERS) or "null"),
                None,
                True,
                False,
                [],
                {},
                0,
                -1,
                1.5,
                2**32 - 1,
                2**63 - 1,
            ]
        )
    if roll < 0.95:
        return rng.choice(TEXTS)
    return nest(rng)


def nest(rng: random.Random) -> Raw:
    depth = rng.choice([20, 100, 1000, 20000, 100000])
    begin, end = rng.choice([("[", "]"), ('{"a":', "}"), ("[[],", "]"), ("[", ""), ('{"a":[', "]}")])
    return Raw(begin * depth + "1" + end * depth if end else begin * depth)


def places(tree: object) -> list[tuple]:
    """Returns every (container, key) below the tree."""
    found = []
    for key, value in (
        tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    ):
        found.append((tree, key))
        found += places(value)
    return found


def tree(rng: random.Random, entry: Entry) -> str:
    """Makes one change to the values of a JSON or YAML file. The rest of the file stays well-formed."""
    entry.tree = copy.deepcopy(entry.tree)
    found = places(entry.tree)
    if not found:
        entry.tree = nest(rng)
        return "nested"
    container, key = rng.choice(found)
    roll = rng.random()
    if roll < 0.55:
        old, container[key] = container[key], scalar(rng, container[key])
        return f"{key}: {str(old)[:40]} -> {str(container[key])[:40]!r}"
    if roll < 0.68:
        del container[key]
        return f"{key} deleted"
    if roll < 0.78:
        other, other_key = rng.choice(found)
        container[key] = copy.deepcopy(other[other_key])
        return f"{key} copied from {other_key}"
    if roll < 0.86 and isinstance(container, list):
        times = rng.choice([1, 2, 100, 5000])
        container[key:key] = [copy.deepcopy(container[key]) for _ in range(times)]
        return f"element {key} {times} times more"
    if roll < 0.93 and isinstance(container, dict):
        name = rng.choice(TEXTS)
        container[name] = container.pop(key)
        return f"{key} renamed to {name[:40]!r}"
    container[key] = nest(rng)
    return f"{key} nested"


def number(rng: random.Random, entry: Entry) -> str:
    """Changes a number in a text, or in the text that heads a binary file."""
    entry.flatten()
    found = list(NUMBER.finditer(entry.data, 0, 4000 if b"\0" in entry.data else len(entry.data)))
    if not found:
        return flip(rng, entry)
    match = rng.choice(found)
    new = rng.choice(NUMBERS).encode()
    if b"\0" in entry.data and len(new) < len(match[0]) and rng.random() < 0.5:
        new = new.rjust(len(match[0]))  # keeps the offset of the data behind the number
    entry.data = entry.data[: match.start()] + new + entry.data[match.end() :]
    return f"{match[0].decode()} -> {new.decode()} at byte {match.start()}"


def line(rng: random.Random, entry: Entry) -> str:
    """Deletes, repeats, moves or joins lines. For YAML it also adds anchors, aliases and tags."""
    entry.flatten()
    lines = entry.data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    roll = rng.randrange(11)
    if roll == 0:
        del lines[i]
    elif roll == 1:
        lines[i:i] = [lines[i]] * rng.choice([1, 1, 2, 1000])
    elif roll == 2:
        lines[i], lines[j] = lines[j], lines[i]
    elif roll == 3:
        lines[i] = rng.choice([b"  ", b"\t", b"\xef\xbb\xbf", b"\x00", b"- ", b"#", b"<!--"]) + lines[i]
    elif roll == 4:
        lines[i] += rng.choice([b"\r", b" ", b",", b",,,,", b"\x1b[2J", b"\xff", b":", b" # x", b"\\"])
    elif roll == 5:
        lines[i] = lines[i].replace(b": ", b": &a ", 1)
        lines[j] = re.sub(rb": .*", b": *a", lines[j], count=1)
    elif roll == 6:
        lines[i] = re.sub(rb": (.*)", rb": &b [*b, \1]", lines[i], count=1)
    elif roll == 7:
        lines[i] = re.sub(
            rb": ",
            rng.choice([b": !!binary ", b": !x ", b": | ", b": > ", b": ? ", b": - ", b":"]),
            lines[i],
            count=1,
        )
    elif roll == 8:
        lines[i : i + 1] = [lines[i][:k] for k in (rng.randrange(len(lines[i]) + 1),)]
    elif roll == 9:
        lines[i] = lines[i] * rng.choice([2, 100, 10000])
    else:
        lines.insert(
            i,
            rng.choice([b"---", b"...", b"<<: *a", b"%YAML 9.9", b"? x", b"end_header", b"]]>", b"</scene>"]),
        )
    entry.data = b"\n".join(lines)
    return f"lines, {roll}, at {i} and {j}"


def quoted(rng: random.Random, entry: Entry) -> str:
    """Replaces a text between quotes (XML, JSON) by another."""
    entry.flatten()
    found = list(re.finditer(rb'"([^"\n]*)"', entry.data))
    if not found:
        return number(rng, entry)
    match = rng.choice(found)
    new = rng.choice(TEXTS + NUMBERS).encode("utf-8", "surrogateescape")
    entry.data = entry.data[: match.start(1)] + new + entry.data[match.end(1) :]
    return f"{match[1][:40]!r} -> {new[:40]!r}"


def element(rng: random.Random, entry: Entry) -> str:
    """Deletes, repeats or nests elements of XML, and adds entities."""
    entry.flatten()
    found = list(re.finditer(rb"<(\w+)[^<>]*/>|<(\w+)[^<>]*>[^<>]*</\2>", entry.data))
    if not found:
        return line(rng, entry)
    match, other = rng.choice(found), rng.choice(found)
    depth = rng.choice([1, 10, 1000, 20000])
    name, wrap = rng.choice(
        [
            ("deleted", b""),
            ("repeated", match[0] * rng.choice([2, 50])),
            ("replaced", other[0]),
            ("in merge", b'<shape type="merge">' * depth + match[0] + b"</shape>" * depth),
            ("in bsdf", b'<bsdf type="twosided">' * depth + match[0] + b"</bsdf>" * depth),
            ("in transform", b'<transform name="to_world">' * depth + match[0] + b"</transform>" * depth),
            ("unclosed", b"<shape>" * depth + match[0]),
            ("include", b'<include filename="scene.xml"/>'),
            ("entity", b"&lol;" * 3 + match[0]),
        ]
    )
    entry.data = entry.data[: match.start()] + wrap + entry.data[match.end() :]
    if rng.random() < 0.1:
        entry.data = (
            b'<!DOCTYPE x [<!ENTITY a "aaaaaaaa"><!ENTITY lol "&a;&a;&a;&a;">'
            b'<!ENTITY s SYSTEM "../outside/secret.txt">]>' + entry.data
        )
    return f"{match[0][:40]!r} {name} {depth}"


def position(rng: random.Random, size: int) -> int:
    """Returns a position. Half of them lie within the head, where formats keep the data that steers their
    reader."""
    return rng.randrange(min(size, 300)) if rng.random() < 0.5 else rng.randrange(size)


def flip(rng: random.Random, entry: Entry) -> str:
    entry.flatten()
    if not entry.data:
        entry.data = rng.randbytes(rng.choice([1, 4, 100]))
        return "filled"
    data = bytearray(entry.data)
    at = []
    for _ in range(rng.choice([1, 1, 1, 2, 4, 16])):
        at.append(position(rng, len(data)))
        data[at[-1]] = rng.choice(
            [data[at[-1]] ^ 1 << rng.randrange(8), rng.randrange(256), 0, 255, 127, 128]
        )
    entry.data = bytes(data)
    return f"bytes {at} changed"


def word(rng: random.Random, entry: Entry) -> str:
    """Overwrites a whole binary number by an extreme one."""
    entry.flatten()
    width = rng.choice([2, 4, 4, 8])
    if len(entry.data) < width:
        return flip(rng, entry)
    at = min(position(rng, len(entry.data)), len(entry.data) - width)
    value = rng.choice(
        [
            0,
            1,
            2 ** (8 * width) - 1,
            2 ** (8 * width - 1),
            2 ** (8 * width - 1) - 1,
            2 ** (4 * width),
            0x7F800000,
            0x7FC00000,
        ]
    )
    new = (value % 2 ** (8 * width)).to_bytes(width, rng.choice(["little", "big"]))
    if rng.random() < 0.2:
        new = struct.pack("<f", rng.choice([1e38, -1e38, 1e-45, float("nan"), float("inf")]))
    entry.data = entry.data[:at] + new + entry.data[at + len(new) :]
    return f"{new.hex()} at byte {at}"


def cut(rng: random.Random, entry: Entry) -> str:
    entry.flatten()
    size = len(entry.data)
    begin, end = sorted((position(rng, size + 1), position(rng, size + 1)))
    roll = rng.randrange(5)
    if roll == 0:
        entry.data = entry.data[:begin]
    elif roll == 1:
        entry.data = entry.data[:begin] + entry.data[end:]
    elif roll == 2:
        entry.data = entry.data[:begin] + entry.data[begin:end] * rng.choice([2, 3, 100]) + entry.data[end:]
    elif roll == 3:
        entry.data += rng.choice([b"\0", b"\n", b"x", rng.randbytes(100), entry.data])
    else:
        entry.data = entry.data[: rng.choice([0, 1, 4, size // 2, max(size - 1, 0)])]
    return f"cut {roll} at {begin} and {end} of {size} bytes"


def splice(rng: random.Random, entry: Entry, other: Entry) -> str:
    entry.flatten()
    content = other.content() if other.type == "file" else b""
    begin, end = position(rng, len(entry.data) + 1), position(rng, len(content) + 1)
    entry.data = entry.data[:begin] + content[end:]
    return f"spliced at {begin} with another from {end}"


def place(rng: random.Random, case: Case, name: str) -> str:
    """Puts something else in the place of a file."""
    roll = rng.randrange(10)
    if roll == 0:
        del case.files[name]
        return "deleted"
    new = [
        Entry("folder"),
        Entry("fifo"),
        Entry("link", b"../outside/secret.txt"),
        Entry("link", f"{OUTSIDE}/secret.txt".encode()),
        Entry("link", name.split("/")[-1].encode()),
        Entry("link", b"/dev/zero"),
        Entry("sparse", str(10 ** rng.choice([6, 9, 11])).encode()),
        Entry(data=b""),
        Entry("link", b"nowhere"),
    ][roll - 1]
    case.files[name] = new
    return f"is a {new.type} {new.data.decode()}"


def weight(kind: str, name: str) -> float:
    """Returns how often a file is chosen. Files that steer the readers are chosen more often than bulk
    data."""
    base = name.rsplit("/", 1)[-1]
    suffix = base.rsplit(".", 1)[-1]
    by_kind = {
        "picture": {"png": 1.0, "jpg": 1.0},
        "ply": {"ply": 1.0},
        "mitsuba": {"xml": 1.0, "ply": 0.05},
        "csv": {"csv": 1.0, "yaml": 0.02},
        "scenario": {"yaml": 1.0},
        "gltf": {"gltf": 1.0, "glb": 1.0, "bin": 0.2, "yaml": 0.3, "png": 0.05, "jpg": 0.05},
    }
    if kind in by_kind:
        return by_kind[kind].get(suffix, 0.0)
    if base in (
        "dataset.json",
        "manifest.json",
        "journal.txt",
        "index.npy",
        "index.csv",
        "consistency.csv",
        "scenario.yaml",
    ):
        return {"dataset.json": 12.0, "journal.txt": 20.0}.get(base, 5.0)
    return 0.6 if name.startswith("data/") else 0.0


def text_mutators(name: str, entry: Entry) -> list[Callable]:
    if name.endswith(".xml"):
        return [element, element, quoted, quoted, number, line, flip, cut]
    if entry.pack:
        return [tree] * 6 + [number, line, quoted, flip, cut] + ([word] * 3 if entry.pack == "glb" else [])
    if name.endswith((".csv", ".txt", ".yaml", ".json")):
        return [number] * 4 + [line] * 4 + [quoted, flip, cut]
    if name.endswith((".ply", ".pcd", ".npy")):
        return [number] * 4 + [line] * 2 + [flip] * 2 + [word] * 3 + [cut] * 2
    return [flip] * 4 + [word] * 4 + [cut] * 2 + [number]


def parse(name: str, entry: Entry) -> None:
    """Parses sound JSON and sound journals, so that they are changed as trees."""
    try:
        if name.endswith(".json"):
            entry.tree, entry.pack = json.loads(entry.data), "json"
        elif name.endswith("journal.txt"):
            entry.tree = [json.loads(text.rsplit(b"\t", 1)[0]) for text in entry.data.splitlines()]
            entry.pack = "journal"
    except (ValueError, RecursionError):
        entry.tree, entry.pack = None, ""


def mutate(kind: str, seed: int, index: int, seeds: list[Case]) -> Case:
    """Returns case `index` of `seed`: a seed file with one to three changes."""
    rng = random.Random(f"{kind}/{seed}/{index}")
    case = rng.choice(seeds).copy()
    case.name = f"{kind}-{seed}-{index}"
    names = [name for name in case.files if weight(kind, name) > 0]
    weights = [weight(kind, name) for name in names]
    for _ in range(rng.choice([1, 1, 1, 2, 2, 3])):
        name = rng.choices(names, weights)[0]
        entry = case.files.get(name)
        if entry is None or entry.type != "file":
            continue
        roll = rng.random()
        if roll < 0.05:
            case.done.append(f"{name}: {place(rng, case, name)}")
        elif roll < 0.12:
            other = case.files[rng.choice([n for n in names if n in case.files])]
            case.done.append(f"{name}: {splice(rng, entry, other)}")
        else:
            if not entry.pack and rng.random() < 0.7:
                parse(name, entry)
            case.done.append(f"{name}: {rng.choice(text_mutators(name, entry))(rng, entry)}")
    if kind in ("dataset", "python") and rng.random() < 0.7 and sign_manifest(case, "data"):
        case.done.append("manifest signed anew")
    if case.command[0] in ("explain", "paths", "generate") or "--radio-materials" in case.command:
        case.secret = False  # a scenario may name any file of the user who runs it
    return case
