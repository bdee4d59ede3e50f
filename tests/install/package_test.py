# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The Debian package that users install: what it says of itself, and what is in it: package_test.py BINARY_DIR CPACK"""
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CPACK = sys.argv.pop(2)
BINARY_DIR = pathlib.Path(sys.argv.pop(1)).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def answer(*command: object) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def pack(folder: pathlib.Path) -> pathlib.Path:
    """The package of programs, made there."""
    subprocess.run([CPACK, "-G", "DEB", "--config", BINARY_DIR / "CPackConfig.cmake", "-B", folder,
                    "-D", "CPACK_COMPONENTS_ALL=programs;debian", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=zstd"],
                   check=True, capture_output=True, cwd=BINARY_DIR, umask=0o022)
    [package] = folder.glob("doorforge_*.deb")
    return package


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.top = pathlib.Path(folder.name)
        cls.package = pack(cls.top)
        cls.root = cls.top / "root"
        answer("dpkg-deb", "-x", cls.package, cls.root)

    def test_packed_later_elsewhere_it_has_the_same_bytes(self):
        again = self.top / "elsewhere/again"
        again.mkdir(parents=True)
        self.assertEqual(hashlib.sha256(pack(again).read_bytes()).hexdigest(),
                         hashlib.sha256(self.package.read_bytes()).hexdigest(), "scripts/compare_packages.sh says what differs")

    def field(self, name: str) -> str:
        return answer("dpkg-deb", "-f", self.package, name).strip()

    def depends(self) -> list[str]:
        return [re.split(r"[ |(]", one.strip())[0] for one in self.field("Depends").split(",")]

    def test_what_it_says_of_itself(self):
        self.assertEqual(self.field("Package"), "doorforge")
        self.assertEqual(self.field("Section"), "science")
        self.assertRegex(self.field("Maintainer"), r"^.+ <\S+@\S+>$")
        description = self.field("Description").splitlines()
        self.assertEqual(description[0], "Door assets and door-opening data for robot learning")
        self.assertGreater(len(description), 5)
        self.assertEqual(self.field("Version"), answer(BINARY_DIR / "bin/doorforge", "--version").split("+")[0])

    def test_it_depends_on_every_library_that_a_program_names(self):
        """Those that the dynamic linker is told by name, in the packages that dpkg says hold them."""
        programs = [*(self.root / "usr/bin").iterdir()]
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", answer("readelf", "-d", *programs)))
        found = dict(re.findall(r"^\s*(\S+) => (/\S+)", answer("ldd", *programs), re.M))
        self.assertIn("libtorch_cpu.so.1.13", needed & set(found))
        files = {library: pathlib.Path(found[library]).resolve().name for library in needed if library in found}
        owners: dict[str, set[str]] = {}
        for package, path in re.findall(r"^(\S+?)(?::\w+)?: (\S+)$", answer("dpkg", "-S", *(f"*/{name}" for name in files.values())), re.M):
            owners.setdefault(pathlib.Path(path).name, set()).add(package)
        for library, name in files.items():
            with self.subTest(library):
                self.assertTrue(owners[name] & set(self.depends()), owners[name])

    def test_every_dependency_can_be_installed(self):
        told = answer("apt-cache", "policy", *self.depends())
        for package in self.depends():
            with self.subTest(package):
                self.assertRegex(told, rf"(?m)^{re.escape(package)}:\n(  Installed: \d|  Installed: \(none\)\n  Candidate: \d)")

    def test_training_gets_a_fast_blas(self):
        self.assertIn("libopenblas0-openmp", self.depends())

    def test_files_lie_where_debian_wants_them(self):
        for path in ("bin/doorforge", "bin/doorforge-read-mesh", "share/man/man1/doorforge.1.gz", "share/doorforge/catalog",
                     "share/doorforge/policies/opener/policy.json", "share/doorforge/schemas",
                     "lib/python3/dist-packages/doorforge_reader.py", "lib/python3/dist-packages/doorforge_lerobot.py",
                     "lib/python3/dist-packages/doorforge/__init__.py",
                     "share/bash-completion/completions/doorforge",
                     "share/zsh/vendor-completions/_doorforge", "share/fish/vendor_completions.d/doorforge.fish",
                     "share/doc/doorforge/changelog.gz"):
            self.assertTrue((self.root / "usr" / path).exists(), path)
        listed = answer("dpkg-deb", "-c", self.package)
        self.assertEqual([], re.findall(r"^.*(?:\.a|\.h|\.cmake|site-functions.*)$", listed, re.M))
        self.assertEqual([], re.findall(r"^\S+ (?!root/root)\S+", listed, re.M))

    def test_the_program_that_contains_cgal_is_under_gpl(self):
        copyright_file = (self.root / "usr/share/doc/doorforge/copyright").read_text()
        paragraphs = [dict(re.findall(r"^(\S+): ?(.*(?:\n .*)*)", text, re.M)) for text in copyright_file.split("\n\n")]
        licences = {files: paragraph["License"] for paragraph in paragraphs if "Files" in paragraph
                    for files in paragraph["Files"].split()}
        self.assertEqual(licences["usr/bin/doorforge-assets"], "GPL-3+")
        self.assertEqual(licences["*"], "Apache-2.0")
        told = {paragraph["License"].split("\n")[0] for paragraph in paragraphs if "Files" not in paragraph and "License" in paragraph}
        self.assertEqual({name for licence in licences.values() for name in licence.split(" and ")}, told)
        with_cgal = {program.name for program in (self.root / "usr/bin").iterdir() if b"CGAL" in program.read_bytes()}
        self.assertEqual(with_cgal, {"doorforge-assets"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
