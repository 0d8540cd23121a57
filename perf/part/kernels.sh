# The kernels of the movement on every instruction set, ns per vertex (perf/bench_kernels): measures
# kernel_NAME_TARGET, and kernel_NAME_TARGET_THREADS of whole steps.
if [ ! -x "$build/perf/bench_kernels" ]; then
  echo "kernels: bench_kernels is not built, left out"
else
  "$build/perf/bench_kernels" --benchmark_repetitions="$runs" --benchmark_min_time=0.1 \
    --benchmark_format=json >"$dir/kernels.json" 2>"$dir/kernels.log" ||
    { cat "$dir/kernels.log" >&2; exit 1; }
  jq -c '
    .benchmarks | map(select(.run_type == "iteration")) | group_by(.name)[]
    | {name: (.[0].name | split("/") | [.[0], .[1]] + map(capture("^threads:(?<n>[0-9]+)$").n)
         | join("_")),
       hash: .[0].label, runs: map(.vertex * 1e9)}' "$dir/kernels.json" |
    while read -r kernel; do
      jq '.runs[]' <<<"$kernel" |
        record "kernel_$(jq -r .name <<<"$kernel")" ns "$(jq -r .hash <<<"$kernel")"
    done
fi
