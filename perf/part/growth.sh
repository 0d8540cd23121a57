# One thread: the time of a vertex, not how well threads share it. The hash of one size is checked
# on all cores.
sizes=(10000 40000 160000 640000 2500000 4000000)
for size in "${sizes[@]}"; do
  echo "growth: $size vertices"
  "$build/perf/bench_growth" "$size" 1 "$runs" >"$dir/size-$size.json"
done
"$build/perf/bench_growth" 160000 "$cores" "$runs" >"$dir/threads.json"
jq -es 'map(.hash) | unique | length == 1' "$dir/threads.json" "$dir/size-160000.json" >/dev/null ||
  { echo "growth: the surface depends on the number of threads" >&2; exit 1; }

for size in "${sizes[@]}"; do
  jq '.total | .median, .min, .max' "$dir/size-$size.json" |
    record "growth_$size" ns "$(jq -r .hash "$dir/size-$size.json")"
  cat "$dir/size-$size.json"
done | jq -s '.' >"$dir/sizes.json"
detail growth <"$dir/sizes.json"
# The dearest size against the cheapest.
jq 'map(.total) | (map(.median) | max / min), (map(.min) | max / min), (map(.max) | max / min)' \
  "$dir/sizes.json" | record growth_ratio x ""
# Of small meshes the threads' own memory is most.
jq 'map(select(.vertices > 100000).bytes_per_vertex) | max' "$dir/sizes.json" |
  record bytes_per_vertex bytes ""
