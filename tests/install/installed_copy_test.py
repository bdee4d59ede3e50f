# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""An installation that was moved works, and knows nothing of where it was built: installed_copy_test.py BINARY_DIR CMAKE"""
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

CMAKE = sys.argv.pop(2)
BINARY_DIR = pathlib.Path(sys.argv.pop(1)).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]

CUBE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""

CONSUMER_CMAKE = """cmake_minimum_required(VERSION 3.24)
project(consumer LANGUAGES CXX)
find_package(doorforge REQUIRED COMPONENTS core)
add_executable(consumer consumer.cpp)
target_link_libraries(consumer PRIVATE doorforge::core)
"""
CONSUMER = """#include <iostream>
#include <doorforge/core/program.h>
int main() { std::cout << doorforge::DataFolder().string() << std::endl; }
"""


def install(prefix: pathlib.Path) -> list[str]:
    """What a user does. Returns the list of what was installed; the one in the build folder stays that of the user."""
    manifest = BINARY_DIR / "install_manifest.txt"
    before = manifest.read_bytes() if manifest.exists() else None
    subprocess.run([CMAKE, "--install", BINARY_DIR, "--prefix", prefix], check=True, capture_output=True)
    installed = manifest.read_text().splitlines()
    if before is None:
        manifest.unlink()
    else:
        manifest.write_bytes(before)
    return installed


def without_debug_information(path: pathlib.Path) -> bytes:
    """A build with debug information names its sources there, for the debugger."""
    with tempfile.NamedTemporaryFile() as stripped:
        subprocess.run(["objcopy", "--strip-debug", path, stripped.name], check=True)
        return pathlib.Path(stripped.name).read_bytes()


def content(path: pathlib.Path) -> bytes:
    if path.suffix == ".a" or path.parent.name == "bin":
        return without_debug_information(path)
    return gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()


class InstalledCopy(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.top = pathlib.Path(folder.name)
        cls.first = cls.top / "first"
        cls.installed = install(cls.first)
        cls.prefix = cls.top / "moved copy"
        cls.first.rename(cls.prefix)
        cls.data = cls.prefix / "share/doorforge"

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(dir=self.top)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_in(self, program: object, *arguments: object, codes=(0,), **environment: str) -> subprocess.CompletedProcess:
        """Runs a program in a folder and an environment of its own."""
        environment = {"PATH": "/usr/bin:/bin", "HOME": "/nonexistent"} | environment
        done = subprocess.run([str(program), *map(str, arguments)], cwd=self.folder, env=environment, capture_output=True,
                              text=True, timeout=300)
        self.assertIn(done.returncode, codes, f"{done.args}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
        return done

    def doorforge(self, *arguments: object, codes=(0,), **environment: str) -> subprocess.CompletedProcess:
        return self.run_in(self.prefix / "bin/doorforge", *arguments, codes=codes, **environment)

    def test_nothing_names_the_source_the_build_or_the_first_prefix(self):
        paths = [str(path).encode() for path in (SOURCE, BINARY_DIR, self.first)]
        files = [path for path in self.prefix.rglob("*") if path.is_file()]
        self.assertGreater(len(files), 800)
        for path in files:
            self.assertFalse(path.is_symlink(), path)
            text = content(path)
            self.assertEqual([], [found for found in paths if found in text], path)

    def test_the_list_by_which_it_is_uninstalled_has_every_file(self):
        files = {path.relative_to(self.prefix) for path in self.prefix.rglob("*") if path.is_file()}
        self.assertEqual({pathlib.Path(path).relative_to(self.first) for path in self.installed}, files)

    def test_a_door_from_the_catalogue_to_the_simulator(self):
        self.assertGreater(len(self.doorforge("catalog", "list").stdout.splitlines()), 500)
        self.doorforge("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", "doors/a")
        self.doorforge("validate", "doors/a")
        self.doorforge("simulate", "--door", "doors/a", "--episodes", "1")
        self.doorforge("export", "doors/a", "--format", "mjcf", "--out", "exported")
        self.assertTrue((self.folder / "exported").is_dir())

    def test_a_mesh_file_is_read(self):
        (self.folder / "cube.obj").write_text(CUBE)
        self.doorforge("repair", "cube.obj", "closed.obj")
        self.assertTrue((self.folder / "closed.obj").exists())

    def test_the_shipped_policies_and_pictures(self):
        for stage, inputs in (("grasp", ("--handle-mask", "mask.png", "--grasper", "grasper")),
                              ("open", ("--state", "state.yaml", "--opener", "opener"))):
            sight = self.data / "sight/lever" / stage
            done = self.doorforge("act", "--depth", sight / "depth.png", "--camera", sight / "camera.yaml", inputs[0],
                                  sight / inputs[1], inputs[2], self.data / "policies" / inputs[3], codes=(0, 1))
            self.assertEqual(json.loads(done.stdout)["schema"], "doorforge.decision")

    def test_help_and_plans_of_every_verb(self):
        verbs = re.findall(r"^  ([a-z]+) +\S", self.doorforge("--help").stdout.split("example:")[0], re.M)
        self.assertIn("quickstart", verbs)
        for verb in verbs:
            self.assertIn("Usage: doorforge " + verb, self.doorforge(verb, "--help").stdout)
        self.assertIn("opener", self.doorforge("pipeline", "plan", "quick", "--out", "run").stdout)

    def test_a_data_set_is_read_in_python(self):
        self.doorforge("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", "doors/a")
        self.doorforge("datagen", "open", "--doors", "doors", "--episodes", "2", "--seed", "1", "--out", "data")
        done = self.run_in("/usr/bin/python3", "-B", "-m", "doorforge_reader", "data", "--check",
                           PYTHONPATH=str(self.prefix / "lib/python3/dist-packages"))
        self.assertIn("open", done.stdout)

    def test_another_folder_of_data(self):
        done = self.doorforge("catalog", "list", codes=(3,), DOORFORGE_DATA=str(self.folder / "mine"))
        self.assertIn(str(self.folder / "mine"), done.stderr)
        shutil.copytree(self.data, self.folder / "mine")
        shutil.rmtree(self.folder / "mine/catalog/safe")
        listed = self.doorforge("catalog", "list", DOORFORGE_DATA=str(self.folder / "mine")).stdout
        self.assertIn("interior_flush_01", listed)
        self.assertNotIn("safe_", listed)

    def test_programs_through_links_and_without_data(self):
        (self.folder / "links").mkdir()
        (self.folder / "links/doorforge").symlink_to(self.prefix / "bin/doorforge")
        self.assertIn("interior_flush_01", self.run_in(self.folder / "links/doorforge", "catalog", "list").stdout)
        shutil.copytree(self.prefix / "bin", self.folder / "alone/bin")
        done = self.run_in(self.folder / "alone/bin/doorforge", "catalog", "list", codes=(3,))
        self.assertIn(str(self.folder / "alone/share/doorforge"), done.stderr)
        self.assertIn("DOORFORGE_DATA", done.stderr)

    def test_a_program_of_ones_own(self):
        (self.folder / "CMakeLists.txt").write_text(CONSUMER_CMAKE)
        (self.folder / "consumer.cpp").write_text(CONSUMER)
        self.run_in(CMAKE, "-S", self.folder, "-B", "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.run_in(CMAKE, "--build", "build")
        consumer = self.folder / "build/consumer"
        path = os.pathsep.join([str(self.prefix / "bin"), "/usr/bin", "/bin"])
        self.assertEqual(self.run_in(consumer, PATH=path).stdout.strip(), str(self.data))

    def test_public_headers_and_no_internal_ones(self):
        include = self.prefix / "include"
        headers = {str(path.relative_to(include)): path.read_text() for path in include.rglob("*.h")}
        self.assertGreater(len(headers), 150)
        included = {needed for text in headers.values() for needed in re.findall(r'(?m)^#include "(doorforge/[^"]+)"', text)}
        self.assertLessEqual(included, set(headers))
        internal = {name for name, text in headers.items() if re.search(r"(?m)^namespace doorforge::internal\b", text)}
        self.assertLessEqual(internal, included)  # what holds a member of a public class must be there

    def test_schemas_and_licences(self):
        for schema in (SOURCE / "schemas/json").iterdir():
            self.assertEqual((self.data / "schemas" / schema.name).read_text(), schema.read_text())
        documents = self.prefix / "share/doc/doorforge"
        self.assertIn("GPL-3", (documents / "copyright").read_text())
        self.assertIn("Apache License", (documents / "LICENSE").read_text())


if __name__ == "__main__":
    unittest.main(verbosity=2)
