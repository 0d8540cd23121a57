# Figures 7 and 8: two linked rings out of a potential function, from one bubble around them and from
# 11^3 small ones. Direct: the paper comes to pyramids after it.
phantom chain
potential="$dir/chain.nrrd"
common=(--iso 0.5 --window 0,1 --levels 0)
forces=(--curvature 0.1 --spring 0.1)
bubbles=(--curvature 0 --init bubbles=11,11,11)

for iterations in 1 20 40; do
  extract one-$iterations "$potential" "${common[@]}" "${forces[@]}" --max-iterations $iterations --no-late-bubbles
  tile one-$iterations "one bubble, iteration $iterations" --azimuth 30 --elevation 25
done
extract one "$potential" "${common[@]}" "${forces[@]}"
tile one "one bubble, iteration $(iterations one)" --azimuth 30 --elevation 25
for iterations in 1 4 10; do
  extract many-$iterations "$potential" "${common[@]}" "${bubbles[@]}" --max-iterations $iterations --no-late-bubbles
  tile many-$iterations "11^3 bubbles, iteration $iterations" --azimuth 30 --elevation 25
done
extract many "$potential" "${common[@]}" "${bubbles[@]}"
tile many "11^3 bubbles, iteration $(iterations many)" --azimuth 30 --elevation 25
extract zero "$potential" "${common[@]}" "${forces[@]}" --rest-length zero

overview "7, 8" \
  "One bubble: on the shape after 90 iterations. 11^3 bubbles without internal forces: after 160. Both two linked rings." \
  "One bubble: $(iterations one) iterations, $(shape one). 11^3 bubbles: $(iterations many) iterations, $(shape many)." \
  "The paper gives no size of its image, and may count until nothing moves; ours end when the energy is small. Its rest length is not told: with a null one the springs shrink the thin rings (volume $(percent zero one volume) against the mean rest length that we take)."
table "one=one bubble" "many=11^3 bubbles" "zero=one bubble, null rest length"
picture chain 4
