# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Reads doorforge datasets with numpy and the standard library. One file: copy it where you need it.

    import doorforge_reader

    data = doorforge_reader.Dataset("DIR")
    episodes = data.episodes("open", "train")     # a sequence: len(), [i], iteration
    episode = episodes[17]
    episode["cloud"]                              # float32 (decisions, points, 3), a view of the mapped file
    episode.meta["scene"]["seed"]                 # dict: scene, outcome, camera, policies ...

    samples = data.samples("open", "train")       # a sequence of decisions, over all episodes
    samples[123_456]["action"]                    # float32 (9,)

    for i in doorforge_reader.order(len(samples), seed=7, epoch=0): ...     # the same on every machine

    for key, members in doorforge_reader.stream(sys.stdin.buffer): ...      # a tar from a pipe

Every member is compared with its CRC-32C when it is first touched (`check=False` leaves that out).
What is wrong with a dataset is raised as DatasetError, whose subclasses tell a missing file
(MissingError), another format version (VersionError) and damage (CorruptError) apart; the message
names the file and the member. Datasets may be pickled and used after a fork: workers map the files
themselves.

    python3 doorforge_reader.py DIR            # prints a summary
    python3 doorforge_reader.py DIR --check    # and compares every member with its checksum

The format is specified in docs/format-shards.md.
"""
from __future__ import annotations

import ast
import collections
import dataclasses
import functools
import json
import math
import mmap
import pathlib
import re
import sys
import tarfile
from typing import Any, BinaryIO, Dict, Iterator, Optional, Sequence, Union

try:
    import numpy as np
except ImportError as error:
    _MISSING = (f"doorforge_reader needs numpy, which {sys.executable} does not have: apt-get install python3-numpy "
                f"and run /usr/bin/python3, or {sys.executable} -m pip install numpy")
    if __name__ == "__main__":
        print(_MISSING, file=sys.stderr)
        sys.exit(3)
    raise ImportError(_MISSING) from error

NEWEST_VERSION = 1  # of dataset.json, provenance.json and the shards' indices
OPEN_SHARDS = 64  # mapped at once; every map holds a file descriptor
_EARLY_INDEX_KEYS = 11  # of an index without a checksum of its own

Bytes = Union[bytes, bytearray, memoryview]


class DatasetError(ValueError):
    """A dataset cannot be read; the message says what, where and what to do."""


class MissingError(DatasetError, KeyError):
    """A file, part, episode or member that is not there."""

    def __str__(self) -> str:
        return str(self.args[0])


class VersionError(DatasetError):
    """Not a record of doorforge, or one of a version that this reader does not know."""


class CorruptError(DatasetError):
    """Bytes that are not the ones that were written."""


# --- CRC-32C ---------------------------------------------------------------------------------------

# The CRC is the remainder of the message, as a polynomial over GF(2), by the Castagnoli polynomial.
# x^(32*5685) + x^(32*1362) + x^(32*426) + 1 is a multiple of it, so a word may be replaced by three
# copies of itself further back, which is three XORs of long rows and no table: this takes most of
# the work off long messages. What is left is folded row by row with tables of 2^16 entries, and the
# last row with one table for each of its bytes.
_FOLD = (5685 - 1362, 5685 - 426, 5685)  # distances in words
_ROW = 1024  # words
_PIECE = 1 << 20  # bytes taken at once, so that they stay in the cache


def _byte_table() -> np.ndarray:
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = np.where(table & 1, (table >> 1) ^ np.uint32(0x82F63B78), table >> 1)
    return table


def _row_tables() -> tuple[np.ndarray, np.ndarray]:
    """What a word's low and high half become when a row of zeros follows the word."""
    bits = np.uint32(1) << np.arange(32, dtype=np.uint32)
    for _ in range(4 * _ROW):
        bits = (bits >> 8) ^ _TABLE[bits & 0xFF]
    tables = []
    for half in (bits[:16], bits[16:]):
        table = np.zeros(1, dtype=np.uint32)
        for bit in half:
            table = np.concatenate([table, table ^ bit])
        tables.append(table)
    return tables[0], tables[1]


def _position_table() -> np.ndarray:
    """For each byte of a row, last to first in memory order: what each of its values adds to the CRC."""
    table = np.empty((4 * _ROW, 256), dtype=np.uint32)
    row = _TABLE
    for position in range(4 * _ROW - 1, -1, -1):
        table[position] = row
        row = (row >> 8) ^ _TABLE[row & 0xFF]
    return table.ravel()


_TABLE = _byte_table()
_LISTED = _TABLE.tolist()
_LOW, _HIGH = _row_tables()
_POSITIONS = _position_table()
_PLACES = 256 * np.arange(4 * _ROW, dtype=np.intp)


def _fold(words: np.ndarray, state: int) -> np.ndarray:
    """A row with the same remainder as the message of `words` after `state`."""
    near, middle, far = _FOLD
    folded = max(0, len(words) - far)
    work = words.copy()
    work[0] ^= np.uint32(state)
    for begin in range(0, folded, near):
        block = work[begin:min(begin + near, folded)]
        for distance in (near, middle, far):
            target = work[begin + distance:begin + distance + len(block)]
            np.bitwise_xor(target, block, out=target)
    rest = work[folded:]
    rows = np.zeros((-(-len(rest) // _ROW), _ROW), dtype=np.uint32)
    rows.ravel()[rows.size - len(rest):] = rest
    row: np.ndarray = rows[0]
    for following in rows[1:]:
        halves = row.astype("<u4", copy=False).view("<u2")
        row = _LOW[halves[0::2]] ^ _HIGH[halves[1::2]] ^ following
    return row


def crc32c(data: Any, crc: int = 0) -> int:
    """CRC-32C (Castagnoli, RFC 3720) of bytes; `crc` continues an earlier result."""
    view = memoryview(data).cast("B")
    while len(view) > _PIECE:
        crc, view = crc32c(view[:_PIECE], crc), view[_PIECE:]
    state = crc ^ 0xFFFFFFFF
    end = len(view) & ~3
    if end > 4 * _ROW:
        row = _fold(np.frombuffer(view[:end], dtype="<u4"), state)
        state = int(np.bitwise_xor.reduce(_POSITIONS[_PLACES + row.astype("<u4", copy=False).view(np.uint8)]))
    elif end:
        octets = np.frombuffer(view[:end], dtype=np.uint8).astype(np.intp)
        octets[:4] ^= np.frombuffer(state.to_bytes(4, "little"), dtype=np.uint8)
        state = int(np.bitwise_xor.reduce(_POSITIONS[_PLACES[-end:] + octets]))
    for byte in view[end:]:
        state = (state >> 8) ^ _LISTED[(state ^ byte) & 0xFF]
    return state ^ 0xFFFFFFFF


# --- records ---------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Feature:
    """An array of every episode. "decisions" and "points" in the shape stand for lengths that vary."""
    name: str
    member: str
    dtype: str
    shape: tuple[Union[int, str], ...]
    unit: str
    frame: str
    meaning: str


@dataclasses.dataclass(frozen=True)
class Part:
    """Counts of a stage's split."""
    stage: str
    split: str
    shards: int
    episodes: int
    failed_episodes: int
    decisions: int
    bytes: int


@dataclasses.dataclass(frozen=True)
class Statistics:
    """Of a feature's components over the decisions (clouds: the points) of the train split, float64."""
    mean: np.ndarray
    standard_deviation: np.ndarray
    minimum: np.ndarray
    maximum: np.ndarray


def _read_text(path: pathlib.Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise MissingError(f"{path}: no such file; the dataset is unfinished or this is none") from None


def _check_index(text: bytes, path: pathlib.Path) -> None:
    """An index ends with the CRC-32C of its text without that line; those of early builds have none."""
    found = re.fullmatch(rb"(.*),\n  \"index_crc32c\": (\d+)\n\}\n", text, re.DOTALL)
    if found is None:
        if b"index_crc32c" not in text and len(json.loads(text)) <= _EARLY_INDEX_KEYS:
            return
    elif crc32c(found[1] + b"\n}\n") == int(found[2]):
        return
    raise CorruptError(f"{path}: damaged: its text is not what its own checksum says")


def _read_json(path: pathlib.Path, schema: str) -> dict[str, Any]:
    text = _read_text(path)
    try:
        record = json.loads(text)
    except ValueError as error:
        raise CorruptError(f"{path}: not JSON ({error})") from None
    if not isinstance(record, dict) or record.get("schema") != schema:
        found = record.get("schema") if isinstance(record, dict) else None
        raise VersionError(f"{path}: schema {found!r}, expected {schema!r}")
    version = record.get("schema_version")
    if not isinstance(version, int) or not 1 <= version <= NEWEST_VERSION:
        raise VersionError(f"{path}: version {version!r}, this reader knows 1 to {NEWEST_VERSION}; "
                           "take the reader of the doorforge that wrote the data")
    return record


def _picked(kind: Any, record: dict[str, Any], path: pathlib.Path) -> Any:
    """A dataclass from the keys it knows; keys of later minor versions are left alone."""
    try:
        return kind(**{field.name: record[field.name] for field in dataclasses.fields(kind)})
    except KeyError as error:
        raise CorruptError(f"{path}: no {error} in {kind.__name__.lower()}") from None


@functools.lru_cache(maxsize=1024)
def _npy_header(header: bytes) -> tuple[np.dtype, tuple[int, ...]]:
    fields = ast.literal_eval(header.decode("latin1"))
    dtype, shape = np.dtype(fields["descr"]), tuple(fields["shape"])
    if fields["fortran_order"] or dtype.hasobject or any(length < 0 for length in shape):
        raise ValueError("Fortran order, objects or a negative length")
    return dtype, shape


def read_npy(data: Any, name: str = "array") -> np.ndarray:
    """An array that shares memory with `data`, the bytes of an .npy file of version 1.0."""
    view = memoryview(data)
    if bytes(view[:8]) != b"\x93NUMPY\x01\x00":
        raise CorruptError(f"{name}: not an .npy file of version 1.0")
    start = 10 + int.from_bytes(view[8:10], "little")
    try:
        dtype, shape = _npy_header(bytes(view[10:start]))
        if len(view) - start != dtype.itemsize * math.prod(shape):
            raise ValueError(f"{len(view) - start} bytes of data do not fit the shape {shape}")
    except (SyntaxError, TypeError, ValueError, KeyError) as error:
        raise CorruptError(f"{name}: not an .npy file that can be used ({error})") from None
    return np.frombuffer(view, dtype, offset=start).reshape(shape)


# --- shards ----------------------------------------------------------------------------------------


class Shard:
    """A tar and its index. A shard without an index was never finished.

    Holds the index as arrays: 20 bytes a member, however many episodes there are.
    """

    def __init__(self, index_path: Union[str, pathlib.Path], check: bool = True) -> None:
        path = pathlib.Path(index_path)
        index = _read_json(path, "doorforge.shard_index")
        try:
            _check_index(_read_text(path), path)
            self._read_index(index, path)
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            if isinstance(error, DatasetError):
                raise
            raise CorruptError(f"{path}: not an index of a shard ({error!r})") from None
        self._check = check
        self._data: Optional[memoryview] = None

    def _read_index(self, index: dict[str, Any], path: pathlib.Path) -> None:
        if "/" in index["tar"] or index["tar"] in ("", ".", ".."):
            raise CorruptError(f"{path}: tar {index['tar']!r} is not a file beside its index")
        self.path = path.parent / index["tar"]
        self.stage, self.split, self.number = index["stage"], index["split"], index["number"]
        self.tar_bytes, self.tar_sha256 = index["tar_bytes"], index["tar_sha256"]
        self.failures: list[dict[str, Any]] = index["failures"]
        episodes = index["episodes"]
        self.keys: list[str] = [episode["key"] for episode in episodes]
        self.decisions = np.array([episode["decisions"] for episode in episodes], dtype=np.int64)
        self.members: list[str] = [member["name"] for member in episodes[0]["members"]] if episodes else []
        self._column = {name: i for i, name in enumerate(self.members)}
        shape = (len(episodes), len(self.members))
        if any([member["name"] for member in episode["members"]] != self.members for episode in episodes):
            raise CorruptError(f"{path}: keys with different members")
        if len(set(self.keys)) != len(self.keys) or any("." in key for key in self.keys):
            raise CorruptError(f"{path}: keys that repeat or hold a dot")
        places = [(m["offset"], m["size"], m["crc32c"]) for e in episodes for m in e["members"]]
        table = np.array(places, dtype=np.int64).reshape(-1, 3)
        offsets, sizes = table[:, 0], table[:, 1]
        by_place = np.argsort(offsets, kind="stable")
        ends = (offsets + sizes)[by_place]
        if len(table) and (table.min() < 0 or ends.max() > self.tar_bytes
                           or (offsets[by_place][1:] < ends[:-1]).any()):
            raise CorruptError(f"{path}: ranges that overlap or leave the tar")
        self._offset, self._size = offsets.reshape(shape), sizes.reshape(shape)
        self._crc = table[:, 2].astype(np.uint32).reshape(shape)
        self._checked = np.zeros(shape, dtype=bool)

    def __len__(self) -> int:
        return len(self.keys)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_data": None}

    def data(self) -> memoryview:
        """The mapped tar."""
        if self._data is None:
            try:
                with open(self.path, "rb") as file:
                    size = file.seek(0, 2)
                    if size != self.tar_bytes:
                        raise CorruptError(f"{self.path}: {size} bytes, its index says {self.tar_bytes}; "
                                           "the file was cut or replaced")
                    self._data = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
            except FileNotFoundError:
                raise MissingError(f"{self.path}: no such file, though its index is there") from None
        return self._data

    def release(self) -> None:
        """Forgets the map; the system frees it when no array refers to it any more."""
        self._data = None

    def member(self, episode: int, name: str, check: Optional[bool] = None) -> memoryview:
        """A member's bytes, compared with their checksum unless that was done or `check` is False."""
        column = self._column.get(name)
        if column is None:
            raise MissingError(f"{self.path}: {self.keys[episode]} has no member {name}; "
                               f"there are {', '.join(self.members)}")
        begin = int(self._offset[episode, column])
        data = self.data()[begin:begin + int(self._size[episode, column])]
        wanted = self._check if check is None else check
        if wanted and not self._checked[episode, column]:
            self._compare(data, episode, column)
        return data

    def _compare(self, data: memoryview, episode: int, column: int) -> None:
        found, written = crc32c(data), int(self._crc[episode, column])
        if found != written:
            raise CorruptError(f"{self.path}: {self.keys[episode]}.{self.members[column]} is damaged "
                               f"(CRC-32C {found:#010x}, written as {written:#010x})")
        self._checked[episode, column] = True

    def faults(self) -> list[str]:
        """Members that differ from their checksums, all of them compared anew."""
        found = []
        for episode in range(len(self)):
            for column, name in enumerate(self.members):
                try:
                    self._compare(self.member(episode, name, check=False), episode, column)
                except CorruptError as error:
                    found.append(str(error))
        return found


@dataclasses.dataclass(frozen=True)
class Episode:
    """One episode: arrays by name (`episode["cloud"]`), and `meta`."""
    shard: Shard
    position: int  # in the shard

    @property
    def key(self) -> str:
        return self.shard.keys[self.position]

    @property
    def decisions(self) -> int:
        return int(self.shard.decisions[self.position])

    def names(self) -> list[str]:
        """Names of the arrays."""
        return [name[:-4] for name in self.shard.members if name.endswith(".npy")]

    def __contains__(self, name: str) -> bool:
        return name + ".npy" in self.shard.members

    def __getitem__(self, name: str) -> np.ndarray:
        """A read-only array with a leading axis of decisions; a view of the mapped file."""
        where = f"{self.shard.path}: {self.key}.{name}.npy"
        array = read_npy(self.member(name + ".npy"), where)
        if array.ndim == 0 or len(array) != self.decisions:
            raise CorruptError(f"{where}: shape {array.shape}, the index says {self.decisions} decisions")
        return array

    def arrays(self) -> dict[str, np.ndarray]:
        return {name: self[name] for name in self.names()}

    @property
    def meta(self) -> dict[str, Any]:
        try:
            meta: dict[str, Any] = json.loads(bytes(self.member("meta.json")))
            return meta
        except ValueError as error:
            if isinstance(error, DatasetError):
                raise
            raise CorruptError(f"{self.shard.path}: {self.key}.meta.json is not JSON ({error})") from None

    def cameras(self) -> list[str]:
        """Names of the cameras that took pictures, if any: their arrays are called "depth_<camera>" and so on."""
        return [name[len("pose_"):] for name in self.names() if name.startswith("pose_")]

    def points(self, camera: str, decision: int) -> np.ndarray:
        """Where the pixels of a camera are in the world [m]: float32 (height, width, 3), NaN where there is no depth.

        Bit for bit the points that the policies' camera made its cloud of, where this is that camera and its exact
        depth ("depth32") was recorded; else from whole millimetres."""
        name = "depth32_" if "depth32_" + camera in self else "depth_"
        depth = self[name + camera][decision].astype(np.float64) / (1 if name == "depth32_" else 1000)
        matrix = self.meta["pictures"][camera]["intrinsic_matrix_px"]
        return back_project(depth, matrix, self["pose_" + camera][decision])

    def member(self, name: str) -> memoryview:
        """A member's bytes; the name holds the extension: "preview.png"."""
        return self.shard.member(self.position, name)


class Episodes(Sequence[Episode]):
    """All episodes of a stage's split in shard order, by index."""

    def __init__(self, shards: list[Shard]) -> None:
        self.shards = shards
        self._ends = np.cumsum([len(shard) for shard in shards], dtype=np.int64)
        self._open: collections.OrderedDict[int, Shard] = collections.OrderedDict()

    def __len__(self) -> int:
        return int(self._ends[-1]) if len(self._ends) else 0

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_open": collections.OrderedDict()}

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        i = index + len(self) if index < 0 else index
        if not 0 <= i < len(self):
            raise IndexError(f"no episode {index}, there are {len(self)}")
        number = int(np.searchsorted(self._ends, i, side="right"))
        shard = self.shards[number]
        self._touch(number)
        return Episode(shard, int(i - (self._ends[number] - len(shard))))

    def _touch(self, number: int) -> None:
        """Keeps the shards that were used last mapped, and no more of them than OPEN_SHARDS."""
        self._open[number] = self.shards[number]
        self._open.move_to_end(number)
        if len(self._open) > OPEN_SHARDS:
            self._open.popitem(last=False)[1].release()

    def decisions(self) -> np.ndarray:
        """Number of decisions of each episode, int64."""
        return np.concatenate([shard.decisions for shard in self.shards] or [np.zeros(0, dtype=np.int64)])


class Samples(Sequence[Dict[str, np.ndarray]]):
    """All decisions of a stage's split, by index: dicts of one row of each array."""

    def __init__(self, episodes: Episodes, names: Optional[Sequence[str]] = None) -> None:
        self.episodes = episodes
        self.names = list(names) if names is not None else (episodes[0].names() if len(episodes) else [])
        self._ends = np.cumsum(episodes.decisions())

    def __len__(self) -> int:
        return int(self._ends[-1]) if len(self._ends) else 0

    def place(self, index: int) -> tuple[int, int]:
        """Episode and decision of a sample."""
        i = index + len(self) if index < 0 else index
        if not 0 <= i < len(self):
            raise IndexError(f"no sample {index}, there are {len(self)}")
        episode = int(np.searchsorted(self._ends, i, side="right"))
        return episode, int(i - (self._ends[episode - 1] if episode else 0))

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        number, decision = self.place(index)
        episode = self.episodes[number]
        return {name: episode[name][decision] for name in self.names}


class Dataset:
    """A dataset's folder. `record` is dataset.json, `provenance` is provenance.json, both as dicts."""

    def __init__(self, folder: Union[str, pathlib.Path], check: bool = True) -> None:
        self.folder = pathlib.Path(folder)
        self._check = check
        path = self.folder / "dataset.json"
        self.record = _read_json(path, "doorforge.dataset")
        self.provenance = _read_json(self.folder / "provenance.json", "doorforge.provenance")
        try:
            self.features = {f["name"]: _picked(Feature, {**f, "shape": tuple(f["shape"])}, path)
                             for f in self.record["features"]}
            self.parts: list[Part] = [_picked(Part, part, path) for part in self.record["parts"]]
            self.statistics = {
                name: _picked(Statistics, {key: np.array(value) for key, value in numbers.items()}, path)
                for name, numbers in self.record["train_statistics"].items()}
            self.cloud_radius_m = float(self.record["train_cloud_radius_m"])
        except (KeyError, TypeError) as error:
            raise CorruptError(f"{path}: not a dataset's record ({error!r})") from None

    def shards(self, stage: str, split: str) -> list[Shard]:
        folder = self.folder / stage / split
        if not folder.is_dir():
            there = ", ".join(f"{part.stage}/{part.split}" for part in self.parts)
            raise MissingError(f"{folder}: no such part; the dataset has {there}")
        return [Shard(path, self._check) for path in sorted(folder.glob("shard-*.index.json"))]

    def episodes(self, stage: str, split: str) -> Episodes:
        return Episodes(self.shards(stage, split))

    def samples(self, stage: str, split: str, names: Optional[Sequence[str]] = None) -> Samples:
        """The split's decisions; `names` picks arrays, all of them by default."""
        return Samples(self.episodes(stage, split), names)

    def split(self, name: str) -> list[str]:
        """Ids of the doors of a split."""
        path = self.folder / "splits" / f"{name}.txt"
        try:
            return path.read_text().split()
        except FileNotFoundError:
            raise MissingError(f"{path}: no such split") from None

    def failures(self) -> Iterator[dict[str, Any]]:
        """Every planned episode that failed, with its cause."""
        with open(self.folder / "failures.jsonl", encoding="utf-8") as lines:
            for line in lines:
                yield json.loads(line)


# --- pictures ---------------------------------------------------------------------------------------


def back_project(depth: np.ndarray, intrinsic_matrix_px: Any, world_from_camera: np.ndarray) -> np.ndarray:
    """Points in the world, float32 (height, width, 3), of depths along the optical axis [m]; NaN where it is 0.

    The camera looks along z, x is right and y down; the first pixel has its centre at (0.5, 0.5). The operations, their order, and
    that the z of a ray's direction alone is rounded are those of the clouds, so that the points are equal bit for bit."""
    height, width = depth.shape
    (fx, _, cx), (_, fy, cy) = intrinsic_matrix_px[:2]
    x = ((np.arange(width) + 0.5 - cx) / fx)[np.newaxis, :]
    y = ((np.arange(height) + 0.5 - cy) / fy)[:, np.newaxis]
    depth = np.where(depth > 0, depth, np.nan)
    points = np.empty((height, width, 3), dtype=np.float32)
    for row, (a, b, c, origin) in enumerate(np.asarray(world_from_camera, dtype=np.float64)):
        direction = (a * x + b * y) + c if row < 2 else (a * x + (b * y + c)).astype(np.float32).astype(np.float64)
        points[..., row] = origin + depth * direction
    return points


# --- order and streams -----------------------------------------------------------------------------


def order(count: int, seed: int, epoch: int) -> np.ndarray:
    """A permutation of range(count): a pure function of its arguments, the same for every version of
    numpy, so that a run that was stopped at a step goes on there without repeating data."""
    mask = (1 << 64) - 1
    start = (seed * 0x9E3779B97F4A7C15 + epoch * 0xD1342543DE82EF95 + 0x2545F4914F6CDD1D) & mask
    z = np.arange(count, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(start)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):  # SplitMix64
        z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
    return np.argsort(z ^ (z >> np.uint64(31)), kind="stable")


def stream(file: BinaryIO, index: Optional[dict[str, Any]] = None) -> Iterator[tuple[str, dict[str, bytes]]]:
    """Episodes of a tar as they come, from anything that can be read once, such as a pipe: pairs of
    key and members by name. With the parsed index, members are compared with their checksums."""
    wanted: dict[str, int] = {}
    if index is not None:
        wanted = {f"{e['key']}.{m['name']}": m["crc32c"] for e in index["episodes"] for m in e["members"]}
    members: dict[str, bytes] = {}
    key, seen = "", 0
    try:
        with tarfile.open(fileobj=file, mode="r|") as archive:
            for item in archive:
                member_key, _, name = item.name.partition(".")
                if member_key != key and members:
                    yield key, members
                    members = {}
                content = archive.extractfile(item)
                data = content.read() if content is not None else b""
                if index is not None and crc32c(data) != wanted.get(item.name):
                    raise CorruptError(f"{item.name}: not the bytes in the index")
                key, members[name], seen = member_key, data, seen + 1
    except tarfile.TarError as error:
        raise CorruptError(f"after {key or 'the beginning'}: the tar is cut or damaged ({error})") from None
    if index is not None and seen != len(wanted):
        raise CorruptError(f"after {key or 'the beginning'}: {seen} of {len(wanted)} members")
    if members:
        yield key, members


# --- summary ---------------------------------------------------------------------------------------


def _print_part(data: Dataset, part: Part) -> None:
    print(f"\n{part.stage}/{part.split}: {part.episodes} episodes, {part.failed_episodes} failed, "
          f"{part.decisions} decisions, {part.shards} shards, {part.bytes / 2**20:.1f} MiB")
    episodes = data.episodes(part.stage, part.split)
    if not episodes:
        return
    for name, array in episodes[0].arrays().items():
        columns = [(e[name].min(), e[name].sum(dtype=np.float64), e[name].size, e[name].max()) for e in episodes]
        low, total, size, high = (np.array(column) for column in zip(*columns))
        print(f"  {name:8} {array.dtype.str} decisions x {str(array.shape[1:]):12} "
              f"min {low.min():10.4f}  mean {total.sum() / size.sum():10.4f}  max {high.max():10.4f}")


def _summary(folder: str, check: bool) -> int:
    data = Dataset(folder, check=False)
    print(f"{folder}: made by doorforge {data.provenance['code_version']}, "
          f"seed {data.provenance['seed']}, {len(data.provenance['doors'])} doors")
    faults: list[str] = []
    for part in data.parts:
        _print_part(data, part)
        if check:
            faults += [fault for shard in data.shards(part.stage, part.split) for fault in shard.faults()]
    causes = collections.Counter(failure["outcome"] for failure in data.failures())
    if causes:
        print("\nfailed episodes: " + ", ".join(f"{n} {cause}" for cause, n in sorted(causes.items())))
    for fault in faults:
        print("damaged: " + fault)
    return 1 if faults else 0


def main(arguments: list[str]) -> int:
    folders = [a for a in arguments if not a.startswith("-")]
    if len(folders) != 1 or any(a.startswith("-") and a != "--check" for a in arguments):
        print(__doc__)
        return 2
    try:
        return _summary(folders[0], "--check" in arguments)
    except (OSError, DatasetError) as error:
        print(f"doorforge_reader: {error}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
