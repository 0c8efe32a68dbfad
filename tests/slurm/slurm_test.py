#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Runs a campaign on a real Slurm of its own and disturbs it; what is merged must have a single run's bytes.

    apt-get install --no-install-recommends slurmctld slurmd slurm-client munge
    python3 tests/slurm/slurm_test.py --program build/release/greatx

It needs root, since Slurm starts jobs for users and the full disk is a file system of its own. It starts
munged, slurmctld and two slurmd with keys, ports and folders of their own, so that no Slurm of this machine
is touched, and ends them. Each case below has its own output folder, and names what it does to the jobs.
Exit code 0: all cases hold; 1: a fault, which is printed. --only CASE runs some of them, --keep keeps the
folder.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from cluster import Cluster

SCENARIO = """greatx: 1
name: base
seed: 4
ticks: {ticks}
tick_rate_hz: 10
scene: {{generate: {{kind: canyon, seed: 3, size_m: 60}}}}
nodes:
  - name: bs
    trajectory: {{type: static, position_m: [1, -20, 6]}}
    sensors: [{{name: a, type: antenna}}]
  - name: uav
    trajectory: {{type: bezier, box: {{min_m: [-3, -15, 3], max_m: [3, 15, 8]}}, offset_m: [1, 1, 1]}}
    sensors:
      - {{name: a, type: antenna}}
      - {{name: cam, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, outputs: [rgb, depth]}}
channels:
  - {{name: csi, tx: bs/a, rx: [uav/a], rate_hz: 10, carrier_hz: 3.5e9, bandwidth_hz: 20e6, subcarriers: 16,
      max_depth: 2}}
"""
CAMPAIGN = """greatx_campaign: 1
name: streets
base: base.yaml
sequences: 3
axes:
  light:
    day: {}
    night:
      environment: {sun: {elevation_deg: -20}, sky_illuminance_lux: 0.4}
  carrier:
    low: {}
    high:
      channels[csi].carrier_hz: 4.5e9
"""


class Failure(Exception):
    pass


def expect(condition: bool, message: str) -> None:
    if not condition:
        raise Failure(message)


def hashes(output: pathlib.Path, resumed: bool) -> dict[str, str]:
    """Returns the SHA-256 of every file of the data sets, the splits and the index. What compares the sensors
    (consistency.csv) is left out after a resumed run: it begins where the run went on, as docs/dataset.md
    says."""
    files = [file for file in (output / "data").rglob("*") if file.is_file()]
    files += [output / "splits.csv", output / "index.csv"]
    return {
        str(file.relative_to(output)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in files
        if not (resumed and file.name == "consistency.csv")
    }


class Campaign:
    """Writes, submits and watches the jobs of one output folder."""

    def __init__(self, bench: "Bench", name: str, *options: str, output: pathlib.Path | None = None):
        # The name is hard to quote for bash and for Slurm.
        self.bench, self.output = bench, output or bench.folder / f"{name} \"of\" 'x' 50% #1"
        self.script, self.logs = self.output / "job.sh", self.output / "logs"
        if "--logs" in options:
            self.logs = pathlib.Path(options[options.index("--logs") + 1])
        bench.greatx("campaign", "slurm", "c.yaml", "-o", str(self.output), "--cpus", "1", *options)
        self.array = self.merge = ""

    def submit(self) -> None:
        said = self.bench.command("bash", str(self.script))
        found = re.search(r"as job (\d+), and their merge as job (\d+)", said)
        expect(found is not None, f"the script said {said!r}")
        self.array, self.merge = found[1], found[2]

    def task_states(self) -> dict[str, dict[str, str]]:
        return self.bench.cluster.jobs(self.array)

    def running(self) -> list[str]:
        return [task for task, job in self.task_states().items() if job["JobState"] == "RUNNING"]

    def processes(self, task: str = "") -> list[int]:
        """Returns the processes of greatx that belong to the array, or to one of its tasks."""
        wanted = [f"SLURM_ARRAY_JOB_ID={self.array}"] + ([f"SLURM_ARRAY_TASK_ID={task}"] if task else [])
        return [
            pid
            for pid, program in self.bench.cluster.processes(*wanted).items()
            if program == str(self.bench.program)
        ]

    def wait(self, what: str, condition, limit_s: float = 600) -> None:
        end = time.monotonic() + limit_s
        while not condition():
            expect(time.monotonic() < end, f"{what}: not within {limit_s:g} s\n{self.log()}")
            time.sleep(0.3)

    def wait_for_merge(self) -> str:
        """Returns the state in which the merge ends."""
        ended = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL")
        state = lambda: self.bench.cluster.jobs(self.merge)[""]["JobState"]
        self.wait("the merge", lambda: state() in ended)
        return state()

    def log(self) -> str:
        return "".join(f"--- {f.name}\n{f.read_text()}" for f in sorted(self.logs.glob("*.out")))

    def restarts(self) -> int:
        return sum(int(job["Restarts"]) for job in self.task_states().values())

    def finish(self, resumed: bool = True) -> None:
        """Waits for the end and compares the bytes with those of the single run."""
        state = self.wait_for_merge()
        expect(state == "COMPLETED", f"the merge has ended as {state}\n{self.log()}")
        expect("4 cells are complete and sound" in self.log(), f"verify has not passed\n{self.log()}")
        expected, found = self.bench.single(resumed), hashes(self.output, resumed)
        names = sorted(n for n in {*expected, *found} if expected.get(n) != found.get(n))
        expect(not names, f"{len(names)} files differ from those of the single run: {names[:5]}")
        self.bench.say(f"  {len(found)} files have the bytes of the single run")


class Bench:
    def __init__(self, program: pathlib.Path, folder: pathlib.Path, cluster: Cluster, ticks: int, kills: int):
        self.program, self.folder, self.cluster, self.kills = program, folder, cluster, kills
        self.random = random.Random(5)
        (folder / "base.yaml").write_text(SCENARIO.format(ticks=ticks))
        (folder / "c.yaml").write_text(CAMPAIGN)

    @staticmethod
    def say(text: str) -> None:
        print(text, flush=True)

    def command(self, *words: str) -> str:
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, env=self.cluster.env)
        expect(done.returncode == 0, f"{words}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    def greatx(self, *words: str) -> str:
        return self.command(str(self.program), *words)

    def make_single(self) -> None:
        """Runs the campaign in one process, and one of its cells by `greatx generate`."""
        begin = time.monotonic()
        self.greatx("campaign", "run", "c.yaml", "-o", "single", "-q")
        self.say(f"single run: {time.monotonic() - begin:.0f} s")
        self.greatx("campaign", "merge", "c.yaml", "-o", "single", "-q")
        cell = self.folder / "single/data/night.high"
        self.greatx("generate", str(cell / "scenario.yaml"), "-o", "generated", "-q")
        self.command("diff", "-r", str(cell), "generated")

    def single(self, resumed: bool) -> dict[str, str]:
        return hashes(self.folder / "single", resumed)

    # Cases. Each is a method; its docstring says what holds.

    def plain(self) -> None:
        """Four tasks on two nodes, with time limits that greatx has measured."""
        campaign = Campaign(self, "plain")
        campaign.submit()
        campaign.finish(resumed=False)
        expect(campaign.restarts() == 0, "a task was restarted")

    def killed(self) -> None:
        """greatx is killed by SIGKILL and tasks are requeued by hand, in turns, at random moments."""
        campaign = Campaign(self, "killed", "--time", "10", "--restarts", "50")
        campaign.submit()
        kills = requeues = 0
        while kills + requeues < self.kills and self.unfinished(campaign):
            campaign.wait("a task", lambda: campaign.processes() or not self.unfinished(campaign))
            time.sleep(self.random.uniform(0.1, 4.0))
            running = campaign.running()
            if not running:
                continue
            task = self.random.choice(running)
            if kills <= requeues:
                victims = campaign.processes(task)
                for pid in victims:
                    self.cluster.kill(pid)
                kills += bool(victims)
            else:
                requeues += self.cluster.requeue(f"{campaign.array}_{task}")
            self.wait_for_start(campaign)
        self.say(f"  {kills} kills, {requeues} requeues")
        expect(kills >= 2 and requeues >= 2, "the run was too short to be disturbed")
        campaign.finish()
        expect(campaign.restarts() >= kills + requeues - 1, f"only {campaign.restarts()} restarts")

    @staticmethod
    def unfinished(campaign: Campaign) -> bool:
        states = ("PENDING", "RUNNING", "COMPLETING")
        return any(job["JobState"] in states for job in campaign.task_states().values())

    def wait_for_start(self, campaign: Campaign) -> None:
        campaign.wait("a start", lambda: campaign.running() or not self.unfinished(campaign))

    def node_lost(self) -> None:
        """All processes of a node vanish and Slurm marks it down; its task goes on at the other node."""
        campaign = Campaign(self, "node", "--tasks", "2", "--time", "10")
        campaign.submit()
        campaign.wait("both tasks", lambda: len(campaign.processes()) == 2)
        time.sleep(self.random.uniform(2.0, 5.0))
        lost = [task for task, job in campaign.task_states().items() if job.get("BatchHost") == "n2"]
        expect(len(lost) == 1, f"tasks {lost} are on n2")
        self.cluster.lose_node("n2")
        campaign.finish()
        job = campaign.task_states()[lost[0]]
        expect(job["BatchHost"] == "n1" and int(job["Restarts"]) == 1, f"task {lost[0]}: {job}")
        self.say(f"  task {lost[0]} went on at n1")
        self.cluster.start_node("n2")

    def time_limit(self) -> None:
        """The time limit comes; the task ends in time by itself and goes on."""
        campaign = Campaign(self, "limit", "--tasks", "1", "--time", "2")
        campaign.submit()
        campaign.wait("the task", campaign.running)
        self.cluster.control("update", f"jobid={campaign.array}_1", "timelimit=1")
        campaign.finish()
        count = campaign.log().count("the time limit of the task is near; it goes on in its next run")
        expect(count >= 1 and campaign.restarts() == count, f"{count} limits, {campaign.restarts()} restarts")
        expect("interrupted: " in campaign.log(), "greatx was not interrupted")
        self.say(f"  {count} time limits")

    def bounded(self) -> None:
        """A task that is killed more often than --restarts ends, and so does the merge."""
        campaign = Campaign(self, "bounded", "--tasks", "1", "--time", "10", "--restarts", "1")
        campaign.submit()
        for _ in range(2):
            campaign.wait("greatx", lambda: campaign.processes() and campaign.running())
            time.sleep(1.0)
            victims = campaign.processes()
            for pid in victims:
                self.cluster.kill(pid)
            campaign.wait("the end of greatx", lambda v=victims: not set(v) & set(campaign.processes()))
        expect(campaign.wait_for_merge() == "CANCELLED", "the merge was not cancelled")
        expect("it has been restarted 1 times and is not again" in campaign.log(), campaign.log())
        expect(campaign.task_states()["1"]["JobState"] == "FAILED", str(campaign.task_states()))
        campaign.submit()
        campaign.finish()

    def cancelled(self) -> None:
        """scancel ends the tasks, which are not requeued; the script goes on when it is submitted again."""
        campaign = Campaign(self, "cancelled", "--time", "10")
        campaign.submit()
        campaign.wait("two tasks", lambda: len(campaign.processes()) == 2)
        time.sleep(self.random.uniform(0.5, 3.0))
        self.command("scancel", campaign.array)
        expect(campaign.wait_for_merge() == "CANCELLED", "the merge was not cancelled")
        campaign.wait("the end", lambda: not campaign.processes())
        expect(campaign.restarts() == 0, "a task was restarted")
        campaign.submit()
        campaign.finish()

    def full_disk(self) -> None:
        """A full disk fails the tasks once; with more room the script goes on."""
        disk, logs = self.folder / "disk", self.folder / "logs of the full disk"
        disk.mkdir()
        size = sum(f.stat().st_size for f in (self.folder / "single/data").rglob("*") if f.is_file())
        self.command("mount", "-t", "tmpfs", "-o", f"size={size // 3}", "tmpfs", str(disk))
        try:
            campaign = Campaign(self, "full", "--time", "10", "--logs", str(logs), output=disk / "out")
            campaign.submit()
            expect(campaign.wait_for_merge() == "CANCELLED", "the merge was not cancelled")
            campaign.wait("the tasks", lambda: not self.unfinished(campaign))
            failed = [job for job in campaign.task_states().values() if job["JobState"] == "FAILED"]
            expect(failed and all(job["ExitCode"] == "1:0" for job in failed), str(campaign.task_states()))
            expect(campaign.restarts() == 0, "a task was restarted")
            expect("No space left on device" in campaign.log(), campaign.log())
            self.say(f"  {len(failed)} tasks have failed with exit code 1")
            self.command("mount", "-o", "remount,size=4g", str(disk))
            campaign.submit()
            campaign.finish()
        finally:
            subprocess.run(["umount", str(disk)], check=False)


def main() -> int:
    cases = ["plain", "killed", "node_lost", "time_limit", "bounded", "cancelled", "full_disk"]
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", required=True, type=pathlib.Path, help="the program greatx")
    parser.add_argument("--only", nargs="+", choices=cases, default=cases, help="run these cases alone")
    parser.add_argument("--ticks", type=int, default=1500, help="length of a sequence")
    parser.add_argument("--kills", type=int, default=8, help="disturbances of the case 'killed'")
    parser.add_argument("--keep", action="store_true", help="keep the folder")
    options = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="greatx_slurm_"))
    try:
        with Cluster(folder / "slurm") as cluster:
            bench = Bench(options.program.resolve(), folder, cluster, options.ticks, options.kills)
            bench.make_single()
            for case in options.only:
                begin = time.monotonic()
                bench.say(f"{case}: {getattr(bench, case).__doc__}")
                getattr(bench, case)()
                bench.say(f"  {time.monotonic() - begin:.0f} s")
    except (Failure, RuntimeError) as failure:
        print(f"failed: {failure}")
        return 1
    finally:
        if options.keep:
            print(f"the files are in {folder}")
        else:
            shutil.rmtree(folder, ignore_errors=True)
    print(f"{len(options.only)} cases hold")
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    os.umask(0o022)
    sys.exit(main())
