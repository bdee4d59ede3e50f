#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Exports to LeRobot before LeRobot itself, from PyPI; not a part of ./test.sh, which has Debian's packages alone:
#   tests/python/lerobot_judge.sh BUILD PYTHON [VENV]
# BUILD is a build folder with the programs; PYTHON is 3.12 or later, which LeRobot wants; VENV a virtual environment that is made
# if it is not there and kept (some GB; without it a new one is made and removed). Collects episodes with pictures at two stages,
# exports them in every form, compares every value, kills exports, and lets LeRobot's own program train its diffusion policy.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
PATH="$(cd "$1" && pwd)/bin:$PATH"
export PATH PYTHONDONTWRITEBYTECODE=1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# nothing may be fetched from a hub, nor be kept of what is here
export HF_HUB_OFFLINE=1 HF_HOME="$scratch/hf" HF_LEROBOT_HOME="$scratch/hf_lerobot" WANDB_MODE=disabled

venv=${3:-$scratch/venv}
if [ ! -x "$venv/bin/lerobot-train" ]; then
  "$2" -m venv "$venv"
  HF_HUB_OFFLINE=0 "$venv/bin/pip" install -q "lerobot[dataset,diffusion,training]==0.6.1"
  # it wants the system's FFmpeg; LeRobot reads by PyAV without it
  "$venv/bin/pip" uninstall -q -y torchcodec
fi
python=$venv/bin/python
judge=$root/tests/python/lerobot_judge.py
cd "$scratch"

echo "== episodes with pictures and colours"
doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out doors/a
doorforge compose --body interior_framed_01 --handle interior_lever_tube_02 --out doors/b
doorforge compose --body safe_box_tall_03 --handle safe_tee_04 --out doors/c
# shellcheck disable=SC2054
collect=(--doors doors --seed 3 --set collection.episodes_per_shard=4 --set collection.val_fraction=0.5
  --set scene.appearance=full --set pictures.cloud_rgb=true
  --set "pictures.cameras=[{name: front, width: 96, height: 96}, {name: wrist, at: hand, width: 64, height: 48}]"
  --set "pictures.streams=[rgb, depth]")
doorforge datagen open "${collect[@]}" --out data --episodes 9
doorforge datagen handle "${collect[@]}" --out data_handle --episodes 4

echo "== v3.0, pictures in the tables"
doorforge dataset export data --to lerobot --python "$python" --depth --points 512 --out lerobot
"$python" "$judge" values data lerobot
doorforge dataset export data_handle --to lerobot --python "$python" --stage handle --json --out lerobot_handle
"$python" "$judge" values data_handle lerobot_handle handle

echo "== v3.0, video"
doorforge dataset export data --to lerobot --python "$python" --images video --out lerobot_video
"$python" "$judge" video data lerobot_video

echo "== killed"
mkdir killed
"$python" "$judge" killed data killed

echo "== v2.1"
doorforge dataset export data --to lerobot --python "$python" --codebase-version v2.1 --images video --out v21_video
"$python" -c 'import json; print(json.load(open("v21_video/meta/modality.json"))["video"])'
doorforge dataset export data --to lerobot --python "$python" --codebase-version v2.1 --out v21
"$python" "$judge" converted data v21

echo "== LeRobot trains its diffusion policy"
doorforge dataset export data --to lerobot --python "$python" --cameras front --points 0 --out lerobot_front
"$venv/bin/lerobot-train" --dataset.repo_id=local/doors --dataset.root="$scratch/lerobot_front" --policy.type=diffusion \
  --policy.device=cpu --policy.push_to_hub=false --wandb.enable=false --output_dir="$scratch/trained" --steps=4 --batch_size=2 \
  --num_workers=0 --log_freq=2 --save_freq=4 --policy.crop_shape='[84, 84]' --policy.down_dims='[32, 64, 128]' \
  --policy.num_train_timesteps=10 --policy.pretrained_backbone_weights=null 2>&1 | tee train.log | grep -E "loss|Effective|episodes" || true
ls trained/checkpoints/*/pretrained_model/model.safetensors
grep -q "loss:" train.log
echo "all judges of LeRobot passed"
