# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the program on damaged inputs and judges how it ends. README.md beside this file explains faults and
options.

  fuzz.py --program build/release/greatx --kind all --seed 1 --count 1000 --time-limit 600 --keep found
  fuzz.py --program build/release/greatx --replay found/dataset-signal-....json
"""
from __future__ import annotations

import argparse
import collections
import concurrent.futures
import itertools
import pathlib
import re
import sys
import tempfile
import time

import attacks
import judge
import mutate
import seeds
from case import Case


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--program",
        required=True,
        help="the greatx to run; one with AddressSanitizer runs without a limit of memory",
    )
    parser.add_argument("--kind", default="all", choices=["all", *seeds.KINDS], help="of input")
    parser.add_argument(
        "--python", default="", metavar="DIR", help="folder of the Python package, which kind `python` needs"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="every case follows from kind, seed and its number"
    )
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--count", type=int, default=100, help="cases of each kind")
    parser.add_argument(
        "--time-limit", type=float, default=0, metavar="SECONDS", help="begin no case after this; 0: none"
    )
    parser.add_argument("--jobs", type=int, default=2, help="programs at a time")
    parser.add_argument(
        "--memory", type=int, default=4096, metavar="MIB", help="address space of a run; 0: unlimited"
    )
    parser.add_argument(
        "--cpu-limit",
        type=int,
        default=0,
        metavar="SECONDS",
        help="of a run; 0: 20, of a sanitized program 120",
    )
    parser.add_argument(
        "--wall-limit", type=int, default=0, metavar="SECONDS", help="of a run; 0: three times the former"
    )
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the cases that fail")
    parser.add_argument(
        "--attacks", action="store_true", help="also the named attacks of attacks.py, on the kinds chosen"
    )
    parser.add_argument("--every", type=int, default=1, metavar="N", help="of the attacks each N-th alone")
    parser.add_argument("--corpus", type=pathlib.Path, help="also every case kept in this folder")
    parser.add_argument("--replay", type=pathlib.Path, nargs="+", help="kept cases, and nothing else")
    parser.add_argument(
        "--into", type=pathlib.Path, help="with --replay of one case: leave its files in this new folder"
    )
    options = parser.parse_args()
    if options.kind == "python" and not options.python:
        parser.error("--kind python: expected --python DIR with it")
    return options


def limits_of(options: argparse.Namespace, sanitized: bool) -> judge.Limits:
    cpu = options.cpu_limit or (120 if sanitized else 20)
    return judge.Limits(
        0 if sanitized else options.memory,
        cpu,
        options.wall_limit or 3 * cpu,
        python=options.python and str(pathlib.Path(options.python).resolve()),
    )


def check_seeds(program: str, kind: str, cases: list[Case], limits: judge.Limits, sanitized: bool) -> None:
    """Runs the seeds and raises RuntimeError if one fails, because mutations of a refused input find
    nothing."""
    seen = set()
    for case in cases:
        key = (tuple(case.command), tuple((name, id(entry)) for name, entry in case.files.items()))
        if key in seen:
            continue
        seen.add(key)
        verdict = judge.run(program, case, limits, sanitized)
        if verdict.fault or verdict.exit != 0:
            raise RuntimeError(
                f"a seed of kind {kind} fails: {' '.join(case.command)}: "
                f"{verdict.fault or verdict.exit}\n{verdict.printed}"
            )


def describe(case: Case) -> str:
    return f"{case.name}: {' '.join(case.command)}; " + "; ".join(done[:160] for done in case.done)


# The state of one process, which `prepare` sets, so that seeds are made once and not sent with every case.
STATE: dict = {}


def prepare(state: dict) -> None:
    STATE.update(state)


def work(job: tuple) -> tuple[Case, judge.Verdict, bool]:
    """Runs one case. Returns the case, its verdict, and whether it failed twice."""
    kind, number = job
    if isinstance(number, int):
        case = mutate.mutate(kind, STATE["seed"], number, STATE["seeds"][kind])
    else:
        case = number
    verdict = judge.run(STATE["program"], case, STATE["limits"], STATE["sanitized"])
    again = (
        verdict.fault.startswith("hang")
        or bool(verdict.fault)
        and bool(judge.run(STATE["program"], case, STATE["limits"], STATE["sanitized"]).fault)
    )
    return case, verdict, again


def cause_of(fault: str) -> str:
    """Returns the fault without names and numbers, so that faults that differ only in these count as one."""
    fault = re.sub(r"( [io][nf] what is printed).*", r"\1", fault, flags=re.DOTALL)
    return re.sub(r"[0-9a-f]{6,}|\d+|'[^']*'|\"[^\"]*\"", "#", fault)[:100]


class Report:
    def __init__(self, keep: pathlib.Path | None):
        self.keep, self.runs = keep, collections.Counter()
        self.exits: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
        self.causes: dict[tuple[str, str], list[str]] = collections.defaultdict(list)
        self.slowest, self.largest = (0.0, ""), (0.0, "")
        if keep:
            keep.mkdir(parents=True, exist_ok=True)

    def add(self, case: Case, verdict: judge.Verdict, again: bool) -> None:
        self.runs[case.kind] += 1
        self.exits[case.kind][verdict.exit] += 1
        self.slowest = max(self.slowest, (verdict.seconds, case.name))
        self.largest = max(self.largest, (verdict.memory_mib, case.name))
        if not verdict.fault:
            return
        cause = (case.kind, cause_of(verdict.fault))
        first = not self.causes[cause]
        self.causes[cause].append(case.name)
        if first or len(self.causes[cause]) <= 3:
            print(
                f"FAULT {describe(case)}\n  {verdict.fault}{'' if again else ' (once of two runs)'}",
                flush=True,
            )
        if self.keep and len(self.causes[cause]) <= 3:
            name = re.sub(r"\W+", "-", f"{case.name}-{verdict.fault.split(':')[0]}")
            (self.keep / f"{name}.json").write_text(case.to_json())

    def end(self) -> int:
        for kind, runs in sorted(self.runs.items()):
            ends = ", ".join(f"exit {code}: {count}" for code, count in sorted(self.exits[kind].items()))
            print(f"{kind}: {runs} runs; {ends}")
        for (kind, cause), names in sorted(self.causes.items()):
            print(f"  {len(names):5} x {kind}: {cause}  [{', '.join(names[:3])}]")
        print(
            f"slowest {self.slowest[0]:.1f} s ({self.slowest[1]}), "
            f"largest {self.largest[0]:.0f} MiB ({self.largest[1]})"
        )
        faults = sum(map(len, self.causes.values()))
        print(f"{faults} faults in {sum(self.runs.values())} runs")
        return 1 if faults or not self.runs else 0


def replay(options: argparse.Namespace, program: str, limits: judge.Limits, sanitized: bool) -> int:
    faults = 0
    for file in options.replay:
        case = Case.from_json(file.read_text())
        verdict = judge.run(program, case, limits, sanitized, options.into)
        print(
            f"{file}: {describe(case)}\n{verdict.printed[:4000].rstrip()}\n"
            f"exit {verdict.exit}, {verdict.seconds:.2f} s, {verdict.memory_mib:.0f} MiB: "
            f"{verdict.fault or 'no fault'}"
        )
        faults += bool(verdict.fault)
    return 1 if faults else 0


def jobs_of(options: argparse.Namespace, kinds: list[str], bases: dict[str, list[Case]]):
    """Yields the corpus, the attacks, and then the kinds in turns, so that all kinds share a time limit."""
    if options.corpus:
        for file in sorted(options.corpus.glob("*.json")):
            case = Case.from_json(file.read_text())
            case.name = file.stem
            if case.kind in kinds:
                yield case.kind, case
    if options.attacks:
        for kind in kinds:
            for case in itertools.islice(
                attacks.attacks_of(kind, bases[kind]), 0, None, max(options.every, 1)
            ):
                yield kind, case
    for number in range(options.first, options.first + options.count):
        for kind in kinds:
            yield kind, number


def main() -> int:
    options = arguments()
    program = str(pathlib.Path(options.program).resolve())
    sanitized = judge.is_sanitized(program)
    limits = limits_of(options, sanitized)
    if options.replay:
        return replay(options, program, limits, sanitized)
    begin = time.monotonic()
    kinds = (
        [kind for kind in seeds.KINDS if kind != "python" or options.python]
        if options.kind == "all"
        else [options.kind]
    )
    bases = {}
    for kind in kinds:
        with tempfile.TemporaryDirectory(prefix="greatx_fuzz_") as folder:
            bases[kind] = seeds.seeds_of(kind, program, pathlib.Path(folder, "seeds"), judge.environment())
        check_seeds(program, kind, bases[kind], limits, sanitized)
    state = {
        "seed": options.seed,
        "seeds": bases,
        "program": program,
        "limits": limits,
        "sanitized": sanitized,
    }
    report = Report(options.keep)
    jobs = jobs_of(options, kinds, bases)
    with concurrent.futures.ProcessPoolExecutor(options.jobs, initializer=prepare, initargs=(state,)) as pool:
        waiting = {pool.submit(work, job) for job in itertools.islice(jobs, 2 * options.jobs)}
        while waiting:
            done, waiting = concurrent.futures.wait(waiting, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                report.add(*future.result())
                if not options.time_limit or time.monotonic() - begin < options.time_limit:
                    waiting |= {pool.submit(work, job) for job in itertools.islice(jobs, 1)}
    return report.end()


if __name__ == "__main__":
    sys.exit(main())
