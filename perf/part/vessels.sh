# Figure 20 and table 2: vessels of a brain, here the phantom of trees of tapering tubes.
"$pellicle" phantom vessels -o "$dir/vessels.nrrd" >"$dir/phantom.log"
vessels=(--iso 500 --curvature 0.07 --mesh uniform)
variant vessels extract "$dir/vessels.nrrd" "${vessels[@]}" --no-late-bubbles
variant vessels-direct extract "$dir/vessels.nrrd" "${vessels[@]}" --levels 0 --no-late-bubbles
variant vessels-late extract "$dir/vessels.nrrd" "${vessels[@]}"
run_variants
for name in "${variants[@]}"; do
  measure "${name//-/_}" s "$name" '.seconds | .pyramid + .evolution'
  levels "$name"
done
