#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Every page before axe-core (WCAG rules), which comes from npm and is therefore no part of ./test.sh:
#   tests/view/axe_judge.sh BUILD
# BUILD is a build folder with the programs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
mkdir -p "$build/axe"
npm install --prefix "$build/axe" --no-audit --no-fund --no-save axe-core@4.11.0
/usr/bin/python3 -B "$here/axe_judge.py" "$build" "$build/axe/node_modules/axe-core/axe.min.js"
