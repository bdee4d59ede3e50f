# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Damages real URDF in some hundred ways each and asks whether `doorforge validate` finds each by its rule at its line:
python3 judge_foreign.py BUILD FOLDER [COUNT]. FOLDER holds the objects of others; files are written beside them and removed."""
import collections
import json
import pathlib
import re
import shutil
import sys

import foreign_damage_test as damage
import foreign_samples as samples
from programs import run

HOUSE = "judge_meshes/"  # where the meshes of what is added lie

# In place: a pattern, what stands there instead, the rule. Asked where the object has such a thing.
IN_PLACE = [
    (r"</robot>\s*$", "", "FIL002"), (r"<link name=", "<link name='twice' name=", "FIL002"), (r"<robot", "<!DOCTYPE a><robot", "FIL004"),
    (r'xyz="[^"]+"', 'xyz="0 zero 0"', "FIL006"), (r'xyz="[^"]+"', 'xyz="0 0"', "FIL006"), (r'rpy="[^"]+"', 'rpy="0 nan 0"', "FIL006"),
    (r'<child link="[^"]+"', "<child", "FIL007"), (r'type="(revolute|fixed|prismatic|continuous)"', 'type="hinged"', "FIL008"),
    (r"<parent link=\"[^\"]+\"", '<parent link="no such link"', "TRE004"), (r'<child link="[^"]+"', '<child link="no such link"', "TRE004"),
    (r'lower="[^"]*" upper="[^"]*"', 'lower="2" upper="1"', "JNT004"), (r'filename="[^"]+"', 'filename="no such mesh.obj"', "GEO001"),
    (r'filename="[^"]+"', 'filename="/etc/passwd"', "GEO002"), (r'filename="[^"]+"', 'filename="../../../../../../../../x.obj"', "GEO002"),
    (r'mass value="[^"]+"', 'mass value="-1"', "INR001"), (r'size="[^"]+"', 'size="1 -1 1"', "GEO015"),
    (r"\bfilename=", "filenam=", "FIL009"), (r'xyz="[^"]+"', 'xyz="${x}"', "FIL010"), (r'<link name="[^"]+"', '<link name=""', "TRE001"),
    (r"<link name=", "<link nam=", "FIL007"), (r'upper="[^"]*"', 'upper="1e400"', "FIL006"), (r'\beffort="[^"]*"', 'effort="-1"', "JNT007"),
    (r'\bvelocity="[^"]*"', 'velocity="-1"', "JNT007"), (r'effort="[^"]*"', 'effort="strong"', "FIL006"), (r'ixx="[^"]*"', 'ixx="-5"', "INR002"),
    (r'izz="[^"]*"', "", "FIL007"), (r'radius="[^"]*"', 'radius="-1"', "GEO015"), (r'length="[^"]*"', 'length="0"', "GEO015"),
    (r'filename="[^"]+"', 'filename=""', "GEO001"), (r'filename="[^"]+"', 'filename="http://x.invalid/y.obj"', "GEO002"),
    (r'filename="[^"]+"', 'filename="package://no such package/y.obj"', "GEO003"), (r'rgba="[^"]+"', 'rgba="1 1 1"', "FIL006"),
    (r'scale="[^"]+"', 'scale="0 1 1"', "GEO006"), (r'<robot name="[^"]*"', "<robot", "FIL007"), (r"<robot", "<roboter", "FIL002"),
    (r"<origin", "<origin &amp", "FIL002"), (r'"', "", "FIL002"), (r"<link", "\x01<link", "FIL002"),
]


def with_gate(text: str, root: str) -> str:
    """The object with the sound gate of the tests on its root link, on lines of its own."""
    inner = samples.URDF[samples.URDF.index("  <link name=\"post\">"):samples.URDF.index("</robot>")]
    inner = inner.replace("meshes/", HOUSE).replace('<material name="oak"/>', '<material name="oak"><color rgba="1 1 1 1"/></material>')
    joint = f'  <joint name="judge" type="fixed"><parent link="{root}"/><child link="post"/></joint>\n'
    at = text.rindex("</robot>")
    return text[:at].rstrip() + "\n" + inner + joint + text[at:]


def root_of(text: str) -> str | None:
    links = re.findall(r'<link\s+name="([^"]+)"', text)
    children = set(re.findall(r'<child\s+link="([^"]+)"', text))
    roots = [link for link in links if link not in children]
    return roots[0] if len(roots) == 1 else None


def codes(item: dict) -> collections.Counter:
    return collections.Counter((finding["code"], finding.get("line"), finding["measured"]) for finding in item["findings"])


def damages_of(text: str, gate: str):
    """Name, damaged text, rule, line (or None)."""
    moving = re.search(r'type="(revolute|prismatic)"', text)
    for pattern, new, code in IN_PLACE:
        # limits of a fixed joint mean nothing, whatever they are
        begin = moving.start() if moving and code == "JNT004" else 0
        if match := re.compile(pattern).search(text, begin):
            changed = text[:match.start()] + new + text[match.end():]
            line = None if code in ("FIL002",) else changed[:match.start()].count("\n") + 1
            yield f"{pattern} -> {new}", changed, code, line
    for kind, old, new, code, *more in damage.REPLACED:
        also = more[1] if len(more) > 1 else None
        old, new = old.replace("meshes/", HOUSE), new.replace("meshes/", HOUSE)
        # what rests on the gate standing alone, or on a narrower root
        other = code in ("FIL005", "GEO016", "GEO004", "TRE012", "MEC002", "MEC003", "MEC009", "HND003", "HND009")
        if kind != "urdf" or gate.count(old) == 0 or other or new.startswith(".."):
            continue
        if also and also[0] not in gate:
            continue
        at = gate.rindex(old) if old in ("</robot>", "</link>") else gate.index(old, gate.index('<link name="post">') if old in
                                                                                gate[gate.index('<link name="post">'):] else 0)
        changed = gate[:at] + new + gate[at + len(old):]
        if also:
            changed = changed.replace(also[0], also[1], 1)
        yield f"{old!r} -> {new!r}", changed, code, None


def main(folder: pathlib.Path, count: int) -> int:
    chosen = []
    for path in sorted(folder.rglob("*.urdf"), key=lambda one: (one.stat().st_size, str(one))):
        text = path.read_text(errors="replace")
        if (root := root_of(text)) and "<joint" in text and text.rstrip().endswith("</robot>") and not path.name.startswith(".judge"):
            chosen.append((path, text, root))
    chosen = chosen[:: max(1, len(chosen) // count)][:count]
    missed, found, kinds = [], 0, set()
    for path, text, root in chosen:
        house = path.parent / HOUSE
        house.mkdir(exist_ok=True)
        damage.ForeignDamage.folder = house
        placed = damage.ForeignDamage().place("sound", "unused", "")
        for mesh in (placed.parent / "meshes").iterdir():
            shutil.copy(mesh, house)
        gate = with_gate(text, root)
        cases = [("sound", gate, "", None), *damages_of(text, gate)]
        files = [path.parent / f".judge-{number}.urdf" for number in range(len(cases))]
        for file, (_, changed, _, _) in zip(files, cases):
            file.write_text(changed)
        result = run("validate", *files, "--format", "json", "--ask", "none", "--root", folder)
        for file in files:
            file.unlink()
        shutil.rmtree(house)
        if result.returncode not in (0, 1):
            missed.append(f"{path}: exit code {result.returncode}: {result.stderr[-200:]}")
            continue
        items = json.loads(result.stdout)["items"]
        before = {code for code, _, _ in codes(items[0])}
        counted = collections.Counter(finding["code"] for finding in items[0]["findings"])
        for (name, _, code, line), item in list(zip(cases, items))[1:]:
            kinds.add(name)
            now = collections.Counter(finding["code"] for finding in item["findings"])
            lines = {finding.get("line") for finding in item["findings"] if finding["code"] == code}
            if now[code] > (counted[code] if code in before else 0) or (line in lines and line is not None):
                found += 1
            else:
                missed.append(f"{path}: {name}: not found by {code}: {dict(now - counted)}")
    print("\n".join(missed))
    print(f"{len(chosen)} objects, {len(kinds)} kinds of damage, {found} found, {len(missed)} missed")
    return bool(missed)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) > 2 else 20))
