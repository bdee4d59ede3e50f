# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Runs one program on a damaged input and says what is wrong with how it took it."""
import contextlib
import dataclasses
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import time

TICKS = os.sysconf("SC_CLK_TCK")
LOOK_SECONDS = 0.25  # between two looks at processor time and memory
CODES = (0, 1, 2, 3, 4)
# names of libraries and their functions, in texts that are not ours
LIBRARY_WORDS = re.compile(
    rb"json\.exception|basic_string|vector::_M|\bstd::|map::at|stoull|stoi\b|stod\b|filesystem error|yaml-cpp|YAML::|"
    rb"bad conversion|terminate called|Assertion|AddressSanitizer|runtime error|\bcv::|OpenCV|c10::|torch::|\bat::|"
    rb"pickle\.|Exception raised|Traceback|CGAL|"
    rb"libpng|tinyxml|XML_ERROR|HDF5-DIAG|H5[A-Z][a-z]+\(|what\(\)")


@dataclasses.dataclass(frozen=True)
class Limits:
    """Processor time decides what hangs, so that a busy machine changes no verdict; the wall's is for what waits."""
    cpu_seconds: float = 20
    wall_seconds: float = 300
    memory_mib: int = 2048


@dataclasses.dataclass
class Case:
    """A run: what is started where, and what its answer is held against."""
    command: list[str]
    box: pathlib.Path  # everything that the run may see; IN and OUT are in its folder `run`
    changed: pathlib.Path  # the damaged file
    names: frozenset[str]  # a message has one of these: the file's name, its object's
    covered: bool = False  # a checksum that the input carries covers the changed bytes
    in_place: bool = False  # the verb writes into its input
    environment: dict[str, str] = dataclasses.field(default_factory=dict)

    @property
    def folder(self) -> pathlib.Path:
        return self.box / "run"


@dataclasses.dataclass
class Answer:
    code: int
    output: bytes
    errors: bytes
    cpu_seconds: float
    memory_mib: int
    stopped: str  # why it was ended from outside; empty: it ended by itself


@dataclasses.dataclass
class Use:
    cpu_seconds: float = 0
    memory_mib: int = 0


def use_of(process: int) -> Use:
    """Of a process and all below it: processor time, that of ended ones too, and the memory that they hold."""
    try:
        fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        children = [
            int(child) for task in os.listdir(f"/proc/{process}/task")
            for child in pathlib.Path(f"/proc/{process}/task/{task}/children").read_text().split()
        ]
    except (OSError, ValueError):
        return Use()
    use = Use(sum(int(field) for field in fields[11:15]) / TICKS, int(fields[21]) * resource.getpagesize() >> 20)
    for below in map(use_of, children):
        use = Use(use.cpu_seconds + below.cpu_seconds, use.memory_mib + below.memory_mib)
    return use


def excess(use: Use, seconds: float, limits: Limits) -> str:
    if use.cpu_seconds > limits.cpu_seconds:
        return f"hang: more than {limits.cpu_seconds:g} s of processor time"
    if use.memory_mib > limits.memory_mib:
        return f"memory: more than {limits.memory_mib} MiB"
    return f"hang: not done after {limits.wall_seconds:g} s" if seconds > limits.wall_seconds else ""


def stop(process: int) -> None:
    """Ends a process group."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)


def waited_for(process: int, limits: Limits) -> tuple[int, resource.struct_rusage, str]:
    """(status, usage, why it was stopped) of a process that leads its group. One that takes too much processor time or
    memory, or waits for ever, is stopped; it is asked often at first, as most are done in no time."""
    start = looked = time.monotonic()
    stopped = ""
    while True:
        pid, status, usage = os.wait4(process, os.WNOHANG)
        if pid == process:
            return status, usage, stopped
        now = time.monotonic()
        if now - looked > LOOK_SECONDS:
            looked = now
            stopped = stopped or excess(use_of(process), now - start, limits)
            if stopped:
                stop(process)
        time.sleep(min(0.05, 0.002 + 0.05 * (now - start)))


def answer_of(case: Case, limits: Limits) -> Answer:
    folder = case.folder
    environment = {
        **os.environ, "TMPDIR": str(folder / "tmp"), "HOME": str(folder / "tmp"), "OMP_NUM_THREADS": "1",
        **case.environment
    }
    with open(folder / "stdout", "wb") as output, open(folder / "stderr", "wb") as errors:
        process = subprocess.Popen(case.command, stdin=subprocess.DEVNULL, stdout=output, stderr=errors, cwd=folder,
                                   start_new_session=True, env=environment)
        status, usage, stopped = waited_for(process.pid, limits)
    process.returncode = os.waitstatus_to_exitcode(status)
    stop(process.pid)  # what it left running
    return Answer(process.returncode, (folder / "stdout").read_bytes(), (folder / "stderr").read_bytes(),
                  usage.ru_utime + usage.ru_stime, usage.ru_maxrss >> 10, stopped)


def listing(folder: pathlib.Path) -> dict[str, tuple]:
    found = {}
    for path in folder.rglob("*"):
        status = path.lstat()
        found[str(path.relative_to(folder))] = (status.st_ino, status.st_size,
                                                status.st_mtime_ns) if path.is_file() else ()
    return found


def ending_faults(answer: Answer, limits: Limits) -> list[str]:
    faults = []
    if answer.stopped:
        faults.append(answer.stopped)
    elif answer.code < 0:
        faults.append(f"signal {signal.Signals(-answer.code).name}")
    elif answer.code not in CODES:
        faults.append(f"exit code {answer.code}")
    if answer.cpu_seconds > limits.cpu_seconds and "hang" not in answer.stopped:
        faults.append(f"hang: {answer.cpu_seconds:.1f} s of processor time")
    if answer.memory_mib > limits.memory_mib and "memory" not in answer.stopped:
        faults.append(f"memory: {answer.memory_mib} MiB")
    return faults


def is_one_json_document(output: bytes) -> bool:
    try:
        json.loads(output)
    except ValueError:
        return False
    return True


def message_faults(case: Case, answer: Answer) -> list[str]:
    faults = []
    text = answer.output + answer.errors
    ended = not answer.stopped and answer.code in CODES
    if ended and answer.code == 0 and case.covered:
        faults.append("success on damage")
    if ended and answer.code != 0 and not any(os.fsencode(name) in text for name in case.names):
        faults.append(f"message without {case.changed.name}")
    words = LIBRARY_WORDS.search(text)
    if words:
        faults.append(f"words of a library: {words.group().decode()}")
    # refused as a whole, standard output is empty; else it is one document
    if ended and "--json" in case.command and not is_one_json_document(answer.output):
        if answer.output.strip() or answer.code in (0, 1):
            faults.append("standard output is no JSON")
    return faults


def folder_faults(case: Case, before: dict[str, tuple]) -> list[str]:
    after = listing(case.box)
    faults = []
    for name, status in before.items():
        if after.get(name) != status and not (case.in_place and name.startswith("run/in")):
            faults.append(f"changed outside the output: {name}")
    for name in sorted(after.keys() - before.keys()):
        place = name.split("/")
        if ".tmp-" in name:
            faults.append(f"temporary left: {name}")
        elif place[:2] not in (["run", "out"], ["run", "stdout"],
                               ["run", "stderr"]) and not (case.in_place and place[:2] == ["run", "in"]):
            faults.append(f"written outside the output: {name}")
    return faults


def judged(case: Case, limits: Limits) -> tuple[Answer, list[str]]:
    """Runs the case; the faults are sentences of which the first words say the kind."""
    before = listing(case.box)
    answer = answer_of(case, limits)
    return answer, ending_faults(answer, limits) + message_faults(case, answer) + folder_faults(case, before)
