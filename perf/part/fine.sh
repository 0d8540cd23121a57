# As the paper has it, with late bubbles, and by default, which is adaptive.
variant fine extract "$head_ct" "${bone[@]}" --levels 3 --no-late-bubbles
variant late extract "$head_ct" "${bone[@]}" --levels 3
variant default extract "$head_ct" --iso 226
run_variants

# check VARIANT: whether it is the surface that was asked for, against the main component of `direct`.
check() {
  local direct=$out/$commit/direct.json
  "$pellicle" measure "$dir/$1.ply" --json "$dir/$1-measure.json" >"$dir/measure.log"
  [ -e "$direct" ] || { echo "fine: not checked, there is no part direct"; return; }
  jq --slurpfile direct "$direct" --slurpfile report "$dir/$1.1.json" '
    def off(f): .components[0][f] / $direct[0].details.direct_main[f] - 1;
    {vertices: .whole.vertices, area_off: off("area"), volume_off: off("volume"),
     converged: ($report[0].levels | all(.converged))}
    | .met = (.vertices >= 90000 and (.area_off | fabs) <= 0.01 and (.volume_off | fabs) <= 0.003
        and .converged)' "$dir/$1-measure.json" | detail "check-$1"
}

declare -A title=([fine]=coarse_to_fine [late]=coarse_to_fine_late)
for name in fine late; do
  measure "${title[$name]}" s "$name" '.seconds | .pyramid + .evolution'
  # Of the finest level, over the vertices that its iterations had.
  moves=$(awk -F, '$2 == 0 { sum += $4 } END { print sum }' "$dir/$name.csv")
  measure "${title[$name]}_dynamics" ns "$name" ".levels[-1].seconds.dynamics * 1e9 / $moves"
  levels "$name"
  check "$name"
done
measure head_default s default '.seconds | .pyramid + .evolution'
levels default
