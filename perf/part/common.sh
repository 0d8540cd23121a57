# What the parts of perf/run share: repeated runs and what is recorded of them. Sourced with $root,
# $pellicle, $out, $commit, $runs and $budget set. A part records measures, each a number in every
# run, and details, any JSON.

head_ct=/usr/share/doc/invesalius-examples/examples/Cranium.inv3
bone=(--iso 226 --curvature 0.4 --mesh uniform)
cores=$(nproc)

# A folder for the files of part NAME.
start_part() {
  part=$1
  dir=$out/$commit/$part
  rm -rf "$dir"
  mkdir -p "$dir"
  load=$(cut -d ' ' -f 1 /proc/loadavg)
  started=$SECONDS
  variants=()
  declare -gA variant_command=()
}

# The part is whole now, and replaces the one before.
finish_part() {
  touch "$dir/measures.part" "$dir/details.part"
  jq -n --arg part "$part" --arg date "$(date +%F)" --argjson load "$load" \
    --argjson seconds $((SECONDS - started)) \
    --slurpfile measures "$dir/measures.part" --slurpfile details "$dir/details.part" '
    {part: $part, date: $date, load: $load, seconds: $seconds,
     measures: ($measures | add // {}), details: ($details | add // {})}' >"$dir.json.part"
  mv "$dir.json.part" "$dir.json"
}

# variant NAME COMMAND...: to be run by run_variants. It writes its report, a JSON object, to the
# file that the shell variable `report` names.
variant() {
  variants+=("$1")
  variant_command[$1]=$(printf '%q ' "${@:2}")
}

# extract VOLUME OPTIONS...: a surface, $dir/NAME.ply for the variant NAME.
extract() {
  "$pellicle" extract "$1" -o "$dir/$name.ply" --report "$report" --trace "$dir/$name.csv" \
    --quiet "${@:2}"
}

# All variants in turn, again and again: a drift of the machine meets all of them alike.
run_variants() {
  local run name report before
  declare -A spent=()
  for ((run = 1; run <= runs; ++run)); do
    for name in "${variants[@]}"; do
      [ "$run" -eq 1 ] || [ "${spent[$name]}" -lt "$budget" ] || continue
      report=$dir/$name.$run.json
      before=$SECONDS
      eval "${variant_command[$name]}"
      spent[$name]=$((${spent[$name]:-0} + SECONDS - before))
      echo "$part: $name, run $run of $runs: $((SECONDS - before)) s"
    done
  done
}

# same_hash VARIANT...: the hash that all their runs have; fails where they differ.
same_hash() {
  local name
  for name in "$@"; do cat "$dir/$name".*.json; done | jq -rs --arg part "$part: $*" '
    map(.hash) | unique | if length == 1 then .[0]
    else error("\($part): results differ: \(map(tostring) | join(", "))") end'
}

# record MEASURE UNIT HASH: of the numbers in stdin, one a line and run. HASH is "" where there is
# none.
record() {
  jq -s --arg name "$1" --arg unit "$2" --arg hash "$3" '
    def median: sort | if length % 2 == 1 then .[length / 2 | floor]
      else (.[length / 2 - 1] + .[length / 2]) / 2 end;
    {($name): ({unit: $unit, median: median, min: min, max: max, runs: .} +
      if $hash == "" then {} else {hash: $hash} end)}' >>"$dir/measures.part"
}

# measure MEASURE UNIT VARIANT FILTER: what a jq filter says of its reports.
measure() {
  local hash
  hash=$(same_hash "$3")
  cat "$dir/$3".*.json | jq "$4" | record "$1" "$2" "$hash"
}

# detail NAME: JSON from stdin.
detail() { jq --arg name "$1" '{($name): .}' >>"$dir/details.part"; }

# levels VARIANT: tables 1 and 2 of the paper, of the run with the median time.
levels() {
  cat "$dir/$1".*.json | jq -s --arg name "$1" '
    sort_by(.seconds.evolution) | .[(length - 1) / 2 | floor]
    | {variant: $name, surface, levels: [.levels[] | {level, iterations, vertices, converged, seconds, moves, checks, operations}]}' |
    detail "levels-$1"
}
