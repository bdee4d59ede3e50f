# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What others do with a finished data set: export, card, page, and the PyTorch example. usage: downstream_test.py BUILD"""
import hashlib
import importlib.util
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = SOURCE / "tests/golden/dataset_v1"
GRASPS = SOURCE / "tests/golden/dataset_v1_grasp"
HANDLES = SOURCE / "tests/golden/dataset_v1_handle"
BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else SOURCE / "build/dev"
sys.path.insert(0, str(SOURCE / "python"))
sys.dont_write_bytecode = True

import doorforge_reader as reader  # noqa: E402


def has(module):
    return importlib.util.find_spec(module) is not None


def dataset(*arguments):
    """Runs `doorforge dataset ARGUMENTS` through the program of the room."""
    return subprocess.run([str(BUILD / "bin/doorforge-datagen"), "dataset", *map(str, arguments)],
                          capture_output=True, text=True, timeout=120)


class DownstreamTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_dataset(self, *arguments):
        result = dataset(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def copy(self):
        shutil.copytree(GOLDEN, self.folder / "data")
        return self.folder / "data"


class Lerobot(DownstreamTest):
    def test_the_verb_runs_the_python_file_and_ends_as_it_does(self):
        out = self.folder / "out"
        export = ("export", GOLDEN, "--to", "lerobot", "--python", "/usr/bin/python3", "--out", out)
        for more, code, words in ((("--points", 99), 2, "--points: 99, the clouds have 24"),
                                  (("--cameras", "a", "b", "--depth"), 2, "no camera 'a'; the episodes have none"),
                                  (("--stage", "grasp"), 3, "no episodes of stage 'grasp'"),
                                  (("--overwrite",), 2, "--overwrite")):
            result = dataset(*export, *more)
            self.assertEqual((result.returncode, words in result.stderr), (code, True), result.stderr)
        result = dataset("export", GOLDEN, "--to", "lerobot", "--python", self.folder / "none", "--out", out)
        self.assertEqual((result.returncode, "give --python" in result.stderr), (3, True), result.stderr)
        result = dataset("export", GOLDEN, "--to", "robomimic", "--points", 5, "--out", out)
        self.assertEqual((result.returncode, "--points: is for --to lerobot" in result.stderr), (2, True), result.stderr)
        self.assertFalse(out.exists())

    def test_without_pyarrow_it_says_what_to_install(self):
        # a Python that has no packages but numpy, however the system's is set up
        python = self.folder / "python"
        python.write_text("#!/bin/sh\nexec /usr/bin/python3 -c 'import runpy, sys; sys.modules[\"pyarrow\"] = None; "
                          "sys.argv = sys.argv[3:]; runpy.run_path(sys.argv[0], run_name=\"__main__\")' \"$@\"\n")
        python.chmod(0o755)
        result = dataset("export", GOLDEN, "--to", "lerobot", "--python", python, "--out", self.folder / "out")
        self.assertEqual((result.returncode, "-m pip install pyarrow" in result.stderr), (3, True), result.stderr)


@unittest.skipUnless(has("h5py"), "python3-h5py is not installed")
class Robomimic(DownstreamTest):
    def test_h5py_reads_the_values_of_the_shards(self):
        import h5py

        out = self.folder / "out/door.hdf5"
        summary = json.loads(self.run_dataset("export", GOLDEN, "--to", "robomimic", "--out", out, "--json"))
        data = reader.Dataset(GOLDEN)
        with h5py.File(out) as file:
            demos = [(split, episode) for split in ("train", "val") for episode in data.episodes("open", split)]
            self.assertEqual(len(file["data"]), len(demos))
            masks = {split: [] for split in ("train", "val")}
            for number, (split, episode) in enumerate(demos):
                demo = file[f"data/demo_{number}"]
                masks[split].append(f"demo_{number}")
                self.assertEqual((demo.attrs["num_samples"], demo.attrs["success"]), (episode.decisions, 1))
                self.assertEqual((demo.attrs["key"], demo.attrs["split"]), (episode.key, split))
                self.assertEqual(demo.attrs["door_id"], episode.meta["door"]["id"])
                self.assertEqual(demo.attrs["category"], episode.meta["door"]["category"])
                self.assertEqual(json.loads(demo["meta"][()]), episode.meta)
                np.testing.assert_array_equal(demo["rewards"][:], episode["score"][:, 0])
                np.testing.assert_array_equal(demo["dones"][:], np.arange(1, episode.decisions + 1) == episode.decisions)
                self.assertEqual(set(demo["obs"]), {"cloud", "proprio"})
                self.assertEqual(set(demo["extras"]), set(episode.names()) - {"cloud", "proprio", "score"})
                for name, array in [*demo["obs"].items(), *demo["extras"].items()]:
                    np.testing.assert_array_equal(array[:], episode[name])
                    self.assertEqual(array.dtype, episode[name].dtype)
            for split, names in masks.items():
                self.assertEqual([name.decode() for name in file[f"mask/{split}"][:]], names)
            total = int(data.episodes("open", "train").decisions().sum() + data.episodes("open", "val").decisions().sum())
            self.assertEqual(file["data"].attrs["total"], total)
            self.assertEqual(json.loads(file["data"].attrs["env_args"])["env_name"], "doorforge")
        self.assertEqual((summary["demos"], summary["samples"], summary["bytes"]),
                         (len(demos), total, out.stat().st_size))

    def export(self, folder, stage):
        out = self.folder / f"{stage}.hdf5"
        self.run_dataset("export", folder, "--to", "robomimic", "--stage", stage, "--out", out)
        return out

    def test_scaled_actions_fill_their_range_and_the_stored_numbers_undo_it(self):
        import h5py

        for folder, stage in ((GOLDEN, "open"), (HANDLES, "handle"), (GRASPS, "grasp")):
            data = reader.Dataset(folder)
            recorded = [episode["action"] for split in ("train", "val") if any(
                part.split == split and part.episodes for part in data.parts if part.stage == stage)
                for episode in data.episodes(stage, split)]
            with h5py.File(self.export(folder, stage)) as file:
                demos = [file[f"data/demo_{number}/actions"][:] for number in range(len(recorded))]
                scale, offset = file["data"].attrs["action_scale"], file["data"].attrs["action_offset"]
            every, scaled = np.concatenate(recorded).astype(float), np.concatenate(demos)
            self.assertEqual(scaled.dtype, np.float32)
            np.testing.assert_allclose(offset + scale * scaled, every, atol=2e-7 * max(1, np.abs(every).max()))
            self.assertLessEqual(np.abs(scaled).max(), 1)
            varied = np.ptp(every[:, :3], axis=0) > 0
            np.testing.assert_allclose(scaled[:, :3].max(axis=0)[varied], 1, rtol=1e-6)
            np.testing.assert_allclose(scaled[:, :3].min(axis=0)[varied], -1, rtol=1e-6)
            np.testing.assert_allclose(scaled[:, 3:], every[:, 3:], atol=1e-4)  # rotations stay rotations

    def test_the_file_keeps_the_rules_that_robomimic_reads_by(self):
        """As robomimic 0.3.0 reads: utils/dataset.py, utils/file_utils.py and scripts/get_dataset_info.py. The run of
        robomimic itself is robomimic_judge.py beside this file."""
        import h5py

        for folder, stage in ((GOLDEN, "open"), (HANDLES, "handle"), (GRASPS, "grasp")):
            with h5py.File(self.export(folder, stage)) as file:
                env = json.loads(file["data"].attrs["env_args"])
                self.assertEqual(set(env), {"env_name", "type", "env_version", "env_kwargs"})
                demos = list(file["data"])
                self.assertEqual(sorted(int(name[5:]) for name in demos), list(range(len(demos))))
                masked = [name.decode("utf-8") for split in file["mask"] for name in np.array(file[f"mask/{split}"][:])]
                self.assertEqual(sorted(masked), sorted(demos))
                shapes = {name: array.shape[1:] for name, array in file[f"data/{demos[0]}/obs"].items()}
                for name in demos:
                    demo, length = file[f"data/{name}"], file[f"data/{name}"].attrs["num_samples"]
                    self.assertEqual(demo["actions"].shape, (length, 9))
                    self.assertTrue((np.abs(demo["actions"][:]) <= 1).all())
                    for key in ("rewards", "dones"):
                        self.assertEqual(demo[key].shape, (length,))
                    self.assertEqual({key: array.shape[1:] for key, array in demo["obs"].items()}, shapes)
                    self.assertTrue(all(len(array) == length for array in demo["obs"].values()))

    def test_the_same_data_give_the_same_bytes_and_nothing_is_overwritten(self):
        out = self.folder / "a.hdf5"
        self.run_dataset("export", GOLDEN, "--to", "robomimic", "--out", out)
        first = out.read_bytes()
        refused = dataset("export", GOLDEN, "--to", "robomimic", "--out", out)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--overwrite", refused.stderr)
        self.run_dataset("export", GOLDEN, "--to", "robomimic", "--out", out, "--overwrite")
        self.assertEqual(out.read_bytes(), first)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["a.hdf5"])

    def test_failed_grasps_keep_their_label(self):
        import h5py

        out = self.folder / "grasp.hdf5"
        self.run_dataset("export", GRASPS, "--to", "robomimic", "--stage", "grasp", "--out", out)
        with h5py.File(out) as file:
            self.assertEqual([int(file[f"data/demo_{i}"].attrs["success"]) for i in range(4)], [1, 0, 1, 0])
            self.assertEqual(file["data/demo_0/extras/state"].dtype, np.float64)

    def test_what_was_executed_is_beside_what_was_asked_for(self):
        import h5py

        out = self.folder / "handle.hdf5"
        self.run_dataset("export", HANDLES, "--to", "robomimic", "--stage", "handle", "--out", out)
        episodes = reader.Dataset(HANDLES).episodes("handle", "train")
        with h5py.File(out) as file:
            self.assertEqual(len(file["data"]), len(episodes))
            for number, episode in enumerate(episodes):
                extras = file[f"data/demo_{number}/extras"]
                np.testing.assert_array_equal(extras["executed"][:], episode["executed"])
                self.assertGreater(np.abs(extras["executed"][:] - extras["action"][:]).max(), 1e-3)

    def test_damage_and_a_stage_that_is_not_there_end_without_a_file(self):
        folder, out = self.copy(), self.folder / "a.hdf5"
        missing = dataset("export", folder, "--to", "robomimic", "--stage", "grasp", "--out", out)
        self.assertEqual(missing.returncode, 3)
        self.assertIn("open/train", missing.stderr)
        tar = folder / "open/train/shard-000000.tar"
        damaged = bytearray(tar.read_bytes())
        damaged[json.loads(tar.with_name("shard-000000.index.json").read_text())
                ["episodes"][1]["members"][1]["offset"] + 700] ^= 4
        tar.write_bytes(damaged)
        result = dataset("export", folder, "--to", "robomimic", "--out", out)
        self.assertEqual(result.returncode, 3)
        self.assertIn("cloud.npy", result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["data"])


# of the context that the specification of Croissant 1.0 gives in its appendix
CROISSANT_TERMS = """citeAs column equivalentProperty extract field fileProperty fileObject fileSet format includes
    isLiveDataset jsonPath key md5 parentField path recordSet references regex repeated replace samplingRate separator
    source subField transform""".split()


class Card(DownstreamTest):
    def setUp(self):
        super().setUp()
        self.data = self.copy()
        self.run_dataset("card", self.data)
        self.croissant = json.loads((self.data / "croissant.json").read_text())

    def test_the_front_matter_names_licence_tags_and_one_configuration_a_stage(self):
        readme = (self.data / "README.md").read_text()
        _, front, body = readme.split("---\n", 2)
        if has("yaml"):
            import yaml

            front = yaml.safe_load(front)
            self.assertEqual(front["license"], "cc0-1.0")
            self.assertIn("robotics", front["tags"])
            self.assertEqual(front["size_categories"], ["n<1K"])
            self.assertEqual([c["config_name"] for c in front["configs"]], ["open"])
            for files in front["configs"][0]["data_files"]:
                self.assertTrue(list(self.data.glob(files["path"])), files)
        self.assertIn("| open | train | 6 | 1 | 80 | 2 |", body)
        for feature in reader.Dataset(self.data).features.values():
            self.assertIn(f"| `{feature.name}` |", body)
        self.assertIn("| door_stuck | 1 |", body)

    def test_every_file_has_its_hash_and_size(self):
        objects = [item for item in self.croissant["distribution"] if item["@type"] == "cr:FileObject"]
        listed = {item["contentUrl"]: item for item in objects}
        own = {"README.md", "croissant.json"}
        self.assertEqual(set(listed), {str(path.relative_to(self.data)) for path in self.data.rglob("*")
                                       if path.is_file()} - own)
        for path, item in listed.items():
            content = (self.data / path).read_bytes()
            self.assertEqual(item["sha256"], hashlib.sha256(content).hexdigest(), path)
            self.assertEqual(item["contentSize"], f"{len(content)} B")

    def test_it_is_croissant(self):
        self.assertEqual(self.croissant["@type"], "sc:Dataset")
        self.assertEqual(self.croissant["conformsTo"], "http://mlcommons.org/croissant/1.0")
        self.assertEqual(self.croissant["license"], "https://spdx.org/licenses/CC0-1.0.html")
        for required in ("@context", "name", "description", "distribution", "recordSet"):
            self.assertTrue(self.croissant[required])
        self.assertEqual({name: meaning for name, meaning in self.croissant["@context"].items()
                          if meaning == f"cr:{name}"}, {name: f"cr:{name}" for name in CROISSANT_TERMS})
        self.assertEqual(self.croissant["@context"]["cr"], "http://mlcommons.org/croissant/")
        ids = {item["@id"] for item in self.croissant["distribution"]}
        self.assertEqual(len(ids), len(self.croissant["distribution"]))
        members = {item["includes"] for item in self.croissant["distribution"] if item["@type"] == "cr:FileSet"}
        self.assertEqual(members, {"*.meta.json"} | {f"*.{f.member}" for f in reader.Dataset(self.data).features.values()})
        for item in self.croissant["distribution"]:
            for source in item.get("containedIn", []):
                self.assertIn(source["@id"], ids)
        for record_set in self.croissant["recordSet"]:
            for field in record_set["field"]:
                self.assertTrue(field["@id"].startswith(record_set["@id"] + "/"))
                source = field["source"]
                self.assertIn(source.get("fileSet", source.get("fileObject"))["@id"], ids)
        failures = next(r for r in self.croissant["recordSet"] if r["@id"] == "failures")
        first = next(reader.Dataset(self.data).failures())
        self.assertLessEqual({field["source"]["extract"]["column"] for field in failures["field"]}, set(first))

    def test_it_is_written_again_the_same(self):
        before = {name: (self.data / name).read_bytes() for name in ("README.md", "croissant.json")}
        self.run_dataset("card", self.data)
        for name, content in before.items():
            self.assertEqual((self.data / name).read_bytes(), content)


class Info(DownstreamTest):
    def test_the_document_counts_what_the_shards_hold(self):
        stage = json.loads(self.run_dataset("info", GOLDEN, "--json"))["stages"][0]
        data, peaks = reader.Dataset(GOLDEN), []
        for split in ("train", "val"):
            peaks += [episode.meta["peak_hinge_rad"] for episode in data.episodes("open", split)]
        peaks += [failure["peak_hinge_rad"] for failure in data.failures()]
        counts, _ = np.histogram(np.degrees(peaks), bins=[*range(0, 125, 5), 1000])
        self.assertEqual(stage["all"]["hinge"]["counts"], counts.tolist())
        self.assertEqual((stage["all"]["episodes"], stage["all"]["succeeded"]), (9, 8))
        self.assertEqual(stage["by_category"]["car"]["causes"], {"door_stuck": 1})
        self.assertEqual(stage["by_category"]["car"]["success_rate"], 0.5)
        self.assertEqual({name: group["episodes"] for name, group in stage["by_split"].items()}, {"train": 7, "val": 2})

    def test_grasps_that_were_kept_though_they_failed_count_as_failed(self):
        document = json.loads(self.run_dataset("info", GRASPS, "--json"))
        self.assertEqual(document["parts"][0]["success_rate"], 0.4)
        self.assertEqual(document["stages"][0]["all"]["causes"], {"collision": 2, "not_reached": 1})
        self.assertIn(" 40.0 %", self.run_dataset("info", GRASPS))

    def test_the_text_names_categories_and_causes(self):
        text = self.run_dataset("info", GOLDEN)
        for word in ("refrigerator", "lever", "door_stuck", "success"):
            self.assertIn(word, text)

    def test_the_page_needs_no_other_file(self):
        page, picture = self.folder / "page.html", self.folder / "angles.png"
        self.run_dataset("info", GOLDEN, "--html", page, "--png", picture)
        html = page.read_text()
        root = xml.etree.ElementTree.fromstring(html.replace("<!DOCTYPE html>", ""))
        self.assertEqual(set(re.findall(r"https?://[^\"<> ]*", html)),
                         {"http://www.w3.org/1999/xhtml"})
        self.assertNotIn(str(GOLDEN.parent), html)
        space = "{http://www.w3.org/1999/xhtml}"
        bars = [bar for bar in root.iter(space + "rect") if bar.get("class") == "good" and bar.find(space + "title") is not None]
        self.assertGreaterEqual(len(bars), 6)
        cells = [cell.text for cell in root.iter(space + "td")]
        for category in ("car", "interior", "refrigerator", "safe", "storagefurniture", "window"):
            self.assertIn(category, cells)
        png = picture.read_bytes()
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", png[16:24])
        self.assertGreater(min(width, height), 400)


@unittest.skipUnless(has("jsonschema"), "python3-jsonschema is not installed")
class Schemas(DownstreamTest):
    def validator(self, name):
        import jsonschema

        schema = json.loads((SOURCE / f"schemas/json/{name}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        return jsonschema.Draft202012Validator(schema)

    def records(self):
        """Pairs of schema and record of the golden data sets."""
        for folder in (GOLDEN, GRASPS, HANDLES):
            yield from self.records_of(folder)

    def records_of(self, folder):
        yield "dataset", json.loads((folder / "dataset.json").read_text())
        yield "provenance", json.loads((folder / "provenance.json").read_text())
        for path in folder.rglob("*.index.json"):
            yield "shard_index", json.loads(path.read_text())
        data = reader.Dataset(folder)
        for part in data.parts:
            for episode in data.episodes(part.stage, part.split):
                yield "episode", episode.meta
        for failure in data.failures():
            yield "failure", failure

    def test_golden_records_are_valid(self):
        seen = set()
        for name, record in self.records():
            self.assertEqual([error.message for error in self.validator(name).iter_errors(record)], [], name)
            seen.add(name)
        # what programs write besides is held against the other schemas in programs/published_schemas_test
        self.assertEqual(seen, {"dataset", "provenance", "shard_index", "episode", "failure"})

    def test_records_that_lack_a_key_or_have_another_type_are_not(self):
        for name, record in self.records():
            validator = self.validator(name)
            for key in validator.schema["required"]:
                self.assertFalse(validator.is_valid({k: v for k, v in record.items() if k != key}), (name, key))
                self.assertFalse(validator.is_valid({**record, key: [{}]}), (name, key))


@unittest.skipUnless(has("torch"), "python3-torch is not installed")
class Torch(DownstreamTest):
    def train(self, *arguments):
        command = [sys.executable, "-B", str(SOURCE / "docs/examples/torch_dataset.py"), str(GOLDEN), *map(str, arguments)]
        environment = {"PYTHONPATH": str(SOURCE / "python"), "OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"}
        result = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.splitlines()

    def test_the_example_learns_and_a_run_that_was_cut_ends_with_the_same_network(self):
        checkpoint = self.folder / "run.pt"
        whole = self.train("--epochs", 3, "--workers", 2)
        losses = [float(line.split()[-1]) for line in whole if line.startswith("epoch")]
        self.assertEqual(len(losses), 3)
        self.assertLess(losses[-1], 0.9 * losses[0])
        self.train("--epochs", 3, "--steps", 7, "--checkpoint", checkpoint)
        resumed = self.train("--epochs", 3, "--checkpoint", checkpoint)
        self.assertIn("going on at epoch 1, sample 32", resumed)
        self.assertEqual(resumed[-1], whole[-1])
        self.assertRegex(whole[-1], r"^policy sha256 [0-9a-f]{64}$")


if __name__ == "__main__":
    unittest.main(verbosity=2)
