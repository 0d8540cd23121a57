# tables.md. Input: a result of perf/run. The paper's seconds are of a Pentium 300.
def two: . * 100 | round / 100;
def short: if . >= 100 then round elif . >= 10 then . * 10 | round / 10
  else . * 1000 | round / 1000 end;

def paper: {
  "1": [
    {name: "multi-resolution", T: [17.0, 30.0, 108.7, 543.8], N: [1.4, 5.5, 22.3, 97.6],
     F: [38.8, 77.8, 258.3, 1242.6], total: 2445},
    {name: "direct", T: [2701.7], N: [553.8], F: [3476.4], total: 6732}],
  "2": [
    {name: "multi-resolution", T: [6.8, 0.0, 3.8, 196.9], N: [1.4, 0.0, 0.0, 26.4],
     F: [4.3, 0.1, 27.8, 729.2], total: 997},
    {name: "direct", T: [1521.0], N: [344.6], F: [986.4], total: 2852}]};

# Cells of the levels 3 .. 0, of a direct run only the last.
def cells: [range(4 - length) | ""] + map(two | tostring);
def row($who; $what; $values; $total):
  "| \($who) | \($what) | \($values | cells | join(" | ")) | \($total | two) |";
def theirs: .name as $n
  | (row("paper, \($n)"; "T"; .T; .T | add), row("|"; "N"; .N; .N | add), row("|"; "F"; .F; .F | add),
     row("|"; "="; [.T, .N, .F] | transpose | map(add); .total))
  | sub("^\\| \\| "; "|  ");
def ours($name): .levels as $l
  | def part(f): $l | map(f);
    (row("Pellicle, \($name)"; "T"; part(.seconds.topology); part(.seconds.topology) | add),
     row("|"; "N"; part(.seconds.normals); part(.seconds.normals) | add),
     row("|"; "F"; part(.seconds.dynamics); part(.seconds.dynamics) | add),
     row("|"; "="; part(.seconds.total); part(.seconds.total) | add),
     "|  | iterations | \([range(4 - ($l | length)) | ""] + ($l | map("\(.iterations)\(if .converged then "" elif .vertices == 0 then " (nothing left)" else "\\*" end)")) | join(" | ")) | \($l | map(.iterations) | add) |",
     "|  | vertices | \([range(4 - ($l | length)) | ""] + ($l | map(.vertices | tostring)) | join(" | ")) | |")
  | sub("^\\| \\| "; "|  ");
def head: "| approach | | I_3 | I_2 | I_1 | I_0 | total |", "|---|---|---|---|---|---|---|";

.details as $d | .measures as $m | .machine.cores as $cores
| "",
  "Seconds of topology (T), normals (N) and dynamics (F) on each level, and together (=), of the run with",
  "the median time. The paper's are of a Pentium 300 and of its own images. A star: the most iterations",
  "allowed ended the level.",
  "",
  "## Table 1: a head CT", "", head,
  (paper["1"][] | theirs),
  ($d["levels-fine"] | select(.) | ours("coarse to fine")),
  ($d["levels-late"] | select(.) | ours("coarse to fine, late bubbles")),
  ($d["levels-default"] | select(.) | ours("by default, adaptive")),
  ($d["levels-direct"] | select(.) | ours("direct")),
  "",
  "## Table 2: vessels", "",
  "The paper's: an angiography, 256 x 256 x 124; ours: the phantom of that size.", "", head,
  (paper["2"][] | theirs),
  ($d["levels-vessels"] | select(.) | ours("coarse to fine")),
  ($d["levels-vessels-late"] | select(.) | ours("coarse to fine, late bubbles")),
  ($d["levels-vessels-direct"] | select(.) | ours("direct")),
  "",
  (if $d.ablation then
    "## What each thing is worth", "",
    "Coarse to fine as the paper has it, one thing different at a time.", "",
    "| variant | median (s) | smallest | largest | against the whole | same surface |",
    "|---|---|---|---|---|---|",
    ($m.ablation_whole as $whole | $d.ablation[] | . as $v | $m["ablation_" + $v]
     | "| \($v) | \(.median | short) | \(.min | short) | \(.max | short) | \(.median / $whole.median | two) | \(if .hash == $whole.hash then "yes" else "no" end) |"),
    ""
   else empty end),
  (if $m["look_\($cores)"] then
    "## Where the time goes", "",
    "Movements of vertices and looks around them, each times what one takes when all \($d.passes_vertices) vertices of the part `passes` take part, on \($cores) threads; the rest is what transformations take, with all else.", "",
    "| run | movements | (s) | looks | (s) | transformations | rest (s) | together (s) |",
    "|---|---|---|---|---|---|---|---|",
    (["levels-fine", "coarse to fine"], ["levels-late", "coarse to fine, late bubbles"], ["levels-direct", "direct"]
     | . as [$key, $title] | select($d[$key]) | $d[$key].levels
     | (map(.moves) | add) as $moves | (map(.checks) | add) as $checks
     | (map(.operations | to_entries | map(.value) | add) | add) as $operations
     | (map(.seconds.total) | add) as $total
     | ($moves * $m["movement_\($cores)"].median / 1000 / $d.passes_vertices) as $moving
     | ($checks * $m["look_\($cores)"].median / 1000 / $d.passes_vertices) as $looking
     | "| \($title) | \($moves / 1e6 | two) M | \($moving | two) | \($checks / 1e6 | two) M | \($looking | two) | \($operations) | \($total - $moving - $looking | two) | \($total | two) |"),
    ""
   else empty end),
  (if $m.speedup_dynamics then
    "## Threads", "",
    "The fine level, \($cores) threads against one: \($m.speedup_dynamics.median | two) x in movements, \($m.speedup_topology.median | two) x in topology, where operations are applied one after the other.",
    ""
   else empty end),
  (if $d.growth then
    "## Growth", "",
    "An iteration on one thread, every vertex awake; ns per vertex.", "",
    "The last column of times: to read and write in order the 956 bytes per vertex that the streams of a movement (normals and dynamics) have, voxels left out.", "",
    "| vertices | total | topology | normals | dynamics | bytes in order | bytes per vertex | of which the mesh |",
    "|---|---|---|---|---|---|---|---|",
    ($d.growth[] | "| \(.vertices) | \(.total.median | short) [\(.total.min | short) .. \(.total.max | short)] | \(.topology.median | short) | \(.normals.median | short) | \(.dynamics.median | short) | \(.stream | short) | \(.bytes_per_vertex | round) | \(.mesh_bytes_per_vertex | round) |"),
    ""
   else empty end),
  (if $d.peers then
    "## Other programs", "",
    "| program | seconds | vertices | self-intersections |",
    "|---|---|---|---|",
    ($d.peers[] | . as $p | $m[$p] | "| \($d[$p].title) | \(.median | short) [\(.min | short) .. \(.max | short)] of \(.runs | length) | \($d[$p].vertices // "-") | \($d[$p].self_intersections // "-") |"),
    ""
   else empty end),
  "## All measures", "",
  "| measure | median | smallest | largest | runs | hash |",
  "|---|---|---|---|---|---|",
  ($m | to_entries[] | "| \(.key) | \(.value.median | short) \(.value.unit) | \(.value.min | short) | \(.value.max | short) | \(.value.runs | length) | \(.value.hash // "") |")
