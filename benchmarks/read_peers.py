#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The samples of a data set written and read through doorforge_reader, h5py and WebDataset-style tars.

    PYTHONPATH=python python3 benchmarks/read_peers.py DIR [--scratch FOLDER] [--episodes N]

All peers hold the same arrays of the same episodes. Every reading sums the arrays, so that each byte
is touched; the best of five runs counts, in CPU time with the files in memory. "random" reads one decision of
every array (a training sample), in one random order for all.
"""
import argparse
import io
import pathlib
import shutil
import tarfile
import tempfile
import time

import numpy as np

import doorforge_reader

RUNS = 5


def best(function):
    """Least CPU seconds of some runs, and the last result."""
    seconds = []
    for _ in range(RUNS):
        start = time.process_time()
        result = function()
        seconds.append(time.process_time() - start)
    return min(seconds), result


def touch(arrays):
    return sum(int(array.view(np.uint8).max()) if array.size else 0 for array in arrays)


def write_tar_of_samples(path, episodes):
    """One key a decision, as WebDataset users do, with numpy's own writer."""
    with tarfile.open(path, "w") as archive:
        for number, episode in enumerate(episodes):
            for decision in range(episode["count"]):
                for name, array in episode["arrays"].items():
                    buffer = io.BytesIO()
                    np.save(buffer, array[decision])
                    item = tarfile.TarInfo(f"{number:06d}_{decision:03d}.{name}.npy")
                    item.size = buffer.tell()
                    buffer.seek(0)
                    archive.addfile(item, buffer)


def read_tar(path):
    total = 0
    with tarfile.open(path, "r|") as archive:
        for item in archive:
            total += touch([np.load(io.BytesIO(archive.extractfile(item).read()))])
    return total


def write_tar_of_episodes(path, episodes):
    with tarfile.open(path, "w") as archive:
        for number, episode in enumerate(episodes):
            for name, array in episode["arrays"].items():
                buffer = io.BytesIO()
                np.save(buffer, array)
                item = tarfile.TarInfo(f"{number:06d}.{name}.npy")
                item.size = buffer.tell()
                buffer.seek(0)
                archive.addfile(item, buffer)


def write_hdf5(path, episodes, checksums):
    import h5py

    with h5py.File(path, "w") as file:
        for number, episode in enumerate(episodes):
            group = file.create_group(f"data/demo_{number}")
            for name, array in episode["arrays"].items():
                chunks = (1, *array.shape[1:]) if checksums else None
                group.create_dataset(name, data=array, chunks=chunks, fletcher32=checksums)


def read_hdf5(path):
    import h5py

    total = 0
    with h5py.File(path) as file:
        for group in file["data"].values():
            total += touch([array[:] for array in group.values()])
    return total


def random_hdf5(path, places):
    import h5py

    with h5py.File(path) as file:
        return sum(touch([array[d] for array in file[f"data/demo_{e}"].values()]) for e, d in places)


def report(name, write_s, read_s, random_s, size, count):
    write = f"{size / write_s / 1e9:9.2f}" if write_s else "        -"
    random = f"{count / random_s:14,.0f}" if random_s else "             -"
    print(f"{name:38} {write} {size / read_s / 1e9:9.2f} {random}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--scratch", help="where the peers' files are written for the time of the run")
    parser.add_argument("--episodes", type=int, default=128)
    options = parser.parse_args()
    source = doorforge_reader.Dataset(options.folder)
    stage, split = source.parts[0].stage, source.parts[0].split
    episodes = [{"count": e.decisions, "arrays": {name: array.copy() for name, array in e.arrays().items()}}
                for e in source.episodes(stage, split)[:options.episodes]]
    size = sum(array.nbytes for episode in episodes for array in episode["arrays"].values())
    all_places = [(e, d) for e, episode in enumerate(episodes) for d in range(episode["count"])]
    places = [all_places[i] for i in doorforge_reader.order(len(all_places), 1, 0)[:1000]]
    names = list(episodes[0]["arrays"])
    print(f"{len(episodes)} episodes, {len(all_places)} decisions, {size / 1e6:.1f} MB of arrays\n")
    print(f"{'':38} {'write':>9} {'read':>9} {'random':>14}\n{'':38} {'GB/s':>9} {'GB/s':>9} {'samples/s':>14}")

    def read_all(check):
        part = doorforge_reader.Dataset(options.folder, check=check).episodes(stage, split)[:options.episodes]
        return sum(touch(episode.arrays().values()) for episode in part)

    def read_random(samples):
        return sum(touch([samples.episodes[e][name][d] for name in names]) for e, d in places)

    checked = source.samples(stage, split)
    plain = doorforge_reader.Dataset(options.folder, check=False).samples(stage, split)
    totals = set()
    for label, check, samples in (("doorforge_reader, CRC-32C checked", True, checked),
                                  ("doorforge_reader, unchecked", False, plain)):
        seconds, total = best(lambda: read_all(check))
        totals.add(total)
        report(label, None, seconds, best(lambda: read_random(samples))[0], size, len(places))

    scratch = pathlib.Path(tempfile.mkdtemp(dir=options.scratch))
    try:
        for checksums in (False, True):
            path = scratch / f"peer{checksums}.hdf5"
            write, _ = best(lambda: write_hdf5(path, episodes, checksums))
            read, total = best(lambda: read_hdf5(path))
            totals.add(total)
            random, _ = best(lambda: random_hdf5(path, places))
            report("h5py, " + ("a chunk a decision, fletcher32" if checksums else "contiguous, no checksums"),
                   write, read, random, size, len(places))
        for label, writer in (("WebDataset style, a key an episode", write_tar_of_episodes),
                              ("WebDataset style, a key a decision", write_tar_of_samples)):
            path = scratch / "peer.tar"
            write, _ = best(lambda: writer(path, episodes))
            read, total = best(lambda: read_tar(path))
            report(label + ", tarfile", write, read, None, size, len(places))
    finally:
        shutil.rmtree(scratch)
    assert len(totals) == 1, "the peers do not hold the same values"


if __name__ == "__main__":
    main()
