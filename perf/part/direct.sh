# Structures as thin as a voxel keep its energy above the default epsilon of 5e-6 for ever.
variant direct extract "$head_ct" "${bone[@]}" --levels 0 --no-late-bubbles --epsilon 1e-5 \
  --max-iterations 1000
run_variants
measure direct s direct '.seconds | .pyramid + .evolution'
measure direct_pyramid s direct .seconds.pyramid
levels direct
"$pellicle" measure "$dir/direct.ply" --json "$dir/measure.json" >"$dir/measure.log"
jq '.components[0] | {vertices, genus, area, volume}' "$dir/measure.json" | detail direct_main
