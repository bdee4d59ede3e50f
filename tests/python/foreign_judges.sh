#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# `doorforge validate` beside usd-core from PyPI; not a part of ./test.sh, which has Debian's packages alone:
#   tests/python/foreign_judges.sh BUILD PYTHON
# BUILD is a build folder with the programs, PYTHON one that usd-core has wheels for. Fails where usd-core refuses
# more than one in a hundred of what doorforge passes.
# shellcheck source=tests/python/judge_setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/judge_setup.sh" "$1" "$2" usd-core
doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out "$scratch/doors/a"
doorforge compose --body safe_box_tall_03 --handle safe_tee_04 --set latch=bolt --out "$scratch/doors/b"
doorforge export "$scratch/doors" --format usda --out "$scratch/exported"
"$venv/bin/python" "$root/tests/python/foreign_judge.py" "$build" "$scratch"
