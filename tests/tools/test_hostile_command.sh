#!/usr/bin/env bash
# The command on files that its libraries abort on or do not come to an end with: one line, exit code
# 2, soon, nothing left behind; and honest files of the same kinds, which are read.
#   tests/tools/test_hostile_command.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
tests=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
# shellcheck source=tests/tools/command_helpers.sh
source "$tests/tools/command_helpers.sh"

# Files that are given to Python's `put(path, bytes)`, which has the good files of the fuzzer at hand.
make_files() {
  PYTHONPATH=$tests/fuzz python3 -B -c '
import pathlib, struct, sys
from command_volumes import *
from command_meshes import *
def put(path, data):
    pathlib.Path(path).parent.mkdir(exist_ok=True)
    pathlib.Path(path).write_bytes(data)
exec(sys.stdin.read())'
}
extract=(timeout 20 "$pellicle" extract)
options=(--iso 100 --max-iterations 3 --quiet -o out/mesh.ply)

# ---- DICOM: GDCM ends the process where elements are cut off
make_files <<'END'
frames = slices('h')
good = dicom(frames)
put('frames.dcm', good)
put('rle.dcm', dicom(frames, 0, 'rle'))
put('tail.dcm', good + b'\xe0\x7f\x10\x00??\0\0')
for z, frame in enumerate(frames):
    put(f'folder/{z}.dcm', dicom([frame], z))
    put(f'damaged/{z}.dcm', dicom([frame], z))
put('damaged/3.dcm', dicom([frames[3]], 3) + b'\xe0\x7f\x10\x00??\0\0')
END
for input in frames.dcm rle.dcm folder; do
  works "$input" 0 "${extract[@]}" $input "${options[@]}"
  works "mask of $input" 0 "${extract[@]}" folder --init mask=$input "${options[@]}"
  works "labels of $input" 0 "${extract[@]}" --labels $input --quiet --max-iterations 3 -o out/a.ply
  left_over >/dev/null
done
for input in tail.dcm damaged; do
  refused "$input" "$input: cannot be read" "${extract[@]}" $input "${options[@]}"
  refused "mask of $input" "$input: cannot be read" "${extract[@]}" folder --init mask=$input \
    "${options[@]}"
  refused "labels of $input" "$input: cannot be read" "${extract[@]}" --labels $input \
    -o out/mesh.ply
done

# ---- formats whose libraries do not come to an end
make_files <<'END'
put('axes.mha', meta_header('MET_SHORT', 'LOCAL').replace(b'NDims = 3', b'NDims = 100000') + raw('h'))
loop = bytearray(tiff(slices('B'), 8))
first = struct.unpack_from('<I', loop, 4)[0]
struct.pack_into('<I', loop, len(loop) - 4, first)
put('loop.tif', loop)
own = bytearray(tiff(slices('B'), 8))
struct.pack_into('<I', own, len(own) - 4, len(own))
put('own.tif', own + struct.pack('<HI', 0, len(own)))
put('stack/1.tif', tiff(slices('B')[:1], 8))
put('stack/2.tif', loop)
END
refused "many axes" "axes.mha: is 100000-D" "${extract[@]}" axes.mha "${options[@]}"
refused "pages in a circle" "loop.tif: .*circle" "${extract[@]}" loop.tif "${options[@]}"
refused "a page that is its own next" "own.tif: .*empty" "${extract[@]}" own.tif "${options[@]}"
refused "a circle in a stack" "2.tif: .*circle" "${extract[@]}" stack "${options[@]}"

# ---- what GDCM passes over, and all that follows it
cp -r folder holes
ln -s nowhere holes/5a.dcm
refused "a link to nothing" "holes/5a.dcm: is not a file" "${extract[@]}" holes "${options[@]}"
rm holes/5a.dcm
mkfifo holes/5a.dcm
refused "a pipe" "holes/5a.dcm: is not a file" "${extract[@]}" holes "${options[@]}"

# ---- an interrupt ends the reader, too: 4 GiB of zeros in as many packed streams take it seconds
make_files <<'END'
header = bytearray(nifti1('h')[:352])
struct.pack_into('<3h', header, 42, 2048, 1024, 1024)
put('long.nii.gz', gzipped(bytes(header)) + gzipped(b'\0' * (1 << 24)) * 256)
END
for signal in INT TERM; do
  # A job in the background would ignore SIGINT.
  env --default-signal=INT "$pellicle" extract long.nii.gz "${options[@]}" 2>stderr &
  process=$!
  reader=
  for _ in $(seq 200); do reader=$(pgrep -P $process) && break; sleep 0.02; done
  [ -n "$reader" ] || fails "SIG$signal: there is no process that reads"
  kill -$signal $process
  wait $process
  code=$?
  [ $code -eq 130 ] || fails "SIG$signal while reading: exit code $code, not 130"
  for _ in $(seq 100); do kill -0 "$reader" 2>/dev/null || break; sleep 0.02; done
  if kill -0 "$reader" 2>/dev/null; then fails "SIG$signal: the reader lives on"; fi
  [ -z "$(left_over)" ] || fails "SIG$signal while reading leaves files"
done

# ---- pictures
make_files <<'END'
def moved(name, change):
    lines = [change(i, p) for i, p in enumerate(POINTS)]
    text = ''.join('v ' + words(p) + '\n' for p in lines)
    text += ''.join('f ' + words(v + 1 for v in f) + '\n' for f in FACES)
    put(name, text.encode())
moved('nan.obj', lambda i, p: (p[0], 'nan', p[2]) if i == 7 else p)
moved('inf.obj', lambda i, p: (p[0], p[1], '-inf') if i == 3 else p)
moved('point.obj', lambda i, p: (1, 2, 3))
moved('line.obj', lambda i, p: (p[0], 0, 0))
moved('far.obj', lambda i, p: p if i != 24 else (p[0], -9223372036854775808, p[2]))
moved('huge.obj', lambda i, p: [x * 5e306 for x in p])
moved('small.obj', lambda i, p: [x * 1e-300 for x in p])
moved('away.obj', lambda i, p: [x + 1e9 for x in p])
moved('near.obj', lambda i, p: p)
END
draws() { works "picture of $1" 0 timeout 60 "$pellicle" render "$1" --size 64 -o "out/$1.png"; }
for mesh in near huge small away; do draws $mesh.obj; done
# As large and as far away as it may be, it is the same ball.
for mesh in huge small; do
  cmp -s out/near.obj.png out/$mesh.obj.png || fails "the picture of $mesh.obj is another one"
done
left_over >/dev/null
render() { refused "$1" "$2" timeout 60 "$pellicle" render "$1" --size 64 -o out/a.png; }
render nan.obj "nan.obj: y of its point 7 is not a number"
render inf.obj "inf.obj: z of its point 3 is infinite"
render point.obj "point.obj: all its points are in one place"
render line.obj "line.obj: no face of it has an area"
# Beside one point that is this far away the others are in one place: a sliver is drawn, or nothing.
timeout 60 "$pellicle" render far.obj --size 64 -o out/a.png 2>stderr
code=$?
[ $code -eq 0 ] || [ $code -eq 2 ] || fails "far.obj: exit code $code"
left_over >/dev/null

# ---- the fuzzer: it finds nothing here, and says so where there is something
fuzz() { python3 -B "$tests/fuzz/command.py" "$1" "$2" found --jobs 2; }
works "fuzzer" 0 fuzz "$pellicle" 60
says "fuzzer" '60 files +[0-9]+ refused, [0-9]+ read +0 findings' stdout
finds() {  # WHAT PATTERN; the command is stdin
  { echo '#!/bin/sh'; cat; } >command
  chmod +x command
  rm -rf found
  works "fuzzer of $1" 1 fuzz command 2
  says "fuzzer of $1" "$2" stdout
  says "fuzzer of $1" ' 2 findings' stdout
  [ "$(find found -name command | wc -l)" -eq 2 ] || fails "the fuzzer keeps no files of $1"
}
finds "a crash" 'ends by SIGSEGV' <<<'kill -SEGV $$'
finds "no line" '0 lines on stderr' <<<'exit 2'
finds "another line" 'not its own' <<<'echo oh >&2; exit 0'
finds "what is left" 'leaves a.ply' <<<'echo "pellicle: no" >&2; echo >out/a.ply; exit 2'
finds "a process" 'leaves a process behind' <<<'sleep 60 & exit 0'

if [ $failures -gt 0 ]; then
  echo "$failures failures"
  exit 1
fi
echo "All as expected."
