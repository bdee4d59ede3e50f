#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# The wheel in fresh virtual environments, with programs of others from PyPI; not a part of ./test.sh, which has Debian's
# packages alone:
#   tests/python/judges.sh BUILD PYTHON...
# BUILD is a build folder with the programs; each PYTHON (3.11 or later) gets a wheel of the last commit built in a fresh
# clone, installed and tried: the package's tests, Gymnasium's checker, examples, README's journeys, the notebook, openpi's
# client and server. For the first PYTHON (3.11, where PyBullet is to be had), JUDGES=full also trains with Stable-Baselines3, and
# tries the latch in other simulators and the loader against WebDataset (several GB of downloads). JUDGES_WHEELS is a folder that keeps
# the wheels; one that lies there is not built again. What the wheels of several PYTHONs share is compiled once with
#   CXX=/usr/lib/ccache/c++ WHEEL_OPTIONS="-C cmake.define.CMAKE_DISABLE_PRECOMPILE_HEADERS=ON"
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd); shift
scratch=$(mktemp -d -p "${JUDGES_SCRATCH:-/tmp}")
trap 'rm -rf "$scratch"' EXIT
export PATH="$build/bin:$PATH" PYTHONNOUSERSITE=1
unset PYTHONPATH
tests="$root/tests/python"
TIMEFORMAT='%R s by the clock, %U s + %S s of the processor'

# A wheel of the last commit for an interpreter; prints its path.
build_wheel() {
  local python=$1 environment=$2 wheels=${JUDGES_WHEELS:-$scratch/wheels} tag
  tag=$("$python" -c 'import sys; print(f"cp{sys.version_info[0]}{sys.version_info[1]}")')
  if ! ls "$wheels"/doorforge-*-"$tag"-*.whl 2> /dev/null; then
    # shellcheck disable=SC2086
    time "$environment/bin/pip" wheel -q "$scratch/clone" --no-deps -w "$wheels" ${WHEEL_OPTIONS:-} >&2
    ls "$wheels"/doorforge-*-"$tag"-*.whl
  fi
}

# A library that is really gone is named with the package that brings it.
hide_a_library() {
  local library; library=$(ldconfig -p | sed -n 's/.*libembree3.so.3 .* => //p')
  # shellcheck disable=SC2016
  unshare -rm bash -c 'mount --bind /dev/null "$(readlink -f "$0")" && "$1" -c "import doorforge" 2>&1' "$library" "$1/bin/python" |
    grep -q "apt-get install libembree3-3"
}

try_wheel() {
  local environment=$1
  "$environment/bin/python" "$tests/package_test.py" "$build"
  "$environment/bin/python" "$tests/environment_test.py"
  "$environment/bin/python" "$root/docs/examples/callable_policy.py" "$scratch/door"
  "$environment/bin/python" "$tests/run_notebook.py" "$root/docs/examples/doors.ipynb"
  "$environment/bin/python" -m mypy --ignore-missing-imports -p doorforge
  # classes of pybind11 have a metaclass and no signatures; export() is added in Python; names of types are the stub's own
  "$environment/bin/python" -m mypy.stubtest doorforge._core --concise --allowlist \
    <(printf 'doorforge\\._core\\.%s\n' '[A-Z]\w*(\.__init__)?' 'Door\.export')
  hide_a_library "$environment"
}

# openpi's client wants a numpy before 2, which Python 3.13 has no wheels of
try_openpi() {
  local python=$1 environment=$2
  "$python" -m venv "$environment"
  if ! "$environment/bin/pip" install -q --only-binary :all: openpi-client==0.1.2 openpi-server==0.1.0 \
      policy-websocket==0.1.0 typing_extensions; then
    echo "openpi's client cannot be installed for this Python; left out"
    return
  fi
  "$environment/bin/python" "$tests/openpi_judge.py" "$build/bin" "$root/data/policies/opener" "$scratch/door"
}

# Several GB, once.
try_heavy_peers() {
  local environment=$1
  "$environment/bin/pip" install -q stable-baselines3==2.9.2 torch==2.15.0 webdataset==1.0.2 mujoco==4.0.0 pybullet==3.2.7 \
    sapien==3.0.3 newton==1.8.0 mujoco-warp==4.0.0 trimesh==5.2.0 genesis-world==1.4.5
  "$environment/bin/python" "$root/docs/examples/ppo_door.py" --least-opened 6
  "$environment/bin/python" "$tests/readme_test.py" "$build"
  for latch in effort bolt; do
    doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --set "latch=$latch" --out "$scratch/$latch"
    doorforge export "$scratch/$latch" --to urdf --latch data --out "$scratch/exported_$latch"
  done
  "$environment/bin/python" -W ignore "$tests/latch_judge.py" "$root/docs/latch-elsewhere.md" "$scratch/effort" \
    "$scratch"/exported_effort/* --bolt "$scratch/bolt" "$scratch"/exported_bolt/*
  doorforge datagen open --doors "$scratch/effort" --out "$scratch/data" --episodes 48
  "$environment/bin/python" "$root/scripts/python_bench.py" --data "$scratch/data"
}

git clone -q "$root" "$scratch/clone"
doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out "$scratch/door"
first=yes
for python in "$@"; do
  echo "== $("$python" --version)"
  environment="$scratch/$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')"
  "$python" -m venv "$environment"
  wheel=$(build_wheel "$python" "$environment")
  du -h "$wheel"
  [ "$(stat -c %s "$wheel")" -lt 60000000 ]
  "$environment/bin/pip" install -q "$wheel[gymnasium]" mypy nbclient nbformat ipykernel matplotlib
  cd "$scratch"
  try_wheel "$environment"
  try_openpi "$python" "$environment-openpi"
  if [ "${JUDGES:-}" = full ] && [ "$first" = yes ]; then try_heavy_peers "$environment"; fi
  first=no
done
echo "all judges passed"
