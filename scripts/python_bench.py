#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the Python package, each beside what it is compared with, in one run.

    PYTHONPATH=build/release/python python3 scripts/python_bench.py [--data DATA] [--rounds 5] [--only states clouds]

import: of a new interpreter, less that of an empty program. states, clouds: decisions a second of whole episodes, stepped from
Python and run in C++ (`simulate`), on one thread; with clouds a trained opener acts in both. vector: 16 environments on 2
threads against 1 thread (needs Gymnasium), whole episodes with their beginnings; also what two idle processors would give, from the
processor time of each job, handed out as the threads do, and of what they do not share. loader: decisions a second of a DataLoader against WebDataset's reader on the same tars, checksums of ours
included (needs --data, PyTorch and webdataset). Rounds alternate; medians. Seconds are told twice: by the clock, and of the
processor, which is what to look at where other programs run.
"""
import argparse
import importlib.util
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import doorforge


def processor_s() -> float:
    """Of this process and of its children that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def timed(call) -> tuple[float, float]:
    """Seconds by the clock and of the processor."""
    begin, begin_processor = time.perf_counter(), processor_s()
    call()
    return time.perf_counter() - begin, processor_s() - begin_processor


def medians(rounds: int, *calls) -> list[tuple[float, float]]:
    """Of each call, which take turns."""
    runs = [[timed(call) for call in calls] for _ in range(rounds)]
    return [tuple(statistics.median(column) for column in zip(*of_one)) for of_one in zip(*runs)]


def compare(name: str, ours, theirs, rounds: int, count: int) -> None:
    (wall, processor), (their_wall, their_processor) = medians(rounds, ours, theirs)
    print(f"{name:18} {count / wall:8.1f} decisions/s, compared with {count / their_wall:8.1f}: {their_wall / wall:.2f}; "
          f"by the processor {count / processor:8.1f}, {count / their_processor:8.1f}: {their_processor / processor:.2f}",
          flush=True)


def run_import(rounds: int) -> None:
    def start(code: str):
        return lambda: subprocess.run([sys.executable, "-c", code], check=True)

    found = medians(2 * rounds, start("import doorforge"), start("import numpy"), start("pass"))
    for name, (wall, processor) in zip(("doorforge", "numpy"), found):
        print(f"import {name:11} {wall - found[2][0]:.3f} s, of the processor {processor - found[2][1]:.3f} s", flush=True)


def run_steps(name: str, folder: str, door, opener: str, clouds: list[str], rounds: int) -> None:
    episodes = 6
    reference = doorforge.simulate(folder, opener=opener, seed=3, episodes=episodes, threads=1)
    count = sum(row["actions"] for row in reference["episodes"])
    stepper = doorforge.Stepper(door, clouds=clouds)
    policy = doorforge.load_policy(opener)

    def from_python() -> None:
        for episode in range(episodes):
            stepper.reset(doorforge.sample_scene(door, 3, episode))
            policy.reset()
            while not stepper.over:
                if clouds:
                    stepper.arrays(["cloud", "proprioception"])
                stepper.step(policy.act(stepper.observation))

    compare(name, from_python, lambda: doorforge.simulate(folder, opener=opener, seed=3, episodes=episodes, threads=1),
            rounds, count)


class Costs:
    """Processor seconds of each job that a vector hands to `advance` of the extension, which its threads share."""

    def __init__(self) -> None:
        self.core, self.seconds, self.makespan = doorforge._engine.core, 0.0, 0.0
        self.advance = self.core.advance

    def __enter__(self) -> "Costs":
        self.core.advance = self.one_by_one
        return self

    def __exit__(self, *unused) -> None:
        self.core.advance = self.advance

    def one_by_one(self, steppers, jobs, threads) -> None:
        busy = [0.0, 0.0]  # of two threads, the next job to the one that is free first
        for stepper, job in zip(steppers, jobs):
            begin = time.process_time()
            self.advance([stepper], [job], 1)
            cost = time.process_time() - begin
            self.seconds += cost
            busy[busy.index(min(busy))] += cost
        self.makespan += max(busy)


def run_vector(door, rounds: int) -> None:
    steps, count = 24, 16  # long enough for some episodes to end and others to begin
    actions = np.random.default_rng(3).uniform(-1, 1, (steps, count, 6)).astype(np.float32)
    for observation in ("door_state", "cloud"):
        vectors = [doorforge.VectorEnv([door], count, threads=threads, observation=observation, control="delta")
                   for threads in (1, 2)]

        def play(envs):
            return lambda: [envs.step(row) for row in actions]

        runs = []
        for _ in range(rounds):
            for envs in vectors:
                envs.reset(seed=5)
                runs.append(timed(play(envs)))
        (one, one_processor), (two, two_processor) = (
            [statistics.median(column) for column in zip(*runs[i::2])] for i in range(2))
        vectors[0].reset(seed=5)
        with Costs() as costs:
            whole = timed(play(vectors[0]))[1]
        alone = max(whole - costs.seconds, 0.0)
        print(f"vector, {observation:10} {steps * count / two:8.1f} decisions/s on 2 threads, {steps * count / one:8.1f} on 1: "
              f"{one / two:.2f}; processor {two_processor / one_processor:.2f} times as much; not shared "
              f"{100 * alone / whole:.1f} %, and two idle processors would give {whole / (alone + costs.makespan):.2f}", flush=True)


def run_loader(folder: str, rounds: int) -> None:
    import webdataset
    from torch.utils.data import DataLoader

    from doorforge.torch_data import Decisions, ResumableSampler

    names = ("cloud", "proprio", "action")
    count = len(Decisions(folder, names=names))
    tars = sorted(str(path) for path in pathlib.Path(folder, "open", "train").glob("*.tar"))

    def ours(workers: int) -> None:
        data = Decisions(folder, names=names)  # anew, so that each epoch compares the checksums
        sampler = ResumableSampler(data, 16, seed=1, drop_last=False)
        loader = DataLoader(data, batch_sampler=sampler, num_workers=workers)
        assert sum(len(batch["action"]) for batch in loader) == count

    def theirs(workers: int) -> None:
        def decisions(source):
            for episode in source:
                arrays = {name: episode[name + ".npy"] for name in names}
                for row in range(len(arrays["action"])):
                    yield {name: array[row] for name, array in arrays.items()}

        reader = webdataset.WebDataset(tars, shardshuffle=False, empty_check=False).decode().compose(decisions).shuffle(1000)
        loader = DataLoader(reader, batch_size=16, num_workers=workers)
        assert sum(len(batch["action"]) for batch in loader) == count

    for workers in (0, min(2, len(tars))):
        compare(f"loader, {workers} workers", lambda: ours(workers), lambda: theirs(workers), rounds, count)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", help="a data set of the stage open")
    parser.add_argument("--rounds", type=int, default=5)
    parts = ("import", "states", "clouds", "vector", "loader")
    parser.add_argument("--only", nargs="+", choices=parts, default=parts)
    options = parser.parse_args()
    if "import" in options.only:
        run_import(options.rounds)
    with tempfile.TemporaryDirectory() as scratch:
        door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
        folder = str(pathlib.Path(scratch) / "door")
        door.save(folder)
        opener = str(doorforge._engine.core.data_folder() / "policies" / "opener")
        if "states" in options.only:
            run_steps("states", folder, door, "expert", [], options.rounds)
        if "clouds" in options.only:
            run_steps("clouds", folder, door, opener, ["open"], options.rounds)
        if "vector" in options.only and importlib.util.find_spec("gymnasium"):
            run_vector(door, options.rounds)
    if options.data and "loader" in options.only:
        run_loader(options.data, options.rounds)


if __name__ == "__main__":
    main()
