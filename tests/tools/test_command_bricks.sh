#!/usr/bin/env bash
# `extract --memory`: images by bricks give the same files as images that are read whole, within the
# memory that is given.   tests/tools/test_command_bricks.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

phantom() { "$pellicle" phantom "$@" || fails "phantom $*"; }

# same WHAT FILE OPTIONS...: with --memory as without.
same() {
  local what=$1 file=$2
  shift 2
  works "$what, whole" 0 "$pellicle" extract "$file" "$@" -o whole.ply
  works "$what, by bricks" 0 "$pellicle" extract "$file" "$@" -o bricks.ply --memory 1G --report bricks.json
  says "$what" '^bricks   [0-9]+ of the image, [0-9]+ read, ' stdout
  says "$what" '"read_again":' bricks.json
  cmp -s whole.ply bricks.ply || fails "$what: another surface by bricks"
}

for suffix in ome.zarr nrrd mhd; do
  phantom vessels --size 90,80,70 --type i16 -o "image.$suffix"
  same "$suffix" "image.$suffix" --iso 500
done
same "a region" image.ome.zarr --iso 500 --box 10,70,5,79,20,60
same "Otsu's value" image.nrrd --iso otsu
phantom chain --size 60 -o chain.nrrd
same "an adaptive mesh" chain.nrrd --iso p90 --mesh adaptive

# Several values: the second starts from the first, and reads the same bricks.
works "values, whole" 0 "$pellicle" extract image.nrrd --iso 400,500 -o whole.ply
works "values, by bricks" 0 "$pellicle" extract image.nrrd --iso 400,500 -o bricks.ply --memory 1G
for value in 400 500; do cmp -s "whole-$value.ply" "bricks-$value.ply" || fails "value $value: another surface"; done

# What cannot be read by bricks is read whole.
phantom chain --size 40 --type i32 -o wide.nrrd
works "32-bit integers" 0 "$pellicle" extract wide.nrrd --iso 500 -o wide.ply --memory 1G
grep -q bricks stdout && fails "32-bit integers: by bricks"

# A volume larger than what is given: 256 MiB in 240 MiB.
phantom chain --size 512,512,512 --type i16 -o large.ome.zarr
works "large" 0 "$pellicle" extract large.ome.zarr --iso 500 -o large.ply --memory 240M --report large.json
peak=$(sed -nE 's/.*"peak_rss_bytes": ([0-9]+).*/\1/p' large.json)
[ "${peak:-0}" -gt 0 ] && [ "$peak" -lt $((240 << 20)) ] || fails "large: a peak of $peak bytes"
works "large, checked" 0 "$pellicle" check large.ply

refused "no size" "--memory" "$pellicle" extract image.nrrd --iso 500 -o out/mesh.ply --memory much
refused "nothing" "--memory" "$pellicle" extract image.nrrd --iso 500 -o out/mesh.ply --memory 0
refused "too little" "--memory" "$pellicle" extract image.nrrd --iso 500 -o out/mesh.ply --memory 1M
refused "no room for the surface" "memory" \
  "$pellicle" extract large.ome.zarr --iso 500 -o out/mesh.ply --memory 100M
phantom labels --size 60 -o labels.nrrd
works "labels" 0 "$pellicle" extract --labels labels.nrrd --merged labels.ply --memory 200M
refused "labels, too little" "memory" "$pellicle" extract --labels labels.nrrd --merged out/labels.ply --memory 1M
# A chunk that cannot be unpacked.
chunk=$(find image.ome.zarr -name '[0-9]*' -type f -size +2k | sort | head -n 1)
truncate -s 100 "$chunk"
refused "a damaged chunk" "image.ome.zarr" \
  "$pellicle" extract image.ome.zarr --iso 500 -o out/mesh.ply --memory 1G
head -c 50000 image.nrrd >short.nrrd
refused "a file that ends early" "truncated" \
  "$pellicle" extract short.nrrd --iso 500 -o out/mesh.ply --memory 1G

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "all as it should be"
