#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the Python package, each beside what it is compared with, in one run.

    PYTHONPATH=build/release/python python3 scripts/python_bench.py [--data DATA] [--rounds 5]

import: of a new interpreter, less that of `import numpy`. states, clouds: decisions a second of whole episodes, stepped
from Python and run in C++ (`simulate`), on one thread; with clouds a trained opener acts in both. vector: 16 environments on
2 threads against 1 thread (needs Gymnasium). loader: decisions a second of a DataLoader against WebDataset's reader on the
same tars (needs --data, PyTorch and webdataset). Rounds alternate; medians.
"""
import argparse
import importlib.util
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import doorforge


def timed(call) -> float:
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def compare(name: str, ours, theirs, rounds: int, unit: str, count: int = 1) -> None:
    pairs = [(timed(ours), timed(theirs)) for _ in range(rounds)]
    mine, other = (statistics.median(column) for column in zip(*pairs))
    print(f"{name:10} {count / mine:10.1f} {unit}, compared with {count / other:10.1f}: {other / mine:.2f}", flush=True)


def run_import(rounds: int) -> None:
    def start(code: str):
        return lambda: subprocess.run([sys.executable, "-c", code], check=True)

    with_it = statistics.median(timed(start("import doorforge")) for _ in range(2 * rounds))
    without = statistics.median(timed(start("import numpy")) for _ in range(2 * rounds))
    bare = statistics.median(timed(start("pass")) for _ in range(2 * rounds))
    print(f"import     {with_it - bare:.3f} s with numpy, of which numpy {without - bare:.3f} s", flush=True)


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
            rounds, "decisions/s", count)


def run_vector(door, rounds: int) -> None:
    def steps(threads: int, observation: str):
        envs = doorforge.VectorEnv([door], 16, threads=threads, observation=observation, control="delta")
        envs.reset(seed=5)
        actions = np.zeros((16, 6), np.float32)

        def call() -> None:
            envs.reset(seed=5)
            for _ in range(12):
                envs.step(actions)
        return call

    for observation in ("door_state", "cloud"):
        compare(f"16, {observation[:5]}", steps(2, observation), steps(1, observation), rounds, "decisions/s", 16 * 12)


def run_loader(folder: str, rounds: int) -> None:
    import webdataset
    from torch.utils.data import DataLoader

    from doorforge.torch_data import Decisions, ResumableSampler

    names = ("cloud", "proprio", "action")
    data = Decisions(folder, names=names)
    tars = sorted(str(path) for path in pathlib.Path(folder, "open", "train").glob("*.tar"))

    def ours() -> None:
        sampler = ResumableSampler(data, 16, seed=1, drop_last=False)
        assert sum(len(batch["action"]) for batch in DataLoader(data, batch_sampler=sampler)) == len(data)

    def theirs() -> None:
        def decisions(source):
            for episode in source:
                arrays = {name: episode[name + ".npy"] for name in names}
                for row in range(len(arrays["action"])):
                    yield {name: array[row] for name, array in arrays.items()}

        reader = webdataset.WebDataset(tars, shardshuffle=False, empty_check=False).decode().compose(decisions)
        assert sum(len(batch["action"]) for batch in DataLoader(reader, batch_size=16)) == len(data)

    compare("loader", ours, theirs, rounds, "decisions/s", len(data))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", help="a data set of the stage open")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    run_import(options.rounds)
    with tempfile.TemporaryDirectory() as scratch:
        door = doorforge.compose("interior_flush_01", "interior_lever_tube_01")
        folder = str(pathlib.Path(scratch) / "door")
        door.save(folder)
        opener = str(doorforge._engine.core.data_folder() / "policies" / "opener")
        run_steps("states", folder, door, "expert", [], options.rounds)
        run_steps("clouds", folder, door, opener, ["open"], options.rounds)
        if importlib.util.find_spec("gymnasium"):
            run_vector(door, options.rounds)
    if options.data:
        run_loader(options.data, options.rounds)


if __name__ == "__main__":
    main()
