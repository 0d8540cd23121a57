#!/usr/bin/env bash
# A disk that is full at each call in turn that makes, writes, syncs, closes or renames an output file: the
# command says so in one line that names the file, with exit code 2, and every file is whole, or as
# it was before, or not there.   tests/tools/test_full_disk.sh PELLICLE FAILING_WRITES
set -uo pipefail
pellicle=$(realpath "$1")
failing=$(realpath "$2")
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
states='absent there'
faults=0
failures=0

fails() {  # NAME N WHAT
  echo "FAILED: $1, call $2: $3"
  sed 's/^/    /' stderr
  failures=$((failures + 1))
}

same_or_absent() {  # FILE OTHER: absent where OTHER is absent, else equal
  if [ -e "$2" ]; then cmp -s "$1" "$2"; else [ ! -e "$1" ]; fi
}

whole() {  # FILE: those with times in them as far as they can be
  case $1 in
    *.json) jq -e . "out/$1" >/dev/null 2>&1 ;;
    *.csv) [ "$(wc -l <"out/$1")" = "$(wc -l <"whole/$1")" ] ;;
    *) cmp -s "out/$1" "whole/$1" ;;
  esac
}

full() {  # NAME FILES COMMAND...: all that it writes is FILES in out/; as they are $states before
  local name=$1 files=$2 code file before n
  shift 2
  rm -rf out whole
  mkdir out
  if ! "$@" >/dev/null 2>stderr; then fails "$name" 0 "does not work at all"; return; fi
  mv out whole
  if [ "$(cd whole && echo *)" != "$(tr ' ' '\n' <<<"$files" | sort | xargs)" ]; then
    fails "$name" 0 "writes $(cd whole && echo *)"
  fi
  for before in $states; do
    for ((n = 1; ; ++n)); do
      rm -rf out old failed
      mkdir out old
      if [ $before = there ]; then
        for file in $files; do echo "what was here" | tee "out/$file" >"old/$file"; done
      fi
      code=0
      LD_PRELOAD=$failing PELLICLE_FAIL_AT=$n PELLICLE_FAILED=$here/failed "$@" \
        >/dev/null 2>stderr </dev/null || code=$?
      [ -e failed ] || break
      faults=$((faults + 1))
      if [ $code -ne 2 ]; then fails "$name" $n "exit code $code, not 2"; fi
      if [ "$(wc -l <stderr)" -ne 1 ]; then fails "$name" $n "not one line on stderr"; fi
      if ! grep -q "out/.*No space left" stderr; then fails "$name" $n "the line does not tell"; fi
      for file in $files; do
        same_or_absent "out/$file" "old/$file" || whole "$file" ||
          fails "$name" $n "half of $file is left"
      done
      if [ -n "$(find out -name '.*.pellicle-*')" ]; then fails "$name" $n "leaves a temporary file"; fi
    done
    if [ $code -ne 0 ]; then fails "$name" $n "exit code $code without a fault"; fi
    if [ $n -lt 6 ]; then fails "$name" $n "only $((n - 1)) calls were seen"; fi
  done
}

"$pellicle" phantom chain --size 24 -o ball.nrrd >/dev/null || exit 1
"$pellicle" extract ball.nrrd --iso 0.5 --levels 0 --quiet -o ball.ply >/dev/null || exit 1
"$pellicle" phantom labels --size 16 --count 1 -o labels.nrrd >/dev/null || exit 1

for suffix in nrrd mha; do
  full "phantom .$suffix" a.$suffix "$pellicle" phantom chain --size 24 -o out/a.$suffix
done
full "phantom .mhd" "a.mhd a.raw" "$pellicle" phantom chain --size 24 -o out/a.mhd
mesh() { full "mesh .$1" "a.$1" "$pellicle" mesh ball.ply -o "out/a.$1"; }
mesh ply
states=absent
for suffix in stl obj off vtp vtk gii glb 3mf; do mesh $suffix; done
states='absent there'
full "extract with report and trace" "a.ply a.json a.csv" "$pellicle" extract ball.nrrd --iso 0.5 \
  --levels 1 --quiet -o out/a.ply --report out/a.json --trace out/a.csv
full "extract --labels" "a-1.ply a-1.json a-2.ply a-2.json" "$pellicle" extract \
  --labels labels.nrrd --quiet -o out/a.ply --report out/a.json
"$pellicle" phantom labels --size 32 --count 9 -o many.nrrd >/dev/null || exit 1
# Many files wait for the disk together, before the first is renamed: ten are made and written in
# twenty calls, then there is one that syncs them.
for n in 21 22; do
  rm -rf out failed
  mkdir out
  code=0
  LD_PRELOAD=$failing PELLICLE_FAIL_AT=$n PELLICLE_FAILED=$here/failed "$pellicle" extract \
    --labels many.nrrd --max-iterations 1 --quiet -o out/a.off >/dev/null 2>stderr || code=$?
  faults=$((faults + 1))
  if [ $code -ne 2 ] || [ -n "$(ls -A out)" ]; then fails "many labels" $n "code $code, leaves $(ls -A out)"; fi
done
full "measure" "a.vtp a.json" "$pellicle" measure ball.ply --curvature -o out/a.vtp \
  --json out/a.json
# Where the build has found no node there is no page.
if "$pellicle" view ball.nrrd ball.ply -o page.html >/dev/null 2>&1; then
  full "view" a.html "$pellicle" view ball.nrrd ball.ply -o out/a.html
fi
full "render" a.png "$pellicle" render ball.ply --size 100 -o out/a.png

echo "$faults faults, $failures failures"
[ $failures -eq 0 ]
