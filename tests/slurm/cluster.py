# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A Slurm of the test's own: munged, slurmctld and two slurmd, all on this machine and in one folder."""

from __future__ import annotations

import os
import pathlib
import re
import secrets
import shutil
import signal
import socket
import subprocess
import time

CONFIGURATION = """ClusterName=greatx
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser=root
AuthType=auth/munge
# A requeued job waits until its credential is old.
AuthInfo=socket={folder}/munge/socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdSpoolDir={folder}/spool/%n
SlurmdPidFile={folder}/%n.pid
SlurmdParameters=config_overrides
# Containers need not have control groups.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=1,sched_interval=2,bf_interval=2
SwitchType=switch/none
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
KillWait=5
MinJobAge=86400
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    def __init__(self, folder: pathlib.Path):
        if os.geteuid() != 0:
            raise RuntimeError("this test needs root")
        for program in ("munged", "slurmctld", "slurmd", "sbatch"):
            if shutil.which(program) is None:
                raise RuntimeError(f"{program} is missing: install slurmctld slurmd slurm-client munge")
        self.folder = folder
        # No setting of another Slurm, or of a job in which this test runs, may reach it.
        others = ("SLURM", "SBATCH", "SALLOC", "SQUEUE")
        self.env = {name: value for name, value in os.environ.items() if not name.startswith(others)}
        self.env["SLURM_CONF"] = str(folder / "slurm.conf")
        self.daemons: dict[str, subprocess.Popen] = {}

    def __enter__(self) -> "Cluster":
        for name in ("munge", "state", "spool/n1", "spool/n2"):
            (self.folder / name).mkdir(parents=True)
        munge = self.folder / "munge"
        key = munge / "key"
        key.touch(mode=0o600)
        key.write_bytes(secrets.token_bytes(1024))
        host = socket.gethostname().partition(".")[0]
        (self.folder / "slurm.conf").write_text(
            CONFIGURATION.format(host=host, folder=self.folder, ports=free_ports(3))
        )
        try:
            names = ("key-file", "socket", "pid-file", "log-file", "seed-file")
            files = [f"--{name}={munge / name.partition('-')[0]}" for name in names]
            self.start("munged", "munged", "--force", "--foreground", *files)
            self.wait("munged", (munge / "socket").exists)
            self.start("slurmctld", "slurmctld", "-D")
            for node in ("n1", "n2"):
                self.start_node(node)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        for name in reversed(list(self.daemons)):
            self.end(name, signal.SIGTERM)
        for pid in self.processes(f"SLURM_CONF={self.env['SLURM_CONF']}"):
            self.kill(pid)

    def start(self, name: str, *command: str) -> None:
        log = open(self.folder / f"{name}.log", "ab")
        self.daemons[name] = subprocess.Popen(
            command, env=self.env, stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=self.folder
        )

    def end(self, name: str, by: signal.Signals) -> None:
        daemon = self.daemons.pop(name)
        daemon.send_signal(by)
        try:
            daemon.wait(20)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()

    def wait(self, what: str, condition) -> None:
        for _ in range(300):
            if condition():
                return
            time.sleep(0.2)
        logs = "".join(f.read_text(errors="replace")[-2000:] for f in self.folder.glob("*.log"))
        raise RuntimeError(f"{what} does not start:\n{logs}")

    def run(self, *command: str) -> subprocess.CompletedProcess:
        return subprocess.run(command, env=self.env, capture_output=True, text=True, check=False)

    def control(self, *words: str) -> str:
        done = self.run("scontrol", *words)
        if done.returncode != 0:
            raise RuntimeError(f"scontrol {' '.join(words)}: {done.stderr}")
        return done.stdout

    def start_node(self, node: str) -> None:
        self.start(node, "slurmd", "-D", "-N", node)
        self.wait(node, lambda: self.run("sinfo", "-h", "-n", node, "-o", "%t").stdout.strip() == "idle")

    def lose_node(self, node: str) -> None:
        """Kills the node's slurmd and every process of its jobs, and says that it is down."""
        self.end(node, signal.SIGKILL)
        for pid in self.processes(f"SLURMD_NODENAME={node}"):
            parent = re.search(r"^PPid:\s*(\d+)", self.read(pid, "status"), re.MULTILINE)
            if parent and "slurmstepd" in self.read(int(parent[1]), "cmdline"):
                self.kill(int(parent[1]))
            self.kill(pid)
        self.control("update", f"nodename={node}", "state=down", "reason=lost")

    def requeue(self, job: str) -> bool:
        return self.run("scontrol", "requeue", job).returncode == 0

    def jobs(self, number: str) -> dict[str, dict[str, str]]:
        """Returns what Slurm knows of a job by the tasks of its array; "" is the task of a single job, and
        "1-4" stands for tasks that have not begun."""
        jobs = {}
        for line in self.control("show", "job", "-o", number).splitlines():
            fields = dict(word.partition("=")[::2] for word in line.split() if "=" in word)
            jobs[fields.get("ArrayTaskId", "")] = fields
        return jobs

    @staticmethod
    def read(pid: int, name: str) -> str:
        try:
            return pathlib.Path(f"/proc/{pid}/{name}").read_text(errors="replace")
        except OSError:  # it has ended meanwhile
            return ""

    def processes(self, *variables: str) -> dict[int, str]:
        """Returns the program of each process that has these environment variables and is of this Slurm."""
        wanted = {*variables, f"SLURM_CONF={self.env['SLURM_CONF']}"}
        found = {}
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit() or int(entry.name) == os.getpid():
                continue
            pid = int(entry.name)
            if wanted <= set(self.read(pid, "environ").split("\0")):
                found[pid] = self.read(pid, "cmdline").partition("\0")[0]
        return found

    @staticmethod
    def kill(pid: int) -> None:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
