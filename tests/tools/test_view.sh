#!/usr/bin/env bash
# `pellicle view` from outside: bad input, and its pages in a headless Chromium.
#   tests/tools/test_view.sh PELLICLE VIEW_CONTOURS NPM_FOLDER
# NPM_FOLDER is where the build has installed what tools/view/package-lock.json names.
set -uo pipefail
pellicle=$(realpath "$1")
contours=$(realpath "$2")
npm=$(realpath "$3")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

# Of the images that phantoms make, only the header is changed: x fastest, voxels in .raw.
"$pellicle" phantom blobs --size 40,44,36 --spacing 1,0.9,1.3 --seed 3 --type i16 -o blobs.mhd >/dev/null || exit 1
turned() {  # NAME AXES OFFSET
  sed -e "s/^TransformMatrix = .*/TransformMatrix = $2/" -e "s/^Offset = .*/Offset = $3/" blobs.mhd >"$1.mhd"
}
turned oblique "0.906308 0.422618 0 -0.416198 0.892539 0.173648 0.073387 -0.157379 0.984808" "300.5 -220 1000"
turned sagittal "0 0 -1 0 1 0 1 0 0" "-7 13 29"  # left-handed: x is down, z to the left
for name in oblique sagittal; do
  grep -q "^TransformMatrix = 0" $name.mhd || fails "$name.mhd has not been turned"
done
works "a surface" 0 "$pellicle" extract oblique.mhd --iso 500 --levels 0 --quiet -o surface.ply
works "a surface in voxels" 0 "$pellicle" extract sagittal.mhd --iso 500 --levels 0 --space voxel --quiet -o voxels.ply
works "a smaller surface" 0 "$pellicle" extract oblique.mhd --iso 700 --levels 0 --quiet -o inner.stl
works "values" 0 "$pellicle" measure surface.ply --curvature --distance inner.stl -o values.vtp

# Where node is missing the page says what installs it.
"$tests/../tools/view/build_page" "" "" "$here/npm" why.cpp >/dev/null || fails "build_page without node"
purpose=$(grep -oE 'tools/setup.sh [a-z]+' why.cpp | cut -d' ' -f2)
[ "$purpose" = page ] || fails "build_page names tools/setup.sh $purpose, which installs a browser, too, or nothing"
grep -qE "^$purpose=\(.*nodejs npm" "$tests/../tools/setup.sh" || fails "tools/setup.sh $purpose installs no node and npm"

if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  refused "without node and npm" "node" "$pellicle" view oblique.mhd surface.ply -o out/a.html
  [ $failures -eq 0 ] || exit 1
  echo "SKIPPED: there is no page to test without node and npm"
  exit 77
fi

view() { refused "$1" "$2" "$pellicle" view "${@:3}" -o out/a.html; }
echo "no image" >words.nrrd
echo "no mesh" >words.ply
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' >empty.ply
view "no image" "missing.nrrd" missing.nrrd surface.ply
view "words as an image" "words.nrrd" words.nrrd surface.ply
view "no surface" "missing.ply" oblique.mhd missing.ply
view "words as a surface" "words.ply" oblique.mhd surface.ply words.ply
view "a surface without faces" "empty.ply: has no face" oblique.mhd empty.ply
view "a name of no format" "unknown format" oblique.mhd blobs.mhd
view "an unknown space" "space" oblique.mhd surface.ply --space mni
view "a window turned round" "window" oblique.mhd surface.ply --window 5,1
view "a window without end" "window" oblique.mhd surface.ply --window=-1.7e308,1.7e308
view "a window of words" "window" oblique.mhd surface.ply --window a,b
view "no voxels" "max-voxels" oblique.mhd surface.ply --max-voxels 0
view "an empty name" "empty" oblique.mhd ""
refused "a page that is no .html" "html" "$pellicle" view oblique.mhd surface.ply -o out/a.png
refused "a folder that is not there" "nowhere" "$pellicle" view oblique.mhd -o out/nowhere/a.html
works "a surface elsewhere" 0 "$pellicle" view blobs.mhd surface.ply -o out/a.html
says "a surface elsewhere" "surface.ply lies outside the image" stderr
works "a surface here" 0 "$pellicle" view oblique.mhd surface.ply -o out/a.html
[ -s stderr ] && fails "a surface here: something is on stderr"
[ "$(ls out)" = a.html ] || fails "leaves $(ls out)"

cp inner.stl '<b>&"x.stl'
works "a page" 0 "$pellicle" view oblique.mhd values.vtp '<b>&"x.stl' -o oblique.html
says "a page" "256 greys" stdout
# What a file says of its space goes before --space.
works "a mesh in RAS" 0 "$pellicle" mesh surface.ply -o ras.ply --space ras
works "a mesh in GIFTI" 0 "$pellicle" mesh surface.ply -o surface.gii
for mesh in ras.ply surface.gii; do
  works "a page of $mesh" 0 "$pellicle" view oblique.mhd $mesh --space ras -o named.html
  if [ -s stderr ]; then fails "a page of $mesh: $(cat stderr)"; fi
done
works "a page in voxels" 0 "$pellicle" view sagittal.mhd voxels.ply --space voxel --window 100,900 -o sagittal.html
works "a reduced page" 0 "$pellicle" view oblique.mhd surface.ply --max-voxels 9000 -o reduced.html
says "a reduced page" "is reduced to 20 x 22 x 18 voxels, each the mean of 2 x 2 x 2" stdout
works "an image alone" 0 "$pellicle" view blobs.mhd -o alone.html
# Two tetrahedra, of labels 3 and 8, over labels.
cat >labels.ply <<'END'
ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
property int Label
element face 8
property list uchar int vertex_indices
end_header
4 4 4 3
16 4 4 3
4 16 4 3
4 4 18 3
12 12 10 8
20 12 10 8
12 20 10 8
12 12 20 8
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
3 4 6 5
3 4 5 7
3 4 7 6
3 5 6 7
END
works "labels" 0 "$pellicle" phantom labels --size 24 -o labels.nrrd
works "a page of labels" 0 "$pellicle" view labels.nrrd labels.ply -o labels.html
[ "$(wc -l <stdout)" -eq 1 ] || fails "a page of labels: something is said of its values"
if grep -lE '(src|href)=["'\'']?(https?:)?//' ./*.html; then fails "a page names another one"; fi

chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
  [ $failures -eq 0 ] || exit 1
  echo "SKIPPED: the pages have been made, but there is no chromium to look at them"
  exit 77
}
node "$tests/tools/view_pages.mjs" "$npm" "$chromium" "$contours" "$here" || failures=$((failures + 1))

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
