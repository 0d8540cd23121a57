#!/usr/bin/env bash
# The head CT of the demo: the same surface for any number of threads and any SIMD target of the
# machine, and valid. A few iterations on every level: large enough for the parallel path throughout.
#   tests/tools/test_ct_determinism.sh PELLICLE        exit code 77 where the CT is not installed
set -uo pipefail
pellicle=$(realpath "$1")
volume=/usr/share/doc/invesalius-examples/examples/Cranium.inv3
[ -e "$volume" ] || { echo "skipped: $volume is not there (invesalius-examples)"; exit 77; }
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
first=
failures=0

# The hash of the surface, by the report. An unavailable target is no failure.
run() {  # threads, simd
  "$pellicle" extract "$volume" -o skull.ply --iso 226 --max-iterations 5 --quiet \
    --report skull.json --threads "$1" --simd "$2" 2>stderr
  case $? in
    0) ;;
    *) grep -q 'does not have it' stderr && return 0
       cat stderr
       failures=$((failures + 1))
       return 0 ;;
  esac
  local hash
  hash=$(sed -nE 's/^ *"hash": "([0-9a-f]{16})".*/\1/p' skull.json)
  first=${first:-$hash}
  echo "threads $1, simd $2: $hash"
  if [ -z "$hash" ] || [ "$hash" != "$first" ]; then
    echo "FAILED: expected $first"
    failures=$((failures + 1))
  fi
}

for simd in scalar sse4 avx2 avx512 neon; do run 2 $simd; done
for threads in 1 3 8; do run $threads auto; done
run 8 scalar
run 2 auto
"$pellicle" check skull.ply >/dev/null || { echo "FAILED: not valid"; failures=$((failures + 1)); }
exit $((failures > 0))
