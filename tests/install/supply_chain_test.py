#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs are linked with: NOTICE against the programs and against what Debian says of the
libraries, the bill of materials against the loader and dpkg. Arguments: source folder, build folder."""
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
PROGRAMS = sorted(path for path in (BUILD / "bin").iterdir()
                  if re.fullmatch(r"doorforge(-[a-z-]+)?", path.name) and os.access(path, os.X_OK))
RUN_TIME = re.compile(r"(ld-linux-x86-64|libc|libm|libgcc_s|libstdc\+\+|libdl|libpthread|librt|lib[atu]*san)\.so")

# What the copyright file of a library under that licence says somewhere.
WORDS = {
    "Zlib": r"(?i)zlib|without any express or implied\s+warranty",
    "BSD-3-Clause": r"(?i)BSD-3-clause|neither the names? of",
    "BSD-2-Clause": r"(?i)Redistributions in binary form must reproduce",
    "Apache-2.0": r"Apache",
    "LGPL-3.0-or-later": r"(?i)LGPL-3|Lesser\s+General\s+Public\s+License",
    "GPL-2.0-or-later": r"GPL-2\+|GPL-2",
    "LGPL-2.1-only": r"LGPL-2\.1",
    "libpng-2.0": r"(?i)libpng",
    "IJG": r"(?i)Independent JPEG Group|IJG",
    "MIT": r"(?i)X11|Expat|MIT|Permission is hereby granted, free of charge",
}


def answer(*command, **kwargs):
    return subprocess.run(command, check=True, capture_output=True, text=True, **kwargs).stdout


def noticed():
    """Licences by library, as NOTICE lists them."""
    table = (SOURCE / "NOTICE").read_text().split("versions.\n\n")[1]
    return dict(re.split(r"\s{2,}", line) for line in table.strip().split("\n"))


def asked_for():
    """Sonames by library that any program asks for, without the run-time libraries."""
    names = {name for program in PROGRAMS for name in re.findall(r"\(NEEDED\).*\[(.+)\]", answer("readelf", "-d", program))}
    return {name.split(".so")[0]: name for name in names if not RUN_TIME.match(name)}


@functools.lru_cache(maxsize=None)
def paths():
    found = {}
    for program in PROGRAMS:
        found.update(re.findall(r"^\s*(\S+) => (/\S+)", answer("ldd", program), re.M))
    return found


@functools.lru_cache(maxsize=None)
def lists():
    """Files of each installed package, as dpkg keeps them."""
    return {path.stem.split(":")[0]: set(path.read_text().split("\n"))
            for path in pathlib.Path("/var/lib/dpkg/info").glob("*.list")}


@functools.lru_cache(maxsize=None)
def package_of(path):
    names = {path, os.path.realpath(path), os.path.realpath(path).replace("/usr/lib", "/lib", 1)}
    return next(package for package, files in lists().items() if names & files)


class SupplyChainTest(unittest.TestCase):
    def test_notice_names_each_library_and_no_other(self):
        self.assertEqual(sorted(noticed()), sorted(asked_for()))

    def test_each_library_is_under_the_licence_that_notice_says(self):
        places = paths()
        for library, soname in asked_for().items():
            terms = pathlib.Path("/usr/share/doc", package_of(places[soname]), "copyright").read_text(errors="replace")
            for licence in noticed()[library].split(" OR "):
                with self.subTest(library=library, licence=licence):
                    self.assertRegex(terms, WORDS[licence])

    def test_no_program_but_that_with_cgal_asks_for_gpl(self):
        strong = re.compile(r"^(A?GPL)")
        for library, licence in noticed().items():
            self.assertFalse(all(strong.match(one) for one in licence.split(" OR ")), library)


class BillOfMaterialsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = answer(sys.executable, "-B", SOURCE / "scripts/sbom.py", BUILD / "bin")
        cls.bill = json.loads(cls.text)

    def test_says_what_spdx_asks_for(self):
        for key in ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo"):
            self.assertIn(key, self.bill)
        self.assertRegex(self.bill["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        elements = [entry["SPDXID"] for entry in self.bill["packages"] + self.bill["files"]] + [self.bill["SPDXID"]]
        self.assertEqual(len(elements), len(set(elements)))
        for element in elements:
            self.assertRegex(element, r"^SPDXRef-[A-Za-z0-9.-]+$")
        for relation in self.bill["relationships"]:
            self.assertIn(relation["spdxElementId"], elements)
            self.assertIn(relation["relatedSpdxElement"], elements)

    def test_names_each_program_with_its_hash(self):
        told = {entry["fileName"]: entry["checksums"][1]["checksumValue"] for entry in self.bill["files"]}
        summed = {"./bin/" + program.name: answer("sha256sum", program).split()[0] for program in PROGRAMS}
        self.assertEqual(told, summed)

    def test_names_each_package_that_is_loaded_with_its_version(self):
        contained = {relation["relatedSpdxElement"] for relation in self.bill["relationships"]
                     if relation["relationshipType"] == "STATIC_LINK"}
        told = {entry["name"]: entry["versionInfo"] for entry in self.bill["packages"] if entry["SPDXID"] not in contained}
        loaded = {package_of(path) for path in paths().values()}
        self.assertEqual(set(told), loaded)
        status = pathlib.Path("/var/lib/dpkg/status").read_text()
        for package in loaded:
            versions = re.findall(rf"^Package: {re.escape(package)}\n(?:\S.*\n|\s.*\n)*?Version: (.+)$", status, re.M)
            self.assertIn(told[package], versions)

    def test_names_what_a_program_contains_without_loading_it(self):
        told = {(relation["spdxElementId"], relation["relatedSpdxElement"]) for relation in self.bill["relationships"]
                if relation["relationshipType"] == "STATIC_LINK"}
        # the library writes this into every file
        containing = {program.name for program in PROGRAMS if b"HDF5 library version" in program.read_bytes()}
        self.assertEqual(told, {(f"SPDXRef-File-{name}", f"SPDXRef-Package-{package}") for name in containing
                                for package in ("libhdf5-dev", "libaec-dev")})
        self.assertEqual(containing, {"doorforge-datagen"})

    def test_is_the_same_again(self):
        self.assertEqual(self.text, answer(sys.executable, "-B", SOURCE / "scripts/sbom.py", BUILD / "bin"))

    def test_a_folder_without_programs_is_refused(self):
        done = subprocess.run([sys.executable, "-B", SOURCE / "scripts/sbom.py", SOURCE / "docs"], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("build first", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
