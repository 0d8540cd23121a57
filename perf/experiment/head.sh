# Figures 15 to 18 and table 1: bone of a head CT, direct against coarse to fine, as the paper has them
# (no late bubbles), and coarse to fine as the command does by default.
bone=(--iso 226 --curvature 0.4)
view=(--azimuth 30 --elevation 10)
extract fine "$head_ct" "${bone[@]}" --levels 3 --no-late-bubbles --each-level
extract direct "$head_ct" "${bone[@]}" --levels 0 --no-late-bubbles
extract late "$head_ct" "${bone[@]}" --levels 3
extract direct-100 "$head_ct" "${bone[@]}" --levels 0 --no-late-bubbles --max-iterations 100

# The largest component of a run's mesh, which is what the approaches have in common.
for run in fine direct late; do
  "$pellicle" measure "$dir/$run.ply" --json "$dir/$run-measure.json" >"$dir/measure.log"
done
part() { jq -r ".components[0].$2" "$dir/$1-measure.json"; }
off() { jq -rn "($(part "$1" "$3") / $(part "$2" "$3") - 1) * 10000 | round / 100 | \"\(.) %\""; }

# curves PICTURE LEFT RIGHT: the commands of its two plots, over the iterations of the traces.
curves() {
  gnuplot <<END
set terminal png font ',11' size 1000, 400
set output '$results/$1.png'
set datafile separator ','
direct = '$dir/direct.csv'
fine = '$dir/fine.csv'
set multiplot layout 1, 2
set xlabel 'iteration'
set grid
$2
$3
END
  echo "![$1]($1.png)" | say
}
# Milliseconds of an iteration: a column of seconds since the start, less that of the row before; the
# largest gaps are a new level's first, and not drawn.
milliseconds='last = -1; step(s) = (d = last < 0 ? NaN : 1000 * (s - last), last = s, d)'

overview "15-18, table 1" \
  "Direct: 700 iterations and more, 65,000 to 120,000 vertices, 112 min. Coarse to fine: 3,800, 12,000, 38,000, 120,000 vertices on the levels, 41 min: 2.8 times as fast. Area within 1.0 %, volume within 0.3 %, both one component of genus 23." \
  "Direct: $(iterations direct) iterations, $(shape direct), $(number direct '.seconds.evolution | round') s. Coarse to fine: $(iterations fine) iterations, $(shape fine), $(number fine '.seconds.evolution | round') s. Main components: area off by $(off fine direct area), volume by $(off fine direct volume), genus $(part fine genus) and $(part direct genus). With late bubbles $(shape late), volume of the main component off by $(off late direct volume)." \
  "Another head (256 x 256 x 108) in a head holder, whose pads are detached parts: the direct approach and late bubbles find them, coarse to fine without late bubbles loses them, as the paper's does with its vessels. Where structures as thin as a voxel open and close, the direct approach comes to rest as they are frozen. The times are of machines a quarter of a century apart; we refuse movements and transformations that would make the surface meet itself, which the paper does not test."
table "direct=direct" "fine=coarse to fine" "late=coarse to fine, late bubbles"
times "direct=direct" "fine=coarse to fine" "late=coarse to fine, late bubbles"
say <<END
Table 1 of the paper, seconds on a Pentium 300: coarse to fine T 17.0, 30.0, 108.7, 543.8, N 1.4, 5.5,
22.3, 97.6, F 38.8, 77.8, 258.3, 1242.6 on I_3 .. I_0; direct T 2701.7, N 553.8, F 3476.4.
END

tile direct-100 "direct, iteration 100" "${view[@]}"
tile direct "direct, at the end" "${view[@]}"
tile late "coarse to fine, late bubbles" "${view[@]}"
for level in 3 2 1; do tile fine-level$level "coarse to fine, I_$level" "${view[@]}"; done
tile fine "coarse to fine, I_0" "${view[@]}"
picture head 4
curves figure17 "
set logscale y
set title 'mean kinetic energy along normals'
plot direct using 1:5 every ::1 with lines title 'direct', fine using 1:5 every ::1 with lines title 'coarse to fine'
unset logscale y" "
set title 'vertices'
set key bottom right
plot direct using 1:4 every ::1 with lines title 'direct', fine using 1:4 every ::1 with lines title 'coarse to fine'"
curves figure18 "
$milliseconds
set yrange [0:*]
set title 'ms per iteration, direct'
plot direct using 1:(step(column(7))) every ::1 with lines notitle" "
last = -1
set title 'ms per iteration, coarse to fine'
plot fine using 1:(step(column(7))) every ::1 with lines notitle"
