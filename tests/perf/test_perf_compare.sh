#!/usr/bin/env bash
# What perf/compare says of two results of perf/run:
#   tests/perf/test_perf_compare.sh
# Skipped (77) where there is no jq.
set -euo pipefail
command -v jq >/dev/null || exit 77
compare=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/perf/compare
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# result FILE MEASURES: a result with these measures.
result() {
  jq -n --argjson measures "$2" \
    '{date: "2026-01-01", commit: "abc", machine: {cpu: "one"}, compiler: "c", flags: "f", $measures}' \
    >"$dir/$1.json"
}
# expect STATUS TEXT ARGUMENTS...: the exit status and a line of the output.
expect() {
  local status=0 output
  output=$(cd "$dir" && "$compare" "${@:3}" 2>&1) || status=$?
  if [ "$status" -ne "$1" ] || ! grep -q -- "$2" <<<"$output"; then
    printf 'compare %s: status %s, expected %s and "%s":\n%s\n' "${*:3}" "$status" "$1" "$2" \
      "$output" >&2
    exit 1
  fi
}

result a '{"direct": {"unit": "s", "median": 4, "min": 3.9, "max": 4.2, "hash": "1"},
           "speedup_2": {"unit": "x", "median": 1.8, "min": 1.7, "max": 1.9}}'
expect 0 '0 worse, 0 with another result, of 2' a.json a.json
expect 0 'direct .* 1$' a.json a.json

# A measure is worse when it is slower beyond the noise and outside both spreads.
result slow '{"direct": {"unit": "s", "median": 5, "min": 4.8, "max": 5.2, "hash": "1"}}'
expect 1 'direct .* 1.25 .*WORSE' a.json slow.json
expect 0 'direct .* 0.8 .*better' slow.json a.json
expect 0 '0 worse' --noise 30 a.json slow.json
result wide '{"direct": {"unit": "s", "median": 5, "min": 4.1, "max": 9, "hash": "1"}}'
expect 0 'worse, within the spread' a.json wide.json
result near '{"direct": {"unit": "s", "median": 4.3, "min": 4.25, "max": 4.4, "hash": "1"}}'
expect 0 '0 worse' a.json near.json
expect 0 'not measured again: speedup_2' a.json near.json

# Of a speed-up less is worse.
result lame '{"speedup_2": {"unit": "x", "median": 1.2, "min": 1.1, "max": 1.3}}'
expect 1 'speedup_2 .*WORSE' a.json lame.json
expect 0 'speedup_2 .*better' lame.json a.json

# Another result is a failure unless it is allowed.
result other '{"direct": {"unit": "s", "median": 4, "min": 3.9, "max": 4.2, "hash": "2"}}'
expect 1 'OTHER RESULT' a.json other.json
expect 0 'OTHER RESULT' --allow-hash a.json other.json
result unhashed '{"direct": {"unit": "s", "median": 4, "min": 3.9, "max": 4.2}}'
expect 0 '0 with another result' a.json unhashed.json

# Nothing in common is no success.
result none '{"else": {"unit": "s", "median": 1, "min": 1, "max": 1}}'
expect 1 'of 0 measures' a.json none.json

jq '.machine.cpu = "two"' "$dir/a.json" >"$dir/elsewhere.json"
expect 0 'warning: another machine' a.json elsewhere.json

echo '{}' >"$dir/empty.json"
expect 2 'empty.json: no result of perf/run' a.json empty.json
expect 2 'gone.json: no result of perf/run' gone.json a.json
expect 2 'two results' a.json
expect 2 'unknown option --fast' --fast a.json a.json
expect 2 'number of percent' --noise few a.json a.json
