#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# The wheel in fresh virtual environments, with programs of others from PyPI; not a part of ./test.sh, which has Debian's
# packages alone:
#   tests/python/judges.sh BUILD PYTHON...
# BUILD is a build folder with the programs; each PYTHON (3.11 or later) gets a wheel built, installed and tried. Options
# of the build, such as a compiler's launcher, may be given in WHEEL_OPTIONS; JUDGES=full also trains with
# Stable-Baselines3 and PyTorch, for the first PYTHON.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd); shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PATH="$build/bin:$PATH"
export PYTHONNOUSERSITE=1

for python in "$@"; do
  echo "== $("$python" --version)"
  environment="$scratch/$(basename "$(dirname "$(dirname "$python")")")"
  "$python" -m venv "$environment"
  # shellcheck disable=SC2086
  "$environment/bin/pip" wheel -q "$root" --no-deps -w "$scratch/wheels" ${WHEEL_OPTIONS:-}
  tag=$("$python" -c 'import sys; print(f"cp{sys.version_info[0]}{sys.version_info[1]}")')
  wheel=$(ls "$scratch"/wheels/doorforge-*-"$tag"-*.whl)
  du -h "$wheel"
  "$environment/bin/pip" install -q "$wheel[gymnasium]" mypy
  cd "$scratch"
  "$environment/bin/python" "$root/tests/python/package_test.py" "$build"
  "$environment/bin/python" "$root/tests/python/environment_test.py"
  # openpi's client wants a numpy before 2, which Python 3.13 has no wheels of
  if "$python" -m venv "$environment-openpi" && "$environment-openpi/bin/pip" install -q --only-binary :all: openpi-client; then
    "$environment-openpi/bin/python" "$root/tests/python/openpi_judge.py" "$build/bin" "$root/data/policies/opener"
  else
    echo "openpi's client cannot be installed for this Python; left out"
  fi
  "$environment/bin/python" -m mypy --ignore-missing-imports -p doorforge || echo "mypy has remarks"
  if [ "${JUDGES:-}" = full ] && [ "$python" = "$1" ]; then  # several GB of PyTorch
    "$environment/bin/pip" install -q stable-baselines3 torch
    "$environment/bin/python" "$root/docs/examples/ppo_door.py" --steps 1024
  fi
done
