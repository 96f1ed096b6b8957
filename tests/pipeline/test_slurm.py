#!/usr/bin/env python3
# SPDX-License-Identifier: AGPL-3.0-or-later
"""A campaign as an array of jobs on a Slurm that the test starts: a task is killed, the array is
submitted again, and the merged curves have the bits of those computed without Slurm.

Usage: slurm_test.py PALPATE SUBMIT. Needs munged, slurmctld and slurmd (Debian's packages) and root.
"""
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bodies import write_case  # noqa: E402

PALPATE = SUBMIT = None
PATIENCE = 120  # s, for a queue on a busy machine
PARTS = 3
DAEMONS = ("munged", "slurmctld", "slurmd")

CONFIGURATION = """ClusterName=palpate
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={root}/munge.socket
CredType=cred/munge
StateSaveLocation={root}/state
SlurmdSpoolDir={root}/spool
SlurmctldPidFile={root}/slurmctld.pid
SlurmdPidFile={root}/slurmd.pid
SlurmctldLogFile={root}/slurmctld.log
SlurmdLogFile={root}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
ReturnToService=2
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """munge, the controller and one node, with all files in one folder."""

    def __init__(self, root):
        self.root = root
        host = socket.gethostname().split(".")[0]
        text = CONFIGURATION.format(host=host, root=root, controller=free_port(), node=free_port())
        self.configuration = root / "slurm.conf"
        self.configuration.write_text(text, encoding="ascii")
        # cgroup version 1, unused here: the search for version 2 fails in a bare chroot.
        (root / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n", encoding="ascii")
        (root / "state").mkdir()
        (root / "spool").mkdir()
        key = root / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.environment = dict(os.environ, SLURM_CONF=str(self.configuration), PALPATE=str(PALPATE))
        self.daemons = []
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={root}/munge.socket",
                   f"--pid-file={root}/munged.pid", f"--seed-file={root}/munged.seed",
                   f"--log-file={root}/munged.log")
        self.start("slurmctld", "-D", "-f", self.configuration)
        self.start("slurmd", "-D", "-f", self.configuration)

    def start(self, name, *arguments):
        with open(self.root / f"{name}.out", "wb") as log:
            self.daemons.append(subprocess.Popen([shutil.which(name), *map(str, arguments)], stdout=log,
                                                 stderr=subprocess.STDOUT, env=self.environment))

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def run(self, *command):
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False,
                              env=self.environment)

    def logs(self):
        return "\n".join(f"== {log.name}\n{log.read_text(errors='replace')[-2000:]}"
                         for log in sorted(self.root.glob("*.log")) + sorted(self.root.glob("*.out")))

    def wait_until(self, condition, what, pause=0.5):
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"{what} did not come to pass:\n{self.logs()}")
            time.sleep(pause)

    def state_of(self, job):
        """PENDING, RUNNING, ..., also for finished jobs; empty when the controller does not answer."""
        found = re.search(r"JobState=(\w+)", self.run("scontrol", "show", "job", job).stdout)
        return found.group(1) if found else ""


@unittest.skipUnless(os.geteuid() == 0, "Slurm's daemons are started by root")
class Slurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        missing = [name for name in DAEMONS if not shutil.which(name)]
        assert not missing, f"{missing} not installed: run scripts/setup"
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = Path(cls.folder.name)
        (root / "cluster").mkdir()
        cls.cluster = Cluster(root / "cluster")
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.wait_until(lambda: "idle" in cls.cluster.run("sinfo", "-h", "-o", "%t").stdout,
                               "an idle node")
        cls.case = write_case(root)
        cls.out = root / "out"

    def submit(self):
        done = self.cluster.run(SUBMIT, self.case, self.out, PARTS)
        self.assertEqual(done.returncode, 0, done.stderr)
        return re.search(r"array (\d+), merge (\d+)", done.stdout).groups()

    def digest(self, file):
        done = subprocess.run([PALPATE, "inspect", file, "--json"], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["content_sha256"]

    def finished(self, job, wanted):
        self.cluster.wait_until(lambda: self.cluster.state_of(job) in ("COMPLETED", "FAILED", "CANCELLED", "NODE_FAIL"),
                                f"the end of job {job}")
        self.assertEqual(self.cluster.state_of(job), wanted, self.cluster.logs())

    def kill_process_of(self, shard):
        """Kills the program of the task, as the out-of-memory killer does."""
        def found():
            for folder in Path("/proc").glob("[0-9]*"):
                try:
                    words = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
                except OSError:
                    continue  # it has finished
                if shard in words and str(self.out) in words and words[1] == "precompute":
                    os.kill(int(folder.name), signal.SIGKILL)
                    return True
            return False
        self.cluster.wait_until(found, f"the program of part {shard}", pause=0.02)

    def test_a_killed_task_is_made_up_for_and_the_bits_are_the_same(self):
        array, merge = self.submit()
        victim = f"{array}_2"
        self.kill_process_of("2/3")
        self.finished(victim, "FAILED")
        self.finished(merge, "CANCELLED")
        self.assertFalse((self.out / "curves.h5").exists())
        self.assertFalse((self.out / f"curves.2-of-{PARTS}.h5").exists())

        array, merge = self.submit()
        self.finished(merge, "COMPLETED")
        log = (self.out / "slurm" / "part-1.log").read_text()
        self.assertIn("is up to date", log)

        alone = self.out.parent / "alone"
        alone.mkdir()
        shutil.copy(self.out / "body.h5", alone)
        done = subprocess.run([PALPATE, "precompute", self.case, "--out", alone], capture_output=True, text=True,
                              check=False)
        self.assertIn(done.returncode, (0, 4), done.stderr)
        self.assertEqual(self.digest(self.out / "curves.h5"), self.digest(alone / "curves.h5"))

    def test_submit_says_how_it_is_used(self):
        for arguments in ((), ("case.toml", "out"), ("case.toml", "out", "many")):
            done = self.cluster.run(SUBMIT, *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn("CASE OUT N", done.stderr)


if __name__ == "__main__":
    SUBMIT = Path(sys.argv.pop(2)).resolve()
    PALPATE = Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
