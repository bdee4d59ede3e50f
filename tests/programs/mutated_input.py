# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Mutated input through the programs: no signal, no hang, no success on damage, every message with its file.

    python3 tests/programs/mutated_input.py build/release --minutes 60 --jobs 2 --seed 1

makes a small set of sound inputs with the programs (sound_inputs.py), then changes one file of a copy at a time
(mutators.py) and runs a verb on it (mutation_targets.py), until the time is over or, with --runs N, N times. Run number
i of a seed is the same on every machine, for the same inputs, whatever --targets and --jobs are. A run is at fault if
the program (mutation_oracle.py)

* ends by a signal or with an exit code that is not 0 to 4,
* takes more than 20 s of processor time, or waits for five minutes,
* needs more than 2 GiB in one process,
* ends with 0 although a checksum or hash that the input carries covers the changed bytes,
* refuses without naming the file, or the folder of the object or data set, on standard output or error,
* shows the words of a library, or prints with --json what is not one JSON document,
* changes its input, writes outside its output, or leaves a temporary behind.

Faults are kept in --out, one folder each with the changed file, what happened, and the command that repeats it; the
exit code is 1 if there are any.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import random
import re
import resource
import shlex
import shutil
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from mutation_oracle import Answer, Case, Limits, judged  # noqa: E402
from mutation_targets import Target, all_targets  # noqa: E402
from mutators import ESCAPE, mutated  # noqa: E402
from sealing import seal  # noqa: E402
from sound_inputs import DOOR_ID, SAFE_HANDLES, make_inputs  # noqa: E402

PROGRESS_SECONDS = 30


def files_of(target: Target, inputs: pathlib.Path) -> list[str]:
    folder = inputs / target.group
    return sorted(
        {str(path.relative_to(folder))
         for pattern in target.files
         for path in folder.glob(pattern) if path.is_file()})


def names_of(target: Target, changed: pathlib.PurePath) -> frozenset[str]:
    """What a message may call a changed file: its name, that of the object that it belongs to, or the object's id. The
    inputs' own names have an underscore or a number, so that they are no words of a message."""
    objects = [part for part in (changed.stem, *changed.parts[:-1]) if re.search(r"_|\d{4}", part)]
    return frozenset([changed.name, *objects, DOOR_ID, *SAFE_HANDLES, *target.outcomes])


def case_of(target: Target, changed: str, doorforge: pathlib.Path, box: pathlib.Path) -> Case:
    folder = box / "run"
    replace = {"IN": str(folder / "in"), "OUT": str(folder / "out"), "CHANGED": changed}

    def filled(word: str) -> str:
        return re.sub(r"\b(IN|OUT|CHANGED)\b", lambda match: replace[match.group()], word)

    return Case([str(doorforge), *map(filled, target.arguments)], box, folder / "in" / changed,
                names_of(target, pathlib.PurePath(changed)), in_place=target.in_place,
                environment={key: filled(value)
                             for key, value in target.environment})


def make_box(target: Target, inputs: pathlib.Path, box: pathlib.Path) -> None:
    shutil.copytree(inputs / target.group, box / "run/in")
    for part in ("run/out", "run/tmp", "around/victim", "run/around/victim"):
        (box / part).mkdir(parents=True)
    for victim in ("around/victim/keep.txt", "run/around/victim/keep.txt"):
        (box / victim).write_text("what no run may touch\n")


class Campaign:
    """Counts and keeps what the runs give."""

    def __init__(self, options: argparse.Namespace, doorforge: pathlib.Path, inputs: pathlib.Path,
                 targets: list[Target]) -> None:
        self.options, self.doorforge, self.inputs = options, doorforge, inputs
        self.limits = Limits()
        self.targets = [target for target in targets for _ in range(target.weight)]
        self.files = {target.name: files_of(target, inputs) for target in self.targets}
        empty = sorted(name for name, files in self.files.items() if not files)
        if empty:
            raise SystemExit(f"no files to change for {empty}")
        self.codes: dict[str, collections.Counter] = collections.defaultdict(collections.Counter)
        self.slowest: dict[str, float] = collections.defaultdict(float)
        self.largest: dict[str, int] = collections.defaultdict(int)
        self.faults: list[dict] = []
        self.lock = threading.Lock()

    def is_wanted(self, target: Target) -> bool:
        return self.options.targets is None or any(name in target.name for name in self.options.targets)

    def target_of(self, number: int) -> tuple[Target, random.Random]:
        draw = random.Random(f"{self.options.seed} {number}")
        return draw.choice(self.targets), draw

    def check_sound(self) -> None:
        """Each target's command on what is not damaged: it succeeds, or the target itself is wrong."""
        wrong = []
        for target in {target.name: target for target in self.targets if self.is_wanted(target)}.values():
            with tempfile.TemporaryDirectory(dir=self.options.work) as name:
                box = pathlib.Path(name)
                make_box(target, self.inputs, box)
                case = case_of(target, self.files[target.name][0], self.doorforge, box)
                answer, faults = judged(case, self.limits)
                if answer.code != 0 or faults:
                    said = (answer.output[-1500:] + answer.errors[-1500:]).decode(errors="replace")
                    wrong.append(
                        f"{target.name}: exit code {answer.code}, {faults}\n{shlex.join(case.command)}\n{said}")
        if wrong:
            raise SystemExit("on sound input:\n" + "\n".join(wrong))

    def run(self, number: int) -> None:
        target, draw = self.target_of(number)
        changed = draw.choice(self.files[target.name])
        with tempfile.TemporaryDirectory(dir=self.options.work, prefix=f"run{number}-") as name:
            box = pathlib.Path(name)
            make_box(target, self.inputs, box)
            case = case_of(target, changed, self.doorforge, box)
            old = case.changed.read_bytes()
            new, mutations = mutated(old, case.changed.suffix, draw)
            new = new.replace(ESCAPE.encode(), str(box).encode())
            if draw.random() < target.sealed:
                seal(box / "run/in", case.changed, old, new)
                mutations.append("sealed")
            else:
                case.changed.write_bytes(new)
                case.covered = target.covered
            kept = self.options.out / f"seed{self.options.seed}_{number:06d}" / "in"
            if self.options.keep_input:
                shutil.copytree(box / "run/in", kept, dirs_exist_ok=True)
            answer, faults = judged(case, self.limits)
            if faults:
                self.keep(kept.parent, case, new)
            self.note(number, target, answer,
                      {"file": changed, "mutations": mutations, "command": shlex.join(case.command)}, faults)

    def keep(self, folder: pathlib.Path, case: Case, content: bytes) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / case.changed.name).write_bytes(content)

    def repeat_command(self, number: int) -> str:
        return shlex.join([
            sys.executable,
            str(pathlib.Path(__file__).resolve()),
            str(self.options.build.resolve()), "--seed",
            str(self.options.seed), "--only",
            str(number), "--keep-input"
        ])

    def note(self, number: int, target: Target, answer: Answer, what: dict, faults: list[str]) -> None:
        with self.lock:
            self.codes[target.name][answer.code] += 1
            self.slowest[target.name] = max(self.slowest[target.name], answer.cpu_seconds)
            self.largest[target.name] = max(self.largest[target.name], answer.memory_mib)
            if self.options.only is not None:
                said = (answer.output + answer.errors).decode(errors="replace")
                print(f"exit code {answer.code}\n{said}", flush=True)
            if not faults:
                return
            record = {
                "number": number, "target": target.name, "faults": faults, "exit_code": answer.code,
                **what, "repeat": self.repeat_command(number), "cpu_seconds": round(answer.cpu_seconds, 2),
                "memory_mib": answer.memory_mib, "stderr": answer.errors[-3000:].decode("utf-8", "backslashreplace"),
                "stdout": answer.output[-3000:].decode("utf-8", "backslashreplace")
            }
            (self.options.out / f"seed{self.options.seed}_{number:06d}" /
             "fault.json").write_text(json.dumps(record, indent=2) + "\n")
            self.faults.append(record)
            print(f"run {number}: {target.name}, {what['file']} by {', '.join(what['mutations'])}: {'; '.join(faults)}",
                  flush=True)

    def runs(self) -> int:
        return sum(codes.total() for codes in self.codes.values())

    def report(self, seconds: float) -> str:
        lines = [
            f"{'target':22} {'runs':>6} {'accepted':>8} {'refused':>8} {'faults':>6} {'most CPU s':>10} {'most MiB':>9}"
        ]
        at_fault = collections.Counter(record["target"] for record in self.faults)
        for name in sorted(self.codes):
            codes = self.codes[name]
            refused = sum(codes[code] for code in (1, 2, 3, 4))
            lines.append(f"{name:22} {codes.total():6} {codes[0]:8} {refused:8} {at_fault[name]:6} "
                         f"{self.slowest[name]:10.1f} {self.largest[name]:9}")
        kinds = collections.Counter(re.split(r":", fault)[0] for record in self.faults for fault in record["faults"])
        lines.append(
            f"{self.runs()} runs in {seconds / 60:.1f} min, seed {self.options.seed}: {len(self.faults)} at fault")
        lines += [f"  {count:6} {kind}" for kind, count in kinds.most_common()]
        return "\n".join(lines)


class Workers:
    """Runs numbers from --first on until there were enough or the time is over."""

    def __init__(self, campaign: Campaign, options: argparse.Namespace) -> None:
        self.campaign, self.options = campaign, options
        self.start = time.monotonic()
        self.end = float("inf") if options.runs is not None else self.start + 60 * options.minutes
        self.next_number = options.first
        self.left = options.runs if options.runs is not None else 1 << 60
        self.told = self.start

    def take(self) -> int | None:
        with self.campaign.lock:
            if self.left == 0 or time.monotonic() > self.end:
                return None
            while not self.campaign.is_wanted(self.campaign.target_of(self.next_number)[0]):
                self.next_number += 1
            self.left -= 1
            self.next_number += 1
            if time.monotonic() - self.told > PROGRESS_SECONDS:
                self.told = time.monotonic()
                counts = f"{self.campaign.runs()} runs, {len(self.campaign.faults)} at fault"
                print(f"{self.told - self.start:.0f} s, {counts}", file=sys.stderr, flush=True)
            return self.next_number - 1

    def work(self) -> None:
        while (number := self.take()) is not None:
            self.campaign.run(number)

    def run(self) -> float:
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            for worker in [pool.submit(self.work) for _ in range(self.options.jobs)]:
                worker.result()
        return time.monotonic() - self.start


def parsed(arguments: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="build folder with bin/doorforge")
    parser.add_argument("--minutes", type=float, default=1)
    parser.add_argument("--runs", type=int, help="so many runs instead of a time")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first run")
    parser.add_argument("--only", type=int, help="repeats this one run and prints what the program said")
    parser.add_argument("--targets", nargs="+",
                        help="only targets whose names contain one of these; the runs keep their numbers")
    parser.add_argument("--inputs", type=pathlib.Path,
                        help="sound inputs of an earlier call; made there if there are none")
    parser.add_argument("--keep-input", action="store_true", help="keeps the whole input of every run in --out")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("mutated_input_faults"),
                        help="where faults are kept")
    options = parser.parse_args(arguments)
    options.out = options.out.resolve()
    if options.only is not None:
        options.first, options.runs, options.targets = options.only, 1, None
    return options


def main() -> int:
    options = parsed()
    doorforge = (options.build / "bin/doorforge").resolve()
    with tempfile.TemporaryDirectory() as work:
        options.work = work
        inputs = (options.inputs or pathlib.Path(work) / "inputs").resolve()
        if not inputs.exists():
            make_inputs(doorforge, inputs)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        campaign = Campaign(options, doorforge, inputs, all_targets())
        if options.only is None:
            campaign.check_sound()
        seconds = Workers(campaign, options).run()
    print(campaign.report(seconds))
    return 1 if campaign.faults else 0


if __name__ == "__main__":
    sys.exit(main())
