# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""`doorforge validate` beside usd-core on stages that are sound, exported and damaged in many ways.

    foreign_judge.py BUILD FOLDER

What usd-core refuses, doorforge names, in all but one of a hundred: it asks for no line break between two entries, as usd-core does. FOLDER is for the stages, and holds exports."""
import json
import pathlib
import random
import subprocess
import sys

from pxr import Tf, Usd

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "programs"))
import foreign_samples as samples  # noqa: E402

CHANGES = ["", "(", ")", "{", "}", "[", "]", '"', "<", ">", "=", ",", "def", "rel", "float", "token", "nan", "-1", "1e400", "é", "\n", "#", "\0"]


def opens(path: pathlib.Path) -> bool:
    try:
        return bool(Usd.Stage.Open(str(path)))
    except (Tf.ErrorException, RuntimeError):
        return False


def damaged(text: str, random_: random.Random) -> str:
    at = random_.randrange(len(text))
    return text[:at] + random_.choice(CHANGES) + text[at + random_.randrange(4):]


def main() -> int:
    build, folder = map(pathlib.Path, sys.argv[1:])
    random_ = random.Random(1)
    stages = sorted(folder.glob("exported/*/model.usda"))
    for i in range(600):
        path = folder / f"damaged_{i}.usda"
        path.write_text(damaged(samples.USDA, random_))
        stages.append(path)
    (folder / "sound.usda").write_text(samples.USDA)
    stages.append(folder / "sound.usda")
    report = json.loads(subprocess.run([build / "bin/doorforge", "validate", *stages, "--format", "json"], capture_output=True, text=True, check=False).stdout)
    verdicts = {item["path"]: item for item in report["items"]}
    counts, faults = {}, []
    for path in stages:
        ours = verdicts[str(path)]["errors"] == 0
        theirs = opens(path)
        counts[ours, theirs] = counts.get((ours, theirs), 0) + 1
        if ours and not theirs:
            faults.append(path)
    print(f"usd-core {'.'.join(map(str, Usd.GetVersion()))}: {len(stages)} stages; both take {counts.get((True, True), 0)}, both refuse "
          f"{counts.get((False, False), 0)}, only doorforge names a fault of {counts.get((False, True), 0)}, only usd-core refuses {len(faults)}")
    for path in faults:
        print(f"  {path}: usd-core refuses it, doorforge finds {[f['code'] for f in verdicts[str(path)]['findings']]}")
    return 1 if len(faults) > len(stages) / 100 else 0


sys.exit(main())
