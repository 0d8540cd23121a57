#!/usr/bin/env bash
# What perf/run records of its runs, and what targets.md and tables.md say of it:
#   tests/perf/test_perf_targets.sh
# Skipped (77) where there is no jq.
set -euo pipefail
command -v jq >/dev/null || exit 77
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "test_perf_targets: $*" >&2; exit 1; }
# contains FILE TEXT
contains() { grep -qF -- "$2" "$1" || { cat "$1" >&2; fail "$1 does not have: $2"; }; }

# A part of two runs of one variant.
out=$work/out commit=abc runs=3 budget=100 pellicle=none
source "$root/perf/part/common.sh"
mkdir -p "$out/$commit"
start_part fine
say() { echo "{\"hash\": \"1234\", \"seconds\": {\"evolution\": $1}}" >"$report"; }
turn=0
pretend() {
  turn=$((turn + 1))
  say "$(sed -n "${turn}p" <<<$'1.5\n0.5\n0.7')"
}
variant fine pretend
run_variants >/dev/null
measure coarse_to_fine s fine .seconds.evolution
echo '{"met": true, "vertices": 95000, "area_off": -0.009, "volume_off": 0.001, "converged": true}' |
  detail check-fine
finish_part
jq -e '.measures.coarse_to_fine
  == {unit: "s", median: 0.7, min: 0.5, max: 1.5, runs: [1.5, 0.5, 0.7], hash: "1234"}' \
  "$out/$commit/fine.json" >/dev/null || fail "record: $(cat "$out/$commit/fine.json")"

# Runs of one variant that do not agree are no measurement.
sed -i s/1234/5678/ "$dir/fine.2.json"
if same_hash fine 2>/dev/null; then fail "different hashes were taken for one"; fi

# A part whose budget is spent has its first runs.
budget=0
start_part once
variant once pretend
turn=0
run_variants >/dev/null
[ "$(ls "$dir" | wc -l)" -eq 1 ] || fail "the budget was not kept"

# Met and not met, measured peers, what is missing.
jq '{date, machine: {cores: 2}, details, measures: (.measures + {
    direct: {unit: "s", median: 4.1, min: 3.9, max: 4.2, runs: [4.1, 3.9, 4.2]},
    speedup_2: {unit: "x", median: 1.85, min: 1.8, max: 1.9, runs: [1.8, 1.85, 1.9]},
    resolution_calm_2: {unit: "ms", median: 4.9, min: 4, max: 6, runs: [4.9, 4, 6]},
    peer_remeshing: {unit: "s", median: 8, min: 7, max: 9, runs: [7, 8, 9]}})}
  | .details.peer_remeshing = {title: "remeshing", self_intersections: 111}' \
  "$out/$commit/fine.json" >result.json
targets() {
  jq -r --slurpfile targets "$root/perf/part/targets.json" -f "$root/perf/part/targets.jq" "$1" \
    >targets.md
}
targets result.json
contains targets.md '| 1 s | 0.7 s [0.5 .. 1.5] of 3 | yes |'
contains targets.md 'isotropic remeshing **8 s [7 .. 9] of 3** (111 self-intersections)'
contains targets.md '| 4 s | 4.1 s [3.9 .. 4.2] of 3 | no |'
contains targets.md '| at least 1.8 x | 1.85 x [1.8 .. 1.9] of 3 | yes |'
contains targets.md '| 5 ms | 4.9 ms [4 .. 6] of 3 | yes |'
contains targets.md '| 250 bytes | not measured | - |'

# A time for a surface that is not the one asked for meets nothing.
jq '.details."check-fine".met = false' result.json >other.json
targets other.json
contains targets.md '0.7 s [0.5 .. 1.5] of 3 | no: not the surface asked for |'
jq 'del(.details."check-fine")' result.json >unchecked.json
targets unchecked.json
contains targets.md '0.7 s [0.5 .. 1.5] of 3 | surface not checked |'

# Tables 1 and 2: a direct run has its only level in the last column.
jq '.details."levels-direct" = {levels: [{level: 0, iterations: 491, vertices: 122454,
    converged: false, seconds: {topology: 3, normals: 0.5, dynamics: 1, total: 4.6}}]}' \
  result.json >tables.json
jq -r -f "$root/perf/part/tables.jq" tables.json >tables.md
contains tables.md '| paper, multi-resolution | T | 17 | 30 | 108.7 | 543.8 | 699.5 |'
contains tables.md '| Pellicle, direct | T |  |  |  | 3 | 3 |'
contains tables.md '|  | iterations |  |  |  | 491\* | 491 |'
