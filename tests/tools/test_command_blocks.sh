#!/usr/bin/env bash
# `blocks`: one surface in tasks, the same bytes in whatever order and by whatever process they are done.
#   tests/tools/test_command_blocks.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

bytes_of() { (cd "$1" && find . -name '*.blk' | sort | xargs cat | md5sum); }
value() { sed -nE "s/^$1 +(.*)/\1/p" stdout; }

"$pellicle" phantom chain --size 256 --type u8 -o chain.ome.zarr || fails phantom
plan=("$pellicle" blocks plan chain.ome.zarr --iso 127 --side 128 --from-level 0)
works plan 0 "${plan[@]}" -o a
says plan '^planned  2 x 2 x 2 blocks of 128 voxels, 8 steps, from [0-9]+ vertices' stdout
works run 0 "$pellicle" blocks run a
says run '^done     8 tasks' stdout
works "check" 0 "$pellicle" blocks check a
says check '^valid +yes' stdout
[ "$(value components)" = 2 ] && [ "$(value genus)" = 2 ] || fails "check: components or genus"
volume=$(value "volume voxels")
# Whole: 453,441 voxels.
awk -v v="$volume" 'BEGIN { exit !(v > 453000 && v < 454000) }' || fails "a volume of $volume"
works mesh 0 "$pellicle" blocks mesh a -o a.ply
works "the mesh" 0 "$pellicle" check a.ply
says "the mesh" '^genus +2' stdout
# Borders show nowhere: it is the surface of the whole image, as near as two that rest are.
works "the whole" 0 "$pellicle" extract chain.ome.zarr --iso 127 --mesh uniform -o whole.ply
works "distances" 0 "$pellicle" measure a.ply --distance whole.ply
for way in to from; do
  read -r mean most < <(sed -nE "s/^ *$way it +mean ([0-9.e-]+), RMS [^,]+, max ([0-9.e-]+) mm/\1 \2/p" stdout)
  awk -v mean="${mean:-9}" -v most="${most:-9}" 'BEGIN { exit !(mean < 0.02 && most < 0.2) }' ||
    fails "$way the whole surface: ${mean:-?} in the mean, ${most:-?} at most"
done
works again 0 "$pellicle" blocks run a
says again '^done     0 tasks' stdout

# One process for each share, the last first; threads; a process that is killed goes on.
works "the same plan" 0 "${plan[@]}" -o b --threads 1
{ timeout -s KILL 0.4 "$pellicle" blocks run b --threads 1; } >/dev/null 2>&1
for step in 0 1 2 3 4 5 6 7; do
  for share in 3 2 1; do
    works "share $share of step $step" 0 "$pellicle" blocks run b --step $step --task $share/3 --threads 1
  done
done
[ "$(bytes_of a)" = "$(bytes_of b)" ] || fails "other bytes in another order"
[ -z "$(find b -name '*.tmp*' -o -name '.*.blk*')" ] || fails "something half-written is left"

# What is in the way, is damaged or comes too early.
works "planned again" 0 "${plan[@]}" -o a
refused "another plan" "another plan" "$pellicle" blocks plan chain.ome.zarr --iso 100 --side 128 --from-level 0 -o a
rm -r b/level0/* && works "begun anew" 0 "$pellicle" blocks run b --step 0
refused "too early" "not there yet" "$pellicle" blocks run b --step 7
truncate -s -5 b/level0/0-0-0.blk
refused "a damaged file" "b/level0/0-0-0.blk" "$pellicle" blocks run b --step 1
rm b/level0/0-0-0.blk
works "the rest" 0 "$pellicle" blocks run b
[ "$(bytes_of a)" = "$(bytes_of b)" ] || fails "other bytes after damage"
refused "no plan" "plan.json" "$pellicle" blocks run out
refused "no such step" "has 8" "$pellicle" blocks run a --step 8
refused "shares without a step" "--step" "$pellicle" blocks run a --task 1/2
refused "small blocks" "--side 64: must be" "$pellicle" blocks plan chain.ome.zarr --iso 127 -o out/x --side 64 --from-level 0
refused "deep" "below --levels" "$pellicle" blocks plan chain.ome.zarr --iso 127 -o out/x --levels 1 --from-level 1
refused "no iso" "--iso" "$pellicle" blocks plan chain.ome.zarr -o out/x --from-level 0
"$pellicle" phantom chain --size 18 --type u8 -o tiny.mha || fails phantom
refused "nothing on coarse levels" "shows above level 0: it can only be extracted whole" \
  "$pellicle" blocks plan tiny.mha --iso 120 --levels 2 -o out/x --side 200 --from-level 0
"$pellicle" phantom chain --size 250 --type u8 -o other.ome.zarr
sed -i 's/chain.ome.zarr/other.ome.zarr/' b/plan.json
rm b/level0/1-1-1.blk
refused "another image" "not the image that was planned with" "$pellicle" blocks run b

exit $((failures > 0))
