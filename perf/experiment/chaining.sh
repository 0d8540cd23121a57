# Figure 23: an iso-surface of the head CT, and what the model makes of it.
rigid=(--iso 226 --levels 0 --curvature 0.3 --no-late-bubbles)
extract before "$head_ct" "${rigid[@]}" --init iso --max-iterations 1
extract after "$head_ct" "${rigid[@]}" --init "mesh=$dir/before.ply"

overview 23 \
  "Marching cubes: 354 components, 958 holes, about 295,000 vertices; after some iterations with alpha_c = 0.3: 45, 181, about 191,000." \
  "Before: $(shape before). After $(iterations after) iterations: $(shape after)." \
  "Another head. Before is the iso-surface after one iteration, so brought to the distances (1) to (3) of the mesh already: the components and holes that are smaller than it resolves went there, before the smoothness forces could take them."
table "before=the iso-surface, one iteration" "after=after deformation"
tile before "iso-surface" --azimuth 30 --elevation 10
tile after "after deformation" --azimuth 30 --elevation 10
picture chaining 2
