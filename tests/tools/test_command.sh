#!/usr/bin/env bash
# The command from outside: what it writes, and that every bad input gets one clear line on stderr,
# exit code 2 and no file.   tests/tools/test_command.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

extract() { refused "$1" "$2" "$pellicle" extract "${@:3}" -o out/mesh.ply; }

# The line names the option, as it is given or as the words of which it is made.
option() {
  local words=${1#--}
  extract "$*" "${words//-/.}" ball.nrrd --iso 0.5 "$@"
}

nrrd() {  # type, sizes, more header lines; the voxels come from stdin
  printf 'NRRD0004\ntype: %s\ndimension: %d\nsizes: %s\nendian: little\nencoding: %s\n\n' \
    "$1" "$(wc -w <<<"$2")" "$2" "${3:-raw}"
  cat
}

metaimage() {  # DimSize, channels
  printf 'ObjectType = Image\nNDims = 3\nDimSize = %s\nElementNumberOfChannels = %s\n' "$1" "$2"
  printf 'ElementType = MET_UCHAR\nElementDataFile = LOCAL\n'
  cat
}

inv3() {  # name, bytes of the matrix of 2 x 8 x 8
  mkdir -p project
  printf '%s' '<?xml version="1.0"?><plist version="1.0"><dict><key>matrix</key><dict>' \
    '<key>dtype</key><string>int16</string><key>filename</key><string>matrix.dat</string>' \
    '<key>shape</key><array><integer>2</integer><integer>8</integer><integer>8</integer></array>' \
    '</dict><key>orientation</key><integer>1</integer><key>spacing</key><array><real>1</real>' \
    '<real>1</real><real>2</real></array></dict></plist>' >project/main.plist
  head -c "$2" /dev/zero >project/matrix.dat
  tar cf "$1" project
}

zeros() { head -c "$1" /dev/zero; }

works "phantom" 0 "$pellicle" phantom blobs --size 24 --seed 7 -o ball.nrrd
works "phantom" 0 "$pellicle" phantom blobs --size 24 --seed 7 -o ball.mha

# ---- inputs that cannot be used
zeros 0 >empty.nrrd
echo "no image" >words.txt
echo "no image" >words.nrrd
head -c 2000 ball.nrrd >cut.nrrd
head -c 2000 ball.mha >cut.mha
head -c 30 ball.mha >cut_header.mha
zeros 64 | nrrd uint8 "8 8" >flat.nrrd
zeros 64 | nrrd uint8 "8 8 1" >slice.nrrd
zeros 64 | nrrd uint8 "8 0 8" >none.nrrd
zeros 1000 | nrrd uint8 "1000 1000 1000" >lying.nrrd
zeros 1000 | gzip -n | nrrd uint8 "100000 100000 10000" gzip >giant.nrrd
zeros 512 | nrrd uint8 "8 8 8" >constant.nrrd
zeros 1536 | metaimage "8 8 8" 3 >vectors.mha
{ zeros 2044; printf '\x00\x00\xc0\x7f'; } | nrrd float "8 8 8" >nan.nrrd
{ zeros 2044; printf '\x00\x00\x80\x7f'; } | nrrd float "8 8 8" >infinite.nrrd
inv3 short.inv3 200
inv3 cut_tar.inv3 256
head -c 1500 cut_tar.inv3 >cut.inv3
tar cf nothing.inv3 words.txt
mkdir no_images no_dicom
cp words.txt no_dicom/slice.dcm

extract "missing file" "missing.nrrd" missing.nrrd --iso 0.5
for file in empty.nrrd words.txt words.nrrd cut.nrrd cut.mha cut_header.mha flat.nrrd slice.nrrd \
  none.nrrd lying.nrrd vectors.mha short.inv3 cut.inv3 nothing.inv3 no_images no_dicom; do
  extract "$file" "$file" $file --iso 0.5
done
extract "more voxels than the file holds" "is truncated" giant.nrrd --iso 0.5
extract "constant image" "constant\|same value\|range" constant.nrrd --iso 0.5
extract "NaN voxels" "nan\|finite" nan.nrrd --iso 0.5
extract "infinite voxels" "inf\|finite" infinite.nrrd --iso 0.5
extract "iso above the range" "iso" ball.nrrd --iso 7
extract "iso below the range" "iso" ball.nrrd --iso -7

# ---- options
option --levels -3
option --levels 31
option --levels 2.5
option --reduction 1
option --reduction 2.5
option --level-iso 0.5,0.5 --levels 3
option --level-iso 0.5,x
extract "no bubbles" "bubbles" ball.nrrd --iso 0.5 --init bubbles=0,1,1
extract "bubbles in 2-D" "bubbles" ball.nrrd --iso 0.5 --init bubbles=3,3
option --init balloon
option --mass -1
option --mass 0
option --damping -1
option --time-step 0
option --time-step nan
option --max-move 0
option --max-move 2
option --bound wall
option --mesh fine
option --tolerance -1
option --edge-range 3,1
option --edge-range 0,1
extract "edges too short for the voxels" "must be a range within" ball.nrrd --iso 0.5 \
  --mesh adaptive --edge-range 0.001,1
extract "springs of an adaptive mesh" "no springs" ball.nrrd --iso 0.5 --mesh adaptive --spring 0.1
option --epsilon 0
option --max-iterations 0
option --curvature -1
option --curvature inf
option --spring -1
option --rest-length -1
option --rest-length long
option --attraction 0
option --window 1,0
option --window 1
option --pad nan
option --inside left
option --anisotropy none
option --space mni
option --threads 0
option --threads 1000000
option --simd mmx
option --colour blue
extract "report in no folder" "missing/report.json" ball.nrrd --iso 0.5 --report missing/report.json
extract "report that is the mesh" "twice" ball.nrrd --iso 0.5 --report out/mesh.ply
extract "no iso" "iso" ball.nrrd
extract "iso that is no number" "iso" ball.nrrd --iso bone
extract "iso that is not finite" "iso" ball.nrrd --iso nan

# ---- outputs
for output in out/mesh.xyz out/mesh missing/mesh.ply out; do
  refused "output $output" "$output" "$pellicle" extract ball.nrrd --iso 0.5 -o $output
done
mkdir folder.ply
# In millimetres of voxels that are eight times as long as wide a surface has more vertices than the
# image has voxels.
{
  printf 'NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 12\n'
  printf 'space directions: (1,0,0) (0,1,0) (0,0,8)\nspace origin: (0,0,0)\nencoding: raw\n\n'
  yes | head -c 1728 | tr 'y\n' '\0\310'
} >long.nrrd
works "a surface out of proportion" 0 "$pellicle" extract long.nrrd -o out/long.ply --iso 100 \
  --anisotropy physical --levels 0 --max-iterations 1
grep -q '^pellicle: expected: about .*, more than the image has voxels$' stderr ||
  fails "a surface out of proportion: is not told before it is made"
left_over >/dev/null
refused "a folder as output" "folder.ply" "$pellicle" extract ball.nrrd --iso 0.5 -o folder.ply
# A file may have 4 KiB: what is written meets the end of the room. So would the counts that a coverage
# build writes when it ends, which go elsewhere.
(ulimit -f 4; export GCOV_PREFIX=$PWD
  refused "no room" "mesh.ply" "$pellicle" extract ball.nrrd --iso 0.5 --quiet -o out/mesh.ply
  exit "$failures")
failures=$?

# ---- the other commands
works "surface" 0 "$pellicle" extract ball.nrrd --iso 0.5 --quiet -o surface.ply
head -c 1000 surface.ply >cut.ply
cp words.txt words.stl
refused "no name of an output" "--output: the name of a file is empty" \
  "$pellicle" extract ball.nrrd --iso 0.5 -o ""
extract "no name of a report" "--report: the name of a file is empty" ball.nrrd --iso 0.5 --report ""
extract "no name of a mask" "--init" ball.nrrd --iso 0.5 --init mask=
refused "no name of labels" "--labels: the name of a file is empty" \
  "$pellicle" extract --labels "" -o out/mesh.ply
refused "no name of a picture" "the name of a file is empty" "$pellicle" render surface.ply -o ""
refused "no command" "subcommand" "$pellicle"
refused "unknown command" "carve" "$pellicle" carve
refused "check of a missing mesh" "missing.ply" "$pellicle" check missing.ply
for file in cut.ply words.stl words.txt; do
  refused "check of $file" "$file" "$pellicle" check $file
  refused "render of $file" "$file" "$pellicle" render $file -o out/picture.png
done
refused "picture of no known kind" "png" "$pellicle" render surface.ply -o out/picture.jpg
refused "picture of no size" "size" "$pellicle" render surface.ply --size 0 -o out/picture.png
refused "picture in no folder" "missing" "$pellicle" render surface.ply -o missing/picture.png
refused "unknown phantom" "cube" "$pellicle" phantom cube -o out/volume.nrrd
refused "phantom of no size" "no voxels" "$pellicle" phantom chain --size 0 -o out/volume.nrrd
refused "phantom of no known kind" "volume.png" "$pellicle" phantom chain -o out/volume.png
refused "phantom with negative noise" "noise" "$pellicle" phantom shell --noise -1 -o out/v.nrrd

printf 'OFF\n4 4 0\n0 0 0\n3 0 0\n0 4 0\n0 0 12\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >tetra.off
printf 'OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n' >points.off
printf 'OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n' >nan.off
measure() { refused "measure: $1" "$2" "$pellicle" measure "${@:3}"; }
measure "no mesh" "MESH"
measure "missing mesh" "missing.ply" missing.ply
measure "mesh cut short" "cut.ply" cut.ply
measure "NaN in a mesh" "vertex 0: z" nan.off
measure "other mesh missing" "missing.ply" tetra.off --distance missing.ply
measure "other mesh without faces" "points.off" tetra.off --distance points.off
measure "NaN in the other mesh" "other mesh: vertex 0" tetra.off --distance nan.off
measure "distance of points" "points.off" points.off --distance tetra.off
measure "vertex that is not there" "geodesic-vertex" tetra.off --geodesic-vertex 4
measure "negative vertex" "geodesic-vertex" tetra.off --geodesic-vertex -1
measure "vertex that is no number" "geodesic-vertex" tetra.off --geodesic-vertex top
measure "point of two numbers" "geodesic" tetra.off --geodesic 1,2
measure "point that is not finite" "geodesic" tetra.off --geodesic 1,2,inf
measure "point near no face" "points.off" points.off --geodesic 1,2,3
measure "point and vertex" "geodesic" tetra.off --geodesic 1,2,3 --geodesic-vertex 0
measure "negative components" "components" tetra.off --components -1
for suffix in stl obj off; do
  measure "values in .$suffix" "no values" tetra.off --curvature -o "out/mesh.$suffix"
done
measure "values of no kind" "nothing to write" tetra.off -o out/mesh.ply
measure "mesh of no known kind" "xyz" tetra.off --curvature -o out/mesh.xyz
measure "mesh in no folder" "missing" tetra.off --curvature -o missing/mesh.ply
measure "JSON in no folder" "missing/m.json" tetra.off --json missing/m.json
measure "JSON that is the mesh" "both" tetra.off --curvature -o out/mesh.ply --json out/mesh.ply

# ---- what works
works "--version" 0 "$pellicle" --version
works "--help" 0 "$pellicle" extract --help
for name in iso level-iso inside levels reduction init curvature spring rest-length attraction mass \
  damping time-step max-move mesh tolerance edge-range bound epsilon max-iterations window pad threads simd report quiet; do
  says "help of extract" "--$name" stdout
done
works "--mesh adaptive" 0 "$pellicle" extract ball.mha --iso 0.5 --mesh adaptive --tolerance 0.1 \
  --edge-range 0.5,4 -o out/mesh.ply --report out/adaptive.json
says "report of --mesh adaptive" '"mesh": "adaptive"' out/adaptive.json
says "report of --tolerance" '"tolerance": 0.1' out/adaptive.json
works "check of an adaptive mesh" 0 "$pellicle" check out/mesh.ply
works "--no-sleeping" 0 "$pellicle" extract ball.mha --iso 0.5 --no-sleeping -o out/mesh.ply \
  --report out/flag.json
says "report of --no-sleeping" '"sleeping": false' out/flag.json
works "check with --no-sleeping" 0 "$pellicle" check out/mesh.ply
for suffix in stl ply obj off vtp PLY; do
  works "extract to .$suffix" 0 "$pellicle" extract ball.mha --iso 0.5 -o "out/mesh.$suffix"
  works "check of .$suffix" 0 "$pellicle" check "out/mesh.$suffix"
  says "check of .$suffix" "^valid +yes" stdout
done
works "same surface" 0 "$pellicle" extract ball.nrrd --iso 0.5 --threads 3 --quiet -o out/again.ply
if [ -s stdout ] || [ -s stderr ]; then fails "--quiet: not quiet"; fi
cmp -s out/again.ply out/mesh.ply || fails "the surface depends on threads or container"
for space in lps ras voxel; do
  works "--space $space" 0 "$pellicle" extract ball.nrrd --iso 0.5 --space $space -o out/s.ply
  works "check in $space" 0 "$pellicle" check out/s.ply
done
works "--report" 0 "$pellicle" extract ball.nrrd --iso 0.5 -o out/r.ply --report out/r.json
for key in pellicle input dims spacing range parameters levels level unit delta iterations vertices \
  converged energy seconds topology normals dynamics total operations creation inversion deletion \
  annular axial tetrahedron refinement surface faces components euler genus area volume read \
  pyramid evolution write peak_rss_bytes threads simd; do
  says "report" "\"$key\":" out/r.json
done
says "report" '"hash": "[0-9a-f]{16}"' out/r.json
works "--level-iso" 0 "$pellicle" extract ball.nrrd --iso 0.5 --window 0,1 --levels 1 --level-iso 0.45,0.5 \
  -o out/r.ply --report out/r.json
tr -d ' \n' <out/r.json | grep -q '"level_iso":\[0.45,0.5\]' || fails "--level-iso: the report has another order"
says "report without frozen sites" '"sites": \[\]' out/r.json
works "--max-iterations" 0 "$pellicle" extract ball.nrrd --iso 0.5 --levels 0 --max-iterations 3 --quiet -o out/r.ply
says "an end by the most iterations" "^pellicle: level 0 did not come to rest within --max-iterations 3$" stderr
works "phantom" 0 "$pellicle" phantom sierpinski -o sites.nrrd --size 27
works "frozen sites" 0 "$pellicle" extract sites.nrrd --iso 128 --mesh uniform -o out/r.ply --report out/r.json
says "frozen sites" "^level 0 .*, [0-9]+ sites of [0-9]+ vertices frozen$" stdout
says "report of frozen sites" '"place":' out/r.json
works "--each-level" 0 "$pellicle" extract ball.nrrd --iso 0.5 --levels 1 --each-level --quiet -o out/l.ply
for file in out/l-level1.ply out/l-level0.ply; do works "check of $file" 0 "$pellicle" check $file; done
cmp -s out/l.ply out/l-level0.ply || fails "--each-level: the last level's surface is not the result"
works "render" 0 "$pellicle" render surface.ply --size 64 -o out/picture.png
works "measure" 0 "$pellicle" measure tetra.off --curvature --geodesic 0,0,13 --distance surface.ply \
  -o out/m.vtp --json out/m.json
says "measure" "^area +78.5941 mm2" stdout
says "measure" "^volume +24 mm3" stdout
says "measure" "^centroid +0.75, 1, 3 mm" stdout
says "measure" "^  integral +12.5664$" stdout
says "measure" "^geodesic from +vertex 3 at 0, 0, 12 mm" stdout
says "measure" "^geodesic distance +at most 12.64" stdout
for key in mesh unit whole components component_count vertices faces euler genus area volume low \
  high centroid second_moments principal_moments principal_axes curvature mean gaussian integral \
  geodesic reached farthest distance to_other from_other rms max hausdorff; do
  says "JSON of measure" "\"$key\":" out/m.json
done
for name in MeanCurvature GaussianCurvature Geodesic Distance; do
  says "values in .vtp" "Name=\"$name\"" out/m.vtp
done
works "measure to .ply" 0 "$pellicle" measure surface.ply --geodesic-vertex 3 -o out/m.ply
says "values in .ply" "property float Geodesic" out/m.ply
for file in out/m.vtp out/m.ply; do works "check of $file" 0 "$pellicle" check $file; done
# Values that a mesh has brought are not written beside those that are asked for.
works "measure of what has been measured" 0 "$pellicle" measure out/m.ply --curvature -o out/again.ply
says "measure of what has been measured" "^property float MeanCurvature" out/again.ply
grep -q "^property float Geodesic" out/again.ply && fails "values of an earlier measure are written again"
works "components" 0 "$pellicle" measure surface.ply --components 2000000000 --json out/parts.json
works "an empty mesh" 0 "$pellicle" measure points.off --curvature --json out/points.json
says "an empty mesh" '"min": null' out/points.json
printf 'OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n' >open.off
works "an open mesh" 1 "$pellicle" check open.off
left_over >/dev/null

# ---- coordinates that floats do not hold, and that doubles do not
moved() {  # ORIGIN SPACING
  LC_ALL=C sed "s/^space origin.*/space origin: ($1,$1,$1)/
    s/^space directions.*/space directions: ($2,0,0) (0,$2,0) (0,0,$2)/" <ball.nrrd >moved.nrrd
}
works "near" 0 "$pellicle" extract ball.nrrd --iso 0.5 --quiet -o near.ply --report near.json
says "report of near" '"coordinates": "float"' near.json
for place in "1e7 1" "1e5 1e-6" "0 1e-25"; do
  read -r origin spacing <<<"$place"
  moved "$origin" "$spacing"
  for suffix in stl ply obj off vtp; do
    works "$place .$suffix" 0 "$pellicle" extract moved.nrrd --iso 0.5 --quiet -o "out/m.$suffix" \
      --report out/m.json
    [ "$spacing" = 1e-25 ] ||
      says "$place .$suffix" "^pellicle: out/m.$suffix: written in double precision" stderr
    [ "$spacing" = 1e-25 ] || says "report of $place" '"coordinates": "double"' out/m.json
    works "check of $place .$suffix" 0 "$pellicle" check "out/m.$suffix"
    works "measure of $place .$suffix" 0 "$pellicle" measure "out/m.$suffix"
    [ "$suffix" = ply ] || works "$place .$suffix" 0 "$pellicle" measure "out/m.$suffix" --curvature \
      -o out/again.ply
    [ "$suffix" = ply ] || works "check again of $place .$suffix" 0 "$pellicle" check out/again.ply
  done
done
moved 1e7 1
works "levels far away" 0 "$pellicle" extract moved.nrrd --iso 0.5 --levels 1 --each-level --quiet \
  -o out/l.ply
for file in out/l-level1.ply out/l-level0.ply; do works "check of $file" 0 "$pellicle" check $file; done
left_over >/dev/null
moved 1e6 1e-12
extract "beyond doubles" "out/mesh.ply: not written: .*--space voxel" moved.nrrd --iso 0.5 --quiet
extract "levels beyond doubles" "out/mesh-level1.ply: not written" moved.nrrd --iso 0.5 --levels 1 \
  --each-level --quiet
works "beyond doubles in voxels" 0 "$pellicle" extract moved.nrrd --iso 0.5 --quiet --space voxel \
  -o out/m.stl
works "check in voxels" 0 "$pellicle" check out/m.stl
left_over >/dev/null

# ---- stdout on a full disk
full_stdout() {  # COMMAND...
  local code=0
  "$@" >/dev/full 2>stderr </dev/null || code=$?
  if [ $code -ne 2 ]; then fails "$2 on a full stdout: exit code $code, not 2"; fi
  says "$2 on a full stdout" "^pellicle: standard output: cannot be written" stderr
}
for arguments in --help --version "extract --xml" "check open.off" "check --json open.off" \
  "measure points.off"; do
  read -ra words <<<"$arguments"
  full_stdout "$pellicle" "${words[@]}"
done
left_over >/dev/null

# ---- Ctrl-C
works "phantom" 0 "$pellicle" phantom sierpinski -o sponge.nrrd
for signal in INT HUP; do
  works "interrupted by SIG$signal" 130 timeout --preserve-status -s $signal 2 \
    "$pellicle" extract sponge.nrrd --iso 100 --levels 0 -o out/sponge.ply --report out/sponge.json
  says "interrupted by SIG$signal" "^pellicle: interrupted$" stderr
  left=$(left_over)
  if [ -n "$left" ]; then fails "interrupted by SIG$signal: leaves $left"; fi
done

# ---- a signal while a file is being written: of two files, the second one is a pipe that nobody reads
being_written() {  # N: ends once this one's temporary file of that number is there.
  mkfifo -m 600 out/a.mhd 2>/dev/null
  "$pellicle" phantom chain --size 24 -o out/a.mhd >stdout 2>stderr &
  writer=$!
  until [ -e "out/.a.raw.pellicle-$1" ] || ! kill -0 $writer 2>/dev/null; do sleep 0.01; done
}
for signal in INT TERM HUP PIPE; do
  being_written 0
  kill -s $signal $writer
  code=0
  wait $writer || code=$?
  if [ $code -ne 130 ]; then fails "SIG$signal while writing: exit code $code"; fi
  [ $signal = PIPE ] && expected="" || expected="pellicle: interrupted"
  if [ "$(cat stderr)" != "$expected" ]; then fails "SIG$signal while writing: not the line"; fi
  left=$(left_over)
  if [ "$left" != out/a.mhd ]; then fails "SIG$signal while writing: leaves $left"; fi
done
being_written 0
kill -s KILL $writer
wait $writer 2>/dev/null
rm out/a.mhd
if [ ! -e out/.a.raw.pellicle-0 ]; then fails "SIGKILL while writing: no leftover to take away"; fi
works "after SIGKILL" 0 "$pellicle" phantom chain --size 24 -o out/a.mhd
if [ "$(ls -A out | xargs)" != "a.mhd a.raw" ]; then fails "after SIGKILL: a leftover stays"; fi
left_over >/dev/null
being_written 0
first=$writer
being_written 1
if [ ! -e out/.a.raw.pellicle-0 ]; then fails "a file that another process writes is taken away"; fi
kill $first $writer
wait $first $writer 2>/dev/null
left_over >/dev/null
trap '' HUP  # as nohup does
being_written 0
kill -s HUP $writer
cat out/a.mhd >/dev/null
code=0
wait $writer || code=$?
trap - HUP
if [ $code -ne 0 ]; then fails "ignored SIGHUP: exit code $code"; fi
left_over >/dev/null

# ---- a reader of stdout that has gone
mkfifo pipe
exec 8<>pipe 9>pipe 8<&-
for arguments in --help "check open.off" "measure tetra.off --curvature -o out/m.ply"   "extract ball.nrrd --iso 0.5 --levels 0 -o out/m.ply"; do
  read -ra words <<<"$arguments"
  code=0
  "$pellicle" "${words[@]}" >&9 2>stderr || code=$?
  if [ $code -ne 130 ] || grep -v "^level" stderr; then fails "$arguments, nobody reads: exit code $code"; fi
  if [[ $arguments == *-o* ]]; then works "$arguments, nobody reads" 0 "$pellicle" check out/m.ply; fi
  left_over >/dev/null
done
exec 9>&-

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
