#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Writes what the programs of a build consist of, as SPDX 2.3 JSON (ISO/IEC 5962).

    scripts/sbom.py build/release/bin > doorforge.spdx.json

Each program is a file with its SHA-256; each Debian package whose shared libraries the dynamic loader
gives a program, or whose static library it contains, is a package with its version. Needs ldd and dpkg-query. The same build on the
same machine gives the same bytes; SOURCE_DATE_EPOCH is the time that it names (0: 1970).
"""
import argparse
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys


CONTAINED = {"doorforge-datagen": ("libhdf5-dev", "libaec-dev")}  # what CMake links statically, by Debian's package


def answer(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def loaded(program):
    """Paths of all shared libraries that the loader gives it, by soname."""
    return dict(re.findall(r"^\s*(\S+) => (/\S+)", answer("ldd", program), re.M))


def names_of(path):
    """As packages may list it: /lib is a link to /usr/lib today, and was a folder."""
    real = os.path.realpath(path)
    return list(dict.fromkeys([path, real, real.replace("/usr/lib", "/lib", 1)]))


def packages_of(paths):
    """(name, version, source) of the Debian package that brought each file, by path."""
    wanted = sorted({name for path in paths for name in names_of(path)})
    # exit code 1: some are known by another of their names
    listed = subprocess.run(["dpkg-query", "-S", *wanted], capture_output=True, text=True).stdout
    owner = {path: owners.split(",")[0] for owners, path in re.findall(r"^(.+?): (/.+)$", listed, re.M)}
    brought = {path: next((owner[name] for name in names_of(path) if name in owner), None) for path in paths}
    missing = [path for path, package in brought.items() if package is None]
    if missing:
        raise SystemExit(f"{missing[0]}: no Debian package brought it")
    known = sorted(set(brought.values()))
    told = answer("dpkg-query", "-W", "-f", "${Package}\t${Version}\t${source:Package}\n", *known)
    by_name = {line.split("\t")[0]: tuple(line.split("\t")) for line in told.splitlines()}
    return {path: by_name[package.split(":")[0]] for path, package in brought.items()}


def contained_in(program):
    """(name, version, source) of the Debian packages whose static libraries a program contains."""
    names = CONTAINED.get(program.name, ())
    told = answer("dpkg-query", "-W", "-f", "${Package}\t${Version}\t${source:Package}\n", *names) if names else ""
    return [tuple(line.split("\t")) for line in told.splitlines()]


def programs_in(folder):
    return sorted(path for path in pathlib.Path(folder).iterdir()
                  if re.fullmatch(r"doorforge(-[a-z-]+)?", path.name) and os.access(path, os.X_OK))


def identifier(*words):
    return "SPDXRef-" + "-".join(re.sub(r"[^A-Za-z0-9.]", "-", word) for word in words)


def package_entry(name, version, source):
    return {"SPDXID": identifier("Package", name), "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "supplier": "Organization: Debian",
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
            "comment": f"terms: /usr/share/doc/{name}/copyright; source package {source}",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{version}"}]}


def file_entry(program):
    is_gpl = program.name == "doorforge-assets"  # it contains CGAL, see NOTICE
    content = program.read_bytes()
    return {"SPDXID": identifier("File", program.name), "fileName": "./bin/" + program.name,
            "checksums": [{"algorithm": name, "checksumValue": hashlib.new(name, content).hexdigest()}
                          for name in ("SHA1", "SHA256")],
            "licenseConcluded": "GPL-3.0-or-later" if is_gpl else "Apache-2.0",
            "licenseInfoInFiles": ["NOASSERTION"], "copyrightText": "2026 The doorforge authors"}


def bill_of(folder):
    programs = programs_in(folder)
    if not programs:
        raise SystemExit(f"{folder}: no program of doorforge; build first")
    files = [file_entry(program) for program in programs]
    packages, relations = {}, []
    libraries = [loaded(program) for program in programs]
    brought = packages_of({path for found in libraries for path in found.values()})
    for entry, found in zip(files, libraries):
        for library in sorted({brought[path] for path in found.values()}):
            packages[library] = package_entry(*library)
            relations.append({"spdxElementId": entry["SPDXID"], "relationshipType": "DYNAMIC_LINK",
                              "relatedSpdxElement": packages[library]["SPDXID"]})
    for entry, program in zip(files, programs):
        for library in contained_in(program):
            packages[library] = package_entry(*library)
            relations.append({"spdxElementId": entry["SPDXID"], "relationshipType": "STATIC_LINK",
                              "relatedSpdxElement": packages[library]["SPDXID"]})
    version = answer(programs[0], "--version").split()[-1]
    digest = hashlib.sha256(json.dumps([files, sorted(packages)]).encode()).hexdigest()
    created = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), datetime.timezone.utc)
    described = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                  "relatedSpdxElement": entry["SPDXID"]} for entry in files]
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": f"doorforge-{version}", "documentNamespace": f"urn:sha256:{digest}",
            "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: doorforge-sbom"]},
            "packages": [packages[library] for library in sorted(packages)], "files": files,
            "relationships": described + relations}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where the programs of the build lie, such as build/release/bin")
    json.dump(bill_of(parser.parse_args().folder), sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
