#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds the dev preset and runs all tests, as continuous integration does:
#   ./test.sh [--tidy] [arguments of ctest, such as -L unit or -R latch]
# --tidy runs clang-tidy over all sources as well (about ten minutes). Without arguments, readers of bytes from outside
# also run under sanitizers, two thousand inputs each (scripts/sanitizers.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
tidy=no
if [ "${1:-}" = --tidy ]; then tidy=yes; shift; fi
scripts/install_packages.sh build test
git ls-files '*.h' '*.cpp' | xargs -r clang-format --dry-run --Werror
# clang-tidy looks at each source by itself
together=ON
if [ "$tidy" = yes ]; then together=OFF; fi
cmake --preset dev -DDOORFORGE_BUILD_FROM_NOTHING="$together"
cmake --build --preset dev --parallel "$(nproc)"
if [ "$tidy" = yes ]; then
  git ls-files '*.cpp' | grep -v '^tests/\|^benchmarks/' | xargs -r -P "$(nproc)" -n 4 clang-tidy -p build/dev --quiet
fi
if [ $# -eq 0 ]; then scripts/sanitizers.sh; fi
ctest --preset dev --parallel "$(nproc)" "$@" || { code=$?; scripts/failed_tests.py build/dev; exit "$code"; }
