# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the rooms of the source and the arrows between them.

usage: check_arrows.py ROOT [--write]

A room is a folder with a `greatx_room(ROOM … ROOMS …)` in the CMakeLists.txt of its top folder. A program or
a module has a `greatx_links(TARGET ROOM…)`. The ROOMS are the arrows. It is a fault if

- a file includes a header of a room that its own room does not name,
- a room names another room and includes nothing of it,
- the arrows form a circle,
- a file with code is in no room, or a room's CMakeLists.txt does not name a source,
- the drawing of the rooms in OVERVIEW.md differs from the drawing that follows from the rooms (--write
  mends it).
"""
import pathlib
import re
import sys
import textwrap

TOPS = "core gpu scene renderer rf io sim draw view assets engine apps python".split()
#: Leaves that every room may include. C++ and GLSL both read shaders/shared. shaders/spirv.h finds compiled
#: shaders.
FREE = {"shaders", "shaders/shared"}
#: Folder of the files of each program or module, by target.
PROGRAMS = {
    "greatx": "apps",
    "greatx_places": "apps/place/program",
    "greatx_engine_library": "engine/library",
    "greatx_python": "python/src",
}
INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"', re.MULTILINE)
ROOM = re.compile(r"((?:^#.*\n)*)^greatx_room\(([^\s)]+)([^)]*)\)", re.MULTILINE)
LINKS = re.compile(r"^greatx_links\((\S+)([^)]*)\)", re.MULTILINE)
BEGIN, END = "<!-- rooms: begin -->\n", "<!-- rooms: end -->\n"


class Room:
    def __init__(self, name, words, arrows, sources):
        self.name, self.words, self.arrows, self.sources = name, words, arrows, sources
        self.used = set()


def rooms_of(root):
    rooms = {
        "assets": Room(
            "assets",
            "Scenarios embedded in the program; examples that need files from elsewhere.",
            set(),
            None,
        )
    }
    for top in TOPS:
        text = (root / top / "CMakeLists.txt").read_text()
        for comment, name, body in ROOM.findall(text):
            lists = {key: [] for key in ("SOURCES", "ROOMS", "USES")}
            current = None
            for word in body.split():
                if word in lists:
                    current = lists[word]
                elif current is not None:
                    current.append(word)
            words = " ".join(line.lstrip("# ") for line in comment.splitlines())
            rooms[name] = Room(name, words, set(lists["ROOMS"]), lists["SOURCES"])
        for target, body in LINKS.findall(text):
            folder = PROGRAMS[target]
            rooms[folder] = Room(folder, f"The program, library or module {target}.", set(body.split()), None)
    return rooms


def include_faults(root, rooms):
    seen = 0
    for top in TOPS:
        for file in sorted((root / top).rglob("*")):
            # An example for users is no part of the program.
            if file.suffix not in {".h", ".cpp"} or "examples" in file.parts:
                continue
            name = str(file.parent.relative_to(root))
            where = file.relative_to(root)
            if name not in rooms:
                yield f"{where}: its folder is no room: expected a greatx_room({name} …)"
                continue
            room = rooms[name]
            if file.suffix == ".cpp" and room.sources is not None and file.name not in room.sources:
                yield f"{where}: not among the SOURCES of greatx_room({name} …)"
            for include in INCLUDE.findall(file.read_text()):
                if "/" not in include:
                    yield f"{where}: includes {include}, expected a path from the project's root"
                    continue
                target = include.rsplit("/", 1)[0]
                seen += 1
                room.used.add(target)
                if target != name and target not in FREE and target not in room.arrows:
                    yield f"{where}: includes {include}, but {name} has no arrow to {target}"
    if seen == 0:
        yield "found no includes"


def arrow_faults(rooms):
    for room in rooms.values():
        for other in sorted(room.arrows - rooms.keys()):
            yield f"{room.name}: an arrow to {other}, which is no room"
        for other in sorted((room.arrows & rooms.keys()) - room.used):
            yield f"{room.name}: an arrow to {other}, of which it includes nothing"
    done, way = set(), []

    def circles(name):
        if name in way:
            yield "a circle: " + " -> ".join(way[way.index(name) :] + [name])
        elif name not in done and name in rooms:
            way.append(name)
            for other in sorted(rooms[name].arrows):
                yield from circles(other)
            way.pop()
            done.add(name)

    for name in rooms:
        yield from circles(name)


def drawing(rooms):
    """Draws the rooms from the bottom up. Leaves out arrows that follow from other arrows."""

    def below(name):
        found, todo = set(), [name]
        while todo:
            for other in rooms[todo.pop()].arrows - found:
                found.add(other)
                todo.append(other)
        return found

    height = {}

    def height_of(name):
        if name not in height:
            height[name] = 1 + max((height_of(other) for other in rooms[name].arrows), default=0)
        return height[name]

    lines = ["```\n"]
    for top in TOPS:
        names = sorted(
            (name for name in rooms if name.split("/")[0] == top), key=lambda name: (height_of(name), name)
        )
        for name in names:
            arrows = rooms[name].arrows
            direct = sorted(
                other for other in arrows if not any(other in below(third) for third in arrows - {other})
            )
            to = f"{name:<25}─► " + ("  ".join(direct) if direct else "nothing")
            lines += [
                line + "\n"
                for line in textwrap.wrap(to, 110, subsequent_indent=" " * 28, break_on_hyphens=False)
            ]
        lines.append("\n")
    lines[-1] = "```\n\n"
    lines.append("| room | holds |\n|---|---|\n")
    for top in TOPS:
        for name in sorted((name for name in rooms if name.split("/")[0] == top)):
            lines.append(f"| `{name}/` | {rooms[name].words} |\n")
    return "".join(lines)


def main(root, write):
    rooms = rooms_of(root)
    faults = [*include_faults(root, rooms), *arrow_faults(rooms)]
    overview = root / "OVERVIEW.md"
    text = overview.read_text()
    if not faults:
        if BEGIN not in text or END not in text:
            faults.append(f"OVERVIEW.md: expected the lines {BEGIN.strip()} and {END.strip()}")
        else:
            head, rest = text.split(BEGIN, 1)
            drawn = head + BEGIN + drawing(rooms) + END + rest.split(END, 1)[1]
            if write:
                overview.write_text(drawn)
            elif drawn != text:
                faults.append(
                    "OVERVIEW.md: its rooms are not those of the CMakeLists.txt: "
                    "run tests/apps/check_arrows.py . --write"
                )
    print(
        "\n".join(faults)
        or f"{len(rooms)} rooms, {sum(len(room.arrows) for room in rooms.values())} arrows, no circle"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), "--write" in sys.argv[2:]))
