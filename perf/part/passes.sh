# Each pass on one thread and on all. Measures NAME_THREADS in ms.
"$build/perf/bench_passes" "$head_ct" --benchmark_repetitions="$runs" --benchmark_format=json \
  >"$dir/passes.json" 2>"$dir/passes.log" || { cat "$dir/passes.log" >&2; exit 1; }

jq -c '
  .benchmarks | map(select(.run_type == "iteration")) | group_by(.name)[]
  | (.[0].name | capture("^(?<name>[^/]+)/threads:(?<threads>[0-9]+)")) + {hash: .[0].label,
      vertices: .[0].vertices, runs: map(.real_time)}' "$dir/passes.json" |
  while read -r pass; do
    name=$(jq -r '.name + "_" + .threads' <<<"$pass")
    jq '.runs[]' <<<"$pass" | record "$name" ms "$(jq -r .hash <<<"$pass")"
    # Where the normals' time is counted depends on which passes are joined: the whole movement.
    if [ "$name" = movement_1 ]; then
      jq '.vertices as $n | .runs[] | . * 1e6 / $n' <<<"$pass" |
        record dynamics ns "$(jq -r .hash <<<"$pass")"
    fi
  done
jq '[.benchmarks[0].vertices][0]' "$dir/passes.json" | detail passes_vertices
