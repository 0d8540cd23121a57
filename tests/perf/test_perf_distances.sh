#!/usr/bin/env bash
# The table of perf/distances, of a command and a comparison whose answers are known:
#   tests/perf/test_perf_distances.sh
# Skipped (77) where there is no jq.
set -euo pipefail
command -v jq >/dev/null || exit 77
distances=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/perf/distances
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

mkdir -p build/tools build/perf/peers
cat >build/tools/pellicle <<'END'
#!/usr/bin/env bash
echo "$*" >>pellicle.log
[ "$2" != bad.nii ] || { echo "a warning" >&2; echo "pellicle: bad.nii: no image" >&2; exit 1; }
while [ "$1" != --report ]; do shift; done
cat >"$2" <<'JSON'
{"parameters": {"pad": -7.5}, "surface": {"vertices": 1000}, "seconds": {"total": 1.5}, "levels": [
  {"level": 2, "vertices": 0, "iterations": 0, "converged": false, "operations": {"creation": 0}},
  {"level": 1, "vertices": 90, "iterations": 500, "converged": false, "frozen": {"sites": 3, "vertices": 9}, "operations": {"creation": 1000}},
  {"level": 0, "vertices": 1000, "iterations": 61, "converged": true, "operations": {"creation": 200, "deletion": 34}}]}
JSON
END
cat >build/perf/peers/peer_distances <<'END'
#!/usr/bin/env bash
echo "$*" >>program.log
echo '{"reference_to_mesh": {"mean": 0.31, "p95": 12.3456}, "mesh_to_reference": {"mean": 0.0051, "p95": 0}}'
END
chmod +x build/tools/pellicle build/perf/peers/peer_distances
touch head.nii knee.nii bad.nii

# expect STATUS TEXT ARGUMENTS...: the exit status and a line of the output.
expect() {
  local status=0
  "$distances" --build build "${@:3}" >out 2>&1 || status=$?
  if [ "$status" -ne "$1" ] || ! grep -qF -- "$2" out; then
    printf 'distances %s: status %s, expected %s and "%s":\n%s\n' "${*:3}" "$status" "$1" "$2" \
      "$(cat out)" >&2
    exit 1
  fi
}
# has FILE TEXT: a line of a log.
has() { grep -qF -- "$2" "$1" || { echo "$1 does not have $2: $(cat "$1")" >&2; exit 1; }; }

numbers='1000 | 1.2 | (0) 500 61 | 1 of 2 | 3 | 1.50 | 0.310 | 12.346 | 0.005 | 0.000 |'
expect 0 "| head.nii | 226 | $numbers" head.nii:226 knee.nii:-4.5e1
expect 0 "| knee.nii | -4.5e1 | $numbers" head.nii:226 knee.nii:-4.5e1 -- --inside below --levels 0
[ "$(grep -c '^|' out)" -eq 4 ] || { echo "not two rows: $(cat out)" >&2; exit 1; }
has pellicle.log '--space voxel --quiet --inside below --levels 0'
has program.log '--space voxel --inside below --pad -7.5'
expect 0 "| knee.nii | 3 | $numbers" -- --levels 0 knee.nii:3
expect 0 "| knee.nii | 3 | $numbers" --reference head.nii knee.nii:3
has program.log "$PWD/head.nii 3 "

# Errors are one line.
wrong() {
  expect 2 "$@"
  [ "$(grep -vc '^|' out)" -eq 1 ] || { echo "not one line: $(cat out)" >&2; exit 1; }
}
wrong 'a volume, FILE:ISO, is expected'
wrong 'head.nii: FILE:ISO is expected' head.nii
wrong 'head.nii:x: FILE:ISO is expected' head.nii:x
wrong 'gone.nii: no such file' gone.nii:3
wrong 'gone.nii: no such file' --reference gone.nii head.nii:3
wrong 'unknown option --fast' --fast head.nii:3
wrong '--space: not to be given here' head.nii:3 -- --space=ras
wrong '--inside sideways: above or below' head.nii:3 -- --inside sideways
wrong 'no such command' --pellicle gone head.nii:3
wrong 'bad.nii: pellicle: bad.nii: no image' bad.nii:3
