# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""A mesh that is not the one a door or a part was recorded with is refused by name, by every verb."""
import pathlib
import shutil
import unittest

from programs import ProgramTest, run

BODY, HANDLE = "safe_antique_01", "safe_dial_lever_01"


def change(mesh: pathlib.Path) -> str:
    """One digit of the first coordinate becomes another one: still a mesh. Returns the text before."""
    before = mesh.read_text()
    at = next(i for i, letter in enumerate(before) if letter.isdigit())
    mesh.write_text(before[:at] + ("1" if before[at] != "1" else "2") + before[at + 1:])
    return before


def meshes(folder: pathlib.Path) -> list[pathlib.Path]:
    """One that is seen and one that is touched."""
    found = sorted(folder.glob("meshes/**/*.obj"))
    touched = [mesh for mesh in found if "_hull_" in mesh.name or mesh.parent.name == "collision"]
    return [next(mesh for mesh in found if mesh not in touched), touched[0]]


class ChangedMesh(ProgramTest):
    def assert_each_is_refused(self, folder: pathlib.Path, verbs: dict[str, list]) -> None:
        for mesh in meshes(folder):
            before = change(mesh)
            for name, arguments in verbs.items():
                with self.subTest(name, mesh=mesh.name):
                    result = run(*arguments)
                    self.assert_refused(result, 1, 3)
                    self.assertIn(f"{mesh.name}: SHA-256 ", result.stderr)
            mesh.write_text(before)

    def test_by_every_verb_that_takes_doors(self):
        door, out = self.folder / "door", self.folder / "out"
        self.assert_ends(run("compose", "--body", BODY, "--handle", HANDLE, "--out", door), 0)
        verbs = {
            "simulate": ["simulate", "--door", door],
            "datagen": ["datagen", "open", "--doors", door, "--out", out, "--episodes", 1],
            "eval": ["eval", "--opener", "expert", "--doors", door, "--seeds", 1],
            "export": ["export", door, "--to", "urdf", "--out", out],
            "preview": ["preview", door, "--out", self.folder / "door.png"],
            "preview --episode": ["preview", "--episode", "--door", door, "--out", self.folder / "film.png"],
        }
        self.assert_each_is_refused(door, verbs)
        self.assertFalse((self.folder / "door.png").exists())
        for mesh in meshes(door):
            before = change(mesh)
            result = run("validate", door)
            self.assert_ends(result, 1)
            self.assertIn("MSH004", result.stdout)
            mesh.write_text(before)
        for name in ("export", "preview"):
            self.assert_ends(run(*verbs[name]), 0)

    def test_by_every_verb_that_takes_parts(self):
        parts, out = self.folder / "parts", self.folder / "out"
        self.assert_ends(run("catalog", "build", "--category", "safe", "--out", self.folder / "built"), 0)
        for part in (BODY, HANDLE):
            shutil.copytree(self.folder / "built" / part, parts / part)
        for part in (parts / BODY, parts / HANDLE):
            self.assert_each_is_refused(part, {
                "compose": ["compose", "--body", parts / BODY, "--handle", parts / HANDLE, "--out", out],
                "compose --all": ["compose", "--all", "--parts", parts, "--out", self.folder / "all"],
                "preview": ["preview", part, "--out", self.folder / "part.png"],
            })
        self.assertFalse(out.exists())
        self.assertEqual(list((self.folder / "all").rglob("door.json")), [])
        self.assert_ends(run("compose", "--body", parts / BODY, "--handle", parts / HANDLE, "--out", out), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
