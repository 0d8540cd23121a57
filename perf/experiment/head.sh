# Figures 15 to 18 and table 1: bone of a head CT, direct against coarse to fine, as the paper has them
# (no late bubbles), and coarse to fine as the command does by default.
bone=(--iso 226 --curvature 0.4)
view=(--azimuth 30 --elevation 10)
extract fine "$head_ct" "${bone[@]}" --levels 3 --no-late-bubbles --each-level
extract direct "$head_ct" "${bone[@]}" --levels 0 --no-late-bubbles --max-iterations 1000
extract late "$head_ct" "${bone[@]}" --levels 3
for iterations in 1 100; do
  extract direct-$iterations "$head_ct" "${bone[@]}" --levels 0 --no-late-bubbles --max-iterations $iterations
done

# The largest component of a run's mesh, which is what the approaches have in common.
for run in fine direct late; do
  "$pellicle" measure "$dir/$run.ply" --json "$dir/$run-measure.json" >"$dir/measure.log"
done
part() { jq -r ".components[0].$2" "$dir/$1-measure.json"; }
off() { jq -rn "(($(part "$1" "$3") / $(part "$2" "$3") - 1) * 10000 | round) / 100 | \"\\(.) %\""; }

# curves PICTURE TITLE COLUMN LOG: a column of the traces over the iterations, as in figures 17, 18.
curves() {
  gnuplot <<END
set terminal png font ',11' size 900, 420
set output '$results/$1.png'
set datafile separator ','
set multiplot layout 1, 2
set xlabel 'iteration'; set grid
$2
END
  echo "![$1]($1.png)" | say
}

tile direct-1 "direct, iteration 1" "${view[@]}"
tile direct-100 "direct, iteration 100" "${view[@]}"
tile direct "direct, iteration $(iterations direct)" "${view[@]}"
tile late "coarse to fine, late bubbles" "${view[@]}"
for level in 3 2 1; do tile fine-level$level "coarse to fine, I_$level" "${view[@]}"; done
tile fine "coarse to fine, I_0" "${view[@]}"
