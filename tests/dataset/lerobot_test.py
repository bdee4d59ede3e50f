# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""python/doorforge_lerobot.py as far as it needs no pyarrow: columns, sentences, splits, statistics, PNGs, and how an export
that was stopped goes on. tests/python/lerobot_judge.sh tries the rest with pyarrow, LeRobot and Hugging Face's datasets."""
import importlib.util
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import zlib

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = SOURCE / "tests/golden/dataset_v1"
sys.path.insert(0, str(SOURCE / "python"))
sys.dont_write_bytecode = True

import doorforge_lerobot as lerobot  # noqa: E402
import doorforge_reader as reader  # noqa: E402


def decoded(png: bytes) -> np.ndarray:
    """Reads a PNG by the specification: chunks with their CRCs, then rows that are differences from the row above."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, place = {}, 8
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place:place + 8])
        data = png[place + 8:place + 8 + length]
        assert struct.unpack(">I", png[place + 8 + length:place + 12 + length])[0] == zlib.crc32(kind + data)
        chunks[kind], place = data, place + 12 + length
    width, height, bits, color, *rest = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert rest == [0, 0, 0] and (bits, color) in ((8, 2), (16, 0))
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    assert set(rows[:, 0]) == {2}
    octets = np.cumsum(rows[:, 1:].astype(np.uint64), axis=0).astype(np.uint8)
    if bits == 16:
        return octets.view(">u2").astype(np.uint16).reshape(height, width, 1)
    return octets.reshape(height, width, 3)


class FakeEpisode:
    """An episode with pictures, which the golden data set has none of."""

    def __init__(self, arrays, meta=None):
        self.all, self.meta, self.key = arrays, meta or {"success": True}, "ep000000"
        self.decisions = len(arrays["cloud"])
        self.shard = unittest.mock.Mock(path="shard.tar")

    def __getitem__(self, name):
        return self.all[name]

    def __contains__(self, name):
        return name in self.all

    def cameras(self):
        return sorted(name[len("pose_"):] for name in self.all if name.startswith("pose_"))


def with_pictures(seed=0, height=6, width=8):
    rng = np.random.default_rng(seed)
    return FakeEpisode({
        "cloud": rng.random((3, 40, 3), np.float32), "cloud_rgb": rng.integers(0, 256, (3, 40, 3), np.uint8),
        "proprio": rng.random((3, 32), np.float32), "action": rng.random((3, 9), np.float32),
        "score": rng.random((3, 1), np.float32), "pose_front": np.zeros((3, 3, 4)),
        "rgb_front": rng.integers(0, 256, (3, height, width, 3), np.uint8),
        "depth_front": rng.integers(0, 65536, (3, height, width), np.uint16)})


class Png(unittest.TestCase):
    def test_pixels_come_back(self):
        rng = np.random.default_rng(1)
        for shape, dtype in (((5, 7, 3), np.uint8), ((1, 1, 3), np.uint8), ((4, 9, 1), np.uint16)):
            pixels = rng.integers(0, np.iinfo(dtype).max + 1, shape).astype(dtype)
            np.testing.assert_array_equal(decoded(lerobot.png_bytes(pixels)), pixels)


class Columns(unittest.TestCase):
    def test_every_value_is_the_shards(self):
        made = lerobot.Export(GOLDEN, "unused", lerobot.Options(points=16))
        data = reader.Dataset(GOLDEN)
        episodes = [e for split in ("train", "val") for e in data.episodes("open", split)]
        self.assertEqual(len(made.episodes), len(episodes))
        frame = 0
        for i, (planned, episode) in enumerate(zip(made.episodes, episodes)):
            rows = made.rows_of(planned)
            for name, source in (("observation.state", "proprio"), ("action", "action"), ("next.reward", "score")):
                np.testing.assert_array_equal(rows[name], episode[source])
            np.testing.assert_array_equal(rows["observation.pointcloud"], episode["cloud"][:, :16])
            self.assertEqual(rows["next.done"].tolist(), [False] * (episode.decisions - 1) + [True])
            self.assertEqual(rows["next.success"][-1], episode.meta["success"])
            np.testing.assert_array_equal(rows["index"], frame + np.arange(episode.decisions))
            np.testing.assert_allclose(rows["timestamp"], np.arange(episode.decisions) / 6, atol=1e-6)
            self.assertEqual(set(rows["episode_index"]), {i})
            frame += episode.decisions
        self.assertEqual(made.splits(), {"train": "0:6", "val": "6:8"})
        self.assertEqual(made.info()["total_frames"], frame)

    def test_pictures_depth_and_colours_are_features(self):
        episode = with_pictures()
        columns = {c.name: c for c in lerobot.columns_of(episode, lerobot.Options(points=10, depth=True))}
        np.testing.assert_array_equal(columns["observation.images.front"].values(episode), episode["rgb_front"])
        depth = columns["observation.images.front_depth"]
        np.testing.assert_array_equal(depth.values(episode)[..., 0], episode["depth_front"])
        self.assertEqual((depth.shape, depth.info), ((6, 8, 1), {"is_depth_map": True, "depth_unit": "mm"}))
        np.testing.assert_array_equal(columns["observation.pointcloud_rgb"].values(episode), episode["cloud_rgb"][:, :10])
        video = {c.name: c for c in lerobot.columns_of(episode, lerobot.Options(images="video", points=0))}
        self.assertEqual(video["observation.images.front"].dtype, "video")
        self.assertNotIn("observation.pointcloud", video)

    def test_what_cannot_be_is_refused_with_the_way_out(self):
        episode = with_pictures()
        for options, episode_, words in (
                (lerobot.Options(points=41), episode, "--points: 41, the clouds have 40"),
                (lerobot.Options(cameras=("wrist",)), episode, "no camera 'wrist'; the episodes have front"),
                (lerobot.Options(images="video"), with_pictures(width=7), "use --images png")):
            with self.assertRaisesRegex(lerobot.ExportError, words):
                lerobot.columns_of(episode_, options)
        columns = lerobot.columns_of(episode, lerobot.Options())
        with self.assertRaisesRegex(lerobot.ExportError, "LeRobot wants one shape"):
            [column.values(with_pictures(width=16)) for column in columns]
        for options, words in ((lerobot.Options(stage="all"), "--stage: 'all'"),
                               (lerobot.Options(codebase_version="v2.1", depth=True), "use v3.0")):
            with self.assertRaisesRegex(lerobot.ExportError, words):
                options.check()
        with self.assertRaisesRegex(lerobot.ExportError, "the dataset has open/train, open/val"):
            lerobot.Export(GOLDEN, "unused", lerobot.Options(stage="grasp"))


class Sentences(unittest.TestCase):
    def test_they_say_what_is_asked(self):
        def meta(category, mechanism, **more):
            return {"door": {"category": category, "mechanism": mechanism}, **more}
        for found, said in ((("handle", meta("interior", "lever")), "turn the lever of the door"),
                            (("handle", meta("interior", "lever", way="other")), "lift the lever of the door"),
                            (("open", meta("safe", "valve")), "pull the safe open by its wheel"),
                            (("open", meta("interior", "round", way="other")), "push the door open by its knob"),
                            (("handle", meta("car", "flap")), "lift the flap of the car door"),
                            (("grasp", meta("storagefurniture", "none")), "take hold of the handle of the cupboard")):
            self.assertEqual(lerobot.sentence_of(found[1], found[0]), said)


class Statistics(unittest.TestCase):
    def check(self, column, parts, flat, scale=1.0, places=1e-9):
        tally = lerobot.Tally(column)
        for part in parts:
            tally.add(part, keep=True)
        found = tally.total(tally.stats)
        every = np.concatenate([flat(part) for part in parts]).astype(np.float64) / scale
        self.assertEqual(found["count"], sum(map(len, parts)))
        for name, expected in (("mean", every.mean(0)), ("std", every.std(0)), ("min", every.min(0)), ("max", every.max(0)),
                               *((name, np.quantile(every, share, axis=0)) for name, share in lerobot.QUANTILES.items())):
            slack = 1e-3 if name.startswith("q") and column.dtype == "float32" and len(column.shape) == 2 else places
            np.testing.assert_allclose(np.ravel(found[name]), expected, atol=slack, err_msg=name)
        return found

    def test_they_are_those_of_all_values(self):
        rng = np.random.default_rng(3)
        lengths = (1, 5, 2)
        self.check(lerobot.Column("action", "action", "float32", (9,)),
                   [rng.normal(size=(n, 9)).astype(np.float32) for n in lengths], lambda a: a)
        picture = self.check(lerobot.Column("observation.images.a", "rgb_a", "image", (4, 6, 3)),
                             [rng.integers(0, 256, (n, 4, 6, 3), np.uint8) for n in lengths], lambda a: a.reshape(-1, 3), 255)
        self.assertEqual(picture["mean"].shape, (3, 1, 1))
        depth = lerobot.Column("observation.images.a_depth", "depth_a", "image", (4, 6, 1), None, {"is_depth_map": True})
        self.check(depth, [rng.integers(0, 5000, (n, 4, 6, 1)).astype(np.uint16) for n in lengths], lambda a: a.reshape(-1, 1),
                   places=1e-6)
        cloud = self.check(lerobot.Column("observation.pointcloud", "cloud", "float32", (20, 3)),
                           [rng.normal(size=(n, 20, 3)).astype(np.float32) for n in lengths], lambda a: a.reshape(-1, 3))
        self.assertEqual(cloud["q99"].shape, (1, 3))

    def test_those_of_the_train_split_are_the_datasets_own(self):
        with tempfile.TemporaryDirectory() as folder, tables_of_numpy():
            lerobot.export(GOLDEN, folder + "/out", lerobot.Options(codebase_version="v2.1"))
            found = json.loads(pathlib.Path(folder, "out/meta/stats.json").read_text())
        own = reader.Dataset(GOLDEN).statistics
        for name, source in (("action", "action"), ("observation.state", "proprio"), ("next.reward", "score")):
            for key, expected in (("mean", own[source].mean), ("std", own[source].standard_deviation),
                                  ("min", own[source].minimum), ("max", own[source].maximum)):
                np.testing.assert_allclose(found[name][key], expected, atol=1e-6, err_msg=name + key)
        np.testing.assert_allclose(found["observation.pointcloud"]["mean"][0], own["cloud"].mean, atol=1e-5)


def tables_of_numpy():
    """Tables written by numpy in the place of pyarrow."""
    def write(path, columns, episodes):
        with open(path, "wb") as file:
            np.savez(file, **{f"{i}/{name}": array for i, rows in enumerate(episodes) for name, array in rows.items()})
    return unittest.mock.patch.multiple(lerobot, write_table=write, require_modules=lambda *_: None)


def content(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(pathlib.Path(folder).rglob("*")) if path.is_file()}


class GoingOn(unittest.TestCase):
    OPTIONS = lerobot.Options(codebase_version="v2.1")

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        patch = tables_of_numpy()
        patch.start()
        self.addCleanup(patch.stop)

    def test_stopped_anywhere_it_ends_with_the_same_files(self):
        lerobot.export(GOLDEN, self.folder / "whole", self.OPTIONS)
        whole = content(self.folder / "whole")
        self.assertEqual(sum(name.startswith("data/") for name in whole), 8)
        self.assertFalse([name for name in whole if "/." in name or name.startswith(".")])
        real = lerobot._commit
        for dies_at in range(1, 25, 3):
            out, commits = self.folder / f"cut{dies_at}", []

            def commit(path, write, commits=commits, dies_at=dies_at):
                commits.append(path)
                if len(commits) == dies_at:
                    real(path, write)
                    path.rename(path.with_name(f".{path.name}.partial"))
                    raise KeyboardInterrupt
                real(path, write)

            with unittest.mock.patch.object(lerobot, "_commit", commit):
                try:
                    lerobot.export(GOLDEN, out, self.OPTIONS)
                except KeyboardInterrupt:
                    pass
            if not commits or len(commits) < dies_at:
                break
            self.assertFalse((out / "meta/info.json").exists())
            lerobot.export(GOLDEN, out, self.OPTIONS)
            self.assertEqual(content(out), whole, dies_at)

    def test_a_finished_one_is_left_and_another_is_refused(self):
        out = self.folder / "out"
        lerobot.export(GOLDEN, out, self.OPTIONS)
        times = {path: path.stat().st_mtime_ns for path in out.rglob("*")}
        self.assertEqual(lerobot.export(GOLDEN, out, self.OPTIONS)["samples"], 110)
        self.assertEqual({path: path.stat().st_mtime_ns for path in out.rglob("*")}, times)
        with self.assertRaisesRegex(lerobot.ExportError, "points is 24 there, 8 here"):
            lerobot.export(GOLDEN, out, lerobot.Options(codebase_version="v2.1", points=8))
        other = self.folder / "other"
        other.mkdir()
        (other / "mine.txt").write_text("mine")
        with self.assertRaisesRegex(lerobot.ExportError, "holds something else"):
            lerobot.export(GOLDEN, other, self.OPTIONS)
        self.assertEqual(content(other), {"mine.txt": b"mine"})
        with self.assertRaisesRegex(lerobot.ExportError, "is a file"):
            lerobot.export(GOLDEN, other / "mine.txt", self.OPTIONS)

    def test_a_full_disk_is_told_before_work(self):
        usage = unittest.mock.Mock(free=1000)
        with unittest.mock.patch.object(lerobot.shutil, "disk_usage", lambda _: usage):
            with self.assertRaisesRegex(lerobot.ExportError, r"about 1 MiB are needed, 0 MiB are free; make room"):
                lerobot.export(GOLDEN, self.folder / "full", self.OPTIONS)
        self.assertFalse((self.folder / "full").exists())

    def test_two_at_once_are_refused(self):
        made = lerobot.Export(GOLDEN, self.folder / "out", self.OPTIONS)
        made.notes.mkdir(parents=True)
        with made._only_one(), self.assertRaisesRegex(lerobot.ExportError, "another process"):
            lerobot.export(GOLDEN, self.folder / "out", self.OPTIONS)

    def test_a_damaged_shard_is_told(self):
        data = self.folder / "data"
        shutil.copytree(GOLDEN, data)
        index = json.loads(next((data / "open/train").glob("*.index.json")).read_text())
        member = next(m for m in index["episodes"][0]["members"] if m["name"] == "action.npy")
        tar = data / "open/train" / index["tar"]
        octets = bytearray(tar.read_bytes())
        octets[member["offset"] + member["size"] - 1] ^= 1
        tar.write_bytes(octets)
        with self.assertRaisesRegex(reader.CorruptError, "damaged"):
            lerobot.export(data, self.folder / "out", self.OPTIONS)
        self.assertFalse((self.folder / "out/meta/info.json").exists())

    def test_the_files_name_each_other(self):
        out = self.folder / "out"
        lerobot.export(GOLDEN, out, self.OPTIONS)
        info = json.loads((out / "meta/info.json").read_text())
        lines = [json.loads(line) for line in (out / "meta/episodes.jsonl").read_text().splitlines()]
        tasks = [json.loads(line)["task"] for line in (out / "meta/tasks.jsonl").read_text().splitlines()]
        for line in lines:
            self.assertTrue((out / info["data_path"].format(episode_chunk=0, **line)).exists())
            self.assertIn(line["tasks"][0], tasks)
        modality = json.loads((out / "meta/modality.json").read_text())
        for part, feature in (("state", "observation.state"), ("action", "action")):
            ends = [(piece["start"], piece["end"]) for piece in modality[part].values()]
            self.assertEqual([end for _, end in ends[:-1]], [start for start, _ in ends[1:]])
            self.assertEqual(ends[-1][1], info["features"][feature]["shape"][0])
        self.assertIn("license: cc0-1.0", (out / "README.md").read_text())


class Program(unittest.TestCase):
    def run_it(self, *arguments):
        return subprocess.run([sys.executable, "-B", str(SOURCE / "python/doorforge_lerobot.py"), *map(str, arguments)],
                              capture_output=True, text=True, check=False)

    def test_what_is_missing_is_named_with_the_command(self):
        if importlib.util.find_spec("pyarrow"):
            self.skipTest("this Python has pyarrow")
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_it(GOLDEN, "--out", folder + "/out")
            self.assertEqual(done.returncode, 3)
            self.assertIn("-m pip install pyarrow", done.stderr)
            self.assertFalse(pathlib.Path(folder, "out").exists())

    def test_wrong_use_and_missing_data_have_their_codes(self):
        with tempfile.TemporaryDirectory() as folder:
            for arguments, code, words in (((GOLDEN,), 2, "--out"), ((GOLDEN, "--out", "x", "--images", "gif"), 2, "gif"),
                                           ((folder, "--out", folder + "/x"), 3, "dataset.json"),
                                           ((GOLDEN, "--out", folder + "/x", "--points", "99"), 2, "the clouds have 24")):
                done = self.run_it(*arguments)
                self.assertEqual((done.returncode, words in done.stderr), (code, True), done.stderr)
                self.assertNotIn("Traceback", done.stderr)

    def test_without_the_reader_installed_it_takes_the_one_beside_it(self):
        done = subprocess.run([sys.executable, "-B", "-P", str(SOURCE / "python/doorforge_lerobot.py"), "--help"],
                              capture_output=True, text=True, check=False, env={"PATH": "/usr/bin:/bin"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("example:", done.stdout)


if __name__ == "__main__":
    unittest.main()
