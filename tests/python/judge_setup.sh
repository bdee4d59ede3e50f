# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Sourced by the scripts beside it that show exports to programs of others from PyPI:
#   . judge_setup.sh BUILD PYTHON PACKAGE...
# Puts the programs of BUILD first in PATH and installs the packages for PYTHON. Sets root, the repository; build and python, as given; scratch, a
# folder that goes with the script; venv, the environment.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd)
python=$2
export PATH="$build/bin:$PATH" PYTHONDONTWRITEBYTECODE=1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
venv=$scratch/venv
"$python" -m venv "$venv"
"$venv/bin/pip" install -q "${@:3}"
