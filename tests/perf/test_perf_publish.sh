#!/usr/bin/env bash
# What is published is of a commit, and replaces what was published before:
#   tests/perf/test_perf_publish.sh
# Skipped (77) where there is no jq or no git.
set -euo pipefail
command -v jq >/dev/null && command -v git >/dev/null || exit 77
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "test_perf_publish: $*" >&2; exit 1; }

# A repository of these scripts alone, in which whatever is refused is refused before tools/setup.sh.
mkdir tools
cp -r "$root/perf" .
rm -rf perf/results
mkdir perf/results
printf '#!/bin/sh\nexit 9\n' >tools/setup.sh
cp "$root/tools/compilers" tools/
chmod +x tools/setup.sh
git init -q
git -c user.name=a -c user.email=a@b add .
git -c user.name=a -c user.email=a@b -c commit.gpgsign=false commit -qm sources

# ends STATUS COMMAND...
ends() {
  local status=0
  "${@:2}" >lines 2>&1 || status=$?
  [ "$status" -eq "$1" ] || fail "${*:2}: exit code $status, not $1: $(cat lines)"
}
ends 9 perf/run --publish kernels
ends 9 perf/experiments chain
touch perf/results/anything  # is no source
ends 9 perf/run --publish kernels
echo '# changed' >>perf/compare
ends 9 perf/run kernels
for command in perf/wasm perf/instructions perf/bricks perf/labels "tools/compilers windows"; do
  # shellcheck disable=SC2086
  ends 9 $command
done
for command in "perf/run --publish kernels" "perf/run --publish --join" "perf/experiments chain" \
  "perf/wasm --publish" "perf/instructions --publish" "perf/bricks --publish" "perf/labels --publish" \
  "tools/compilers --publish windows"; do
  # shellcheck disable=SC2086
  ends 2 $command
  grep -qE '^(run|experiments|wasm|instructions|bricks|labels|compilers): the sources differ from commit [0-9a-f]+: commit them first$' lines ||
    fail "$command: $(cat lines)"
done
ends 9 env RESULTS=elsewhere perf/experiments chain
rm -rf .git
GIT_CEILING_DIRECTORIES=$(dirname "$work") ends 2 perf/experiments chain

# The last published run alone is kept; elsewhere, all but earlier ones of the same commit.
source perf/part/results.sh
facts() { echo '{}'; }
write_targets() { :; }
write_tables() { :; }
out=$work/out commit=abc root=$work
mkdir -p out/abc perf/part
: >perf/part/plots.sh
echo '{"part": "fine", "date": "2026-02-03", "load": 0, "seconds": 1, "measures": {}, "details": {}}' \
  >out/abc/fine.json
for publish in "" 1; do
  to=$out
  [ -z "$publish" ] || to=perf/results
  touch "$to/2026-01-01-abc.json" "$to/2026-01-02-other.json" "$to/targets.md"
  write_results >/dev/null
  found=$(cd "$to" && echo ????-??-??-*.json)
  expected="2026-01-02-other.json 2026-02-03-abc.json"
  [ -z "$publish" ] || expected=2026-02-03-abc.json
  [ "$found" = "$expected" ] || fail "publish '$publish': $found is there, not $expected"
  [ -e "$to/targets.md" ] || fail "targets.md is gone"
done
