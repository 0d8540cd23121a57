#!/usr/bin/env bash
# perf/accuracy: its tables of programs whose answers are known, and the programs of perf/truth:
#   tests/perf/test_perf_accuracy.sh TRUTH_RENDER TRUTH_MEASURE PELLICLE
# Skipped (77) where there is no jq.
set -euo pipefail
command -v jq >/dev/null || exit 77
accuracy=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/perf/accuracy
render=$(realpath "$1") measure=$(realpath "$2") pellicle=$(realpath "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# expect STATUS TEXT COMMAND...: the exit status and a part of a line of the output.
expect() {
  local status=0
  "${@:3}" >out 2>&1 || status=$?
  if [ "$status" -ne "$1" ] || ! grep -qF -- "$2" out; then
    printf '%s: status %s, expected %s and "%s":\n%s\n' "${*:3}" "$status" "$1" "$2" "$(cat out)" >&2
    exit 1
  fi
}
# wrong TEXT COMMAND...: refused in one line.
wrong() {
  expect 2 "$@"
  [ "$(wc -l <out)" -eq 1 ] || { echo "not one line: $(cat out)" >&2; exit 1; }
}

# A small ball of the command, on its way through every program.
scene='ball:6 --sigma 1 --oblique --voxels 1,1,2'
# shellcheck disable=SC2086
"$render" $scene -o ball.nrrd
"$pellicle" extract ball.nrrd -o ball.ply --iso 0.5 --quiet
# shellcheck disable=SC2086
"$measure" $scene ball.ply >ball.json
jq -e '.truth.object.genus == 0 and .truth.iso.components == 1 and .meshes[0].components == 1
  and (.meshes[0].iso.to_truth | .rms < 0.2 and .rms >= (.bias | fabs) and .max >= .p95)
  and .meshes[0].object.from_truth.far < 0.1' ball.json >/dev/null || { cat ball.json; exit 1; }
# shellcheck disable=SC2086
"$render" $scene -o again.nrrd --noise 0.1
cmp -s ball.nrrd again.nrrd && { echo "no noise" >&2; exit 1; }

wrong 'truth_render: a shape is expected' "$render"
wrong 'truth_render: -o FILE is expected' "$render" ball:5
wrong 'truth_render: egg: not a shape' "$render" egg -o x.nrrd
wrong 'truth_render: --sigma -1: 0 to 10 is expected' "$render" ball:5 --sigma -1 -o x.nrrd
wrong 'truth_render: x.gif: volumes are written as' "$render" ball:5 -o x.gif
wrong 'truth_measure: a shape is expected' "$measure"
wrong 'truth_measure: gone.ply' "$measure" ball:5 gone.ply
wrong 'truth_measure: --fast: not known' "$measure" ball:5 --fast ball.ply

# The table, of programs that say what they are told.
mkdir -p build/tools build/perf/truth build/perf/peers
cat >build/tools/pellicle <<'END'
#!/usr/bin/env bash
echo "$*" >>pellicle.log
case $* in
  *--fast*) echo "pellicle: The following argument was not expected: --fast" >&2; exit 2 ;;
  *[12].nrrd*) echo "pellicle: iso 0.5: outside the image's range 0 .. 0.3" >&2; exit 2 ;;
esac
touch "$4"
while [ "$1" != --report ]; do shift; done
echo '{"seconds": {"total": 1.5, "read": 0.25, "write": 0.25}, "levels": [{"converged": true}]}' >"$2"
END
cat >build/perf/truth/truth_render <<'END'
#!/usr/bin/env bash
touch "${@: -1}"
END
cat >build/perf/peers/peer_flying_edges <<'END'
#!/usr/bin/env bash
echo "$*" >>peer.log
case $* in *2.nrrd*) echo "/x/peer_flying_edges: nothing there" >&2; exit 2 ;; esac
echo '{"seconds": 0.5}'
touch "${@: -1}"
END
cat >build/perf/truth/truth_measure <<'END'
#!/usr/bin/env bash
truth='{"object": {"components": 2, "genus": 1, "area": 100, "volume": 50}, "iso": null}'
deviation() {
  echo "{\"to_truth\": {\"bias\": -$1, \"rms\": $1, \"p95\": 1, \"max\": 2, \"far\": 0},
    \"from_truth\": {\"bias\": 0, \"rms\": 0.01, \"p95\": 0, \"max\": 0, \"far\": 0.125}}"
}
list=
for mesh in "$@"; do
  case $mesh in *pellicle.ply) rms=0.3 ;; *edges.ply) rms=0.0625 ;; *) continue ;; esac
  list+="${list:+,}{\"mesh\": \"$mesh\", \"vertices\": 7, \"components\": 3, \"genus\": -1,
    \"area\": 101, \"volume\": 45, \"curvature\": null, \"object\": $(deviation $rms), \"iso\": null}"
done
echo "{\"voxels\": [1, 2, 3], \"truth\": $truth, \"meshes\": [$list]}"
END
chmod +x build/tools/pellicle build/perf/*/*
run() { "$accuracy" --build build --out out.d --programs pellicle,flying_edges "$@"; }

measured='- | - | - | - | - | -0.300 | 0.300 | 1.000 | 2.00 | 0.010, 12.5 % | 1.00 | -10.00 | - | 3 | open'
expect 0 "| **Pellicle** | $measured | 7 | 1.00 |" \
  run 'ball --sigma 1' 'plate:0.5 --sigma 1' rod -- --curvature 0.2
has() { grep -qF -- "$2" "$1" || { echo "$1 does not have $2: $(cat "$1")" >&2; exit 1; }; }
has out "| **Pellicle** | pellicle: iso 0.5: outside the image's range 0 .. 0.3 | -"
has out '| FlyingEdges | peer_flying_edges: nothing there | -'
has out.d/accuracy.md '| rod | none | none | 2: - |'
has out.d/accuracy.md '| ball blur 1 | 0.300 | **0.063** | 2: 3 |'
has out.d/accuracy.md '| plate:0.5 blur 1 | none | **0.063** | 2: - |'
has out.d/accuracy.md 'Another program is nearer in 2 of 3 scenes'
has out.d/accuracy.md '- ball blur 1: ours 0.300, FlyingEdges 0.063'
has pellicle.log '--quiet --curvature 0.2'
has peer.log '--iso 0.5 --window 0,1 -o'
expect 0 'ball --sigma 1 --noise 0.2' "$accuracy" --list
[ "$("$accuracy" --list --all | sort -u | wc -l)" -gt 300 ] || { echo "not all" >&2; exit 1; }

wrong 'pellicle: The following argument was not expected: --fast' run ball -- --fast
wrong 'unknown option --fast' run --fast
wrong '--space: not to be given here' run ball -- --space=ras
wrong '--programs cubes: one of' "$accuracy" --build build --programs cubes
wrong 'peer_level_set: no such command' "$accuracy" --build build --programs level_set
wrong 'no such command' run --pellicle gone
