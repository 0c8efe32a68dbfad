# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that no line is longer than 110 columns.

usage: check_columns.py ROOT

All lines of the source (C++, GLSL, Python, CMake, shell) and of the scenarios in assets/ are checked. Of a
Markdown page the sentences are checked, but no table, block of code or picture.
"""
import pathlib
import shutil
import subprocess
import sys

MOST = 110
#: By the end of a file's name.
CODE = (".h", ".cpp", ".glsl", ".py", ".pyi", ".cmake", "CMakeLists.txt", ".sh")


def sentences(lines):
    """Yields (number, line) for the lines of a Markdown page that are neither table, code nor picture."""
    in_code = False
    for number, line in enumerate(lines, 1):
        text = line.lstrip()
        if text.startswith("```"):
            in_code = not in_code
        # A line of one word (`code` counts as one) cannot be broken.
        one_word = text.count("`") == 2 and text.startswith("`") and text.rstrip(".,:;").endswith("`")
        if not (in_code or one_word or text.startswith(("|", "!["))):
            yield number, line


def checked_lines(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return sentences(lines) if path.suffix == ".md" else enumerate(lines, 1)


def sources(root):
    """Returns the files of the project: those that git knows, or all outside of build/ and out/."""
    git = shutil.which("git")
    listed = git and subprocess.run([git, "-C", root, "ls-files", "-z"], capture_output=True, text=True)
    if listed and listed.returncode == 0:
        names = [name for name in listed.stdout.split("\0") if name]
    else:
        names = [str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()]
        names = [name for name in names if not name.startswith(("build/", "out/", "."))]
    wanted = [
        name
        for name in names
        if name.endswith((".md",) + CODE) or (name.startswith("assets/") and name.endswith(".yaml"))
    ]
    return [root / name for name in wanted if (root / name).is_file()]


def main():
    root = pathlib.Path(sys.argv[1])
    paths = sources(root)
    if not paths:
        sys.exit(f"{root}: expected sources, found none")
    faults = [
        f"{path.relative_to(root)}:{number}: {len(line)} columns, expected at most {MOST}"
        for path in paths
        for number, line in checked_lines(path)
        if len(line) > MOST
    ]
    print("\n".join(faults) if faults else f"{len(paths)} files, no line of more than {MOST} columns")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
