# Figure 21: skin and bone by the iso force, the hull of the skull by the gradient force, on one head.
# Everything starts from a bubble around the head.
extract bone "$head_ct" --iso 226 --no-late-bubbles
extract skin "$head_ct" --iso -200 --no-late-bubbles
# The gradient force climbs to bright voxels; the window leaves the air out of it.
extract hull "$head_ct" --force gradient --gradient 0.1 --gradient-tangent 0.05 --iso 226 \
  --window 0,1500

overview 21 \
  "Skull by f_I (0.29), skin by f_I (0.1), and by f_gradI (0.1, 0.05) a hull of the skull that fills its gaps (orbits, jaws); no numbers." \
  "Skull: $(shape bone). Skin: $(shape skin). Hull: $(shape hull), volume $(percent hull bone volume) against the skull's." \
  "Another head, with a head holder. The paper gives no unit for its gradient; ours is per window and voxel, and bounded."
table "bone=f_I, 226 HU" "skin=f_I, -200 HU" "hull=f_gradI"
tile bone "skull by f_I" --azimuth 30 --elevation 10
tile skin "skin by f_I" --azimuth 30 --elevation 10
tile hull "hull of the skull by f_gradI" --azimuth 30 --elevation 10
picture forces 3
