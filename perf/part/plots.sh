#!/usr/bin/env bash
# The plots of a result of perf/run:
#   perf/part/plots.sh RESULT.json FOLDER
# levels.png, ablation.png, scaling.png and peers.png, each where its measures are there.
set -euo pipefail
result=$1
to=$2
data=$(mktemp -d)
trap 'rm -rf "$data"' EXIT

# rows NAME FILTER: the lines that a jq filter makes of the result.
rows() { jq -r "$2" "$result" >"$data/$1"; }

# plot NAME WIDTH HEIGHT: gnuplot commands from stdin into NAME.png.
plot() {
  {
    echo "set terminal png font ',11' size $2, $3"
    echo "set output '$to/$1.png'"
    echo "set style fill solid 0.85 noborder; set boxwidth 0.75; set grid y; set tics nomirror"
    # For those who see fewer colours, too.
    echo "set linetype 1 lc rgb '#0072b2'; set linetype 2 lc rgb '#e69f00'"
    echo "set linetype 3 lc rgb '#009e73'; set linetype 4 lc rgb '#999999'"
    cat
  } | gnuplot
}

# Seconds of topology, normals and dynamics on each level.
rows levels '
  .details as $d
  | [["levels-fine", "coarse to fine"], ["levels-late", "with late bubbles"], ["levels-direct", "direct"]][]
  | . as [$key, $title] | select($d[$key])
  | ($d[$key].levels[] | "\"I_\(.level)\" \(.seconds.topology) \(.seconds.normals) \(.seconds.dynamics) \"\($title)\""),
    "\"\" 0 0 0 \"\""'
if [ -s "$data/levels" ]; then
  # Titles below the bars of each group.
  awk -F '"' '$4 != "" { if ($4 != last) { group = group sprintf("%s", ""); first[$4] = NR; last = $4 }
    end[$4] = NR } END { for (t in first)
    printf "set label \"%s\" at %g, graph -0.12 center\n", t, (first[t] + end[t]) / 2 - 1 }' \
    "$data/levels" >"$data/labels"
  plot levels 800 420 <<END
set title 'Bone of a head CT: seconds per level'
set style data histograms
set style histogram rowstacked
set ylabel 's'
set bmargin 5
set key top left
set xtics noenhanced
load '$data/labels'
plot '$data/levels' using 2:xtic(1) title 'topology' lt 1, '' using 3 title 'normals' lt 2, \
  '' using 4 title 'dynamics' lt 3
END
fi

# Median, smallest and largest of each variant.
rows ablation '
  .measures as $m | .details.ablation // [] | reverse[]
  | . as $v | $m["ablation_" + $v] | "\"\($v)\" \(.median) \(.min) \(.max)"'
if [ -s "$data/ablation" ]; then
  plot ablation 800 $((110 + 34 * $(wc -l <"$data/ablation"))) <<END
set title 'Coarse to fine, one thing different at a time'
unset key
set grid x; unset grid
set grid x
set xlabel 's'
set xrange [0:*]
set yrange [-0.6:$(wc -l <"$data/ablation") - 0.4]
set lmargin 18
plot '$data/ablation' using (\$2 / 2):0:(\$2 / 2):(0.36):ytic(1) with boxxyerror lt 1, \
  '' using 2:0:3:4 with xerrorbars lt -1 pt 0
END
fi

# Threads; vertices.
rows threads '
  .measures as $m | .details.threads // [] | .[] | "\(.) \($m["speedup_\(.)"] | "\(.median) \(.min) \(.max)")"'
rows growth '
  .details.growth // [] | .[] | "\(.vertices) \(.total.median) \(.total.min) \(.total.max) \(.topology.median) \(.dynamics.median) \(.bytes_per_vertex)"'
if [ -s "$data/threads" ] && [ -s "$data/growth" ]; then
  plot scaling 1200 400 <<END
set multiplot layout 1, 3
set key bottom right
set xlabel 'threads'
set title 'times as fast as one thread, finest level'
set xrange [0.8:$(sort -n "$data/threads" | awk 'END { print $1 + 0.2 }')]; set yrange [0:*]
set xtics 1
plot '$data/threads' using 1:2:3:4 with yerrorbars lt 1 pt 7 notitle, '' using 1:2 with lines lt 1 notitle, \
  x with lines lt 4 dt 2 title 'ideal'
set xrange [*:*]
set logscale x; set xtics auto; set format x '10^{%L}'
set xlabel 'vertices'
set title 'ns per vertex and iteration, one thread'
set key bottom right
plot '$data/growth' using 1:2:3:4 with yerrorbars lt 1 pt 7 notitle, '' using 1:2 with lines lt 1 title 'all', \
  '' using 1:5 with linespoints lt 2 pt 5 title 'topology', '' using 1:6 with linespoints lt 3 pt 9 title 'dynamics'
set title 'bytes per vertex'
set key top right
plot '$data/growth' using 1:7 with linespoints lt 1 pt 7 notitle, 250 with lines lt 4 dt 2 title 'target'
END
fi

# Ours and the others, coarse to fine.
rows peers '
  .measures as $m | .details as $d
  | select($d.peers and $m.coarse_to_fine)
  | [{title: "Pellicle, coarse to fine", m: $m.coarse_to_fine, ours: 1},
     {title: "Pellicle, with late bubbles", m: $m.coarse_to_fine_late, ours: 1},
     {title: "Pellicle, by default: adaptive", m: $m.head_default, ours: 1},
     {title: "Pellicle, direct", m: $m.direct, ours: 1},
     ($d.peers[] | select($d[.].pyramid | not) | {title: $d[.].title, m: $m[.], ours: 4})]
  | map(select(.m)) | sort_by(-.m.median)[] | "\"\(.title)\" \(.m.median) \(.m.min) \(.m.max) \(.ours)"'
if [ -s "$data/peers" ]; then
  plot peers 1000 $((110 + 34 * $(wc -l <"$data/peers"))) <<END
set title 'Bone of a head CT'
unset key; unset grid
set grid x
set logscale x
set xlabel 's'
set xrange [0.01:*]
set ytics noenhanced
set yrange [-0.6:$(wc -l <"$data/peers") - 0.4]
set lmargin 48
plot '$data/peers' using 2:0:(0.01):2:(\$0 - 0.36):(\$0 + 0.36):5:ytic(1) with boxxyerror lc variable, \
  '' using 2:0:3:4 with xerrorbars lt -1 pt 0
END
fi
