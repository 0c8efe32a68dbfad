# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Makes named attacks from the seeds, so that they follow the formats. Somebody has thought of each of these
inputs, and each was once a fault or a near miss. `exit` holds the exit codes that the program may end
with."""
from __future__ import annotations

import copy
import json
import struct
from collections.abc import Callable, Iterator

from case import OUTSIDE, Case, Entry, Raw, sign_manifest
import pictures

DEEP = 100000


def set_at(tree: object, path: str, value: object) -> None:
    *way, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in way:
        tree = tree[key]
    tree[last] = value


def changed(base: Case, name: str, exits: list[int], file: str, **values: object) -> Case:
    """Returns a copy of the base with other values at paths such as nodes__0__name."""
    case = base.copy()
    entry = case.files[file]
    entry.tree = copy.deepcopy(entry.tree)
    for path, value in values.items():
        set_at(entry.tree, path.replace("__", "."), value)
    case.name, case.exit, case.done = name, exits, [f"{file}: {values}"[:200]]
    return case


def replaced(base: Case, name: str, exits: list[int], files: dict[str, Entry]) -> Case:
    case = base.copy()
    case.files.update(files)
    case.name, case.exit, case.done = name, exits, [f"{file}: {entry.type}" for file, entry in files.items()]
    return case


def places_of(base: Case, name: str, files: list[str]) -> Iterator[Case]:
    """Puts something else in the place of each of these files."""
    for file in files:
        short = file.rsplit("/", 1)[-1]
        for other, entry in {
            "a folder": Entry("folder"),
            "a fifo": Entry("fifo"),
            "endless": Entry("link", b"/dev/zero"),
            "100 GiB": Entry("sparse", str(100 << 30).encode()),
            "a link to itself": Entry("link", short.encode()),
            "empty": Entry(),
        }.items():
            # A run that was killed before its first line leaves an empty journal, which --resume accepts.
            may_go_on = (short, other) == ("journal.txt", "empty")
            yield replaced(base, f"{name}: {short} is {other}", [0, 1] if may_go_on else [1], {file: entry})


def scenario(bases: list[Case]) -> Iterator[Case]:
    data, moves, empty, paths, radio, _ = bases
    laughs = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
        f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 9)
    )
    within = (
        "greatx: 1\nname: x\nticks: 1\ntick_rate_hz: 10\nnodes:\n- &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
        + "".join(f"- &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 9))
    )
    yield replaced(
        empty, "aliases of aliases among the nodes", [1], {"empty.yaml": Entry(data=within.encode())}
    )
    for base, file in ((empty, "empty.yaml"), (radio, "radio.yaml")):
        yield replaced(base, f"aliases of aliases in {file}", [1], {file: Entry(data=laughs.encode())})
        yield replaced(
            base,
            f"an alias of itself in {file}",
            [1],
            {file: Entry(data=b"materials: &a [*a]\ngreatx: *a\n")},
        )
        for begin in ("[", "{a: ", "- ", "? ", "&a [", "!x ["):
            yield replaced(
                base, f"{file} nested by '{begin}'", [1], {file: Entry(data=begin.encode() * DEEP)}
            )
        yield replaced(base, f"{file} is one long line", [1], {file: Entry(data=b"x" * (32 << 20))})
        yield from places_of(base, "scenario", [file])
    for carrier in ("1e-300", "5e-324", "1e300", "1"):
        yield changed(
            paths, f"carrier_hz {carrier}", [0, 1], "empty.yaml", channels__0__carrier_hz=Raw(carrier)
        )
    for position in ("1e300", "1e38", "1e154", "-1e308"):
        yield changed(
            paths,
            f"position {position}",
            [0, 1],
            "empty.yaml",
            nodes__0__trajectory__position_m=[Raw(position), 0, 0],
        )
    yield changed(paths, "depth 16", [0, 1], "empty.yaml", channels__0__max_depth=16)
    for tick_rate in (
        "9223372036854775807",
        "1/9223372036854775807",
        "9223372036854775807/9223372036854775806",
        "1e18",
    ):
        yield changed(moves, f"tick rate {tick_rate}", [0, 1], "moves.yaml", tick_rate_hz=tick_rate)
    yield changed(empty, "a name of control characters", [1], "empty.yaml", nodes__0__name="\x1b[31mred")
    yield changed(empty, "a name that is no UTF-8", [1], "empty.yaml", nodes__0__name=Raw('"\udcff\udcfe"'))
    yield changed(empty, "a name that leads outside", [1], "empty.yaml", nodes__0__name="../outside")
    short = changed(
        empty,
        "a node called index.npy",
        [0, 1],
        "empty.yaml",
        nodes__0__name="index.npy",
        channels__0__tx="index.npy/x",
    )
    short.command = ["generate", "empty.yaml", "-o", "out/data", "-q"]
    yield short
    near = changed(
        empty,
        "two arrays of 64 x 64 in their near field",
        [0, 1],
        "empty.yaml",
        nodes__0__sensors__0={"name": "x", "type": "antenna", "rows": 64, "columns": 64},
        nodes__1__sensors__0={"name": "x", "type": "antenna", "rows": 64, "columns": 64},
    )
    near.command = ["generate", "empty.yaml", "-o", "out/data", "-q", "--ticks", "1"]
    yield near


def gltf(bases: list[Case]) -> Iterator[Case]:
    textured, glb = bases[0], bases[1]
    sparse = [
        {
            "componentType": 5126,
            "count": 60_000_000,
            "type": "VEC4",
            "sparse": {
                "count": 1,
                "indices": {"bufferView": 0, "componentType": 5125},
                "values": {"bufferView": 0},
            },
        }
        for _ in range(6)
    ]
    many = {"name": "x", "primitives": [{"attributes": {"POSITION": 0, "TANGENT": i}} for i in range(6)]}
    yield changed(
        textured, "sparse accessors of nothing", [1], "scene.gltf", accessors=sparse, meshes=[many, many]
    )
    for count in (2**31, 2**32 - 1, 2**63):
        yield changed(textured, f"accessor of {count}", [1], "scene.gltf", accessors__0__count=count)
    yield changed(textured, "a node is its own child", [1], "scene.gltf", nodes__1__children=[0])
    chain = [{"children": [i + 1]} for i in range(DEEP)] + [{"mesh": 0}]
    yield changed(textured, "a chain of nodes", [0, 1], "scene.gltf", nodes=chain, scenes=[{"nodes": [0]}])
    yield changed(textured, "nested JSON", [1], "scene.gltf", extras=Raw("[" * DEEP + "]" * DEEP))
    for uri in (
        "../outside/secret.bin",
        f"{OUTSIDE}/secret.bin",
        f"file://{OUTSIDE}/secret.bin",
        "%2e%2e/outside/secret.bin",
        "..\\outside\\secret.bin",
        "/dev/zero",
    ):
        yield changed(textured, f"buffer {uri}", [1], "scene.gltf", buffers__0__uri=uri)
    for uri in ("../outside/secret.png", f"{OUTSIDE}/secret.png"):
        yield changed(textured, f"image {uri}", [1], "scene.gltf", images__0__uri=uri)
    yield replaced(
        textured, "a buffer that is a link", [1], {"scene.bin": Entry("link", b"../outside/secret.bin")}
    )
    for name in ("\x1b[31mred", "a\nb", Raw('"\udcff\udcfe"')):
        case = changed(
            textured,
            f"names {name!r}",
            [0, 1],
            "scene.gltf",
            materials__1__name=name,
            nodes__0__name=name,
            meshes__0__name=name,
        )
        yield case
    fan = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)] + [(1.0 + i, 0.0, 1e-3 * i) for i in range(60000)]
    data = struct.pack(f"<{3 * len(fan)}f", *(x for point in fan for x in point))
    corners = struct.pack(f"<{3 * (len(fan) - 2)}I", *(x for i in range(2, len(fan)) for x in (0, 1, i)))
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"name": "itu_metal"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(fan), "type": "VEC3"},
            {"bufferView": 1, "componentType": 5125, "count": len(corners) // 4, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(data)},
            {"buffer": 0, "byteOffset": len(data), "byteLength": len(corners)},
        ],
        "buffers": [{"byteLength": len(data) + len(corners)}],
    }
    yield replaced(
        glb,
        "60,000 triangles on one edge",
        [0, 1],
        {"scene.glb": Entry(data=data + corners, tree=tree, pack="glb")},
    )
    one = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    nodes = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(60000))}],
        "nodes": [{"mesh": 0, "translation": [2 * i, 0, 0]} for i in range(60000)],
        "materials": [{"name": "itu_metal"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36}],
    }
    yield replaced(glb, "60,000 nodes", [0, 1], {"scene.glb": Entry(data=one, tree=nodes, pack="glb")})
    yield from places_of(textured, "gltf", ["scene.gltf", "scene.bin", "color.png"])


def picture(bases: list[Case]) -> Iterator[Case]:
    jpeg = pictures.jpeg(2, 2)
    at = jpeg.index(b"\xff\xc4") + 5
    for counts in (b"\xff" * 16, b"\0" * 15 + b"\xff", b"\1" * 16, b"\2" * 16):
        for base in (bases[4], bases[6]):
            progressive = base is bases[6]
            data = pictures.jpeg(2, 1, progressive=True) if progressive else jpeg
            damaged = data[:at] + counts + data[at + 16 :]
            yield replaced(
                base,
                f"Huffman lengths {counts.hex()}{' progressive' if progressive else ''}",
                [0, 1],
                {"a.jpg": Entry(data=damaged)},
            )
    bomb = Entry(data=pictures.png_bomb(16384))
    tree = copy.deepcopy(bases[0].files["scene.gltf"].tree)
    tree["images"] = [{"uri": "a.png"}, {"uri": "b.png"}]
    tree["textures"] = [{"source": 0}, {"source": 1}]
    tree["materials"][0]["normalTexture"] = {"index": 1}
    yield replaced(
        bases[0],
        "two pictures of 16384 x 16384",
        [0, 1],
        {"scene.gltf": Entry(tree=tree, pack="json"), "a.png": bomb, "b.png": bomb},
    )
    for width, height in ((0, 1), (1, 0), (2**31 - 1, 1), (2**31, 2**31), (16385, 1)):
        data = pictures.png(3, 3)
        yield replaced(
            bases[0],
            f"PNG that says {width} x {height}",
            [1],
            {
                "a.png": Entry(
                    data=data[:8]
                    + pictures.png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                    + data[33:]
                )
            },
        )
    yield from places_of(bases[0], "picture", ["a.png"])


def mitsuba(bases: list[Case]) -> Iterator[Case]:
    base = bases[0]
    shape = (
        '<shape type="ply" id="mesh-x"><string name="filename" value="meshes/wall.ply"/>'
        '<bsdf type="diffuse" id="{}"/></shape>'
    )

    def xml(name: str, exits: list[int], text: str, encoding: str = "utf-8") -> Case:
        return replaced(
            base, name, exits, {"scene.xml": Entry(data=text.encode(encoding, "surrogateescape"))}
        )

    def scene(body: str) -> str:
        return f'<scene version="2.1.0">{body}</scene>'

    inner = shape.format("mat-itu_wood")
    for tag in ('shape type="merge"', 'bsdf type="twosided"', 'transform name="to_world"', "scene", "x"):
        end = f"</{tag.split()[0]}>"
        yield xml(f"nested {tag}", [0, 1], scene(f"<{tag}>" * 20000 + inner + end * 20000))
        yield xml(f"unclosed {tag}", [1], scene(f"<{tag}>" * DEEP))
    for uri in (
        "../outside/secret.ply",
        f"{OUTSIDE}/secret.ply",
        "meshes/../../outside/secret.ply",
        "/dev/zero",
        "",
    ):
        yield xml(f"mesh {uri}", [1], scene(inner.replace("meshes/wall.ply", uri)))
    yield replaced(
        base, "a mesh that is a link", [1], {"meshes/wall.ply": Entry("link", b"../../outside/secret.ply")}
    )
    yield xml(
        "an id that is no UTF-8",
        [0, 1],
        scene(shape.format("mat-itu_wood\udcff\udcfe").replace("mesh-x", "mesh-\udcff")),
    )
    yield xml(
        "control characters in names",
        [0, 1],
        scene(shape.format("mat-itu_wood").replace("mesh-x", "mesh-&#27;[31m&#7;")),
    )
    yield xml("a material of control characters", [1], scene(shape.format("&#27;[31m")))
    yield xml(
        "entities",
        [0, 1],
        '<!DOCTYPE s [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
        + scene(shape.format("mat-itu_wood").replace("mesh-x", "mesh-&b;")),
    )
    yield xml("UTF-16", [0, 1], scene(inner), "utf-16")
    yield from places_of(base, "mitsuba", ["scene.xml", "meshes/wall.ply"])


def ply(bases: list[Case]) -> Iterator[Case]:
    text = bases[0].files["meshes/wall.ply"].data
    for count in (
        b"0",
        b"-1",
        b"4294967295",
        b"1000000000",
        b"9223372036854775807",
        b"18446744073709551616",
        b"1e9",
    ):
        for what in (b"vertex 4", b"face 2"):
            damaged = text.replace(b"element " + what, b"element " + what.split()[0] + b" " + count)
            yield replaced(
                bases[0],
                f"PLY {what.decode()} says {count.decode()}",
                [1],
                {"meshes/wall.ply": Entry(data=damaged)},
            )
    binary = bases[0].files["meshes/pane.ply"].data
    for count in (b"1000000000", b"4294967295"):
        damaged = binary.replace(b"element vertex 4", b"element vertex " + count)
        yield replaced(
            bases[0], f"binary PLY says {count.decode()}", [1], {"meshes/pane.ply": Entry(data=damaged)}
        )
    yield replaced(
        bases[0],
        "PLY of properties",
        [0, 1],
        {"meshes/wall.ply": Entry(data=text.replace(b"property float s\n", b"property float s\n" * 200000))},
    )


def csv(bases: list[Case]) -> Iterator[Case]:
    half = 15000
    lines = [f"{180 * i / half},0,1" for i in range(half + 1)] + [
        f"0,{360 * i / half},1" for i in range(half)
    ]
    yield replaced(
        bases[0],
        "a pattern of 30,001 lines and 225 million directions",
        [1],
        {"gain.csv": Entry(data=("theta_deg,phi_deg,gain_dbi\n" + "\n".join(lines) + "\n").encode())},
    )
    for file, base in (
        ("gain.csv", 0),
        ("field.csv", 1),
        ("flight.csv", 0),
        ("shots.csv", 0),
        ("points.csv", 2),
    ):
        text = bases[base].files[file].data
        for name, data in {
            "one long line": b"1," * (8 << 20),
            "line ends alone": b"\n" * (8 << 20),
            "NUL": text.replace(b",", b"\0", 3),
            "nan": text.replace(b"0", b"nan"),
            "1e300": text.replace(b"0", b"1e300"),
            "an escape": text + b"\x1b[2J,1,1\n",
            "no UTF-8": text + b"\xff\xfe,1\n",
        }.items():
            yield replaced(bases[base], f"{file}: {name}", [0, 1], {file: Entry(data=data)})
        yield from places_of(bases[base], "csv", [file])


def dataset(bases: list[Case]) -> Iterator[Case]:
    verify, inspect, resume = bases[0], bases[7], bases[-1]

    def signed(case: Case) -> Case:
        sign_manifest(case, "data")
        return case

    nested = Entry(data=b"[" * DEEP + b"]" * DEEP)
    metadata = ["data/dataset.json", "data/manifest.json", "data/sequence_0000/index.npy"]
    for base, word in ((verify, "verify"), (inspect, "inspect")):
        for file in ["data/dataset.json", "data/manifest.json"]:
            yield replaced(base, f"{word}: {file} nested", [0, 1], {file: nested})
        tree = json.loads(verify.files["data/dataset.json"].data)
        for key in sorted(tree):
            for value in (
                None,
                "",
                "9223372036854775807/1",
                2**63 - 1,
                -1,
                1e300,
                [],
                {},
                Raw("[" * DEEP + "]" * DEEP),
            ):
                made = {**tree, key: value}
                case = replaced(
                    base,
                    f"{word}: dataset.json {key} {value!r}",
                    [0, 1],
                    {"data/dataset.json": Entry(tree=made, pack="json")},
                )
                yield signed(case)
        yield from places_of(base, word, [*metadata, "data/sequence_0000/csi/cfr.npy"])
        if word == "verify":  # inspect reads only some of the pictures, for its sheet
            yield from places_of(base, word, ["data/sequence_0000/uav/cam/rgb/000000.png"])
        name = next(file for file in verify.files if file.endswith(".pcd"))
        cloud = verify.files[name].data
        for old, new in (
            (b"FIELDS x", b"FIELDS"),
            (b"FIELDS x y z", b"FIELDS x x x"),
            (b"SIZE 4", b"SIZE 0"),
            (b"COUNT 1", b"COUNT 0"),
            (b"\nFIELDS", b"\n#"),
            (b"POINTS ", b"POINTS 9"),
            (b"WIDTH ", b"WIDTH -"),
        ):
            yield signed(
                replaced(
                    base,
                    f"{word}: PCD {old!r} -> {new!r}",
                    [0, 1],
                    {name: Entry(data=cloud.replace(old, new, 1))},
                )
            )
    manifest = json.loads(verify.files["data/manifest.json"].data)
    for path in (f"{OUTSIDE}/secret.txt", "../../outside/secret.txt", "../data.yaml", "", ".", "/dev/zero"):
        made = copy.deepcopy(manifest)
        made["files"][0]["path"] = path
        yield replaced(
            verify, f"manifest lists {path}", [1], {"data/manifest.json": Entry(tree=made, pack="json")}
        )
    if "data/journal.txt" not in resume.files:
        return
    journal = [
        json.loads(text.rsplit(b"\t", 1)[0]) for text in resume.files["data/journal.txt"].data.splitlines()
    ]
    packet = next(i for i, entry in enumerate(journal) if "packet" in entry)
    for value in (2**32 - 1, 2**32, 2**63 - 1, -1, None, "x", 1e300, [], Raw("[" * DEEP + "]" * DEEP)):
        for key in ("packet", "records", "files"):
            for place in (0, 1, 2) if key == "packet" else (0,):
                lines = copy.deepcopy(journal)
                if isinstance(lines[packet][key], list) and place < len(lines[packet][key]):
                    lines[packet][key][place] = value
                    yield replaced(
                        resume,
                        f"journal: {key} {place} {value!r}",
                        [0, 1],
                        {"data/journal.txt": Entry(tree=lines, pack="journal")},
                    )
    for line in (
        [],
        {},
        None,
        {"packet": 1},
        {"end": 0, "files": [["../../outside/secret.txt", 1, "0"]]},
        {"end": 0, "files": [[f"{OUTSIDE}/secret.txt", 1, "0"]]},
        {"end": 2**32 - 1, "files": []},
    ):
        yield replaced(
            resume,
            f"journal: {json.dumps(line)[:60]}",
            [0, 1],
            {"data/journal.txt": Entry(tree=[*journal, line], pack="journal")},
        )
    parts = [name for name in resume.files if name.endswith(".part") or name.endswith("journal.txt")]
    for part in [*parts[:3], "data/journal.txt"]:
        yield replaced(
            resume,
            f"resume: {part.rsplit('/', 1)[-1]} is a link",
            [1],
            {part: Entry("link", f"{OUTSIDE}/secret.txt".encode())},
        )
    stacks = sorted(
        {name.rsplit("/", 1)[0] for name in resume.files if name.startswith("data/sequence_0001/")}
    )
    for folder in stacks[:2]:
        case = resume.copy()
        case.files = {name: entry for name, entry in case.files.items() if not name.startswith(folder + "/")}
        case.files[folder] = Entry("link", OUTSIDE.encode())
        case.name, case.exit, case.done = f"resume: {folder} is a link", [1], [f"{folder}: link"]
        yield case
    yield from places_of(resume, "resume", ["data/journal.txt", "data/dataset.json"])


def python(bases: list[Case]) -> Iterator[Case]:
    whole = bases[0]
    for case in dataset([whole] * 15):
        if not case.name.startswith(("resume", "journal", "inspect", "manifest")):
            case.exit, case.name = [0, 1], case.name.replace("verify", "python")
            yield case
    for name in whole.files:
        if name.endswith(".exr") and name.endswith("000000.exr"):
            data = whole.files[name].data
            for size in (0, 4, 8, 20, 60, len(data) // 2, len(data) - 1):
                yield replaced(whole, f"{name} of {size} bytes", [0, 1], {name: Entry(data=data[:size])})


ATTACKS: dict[str, Callable] = {
    "scenario": scenario,
    "gltf": gltf,
    "picture": picture,
    "mitsuba": mitsuba,
    "ply": ply,
    "csv": csv,
    "dataset": dataset,
    "python": python,
}


def attacks_of(kind: str, bases: list[Case]) -> Iterator[Case]:
    for case in ATTACKS[kind](bases):
        if case.command[0] in ("explain", "paths", "generate") or "--radio-materials" in case.command:
            case.secret = False
        yield case
