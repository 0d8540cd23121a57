#!/usr/bin/env bash
# The plot of a result of perf/accuracy:
#   perf/part/accuracy_plots.sh accuracy.json FOLDER
# accuracy.png: RMS over the noise on a blurred ball, and what is lost of plates and rods. Panels whose
# scenes are not there are left empty.
set -euo pipefail
result=$1
to=$2
data=$(mktemp -d)
trap 'rm -rf "$data"' EXIT

programs=(pellicle flying_edges windowed_sinc make_mesh level_set)
titles=(Pellicle FlyingEdges 'windowed sinc' 'make\_mesh\_3' 'ITK level set')

# rows PROGRAM PATTERN PLACE VALUE: lines of a number in the scene (PLACE names it) and a value.
rows() {
  jq -r --arg program "$1" --arg pattern "$2" '
    .cases[] | select(.scene | test($pattern)) | (.scene | capture($pattern).x | tonumber) as $x
    | .results[$program] | select(. != null) | [$x, ('"$3"')] | select(.[1] != null) | "\(.[0]) \(.[1])"' \
    "$result" | sort -n
}

score='(.iso // .object) | if . == null then null else [.to_truth.rms, .from_truth.rms] | max end'
far='if .object == null then 100 else .object.from_truth.far * 100 end'
panels=(noise plate rod)
for program in "${programs[@]}"; do
  rows "$program" '^ball --sigma 1 --noise (?<x>[0-9.]+)$' "$score" >"$data/noise-$program"
  rows "$program" '^plate:(?<x>[0-9.]+) --sigma 0.5( --noise 0)?$' "$far" >"$data/plate-$program"
  rows "$program" '^rod:(?<x>[0-9.]+) --sigma 0.5( --noise 0)?$' "$far" >"$data/rod-$program"
done

# curves PANEL: what to plot of it.
curves() {
  local i list=
  for i in "${!programs[@]}"; do
    [ -s "$data/$1-${programs[i]}" ] || continue
    list+="${list:+, }'$data/$1-${programs[i]}' with linespoints lt $((i + 1)) pt $((i + 4)) title '${titles[i]}'"
  done
  echo "plot ${list:-NaN notitle}"
}

[ -n "$(find "$data" -type f -size +0)" ] || exit 0
gnuplot <<PLOT
set terminal png font ',11' size 1200, 420
set output '$to/accuracy.png'
set multiplot layout 1, ${#panels[@]}
set grid y; set tics nomirror
set linetype 1 lc rgb '#0072b2' lw 3; set linetype 2 lc rgb '#e69f00'
set linetype 3 lc rgb '#009e73'; set linetype 4 lc rgb '#999999'; set linetype 5 lc rgb '#cc79a7'
set key top left
set title 'ball of radius 20, blur 1: RMS, voxels'
set xlabel 'noise, of the contrast'
set logscale y
set yrange [0.005:10]; set xrange [-0.02:0.22]
$(curves noise)
unset logscale y
unset key
set title 'plate, blur 0.5: farther than 1/2 voxel, %'
set xlabel 'thickness, voxels'
set yrange [0:105]; set xrange [0:4.5]
$(curves plate)
set title 'rod, blur 0.5: farther than 1/2 voxel, %'
set xlabel 'diameter, voxels'
$(curves rod)
PLOT
