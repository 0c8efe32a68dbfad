# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""check_docs_commands.py PROGRAM SOURCE FILE...: checks that the command lines of README.md, docs/ and other
pages are the program's own.

Every `greatx ...`, between backticks or in a block, must have subcommands, options and embedded scenarios
that --help knows. So must every option that stands alone between backticks.

A block that begins with `greatx` or with `$ COMMAND` is run, line by line, in a folder of the page's own, and
must succeed. These comments in front of a block change that:

    <!-- check: options -->         it is not run: it has names to be filled in, or takes long
    <!-- check: fails -->           its commands must end with exit code 1; what is shown is the message
    <!-- check: prints COMMAND -->  it is what this command prints; the command is run once for the whole page
    <!-- file: NAME -->             it is the content of this file, for the commands of its page

The lines below `$ COMMAND`, or of a block that a command prints, must be its output, one after another from
some line on. Numbers with a fraction or an exponent may differ by one and a half of their last digit. Spaces
may differ in number. `...` or `…` within a line stands for any text, for example for a time or for what
depends on the device, and alone in a line for any lines. Output after the last line is ignored.

Three more checks: docs/commands.md names every embedded scenario. In README.md the numbers of triangles in
the table are right, and so are the paths of files below "sequence_0000/", whose numbers of frames are taken
as 0.
"""
from __future__ import annotations

import argparse
import functools
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

FENCE = re.compile(
    r"^(?P<comments>(?:<!-- [^\n]* -->\n)*)```(?P<language>\w*)\n(?P<body>.*?)^```$", re.DOTALL | re.MULTILINE
)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w])")
OTHERS = {  # options of other programs, and options of greatx's scripts
    "--install",
    "--build",
    "--target",
    "--no-build-isolation",
    "--no-deps",
    "--extra-index-url",
    "--layout",
    "--prefix",
    "--table",
}


class Failure(Exception):
    pass


@functools.cache
def converter_options(source: pathlib.Path) -> set[str]:
    """Returns all options of python3 -m greatx.convert."""
    sys.path.insert(0, str(source / "python"))
    from greatx.convert.catalogue import COMMANDS

    found: set[str] = set()
    for command in COMMANDS:
        parser = argparse.ArgumentParser()
        command.arguments(parser)
        found.update(re.findall(r"(?<![\w-])--[a-z][\w-]*", parser.format_help()))
    return found


def task_options(source: pathlib.Path) -> set[str]:
    """Returns all options of the tasks of python/tasks, which need PyTorch to print them."""
    found: set[str] = set()
    for path in (source / "python/tasks").rglob("*.py"):
        found.update(re.findall(r'(?:"|\s)(--[a-z][a-z-]*)"', path.read_text()))
    return found


class Program:
    def __init__(self, program: str):
        self.program = program

    @functools.cache
    def help(self, *chain: str) -> str:
        return subprocess.run(
            [self.program, *chain, "--help"], capture_output=True, text=True, check=True
        ).stdout

    @functools.cache
    def options(self, *chain: str) -> set[str]:
        return set(
            re.findall(
                r"(?<![\w-])--?[A-Za-z][\w-]*",
                "\n".join(line for line in self.help(*chain).splitlines() if line.lstrip().startswith("-")),
            )
        )

    @functools.cache
    def subcommands(self, *chain: str) -> list[str]:
        # The groups of commands follow the options; no option begins with a letter.
        part = self.help(*chain).partition("\nOptions:\n")[2]
        return re.findall(r"^  ([a-z]\w*) ", part, re.MULTILINE)

    @functools.cache
    def scenarios(self, command: str = "explain") -> list[str]:
        return re.findall(r"\w+", self.help(command).partition("or an embedded one:")[2].partition("\n\n")[0])

    def every_option(self) -> set[str]:
        found = self.options()
        for command in self.subcommands():
            found = found | self.options(command)
            for below in self.subcommands(command):
                found = found | self.options(command, below)
        return found

    def check(self, line: str) -> None:
        """Checks the names of subcommands, options and scenarios."""
        try:
            words = shlex.split(line, comments=True)
        except ValueError:
            words = line.split()
        chain: list[str] = []
        words = [word.strip("[],.;…") for word in words[words.index("greatx") + 1 :]]
        for word in words:
            if word in (">", "|", "&&"):
                return
            if re.fullmatch(r"--?[A-Za-z].*", word):
                name = word.partition("=")[0]
                if name not in self.options(*chain):
                    raise Failure(f"greatx {' '.join(chain)} has no option {name}")
            elif self.subcommands(*chain) and re.fullmatch(r"[a-z]\w*", word):
                if word not in self.subcommands(*chain):
                    raise Failure(f"greatx {' '.join(chain)} has no subcommand {word}")
                chain.append(word)
            elif (
                word == words[len(chain)]
                and re.fullmatch(r"[a-z]\w*", word)
                and "SCENARIO" in self.help(*chain)
            ):
                if word not in self.scenarios(*chain):
                    raise Failure(f"there is no embedded scenario {word}")


def same(shown: str, printed: str) -> bool:
    """Returns whether a line of a page agrees with a line of the program's output."""
    shown, printed = " ".join(shown.split()), " ".join(printed.split())
    wanted, pattern, last = [], "", 0
    for match in re.finditer(rf"…|\.\.\.|{NUMBER.pattern}", shown):
        pattern += re.escape(shown[last : match.start()])
        last = match.end()
        if match[0] in ("…", "..."):
            pattern += ".*?"
        # The digits of a path's identity may look like a number beyond all bounds.
        elif re.search(r"[.eE]", match[0]) and math.isfinite(float(match[0])):
            pattern += f"({NUMBER.pattern})"
            wanted.append(match[0])
        else:
            pattern += re.escape(match[0])
    found = re.fullmatch(pattern + re.escape(shown[last:]), printed)
    if not found:
        return False
    for text, number in zip(wanted, found.groups(), strict=True):
        mantissa, _, exponent = text.lower().partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        if abs(float(text) - float(number)) > 1.5 * unit:
            return False
    return True


def compare(shown: list[str], printed: list[str]) -> None:
    at, skipping = 0, True
    for line in shown:
        if line.strip() in ("...", "…"):
            skipping = True
            continue
        if not line.strip():
            continue
        rest = [i for i in range(at, len(printed)) if printed[i].strip()]
        match = next((i for i in (rest if skipping else rest[:1]) if same(line, printed[i])), None)
        if match is None:
            raise Failure(
                f"shown:   {line}\nprinted: " + ("\n         ".join(printed[at : at + 12]) or "nothing more")
            )
        at, skipping = match + 1, False


class Page:
    def __init__(self, file: pathlib.Path, program: Program, source: pathlib.Path, folder: pathlib.Path):
        self.file, self.program, self.source = file, program, source
        self.text = file.read_text(encoding="utf-8")
        self.folder = folder / file.stem
        self.runs = self.checked = 0
        self.printed: dict[str, list[str]] = {}  # what each command of the page prints
        self.env = dict(
            os.environ, GREATX_CACHE=str(folder / "cache"), PATH=f"{folder}/bin:{os.environ['PATH']}"
        )

    def line_of(self, at: int) -> int:
        return self.text.count("\n", 0, at) + 1

    def prepare(self) -> None:
        self.folder.mkdir()
        for name in ("assets", "python"):
            (self.folder / name).symlink_to(self.source / name)
        for block in FENCE.finditer(self.text):
            for name in re.findall(r"<!-- file: (\S+) -->", block["comments"]):
                (self.folder / name).write_text(block["body"], encoding="utf-8")

    def prints(self, command: str) -> list[str]:
        """Returns what a command prints; it is run if no block of this page has run it before."""
        if command not in self.printed:
            self.run(command)
        return self.printed[command]

    def run(self, command: str, fails: bool = False) -> list[str]:
        written = command
        command = re.sub(r"\bpython3\b", shlex.quote(sys.executable), command)
        done = subprocess.run(
            ["bash", "-c", command],
            cwd=self.folder,
            env=self.env,
            capture_output=True,
            text=True,
            check=False,
        )
        self.runs += 1
        if done.returncode != (1 if fails else 0):
            raise Failure(f"ends with {done.returncode}: {done.stderr.strip()}")
        self.printed[written] = (done.stderr if fails else done.stdout).splitlines()
        return self.printed[written]

    def block(self, body: str, comments: str) -> None:
        printed = re.search(r"<!-- check: prints (.*?) -->", comments)
        if printed:
            try:
                compare(body.splitlines(), self.prints(printed[1]))
            except Failure as failure:
                raise Failure(f"{printed[1]}\n{failure}") from None
            return
        runs, fails = "check: options" not in comments, "check: fails" in comments
        lines = body.splitlines()
        if not lines[0].startswith("$ "):
            lines = [f"$ {line}" for line in lines if line.strip() and not line.lstrip().startswith("#")]
        starts = [i for i, line in enumerate(lines) if line.startswith("$ ")]
        for start, end in zip(starts, [*starts[1:], len(lines)], strict=True):
            command = lines[start][2:]
            try:
                if "greatx" in shlex.split(command, comments=True) and not fails:
                    self.program.check(command)
                    self.checked += 1
                if runs:
                    compare(lines[start + 1 : end], self.run(command, fails))
                elif end > start + 1:
                    raise Failure("what it prints is shown, so it has to be run")
            except Failure as failure:
                raise Failure(f"{command}\n{failure}") from None

    def check(self) -> None:
        # A page about one command shows only the options of this command.
        about = re.search(r"^# `greatx ([\w ]+)`$", self.text, re.MULTILINE)
        every = self.program.options(*about[1].split()) if about else self.program.every_option()
        inline = FENCE.sub(lambda match: "\n" * match[0].count("\n"), self.text)
        for span in re.finditer(r"`([^`]+)`", inline):
            code = " ".join(span[1].split())
            try:
                if code.startswith("greatx "):
                    self.program.check(code)
                    self.checked += 1
                for option in re.findall(r"^--[a-z][\w-]*", code):
                    if option not in every | OTHERS | converter_options(self.source) | task_options(
                        self.source
                    ):
                        raise Failure(
                            f"greatx {about[1]} has no option {option}"
                            if about
                            else f"no command has the option {option}"
                        )
            except Failure as failure:
                raise Failure(f"{self.file}:{self.line_of(span.start())}: {code}\n{failure}") from None
        blocks = [
            match
            for match in FENCE.finditer(self.text)
            if re.match(r"\$ |greatx ", match["body"]) or "check: prints" in match["comments"]
        ]
        if any("check: options" not in match["comments"] for match in blocks):
            self.prepare()
        for match in blocks:
            try:
                self.block(match["body"], match["comments"])
            except Failure as failure:
                raise Failure(f"{self.file}:{self.line_of(match.start('body'))}: {failure}") from None


def check_embedded_scenarios(page: Page) -> None:
    for name in page.program.scenarios():
        if not re.search(rf"\b{name}\b", page.text):
            raise Failure(f"{page.file}: the embedded scenario {name} is not there")


def check_readme(readme: Page) -> None:
    """Checks the triangles of the default scenario and the files of a data set."""
    triangles = re.search(r"^\| (\w+) \(default\) \| ([\d,]+) \|", readme.text, re.MULTILINE)
    printed = readme.run(f"greatx explain {triangles[1]}")[0]
    if f" {triangles[2].replace(',', '')} triangles" not in printed:
        raise Failure(f"{readme.file}: {triangles[0]}\n{printed}")
    readme.run("greatx generate --ticks 1 -o layout -q")
    files = [str(file.relative_to(readme.folder)) for file in (readme.folder / "layout").rglob("*")]
    block = next(
        match["body"] for match in FENCE.finditer(readme.text) if match["body"].startswith("sequence_0000/")
    )
    for name in re.sub(r"\b\d{6}\b", "000000", block).split():
        if name != "…" and not any(file.endswith("/" + name) for file in files):
            raise Failure(f"{readme.file}: a data set has no file {name}")


def main(binary: str, source: str, files: list[str]) -> int:
    program = Program(str(pathlib.Path(binary).resolve()))
    runs = checked = 0
    with tempfile.TemporaryDirectory(prefix="greatx_docs_") as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "bin/greatx").symlink_to(program.program)
        for file in map(pathlib.Path, files):
            page = Page(file, program, pathlib.Path(source).resolve(), folder)
            try:
                page.check()
                if file.resolve() == page.source / "README.md":
                    page.folder.mkdir(exist_ok=True)
                    check_readme(page)
                if file.name == "commands.md":
                    check_embedded_scenarios(page)
            except Failure as failure:
                print(failure)
                return 1
            runs, checked = runs + page.runs, checked + page.checked
    print(f"{checked} command lines, {runs} of them run")
    return 0 if runs > 0 and checked > 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
