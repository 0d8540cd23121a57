#!/usr/bin/env bash
# perf/progress on traces whose answer is known.
set -uo pipefail
progress=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/perf/progress
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
failures=0
fails() { echo "FAILED: $1"; failures=$((failures + 1)); }

trace() {  # the told part as a function of the part t that is done
  awk -v told="$1" 'BEGIN {
    print "iteration,level,level_iteration,vertices,energy,speed,seconds,fraction"
    for (i = 1; i <= 100; ++i) {
      t = i / 100
      print i ",0," i ",10,1,1," t * 20 "," (told == "right" ? t : told == "late" ? t / (t + 3 * (1 - t)) : 1)
    }
  }'
}
trace right >right.csv
trace late >late.csv
trace done >done.csv
expect() { grep -qE "$1" out || fails "expected $1: $(cat out)"; }
"$progress" right.csv late.csv done.csv >out || fails "exit code $?"
expect '^right +20\.0( +1\.00){8} +0\.0% +0\.0%$'
expect '^late +20\.0( +3\.00){8} +(9[89]\.[0-9]|100\.0)% +[1-9][0-9]\.[0-9]%$'
expect '^done +20\.0( +0\.00){8} +'
echo "a,b" >none.csv
if "$progress" none.csv >out 2>&1; then fails "no trace is none"; fi
if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
