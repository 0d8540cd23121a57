# The results of perf/run: one JSON file, tables and plots out of the parts. Sourced by perf/run.

# JSON of the machine and of what was measured.
facts() {
  local cache=$build/CMakeCache.txt
  jq -n --arg commit "$commit" \
    --arg cpu "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" \
    --argjson cores "$(nproc)" \
    --argjson memory "$(($(sed -n 's/^MemTotal: *\([0-9]*\).*/\1/p' /proc/meminfo) * 1024))" \
    --arg caches "$(lscpu | sed -n 's/^\(L[0-9][a-z]*\) cache: */\1 /p' | paste -sd ';')" \
    --arg kernel "$(uname -sr)" \
    --arg compiler "$("$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$cache")" --version | head -1)" \
    --arg flags "$(echo "$(sed -n 's/^CMAKE_CXX_FLAGS:[^=]*=//p' "$cache")" \
      "$(sed -n 's/^CMAKE_CXX_FLAGS_RELEASE:[^=]*=//p' "$cache")" -ffp-contract=off)" '
    {$commit, machine: {$cpu, $cores, memory_bytes: $memory, $caches, $kernel}, $compiler,
     flags: ($flags | ltrimstr(" "))}'
}

# Of the parts of this commit.
write_results() {
  local to=$out parts=("$out/$commit"/*.json) date file
  [ -e "${parts[0]}" ] || return 0
  [ -z "$publish" ] || to=$root/perf/results
  mkdir -p "$to"
  date=$(jq -rs 'map(.date) | max' "${parts[@]}")
  file=$to/$date-$commit.json
  if [ -n "$publish" ]; then
    rm -f "$to"/????-??-??-*.json  # the last published run alone
  else
    rm -f "$to"/????-??-??-"$commit".json  # of an earlier day
  fi
  jq -s --argjson facts "$(facts)" --arg date "$date" '
    {$date} + $facts + {
      parts: (map({(.part): {date, load, seconds}}) | add),
      measures: (map(.measures) | add),
      details: (map(.details) | add)}
    # In seconds, as its target is.
    | .measures |= with_entries(., (select(.key | startswith("pyramid_"))
        | .key += "_s" | .value |= (.unit = "s" | .runs |= map(. / 1000)
          | .median /= 1000 | .min /= 1000 | .max /= 1000)))
  ' "${parts[@]}" >"$file.part"
  mv "$file.part" "$file"
  write_targets "$file" "$to/targets.md"
  write_tables "$file" "$to/tables.md"
  bash "$root/perf/part/plots.sh" "$file" "$to"
  echo "Written $file, targets.md, tables.md and plots"
}

# heading TITLE RESULT: of a file of tables.
heading() {
  echo "# $1"
  echo
  jq -r '"Written by `perf/run`, \(.date), commit \(.commit): \(.machine.cores) cores of \(.machine.cpu), "
    + "\(.machine.memory_bytes / 1073741824 | round) GiB; \(.compiler), \(.flags)."' "$2"
}

# write_targets RESULT FILE
write_targets() {
  {
    heading "Targets" "$1"
    echo
    echo "Median [smallest .. largest] of the runs, one run at a time. For comparison: other programs"
    echo "on the same machine in the same run of this command where a median is given in bold, else as"
    echo "measured or published before."
    echo
    echo "| measure | for comparison | target | ours | met |"
    echo "|---|---|---|---|---|"
    jq -r --slurpfile targets "$root/perf/part/targets.json" -f "$root/perf/part/targets.jq" "$1"
    checks "$1"
  } >"$2.part"
  mv "$2.part" "$2"
}

# checks RESULT: of the surfaces of coarse to fine against the direct one.
checks() {
  jq -r '
    def percent: . * 10000 | round / 100 | "\(.) %";
    .details | to_entries[] | select(.key | startswith("check-")) | .value as $c
    | "\nThe surface of `\(.key | ltrimstr("check-"))`: \($c.vertices) vertices (90,000 and more asked for); the main component off that of the direct run by \($c.area_off | percent) in area (1 %) and \($c.volume_off | percent) in volume (0.3 %); \(if $c.converged then "every level converged" else "not every level converged" end)."
    ' "$1"
}

# write_tables RESULT FILE: tables 1 and 2 of the paper beside ours, and all measures.
write_tables() {
  {
    heading "Tables" "$1"
    jq -r -f "$root/perf/part/tables.jq" "$1"
  } >"$2.part"
  mv "$2.part" "$2"
}
