#!/usr/bin/env bash
# perf/bench_ablation, and what it shares with perf/bench_passes, on a volume that takes no time:
#   test_perf_ablation.sh BENCH_ABLATION PELLICLE
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2" phantom blobs --size 48 --type i16 --noise 0 -o "$work/blobs.nrrd" >"$work/log"
for left_out in check-all no-renumbering; do
  "$1" "$work/blobs.nrrd" "$left_out" >"$work/out"
  grep -q '"hash": "[0-9a-f]\{16\}"' "$work/out" ||
    { echo "bench_ablation $left_out: no hash: $(cat "$work/out")" >&2; exit 1; }
done
