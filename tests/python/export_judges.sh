#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Exports before programs of others from PyPI, and glTF's own validator from npm where node is; not a part of ./test.sh,
# which has Debian's packages alone:
#   tests/python/export_judges.sh BUILD PYTHON [DOORS]
# BUILD is a build folder with the programs, PYTHON 3.11, which all engines have wheels for; DOORS a folder of composed
# doors, else three of the catalogue. Prints the table of docs/conformance.md; fails where a door does not load, hold or open.
# shellcheck source=tests/python/judge_setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/judge_setup.sh" "$1" "$2" \
  mujoco pybullet sapien drake newton mujoco-warp newton-usd-schemas usd-core trimesh scipy
doors=${3:-$scratch/doors}
if [ $# -lt 3 ]; then
  doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out "$doors/a"
  doorforge compose --body safe_box_tall_03 --handle safe_tee_04 --set latch=bolt --out "$doors/b"
  doorforge compose --body refrigerator_plain_01 --handle refrigerator_latch_01 --set hinge_side=right --out "$doors/c"
fi

doorforge export "$doors" --format usda,glb --out "$scratch/exported"
"$venv/bin/python" "$root/tests/python/usd_judge.py" "$scratch"/exported/*/model.usda
if command -v npm >/dev/null; then
  (cd "$scratch" && npm install --silent --no-audit --no-fund gltf-validator@2.0.0-dev.3.10)
  for glb in "$scratch"/exported/*/model.glb; do
    (cd "$scratch" && node -e '
      const { readFileSync } = require("fs");
      require("gltf-validator").validateBytes(new Uint8Array(readFileSync(process.argv[1]))).then((report) => {
        const { numErrors, numWarnings } = report.issues;
        console.log(process.argv[1].split("/").at(-2), "glTF-Validator:", numErrors, "errors,", numWarnings, "warnings");
        process.exit(numErrors + numWarnings ? 1 : 0);
      });' "$glb")
  done
else
  echo "npm is not there; glTF-Validator left out"
fi
doorforge conformance "$doors" --python "$venv/bin/python" --out "$scratch/judged" --format markdown 2>/dev/null
