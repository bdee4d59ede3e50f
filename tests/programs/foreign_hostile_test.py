# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Files of strangers that are made to break a reader: `validate` and `import` refuse each by its name, within limits."""
import contextlib
import json
import os
import pathlib
import resource
import shutil
import socket
import subprocess
import threading
import time
import unittest
import unittest.mock

import foreign_bombs
import foreign_samples as samples
from programs import ProgramTest, run

MEMORY_GIB = 3  # of address space: a child that reads for another program may have two
MOST_SECONDS = 20  # of processor time, children and all
TIMEOUT = 600  # by the clock: what takes as long hangs

OBJECTS = {"urdf": samples.URDF, "xml": samples.MJCF, "sdf": samples.SDF, "usda": samples.USDA, "obj": samples.OBJ,
           "stl": samples.STL, "ply": samples.PLY, "off": samples.OFF}


def place_object(folder: pathlib.Path, file: str, content: str | bytes) -> pathlib.Path:
    (folder / "meshes").mkdir(parents=True)
    (folder / "meshes/box.obj").write_text(samples.OBJ)
    (folder / "meshes/box.stl").write_text(samples.STL)
    path = folder / file
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def make_pipe(path: pathlib.Path) -> None:
    os.mkfifo(path)


def make_socket(path: pathlib.Path) -> None:
    with socket.socket(socket.AF_UNIX) as plug:  # a path of a socket is short
        here = os.getcwd()
        os.chdir(path.parent)
        try:
            plug.bind(path.name)
        finally:
            os.chdir(here)


def make_hole(path: pathlib.Path) -> None:
    with path.open("wb") as file:
        file.truncate(1 << 40)


# What lies where a file should lie.
PLACES = {
    "pipe": make_pipe,
    "socket": make_socket,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "terminal": lambda path: path.symlink_to("/dev/tty"),
    "process": lambda path: path.symlink_to("/proc/self/mem"),
    "loop": lambda path: path.symlink_to(path.name),
    "two_loop": lambda path: (path.symlink_to(path.name + "_"), path.with_name(path.name + "_").symlink_to(path.name)),
    "nowhere": lambda path: path.symlink_to("gone"),
    "folder": lambda path: path.mkdir(),
    "hole": make_hole,
}


class ForeignHostile(ProgramTest):
    def run_limited(self, *arguments: object) -> tuple:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        result = run(*arguments, timeout=TIMEOUT, memory_gib=MEMORY_GIB)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return result, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def problem_of_validate(self, path: pathlib.Path, code: str | None) -> str:
        """What is wrong with how it is refused; empty where nothing is."""
        result, seconds = self.run_limited("validate", path, "--format", "json")
        if result.returncode not in ((0, 1) if code is None else (1,)):
            return f"validate ends with {result.returncode}: {result.stderr[-200:]}"
        if seconds > MOST_SECONDS:
            return f"validate takes {seconds:.1f} s"
        item = json.loads(result.stdout)["items"][0]
        codes = [finding["code"] for finding in item["findings"]]
        if "FIL012" in codes or (code is not None and code not in codes):
            return f"validate finds {codes}, expected {code}: {[f['measured'] for f in item['findings']][:2]}"
        return ""

    def problem_of_import(self, path: pathlib.Path, taken: bool) -> str:
        role = [] if path.suffix in (".urdf", ".xml", ".sdf", ".usda") else ["--role", "handle", "--category", "interior"]
        result, seconds = self.run_limited("import", path, "--out", path.parent / "parts", *role)
        if result.returncode != (0 if taken else 3):
            return f"import ends with {result.returncode}: {result.stderr[-200:]}"
        if seconds > MOST_SECONDS:
            return f"import takes {seconds:.1f} s"
        if not taken and path.name not in result.stderr:
            return f"import does not name it: {result.stderr[-200:]}"
        return ""

    def test_bombs_are_named_within_limits(self):
        problems = []
        count = 0
        for name, file, content, code in foreign_bombs.all_bombs():
            folder = self.folder / name
            path = place_object(folder, file, content)
            count += 1
            found = [self.problem_of_validate(path, code)]
            if path.suffix == ".mjcf":  # import knows MJCF by its root
                path = path.rename(path.with_suffix(".xml"))
            found.append(self.problem_of_import(path, name in foreign_bombs.IMPORTED))
            problems += [f"{name}: {problem}" for problem in found if problem]
            shutil.rmtree(folder)
        self.assertEqual(problems, [], "\n" + "\n".join(problems))
        print(f"{count} bombs")

    def test_what_is_no_file_is_refused(self):
        document, binary = samples.gltf_gate()
        endings = [*OBJECTS, "glb", "gltf", "dae"]
        problems = []
        for place, make in PLACES.items():
            folder = self.folder / place
            folder.mkdir()
            for ending in endings:
                path = folder / f"model.{ending}"
                make(path)
                for verb in (["validate", path], ["import", path, "--out", folder / "parts", "--role", "handle", "--category", "interior"]):
                    result, seconds = self.run_limited(*verb)
                    said = result.stdout + result.stderr
                    # validate counts what it could not read as a finding of that file, import as its input
                    if result.returncode not in (1, 3) or path.name not in said or seconds > MOST_SECONDS:
                        problems.append(f"{verb[0]} {place} {ending}: {result.returncode}, {seconds:.1f} s, {said[-200:]}")
        self.assertEqual(problems, [], "\n" + "\n".join(problems))
        self.assertTrue(document and binary)

    def test_what_a_file_names_may_be_no_file(self):
        gltf, binary = samples.gltf_gate()
        gltf["buffers"][0]["uri"] = "box.bin"
        # of a handle's size: in a box of a metre a grasp is looked for longest
        picture = samples.OBJ.replace("0.5", "0.05").replace("# a box", "mtllib box.mtl\n# a box\nusemtl oak")
        # the object, and the file that it names
        named = {
            "model.urdf": (samples.URDF, "meshes/box.obj"), "model.xml": (samples.MJCF, "meshes/box.obj"),
            "model.sdf": (samples.SDF, "meshes/box.stl"), "model.gltf": (json.dumps(gltf), "box.bin"),
            "deep.gltf": (json.dumps(gltf).replace('"box.bin"', '"./meshes/../box.bin"'), "box.bin"),
            "included.xml": (samples.MJCF.replace("<compiler", '<include file="more.xml"/><compiler', 1), "more.xml"),
            "layer.usda": (samples.USDA.replace("(\n    defaultPrim", "(\n    subLayers = [@more.usda@]\n    defaultPrim", 1), "more.usda"),
            "box.obj": (picture, "box.mtl"),
        }
        problems = []
        places = PLACES | {"outside": lambda path: path.symlink_to("/etc/passwd")}
        for place, make in places.items():
            for file, (content, names) in named.items():
                folder = self.folder / f"{place}_{file}"
                path = place_object(folder, file, content)
                target = folder / names
                target.unlink(missing_ok=True)
                make(target)
                role = ["--role", "handle", "--category", "interior"] if path.suffix in (".obj", ".gltf") else []
                for verb in (["validate", path], ["import", path, "--out", folder / "parts", *role]):
                    result, seconds = self.run_limited(*verb)
                    said = result.stdout + result.stderr
                    # colours may be missing, and of a layer that is named only that it is there is asked
                    optional = names == "box.mtl" or (verb[0], place) == ("validate", "hole") and names == "more.usda"
                    refused = result.returncode in ((0, 1, 3) if optional else (1, 3))
                    if not refused or file not in said or seconds > MOST_SECONDS:
                        problems.append(f"{verb[0]} {file} names {place}: {result.returncode}, {seconds:.1f} s, {said[-300:]}")
                    if "longer than the time" in said:
                        problems.append(f"{verb[0]} {file} names {place}: waits until its limit")
                    if "root:x:0" in said:
                        problems.append(f"{verb[0]} {file} names {place}: shows the other file")
                shutil.rmtree(folder)
        self.assertEqual(problems, [], "\n" + "\n".join(problems))

    def test_a_mesh_of_an_object_may_name_what_is_no_file(self):
        gltf, _ = samples.gltf_gate()
        gltf["buffers"][0]["uri"] = "box.bin"
        for place in ("pipe", "device", "terminal"):
            folder = self.folder / f"of_{place}"
            path = place_object(folder, "model.urdf", samples.URDF.replace("meshes/box.obj", "meshes/box.gltf"))
            (folder / "meshes/box.gltf").write_text(json.dumps(gltf))
            PLACES[place](folder / "meshes/box.bin")
            for verb in (["validate", path], ["import", path, "--out", folder / "parts"]):
                with self.subTest(place=place, verb=verb[0]):
                    result, _ = self.run_limited(*verb)
                    self.assert_ends(result, 1, 3)
                    self.assertNotIn("longer than the time", result.stdout + result.stderr)
                    self.assertIn("box.gltf", result.stdout + result.stderr)

    def test_objects_are_read_in_a_process_of_their_own(self):
        gltf, _ = samples.gltf_gate()
        objects = {"model.urdf": samples.URDF, "model.xml": samples.MJCF, "model.sdf": samples.SDF, "model.usda": samples.USDA,
                   "model.gltf": json.dumps(gltf)}
        # what the reading program does in place of an answer, and what is said of the file
        ends = {"crash": ("kill -SEGV $$", "crashed on it"), "nothing": ("exit 3", "exit code 3"), "forged": ("head -c 4000 /dev/zero >&3", "no")}
        for end, (does, said) in ends.items():
            reader = self.folder / end
            reader.write_text(f"#!/bin/sh\n{does}\n")
            reader.chmod(0o755)
            for file, content in objects.items():
                path = place_object(self.folder / f"{end}_{file}", file, content)
                with self.subTest(end=end, file=file), unittest.mock.patch.dict(os.environ, DOORFORGE_READ_MODEL=str(reader)):
                    result = run("validate", path, "--ask", "none")
                    self.assert_ends(result, 1)
                    self.assertIn("FIL012", result.stdout)
                    self.assertIn(said, result.stdout)
                    if file == "model.gltf":  # it is imported as a mesh, by another program
                        continue
                    result = run("import", path, "--out", path.parent / "parts")
                    self.assert_ends(result, 3)
                    self.assertIn(file, result.stderr)
                    self.assertIn(said, result.stderr)

    def test_what_compose_wrote_needs_no_reader(self):
        door = self.folder / "door"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out", door), 0)
        with unittest.mock.patch.dict(os.environ, DOORFORGE_READ_MODEL="/bin/false"):
            self.assert_ends(run("validate", door), 0)
            urdf = door / "model.urdf"
            urdf.write_text(urdf.read_text().replace("<link", "<!-- of others --><link", 1))
            result = run("validate", door)
        self.assert_ends(result, 1)
        self.assertIn("URD001", result.stdout)
        self.assert_ends(run("validate", door), 0)

    def test_files_may_vanish_while_they_are_read(self):
        folder = self.folder / "moving"
        place_object(folder, "model.urdf", samples.URDF)
        for name, content in (("model.xml", samples.MJCF), ("model.sdf", samples.SDF), ("model.usda", samples.USDA)):
            (folder / name).write_text(content)
        texts = {path: path.read_bytes() for path in [*folder.glob("model.*"), *folder.glob("meshes/*")]}
        stop = threading.Event()

        def disturb():
            turn = 0
            spare = self.folder / "spare"
            while not stop.is_set():
                for path, content in texts.items():
                    turn += 1
                    with contextlib.suppress(FileNotFoundError):
                        spare.unlink()
                    if turn % 5 == 0:
                        os.mkfifo(spare)
                    elif turn % 5 == 1:
                        spare.symlink_to("/dev/zero")
                    else:
                        spare.write_bytes(content[:len(content) // 2] if turn % 5 == 2 else content)
                    if turn % 7 == 0:
                        path.unlink(missing_ok=True)
                    else:
                        os.replace(spare, path)
                    time.sleep(0.0005)

        thread = threading.Thread(target=disturb)
        thread.start()
        try:
            for number in range(30):
                # of others' programs each may wait for a pipe as long as it is let, 60 s
                verb = ["validate", "--ask", "none", *([folder] if number % 2 == 0 else texts)]
                if number % 3 == 2:
                    verb = ["import", folder / "model.urdf", "--out", self.folder / f"parts{number}"]
                result, seconds = self.run_limited(*verb)
                self.assert_ends(result, 0, 1, 3)
                self.assertLess(seconds, MOST_SECONDS)
        finally:
            stop.set()
            thread.join()

    def test_folders_may_be_mazes(self):
        folder = self.folder / "maze"
        path = place_object(folder, "model.urdf", samples.URDF)
        (folder / "again").symlink_to(folder)
        (folder / "up").symlink_to("..")
        (folder / "loop").symlink_to("loop")
        (folder / "model.urdf.d").mkdir()
        (folder / os.fsdecode(b"\xff\n\x1b[31m.urdf")).write_text(samples.URDF)
        make_pipe(folder / "pipe.urdf")
        result, _ = self.run_limited("validate", folder, "--format", "json")
        self.assert_ends(result, 0)
        self.assertEqual(len(json.loads(result.stdout)["items"]), 2)
        result, _ = self.run_limited("validate", folder)
        self.assert_ends(result, 0)
        self.assertNotIn("\x1b", result.stdout)
        result, _ = self.run_limited("import", folder, "--out", self.folder / "parts")
        self.assert_ends(result, 0)
        self.assertNotIn("\x1b", result.stdout)
        self.assertIn("2 imported", result.stdout)
        # deeper than a path may be long
        here = os.open(folder, os.O_RDONLY)
        for _ in range(1500):
            os.mkdir("deep", dir_fd=here)
            inner = os.open("deep", os.O_RDONLY, dir_fd=here)
            os.close(here)
            here = inner
        os.close(here)
        for verb in (["validate", folder], ["import", folder, "--out", self.folder / "parts_deep"]):
            result, _ = self.run_limited(*verb)
            self.assert_ends(result, 0, 1, 3)
        self.assertTrue(path.exists())
        subprocess.run(["rm", "-rf", folder / "deep"], check=True)  # deeper than Python removes


if __name__ == "__main__":
    unittest.main()
