#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Asks bash, zsh and fish for their completions with the scripts of `greatx completion SHELL`, and compares
the answers. zsh and fish are left out where they are not installed. Also compares the manual page with
--help: every command and every option of every command must be in it.

usage: check_completion.py PROGRAM
"""

import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile

#: What is typed, and what must be among the answers; a name after "!" must not. The current folder holds
#: file.yaml and a folder.
CASES = [
    ("gen", ["generate", "!info", "!file.yaml"]),
    ("scene c", ["city", "check", "country", "!completion"]),
    ("scene city --s", ["--seed", "--size", "!--set"]),
    ("generate --compression ", ["none", "fast", "small", "!file.yaml"]),
    ("generate --compression f", ["fast", "!none"]),
    ("generate c", ["city", "canyon", "!room"]),
    ("generate f", ["file.yaml", "folder"]),
    ("generate --seed ", ["!file.yaml", "!city"]),
    ("generate --seed 3 --res", ["--resume"]),
    ("generate --assets f", ["folder"]),
    ("info f", ["!file.yaml", "!folder"]),
    ("completion ", ["bash", "zsh", "fish"]),
    ("paths city --color ", ["gain", "kind"]),
]
#: What Readline adds itself: names of files, where the function allows it by leaving COMPREPLY empty.
BASH = """
compopt() { [[ $* == "+o default"* ]] && allowed=; true; }
source "$1"
shift
COMP_WORDS=(greatx "$@")
COMP_CWORD=$#
allowed=yes
_greatx
[[ -n $allowed && ${#COMPREPLY[@]} -eq 0 ]] && mapfile -t COMPREPLY < <(compgen -f -- "${!#}")
printf '%s\\n' "${COMPREPLY[@]}"
"""
#: Prints what the completion system would add, each in brackets, instead of adding it.
ZSH = r"""
autoload -Uz compinit
compinit -u -D
source $1
unsetopt listbeep
compadd() {
  local -a captured
  builtin compadd -O captured "$@" 2>/dev/null
  (( $#captured )) && print -rl -- "<"${^captured}">"
  builtin compadd "$@"
}
ask() { print; _main_complete; compstate[insert]=; compstate[list]=; print -r -- "<<done>>" }
zle -C ask complete-word ask
bindkey "^X" ask
print -r -- "<<done>>"
"""


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Bash:
    def __init__(self, script):
        self.script = script

    def answers(self, typed):
        return run("bash", "--norc", "-c", BASH, "bash", self.script, *typed.split(" ")).splitlines()


class Fish:
    def __init__(self, script):
        self.script = script

    def answers(self, typed):
        command = f"source {self.script}; complete -C 'greatx {typed}'"
        # A description follows after a tab. Folders end in a slash.
        lines = run("fish", "--no-config", "-c", command).splitlines()
        return [line.split("\t")[0].rstrip("/") for line in lines]


class Zsh:
    """An interactive zsh on a terminal, because its completion works only there."""

    def __init__(self, script):
        setup = pathlib.Path("setup.zsh")
        setup.write_text(ZSH)
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb"})
        self.send(f"PROMPT= RPROMPT=; stty -echo; source ./{setup} {script}\n")
        self.read()

    def send(self, text):
        os.write(self.terminal, text.encode())

    def read(self):
        """Returns what the shell prints up to the mark of the end."""
        text = ""
        while "<<done>>" not in text:
            if not select.select([self.terminal], [], [], 60)[0]:
                sys.exit(f"zsh: expected <<done>>, found {text!r}")
            text += os.read(self.terminal, 65536).decode(errors="replace")
        return text

    def answers(self, typed):
        self.send(f"greatx {typed}\x18")
        answers = re.findall(r"^<(.*)>\r?$", self.read(), re.MULTILINE)
        self.send("\x15")  # empties the line
        return answers

    def __del__(self):
        os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)


def completion_faults(program, shell, kind):
    script = pathlib.Path(f"greatx.{shell}").resolve()
    script.write_text(run(program, "completion", shell))
    run(shell, "-n", str(script))
    asked = kind(str(script))
    for typed, wanted in CASES:
        answers = asked.answers(typed)
        for name in wanted:
            banned = name.startswith("!")
            if (name.lstrip("!") in answers) == banned:
                what = "no " if banned else ""
                yield f"{shell}: 'greatx {typed}': expected {what}'{name.lstrip('!')}', found {answers}"


def commands(program, path=()):
    """Yields the path of each command, and its --help."""
    text = run(program, *path, "--help")
    yield path, text
    # The groups of commands follow the options; no option begins with a letter.
    for name in re.findall(r"^  ([a-z]\w*) ", text.partition("\nOptions:\n")[2], re.MULTILINE):
        yield from commands(program, (*path, name))


def manual_faults(program):
    page = run(program, "manual").replace("\\-", "-")
    seen = 0
    for path, text in commands(program):
        section = page
        if path:
            match = re.search(
                rf"^\.SS greatx {' '.join(path)}$(.*?)(?=^\.S[SH] )", page, re.DOTALL | re.MULTILINE
            )
            section = match.group(1) if match else ""
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.MULTILINE):
            seen += 1
            if f"\\fB{option}\\fR" not in section and option != "--help":
                yield f"manual: 'greatx {' '.join(path)}': expected {option}, found none"
    if seen < 150:
        yield f"--help: expected 150 options or more, found {seen}"


def main(program):
    found = list(manual_faults(program))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("file.yaml").touch()
        pathlib.Path("folder").mkdir()
        for shell, kind in (("bash", Bash), ("zsh", Zsh), ("fish", Fish)):
            if shell == "bash" or shutil.which(shell):
                found += completion_faults(program, shell, kind)
            else:
                print(f"{shell}: left out, not installed")
        os.chdir("/")
    print("\n".join(found) or "completions and manual page are complete")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1])))
