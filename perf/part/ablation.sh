# Coarse to fine, one thing different at a time. What only changes how results are computed must not
# change them.
declare -A other=()  # variants with results of their own
all=("${bone[@]}" --levels 3 --no-late-bubbles)
variant whole extract "$head_ct" "${all[@]}"
for target in scalar sse4 avx2 avx512; do
  if "$pellicle" extract "$head_ct" -o "$dir/probe.ply" "${all[@]}" --simd "$target" --quiet \
    --max-iterations 1 >/dev/null 2>"$dir/probe.log" || ! grep -q simd "$dir/probe.log"; then
    variant "$target" extract "$head_ct" "${all[@]}" --simd "$target"
  else
    echo "ablation: $target left out: $(head -1 "$dir/probe.log")"
  fi
done
variant one-thread extract "$head_ct" "${all[@]}" --threads 1
for option in --check-all --no-sleeping --no-renumbering; do
  if has_option "$option"; then
    variant "${option#--}" extract "$head_ct" "${all[@]}" "$option"
    other[${option#--}]=1
  else
    echo "ablation: pellicle extract has no $option, left out"
  fi
done
run_variants

same=()
for name in "${variants[@]}"; do
  measure "ablation_$name" s "$name" '.seconds | .pyramid + .evolution'
  [ -n "${other[$name]:-}" ] || same+=("$name")
done
same_hash "${same[@]}" >/dev/null
printf '%s\n' "${variants[@]}" | jq -R . | jq -s . | detail ablation
