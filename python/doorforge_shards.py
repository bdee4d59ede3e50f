# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads doorforge datasets with numpy and the standard library.

    python3 doorforge_shards.py DIR            # prints a summary
    python3 doorforge_shards.py DIR --check    # and compares every member with its checksum

    import doorforge_shards
    data = doorforge_shards.Dataset("DIR")
    for episode in data.episodes("open", "train"):
        episode["cloud"]     # float32 (decisions, points, 3), a view into the mapped file
        episode["action"]    # float32 (decisions, 9)
        episode.meta         # dict: scene, outcome, camera, seed ...

The format is specified in docs/format-shards.md. This file stands alone: copy it where you need it.
"""
import ast
import json
import mmap
import pathlib
import sys

import numpy as np

_CRC_TABLE = None


def crc32c(data):
    """CRC-32C (Castagnoli) of bytes. Plain Python over numpy: about 10 MB/s, for checks only."""
    global _CRC_TABLE
    if _CRC_TABLE is None:
        table = np.arange(256, dtype=np.uint32)
        for _ in range(8):
            table = np.where(table & 1, (table >> 1) ^ np.uint32(0x82F63B78), table >> 1)
        _CRC_TABLE = table.tolist()
    table, crc = _CRC_TABLE, 0xFFFFFFFF
    for byte in bytes(data):
        crc = (crc >> 8) ^ table[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def read_npy(data, name="array"):
    """An array that shares memory with `data`, the bytes of an .npy file of version 1.0."""
    if bytes(data[:8]) != b"\x93NUMPY\x01\x00":
        raise ValueError(f"{name}: not an .npy file of version 1.0")
    start = 10 + int.from_bytes(data[8:10], "little")
    header = ast.literal_eval(bytes(data[10:start]).decode("latin1"))
    dtype, shape = np.dtype(header["descr"]), header["shape"]
    if header["fortran_order"] or dtype.hasobject:
        raise ValueError(f"{name}: Fortran order or objects")
    if len(data) - start != dtype.itemsize * int(np.prod(shape, dtype=np.int64)):
        raise ValueError(f"{name}: {len(data) - start} bytes of data do not fit the shape {shape}")
    return np.frombuffer(data, dtype, offset=start).reshape(shape)


class Episode:
    """One episode: arrays by name (`episode["cloud"]`), and `meta`."""

    def __init__(self, shard, entry):
        self.key = entry["key"]
        self.decisions = entry["decisions"]
        self._shard = shard
        self._members = {member["name"]: member for member in entry["members"]}

    def names(self):
        """Names of the arrays."""
        return [name[:-4] for name in self._members if name.endswith(".npy")]

    def __getitem__(self, name):
        return read_npy(self.member(name + ".npy"), f"{self.key}.{name}.npy")

    @property
    def meta(self):
        return json.loads(bytes(self.member("meta.json")))

    def member(self, name, check=False):
        """A member's bytes as a memoryview; `check` compares them with their checksum."""
        member = self._members[name]
        data = self._shard.data[member["offset"]:member["offset"] + member["size"]]
        if check and crc32c(data) != member["crc32c"]:
            raise ValueError(f"{self._shard.path}: {self.key}.{name} is damaged")
        return data

    def faults(self):
        """Names of the members that differ from their checksums."""
        found = []
        for name in self._members:
            try:
                self.member(name, check=True)
            except ValueError:
                found.append(f"{self.key}.{name}")
        return found


class Shard:
    """A mapped tar and its index. A shard without an index was never finished."""

    def __init__(self, index_path):
        index_path = pathlib.Path(index_path)
        self.index = json.loads(index_path.read_text())
        if self.index["schema"] != "doorforge.shard_index" or self.index["schema_version"] != 1:
            raise ValueError(f"{index_path}: not a shard index of version 1")
        self.path = index_path.parent / self.index["tar"]
        with open(self.path, "rb") as file:
            self.data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
        if len(self.data) != self.index["tar_bytes"]:
            raise ValueError(f"{self.path}: {len(self.data)} bytes, its index says "
                             f"{self.index['tar_bytes']}; the file was cut or replaced")
        self.episodes = [Episode(self, entry) for entry in self.index["episodes"]]


class Dataset:
    """A dataset's folder: `record` is dataset.json, `provenance` is provenance.json."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.record = json.loads((self.folder / "dataset.json").read_text())
        if self.record["schema"] != "doorforge.dataset" or self.record["schema_version"] != 1:
            raise ValueError(f"{self.folder}: not a dataset of version 1")
        self.provenance = json.loads((self.folder / "provenance.json").read_text())

    def parts(self):
        """Pairs (stage, split)."""
        return [(part["stage"], part["split"]) for part in self.record["parts"]]

    def shards(self, stage, split):
        for path in sorted((self.folder / stage / split).glob("shard-*.index.json")):
            yield Shard(path)

    def episodes(self, stage, split):
        for shard in self.shards(stage, split):
            yield from shard.episodes

    def failures(self):
        """Every planned episode that failed, with its cause."""
        with open(self.folder / "failures.jsonl") as lines:
            return [json.loads(line) for line in lines]


def _summary(folder, check):
    data = Dataset(folder)
    print(f"{folder}: made by doorforge {data.provenance['code_version']}, "
          f"seed {data.provenance['seed']}, {len(data.provenance['doors'])} doors")
    faults = []
    for stage, split in data.parts():
        episodes = list(data.episodes(stage, split))
        decisions = sum(episode.decisions for episode in episodes)
        failed = sum(len(shard.index["failures"]) for shard in data.shards(stage, split))
        print(f"\n{stage}/{split}: {len(episodes)} episodes, {failed} failed, {decisions} decisions")
        if not episodes:
            continue
        for name in episodes[0].names():
            array = episodes[0][name]
            values = np.concatenate([episode[name].ravel() for episode in episodes])
            print(f"  {name:8} {array.dtype.str} decisions x {str(array.shape[1:]):12} "
                  f"min {values.min():10.4f}  mean {values.mean(dtype=np.float64):10.4f}  "
                  f"max {values.max():10.4f}")
        if check:
            faults += [f"{stage}/{split}: {fault}" for e in episodes for fault in e.faults()]
    causes = {}
    for failure in data.failures():
        causes[failure["outcome"]] = causes.get(failure["outcome"], 0) + 1
    if causes:
        print("\nfailed episodes: " + ", ".join(f"{n} {cause}" for cause, n in sorted(causes.items())))
    for fault in faults:
        print("damaged: " + fault)
    return 1 if faults else 0


def main(arguments):
    folders = [a for a in arguments if not a.startswith("-")]
    if len(folders) != 1 or any(a.startswith("-") and a != "--check" for a in arguments):
        print(__doc__)
        return 2
    try:
        return _summary(folders[0], "--check" in arguments)
    except (OSError, ValueError, KeyError) as error:
        print(f"doorforge_shards: {error}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
