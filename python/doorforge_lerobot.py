# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Copies a stage of a doorforge dataset into LeRobot's format. One file: copy it, with doorforge_reader.py, where you need it.

    python3 doorforge_lerobot.py data --out lerobot                            # also: python3 -m doorforge.lerobot
    python3 doorforge_lerobot.py data --out lerobot --images video --points 0  # doorforge dataset export data --to lerobot

    import doorforge_lerobot
    doorforge_lerobot.export("data", "lerobot", doorforge_lerobot.Options(stage="open", points=1024))

Reading needs numpy; writing tables pyarrow, video PyAV: pip install "doorforge[lerobot]", or pyarrow and av. Killed at any moment,
the same call goes on. What is written is told in docs/lerobot.md of doorforge, why so in docs/design/lerobot.md.
"""
from __future__ import annotations

import argparse
import contextlib
import dataclasses
import fcntl
import functools
import hashlib
import importlib
import importlib.util
import io
import json
import os
import pathlib
import shutil
import signal
import struct
import sys
import time
import zlib
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence, Union


def _load_reader() -> Any:
    """The reader that is installed, or the one beside this file."""
    try:
        return importlib.import_module("doorforge_reader")
    except ModuleNotFoundError as error:
        if error.name != "doorforge_reader":
            raise
    path = pathlib.Path(__file__).with_name("doorforge_reader.py")
    if not path.exists():
        raise ImportError(f"{path}: no such file; doorforge_lerobot.py wants doorforge_reader.py beside it")
    spec = importlib.util.spec_from_file_location("doorforge_reader", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["doorforge_reader"] = module
    spec.loader.exec_module(module)
    return module


try:
    reader: Any = _load_reader()
except ImportError as problem:
    if __name__ != "__main__":
        raise
    print(f"doorforge_lerobot: {problem}", file=sys.stderr)
    sys.exit(3)

import numpy as np  # noqa: E402  (the reader says what to install where it is missing)

FPS = 6  # decisions a second
STAGES = ("open", "handle", "grasp")
VERSIONS = ("v3.0", "v2.1")
IMAGES = ("png", "video")
DEFAULT_POINTS = 1024
QUANTILES = {"q01": 0.01, "q10": 0.10, "q50": 0.50, "q90": 0.90, "q99": 0.99}
FILE_BYTES = 100 << 20  # of episodes in a data file of v3.0, before compression
CHUNK_FILES = 1000
VIDEO_SHARE = 10  # a video takes less than its pixels by so much
WAY_OUT = "make room, or choose another --out"
STATE_NAMES = ([f"joint_{i}.position" for i in range(11)] + [f"joint_{i}.velocity" for i in range(11)]
               + ["base.x", "base.y", "base.z", "hand.x", "hand.y", "hand.z", "hand.qx", "hand.qy", "hand.qz", "hand.qw"])
ACTION_NAMES = ["hand.dx", "hand.dy", "hand.dz"] + [f"hand.rotation_{row}{column}" for row in range(2) for column in range(3)]

PathLike = Union[str, "os.PathLike[str]"]
Stats = dict[str, Any]  # "mean" and so on, float64 arrays; "count" is one integer


class ExportError(reader.DatasetError):  # type: ignore[name-defined, misc]
    """An export cannot be made; the message says what, where and what to do. `exit_code` is the program's."""

    def __init__(self, message: str, exit_code: int = 3) -> None:
        super().__init__(message)
        self.exit_code = exit_code


@dataclasses.dataclass(frozen=True)
class Options:
    """What is exported, and how."""
    stage: str = "open"
    codebase_version: str = "v3.0"  # "v2.1" is what GR00T reads
    points: Optional[int] = None  # of each cloud; None: 1024, or all if there are fewer; 0: no clouds
    images: str = "png"  # within the tables, without loss; "video": MP4, with some
    depth: bool = False  # also the depth of the cameras, as 16-bit pictures in millimetres
    cameras: Optional[tuple[str, ...]] = None  # None: all

    def check(self) -> None:
        for name, value, known in (("stage", self.stage, STAGES), ("codebase-version", self.codebase_version, VERSIONS),
                                   ("images", self.images, IMAGES)):
            if value not in known:
                raise ExportError(f"--{name}: {value!r}, expected one of {', '.join(known)}", 2)
        if self.points is not None and self.points < 0:
            raise ExportError(f"--points: {self.points}, expected 0 or more", 2)
        if self.depth and self.codebase_version != "v3.0":
            raise ExportError("--depth: readers of v2.1 do not know pictures of 16 bits; use v3.0", 2)


# --- columns ---------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Column:
    """A feature of the export, and the array of the shards that it is made of."""
    name: str
    source: str
    dtype: str  # as in info.json: numpy's, "image" or "video"
    shape: tuple[int, ...]
    names: Optional[list[str]] = None
    info: Optional[dict[str, Any]] = None

    @property
    def is_picture(self) -> bool:
        return self.dtype in ("image", "video")

    @property
    def is_depth(self) -> bool:
        return bool(self.info and self.info.get("is_depth_map"))

    @property
    def frame_bytes(self) -> int:
        """Bytes that a decision takes at most."""
        size = 2 if self.is_depth else 1 if self.is_picture else np.dtype(self.dtype).itemsize
        share = VIDEO_SHARE if self.dtype == "video" else 1
        return -(-size * int(np.prod(self.shape)) // share)

    def values(self, episode: Any) -> np.ndarray:
        """The numbers of an episode, decisions x shape."""
        decisions = episode.decisions
        if self.source == "success":
            ended = np.arange(decisions) == decisions - 1
            return (ended & bool(episode.meta["success"])) if self.name == "next.success" else ended
        array = episode[self.source]
        if self.source in ("cloud", "cloud_rgb"):
            array = array[:, :self.shape[0]]
        if array.size != decisions * int(np.prod(self.shape)):
            raise ExportError(f"{episode.shard.path}: {episode.key}.{self.source}.npy: shape {array.shape}, the first episode's "
                              f"decisions have {self.shape}; LeRobot wants one shape in all episodes: export parts that agree, "
                              "or leave cameras out with --cameras")
        return array.reshape((decisions, *self.shape))


def _picture_columns(episode: Any, options: Options) -> list[Column]:
    there = episode.cameras()
    wanted = list(there) if options.cameras is None else list(options.cameras)
    for camera in wanted:
        if camera not in there:
            raise ExportError(f"--cameras: no camera {camera!r}; the episodes have {', '.join(there) or 'none'}", 2)
    columns = []
    for camera in wanted:
        if "rgb_" + camera in episode:
            height, width = episode["rgb_" + camera].shape[1:3]
            _check_video_size(camera, height, width, options)
            dtype = "video" if options.images == "video" else "image"
            columns.append(Column(f"observation.images.{camera}", "rgb_" + camera, dtype, (height, width, 3),
                                  ["height", "width", "channels"]))
        if options.depth and "depth_" + camera in episode:
            height, width = episode["depth_" + camera].shape[1:3]
            columns.append(Column(f"observation.images.{camera}_depth", "depth_" + camera, "image", (height, width, 1),
                                  ["height", "width", "channels"], {"is_depth_map": True, "depth_unit": "mm"}))
    if options.depth and not any(column.is_depth for column in columns):
        raise ExportError("--depth: the episodes have no depth_<camera>; see docs/images.md of doorforge", 2)
    return columns


def _check_video_size(camera: str, height: int, width: int, options: Options) -> None:
    if options.images == "video" and (height % 2 or width % 2):
        raise ExportError(f"camera {camera}: {width} x {height} pixels, and videos have even sides; use --images png", 2)


def columns_of(episode: Any, options: Options) -> list[Column]:
    """The features that this episode, and so all of them, are exported as."""
    points = episode["cloud"].shape[1]
    if options.points is not None and options.points > points:
        raise ExportError(f"--points: {options.points}, the clouds have {points}", 2)
    count = min(DEFAULT_POINTS, points) if options.points is None else options.points
    columns = [Column("observation.state", "proprio", "float32", (32,), STATE_NAMES)]
    if count > 0:
        columns.append(Column("observation.pointcloud", "cloud", "float32", (count, 3), ["point", "xyz"]))
        if "cloud_rgb" in episode:
            columns.append(Column("observation.pointcloud_rgb", "cloud_rgb", "uint8", (count, 3), ["point", "rgb"]))
    return columns + _picture_columns(episode, options) + [
        Column("action", "action", "float32", (9,), ACTION_NAMES), Column("next.reward", "score", "float32", (1,)),
        Column("next.success", "success", "bool", (1,)), Column("next.done", "success", "bool", (1,))]


NUMBERING = [Column("timestamp", "", "float32", (1,)), *(Column(name, "", "int64", (1,)) for name in (
    "frame_index", "episode_index", "index", "task_index"))]

# --- sentences -------------------------------------------------------------------------------------

_OBJECTS = {"interior": "door", "window": "window", "car": "car door", "safe": "safe", "storagefurniture": "cupboard",
            "refrigerator": "refrigerator"}
_HANDLES = {"none": "handle", "lever": "lever", "round": "knob", "key": "key", "valve": "wheel", "flap": "flap"}


def sentence_of(meta: dict[str, Any], stage: str) -> str:
    """What the robot is asked to do, of an episode's meta data: "turn the lever of the window"."""
    door = meta["door"]
    thing = _OBJECTS.get(door["category"], door["category"])
    handle = _HANDLES.get(door["mechanism"], "handle")
    other = meta.get("way") == "other"
    if stage == "grasp":
        return f"take hold of the {handle} of the {thing}"
    if stage == "open":
        return f"{'push' if other else 'pull'} the {thing} open by its {handle}"
    if handle in ("lever", "flap"):
        return f"{'lift' if other or handle == 'flap' else 'turn'} the {handle} of the {thing}"
    return f"turn the {handle} of the {thing}" + (" the other way" if other else "")


# --- pictures --------------------------------------------------------------------------------------


def png_bytes(pixels: np.ndarray) -> bytes:
    """A PNG of uint8 (height, width, 3) or uint16 (height, width, 1)."""
    height, width, channels = pixels.shape
    depth, color = (16, 0) if channels == 1 else (8, 2)
    octets = np.ascontiguousarray(pixels.astype(">u2" if depth == 16 else np.uint8)).view(np.uint8).reshape(height, -1)
    rows = np.empty((height, 1 + octets.shape[1]), dtype=np.uint8)
    rows[:, 0] = 2  # each row as the difference from the one above, which compresses better
    rows[0, 1:] = octets[0]
    np.subtract(octets[1:], octets[:-1], out=rows[1:, 1:])

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 4))
            + chunk(b"IEND", b""))


def write_video(path: pathlib.Path, frames: Iterable[np.ndarray], size: tuple[int, int]) -> None:
    """H.264 in MP4, `size` is width and height: every second picture is whole, so that any is found at once. The same frames and
    encoder give the same bytes."""
    av = importlib.import_module("av")
    with av.open(str(path), "w", format="mp4") as container:
        stream = container.add_stream("libx264", rate=FPS, options={"crf": "14", "g": "2", "bf": "0"})
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        stream.codec_context.thread_count = 1
        for pixels in frames:
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(pixels), format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


# --- statistics ------------------------------------------------------------------------------------


def quantiles_of_counts(counts: np.ndarray, shares: Sequence[float]) -> list[float]:
    """Quantiles, linear between neighbours as numpy's, of whole numbers of which there are `counts`."""
    cumulative = np.cumsum(counts)
    places = np.array(shares) * (cumulative[-1] - 1)
    below = np.floor(places)
    low = np.searchsorted(cumulative, below, side="right")
    high = np.searchsorted(cumulative, np.ceil(places), side="right")
    return [float(value) for value in low + (places - below) * (high - low)]


def stats_of_values(values: np.ndarray) -> Stats:
    """Of decisions x components: each component's own, float64."""
    numbers = np.asarray(values, dtype=np.float64)
    stats = {"min": numbers.min(0), "max": numbers.max(0), "mean": numbers.mean(0), "std": numbers.std(0),
             "count": len(numbers)}
    return {**stats, **{name: np.quantile(numbers, share, axis=0) for name, share in QUANTILES.items()}}


def stats_of_counts(counts: np.ndarray, decisions: int, scale: float) -> Stats:
    """Of pictures: `counts` of channels x values, divided by `scale`; shape channels x 1 x 1."""
    levels = np.arange(counts.shape[1], dtype=np.float64)
    total = counts.sum(1)
    mean = counts @ levels / total
    square = np.array([row @ (levels - middle) ** 2 for row, middle in zip(counts.astype(np.float64), mean)]) / total
    there = [np.flatnonzero(row) for row in counts]
    found = {"min": [row[0] for row in there], "max": [row[-1] for row in there], "mean": mean, "std": np.sqrt(square)}
    by_quantile = np.array([quantiles_of_counts(row, list(QUANTILES.values())) for row in counts])
    found.update({name: by_quantile[:, i] for i, name in enumerate(QUANTILES)})
    shaped = {name: np.asarray(value, dtype=np.float64).reshape(-1, 1, 1) / scale for name, value in found.items()}
    return {**shaped, "count": decisions}


def merged_stats(parts: Sequence[Stats]) -> Stats:
    """Of all decisions of several stats; without quantiles, which do not merge."""
    counts = np.array([part["count"] for part in parts], dtype=np.float64)
    weights = counts / counts.sum()
    means = np.array([part["mean"] for part in parts])
    mean = np.tensordot(weights, means, 1)
    spread = np.tensordot(weights, np.array([part["std"] for part in parts]) ** 2 + (means - mean) ** 2, 1)
    return {"min": np.min([part["min"] for part in parts], 0), "max": np.max([part["max"] for part in parts], 0),
            "mean": mean, "std": np.sqrt(spread), "count": int(counts.sum())}


_MILLIMETRES = 32768  # coordinates of clouds lie within so many, on either side


class Tally:
    """What statistics over many episodes need of a column: small values themselves, pictures and clouds as counts."""

    def __init__(self, column: Column) -> None:
        self.column = column
        self.is_cloud = column.name.startswith("observation.pointcloud")
        self.stats: list[Stats] = []  # an episode each
        self.kept: list[np.ndarray] = []  # of the train split: values, or one array of counts

    def add(self, values: np.ndarray, keep: bool) -> None:
        if self.column.is_picture:
            counts = self._counts(values.reshape(-1, values.shape[-1]))
            self.stats.append(stats_of_counts(counts, len(values), self._scale()))
        elif self.is_cloud:
            rows = values.reshape(-1, 3)
            stats = stats_of_values(rows)
            self.stats.append({name: np.atleast_2d(value) for name, value in stats.items()} | {"count": len(values)})
            counts = self._counts(self._whole(rows))
        else:
            self.stats.append(stats_of_values(values.reshape(len(values), -1)))
            counts = np.asarray(values).reshape(len(values), -1)
        if keep:
            self._keep(counts)

    def _scale(self) -> float:
        return 1.0 if self.column.is_depth else 255.0

    def _levels(self) -> int:
        if self.column.dtype == "float32":
            return 2 * _MILLIMETRES
        return 65536 if self.column.is_depth else 256

    def _whole(self, rows: np.ndarray) -> np.ndarray:
        if self.column.dtype != "float32":
            return rows
        millimetres = np.rint(1000 * rows.astype(np.float64)) + _MILLIMETRES
        return np.clip(millimetres, 0, 2 * _MILLIMETRES - 1).astype(np.int64)

    def _counts(self, whole: np.ndarray) -> np.ndarray:
        return np.array([np.bincount(channel, minlength=self._levels()) for channel in whole.T])

    def _keep(self, array: np.ndarray) -> None:
        if self.kept and (self.column.is_picture or self.is_cloud):
            self.kept[0] += array
        else:
            self.kept.append(array)

    def quantiles(self) -> Stats:
        """Of what was kept, in the shape of the statistics; of clouds to a millimetre."""
        shares = list(QUANTILES.values())
        if not (self.column.is_picture or self.is_cloud):
            found = np.quantile(np.concatenate(self.kept).astype(np.float64), shares, axis=0)
            return dict(zip(QUANTILES, found))
        found = np.array([quantiles_of_counts(row, shares) for row in self.kept[0]]).T
        if self.column.is_picture:
            return dict(zip(QUANTILES, found.reshape(len(shares), -1, 1, 1) / self._scale()))
        if self.column.dtype == "float32":
            found = (found - _MILLIMETRES) / 1000
        return dict(zip(QUANTILES, found[:, np.newaxis, :]))

    def total(self, of: Sequence[Stats]) -> Stats:
        return {**merged_stats(of), **self.quantiles()}


def _plain(stats: Stats) -> dict[str, Any]:
    """As lists for JSON; the count is a list of one."""
    return {name: [int(value)] if name == "count" else np.asarray(value, dtype=np.float64).tolist()
            for name, value in stats.items()}


# --- tables ----------------------------------------------------------------------------------------


def _huggingface_feature(column: Column) -> dict[str, Any]:
    if column.dtype == "image":
        return {"_type": "Image"}
    value = {"dtype": column.dtype, "_type": "Value"}
    if column.shape == (1,):
        return value
    if len(column.shape) == 1:
        return {"feature": value, "length": column.shape[0], "_type": "Sequence"}
    return {"shape": list(column.shape), "dtype": column.dtype, "_type": "Array2D"}


def _arrow_type(pa: Any, column: Column) -> Any:
    if column.dtype == "image":
        return pa.struct([("bytes", pa.binary()), ("path", pa.string())])
    value = pa.from_numpy_dtype(np.dtype(column.dtype))
    if column.shape == (1,):
        return value
    return pa.list_(value, column.shape[0]) if len(column.shape) == 1 else pa.list_(pa.list_(value))


def _arrow_array(pa: Any, column: Column, values: np.ndarray) -> Any:
    if column.dtype == "image":
        pictures = pa.array([png_bytes(pixels) for pixels in values], pa.binary())
        paths = pa.array([f"{column.source}_{i:06d}.png" for i in range(len(values))], pa.string())
        return pa.StructArray.from_arrays([pictures, paths], ["bytes", "path"])
    flat = pa.array(np.ascontiguousarray(values).ravel())
    if column.shape == (1,):
        return flat
    if len(column.shape) == 1:
        return pa.FixedSizeListArray.from_arrays(flat, column.shape[0])
    rows, width = column.shape
    inner = pa.ListArray.from_arrays(np.arange(0, len(flat) + 1, width, dtype=np.int32), flat)
    return pa.ListArray.from_arrays(np.arange(0, len(inner) + 1, rows, dtype=np.int32), inner)


def write_table(path: pathlib.Path, columns: Sequence[Column], episodes: Iterable[dict[str, np.ndarray]]) -> None:
    """Parquet, one group of rows an episode, with the features that `datasets` of Hugging Face reads."""
    pa, parquet = importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
    stored = [column for column in columns if column.dtype != "video"]
    features = {"info": {"features": {column.name: _huggingface_feature(column) for column in stored}}}
    schema = pa.schema([(column.name, _arrow_type(pa, column)) for column in stored],
                       metadata={"huggingface": json.dumps(features)})
    with parquet.ParquetWriter(path, schema, compression="snappy") as writer:
        for values in episodes:
            arrays = [_arrow_array(pa, column, values[column.name]) for column in stored]
            writer.write_table(pa.Table.from_arrays(arrays, schema=schema))


# --- plan ------------------------------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class PlannedEpisode:
    """An episode's place in the export."""
    index: int
    first_frame: int
    split: str
    task: str
    episode: Any

    @property
    def decisions(self) -> int:
        return int(self.episode.decisions)


@dataclasses.dataclass(frozen=True)
class PlannedFile:
    """A file of data, which holds episodes of one split."""
    number: int
    split: str
    episodes: list[PlannedEpisode]

    @property
    def chunk(self) -> int:
        return self.number // CHUNK_FILES

    @property
    def place(self) -> int:
        """Within the chunk."""
        return self.number % CHUNK_FILES


def _split_order(data: Any, stage: str) -> list[str]:
    splits = [part.split for part in data.parts if part.stage == stage and part.decisions > 0]
    if not splits:
        there = ", ".join(f"{part.stage}/{part.split}" for part in data.parts) or "none"
        raise ExportError(f"{data.folder}: no episodes of stage {stage!r}; the dataset has {there}")
    return sorted(splits, key=lambda split: split != "train")


def plan_episodes(data: Any, stage: str) -> list[PlannedEpisode]:
    """All episodes in their order: the train split first, then the others as dataset.json has them."""
    planned: list[PlannedEpisode] = []
    frame = 0
    for split in _split_order(data, stage):
        for episode in data.episodes(stage, split):
            if episode.decisions == 0:
                continue
            planned.append(PlannedEpisode(len(planned), frame, split, sentence_of(episode.meta, stage), episode))
            frame += episode.decisions
    return planned


def plan_files(episodes: Sequence[PlannedEpisode], frame_bytes: int, most_bytes: int) -> list[PlannedFile]:
    """Files of at most so many bytes, where an episode has no more; none holds two splits."""
    files: list[PlannedFile] = []
    filled = 0
    for episode in episodes:
        size = episode.decisions * frame_bytes
        if not files or files[-1].split != episode.split or filled + size > most_bytes:
            files.append(PlannedFile(len(files), episode.split, []))
            filled = 0
        files[-1].episodes.append(episode)
        filled += size
    return files


# --- files -----------------------------------------------------------------------------------------


def _commit(path: pathlib.Path, write: Callable[[pathlib.Path], Any]) -> None:
    """Writes under a hidden name, which becomes `path` when everything is on the disk."""
    path.parent.mkdir(parents=True, exist_ok=True)
    hidden = path.with_name(f".{path.name}.partial")
    write(hidden)
    with open(hidden, "rb") as file:
        os.fsync(file.fileno())
    os.replace(hidden, path)


def _commit_json(path: pathlib.Path, record: Any) -> None:
    _commit(path, lambda hidden: hidden.write_text(json.dumps(record, indent=4) + "\n"))


def _commit_lines(path: pathlib.Path, records: Iterable[Any]) -> None:
    _commit(path, lambda hidden: hidden.write_text("".join(json.dumps(record) + "\n" for record in records)))


def bytes_below(folder: pathlib.Path) -> int:
    return sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file())


def require_space(folder: pathlib.Path, needed: int) -> None:
    """Refuses what would certainly fill the disk."""
    existing = next(parent for parent in (folder.absolute(), *folder.absolute().parents) if parent.exists())
    free = shutil.disk_usage(existing).free
    if needed > free:
        raise ExportError(f"{folder}: about {-(-needed >> 20)} MiB are needed, {free >> 20} MiB are free; {WAY_OUT}"
                          .replace("about 0 ", "about 1 "))


def require_modules(columns: Sequence[Column]) -> None:
    """Asks for what writing needs before anything is written."""
    wanted = ["pyarrow"] + (["av"] if any(column.dtype == "video" for column in columns) else [])
    missing = [name for name in wanted if importlib.util.find_spec(name) is None]
    if missing:
        what = "video" if missing == ["av"] else "LeRobot's tables"
        raise ExportError(f"{what} cannot be written: {sys.executable} has no {' and no '.join(missing)}; "
                          f"{sys.executable} -m pip install {' '.join(missing)}"
                          + (", or use --images png" if missing == ["av"] else ", or give another --python that has it"))


# --- the export ------------------------------------------------------------------------------------


class Export:
    """A planned export. The plan is a pure function of dataset and options."""

    def __init__(self, folder: PathLike, out: PathLike, options: Options = Options()) -> None:
        options.check()
        self.out, self.options = pathlib.Path(out), options
        self.data = reader.Dataset(folder)
        self.episodes = plan_episodes(self.data, options.stage)
        self.columns = columns_of(self.episodes[0].episode, options)
        self.all_columns = self.columns + NUMBERING
        self.tasks = list(dict.fromkeys(episode.task for episode in self.episodes))
        most = FILE_BYTES if options.codebase_version == "v3.0" else 0
        self.frame_bytes = sum(column.frame_bytes for column in self.all_columns)
        self.files = plan_files(self.episodes, self.frame_bytes, most)
        self.notes = self.out / ".export"

    @property
    def frames(self) -> int:
        return sum(episode.decisions for episode in self.episodes)

    @functools.cached_property
    def plan(self) -> dict[str, Any]:
        """What tells one export from another."""
        content = hashlib.sha256()
        for split in _split_order(self.data, self.options.stage):
            for shard in self.data.shards(self.options.stage, split):
                content.update(shard.tar_sha256.encode())
        options = {**dataclasses.asdict(self.options), "cameras": [
            column.source[len("rgb_"):] for column in self.columns if column.source.startswith("rgb_")]}
        options["points"] = next((column.shape[0] for column in self.columns if column.source == "cloud"), 0)
        return {"shards_sha256": content.hexdigest(), "config_sha256": self.data.provenance["config_sha256"],
                "seed": self.data.provenance["seed"], "made_by": self.data.provenance["code_version"], **options}

    # --- running ---

    def run(self, on_file: Callable[[int, int], None] = lambda done, files: None,
            stopped: Callable[[], bool] = lambda: False) -> bool:
        """Makes what is not there yet; False if `stopped` said so between two episodes."""
        if self._is_done():
            return True
        there = bytes_below(self.out) if self.out.exists() else 0
        require_space(self.out, self.frames * self.frame_bytes - there)
        require_modules(self.columns)
        self.notes.mkdir(parents=True, exist_ok=True)
        with self._only_one():
            if not (self.notes / "plan.json").exists():
                _commit_json(self.notes / "plan.json", self.plan)
            for file in self.files:
                if not self._has(file) and not self._write(file, stopped):
                    return False
                on_file(file.number + 1, len(self.files))
            self._finish()
        shutil.rmtree(self.notes)
        return True

    def _is_done(self) -> bool:
        """Whether the folder holds this export; refuses one that holds anything else."""
        if not self.out.exists():
            return False
        if not self.out.is_dir():
            raise ExportError(f"{self.out}: is a file; --out is a folder to be made", 2)
        begun, done = self.notes / "plan.json", self.out / "meta/doorforge.json"
        record = begun if begun.exists() else done
        if record.exists():
            self._refuse_another(json.loads(record.read_text()))
            return record == done and (self.out / "meta/info.json").exists()
        if any(path != self.notes for path in self.out.iterdir()):
            raise ExportError(f"{self.out}: holds something else; choose another --out, or remove the folder yourself", 2)
        return False

    def _refuse_another(self, found: dict[str, Any]) -> None:
        other = [f"{name} is {found.get(name)!r} there, {value!r} here" for name, value in self.plan.items()
                 if found.get(name) != value]
        if other:
            raise ExportError(f"{self.out}: holds another export: {'; '.join(other)}. Choose another --out, or remove the "
                              "folder yourself", 2)

    @contextlib.contextmanager
    def _only_one(self) -> Iterator[None]:
        with open(self.notes / "lock", "w", encoding="ascii") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise ExportError(f"{self.out}: another process writes into it") from None
            yield

    # --- files of data ---

    def data_path(self, file: PlannedFile) -> str:
        return self._data_template().format(chunk_index=file.chunk, file_index=file.place, episode_chunk=file.chunk,
                                            episode_index=file.number)

    def video_path(self, file: PlannedFile, key: str) -> str:
        return self._video_template().format(video_key=key, chunk_index=file.chunk, file_index=file.place,
                                             episode_chunk=file.chunk, episode_index=file.number)

    def _data_template(self) -> str:
        if self.options.codebase_version == "v2.1":
            return "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet"
        return "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"

    def _video_template(self) -> str:
        if self.options.codebase_version == "v2.1":
            return "videos/chunk-{episode_chunk:03d}/{video_key}/episode_{episode_index:06d}.mp4"
        return "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"

    def _note_path(self, file: PlannedFile) -> pathlib.Path:
        return self.notes / f"file-{file.number:06d}.npz"

    def _videos(self) -> list[Column]:
        return [column for column in self.columns if column.dtype == "video"]

    def _has(self, file: PlannedFile) -> bool:
        paths = [self.data_path(file), *(self.video_path(file, column.name) for column in self._videos())]
        return self._note_path(file).exists() and all((self.out / path).exists() for path in paths)

    def rows_of(self, planned: PlannedEpisode) -> dict[str, np.ndarray]:
        """The columns of an episode, each decisions x shape."""
        rows = {column.name: column.values(planned.episode) for column in self.columns}
        frames = np.arange(planned.decisions, dtype=np.int64)
        rows["timestamp"] = (frames / FPS).astype(np.float32)
        rows["frame_index"], rows["index"] = frames, frames + planned.first_frame
        rows["episode_index"] = np.full_like(frames, planned.index)
        rows["task_index"] = np.full_like(frames, self.tasks.index(planned.task))
        return rows

    def _write(self, file: PlannedFile, stopped: Callable[[], bool]) -> bool:
        episodes = []
        tallies = {column.name: Tally(column) for column in self.all_columns}
        for planned in file.episodes:
            if stopped():
                return False
            rows = self.rows_of(planned)
            for name, tally in tallies.items():
                tally.add(rows[name], keep=file.split == self._counted_split())
            episodes.append(rows)
        for column in self._videos():
            height, width = column.shape[:2]
            frames = (pixels for rows in episodes for pixels in rows[column.name])
            _commit(self.out / self.video_path(file, column.name),
                    functools.partial(write_video, frames=frames, size=(width, height)))
        _commit(self.out / self.data_path(file), lambda hidden: write_table(hidden, self.all_columns, episodes))
        self._write_note(file, tallies)
        return not stopped()

    def _counted_split(self) -> str:
        """The split that stats.json is of."""
        return self.episodes[0].split

    def _write_note(self, file: PlannedFile, tallies: dict[str, Tally]) -> None:
        stats = [{name: _plain(tally.stats[i]) for name, tally in tallies.items()} for i in range(len(file.episodes))]
        arrays: dict[str, Any] = {"kept/" + name: array for name, tally in tallies.items() for array in self._joined(tally)}
        note = io.BytesIO()
        np.savez_compressed(note, stats=np.frombuffer(json.dumps(stats).encode(), dtype=np.uint8), **arrays)
        _commit(self._note_path(file), lambda hidden: hidden.write_bytes(note.getvalue()))

    @staticmethod
    def _joined(tally: Tally) -> list[np.ndarray]:
        return [np.concatenate(tally.kept)] if len(tally.kept) > 1 else tally.kept

    # --- records ---

    def _read_notes(self) -> tuple[list[dict[str, Any]], dict[str, Tally]]:
        """Statistics of every episode, and what those of the counted split are made of."""
        stats: list[dict[str, Any]] = []
        tallies = {column.name: Tally(column) for column in self.all_columns}
        for file in self.files:
            with np.load(self._note_path(file)) as note:
                stats += json.loads(note["stats"].tobytes())
                for name, tally in tallies.items():
                    if "kept/" + name in note:
                        tally._keep(note["kept/" + name])
        return stats, tallies

    def _finish(self) -> None:
        stats, tallies = self._read_notes()
        counted = [i for i, planned in enumerate(self.episodes) if planned.split == self._counted_split()]
        total = {}
        for name, tally in tallies.items():
            parts = [{key: value[0] if key == "count" else np.array(value) for key, value in stats[i][name].items()}
                     for i in counted]
            total[name] = _plain(tally.total(parts))
        meta = self.out / "meta"
        _commit_json(meta / "stats.json", total)
        if self.options.codebase_version == "v3.0":
            self._write_tables_of_episodes(stats)
        else:
            self._write_lines_of_episodes(stats)
        _commit_json(meta / "modality.json", self.modality())
        _commit_json(meta / "doorforge.json", self.plan)
        _commit(self.out / "README.md", lambda hidden: hidden.write_text(self.card()))
        _commit_json(meta / "info.json", self.info())

    def _episode_record(self, file: PlannedFile, planned: PlannedEpisode) -> dict[str, Any]:
        """What both versions and their users want to know of an episode."""
        door = planned.episode.meta["door"]
        return {"episode_index": planned.index, "tasks": [planned.task], "length": planned.decisions, "split": file.split,
                "key": planned.episode.key, "door_id": door["id"], "category": door["category"], "mechanism": door["mechanism"]}

    def _write_tables_of_episodes(self, stats: list[dict[str, Any]]) -> None:
        pa, parquet = importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")
        records = []
        for file in self.files:
            frame = 0
            for planned in file.episodes:
                record = self._episode_record(file, planned)
                record.update({"data/chunk_index": file.chunk, "data/file_index": file.place,
                               "dataset_from_index": planned.first_frame,
                               "dataset_to_index": planned.first_frame + planned.decisions,
                               "meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0})
                for column in self._videos():
                    key = f"videos/{column.name}"
                    record.update({f"{key}/chunk_index": file.chunk, f"{key}/file_index": file.place,
                                   f"{key}/from_timestamp": frame / FPS, f"{key}/to_timestamp": (frame + planned.decisions) / FPS})
                record.update({f"stats/{name}/{key}": value for name, found in stats[planned.index].items()
                               for key, value in found.items()})
                frame += planned.decisions
                records.append(record)
        table = pa.table({name: pa.array([record[name] for record in records]) for name in records[0]})
        _commit(self.out / "meta/episodes/chunk-000/file-000.parquet", lambda hidden: parquet.write_table(table, hidden))
        # the sentences are the index of the table that pandas makes of it
        kinds = {"task_index": ("int64", "int64"), "task": ("unicode", "object")}
        pandas = {"index_columns": ["task"], "column_indexes": [], "pandas_version": "2.0.0", "columns": [
            {"name": name, "field_name": name, "pandas_type": kind, "numpy_type": stored, "metadata": None}
            for name, (kind, stored) in kinds.items()]}
        tasks = pa.table({"task_index": pa.array(range(len(self.tasks)), pa.int64()), "task": pa.array(self.tasks)})
        tasks = tasks.replace_schema_metadata({"pandas": json.dumps(pandas)})
        _commit(self.out / "meta/tasks.parquet", lambda hidden: parquet.write_table(tasks, hidden))

    def _write_lines_of_episodes(self, stats: list[dict[str, Any]]) -> None:
        meta = self.out / "meta"
        _commit_lines(meta / "episodes.jsonl", (self._episode_record(file, planned) for file in self.files
                                                for planned in file.episodes))
        _commit_lines(meta / "episodes_stats.jsonl", ({"episode_index": i, "stats": found} for i, found in enumerate(stats)))
        _commit_lines(meta / "tasks.jsonl", ({"task_index": i, "task": task} for i, task in enumerate(self.tasks)))

    def splits(self) -> dict[str, str]:
        """Ranges of episodes."""
        ranges: dict[str, list[int]] = {}
        for planned in self.episodes:
            ranges.setdefault(planned.split, [planned.index, 0])[1] = planned.index + 1
        return {split: f"{first}:{end}" for split, (first, end) in ranges.items()}

    def info(self) -> dict[str, Any]:
        """meta/info.json."""
        robots = {planned.episode.meta["scene"].get("robot", {}).get("name", "mobile_franka") for planned in self.episodes}
        v3 = self.options.codebase_version == "v3.0"
        counts: dict[str, Any] = {"total_episodes": len(self.episodes), "total_frames": self.frames, "total_tasks": len(self.tasks)}
        if not v3:
            counts.update(total_videos=len(self.episodes) * len(self._videos()), total_chunks=self.files[-1].chunk + 1)
        sizes = {"data_files_size_in_mb": FILE_BYTES >> 20, "video_files_size_in_mb": 200} if v3 else {}
        return {"codebase_version": self.options.codebase_version, "robot_type": " ".join(sorted(robots)), **counts,
                "chunks_size": CHUNK_FILES, **sizes, "fps": FPS, "splits": self.splits(), "data_path": self._data_template(),
                "video_path": self._video_template() if self._videos() else None,
                "features": {column.name: self._feature(column) for column in self.all_columns}}

    @staticmethod
    def _feature(column: Column) -> dict[str, Any]:
        feature: dict[str, Any] = {"dtype": column.dtype, "shape": list(column.shape), "names": column.names}
        if column.dtype == "video":
            height, width = column.shape[:2]
            feature["info"] = {"video.height": height, "video.width": width, "video.codec": "h264",
                               "video.pix_fmt": "yuv420p", "video.is_depth_map": False, "video.fps": FPS,
                               "video.channels": 3, "has_audio": False}
        elif column.info is not None:
            feature["info"] = column.info
        return feature

    def modality(self) -> dict[str, Any]:
        """meta/modality.json, by which GR00T knows the pieces of state and action."""
        return {"state": {"joint_position": {"start": 0, "end": 11}, "joint_velocity": {"start": 11, "end": 22},
                          "base_position": {"start": 22, "end": 25}, "hand_position": {"start": 25, "end": 28},
                          "hand_rotation": {"start": 28, "end": 32, "rotation_type": "quaternion"}},
                "action": {"hand_offset": {"start": 0, "end": 3, "absolute": False},
                           "hand_rotation": {"start": 3, "end": 9, "rotation_type": "rotation_6d"}},
                "video": {column.source[len("rgb_"):]: {"original_key": column.name} for column in self.columns
                          if column.source.startswith("rgb_")},
                "annotation": {"human.task_description": {"original_key": "task_index"}}}

    def card(self) -> str:
        """README.md, whose head tells the hub and `datasets` which files are which split."""
        licenses = sorted({door["license"] for door in self.data.provenance["doors"]})
        license_lines = (f"license: {licenses[0].lower()}" if len(licenses) == 1
                         else f"license: other\nlicense_name: \"{', '.join(licenses)}\"")
        files = ["configs:", "- config_name: default", "  data_files:"]
        for split in self.splits():
            files += [f"  - split: {split}", "    path:"]
            files += [f"    - {self.data_path(file)}" for file in self.files if file.split == split]
        ranges = ", ".join(f"{split} {episodes}" for split, episodes in self.splits().items())
        return "\n".join(["---", license_lines, "task_categories:", "- robotics", "tags:", "- LeRobot", "- doorforge", *files,
                          "---", "", "# Doors opened by a robot in simulation", "",
                          f"The stage `{self.options.stage}` of a dataset of doorforge {self.data.provenance['code_version']}, seed "
                          f"{self.data.provenance['seed']}, in LeRobot's format {self.options.codebase_version}: "
                          f"{len(self.episodes)} episodes ({ranges}), {self.frames} decisions, {FPS} a second.", "",
                          "Tasks:", "", *(f"- {task}" for task in self.tasks), ""])

    def summary(self) -> dict[str, Any]:
        """What --json prints."""
        return {"schema": "doorforge.dataset_export", "schema_version": 1, "to": "lerobot",
                "stage": self.options.stage, "out": str(self.out), "demos": len(self.episodes), "samples": self.frames,
                "bytes": bytes_below(self.out), "codebase_version": self.options.codebase_version}


def export(folder: PathLike, out: PathLike, options: Options = Options()) -> dict[str, Any]:
    """Exports a stage into the folder `out`, which may hold the beginning of this very export. Returns what was written.
    Raises ExportError, or DatasetError where the dataset cannot be read."""
    made = Export(folder, out, options)
    made.run()
    return made.summary()


# --- the program -----------------------------------------------------------------------------------


def _parsed(arguments: Optional[Sequence[str]]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="doorforge_lerobot", description="Copies a stage of a doorforge dataset into LeRobot's format.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="example:\n  python3 -m doorforge.lerobot data --out data_lerobot")
    parser.add_argument("dataset", help="the dataset's folder")
    parser.add_argument("--out", required=True, help="folder to make, or one that the same command began")
    parser.add_argument("--stage", default="open", choices=STAGES, help="an export holds one stage (default: open)")
    parser.add_argument("--codebase-version", default="v3.0", choices=VERSIONS, help="LeRobot's; v2.1 for GR00T (default: v3.0)")
    parser.add_argument("--points", type=int, metavar="N", help="of each cloud, 0: no clouds (default: 1024, or all there are)")
    parser.add_argument("--images", default="png", choices=IMAGES, help="in the tables without loss, or MP4 (default: png)")
    parser.add_argument("--cameras", nargs="+", metavar="NAME", help="those to take (default: all)")
    parser.add_argument("--depth", action="store_true", help="also depth, 16 bits [mm]")
    parser.add_argument("--json", action="store_true", help="print JSON")
    return parser.parse_args(arguments)


class _StopSignal:
    """Notes SIGINT and SIGTERM; a second one, half a second later or more, ends the process at once."""

    def __init__(self) -> None:
        self.number, self.since = 0, 0.0
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._note)

    def _note(self, number: int, frame: Any) -> None:
        # a terminal and the parent may both tell of one press
        if self.number and time.monotonic() - self.since > 0.5:
            os._exit(128 + number)
        if not self.number:
            self.number, self.since = number, time.monotonic()


def _progress(done: int, files: int) -> None:
    if sys.stderr.isatty():
        print(f"\rexport: {done} of {files} files", end="\n" if done == files else "", file=sys.stderr, flush=True)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    given = _parsed(arguments)
    stop = _StopSignal()
    try:
        options = Options(given.stage, given.codebase_version, given.points, given.images, given.depth,
                          None if given.cameras is None else tuple(given.cameras))
        made = Export(given.dataset, given.out, options)
        if not made.run(_progress, lambda: stop.number != 0):
            print(f"doorforge: stopped; what is done is kept in {given.out}, the same command goes on", file=sys.stderr)
            return 128 + stop.number
        summary = made.summary()
    except (OSError, reader.DatasetError) as error:
        print(f"doorforge: {error}", file=sys.stderr)
        return getattr(error, "exit_code", 3)
    print(json.dumps(summary, indent=2) if given.json else
          f"{given.out}: {summary['demos']} demos, {summary['samples']} samples, {summary['bytes'] / 2**20:.1f} MiB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
