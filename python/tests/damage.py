# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Damages a data set by random changes. Each kind of change is a function (folder, random.Random) -> str,
which returns a description of the change. The module serves the tests here and can try any program on many
damaged data sets.
"""
import json
import os
import pathlib
import random
import struct
import zlib

#: Values that may replace the value of a field.
EXTREMES = (
    0,
    -1,
    1,
    2**31,
    2**32 - 1,
    2**53,
    2**63 - 1,
    2**64,
    1e300,
    -1e300,
    0.5,
    True,
    None,
    "",
    "x",
    "/etc/passwd",
    "../../x",
    "9223372036854775807",
    "1/9223372036854775807",
    "1e999999999",
    "\x1b[31m",
    "a" * 5000,
    [],
    {},
    [[]],
    [-1],
    [2**40, 2**40],
)


def files_of(folder: pathlib.Path) -> list:
    """Returns the plain files that are small enough to be read as a whole."""
    return sorted(
        p for p in folder.rglob("*") if not p.is_symlink() and p.is_file() and p.stat().st_size < 1 << 26
    )


def pick(folder: pathlib.Path, rng: random.Random) -> pathlib.Path:
    """Picks a file. In half of the cases, picks one of the files that describe the others."""
    files = files_of(folder)
    small = [
        p
        for p in files
        if p.name in ("dataset.json", "manifest.json", "journal.txt", "index.npy", "index.csv")
    ]
    return rng.choice(small if small and rng.random() < 0.5 else files)


def flip_bytes(folder: pathlib.Path, rng: random.Random) -> str:
    path = pick(folder, rng)
    data = bytearray(path.read_bytes())
    # Small offsets are preferred, because headers hold the sizes.
    places = (
        [
            rng.randrange(min(len(data), rng.choice((64, 400, 1 << 30))))
            for _ in range(rng.choice((1, 1, 3, 20)))
        ]
        if data
        else []
    )
    for at in places:
        data[at] = rng.choice((data[at] ^ (1 << rng.randrange(8)), 0, 255, 127, 10, 45, 57))
    path.write_bytes(data)
    return f"bytes {places} of {path.name}"


def write_numbers(folder: pathlib.Path, rng: random.Random) -> str:
    """Writes an extreme number at a place where a binary file may hold a number."""
    path = pick(folder, rng)
    data = bytearray(path.read_bytes())
    form, value = rng.choice(
        (
            ("<q", 2**63 - 1),
            ("<q", -1),
            ("<q", 2**40),
            ("<i", -1),
            ("<i", 2**31 - 1),
            ("<I", 2**32 - 1),
            ("<d", float("inf")),
            ("<d", 1e300),
            ("<f", float("nan")),
            ("<f", 3e38),
            (">I", 2**31 - 1),
        )
    )
    size = struct.calcsize(form)
    if len(data) < size:
        return "nothing"
    at = rng.randrange(0, len(data) - size + 1, 4)
    data[at : at + size] = struct.pack(form, value)
    path.write_bytes(data)
    return f"{form} {value} at byte {at} of {path.name}"


def truncate(folder: pathlib.Path, rng: random.Random) -> str:
    path = pick(folder, rng)
    size = rng.randrange(path.stat().st_size + 1)
    os.truncate(path, size)
    return f"{path.name} cut to {size} bytes"


def delete(folder: pathlib.Path, rng: random.Random) -> str:
    path = pick(folder, rng)
    path.unlink()
    return f"{path.name} deleted"


def swap(folder: pathlib.Path, rng: random.Random) -> str:
    """Replaces a file by another kind of file, or by a copy of another file of the data set."""
    path = pick(folder, rng)
    kind = rng.choice(
        ("folder", "fifo", "link", "link to a device", "link to itself", "sparse", "empty", "other")
    )
    other = rng.choice(files_of(folder)).read_bytes()
    path.unlink()
    if kind == "folder":
        path.mkdir()
    elif kind == "fifo":
        os.mkfifo(path)
    elif kind.startswith("link"):
        path.symlink_to(
            {"link": "/etc/hostname", "link to a device": "/dev/zero", "link to itself": path.name}[kind]
        )
    else:
        path.write_bytes(other if kind == "other" else b"")
        if kind == "sparse":
            os.truncate(path, 100 << 30)
    return f"{path.name}: {kind}"


def _places(tree, place=()):
    yield place
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield from _places(value, (*place, key))


def change_json(folder: pathlib.Path, rng: random.Random) -> str:
    """Changes a value in dataset.json, in manifest.json or in a line of the journal, whose checksum is
    updated.
    """
    names = [
        n
        for n in ("dataset.json", "dataset.json", "manifest.json", "journal.txt")
        if folder / n in files_of(folder)
    ]
    if not names:
        return "nothing"
    path = folder / rng.choice(names)
    text = path.read_text("utf-8", "replace")
    lines = text.splitlines()
    row = rng.randrange(len(lines)) if path.name == "journal.txt" and lines else None
    try:
        tree = json.loads(text if row is None else lines[row].rsplit("\t", 1)[0])
    except (ValueError, IndexError, RecursionError):
        return "nothing"
    *way, last = [None, *rng.choice(list(_places(tree)) or [()])]
    holder, value = {None: tree}, rng.choice(EXTREMES)
    whole = holder
    for key in way:
        holder = holder[key]
    if rng.random() < 0.2 and last is not None:
        del holder[last]
        value = "nothing"
    else:
        holder[last] = value
    done = json.dumps(whole[None])
    if rng.random() < 0.05:
        done = rng.choice(("[", '{"a":')) * 100_000
    if row is None:
        path.write_text(done)
    else:
        lines[row] = f"{done}\t{zlib.crc32(done.encode()):08x}"
        path.write_text("\n".join(lines) + "\n")
    return f"{path.name}: {[*way[1:], last]} = {str(value)[:40]!r}"


MUTATORS = (
    flip_bytes,
    flip_bytes,
    write_numbers,
    truncate,
    delete,
    swap,
    change_json,
    change_json,
    change_json,
)


def sign(folder: pathlib.Path) -> None:
    """Updates the sizes and hashes in the manifest, so that a program gets beyond their check."""
    import hashlib

    path = folder / "manifest.json"
    if not path.is_file() or path.stat().st_size > 1 << 26:  # a FIFO, a link to a device, a sparse file
        return
    try:
        manifest = json.loads(path.read_text())
        for file in manifest["files"]:
            target = folder / file["path"]
            if (
                folder in target.parents
                and target.is_file()
                and not target.is_symlink()
                and target.stat().st_size < 1 << 24
            ):
                data = target.read_bytes()
                file["size"], file["sha256"] = len(data), hashlib.sha256(data).hexdigest()
        path.write_text(json.dumps(manifest))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        pass


def damage(folder: pathlib.Path, seed: int) -> str:
    """Makes one change, in a quarter of the cases three. In half of the cases, updates the manifest. Returns
    a description.
    """
    rng = random.Random(seed)
    done = []
    for _ in range(rng.choice((1, 1, 1, 3))):
        if files_of(folder):
            done.append(rng.choice(MUTATORS)(folder, rng))
    if rng.random() < 0.5:
        sign(folder)
        done.append("signed")
    return "; ".join(done)
