# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of docs/sionna.md in Markdown: time, memory, completeness and determinism of both tools on
etoile. Each row runs in a process of its own. Wall time, CPU time and peak memory are those of this
process."""
import dataclasses
import hashlib
import importlib.metadata
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

import numpy as np

import sionna_setup
from sionna_greatx import Greatx
from sionna_paths import case_called

HERE = pathlib.Path(__file__).resolve().parent


def process(words, environment=None):
    """Returns (stdout, wall s, CPU s, peak MiB) of a program. The peak is at least that of this process, from
    which the child is forked. This is right for Sionna RT, which needs more memory. greatx states its own
    peak."""
    begin = time.perf_counter()
    with tempfile.TemporaryFile() as errors:
        child = subprocess.Popen(
            [str(w) for w in words],
            stdout=subprocess.PIPE,
            stderr=errors,
            env=os.environ | (environment or {}),
        )
        output = child.stdout.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            errors.seek(0)
            raise SystemExit(
                f"{' '.join(map(str, words))[:300]}: exit code {child.returncode}\n"
                + errors.read().decode(errors="replace")[-1000:]
            )
    return output, time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


class Table:
    def __init__(self, options):
        from sionna_referee import Referee
        from sionna_side import scene_file

        self.options = options
        self.program = sionna_setup.program(options)
        self.case = case_called("etoile")
        self.greatx = Greatx(self.program, options.work / "greatx", scene_file(self.case, options.work))
        self.referee = Referee(scene_file(self.case, options.work))
        self.receivers = self.referee.draw_receivers(dataclasses.replace(self.case, count=1000))
        self.results = {"load": [os.getloadavg()[0]]}

    def say(self, text=""):
        print(text, flush=True)

    def sionna(self, row, receivers, change=None, **settings):
        words = [
            sys.executable,
            HERE / "sionna_bench.py",
            row,
            json.dumps(
                {
                    "case": self.case.name,
                    "receivers": np.asarray(receivers).tolist(),
                    "change": change or {},
                    "work": str(self.options.work),
                }
                | settings
            ),
        ]
        output, wall, cpu, peak = process(words)
        return json.loads(output) | {"wall_s": wall, "cpu_s": cpu, "peak_mib": peak}

    def greatx_paths(self, count, cache, change=None, form="--brief"):
        """Runs a whole process: load, search, solve, print one line for each receiver (or everything with
        --json)."""
        case = dataclasses.replace(self.case, **(change or {}))
        words = [
            self.program,
            "paths",
            self.greatx.scenario(case, self.receivers[:1]),
            "--assets",
            self.greatx.scenes,
            "--receivers",
            self.greatx.points_file(case, self.receivers[:count]),
            form,
        ]
        folder = self.options.work / "cache"
        output, wall, cpu, peak = process(words, {"GREATX_CACHE": str(folder) if cache else "off"})
        return {"wall_s": wall, "cpu_s": cpu, "peak_mib": peak, "digest": hashlib.sha256(output).hexdigest()}

    def greatx_radio(self, count, change=None):
        case = dataclasses.replace(self.case, **(change or {}))
        output, *_ = process(
            [
                self.program,
                "bench",
                self.moving(case),
                "--assets",
                self.greatx.scenes,
                "--radio",
                "--json",
                "--many",
                count,
                "--row-seconds",
                1 if self.options.quick else 5,
            ]
        )
        return json.loads(output)

    def moving(self, case):
        """Writes the scenario with a moving receiver, which has a new place at every tick. Returns the
        file."""
        text = (
            self.greatx.scenario(case, self.receivers[:1]).read_text().replace("ticks: 1\n", "ticks: 100\n")
        )
        still = f"{{type: static, position_m: [{', '.join(repr(float(x)) for x in self.receivers[0])}]}}"
        assert still in text
        points = ", ".join(
            f"{{t_s: {2.5 * i}, position_m: [{', '.join(repr(float(x)) for x in p)}]}}"
            for i, p in enumerate(self.receivers[:5])
        )
        file = self.greatx.work / f"{case.name}_moving.yaml"
        file.write_text(text.replace(still, f"{{type: waypoints, points: [{points}]}}"))
        return file

    # ---- rows

    def machine(self):
        import drjit
        import mitsuba

        cpu = next(
            (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
            platform.machine(),
        )
        about = self.greatx_radio(1)
        self.results["about"] = {k: about[k] for k in ("device", "driver", "facets")}
        self.say(
            f"{os.cpu_count()} cores, {cpu}; load before: {os.getloadavg()[0]:.2f}. "
            f"greatx: {about['device']}, "
            f"{about['driver']}. Sionna RT {importlib.metadata.version('sionna-rt')}, "
            f"Mitsuba {mitsuba.__version__}, "
            f"Dr.Jit {drjit.__version__}, {os.environ['DRJIT_LIBLLVM_PATH'].split('/')[-1]}, "
            f"Python {platform.python_version()}."
        )
        self.say()
        return about

    def times(self):
        one = self.machine()
        walls = {"walls": 3}
        self.say("| etoile, depth 3, opaque walls | greatx | Sionna RT, 1e6 rays | Sionna RT, 1e7 rays |")
        self.say("|---|---|---|---|")
        repeat = 5 if self.options.quick else 20
        solves = [
            self.sionna("first", self.receivers[: repeat + 1], solve={"samples": s}, repeat=repeat)
            for s in (1e6, 1e7)
        ]
        cold, warm = self.greatx_paths(1, False), self.greatx_paths(1, True)
        warm = self.greatx_paths(1, True)
        self.say(
            f"| process start to first answer, nothing cached but Sionna RT's kernels "
            f"| {cold['wall_s']:.2f} s | "
            + " | ".join(f"{s['to_first_ms'] / 1e3:.2f} s" for s in solves)
            + " |"
        )
        self.say(f"| the same, greatx's search cached | {warm['wall_s']:.2f} s | – | – |")
        self.say(
            f"| one position after another, median "
            f"| {one['ticks']['reflection_transmission']['tick_ms']['median']:.2f} ms | "
            + " | ".join(f"{s['steady_ms']:.0f} ms" for s in solves)
            + " |"
        )
        self.say(
            f"| peak memory of that "
            f"| {one['ticks']['reflection_transmission']['peak_rss_bytes'] / 2**20:.0f} MiB | "
            + " | ".join(f"{s['peak_mib']:.0f} MiB" for s in solves)
            + " |"
        )
        self.results["one"] = {"greatx": one, "cold": cold, "warm": warm, "sionna": solves}
        for count in (100, 1000):
            ours = self.greatx_paths(count, True)
            inside = self.greatx_radio(count)["many"]
            theirs = [
                self.sionna("many", self.receivers[:count], solve={"samples": s})
                for s in ((1e6,) if self.options.quick or count > 100 else (1e6, 1e7))
            ]
            cells = " | ".join(
                f"{s['steady_ms'] / 1e3:.2f} s (process {s['to_first_ms'] / 1e3:.1f} s), "
                f"{s['peak_mib']:.0f} MiB, "
                f"{s['cpu_s']:.0f} s CPU"
                for s in theirs
            )
            self.say(
                f"| {count} receivers in one call | {inside['ms'] / 1e3:.3f} s "
                f"(process {ours['wall_s']:.2f} s), "
                f"{inside['peak_rss_bytes'] / 2**20:.0f} MiB, {ours['cpu_s']:.1f} s CPU "
                f"| {cells} |{' – |' if len(theirs) < 2 else ''}"
            )
            self.results[f"many_{count}"] = {"greatx": ours, "inside": inside, "sionna": theirs}
        ours = self.greatx_radio(1, walls)
        theirs = self.sionna(
            "first", self.receivers[: repeat + 1], walls, solve={"samples": 1e6}, repeat=repeat
        )
        self.say(
            f"| one position, walls of 0.1 m passed as well "
            f"| {ours['ticks']['reflection_transmission']['tick_ms']['median']:.2f} ms"
            f" | {theirs['steady_ms']:.0f} ms | – |"
        )
        for name, change, key in (("diffraction as well", {"walls": 3, "diffraction": True}, "diffraction"),):
            theirs = self.sionna(
                "first", self.receivers[: repeat + 1], change, solve={"samples": 1e6}, repeat=repeat
            )
            tick = ours["ticks"].get(key)
            cell = f"{tick['tick_ms']['median']:.1f} ms" if tick and tick["tick_ms"]["count"] else "–"
            self.say(f"| one position, {name} | {cell} | {theirs['steady_ms']:.0f} ms | – |")
        self.say()

    def completeness(self):
        from sionna_match import doubled_within, pair
        from sionna_side import Sionna

        case, receivers = self.case, self.receivers[: self.case.count]
        ours = self.greatx.paths(case, receivers)
        recall = self.greatx.recall(case, receivers)
        found = recall[0] if isinstance(recall, list) else recall
        self.say(
            f"Completeness, {len(receivers)} receivers: greatx has {len(ours)} paths; "
            f"its exhaustive reference says "
            f"{json.dumps(found['beams']['all'])}; doubled among its own: {doubled_within(ours)}."
        )
        self.say()
        self.say("| Sionna RT | missing | not there | doubled |")
        self.say("|---|---|---|---|")
        sionna = Sionna(case, self.options.work)
        runs = [
            ("1e5 rays, one receiver a call", True, {"samples": 1e5}),
            ("1e6 (its default), one a call", True, {"samples": 1e6}),
            ("1e6, one a call, deterministic=True", True, {"samples": 1e6, "deterministic": True}),
            ("1e7, one a call", True, {"samples": 1e7}),
            ("1e7 and a hash table of 1e7, one a call", True, {"samples": 1e7, "table": 1e7}),
            ("1e6, all in one call", False, {"samples": 1e6}),
            ("1e7, all in one call", False, {"samples": 1e7}),
            ("1e7 and a hash table of 1e7, all in one call", False, {"samples": 1e7, "table": 1e7}),
        ]
        self.results["completeness"] = {}
        for name, alone, settings in runs[:2] + runs[5:6] if self.options.quick else runs:
            theirs = (
                sionna.each_alone(receivers, **settings) if alone else sionna.paths(receivers, **settings)
            )
            _, missing, extra, doubled = pair(ours, theirs)
            absent = sum(self.referee.judge(p)["exists"] is False for p in missing)
            real = sum(self.referee.judge(p)["exists"] is not False for p in extra)
            note = (f" ({absent} of greatx's not confirmed)" if absent else "") + (
                f" ({real} that greatx lacks)" if real else ""
            )
            self.say(
                f"| {name} | {len(missing)} of {len(ours)}{note} | {len(extra) - real} | {len(doubled)} |"
            )
            self.results["completeness"][name] = [len(missing), len(extra), len(doubled)]
        self.say()

    def determinism(self, runs=10):
        runs = 3 if self.options.quick else runs
        receivers = self.receivers[:20]
        self.say(f"Determinism, {runs} processes, 20 receivers in one call: ")
        self.say()
        self.say("| | different bytes | different sets of paths | paths |")
        self.say("|---|---|---|---|")
        ours = {self.greatx_paths(20, False, form="--json")["digest"] for _ in range(runs)}
        threads = set()
        for n in ("1", "2"):
            os.environ["LP_NUM_THREADS"] = n
            threads.add(self.greatx_paths(20, False, form="--json")["digest"])
        del os.environ["LP_NUM_THREADS"]
        self.say(
            f"| greatx, 1 and 2 driver threads among them | {len(ours | threads)} | {len(ours | threads)} | |"
        )
        for name, settings in (
            ("Sionna RT", {"samples": 1e6}),
            ("Sionna RT, deterministic=True", {"samples": 1e6, "deterministic": True}),
        ):
            rows = [self.sionna("digest", receivers, solve=settings) for _ in range(runs)]
            counts = sorted({r["paths"] for r in rows})
            self.say(
                f"| {name} | {len({r['bytes'] for r in rows})} | {len({r['set'] for r in rows})} | "
                f"{counts[0]}{f' to {counts[-1]}' if len(counts) > 1 else ''} |"
            )
            self.results.setdefault("determinism", {})[name] = [len({r["bytes"] for r in rows}), counts]
        self.say()

    def maps(self):
        import sionna_map

        sionna_map.rows(self)


def main(options):
    begin = time.perf_counter()
    table = Table(options)
    table.times()
    table.completeness()
    table.determinism()
    table.maps()
    table.results["load"].append(os.getloadavg()[0])
    table.say(
        f"Load of the machine before and after: {table.results['load'][0]:.2f}, "
        f"{table.results['load'][1]:.2f}; "
        f"{(time.perf_counter() - begin) / 60:.0f} minutes for all of it."
    )
    if options.json:
        options.json.write_text(json.dumps(table.results, indent=1, default=str))
    return 0
