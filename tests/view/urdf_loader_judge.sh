#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Poses of a page's links before urdf-loader, which comes from npm and is therefore no part of ./test.sh:
#   tests/view/urdf_loader_judge.sh BUILD
# BUILD is a build folder with the programs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$(cd "$1" && pwd)
judge=$build/urdf_loader
mkdir -p "$judge"
npm install --prefix "$judge" --no-audit --no-fund --no-save urdf-loader@0.13.1 three@0.187.0 esbuild@0.28.2
cp "$here/urdf_loader_judge.mjs" "$judge"
(cd "$judge" && node_modules/.bin/esbuild urdf_loader_judge.mjs --bundle --format=iife --log-level=error --outfile=judge.js)
/usr/bin/python3 -B "$here/urdf_loader_judge.py" "$build" "$judge/judge.js"
