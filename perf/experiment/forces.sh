# Figure 21: skin and bone by the iso force, the hull of the skull by the gradient force, on one head.
# Everything starts from a bubble around the head.
extract bone "$head_ct" --iso 226 --no-late-bubbles
extract skin "$head_ct" --iso -200 --no-late-bubbles
# The gradient force climbs to bright voxels; the window leaves the air out of it. In the air there is
# no gradient: a slight spring of null rest length, as in figure 22, draws the bubble to the head.
extract hull "$head_ct" --force gradient --gradient 0.1 --gradient-tangent 0.05 --iso 226 \
  --window 0,1500 --spring 0.05 --rest-length zero --no-late-bubbles

overview 21 \
  "Skull by f_I (0.29), skin by f_I (0.1), and by f_gradI (0.1, 0.05) a hull of the skull that fills its gaps (orbits, jaws); no numbers." \
  "Skull: $(shape bone). Skin: $(shape skin). Hull: $(shape hull), around $(number hull '.surface.volume / 1000 | round') cm3, the bone being $(number bone '.surface.volume / 1000 | round') cm3 and the skin's inside $(number skin '.surface.volume / 1000 | round') cm3." \
  "Another head. The paper names no force that brings the bubble through the air, where the gradient is null: we add a spring of null rest length (0.05), without which the bubble stays where it is, and which flattens the face."
table "bone=f_I, 226 HU" "skin=f_I, -200 HU" "hull=f_gradI"
tile bone "skull by f_I" --azimuth 30 --elevation 10
tile skin "skin by f_I" --azimuth 30 --elevation 10
tile hull "hull of the skull by f_gradI" --azimuth 30 --elevation 10
picture forces 3
