# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Whatever comes from outside ends in a clear message and an exit code, and leaves nothing behind."""
import json
import os
import resource
import subprocess
import unittest

from programs import BINARY_DIR, ProgramTest, real_assets, run

DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"/>"""


def processor_seconds() -> float:
    """Of all programs that have ended: what else a machine does at the same time does not count."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime

# a wrap of 100 loose triangles takes 40 s of processor time (docs/repair.md); a third as fine, it is the same way
COARSER = {"soup.stl": ("--set", "alpha_fraction=0.03", "--set", "offset_fraction=0.0025")}


class BadInput(ProgramTest):
    def assert_nothing_left(self) -> None:
        left = [path.name for path in self.folder.iterdir() if path.name.startswith(("out", ".out"))]
        self.assertEqual(left, [])

    def test_every_dirty_mesh_is_repaired_or_refused(self):
        meshes = sorted(path for path in (real_assets("dirty_meshes") / "dirty_meshes").rglob("*") if path.is_file())
        self.assertGreater(len(meshes), 20)
        for mesh in meshes:
            with self.subTest(mesh.name):
                out = self.folder / "out.obj"
                before = processor_seconds()
                result = run("repair", mesh, out, *COARSER.get(mesh.name, ()), timeout=600)
                seconds = processor_seconds() - before
                self.assert_ends(result, 0, 1, 2, 3)
                self.assertEqual(out.exists(), result.returncode == 0, result.stderr)
                if result.returncode != 0:
                    self.assertGreater(len(result.stderr.strip()), 20)
                if result.returncode == 0:
                    out.unlink()
                    out.with_name(out.name + ".report.json").unlink()
                self.assert_nothing_left()
                self.assertLess(seconds, 120)

    def test_an_empty_file_and_a_folder_are_no_meshes(self):
        for name in ("empty.obj", "empty.stl", "empty.ply", "empty.dae", "empty.glb"):
            (self.folder / name).touch()
            self.assert_refused(run("repair", self.folder / name, self.folder / "out.obj"), 3)
        (self.folder / "folder.obj").mkdir()
        self.assert_refused(run("repair", self.folder / "folder.obj", self.folder / "out.obj"), 3)
        self.assert_refused(run("repair", self.folder / "missing.obj", self.folder / "out.obj"), 3)
        self.assert_nothing_left()

    def test_an_import_of_nothing_is_refused(self):
        (self.folder / "empty").mkdir()
        (self.folder / "file").touch()
        for source in ("empty", "file", "missing"):
            self.assert_refused(run("import", self.folder / source, "--out", self.folder / "out"), 1, 3)
        self.assert_nothing_left()

    def make_object(self, urdf: str) -> None:
        source = self.folder / "99650089960001"
        (source / "texture_dae").mkdir(parents=True, exist_ok=True)
        (source / "texture_dae/board.dae").write_text(DAE)
        (source / "bounding_box.json").write_text('{"min": [0, 0, 0], "max": [1, 0.1, 2]}')
        (source / "handle_bounding.json").write_text(
            json.dumps({"handle_min": [0, 0, 0], "handle_max": [0.1, 0.1, 0.1], "goal_pos": [0, 0, 0]}))
        (source / "mobility.urdf").write_text(urdf)

    def test_a_hostile_urdf_is_refused(self):
        outside = self.folder / "secret.dae"
        outside.write_text(DAE)
        mesh = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
        link = '<robot name="r"><link name="base"/><link name="link_0">' + mesh + "</link></robot>"
        hostile = [
            '<!DOCTYPE r [<!ENTITY a "aaaa">]><robot name="&a;"><link name="base"/></robot>',
            link.format("../secret.dae"), link.format(outside), link.format("texture_dae/../../secret.dae"),
            "", "not xml", "<robot>" * 200, '<robot name="r">' + "<link/>" * 3,
        ]
        for urdf in hostile:
            with self.subTest(urdf[:60]):
                self.make_object(urdf)
                result = run("import", self.folder / "99650089960001", "--out", self.folder / "out")
                self.assert_refused(result, 1, 3)
                self.assert_nothing_left()

    def write_stl(self, name: str) -> None:
        # a tetrahedron; nothing here asks what it is good for
        corners = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        lines = ["solid s"]
        for face in faces:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corners[corner]) for corner in face]
            lines += ["endloop", "endfacet"]
        (self.folder / name).write_text("\n".join(lines + ["endsolid s"]) + "\n")

    def test_an_output_that_cannot_be_written_is_told_before_the_work(self):
        self.write_stl("mesh.stl")
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_01", "--out",
                             self.folder / "door", "--quiet"), 0)
        (self.folder / "file").touch()
        out = self.folder / "file" / "below"  # where not even root can make a folder
        before = processor_seconds()
        for arguments in (["compose", "--all", "--out", out], ["catalog", "build", "--out", out],
                          ["export", self.folder / "door", "--format", "urdf", "--out", out],
                          ["repair", self.folder / "mesh.stl", out / "a.obj"],
                          ["import", self.folder / "mesh.stl", "--role", "handle", "--category", "interior", "--out", out]):
            with self.subTest(arguments[0]):
                result = run(*arguments)
                self.assert_refused(result, 3)
                self.assertIn(str(self.folder / "file"), result.stderr)
        # preparing the 532 parts of the catalogue alone takes a minute
        self.assertLess(processor_seconds() - before, 20)
        self.assertEqual((self.folder / "file").read_bytes(), b"")
        self.assert_nothing_left()

    def test_one_damaged_part_costs_no_door_of_the_others(self):
        self.assert_ends(run("catalog", "build", "--split", "quickstart", "--out", self.folder / "parts"), 0)
        parts = {path.name: json.loads((path / "part.json").read_text()) for path in (self.folder / "parts").iterdir()}
        handles = sorted(name for name, part in parts.items() if part["role"] == "handle")
        damaged = self.folder / "parts" / handles[0]
        mesh = next((damaged / "meshes").rglob("*.obj"))
        mesh.write_text(mesh.read_text().replace("v ", "v 1e9", 1))
        result = run("compose", "--all", "--parts", self.folder / "parts", "--out", self.folder / "out", "--json")
        self.assert_ends(result, 1)
        self.assertIn(handles[0] + ": left out", result.stderr)
        doors = json.loads(result.stdout)["doors"]
        self.assertGreater(len(doors), 0)
        self.assertTrue(all(door["composed"] for door in doors), doors)
        self.assertFalse(any(handles[0] in door["id"] for door in doors))

    def test_what_takes_too_much_time_is_given_up_by_name(self):
        self.write_stl("mesh.stl")
        for seconds, code in ((1e-9, 3), (600, 0)):
            result = run("repair", self.folder / "mesh.stl", self.folder / "out.obj", "--max-seconds", seconds)
            self.assert_ends(result, code)
            if code == 3:
                self.assertIn(str(self.folder / "mesh.stl") + ": takes more than", result.stderr)
                self.assertIn("--max-seconds", result.stderr)
                self.assert_nothing_left()

    def test_wrong_use_is_told_apart_from_bad_input(self):
        for arguments in (["frobnicate"], ["repair"], ["compose", "--body", "x"], ["datagen", "open", "--wrong"],
                          ["eval", "--seeds"], ["train", "open"], ["validate"], ["pipeline", "quick"],
                          ["pipeline", "nothing", "--out", "x"], ["act", "--depth", "x.png"]):
            with self.subTest(arguments):
                self.assert_refused(run(*arguments), 2)

    def test_a_slow_blas_is_noticed_and_what_to_install_is_said(self):
        # a matrix product as the reference BLAS has it: loops
        source = self.folder / "slow.cpp"
        source.write_text("""extern "C" void sgemm_(const char*, const char*, const int* m, const int* n, const int* k,
            const float* alpha, const float* a, const int* lda, const float* b, const int* ldb,
            const float* beta, float* c, const int* ldc) {
          for (int j = 0; j < *n; ++j)
            for (int i = 0; i < *m; ++i) {
              volatile float sum = 0;
              for (int l = 0; l < *k; ++l) sum = sum + a[i + l * *lda] * b[l + j * *ldb];
              c[i + j * *ldc] = *alpha * sum + (*beta == 0 ? 0 : *beta * c[i + j * *ldc]);
            }
        }""")
        library = self.folder / "libslow.so"
        if subprocess.run(["c++", "-O1", "-shared", "-fPIC", "-o", library, source]).returncode != 0:
            self.skipTest("no compiler")
        (self.folder / "data").mkdir()
        doorforge = [str(BINARY_DIR / "bin/doorforge")]
        for arguments, code in ((["doctor"], 1), (["train", "open", "--data", self.folder / "data",
                                                   "--out", self.folder / "out"], 3)):
            with self.subTest(arguments[0]):
                result = subprocess.run(doorforge + [str(argument) for argument in arguments], capture_output=True,
                                        text=True, timeout=120, env={**os.environ, "LD_PRELOAD": str(library)})
                self.assert_ends(result, code)
                self.assertRegex(result.stdout + result.stderr, r"\d GFLOP/s")
                self.assertIn("apt-get install libopenblas0-openmp", result.stdout + result.stderr)
        self.assert_nothing_left()

    def test_every_verb_explains_itself_with_an_example(self):
        for verb in ("quickstart", "catalog", "import", "repair", "compose", "validate", "simulate",
                     "datagen", "dataset", "train", "eval", "act", "sight", "pipeline", "doctor"):
            with self.subTest(verb):
                result = run(verb, "--help")
                self.assert_ends(result, 0)
                self.assertIn("example", result.stdout.lower())
                self.assertIn("doorforge " + verb, result.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
