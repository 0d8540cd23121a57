# For the tests of `pellicle cohort`: sourced after command_helpers.sh.
# shellcheck shell=bash

# make_scans N [SIZE]: scans/s1.nrrd to sN.nrrd.
make_scans() {
  local i
  mkdir -p scans
  for ((i = 1; i <= $1; i++)); do
    "$pellicle" phantom blobs -o "scans/s$i.nrrd" --size "${2:-32}" --seed "$i" >/dev/null || exit 1
  done
}

# expect_hash WHAT REPORT INPUT OPTIONS...: the report's hash is that of a single extraction.
expect_hash() {
  local what=$1 report=$2 single
  shift 2
  "$pellicle" extract "$@" -o single.ply --report single.json --quiet || fails "$what: extract"
  single=$(jq -r .hash single.json)
  [ "$(jq -r .hash "$report")" = "$single" ] || fails "$what: not the hash of a single extraction"
  cmp -s single.ply "${report%.json}.ply" || fails "$what: not the mesh of a single extraction"
}

# same_as_single STUDY OPTIONS...: of every s*.json.
same_as_single() {
  local study=$1 report
  shift
  for report in "$study"/s[0-9]*.json; do
    expect_hash "$report" "$report" "scans/$(basename "$report" .json).nrrd" "$@"
  done
}

# whole STUDY: nothing in it is half of anything.
whole() {
  local file
  while IFS= read -r file; do
    case $file in
      *.json) jq -e . "$file" >/dev/null || fails "$file is half-written" ;;
      *.ply) "$pellicle" check "$file" >/dev/null || fails "$file is not valid" ;;
    esac
  done < <(find "$1" -path "$1/work" -prune -o -type f -print)
}

# wait_for SECONDS COMMAND...: until it succeeds.
wait_for() {
  local seconds=$1 i
  shift
  for ((i = 0; i < 10 * seconds; i++)); do
    "$@" && return 0
    sleep 0.1
  done
  return 1
}

# done_in STUDY: how many scans have their reports.
done_in() { find "$1" -maxdepth 1 -name 's[0-9]*.json' | wc -l; }
at_least() { [ "$(done_in "$1")" -ge "$2" ]; }
