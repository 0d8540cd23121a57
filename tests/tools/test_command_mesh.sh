#!/usr/bin/env bash
# pellicle info and mesh; and of extract what is a region, kept, told by the image, or a preset.
#   tests/tools/test_command_mesh.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

json() { jq -r "$2" "$1"; }
is() { [ "$2" = "$3" ] || fails "$1: $2, not $3"; }
near() {  # WHAT FOUND EXPECTED TOLERANCE
  awk -v a="$2" -v b="$3" -v t="$4" 'BEGIN {exit !(a - b <= t && b - a <= t)}' || fails "$1: $2, not $3"
}
valid() { works "check of $1" 0 "$pellicle" check "$1"; }
info() { "$pellicle" info --json "$2" | jq -r "$1"; }

works "phantom" 0 "$pellicle" phantom blobs --size 40 --seed 7 --spacing 0.5,1,2 --type i16 -o blobs.nrrd
LC_ALL=C sed -i 's/^space origin.*/space origin: (10,-20,30)/' blobs.nrrd

# ---- info
works "info of an image" 0 "$pellicle" info blobs.nrrd
for line in "^image +blobs.nrrd" "^voxels +40 x 40 x 40 of i16" "^axes +LPS \(x to the left, y to the back" \
  "^spacing +0.5 x 1 x 2 mm" "^origin +10, -20, 30 mm" "^  lps +10, -20, 30 .. 29.5, 19, 108 mm" \
  "^  ras +-29.5, -19, 30 .. -10, 20, 108 mm" "^  voxel +0, 0, 0 .. 39, 39, 39" "^range +" \
  "^percentiles +p1 .* p50 .* p99 " "^otsu +[0-9.]+$"; do
  says "info of an image" "$line" stdout
done
[ ! -s stderr ] || fails "info of an image: tells something on stderr"
works "info of an image as JSON" 0 "$pellicle" info blobs.nrrd --json
for key in image dims type axes obliquity spacing origin direction bounds lps ras voxel range not_finite \
  percentiles p95 otsu; do
  says "JSON of an image" "\"$key\":" stdout
done
jq -e . stdout >/dev/null || fails "info --json is no JSON"
refused "info of nothing" "missing.nrrd" "$pellicle" info missing.nrrd
refused "info of no known kind" "words.txt" "$pellicle" info words.txt
refused "info with no frame" "nifti-frame" "$pellicle" info blobs.nrrd --nifti-frame mni

otsu=$(info .otsu blobs.nrrd)
"$pellicle" info --json blobs.nrrd >info.json
python3 - info.json blobs.nrrd <<'END' || fails "info tells other percentiles than those of the voxels"
import json, struct, sys
data = open(sys.argv[2], 'rb').read().split(b'\n\n', 1)[1]
values = sorted(struct.unpack(f'<{40 ** 3}h', data))
told = json.load(open(sys.argv[1]))['percentiles']
# The least value that so many percent of the voxels do not exceed.
true = {f'p{p}': values[max(0, -(-len(values) * p // 100) - 1)] for p in (1, 5, 25, 50, 75, 95, 99)}
if told != true: print(told, true)
sys.exit(told != true)
END

# ---- --iso otsu and percentiles
works "--iso otsu" 0 "$pellicle" extract blobs.nrrd --iso otsu -o all.ply --report all.json
says "--iso otsu is told" "^iso      .* \(otsu\)$" stdout
is "--iso otsu" "$(json all.json .parameters.iso)" "$otsu"
is "--iso otsu in the report" "$(json all.json .iso_from)" otsu
is "the report's file" "$(json all.json .input.file)" blobs.nrrd
is "the report's space" "$(json all.json .parameters.space)" lps
is "the report's origin" "$(json all.json '.input.origin | map(tostring) | join(",")')" 10,-20,30
is "the report's direction" "$(json all.json '.input.direction | length')" 9
works "the same by its value" 0 "$pellicle" extract blobs.nrrd --iso "$otsu" --quiet -o out/same.ply
cmp -s all.ply out/same.ply || fails "--iso otsu is not its value"
works "several isos" 0 "$pellicle" extract blobs.nrrd --iso otsu,p95,500 --quiet -o out/i.ply
is "names of several isos" "$(cd out && echo i-*)" "i-500.ply i-otsu.ply i-p95.ply"
works "a structure by percentile" 0 "$pellicle" extract blobs.nrrd --structure core="--iso p95" \
  --structure all="--iso otsu" --quiet -o out/s.ply
cmp -s out/s-all.ply all.ply || fails "--structure all=--iso otsu is not --iso otsu"
left_over >/dev/null
for value in p p101 p-1 pX otsu2 ''; do
  refused "--iso '$value'" "iso.*percentiles" "$pellicle" extract blobs.nrrd --iso "$value" -o out/a.ply
done
refused "otsu of a gradient" "iso otsu.*image itself" "$pellicle" extract blobs.nrrd --iso otsu \
  --feature gradient-norm -o out/a.ply
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n'; head -c 512 /dev/zero; } >flat.nrrd
refused "otsu of one value" "iso otsu.*same" "$pellicle" extract flat.nrrd --iso otsu -o out/a.ply

# ---- info of a mesh
works "info of a mesh" 0 "$pellicle" info all.ply
is "lines of info of a mesh" "$(wc -l <stdout)" 5
for line in "^mesh +all.ply: [0-9]+ vertices, [0-9]+ faces, in LPS" "^valid +yes" \
  "^shape +[0-9]+ components?, genus [0-9]+, area .*, volume" "^bounds " "^edges +.* mean "; do
  says "info of a mesh" "$line" stdout
done
printf 'OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n' >open.off
works "info of an open mesh" 0 "$pellicle" info open.off
says "info of an open mesh" "^valid +no: 3 border edges" stdout
says "info of an open mesh" "^shape .* genus not defined" stdout
refused "info of a format that is not read" "written only" "$pellicle" info a.glb
near "volume by info and by the report" "$(info .volume all.ply)" "$(json all.json .surface.volume)" 0.1

# ---- --box: what is outside might not be there
works "--box" 0 "$pellicle" extract blobs.nrrd --iso 400 --box 3,30,0,39,10,35 --quiet -o box.ply \
  --report box.json
valid box.ply
is "the report's box" "$(json box.json '.input.box | map(tostring) | join(",")')" 3,30,0,39,10,35
is "dims in the report" "$(json box.json '.input.dims | map(tostring) | join(",")')" 28,40,26
near "x of the box" "$(info '.bounds.low[0] >= 11 and .bounds.high[0] <= 25.5' box.ply | grep -c true)" 1 0
near "z of the box" "$(info '.bounds.low[2] >= 48 and .bounds.high[2] <= 102' box.ply | grep -c true)" 1 0
works "--box in voxels" 0 "$pellicle" extract blobs.nrrd --iso 400 --box 3,30,0,39,10,35 --space voxel \
  --quiet -o voxels.ply
near "voxels of the whole image" "$(info '.bounds.low[2]' voxels.ply)" \
  "$(info '(.bounds.low[2] - 30) / 2' box.ply)" 1e-3
works "the box in LPS again" 0 "$pellicle" mesh voxels.ply --space lps --image blobs.nrrd -o out/again.ply
near "voxels and mm" "$(info '.bounds.high[0]' out/again.ply)" "$(info '.bounds.high[0]' box.ply)" 1e-3
near "voxels and mm" "$(info '.volume' out/again.ply)" "$(info '.volume' box.ply)" 0.5
works "a start in a box, in voxels" 0 "$pellicle" extract blobs.nrrd --iso 400 --box 3,30,0,39,10,35 \
  --space voxel --init mesh=voxels.ply --levels 0 --quiet -o out/start.ply
near "a start in a box" "$(info '.volume' out/start.ply)" "$(info '.volume' voxels.ply)" 20
works "a mask in a box" 0 "$pellicle" extract blobs.nrrd --iso 400 --box 3,30,0,39,10,35 \
  --init mask=blobs.nrrd --levels 0 --quiet -o out/mask.ply
works "otsu of a box" 0 "$pellicle" extract blobs.nrrd --iso otsu --box 3,30,0,39,10,35 -o out/o.ply
if grep -q "^iso      $(printf '%.6g' "$otsu") " stdout; then fails "otsu of a box is that of the image"; fi
left_over >/dev/null
for box in 3,30,0,39,10 3,30,0,39,10,40 -1,30,0,39,10,35 5,5,0,39,10,35 a,30,0,39,10,35; do
  refused "--box $box" "box" "$pellicle" extract blobs.nrrd --iso 400 --box=$box -o out/a.ply
done
refused "--box of labels" "box" "$pellicle" extract --labels blobs.nrrd --box 0,9,0,9,0,9 -o out/a.ply

# ---- --keep
bodies() { "$pellicle" measure "$1" --json out/m.json >/dev/null && json out/m.json .component_count; }
works "several bodies" 0 "$pellicle" phantom sierpinski --size 30 -o sponge.nrrd
works "several bodies" 0 "$pellicle" extract blobs.nrrd --iso 600 --quiet -o parts.ply
[ "$(bodies parts.ply)" -ge 3 ] || fails "the test needs a surface of three bodies"
works "--keep largest" 0 "$pellicle" extract blobs.nrrd --iso 600 --keep largest -o one.ply --report one.json
says "--keep is told" "^kept     1 of [0-9]+ bodies$" stdout
valid one.ply
is "--keep largest" "$(bodies one.ply)" 1
near "the kept volume" "$(json one.json .surface.volume)" "$(info .volume one.ply)" 0.1
is "--keep in the report" "$(json one.json .keep.kept)" 1
works "mesh --keep largest" 0 "$pellicle" mesh parts.ply --keep largest -o out/one.ply
is "both keep the same" "$(info .volume out/one.ply)" "$(info .volume one.ply)"
works "--keep 2" 0 "$pellicle" mesh parts.ply --keep 2 -o out/two.ply
is "--keep 2" "$(bodies out/two.ply)" 2
volume=$(info .volume one.ply)
works "--keep by volume" 0 "$pellicle" mesh parts.ply --keep "$(awk -v v="$volume" 'BEGIN {print v - 1}')mm3" \
  -o out/large.ply
is "--keep by volume" "$(bodies out/large.ply)" 1
works "--keep in voxels, by mm3" 0 "$pellicle" extract blobs.nrrd --iso 600 --space voxel \
  --keep "$(awk -v v="$volume" 'BEGIN {print v - 1}')mm3" --quiet -o out/voxel.ply
is "--keep in voxels, by mm3" "$(bodies out/voxel.ply)" 1
left_over >/dev/null
for keep in 0 -1 2.5 smallest mm3 -3mm3 5mm; do
  refused "--keep $keep" "keep" "$pellicle" mesh parts.ply --keep=$keep -o out/a.ply
  refused "extract --keep $keep" "keep" "$pellicle" extract blobs.nrrd --iso 600 --keep=$keep -o out/a.ply
done
refused "--keep of none" "none of the" "$pellicle" extract blobs.nrrd --iso 600 --keep 1e9mm3 --quiet -o out/a.ply
works "--keep all" 0 "$pellicle" mesh parts.ply --keep all -o out/all.ply
cmp -s parts.ply out/all.ply || fails "mesh --keep all is not all"
works "extract --keep all" 0 "$pellicle" extract blobs.nrrd --iso 600 --keep all --quiet -o out/all.ply
cmp -s parts.ply out/all.ply || fails "extract --keep all is not all"
works "a start with all bodies" 0 "$pellicle" extract blobs.nrrd --iso 600,590 --quiet -o out/f.ply --report out/f.json
is "a start from a file" "$(json out/f-590.json .parameters.init)" "mesh=out/f-600.ply"
works "a start of which the file has less" 0 "$pellicle" extract blobs.nrrd --iso 600,590 --keep largest --quiet \
  -o out/k.ply --report out/k.json
is "a start of which the file has less" "$(json out/k-590.json .parameters.init)" "surface of 600 before --keep"
is "the first has none" "$(json out/k-600.json .parameters.init)" iso
works "--init auto" 0 "$pellicle" extract blobs.nrrd --iso 600 --init auto --quiet -o out/a.ply --report out/a.json
is "--init auto is the default" "$(json out/a.json .hash)" "$(json out/f-600.json .hash)"
echo "pin 20 0 60 3" > pin.txt
works "a start with places" 0 "$pellicle" extract blobs.nrrd --iso 600 --attach pin.txt --quiet -o out/p.ply \
  --report out/p.json
is "a start with places" "$(json out/p.json '.parameters | "\(.init) \(.levels)"')" "bubble 3"
is "it starts from all bodies" "$(json out/k-590.json .hash)" "$(json out/f-590.json .hash)"
left_over >/dev/null
refused "mesh --keep of none" "--keep leaves none" "$pellicle" mesh parts.ply --keep 1e9mm3 -o out/a.ply
refused "--keep of an open mesh" "open.off: is not a valid" "$pellicle" mesh open.off --keep largest -o out/a.ply

# ---- mesh: a ball in a shell beside another ball, of cubes
cube() {  # LOW HIGH [inward]: faces of a cube
  awk -v l="$1" -v h="$2" -v turned="${3:-}" 'BEGIN {
    print "OFF\n8 12 0"
    for (i = 0; i < 8; ++i) print (i % 2 ? h : l), (int(i / 2) % 2 ? h : l), (i > 3 ? h : l)
    n = split("0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5", v, " ")
    for (i = 1; i <= n; i += 3) print 3, v[i], turned ? v[i + 2] : v[i + 1], turned ? v[i + 1] : v[i + 2]
  }'
}
cube 0 10 >outer.off
cube 3 7 inward >cavity.off
cube 4 6 >core.off
cube 20 21 >small.off
cube 8 15 >across.off
valid outer.off
works "an outer wall alone" 1 "$pellicle" check cavity.off
merge() { "$pellicle" mesh --merge "$@"; }
works "merge of a wall" 0 merge outer.off cavity.off core.off small.off -o nested.ply
[ ! -s stderr ] || fails "merge of a wall: told to be invalid, though it is not"
valid nested.ply
is "labels" "$(info '.values | join(",")' nested.ply)" Label
works "crop" 0 "$pellicle" mesh nested.ply --crop 4,5,4,5,4,5 -o out/core.ply
is "what is cropped to" "$(info .volume out/core.ply)" 8
works "the largest has its cavity" 0 "$pellicle" mesh nested.ply --keep largest -o out/shell.ply
near "the largest has its cavity" "$(info .volume out/shell.ply)" 936 1e-6
valid out/shell.ply
works "crop and keep" 0 "$pellicle" mesh nested.ply --crop 0,11,0,11,0,11 --keep 2 -o out/two.vtp
near "crop and keep" "$(info .volume out/two.vtp)" 944 1e-6
is "values stay" "$(info '.values | join(",")' out/two.vtp)" Label
left_over >/dev/null
refused "crop to what is too small" "--keep leaves none" "$pellicle" mesh nested.ply --crop 0,11,0,11,0,11 \
  --keep 1e6mm3 -o out/a.ply
refused "crop to nothing, and keep" "--crop leaves none" "$pellicle" mesh nested.ply --crop 100,101,0,1,0,1 \
  --keep largest -o out/a.ply
refused "crop to nothing" "--crop leaves none" "$pellicle" mesh nested.ply --crop 100,101,0,1,0,1 -o out/a.ply
refused "crop of no box" "crop" "$pellicle" mesh nested.ply --crop 5,4,0,1,0,1 -o out/a.ply
refused "a merge that would meet" "outer.off and across.off: not merged.*meet" merge outer.off across.off -o out/a.ply
refused "a merge of one in another" "not merged.*inside" merge outer.off core.off -o out/a.ply
refused "a merge of the same" "not merged" merge outer.off outer.off -o out/a.ply
refused "two meshes" "small.off: a second mesh; --merge" "$pellicle" mesh outer.off small.off -o out/a.ply
works "labels in no format for them" 0 merge outer.off small.off -o out/m.stl
says "labels in no format for them" "out/m.stl: its format holds no values at vertices: without Label" stderr
valid out/m.stl
works "an open mesh is converted" 0 "$pellicle" mesh open.off -o out/open.ply
says "an open mesh is told" "out/open.ply: is not a valid surface, as it was" stderr
left_over >/dev/null
refused "mesh of no known kind" "unknown format" "$pellicle" mesh outer.off -o out/a.xyz
refused "mesh in no folder" "missing" "$pellicle" mesh outer.off -o missing/a.ply
left_over >/dev/null

# ---- spaces
works "to RAS" 0 "$pellicle" mesh all.ply --space ras -o ras.ply
is "RAS is named" "$(info .space ras.ply)" RAS
near "RAS" "$(info '.bounds.low[0]' ras.ply)" "$(info '-.bounds.high[0]' all.ply)" 0
works "a distance between spaces" 0 "$pellicle" measure all.ply --distance ras.ply --json out/d.json
near "a distance between spaces" "$(json out/d.json .distance.hausdorff)" 0 1e-9
works "and back, without --space as it is" 0 "$pellicle" mesh ras.ply --space lps -o out/back.ply
cmp -s out/back.ply all.ply || fails "LPS to RAS and back is another file"
works "a start in another space" 0 "$pellicle" extract blobs.nrrd --iso "$otsu" --init mesh=ras.ply --levels 0 \
  --quiet -o out/start.ply
near "a start in another space" "$(info .volume out/start.ply)" "$(info .volume all.ply)" 30
left_over >/dev/null
refused "voxels without an image" "only its image" "$pellicle" mesh all.ply --space voxel -o out/a.ply
refused "a distance from mm to voxels" "voxels.ply: is in voxel.*only its image" "$pellicle" measure all.ply --distance voxels.ply
# A mesh that names no space is in LPS, whichever of the two it is.
works "no named space" 0 "$pellicle" mesh all.ply -o plain.off
works "a distance from no named space" 0 "$pellicle" measure plain.off --distance ras.ply --json out/d.json
near "a distance from no named space" "$(json out/d.json .distance.hausdorff)" 0 1e-3
works "a distance to no named space" 0 "$pellicle" measure ras.ply --distance plain.off --json out/d.json
near "a distance to no named space" "$(json out/d.json .distance.hausdorff)" 0 1e-3
left_over >/dev/null
refused "a distance from no named space to voxels" "voxels.ply: is in voxel.*only its image" \
  "$pellicle" measure plain.off --distance voxels.ply
refused "a distance from voxels to no named space" "plain.off: names no space.*LPS" \
  "$pellicle" measure voxels.ply --distance plain.off
works "voxels" 0 "$pellicle" mesh all.ply --space voxel --image blobs.nrrd -o out/voxel.ply
valid out/voxel.ply
near "voxels" "$(info '.bounds.low[0]' out/voxel.ply)" "$(info '(.bounds.low[0] - 10) / 0.5' all.ply)" 1e-4
works "--from" 0 "$pellicle" mesh outer.off --from ras --space lps -o out/lps.ply
is "--from" "$(info '.bounds.low[0]' out/lps.ply)" -10
left_over >/dev/null
refused "--from nowhere" "from" "$pellicle" mesh outer.off --from mni -o out/a.ply
left_over >/dev/null

# ---- every format, from a surface and back; what it cannot hold
for suffix in stl ply obj off vtp vtk surf.gii; do
  works "extract to .$suffix" 0 "$pellicle" extract blobs.nrrd --iso 400 --quiet -o "out/a.$suffix"
  valid "out/a.$suffix"
  near "volume of .$suffix" "$(info .volume "out/a.$suffix")" "$(info .volume out/a.stl)" 1e-2
done
left_over >/dev/null
for suffix in glb 3mf; do
  works "extract to .$suffix" 0 "$pellicle" extract blobs.nrrd --iso 400 --quiet -o "out/a.$suffix"
  mv "out/a.$suffix" .
  refused "read of .$suffix" "written only" "$pellicle" check "a.$suffix"
done
works "two isos to .surf.gii" 0 "$pellicle" extract blobs.nrrd --iso 400,500 --quiet -o out/i.surf.gii
is "names of .surf.gii" "$(cd out && echo i-*)" "i-400.surf.gii i-500.surf.gii"
LC_ALL=C sed 's/^space origin.*/space origin: (1e7,1e7,1e7)/' blobs.nrrd >far.nrrd
left_over >/dev/null
for suffix in glb surf.gii; do
  refused "doubles in .$suffix" "not written: this format has no doubles" "$pellicle" extract far.nrrd \
    --iso 400 --quiet -o "out/a.$suffix"
done
for suffix in vtk 3mf; do
  works "doubles in .$suffix" 0 "$pellicle" extract far.nrrd --iso 400 --quiet -o "out/a.$suffix"
  says "doubles in .$suffix" "written in double precision" stderr
done
valid out/a.vtk
works "doubles from .vtk" 0 "$pellicle" mesh out/a.vtk -o out/b.ply
valid out/b.ply
left_over >/dev/null

# ---- --quality
works "--quality draft" 0 "$pellicle" extract blobs.nrrd --iso 400 --quality draft --quiet -o out/d.ply --report out/d.json
is "draft" "$(json out/d.json '.parameters | "\(.late_bubbles) \(.epsilon) \(.mesh)"')" "false 0.0001 uniform"
works "--quality normal" 0 "$pellicle" extract blobs.nrrd --iso 400 --quality normal --quiet -o out/n.ply
works "no quality" 0 "$pellicle" extract blobs.nrrd --iso 400 --quiet -o out/m.ply
cmp -s out/n.ply out/m.ply || fails "--quality normal is not the default"
works "an option on top" 0 "$pellicle" extract blobs.nrrd --iso 400 --mesh adaptive --epsilon 1e-3 --quality draft --quiet \
  -o out/f.ply --report out/f.json
is "an option on top, whatever stands first" "$(json out/f.json '.parameters | "\(.epsilon) \(.mesh)"')" "0.001 adaptive"
left_over >/dev/null
preset_of() { json "out/s-$1.json" '.parameters | "\(.late_bubbles) \(.epsilon) \(.mesh)"'; }
works "presets of structures" 0 "$pellicle" extract blobs.nrrd --quality draft --mesh adaptive --quiet -o out/s.ply \
  --report out/s.json --structure a="--iso 400 --quality normal" --structure b="--iso 400 --spring 0.1 --mesh auto" \
  --structure c="--iso 400" --structure d="--iso 400 --quality draft --epsilon 1e-3"
is "normal in draft" "$(preset_of a)" "true 5e-06 adaptive"
is "springs in draft" "$(preset_of b)" "false 0.0001 uniform"
is "no preset in draft" "$(preset_of c)" "false 0.0001 adaptive"
is "an option on top in draft" "$(preset_of d)" "false 0.001 uniform"
left_over >/dev/null
refused "--quality best" "quality" "$pellicle" extract blobs.nrrd --iso 400 --quality best -o out/a.ply
left_over >/dev/null

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
