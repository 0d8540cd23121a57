# Figure 22: a nucleus whose boundary is marked with fluorescence: the maxima of the intensity.
phantom shell
extract shell "$dir/shell.nrrd" --force gradient --gradient 0.1 --spring 0.2 --rest-length zero \
  --curvature 1.5

# The phantom's sphere has radius 0.36 of its 80 mm.
true_volume='(0.36 * 80 | . * . * .) * 4 / 3 * 3.14159265358979'
overview 22 \
  "One component with two holes, about 41,000 vertices." \
  "$(shape shell); volume off that of the phantom's sphere by $(number shell "(.surface.volume / ($true_volume) - 1) * 10000 | round / 100") %." \
  "A noisy spherical shell instead of a nucleus, without holes in truth and four times as small in vertices. The springs of null rest length, which draw the bubble onto the shell, still pull on it at rest: it comes out a little small, as the paper's must."
table "shell=f_gradI"

# Figure 22b: vertices within half a voxel of the middle slice, over it. Both files are binary.
vertices=$(number shell .surface.vertices)
header=$(($(grep -abm 1 -o '^end_header' "$dir/shell.ply" | cut -d : -f 1) + 11))
tail -c $((80 * 80 * 80)) "$dir/shell.nrrd" >"$dir/shell.raw"
"$pellicle" render "$dir/shell.ply" -o "$dir/shell.png" --size 480 --azimuth 30 --elevation 20 >"$dir/render.log"
gnuplot <<END
set terminal png truecolor font ',11' size 640, 340
set output '$results/shell.png'
set multiplot layout 1, 2
unset key; unset tics; unset border; unset colorbox; set size ratio -1; set margins 0.5, 0.5, 0.5, 2
set title 'by f_gradI' noenhanced
plot '$dir/shell.png' binary filetype=png with rgbimage
set palette gray
set title 'vertices near the middle slice' noenhanced
plot '$dir/shell.raw' binary array=(80,80) format='%uchar' skip=$((80 * 80 * 40)) with image, \\
  '$dir/shell.ply' binary skip=$header record=$vertices format='%6float' \\
  using 1:(abs(\$3 - 40) < 0.5 ? \$2 : NaN) with points pointtype 7 pointsize 0.3 linecolor rgb 'red'
END
echo "![shell](shell.png)" | say
