#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Collections through a real Slurm on this machine: a four-task array, one task killed and requeued, and ten
tasks where an array holds four at most; the merge and the verification after them, and the bytes of a run by
one process.

    python3 tests/cluster/slurm_test.py BUILD_FOLDER [--install] [--episodes N] [--doors DOORS ...]

Starts munged, slurmctld and slurmd of its own, with a key, ports and folders of their own, and ends them.
Skipped, with the reason, where this user is not root or Debian's slurm-wlm and munge are not installed;
--install, or DOORFORGE_INSTALL_SLURM=1, installs them. Without --doors three are composed.
"""
import argparse
import filecmp
import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

parser = argparse.ArgumentParser()
parser.add_argument("build_folder", type=pathlib.Path)
parser.add_argument("--install", action="store_true")
parser.add_argument("--episodes", type=int, default=64)
parser.add_argument("--doors", nargs="+", default=os.environ.get("DOORFORGE_TEST_DOORS", "").split())
options, sys.argv[1:] = parser.parse_known_args()
INSTALL = options.install or os.environ.get("DOORFORGE_INSTALL_SLURM") == "1"
BINARY_DIR = options.build_folder.resolve()
DOORFORGE = BINARY_DIR / "bin/doorforge"
PROGRAMS = ["slurmctld", "slurmd", "munged", "sbatch", "scontrol", "squeue"]
EPISODES, TASKS = options.episodes, 4
ARRAY_SIZE = 4  # Slurm's MaxArraySize, 1001 by default
PER_SHARD = 8 if EPISODES < 1000 else 128
PATIENCE = 400 + 2 * EPISODES  # [s]
BODIES = ["interior_flush_01", "interior_four_panel_02", "interior_framed_02"]
HANDLE = "interior_lever_tube_02"


def missing_programs() -> list[str]:
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    return [name for name in PROGRAMS if shutil.which(name, path=path) is None]


def install() -> None:
    subprocess.run(["apt-get", "install", "-y", "--no-install-recommends", "slurm-wlm", "munge"],
                   check=True, capture_output=True)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


def wait_for(condition, seconds: float, what: str):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        answer = condition()
        if answer:
            return answer
        time.sleep(0.1)
    raise AssertionError(f"{what}: not within {seconds:.0f} s")


class Slurm:
    """Slurm with this machine as its only node."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self.processes: list[subprocess.Popen] = []
        for name in ("state", "spool", "munge"):
            (folder / name).mkdir()
        os.chmod(folder, 0o755)
        os.chmod(folder / "munge", 0o755)
        key = folder / "munge/key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o600)
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"),
                                PATH=os.environ["PATH"] + ":/usr/sbin:/sbin")
        for name in list(self.environment):
            if name.startswith("SLURM_") and name != "SLURM_CONF":
                del self.environment[name]
        self.write_config()

    def write_config(self) -> None:
        host = socket.gethostname().split(".")[0]
        folder = self.folder
        (folder / "slurm.conf").write_text(f"""ClusterName=doorforge
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
KillWait=5
MaxArraySize={ARRAY_SIZE}
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")

    def start(self) -> None:
        munge = self.folder / "munge"
        self.spawn("munged", "--foreground", "--force", f"--socket={munge}/socket",
                   f"--key-file={munge}/key", f"--pid-file={munge}/pid", f"--log-file={munge}/log",
                   f"--seed-file={munge}/seed")
        wait_for((munge / "socket").exists, 20, "munged")
        self.spawn("slurmctld", "-D", "-c")
        self.spawn("slurmd", "-D")
        wait_for(lambda: "idle" in self.run("sinfo", "-h", "-o", "%t", check=False), 60, "the node")

    def spawn(self, name: str, *arguments: str) -> None:
        program = shutil.which(name, path=self.environment["PATH"])
        with open(self.folder / f"{name}.log", "wb") as log:
            self.processes.append(subprocess.Popen([program, *arguments], env=self.environment,
                                                   stdout=log, stderr=subprocess.STDOUT))

    def stop(self) -> None:
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def run(self, *command: str, check: bool = True) -> str:
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        if check and done.returncode != 0:
            raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def state(self, job: str) -> str:
        words = self.run("scontrol", "-o", "show", "job", job, check=False).split()
        return next((word.split("=")[1] for word in words if word.startswith("JobState=")), "")

    def processes_of(self, job_and_task: str) -> list[int]:
        """Our programs that run for a task."""
        job, task = job_and_task.split("_")
        found = []
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                environment = (folder / "environ").read_bytes()
                program = os.readlink(folder / "exe")
            except OSError:
                continue
            if (program.startswith(str(BINARY_DIR)) and f"SLURM_ARRAY_JOB_ID={job}\0".encode() in environment
                    and f"SLURM_ARRAY_TASK_ID={task}\0".encode() in environment):
                found.append(int(folder.name))
        return found


class SlurmTest(unittest.TestCase):
    def setUp(self) -> None:
        if os.geteuid() != 0:
            self.skipTest("needs root to start slurmd")
        if missing_programs() and INSTALL:
            install()
        if missing_programs():
            self.skipTest(f"{', '.join(missing_programs())} not installed; apt-get install slurm-wlm munge, "
                          "or DOORFORGE_INSTALL_SLURM=1")
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="doorforge_slurm_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.doors = [str(pathlib.Path(name).resolve()) if os.path.exists(name) else name
                      for name in options.doors] or [self.compose_doors()]
        slurm_folder = self.folder / "slurm"
        slurm_folder.mkdir()
        self.slurm = Slurm(slurm_folder)
        self.addCleanup(self.slurm.stop)
        try:
            self.slurm.start()
        except AssertionError:
            for log in slurm_folder.glob("*.log"):
                print(log.name, log.read_text(errors="replace")[-2000:], file=sys.stderr)
            raise

    def doorforge(self, *arguments: object) -> subprocess.CompletedProcess:
        done = subprocess.run([DOORFORGE, *map(str, arguments)], env=self.slurm.environment if hasattr(
            self, "slurm") else None, capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 0, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def compose_doors(self) -> str:
        for body in BODIES:
            self.doorforge("compose", "--body", body, "--handle", HANDLE, "--out", self.folder / "doors" / body)
        return str(self.folder / "doors")

    def collection(self, name: str) -> list[object]:
        return ["datagen", "open", "--doors", *self.doors, "--out", self.folder / name, "--episodes", EPISODES,
                "--seed", 7, "--set", f"collection.episodes_per_shard={PER_SHARD}", "-j", 1]

    def test_an_array_with_a_requeued_task_gives_the_bytes_of_one_process(self) -> None:
        submitted = self.doorforge(*self.collection("array"), "--slurm", "array.sh", "--tasks", TASKS, "--submit",
                                   "--slurm-memory", 0)
        words = submitted.stdout.split()
        self.assertEqual(words[::2], ["tasks", "merge", "verify"], submitted.stdout)
        array, merge, verify = words[1::2]

        # a task that has written is stopped, queued again and killed: no orderly end
        def writing_task() -> str:
            for task in range(TASKS):
                name = f"{array}_{task}"
                if self.slurm.processes_of(name) and any((self.folder / "array").rglob("*.partial")):
                    return name
            return ""

        victim = wait_for(writing_task, PATIENCE, "a task that writes")
        time.sleep(1)
        victims = self.slurm.processes_of(victim)
        for process in victims:
            os.kill(process, signal.SIGSTOP)
        self.slurm.run("scontrol", "requeue", victim)
        for process in victims:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        print(f"killed and requeued task {victim}", file=sys.stderr)

        wait_for(lambda: self.slurm.state(verify) in ("COMPLETED", "FAILED", "CANCELLED") or
                 self.slurm.state(merge) in ("FAILED", "CANCELLED"), PATIENCE, "the verification")
        logs = "\n".join(f"{log.name}: {log.read_text(errors='replace')[-600:]}"
                         for log in sorted((self.folder / "array.slurm").iterdir()))
        self.assertEqual(self.slurm.state(merge), "COMPLETED", logs)
        self.assertEqual(self.slurm.state(verify), "COMPLETED", logs)
        requeued = self.slurm.run("scontrol", "-o", "show", "job", victim)
        self.assertIn("Restarts=1", requeued)
        self.assertIn("no faults", logs)
        # one job array of four, not more
        self.assertEqual(len(list((self.folder / "array.slurm").glob("task-*.log"))), TASKS)

        self.doorforge(*self.collection("single"))
        self.assert_same(self.folder / "single", self.folder / "array")

    def test_more_tasks_than_an_array_holds_become_several_arrays(self) -> None:
        tasks = 10
        small = ["datagen", "open", "--doors", *self.doors, "--episodes", 2 * tasks, "--seed", 7, "-j", 1, "--set",
                 "collection.episodes_per_shard=2", "--set", "cloud.point_count=64", "--set", "preview=false"]
        script = ["--slurm", "arrays.sh", "--tasks", tasks, "--submit", "--slurm-memory", 0]
        # as where the cluster's arrays are smaller than Slurm's default
        refused = subprocess.run([DOORFORGE, *map(str, small), "--out", self.folder / "arrays", *map(str, script)],
                                 env=self.slurm.environment, capture_output=True, text=True, cwd=self.folder)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("Invalid job array specification", refused.stderr)
        self.assertIn("sbatch refused a job", refused.stderr)
        self.assertEqual(self.slurm.run("squeue", "-h"), "")

        (self.folder / "arrays.sh").unlink()  # a script that says something else is not replaced unasked
        submitted = self.doorforge(*small, "--out", self.folder / "arrays", *script, "--slurm-array", ARRAY_SIZE)
        words = submitted.stdout.split()
        self.assertEqual([words[0], *words[4::2]], ["tasks", "merge", "verify"], submitted.stdout)
        arrays, merge, verify = words[1:4], words[5], words[7]
        wait_for(lambda: self.slurm.state(verify) in ("COMPLETED", "FAILED", "CANCELLED") or
                 self.slurm.state(merge) in ("FAILED", "CANCELLED"), PATIENCE, "the verification")
        logs = {log.name: log.read_text(errors="replace") for log in (self.folder / "arrays.slurm").iterdir()}
        self.assertEqual([self.slurm.state(merge), self.slurm.state(verify)], ["COMPLETED"] * 2, logs)
        self.assertEqual({name for name in logs if name.startswith("task-")},
                         {f"task-{array}_{i}.log" for array, count in zip(arrays, (4, 4, 2)) for i in range(count)})
        for array, first in zip(arrays, (0, 4, 8)):
            self.assertIn(f"task {first}/{tasks}: 1 shards", logs[f"task-{array}_0.log"])
        self.assertIn("no faults", logs[f"verify-{verify}.log"])

        self.doorforge(*small, "--out", self.folder / "single")
        self.assert_same(self.folder / "single", self.folder / "arrays")

    def assert_same(self, a: pathlib.Path, b: pathlib.Path) -> None:
        names = [sorted(str(path.relative_to(root)) for path in root.rglob("*") if path.is_file())
                 for root in (a, b)]
        self.assertEqual(names[0], names[1])
        _, different, unreadable = filecmp.cmpfiles(a, b, names[0], shallow=False)
        self.assertEqual((different, unreadable), ([], []))
        print(f"{len(names[0])} files the same", file=sys.stderr)


if __name__ == "__main__":
    result = unittest.main(exit=False, verbosity=2).result
    # ctest takes 77 for "skipped"
    sys.exit(77 if result.skipped and not result.failures and not result.errors else not result.wasSuccessful())
