#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes the Debian packages of one or two build folders of the same commit, one after the other, with umask 022 as Debian does, and
# says whether they have the same bytes.
#
#   scripts/compare_packages.sh build/release                  # the same build packed twice
#   scripts/compare_packages.sh build/release other/release    # two builds, in folders of different names
#
# Exit code: 0 the same, 1 not (then what differs is listed), 2 wrong use.
set -euo pipefail
[ $# -ge 1 ] && [ $# -le 2 ] && [ -f "$1/CPackConfig.cmake" ] || { sed -n '5,12s/^# \{0,1\}//p' "$0" >&2; exit 2; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

pack() {  # build folder, name
  (umask 022; cd "$1"; cpack -G DEB --config CPackConfig.cmake -B "$scratch/$2" ${DOORFORGE_PACK_OPTIONS:-} >"$scratch/$2.log" 2>&1) ||
    { cat "$scratch/$2.log" >&2; exit 2; }
}

pack "$1" one
sleep 2  # archives count time in seconds
pack "${2:-$1}" two
differing=0
for package in "$scratch"/one/*.deb; do
  name=$(basename "$package")
  if cmp -s "$package" "$scratch/two/$name"; then
    echo "$name: the same $(stat -c %s "$package") bytes, SHA-256 $(sha256sum "$package" | cut -c1-64)"
    continue
  fi
  differing=1
  echo "$name: differs"
  for side in one two; do
    dpkg-deb -R "$scratch/$side/$name" "$scratch/$side-$name" 2>/dev/null || continue
    (cd "$scratch/$side-$name" && find . -type f -exec sha256sum {} + | sort -k 2) >"$scratch/$side.sums"
    dpkg-deb -c "$scratch/$side/$name" >"$scratch/$side.list" || true
  done
  diff "$scratch/one.sums" "$scratch/two.sums" | head -40 || true
  diff "$scratch/one.list" "$scratch/two.list" | head -40 || true
done
exit $differing
