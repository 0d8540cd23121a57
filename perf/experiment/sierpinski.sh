# Figure 14: the fractal cube of 81^3 voxels, coarse to fine.
phantom sierpinski
# pi_I is 0.4, "slightly decreased for the uppermost levels".
extract cube "$dir/sierpinski.nrrd" --iso 102 --level-iso 76.5,85,93.5,102 --window 0,255 \
  --curvature 0.05 --spring 0.001 --max-iterations 400 --no-late-bubbles --each-level

for level in 3 2 1; do tile cube-level$level "I_$level" --azimuth 30 --elevation 25; done
tile cube "I_0" --azimuth 30 --elevation 25
overview 14 \
  "The areas of higher density come first, the cube's holes level by level; no numbers." \
  "The same order of events: $(iterations cube) iterations, $(shape cube)." \
  "The paper draws the result and counts nothing. Walls and holes of one voxel open and close for ever on the two finest images: the most iterations end it, and the genus depends on the one at which they do."
table "cube=coarse to fine"
picture sierpinski 4
