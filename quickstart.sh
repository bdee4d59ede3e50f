#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# From a fresh Debian 12 machine to a trained door-opening policy and its report:
#   ./quickstart.sh [arguments of `doorforge quickstart`]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
scripts/install_packages.sh build
cmake --preset release >build-release.log 2>&1 || { cat build-release.log >&2; exit 3; }
rm -f build-release.log
cmake --build --preset release --parallel "$(nproc)"
exec build/release/bin/doorforge quickstart "$@"
