#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# USD of `doorforge export --profile isaac` before SimReady's own validator from PyPI; not a part of ./test.sh, which has Debian's
# packages alone:
#   tests/python/simready_judge.sh BUILD PYTHON [DOORS]
# BUILD is a build folder with the programs, PYTHON one that simready-validate has wheels for (3.12); DOORS a folder of composed doors,
# else five that tests/python/draw_doors.py draws, one a mechanism. Fails where a door does not keep the profile.
# shellcheck source=tests/python/judge_setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/judge_setup.sh" "$1" "$2" simready-validate simready-foundation-tier-core==2026.8.0
doors=${3:-$scratch/doors}
[ $# -ge 3 ] || "$python" "$root/tests/python/draw_doors.py" doorforge "$doors" 5
# The rule NP.005 wants a file in a folder of any name, in one whose name the file's name has: model/ID/model.usda.
doorforge export --profile isaac "$doors" --out "$scratch/model"
ls "$scratch"/model/*/model.usda > "$scratch/assets"
"$venv/bin/simready-validate" --profile Robotics-Prop --version 4.0.0 --asset_list "$scratch/assets" --output "$scratch/answer.json"
