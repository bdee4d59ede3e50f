# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""python/doorforge_reader.py on the golden data set, against numpy's own readers and the standard library's tarfile."""
import hashlib
import io
import json
import pathlib
import pickle
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = SOURCE / "tests/golden/dataset_v1"
sys.path.insert(0, str(SOURCE / "python"))
sys.dont_write_bytecode = True

import doorforge_reader as reader  # noqa: E402


def tars(split):
    return sorted((GOLDEN / "open" / split).glob("*.tar"))


def members(path):
    with tarfile.open(path) as archive:
        return {item.name: archive.extractfile(item).read() for item in archive}


class BackProjection(unittest.TestCase):
    def test_a_plane_before_a_turned_camera_is_where_it_stands(self):
        # at (1, 2, 3), looking along world y, with world x to the right: the plane y = 4
        pose = np.array([[1.0, 0, 0, 1], [0, 0, 1, 2], [0, -1, 0, 3]])
        depth = np.full((3, 4), 2.0)
        depth[0, 0] = 0
        points = reader.back_project(depth, [[5, 0, 2], [0, 5, 1.5], [0, 0, 1]], pose)
        self.assertTrue(np.isnan(points[0, 0]).all())
        self.assertEqual((points.dtype, points.shape), (np.float32, (3, 4, 3)))
        for (row, column), x, z in (((1, 2), 1.2, 3.0), ((2, 0), 0.4, 2.6)):
            np.testing.assert_allclose(points[row, column], (x, 4, z), atol=1e-6)


class WithoutNumpy(unittest.TestCase):
    def test_the_message_says_what_to_install(self):
        path = str(SOURCE / "python/doorforge_reader.py")
        for name, code in (("__main__", 3), ("doorforge_reader", 1)):
            program = ("import runpy, sys; sys.modules['numpy'] = None; "
                       f"sys.argv = [{path!r}, {str(GOLDEN)!r}]; runpy.run_path({path!r}, run_name={name!r})")
            done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn("apt-get install python3-numpy", done.stderr)
            self.assertEqual("Traceback" in done.stderr, code == 1)


class Crc(unittest.TestCase):
    def test_the_examples_of_rfc_3720_are_met(self):
        for data, crc in ((b"123456789", 0xE3069283), (bytes(32), 0x8A9136AA), (b"\xff" * 32, 0x62A8AB43),
                          (bytes(range(32)), 0x46DD794E), (b"", 0)):
            self.assertEqual(reader.crc32c(data), crc)

    def test_all_lengths_agree_with_the_definition_bit_by_bit(self):
        def slow(data):
            crc = 0xFFFFFFFF
            for byte in data:
                crc ^= byte
                for _ in range(8):
                    crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
            return crc ^ 0xFFFFFFFF

        data = np.random.default_rng(1).bytes(60000)
        for length in (*range(9), 63, 64, 4095, 4096, 4097, 4100, 8191, 8192, 12289, 22739, 22740, 22745, 60000):
            self.assertEqual(reader.crc32c(data[:length]), slow(data[:length]), length)

    def test_a_checksum_is_continued_over_pieces_of_any_length(self):
        data = np.random.default_rng(2).bytes(3 << 20)
        whole = reader.crc32c(data)
        for cut in (1, 5000, 70001, 1 << 20, (1 << 20) + 3, (2 << 20) + 1):
            self.assertEqual(reader.crc32c(data[cut:], reader.crc32c(data[:cut])), whole, cut)


class Golden(unittest.TestCase):
    def setUp(self):
        self.data = reader.Dataset(GOLDEN)

    def test_the_files_are_the_ones_that_were_committed(self):
        listed = dict(line.split("  ")[::-1] for line in (GOLDEN.parent / "dataset_v1.sha256").read_text().splitlines())
        found = {str(path.relative_to(GOLDEN)): hashlib.sha256(path.read_bytes()).hexdigest()
                 for path in GOLDEN.rglob("*") if path.is_file()}
        self.assertEqual(found, listed)

    def test_every_array_is_what_tarfile_and_numpy_read(self):
        compared = 0
        for part in self.data.parts:
            raw = {name: data for path in tars(part.split) for name, data in members(path).items()}
            for episode in self.data.episodes(part.stage, part.split):
                for name, array in episode.arrays().items():
                    expected = np.load(io.BytesIO(raw[f"{episode.key}.{name}.npy"]))
                    np.testing.assert_array_equal(array, expected)
                    self.assertEqual(array.dtype, expected.dtype)
                    self.assertEqual(array.ctypes.data % 64, 0)
                    self.assertFalse(array.flags.owndata or array.flags.writeable)
                    compared += 1
                self.assertEqual(episode.meta, json.loads(raw[episode.key + ".meta.json"]))
        self.assertEqual(compared, 8 * 6)

    def test_features_describe_the_arrays(self):
        episode = self.data.episodes("open", "train")[0]
        self.assertEqual(set(self.data.features), set(episode.names()))
        for feature in self.data.features.values():
            array = episode[feature.name]
            self.assertEqual(array.dtype.str, feature.dtype)
            known = {"decisions": episode.decisions, "points": episode["cloud"].shape[1]}
            self.assertEqual(array.shape, tuple(known.get(length, length) for length in feature.shape))

    def test_statistics_are_those_of_numpy(self):
        episodes = self.data.episodes("open", "train")
        for name, statistics in self.data.statistics.items():
            rows = np.concatenate([e[name].reshape(-1, e[name].shape[-1]) for e in episodes]).astype(np.float64)
            np.testing.assert_allclose(statistics.mean, rows.mean(axis=0), atol=1e-12)
            np.testing.assert_allclose(statistics.standard_deviation, rows.std(axis=0), atol=1e-7)
            np.testing.assert_array_equal(statistics.minimum, rows.min(axis=0))
            np.testing.assert_array_equal(statistics.maximum, rows.max(axis=0))
        clouds = np.concatenate([e["cloud"] for e in episodes]).astype(np.float64)
        radius = np.linalg.norm(clouds - clouds.mean(axis=1, keepdims=True), axis=2).max()
        self.assertAlmostEqual(self.data.cloud_radius_m, radius, 9)

    def test_counts_failures_and_splits_are_there(self):
        self.assertEqual([(p.stage, p.split, p.episodes, p.failed_episodes) for p in self.data.parts],
                         [("open", "train", 6, 1), ("open", "val", 2, 0)])
        self.assertEqual([f["outcome"] for f in self.data.failures()], ["door_stuck"])
        self.assertEqual([s.failures[0]["key"] for s in self.data.shards("open", "train") if s.failures], ["ep000008"])
        doors = {door["id"]: door["split"] for door in self.data.provenance["doors"]}
        for split in ("train", "val"):
            self.assertEqual(sorted(self.data.split(split)), sorted(d for d, s in doors.items() if s == split))

    def test_samples_are_the_rows_of_the_episodes_in_order(self):
        samples = self.data.samples("open", "train", names=("action", "proprio"))
        actions = np.concatenate([e["action"] for e in samples.episodes])
        self.assertEqual(len(samples), len(actions))
        np.testing.assert_array_equal(np.stack([s["action"] for s in samples]), actions)
        np.testing.assert_array_equal(samples[-1]["action"], actions[-1])
        self.assertEqual(set(samples[3]), {"action", "proprio"})
        self.assertEqual(len(samples[2:9:3]), 3)
        for beyond in (len(samples), -len(samples) - 1):
            with self.assertRaises(IndexError):
                samples[beyond]

    def test_a_pickled_data_set_maps_the_files_itself(self):
        samples = self.data.samples("open", "train")
        before = samples[5]
        again = pickle.loads(pickle.dumps(samples))[5]
        self.assertLess(len(pickle.dumps(samples)), 20000)
        for name, row in before.items():
            np.testing.assert_array_equal(row, again[name])

    def test_more_shards_than_may_be_open_are_read_all_the_same(self):
        limit, reader.OPEN_SHARDS = reader.OPEN_SHARDS, 1
        self.addCleanup(setattr, reader, "OPEN_SHARDS", limit)
        episodes = self.data.episodes("open", "train")
        kept = episodes[0]["action"]
        copy = kept.copy()
        for _ in range(2):
            for episode in episodes:
                episode["cloud"].sum()
        self.assertEqual(sum(shard._data is not None for shard in episodes.shards), 1)
        np.testing.assert_array_equal(kept, copy)  # a view outlives the map's place

    def test_a_stream_gives_the_same_members(self):
        for path in tars("train"):
            raw = members(path)
            index = json.loads(path.with_name(path.stem + ".index.json").read_text())
            for known in (None, index):
                found = {f"{key}.{name}": data for key, parts in reader.stream(io.BytesIO(path.read_bytes()), known)
                         for name, data in parts.items()}
                self.assertEqual(found, raw)


class GoldenGrasps(unittest.TestCase):
    """Failed grasps beside those that succeeded, joint states, an index with a checksum of its own."""
    FOLDER = GOLDEN.parent / "dataset_v1_grasp"

    def test_it_is_read_as_tarfile_and_numpy_do(self):
        data = reader.Dataset(self.FOLDER)
        raw = members(self.FOLDER / "grasp/train/shard-000000.tar")
        episodes = data.episodes("grasp", "train")
        self.assertEqual([episode.meta["success"] for episode in episodes], [True, False, True, False])
        for episode in episodes:
            self.assertEqual(episode["state"].dtype.str, "<f8")
            self.assertEqual(episode["state"].shape, (1, 14))
            for name, array in episode.arrays().items():
                np.testing.assert_array_equal(array, np.load(io.BytesIO(raw[f"{episode.key}.{name}.npy"])))
        self.assertEqual([failure["outcome"] for failure in data.failures()], ["not_reached"])
        self.assertIn(b"index_crc32c", (self.FOLDER / "grasp/train/shard-000000.index.json").read_bytes())


class Order(unittest.TestCase):
    def test_it_is_a_permutation_that_depends_on_seed_and_epoch(self):
        orders = [reader.order(1000, seed, epoch) for seed in (0, 7) for epoch in (0, 1, 2)]
        for order in orders:
            np.testing.assert_array_equal(np.sort(order), np.arange(1000))
        self.assertEqual(len({order.tobytes() for order in orders}), len(orders))
        for order in orders:  # far from sorted: a random permutation has a rank correlation of 0 +- 0.03
            self.assertLess(abs(np.corrcoef(order, np.arange(1000))[0, 1]), 0.15)

    def test_it_never_changes(self):
        self.assertEqual(reader.order(8, seed=7, epoch=3).tolist(), [7, 2, 3, 6, 0, 1, 5, 4])
        self.assertEqual(len(reader.order(0, 1, 1)), 0)


class Damage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "data"
        shutil.copytree(GOLDEN, self.folder)
        self.tar = self.folder / "open/train/shard-000000.tar"
        self.index = self.tar.with_name("shard-000000.index.json")

    def change_json(self, path, change):
        record = json.loads(path.read_text())
        change(record)
        path.write_text(json.dumps(record))

    def test_a_flipped_bit_anywhere_in_a_member_is_seen_when_it_is_touched(self):
        episodes = json.loads(self.index.read_text())["episodes"]
        original = self.tar.read_bytes()
        for number, member in enumerate(episodes[1]["members"]):
            for at in {0, member["size"] // 2, member["size"] - 1}:
                damaged = bytearray(original)
                damaged[member["offset"] + at] ^= 1 << (number % 8)
                self.tar.write_bytes(damaged)
                data = reader.Dataset(self.folder).episodes("open", "train")
                data[0].arrays()  # the others are whole
                with self.assertRaisesRegex(reader.CorruptError, member["name"]):
                    data[1].member(member["name"])
                reader.Dataset(self.folder, check=False).episodes("open", "train")[1].member(member["name"])

    def test_a_cut_tar_is_named(self):
        size = self.tar.stat().st_size
        for length in (0, 1, 512, size // 2, size - 1):
            self.tar.write_bytes(GOLDEN.joinpath("open/train/shard-000000.tar").read_bytes()[:length])
            with self.assertRaisesRegex(reader.CorruptError, f"{length} bytes, its index says {size}"):
                reader.Dataset(self.folder).episodes("open", "train")[0]["cloud"]
            if length < size // 2 + 1:
                with self.assertRaises(reader.CorruptError):
                    list(reader.stream(io.BytesIO(self.tar.read_bytes()), json.loads(self.index.read_text())))

    def test_another_version_is_refused(self):
        for path in (self.folder / "dataset.json", self.folder / "provenance.json", self.index):
            for key, value in (("schema_version", 2), ("schema_version", "1"), ("schema", "other")):
                before = path.read_text()
                self.change_json(path, lambda record: record.update({key: value}))
                with self.assertRaisesRegex(reader.VersionError, path.name):
                    reader.Dataset(self.folder).episodes("open", "train")
                path.write_text(before)

    def test_an_index_that_cannot_be_is_refused(self):
        def overlap(index):
            index["episodes"][1]["members"][0]["offset"] = index["episodes"][0]["members"][1]["offset"]

        changes = {
            "overlap": overlap,
            "leave the tar": lambda index: index["episodes"][-1]["members"][-1].update(size=10**9),
            "overlap or leave": lambda index: index["episodes"][0]["members"][0].update(offset=-512),
            "different members": lambda index: index["episodes"][0]["members"].pop(),
            "keys that repeat": lambda index: index["episodes"][1].update(key=index["episodes"][0]["key"]),
            "beside its index": lambda index: index.update(tar="../../../etc/passwd"),
            "not an index": lambda index: index.pop("episodes"),
        }
        before = self.index.read_text()
        for message, change in changes.items():
            self.change_json(self.index, change)
            with self.assertRaisesRegex(reader.CorruptError, message):
                reader.Dataset(self.folder).episodes("open", "train")
            self.index.write_text(before)
        self.index.write_text(before[:200])
        with self.assertRaisesRegex(reader.CorruptError, "not JSON"):
            reader.Dataset(self.folder).episodes("open", "train")

    def test_an_index_with_a_checksum_of_its_own_shows_every_flipped_bit(self):
        plain = self.index.read_bytes()
        whole = plain[:-3] + b',\n  "index_crc32c": %d\n}\n' % reader.crc32c(plain)
        self.index.write_bytes(whole)
        self.assertEqual(len(reader.Shard(self.index)), 4)
        for at in (*range(0, len(whole), 37), *range(len(whole) - 40, len(whole))):
            damaged = bytearray(whole)
            damaged[at] ^= 1 << (at % 8)
            self.index.write_bytes(damaged)
            with self.assertRaises(reader.DatasetError, msg=f"byte {at}"):
                reader.Shard(self.index)

    def test_what_is_not_there_is_named(self):
        data = reader.Dataset(self.folder)
        with self.assertRaisesRegex(reader.MissingError, "open/train"):
            data.episodes("grasp", "train")
        with self.assertRaisesRegex(reader.MissingError, "no member colour.npy"):
            data.episodes("open", "train")[0]["colour"]
        self.tar.unlink()
        with self.assertRaisesRegex(reader.MissingError, "though its index is there"):
            data.episodes("open", "train")[0]["cloud"]
        with self.assertRaisesRegex(reader.MissingError, "dataset.json"):
            reader.Dataset(self.folder / "open")


if __name__ == "__main__":
    unittest.main(verbosity=2)
