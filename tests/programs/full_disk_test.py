# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What certainly has no room is refused before work begins: a disk of one megabyte, mounted in a name space of its
own, which is skipped where the system does not let us have one."""
import shlex
import subprocess
import unittest

from programs import BINARY_DIR, ProgramTest, run


class FullDisk(ProgramTest):
    def on_small_disk(self, *arguments: object) -> subprocess.CompletedProcess:
        """Runs `doorforge ARGUMENTS` where the folder "small" is such a disk; lists it afterwards."""
        small = self.folder / "small"
        small.mkdir(exist_ok=True)
        command = shlex.join([str(BINARY_DIR / "bin/doorforge"), *map(str, arguments)])
        script = (f"mount -t tmpfs -o size=1m none {shlex.quote(str(small))} || exit 99\n{command}; code=$?\n"
                  f"echo left: $(find {shlex.quote(str(small))} -type f)\nexit $code")
        try:
            result = subprocess.run(["unshare", "--user", "--map-root-user", "--mount", "bash", "-c", script],
                                    capture_output=True, text=True, timeout=300, errors="replace")
        except FileNotFoundError:
            self.skipTest("no unshare on this system")
        if result.returncode == 99 or "unshare" in result.stderr:
            self.skipTest("no disk may be mounted here: " + result.stderr.strip())
        return result

    def test_collecting_looking_again_exporting_and_merging_are_refused(self):
        data, door, small = self.folder / "data", self.folder / "door", self.folder / "small"
        self.assert_ends(run("compose", "--body", "interior_flush_01", "--handle", "interior_lever_tube_02",
                             "--out", door), 0)
        collect = ["datagen", "open", "--doors", door, "--episodes", 2, "--seed", 3, "--set", "preview=false"]
        self.assert_ends(run(*collect, "--out", data), 0)
        doors = [door] + [self.folder / f"again_{i}" for i in range(63)]
        for link in doors[1:]:
            link.symlink_to(door)
        for arguments in (
            ["datagen", "open", "--doors", door, "--episodes", 200, "--out", small / "data"],
            ["dataset", "re-observe", data, "--doors", door, "--out", small / "again"],
            ["dataset", "export", data, "--to", "robomimic", "--out", small / "data.hdf5"],
            ["dataset", "export", data, "--to", "lerobot", "--points", 4096, "--python", "/usr/bin/python3",
             "--out", small / "lerobot"],
            ["dataset", "merge", small / "merged", data],
            ["export", *doors, "--format", "urdf", "--out", small / "exported"],
        ):
            result = self.on_small_disk(*arguments)
            self.assert_refused(result, 3)
            self.assertRegex(result.stderr, r"about [1-9]\d* MiB are needed, [01] MiB are free; make room",
                             result.args)
            self.assertNotIn(".tar", result.stdout)
            self.assertNotIn("hdf5", result.stdout)


if __name__ == "__main__":
    unittest.main()
