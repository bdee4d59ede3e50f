#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Pictures of collected episodes before MuJoCo's renderer, three.js in headless Chromium and trimesh's rays; not a part of
# ./test.sh, which has Debian's packages alone:
#   tests/python/silhouette_judges.sh BUILD PYTHON [EPISODES]
# BUILD is a build folder with the programs, PYTHON 3.11 or later; EPISODES (6) are shared by six doors, one of each category.
# Where npm is not there, three.js is left out. Fails where silhouettes overlap by 0.98 or less (intersection over union), or a
# ray finds another link, label or depth.
# shellcheck source=tests/python/judge_setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/judge_setup.sh" "$1" "$2" mujoco trimesh rtree yourdfpy "websockets<14"
cd "$scratch"
doorforge compose --body interior_arched_01 --handle interior_lever_blade_01 --out doors/a
doorforge compose --body window_arched_01 --handle window_cockspur_05 --out doors/b
doorforge compose --body car_box_01 --handle car_flap_01 --out doors/c
doorforge compose --body safe_box_tall_03 --handle safe_tee_05 --out doors/d
doorforge compose --body storage_bowed_desk_03 --handle storage_pull_bridge_01 --out doors/e
doorforge compose --body refrigerator_arched_01 --handle refrigerator_latch_01 --out doors/f
doorforge export doors --format mjcf,glb,urdf --out exported
doorforge datagen open --doors doors --out data --episodes "${3:-6}" --seed 3 --set collection.val_fraction=0 \
  --set pictures.cameras='[{name: front}, {name: side, position_m: [1.6, 1.3, 1.5], target_m: [0, 0.1, 0.9]}]' \
  --set pictures.streams='[depth32, link, label]'
modules=()
if command -v npm >/dev/null; then
  npm install --silent --no-audit --no-fund three@0.187 urdf-loader@0.13.1
  modules=("$scratch/node_modules")
else
  echo "npm is not there; three.js left out"
fi
"$venv/bin/python" "$root/tests/python/silhouette_judge.py" data exported \
  "$root/data/robots/mobile_franka/mobile_franka.urdf" "${modules[@]}" 2> >(grep -v "Geom with duplicate name" >&2)
