# Figure 24: three iso-values of one image in order, each from the surface of the one before.
phantom blobs --count 40 --noise 0.03
extract cell "$dir/blobs.nrrd" --iso 0.3,0.45,0.75 --window 0,1

values=(0.3 0.45 0.75)
ours=""
pairs=()
for value in "${values[@]}"; do
  ours+="$value: $(iterations "cell-$value") iterations, $(shape "cell-$value"). "
  pairs+=("cell-$value=pi_I = $value, from $(number "cell-$value" '.parameters.init | sub("=.*/"; "=")')")
  tile "cell-$value" "pi_I = $value" --azimuth 30 --elevation 20
done
overview 24 \
  "Surfaces of a lymphocyte for pi_I = 0.3, 0.45 and 0.75; no numbers." \
  "${ours% }" \
  "A phantom of metaballs with noise for a confocal image. A value starts from the surface of the last one, on the full image, where fewer voxels lie between them than inside."
table "${pairs[@]}"
picture tracking 3
