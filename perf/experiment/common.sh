# What the experiments share: runs, rows of tables, pictures. Sourced by perf/experiments, with $root
# set and, before one starts, $commit. Every number of ours in the results is read from the report of a
# run (number, row).

results=${RESULTS:-$root/perf/results}
out=${EXPERIMENTS:-$root/out/experiments}
pellicle=${PELLICLE:-$root/build/tools/pellicle}
head_ct=/usr/share/doc/invesalius-examples/examples/Cranium.inv3
run_limit=${RUN_LIMIT:-590}  # seconds of one run

# A folder for the files of the experiment NAME, and empty parts of the results.
start_experiment() {
  experiment=$1
  dir=$out/$experiment
  mkdir -p "$dir" "$results"
  rm -f "$dir"/*.part "$dir"/tile-*
  tiles=0
  printf '\n## %s\n\n%s, commit %s, %s cores of %s, %s.\n' "$experiment" "$(date +%F)" \
    "$commit" "$(nproc)" \
    "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$(c++ --version | head -1)" \
    >"$dir/section.part"
}

# The row of the overview and the section are whole now, and replace those before.
finish_experiment() {
  mv "$dir/overview.part" "$dir/overview.md"
  mv "$dir/section.part" "$dir/section.md"
}

# One more paragraph or table of the section, from stdin.
say() { { echo; cat; } >>"$dir/section.part"; }

# overview FIGURES PAPER OURS WHY: the row of the overview.
overview() { echo "| [$experiment](#$experiment) | $1 | $2 | $3 | $4 |" >"$dir/overview.part"; }

# extract RUN VOLUME OPTIONS...: a surface $dir/RUN.ply with its report and its trace, of a uniform
# mesh, as the paper's is. With KEEP=1 a run of an earlier call with the same options is taken as it
# is: to go on after an interrupt.
extract() {
  local name=$1 volume=$2
  shift 2
  if [ -n "${KEEP:-}" ] && [ -e "$dir/$name.json" ] && [ -e "$dir/$name.args" ] &&
    [ "$(cat "$dir/$name.args")" = "$volume $*" ]; then
    return
  fi
  rm -f "$dir/$name.json"
  echo "$volume $*" >"$dir/$name.args"
  echo "$name: extract $(basename "$volume") $*"
  timeout "$run_limit" "$pellicle" extract "$volume" -o "$dir/$name.ply" --report "$dir/$name.json" \
    --trace "$dir/$name.csv" --mesh uniform --quiet "$@"
}

# phantom KIND OPTIONS...: $dir/KIND.nrrd.
phantom() { "$pellicle" phantom "$1" -o "$dir/$1.nrrd" "${@:2}" >"$dir/phantom.log"; }

# number RUN FILTER: of a run's report, by a jq filter.
number() { jq -r "$2" "$dir/$1.json"; }

# shape RUN: its surface in a few words.
shape() {
  number "$1" '.surface | "\(.vertices) vertices, \(.components) component\(if .components == 1
    then "" else "s" end), genus \(.genus)"'
}

# iterations RUN: of each level, coarse to fine; a star where the most iterations ended it, in
# parentheses where nothing was left of the surface.
iterations() {
  number "$1" '[.levels[] | if .vertices == 0 then "(\(.iterations))" elif .converged then
    "\(.iterations)" else "\(.iterations)\\*" end] | join(" + ")'
}

# percent RUN OTHER FIELD: by how much a measure of RUN is off that of OTHER.
percent() {
  jq -rn --slurpfile a "$dir/$1.json" --slurpfile b "$dir/$2.json" --arg f "$3" \
    '($a[0].surface[$f] / $b[0].surface[$f] - 1) * 10000 | round / 100 | "\(.) %"'
}

# table RUN=LABEL...: what became of each run, as a table of the section.
table() {
  local pair
  {
    echo "| run | iterations | vertices | components | genus | area (mm2) | volume (mm3) | late bubbles, cavities | seconds | peak (MiB) | hash |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|"
    for pair in "$@"; do
      jq -r --arg run "${pair#*=}" --arg iterations "$(iterations "${pair%%=*}")" '
        [$run, $iterations, .surface.vertices, .surface.components, .surface.genus,
         (.surface.area | round), (.surface.volume | round),
         ([.levels[].late.bubbles] | add | tostring) + ", " +
           ([.levels[].late.cavities] | add | tostring),
         (.seconds.evolution * 10 | round / 10), (.peak_rss_bytes / 1048576 | round), .hash]
        | "| " + (map(tostring) | join(" | ")) + " |"' "$dir/${pair%%=*}.json"
    done
  } | say
}

# times RUN=LABEL...: tables 1 and 2 of the paper, seconds of topology, normals and dynamics.
times() {
  local pair
  {
    echo "| approach | level | iterations | vertices | T (s) | N (s) | F (s) | = (s) |"
    echo "|---|---|---|---|---|---|---|---|"
    for pair in "$@"; do
      jq -r --arg a "${pair#*=}" '
        def two: . * 100 | round / 100;
        .levels[] | [$a, "I_\(.level)", .iterations, .vertices, (.seconds.topology | two),
          (.seconds.normals | two), (.seconds.dynamics | two), (.seconds.total | two)]
        | "| " + (map(tostring) | join(" | ")) + " |"' "$dir/${pair%%=*}.json"
    done
  } | say
}

# tile MESH TITLE [OPTIONS of render...]: one more part of the next picture.
tile() {
  tiles=$((tiles + 1))
  "$pellicle" render "$dir/$1.ply" -o "$dir/tile-$tiles.png" --size 480 "${@:3}" >"$dir/render.log"
  echo "$2" >"$dir/tile-$tiles.txt"
}

# picture NAME COLUMNS: the tiles so far in one picture, perf/results/NAME.png.
picture() {
  local columns=$2 rows i
  rows=$(((tiles + columns - 1) / columns))
  {
    # The terminal of libgd writes a palette: a third of the bytes of true colour.
    echo "set terminal png font ',11' size $((280 * columns)), $((310 * rows))"
    echo "set output '$results/$1.png'"
    echo "set multiplot layout $rows, $columns"
    echo "unset key; unset tics; unset border; set size ratio -1; set margins 0.5, 0.5, 0.5, 2"
    for ((i = 1; i <= tiles; ++i)); do
      echo "set title '$(cat "$dir/tile-$i.txt")' noenhanced offset 0, -0.5"
      echo "plot '$dir/tile-$i.png' binary filetype=png with rgbimage"
    done
  } | gnuplot
  rm -f "$dir"/tile-*
  tiles=0
  echo "![$1]($1.png)" | say
}

# write_results NAME...: experiments.md out of the parts just made and, for the others, its own.
write_results() {
  local file=$results/experiments.md name old
  old=$(cat "$file" 2>/dev/null || true)
  {
    echo "# The experiments of the paper"
    echo
    echo "Written by \`perf/experiments\`; each section tells when, of which commit and on what machine."
    echo "Iterations are those of each level, coarse to fine; a star: ended by the most iterations"
    echo "allowed; in parentheses: nothing was left of the surface on this level."
    echo "Seconds are wall clock of the evolution; the machine was shared with other work: expect half or double."
    echo
    echo "| experiment | figures | the paper reports | we get | why they differ |"
    echo "|---|---|---|---|---|"
    for name in "$@"; do
      if [ -e "$out/$name/overview.md" ]; then
        cat "$out/$name/overview.md"
      else
        grep -F "| [$name](#$name) |" <<<"$old" || true
      fi
    done
    for name in "$@"; do
      if [ -e "$out/$name/section.md" ]; then
        cat "$out/$name/section.md"
      elif grep -qxF "## $name" <<<"$old"; then
        # The substitution takes the blank lines before the next section away.
        printf '\n%s\n' "$(awk -v name="## $name" '/^## / { on = $0 == name } on' <<<"$old")"
      fi
    done
  } >"$file.part"
  mv "$file.part" "$file"
  for name in "$@"; do rm -f "$out/$name/overview.md" "$out/$name/section.md"; done
}
