#!/usr/bin/env bash
# pellicle simplify.
#   tests/tools/test_command_simplify.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

value() { "$pellicle" check "$1" | awk -v name="$2" '$1 == name { print $2 }'; }

"$pellicle" phantom blobs --size 48 --seed 3 -o blobs.nrrd >/dev/null
"$pellicle" extract blobs.nrrd --iso 0.5 --mesh uniform -o blobs.ply --quiet

works "simplify" 0 "$pellicle" simplify blobs.ply --tolerance 0.15 -o light.ply
says "simplify" "^surface +[0-9]+ of $(value blobs.ply vertices) vertices" stdout
says "simplify" "^distance at most 0.1[0-4][0-9]* from blobs.ply, at most 0.1[0-4][0-9]* from it" stdout
works "check of the result" 0 "$pellicle" check light.ply
[ $((3 * $(value light.ply vertices))) -lt "$(value blobs.ply vertices)" ] || fails "simplify leaves more than a third"
for what in components genus; do
  [ "$(value light.ply $what)" = "$(value blobs.ply $what)" ] || fails "simplify changes the $what"
done
# By samples, in both directions.
largest=$("$pellicle" measure light.ply --distance blobs.ply --json m.json >/dev/null && jq .distance.hausdorff m.json)
awk -v d="$largest" 'BEGIN { exit !(d > 0.1 && d <= 0.15) }' || fails "the result is $largest from the mesh"
works "the space" 0 "$pellicle" info light.ply
says "the space" "LPS" stdout
cp light.ply first.ply
works "again" 0 "$pellicle" simplify blobs.ply --tolerance 0.15 -o light.ply --quiet
if [ -s stdout ] || [ -s stderr ]; then fails "--quiet tells something"; fi
cmp -s light.ply first.ply || fails "simplify does not give the same bytes again"
works "one side" 0 "$pellicle" simplify blobs.ply --tolerance 0.15 --one-sided -o one.stl --quiet
works "check of one side" 0 "$pellicle" check one.stl

"$pellicle" measure blobs.ply --curvature -o curved.vtp >/dev/null
works "values at vertices" 0 "$pellicle" simplify curved.vtp --tolerance 0.15 -o light.ply
says "values at vertices" "without the values at vertices of curved.vtp" stderr

printf 'solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid x\n' >open.stl
refused "an open mesh" "edges have one face" "$pellicle" simplify open.stl --tolerance 1 -o out/a.ply
refused "no tolerance" "tolerance" "$pellicle" simplify blobs.ply -o out/a.ply
refused "a tolerance of 0" "tolerance" "$pellicle" simplify blobs.ply --tolerance 0 -o out/a.ply
refused "a tolerance that is none" "tolerance" "$pellicle" simplify blobs.ply --tolerance nan -o out/a.ply
refused "no mesh" "missing.ply" "$pellicle" simplify missing.ply --tolerance 1 -o out/a.ply
refused "an unknown format" "a.xyz" "$pellicle" simplify blobs.ply --tolerance 1 -o out/a.xyz
refused "no such folder" "none" "$pellicle" simplify blobs.ply --tolerance 0.2 -o out/none/a.ply

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
