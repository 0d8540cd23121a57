# Coarse to fine, one thing different at a time. What only changes how results are computed must not
# change them.
without() { "$build/perf/bench_ablation" "$head_ct" "$1" >"$report"; }
declare -A other=()  # variants with results of their own
all=("${bone[@]}" --levels 3 --no-late-bubbles)
variant whole extract "$head_ct" "${all[@]}"
for target in scalar sse4 avx2 avx512 neon; do
  if "$pellicle" extract "$head_ct" -o "$dir/probe.ply" "${all[@]}" --simd "$target" --quiet \
    --max-iterations 1 >/dev/null 2>"$dir/probe.log" || ! grep -q simd "$dir/probe.log"; then
    variant "$target" extract "$head_ct" "${all[@]}" --simd "$target"
  else
    echo "ablation: $target left out: $(head -1 "$dir/probe.log")"
  fi
done
variant one-thread extract "$head_ct" "${all[@]}" --threads 1
variant no-sleeping extract "$head_ct" "${all[@]}" --no-sleeping
other[no-sleeping]=1
# What is left out for comparisons only is no option of the command.
for heuristic in check-all no-renumbering; do
  variant "$heuristic" without "$heuristic"
  other[$heuristic]=1
done
run_variants

same=()
for name in "${variants[@]}"; do
  measure "ablation_$name" s "$name" '.seconds | .pyramid + .evolution'
  [ -n "${other[$name]:-}" ] || same+=("$name")
done
same_hash "${same[@]}" >/dev/null
printf '%s\n' "${variants[@]}" | jq -R . | jq -s . | detail ablation
