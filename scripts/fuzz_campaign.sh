#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Fuzzes one target after the other and goes on where it was left off:
#   scripts/fuzz_campaign.sh [--seconds N] [--goal N] [--build DIR] [--work DIR] [--seeds DIR]... [TARGET...]
#   scripts/fuzz_campaign.sh --report        # executions, corpus and findings of each target so far
# A round gives each target N seconds (default 60), those with the fewest executions first; rounds follow until each
# has its goal (1e8; 1e6 for those that go through libraries of others) or the script is stopped, which it may be at any time.
# After its turn a target's corpus is minimised. Findings lie in WORK/findings/TARGET, with the line that repeats each.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/fuzz work=$root/build/fuzz_campaign seconds=60 goal= report=no
more=() targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --goal) goal=$2; shift 2 ;;
    --build) build=$2; shift 2 ;;
    --work) work=$2; shift 2 ;;
    --seeds) more+=("$2"); shift 2 ;;
    --report) report=yes; shift ;;
    -*) sed -n '5,11s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
    *) targets+=("$1"); shift ;;
  esac
done

unset DOORFORGE_FUZZ_TARGET
declare -A program
for file in "$build"/bin/fuzz_*; do
  for target in $("$file" -help=1 2>/dev/null || true); do program[$target]=$file; done
done
[ ${#program[@]} -gt 0 ] || { echo "no program in $build/bin: cmake --preset fuzz && cmake --build --preset fuzz" >&2; exit 2; }
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(printf '%s\n' "${!program[@]}" | sort)

executions() { awk '{sum += $1} END {print sum + 0}' "$work/executions/$1" 2>/dev/null || echo 0; }
findings() { find "$work/findings/$1" -type f ! -name '*.log' 2>/dev/null | wc -l; }
goal_of() { case ${program[$1]} in *fuzz_libraries) echo "${goal:-1000000}" ;; *) echo "${goal:-100000000}" ;; esac; }

if [ "$report" = yes ]; then
  printf '%-18s %14s %14s %8s %9s\n' target executions goal corpus findings
  for target in "${targets[@]}"; do
    printf '%-18s %14s %14s %8s %9s\n' "$target" "$(executions "$target")" "$(goal_of "$target")" \
      "$(find "$work/corpus/$target" -type f 2>/dev/null | wc -l)" "$(findings "$target")"
  done
  exit 0
fi

mkdir -p "$work/executions" "$work/seeds"
python3 "$root/tests/fuzz/seeds.py" "$work/seeds" "${more[@]}"
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=0:detect_stack_use_after_return=0
export UBSAN_OPTIONS=print_stacktrace=1

# what has run is counted, however the script is stopped
stopping=no child=
stop() {
  stopping=yes
  if [ -n "$child" ]; then kill -INT "$child" 2>/dev/null || true; fi
}
trap stop INT TERM

# fuzz_one TARGET: its turn, and what it ran; a finding ends the turn
fuzz_one() {
  local target=$1 corpus=$work/corpus/$1 found=$work/findings/$1 log=$work/log/$1 options=(-print_final_stats=1)
  mkdir -p "$corpus" "$found" "$work/log" "$work/seeds/$target"
  options+=(-max_total_time="$seconds" -max_len=8192 -timeout=120 -rss_limit_mb=2048 -malloc_limit_mb=256 -artifact_prefix="$found/")
  if [ -e "$work/seeds/$target.dict" ]; then options+=(-dict="$work/seeds/$target.dict"); fi
  local result=0
  DOORFORGE_FUZZ_TARGET=$target "${program[$target]}" "${options[@]}" "$corpus" "$work/seeds/$target" >"$log" 2>&1 &
  child=$!
  wait $child || result=$?
  if [ $stopping = yes ]; then wait $child || true; fi
  awk '/stat::number_of_executed_units/ {ran = $2} /^#[0-9]+/ {last = substr($1, 2)} END {print ran ? ran : last + 0}' "$log" \
    >>"$work/executions/$target"
  if [ $stopping = yes ]; then exit 130; fi
  if [ $result -ne 0 ]; then
    cp "$log" "$found/$(date +%Y%m%d-%H%M%S).log"
    echo "$target: a finding; DOORFORGE_FUZZ_TARGET=$target ${program[$target]} FILE repeats it:"
    find "$found" -type f ! -name '*.log' -newer "$work/executions" | sed 's/^/  /'
  fi
  local least=$work/least
  rm -rf "$least" && mkdir "$least"
  if DOORFORGE_FUZZ_TARGET=$target "${program[$target]}" -merge=1 -max_len=8192 "$least" "$corpus" >"$log.merge" 2>&1; then
    rm -rf "$corpus" && mv "$least" "$corpus"
  fi
}

while true; do
  turn=()
  while read -r count target; do
    if [ "$count" -lt "$(goal_of "$target")" ]; then turn+=("$target"); fi
  done < <(for target in "${targets[@]}"; do echo "$(executions "$target") $target"; done | sort -n)
  [ ${#turn[@]} -gt 0 ] || break
  for target in "${turn[@]}"; do
    fuzz_one "$target"
    echo "$target: $(executions "$target") executions, $(findings "$target") findings"
    if [ $stopping = yes ]; then exit 130; fi
  done
done
