#!/usr/bin/env bash
# extract --labels from outside: the surfaces of a phantom's labels do not overlap, neighbours are at
# most a voxel apart, and bad input gets one line.   tests/tools/test_command_labels.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

# All .off meshes given, as one.
union() {
  awk 'FNR == 1 { next }
    FNR == 2 { base = vertices; vertices += $1; faces += $2; last = $1 + 2; next }
    FNR <= last { points = points $0 "\n"; next }
    { corners = corners $1 " " $2 + base " " $3 + base " " $4 + base "\n" }
    END { printf "OFF\n%d %d 0\n%s%s", vertices, faces, points, corners }' "$@"
}

# The number of a mesh's components that `pellicle check` tells; fails unless it is valid.
components() {
  works "check of $1" 0 "$pellicle" check "$1"
  awk '/^components +[0-9]/ { print $2 }' stdout
}

# Of vertices of the first mesh to the second, the nearest one.
at_most_apart() {  # LIMIT MESH OTHER
  "$pellicle" measure "$2" --distance "$3" --json distance.json >stdout 2>stderr ||
    fails "distance of $2 to $3"
  awk -v limit="$1" '/"to_other"/ { at = 1 } at && /"max"/ { exit !($2 + 0 <= limit) }' \
    distance.json || fails "$2 is more than $1 away from $3"
}

# ---- a phantom with a label inside another, on voxels that are no cubes
works "phantom" 0 "$pellicle" phantom labels --size 36,36,24 --spacing 1,1,1.5 --count 3 -o cells.nrrd
works "labels" 0 "$pellicle" extract --labels cells.nrrd -o out/cell.off --report out/cell.json
if [ -s stderr ] && grep -q "left out" stderr; then fails "labels: one is left out"; fi
grep -q "^labels   4 written, 0 left out" stdout || fails "labels: not four are told"
found=$(cd out && echo cell-*)
expected="cell-1.json cell-1.off cell-2.json cell-2.off cell-3.json cell-3.off cell-4.json"
expected="$expected cell-4.off"
if [ "$found" != "$expected" ]; then fails "labels: wrote $found"; fi
parts=0
for label in 1 2 3 4; do
  own=$(components out/cell-$label.off)
  parts=$((parts + own))
  grep -q "\"value\": $label," out/cell-$label.json || fails "report of label $label"
done
if [ $parts -ne 5 ]; then fails "labels: $parts components, not four and a cavity"; fi
union out/cell-*.off >all.off
if [ "$(components all.off)" != "$parts" ]; then fails "the labels together: other components"; fi
for mesh in out/cell-[1-3].off; do
  [ "$(components "$mesh")" = 2 ] && shell=$mesh
done
at_most_apart 1.5 out/cell-4.off "${shell:-}"  # all of the inner label's surface is its neighbour's
find out -mindepth 1 -delete

# ---- one file of all with names and colours, and a table; volumes are those of the voxels
"$pellicle" phantom labels --size 40 --count 2 -o named.nrrd >stdout 2>stderr
printf '1 10 20 30 1 1 1 "first cell"\n2 0 0 255 1 1 1 "second"\n' >named.label
works "merged" 0 "$pellicle" extract --labels named.nrrd -o out/n.off --merged out/all.ply --table out/n.tsv
says "merged" '^label 1 \(first cell\) +[0-9]+ voxels: .* \(9[6-9]\.[0-9] %\): out/n-1.off$' stdout
says "merged" '^labels   3 written, 0 left out, .* neighbours 0.017 mm apart$' stdout
[ "$(LC_ALL=C grep -a '^comment label' out/all.ply | head -2 | paste -sd+)" = \
  "comment label 1 10 20 30 first cell+comment label 2 0 0 255 second" ] || fails "merged: no names in the .ply"
merged=$(components out/all.ply)
union out/n-*.off >all.off
[ "$(components all.off)" = "$merged" ] || fails "merged: $merged components"
awk -F'\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
  { ++rows; if ($at["of_voxels"] < 0.9 || $at["of_voxels"] > 1.02 || system("test -s " $at["file"]) != 0) exit 1 }
  $1 == 1 && ($2 != "first cell" || $3 != 10 || $5 != 30) { exit 1 }
  END { if (rows != 3) exit 1 }' out/n.tsv || fails "table: $(cat out/n.tsv)"
printf '1 other\n' >other.txt
works "merged alone" 0 "$pellicle" extract --labels named.nrrd --names other.txt --merged out/alone.vtp --quiet
components out/alone.vtp >/dev/null
find out -mindepth 1 -delete
refused "merged to .stl" "out/m.stl: --merged needs" "$pellicle" extract --labels named.nrrd --merged out/m.stl
echo nonsense >bad.txt
refused "bad names" "bad.txt: line 1" "$pellicle" extract --labels named.nrrd --names bad.txt -o out/x.ply
# A ball of radius 8, and one in a block of another label.
awk 'BEGIN { printf "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 44 22 22\nencoding: ascii\n\n"
  for (i = 0; i < 44 * 22 * 22; ++i) { x = i % 44; y = int(i / 44) % 22; z = int(i / 968)
    r = (y - 10.3) ^ 2 + (z - 10.6) ^ 2
    print ((x - 10.4) ^ 2 + r <= 64 ? 3 : (x - 32.2) ^ 2 + r <= 64 ? 2 : x > 21 && x < 43 && y * z > 0 && y < 21 && z < 21 ? 1 : 0) } }' >balls.nrrd
works "balls" 0 "$pellicle" extract --labels balls.nrrd --merged out/balls.vtp --table out/balls.tsv --quiet
awk -F'\t' 'NR > 1 { ++rows; if ($14 < 0.975 || $14 > 1.02) exit 1 } END { if (rows != 3) exit 1 }' out/balls.tsv ||
  fails "volumes are too far off: $(cat out/balls.tsv)"
find out -mindepth 1 -delete

# ---- the frame: voxel indices and mm of the whole image, whatever the crop
zeros() { local i; for ((i = 0; i < $1; ++i)); do printf '\0'; done; }
{
  printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nspace: left-posterior-superior\n'
  printf 'space directions: (0,2,0) (-2,0,0) (0,0,2)\nspace origin: (100,200,300)\n'
  printf 'encoding: raw\n\n'
  for z in $(seq 24); do
    for y in $(seq 24); do
      # A box of voxels 12 .. 21 x 10 .. 17 x 2 .. 5 (from 0).
      if [ "$z" -gt 2 ] && [ "$z" -le 6 ] && [ "$y" -gt 10 ] && [ "$y" -le 18 ]; then
        zeros 12; printf '\7\7\7\7\7\7\7\7\7\7'; zeros 2
      else zeros 24
      fi
    done
  done
} >box.nrrd
for space in voxel lps; do
  works "box in $space" 0 "$pellicle" extract --labels box.nrrd -o out/box.off --space $space --quiet
  "$pellicle" measure out/box-7.off 2>stderr | grep -E "^centroid" >centroid
  [ $space = voxel ] && expected="16.5 13.5 3.5" || expected="73 233 307"
  awk -v expected="$expected" '{ split(expected, e); gsub(",", "");
    for (i = 1; i <= 3; ++i) if (($(i + 1) - e[i]) ^ 2 > 0.01) exit 1 }' centroid ||
    fails "box in $space: $(cat centroid), not at $expected"
done
find out -mindepth 1 -delete

# ---- labels that meet at first are drawn apart
works "phantom" 0 "$pellicle" phantom labels --size 24 --count 14 --seed 3 -o rough.nrrd
works "rough" 0 "$pellicle" extract --labels rough.nrrd -o out/r.off --curvature 0 --max-iterations 100
grep -qE "^labels   15 written, 0 left out, [1-9]" stdout || fails "rough: none was tried again"
union out/r-*.off >all.off
components all.off >/dev/null
mkdir again
works "rough, threads" 0 "$pellicle" extract --labels rough.nrrd -o again/r.off --curvature 0 \
  --max-iterations 100 --threads 3 --quiet
if [ -s stdout ]; then fails "--quiet: not quiet"; fi
diff -rq out again >stderr || fails "the surfaces depend on threads"
find out -mindepth 1 -delete

# ---- too small, and nothing at all
nrrd() { printf 'NRRD0004\ntype: %s\ndimension: 3\nsizes: 8 8 8\nendian: little\nencoding: raw\n\n' "$1"; cat; }
zeros 512 | nrrd uint8 >zeros.nrrd
{ zeros 219; printf '\1'; zeros 292; } | nrrd uint8 >one.nrrd
{ zeros 2044; printf '\x00\x00\x00\x3f'; } | nrrd float >half.nrrd
{ zeros 2044; printf '\x00\x00\xc0\x7f'; } | nrrd float >nan.nrrd
awk 'BEGIN { printf "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: ascii\n\n"
  for (i = 0; i < 1728; ++i) { x = i % 12; y = int(i / 12) % 12; z = int(i / 144)
    print (x > 1 && x < 10 && y > 1 && y < 10 && z > 1 && z < 10 ? 3 : i == 0 ? 8 : 0) } }' >speck.nrrd
works "a speck" 0 "$pellicle" extract --labels speck.nrrd -o out/s.ply --quiet
grep -q "label 8: too small .*left out" stderr || fails "a speck: not told"
if [ "$(wc -l <stderr)" -ne 1 ]; then fails "a speck: not one line"; fi
if [ "$(ls out)" != s-3.ply ]; then fails "a speck: wrote $(ls out)"; fi
find out -mindepth 1 -delete
# Fifteen specks beside a label that holds a surface: one line.
awk 'BEGIN { printf "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: ascii\n\n"
  for (i = 0; i < 1728; ++i) { x = i % 12; y = int(i / 12) % 12; z = int(i / 144)
    print (x > 3 && y > 3 && z > 3 ? 3 : x % 2 + y % 2 + z == 0 && y < 6 && x < 10 ? 10 + x / 2 + 5 * y / 2 : 0) } }' \
  >specks.nrrd
works "specks" 0 "$pellicle" extract --labels specks.nrrd -o out/s.ply --quiet
says "specks" "^pellicle: 15 labels \(10, 11, .*, 19 \.\.\.\): too small .*: left out$" stderr
if [ "$(wc -l <stderr)" -ne 1 ]; then fails "specks: not one line"; fi
find out -mindepth 1 -delete

# ---- where floats would make the surfaces meet, all are written in doubles; where doubles do, none is
LC_ALL=C sed 's/^space origin.*/space origin: (1e7,0,0)/' <cells.nrrd >far.nrrd
works "far labels" 0 "$pellicle" extract --labels far.nrrd -o out/cell.off --report out/cell.json --quiet
says "far labels" "^pellicle: out/cell.off: written in double precision" stderr
if [ "$(wc -l <stderr)" -ne 1 ]; then fails "far labels: not one line"; fi
union out/cell-*.off >all.off
components all.off >/dev/null
says "far labels" '"coordinates": "double"' out/cell-2.json
find out -mindepth 1 -delete
LC_ALL=C sed 's/^space origin.*/space origin: (1e18,0,0)/' <cells.nrrd >farther.nrrd
refused "labels too far away" "out/cell.off: not written: .*--space voxel" \
  "$pellicle" extract --labels farther.nrrd -o out/cell.off --quiet
works "labels far away in voxels" 0 "$pellicle" extract --labels farther.nrrd --space voxel \
  -o out/cell.off --quiet
union out/cell-*.off >all.off
components all.off >/dev/null
find out -mindepth 1 -delete

labels() { refused "$1" "$2" "$pellicle" extract --labels "${@:3}" -o out/mesh.ply --quiet; }
labels "no labels" "no label" zeros.nrrd
labels "label of one half" "half.nrrd.*integer" half.nrrd
labels "label that is NaN" "nan.nrrd.*integer" nan.nrrd
labels "missing labels" "missing.nrrd" missing.nrrd
labels "report in no folder" "missing/report" cells.nrrd --report missing/report.json
labels "table in no folder" "missing/t.tsv" cells.nrrd --table missing/t.tsv
labels "missing names" "missing.txt: there is no such file" cells.nrrd --names missing.txt
labels "report that is the mesh" "twice" cells.nrrd --report out/mesh.ply
labels "bad curvature" "curvature" cells.nrrd --curvature -1
labels "an image too" "labels" cells.nrrd cells.nrrd
labels "several surfaces" "labels" cells.nrrd --structure bone=--iso=3
for option in "--iso 1" "--inside below" "--level-iso 1" "--window 0,1" "--pad 0" \
  "--feature gradient-norm" "--sigma 1" "--levels 1" "--reduction 2" "--init bubble" "--attach f" \
  "--force both" "--gradient 1" "--gradient-tangent 1" "--gradient-bound 1" "--trace t.csv" "--each-level" \
  --no-late-bubbles; do
  read -ra words <<<"$option"
  labels "$option" "${words[0]#--}.*labels" cells.nrrd "${words[@]}"
done
refused "neither image nor labels" "INPUT" "$pellicle" extract --iso 1 -o out/mesh.ply
refused "labels to no known kind" "mesh.xyz" "$pellicle" extract --labels cells.nrrd -o out/mesh.xyz
code=0
"$pellicle" extract --labels one.nrrd -o out/m.ply --quiet >stdout 2>stderr || code=$?
if [ $code -ne 2 ] || ! grep -q "no label is large enough" stderr; then fails "one voxel"; fi

# ---- Ctrl-C
"$pellicle" extract --help >stdout 2>stderr
grep -q -- "--labels FILE" stdout || fails "help of extract: no --labels"
works "phantom" 0 "$pellicle" phantom labels --size 120 --count 30 -o many.nrrd
code=0
timeout --preserve-status -s INT 2 "$pellicle" extract --labels many.nrrd -o out/m.ply \
  --report out/m.json --quiet >stdout 2>stderr || code=$?
if [ $code -ne 130 ]; then fails "interrupted: exit code $code"; fi
if [ -n "$(ls out)" ]; then fails "interrupted: leaves $(ls out)"; fi

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
