# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""The viewer in data/view was made of the sources in web/: it says so in its first line, by their hash."""
import hashlib
import pathlib
import re
import sys

MOST_BYTES = 700_000


def hash_of_sources(web: pathlib.Path) -> str:
    names = ["build.mjs", "package.json", "package-lock.json", *sorted(f"src/{path.name}" for path in (web / "src").iterdir())]
    digest = hashlib.sha256()
    for name in names:
        digest.update(name.encode() + b"\n" + (web / name).read_bytes() + b"\n")
    return digest.hexdigest()


def main(root: pathlib.Path) -> int:
    viewer, licence = root / "data/view/viewer.js", root / "data/view/three.LICENSE.txt"
    told = re.search(r"[0-9a-f]{64}", viewer.read_text().partition("\n")[0])
    faults = []
    if told is None or told[0] != hash_of_sources(root / "web"):
        faults.append("data/view/viewer.js is not of the sources in web/: run `npm ci && npm run build` there")
    if viewer.stat().st_size > MOST_BYTES:
        faults.append(f"{viewer}: {viewer.stat().st_size} bytes, more than {MOST_BYTES}")
    if "three.js authors" not in licence.read_text():
        faults.append(f"{licence} is not the licence of three.js")
    if re.search(r"https?://(?!www\.w3\.org/|jcgt\.org/|github\.com/)", viewer.read_text()):
        faults.append("the viewer names an address")
    print("\n".join(faults) or "viewer ok")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
