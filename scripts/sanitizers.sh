#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# What ./test.sh does with sanitizers, and what it has no time for:
#   scripts/sanitizers.sh                      # readers of bytes from outside, two thousand inputs each
#   scripts/sanitizers.sh address TARGET...    # test programs, by name, under address and undefined-behaviour sanitizers
#   scripts/sanitizers.sh thread TARGET...     # under the thread sanitizer
# Such as, after work on collection:  scripts/sanitizers.sh thread collect_test dataset_test
# Leaks are told by the readers' round alone: libtorch keeps what it has until the program ends.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=$(nproc)

build_and_run() {
  local preset=$1
  shift
  cmake --preset "$preset"
  cmake --build "build/$preset" --parallel "$jobs" --target "$@"
  for program in "$@"; do "build/$preset/bin/$program"; done
}

# In a shell of its own, beside others.
run_reader() {
  local target=$1
  local options=(-runs=2000 -seed=1 -max_len=4096 -malloc_limit_mb=256 -rss_limit_mb=2048 -artifact_prefix="$TMPDIR/$target-")
  if [ -e "$TMPDIR/seeds/$target.dict" ]; then options+=(-dict="$TMPDIR/seeds/$target.dict"); fi
  mkdir -p "$TMPDIR/seeds/$target"
  DOORFORGE_FUZZ_TARGET=$target build/fuzz/bin/fuzz_readers "${options[@]}" "$TMPDIR/seeds/$target" >"$TMPDIR/$target.log" 2>&1 && return
  tail -60 "$TMPDIR/$target.log"
  echo "the reader \"$target\" does not hold; docs/design/fuzzing.md"
  return 255  # xargs begins no other
}

case ${1:-readers} in
  readers)
    cmake --preset fuzz >/dev/null
    cmake --build --preset fuzz --parallel "$jobs" --target fuzz_readers
    scratch=$(mktemp -d)
    trap 'rm -rf "$scratch"' EXIT
    export TMPDIR=$scratch
    python3 tests/fuzz/seeds.py "$scratch/seeds"
    targets=$(build/fuzz/bin/fuzz_readers 2>/dev/null || true)  # without a target it lists them, and fails
    [ -n "$targets" ]
    export -f run_reader
    xargs -P "$jobs" -I{} bash -c 'run_reader {}' <<<"$targets"
    ;;
  address)
    shift
    export ASAN_OPTIONS=detect_leaks=0
    build_and_run asan "$@"
    ;;
  thread)
    shift
    export TSAN_OPTIONS=halt_on_error=1
    build_and_run tsan "$@"
    ;;
  *)
    sed -n '5,11s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
