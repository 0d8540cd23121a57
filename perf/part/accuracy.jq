# Tables of perf/accuracy.

def fixed(digits): if . == null then "-" else
    pow(10; digits) as $p | (. < 0) as $minus | fabs * $p | round | tostring
    | (if digits == 0 then . else
        (("0" * ([digits + 1 - length, 0] | max)) // "") + . | .[:-digits] + "." + .[-digits:] end)
    | (if $minus and test("[1-9]") then "-" else "" end) + . end;
def row: "| \(map(tostring) | join(" | ")) |";
def percent(of): if . == null or of == null then "-" else (. / of - 1) * 100 | fixed(2) end;

def titles: {pellicle: "**Pellicle**", flying_edges: "FlyingEdges", windowed_sinc: "windowed sinc",
  make_mesh: "make_mesh_3", level_set: "level set"};
def title: titles[.] // .;

# What a result is compared by: the larger RMS of both ways, against the iso-surface; where there is
# none, against the object. Null where there is no result.
def score: (.iso // .object) | if . == null then null else [.to_truth.rms, .from_truth.rms] | max end;

# Of a deviation, five cells.
def cells: if . == null then ["-", "-", "-", "-", "-"] else
  [(.to_truth.bias | fixed(3)), (.to_truth.rms | fixed(3)), (.to_truth.p95 | fixed(3)),
   (.to_truth.max | fixed(2)), "\(.from_truth.rms | fixed(3)), \(.from_truth.far * 100 | fixed(1)) %"] end;

def truth_line: def one: "\(.components) in number, genus \(.genus)";
  "Components of the object: \(.truth.object | one); of the iso-surface: " +
  (if .truth.iso then .truth.iso | one else "the blur has left none" end) + ".";

def case_table: .truth as $truth | "", "### \(.scene)", "", truth_line, "",
  (["program", "iso-surface: bias", "RMS", "95 %", "largest", "back: RMS, farther than 1/2",
    "object: bias", "RMS", "95 %", "largest", "back: RMS, farther than 1/2", "area, %", "volume, %",
    "curvature", "components", "genus", "vertices", "s"] | row),
  ([range(18) | "---"] | "|\(join("|"))|"),
  (.results | to_entries[] | .value as $r | if $r.object then
    [(.key | title)] + ($r.iso | cells) + ($r.object | cells) +
    [($r.area | percent($truth.object.area)), ($r.volume | percent($truth.object.volume)),
     ($r.curvature | fixed(3)), $r.components, (if $r.genus < 0 then "open" else $r.genus end),
     $r.vertices, ($r.seconds | fixed(2))] | row
   else [(.key | title), ($r.none // "no surface")] + [range(16) | "-"] | row end);

# Of the cases: RMS of all programs in one row.
def names: [.cases[].results | keys_unsorted[]] | reduce .[] as $n ([]; if index($n) then . else . + [$n] end);
def short: sub("--sigma"; "blur") | sub("--noise"; "noise") | sub("--voxels"; "voxels") | gsub("--"; "");
def summary: names as $names
  | (["scene"] + ($names | map(title)) + ["components, theirs: ours"] | row),
    ([range(($names | length) + 2) | "---"] | "|\(join("|"))|"),
    (.cases[] | . as $case | ([.results[] | score | numbers] | min) as $best
     | [(.scene | short)] + [$names[] | $case.results[.] | if . == null then "-" else
         score as $s | if $s == null then "none" elif $s == $best then "**\($s | fixed(3))**"
         else $s | fixed(3) end end] +
       ["\((.truth.iso // .truth.object).components): \(.results.pellicle.components // "-")"] | row);

# Where another program is nearer, by more than rounding.
def losses: [.cases[] | . as $case | .results.pellicle | select(. != null) | score as $ours
  | [$case.results | to_entries[] | select(.key != "pellicle") | .key as $key
     | .value | score | numbers | {key: $key, score: .}
     | select($ours == null or .score < $ours - 0.0005)] | select(length > 0) | sort_by(.score)
  | {scene: $case.scene, ours: $ours, by: .}];

def report: losses as $losses | ([.cases[] | select(.results.pellicle)] | length) as $cases |
  "# Accuracy", "",
  "Of `perf/accuracy` on \(.date), commit \(.commit), on \(.machine)" +
    (if .options == "" then "" else ", with `\(.options)`" end) + ". Every program with the",
  "same parameters for all scenes; [perf/README.md](../README.md#accuracy) tells which, and what is measured. Distances in voxels.", "",
  "## Summary", "",
  "RMS of the distance, the larger of both ways, against the iso-surface of the image without noise",
  "(against the object where the blur has left none). The best is bold.", "", summary, "",
  "Another program is nearer in \($losses | length) of \($cases) scenes:", "",
  ($losses[] | "- \(.scene | short): ours \(.ours | fixed(3)), " +
    (.by | map("\(.key | title) \(.score | fixed(3))") | join(", "))), "",
  "![RMS](accuracy.png)", "",
  "## Scene by scene", "",
  "Bias, RMS, 95th percentile and largest size of the signed distance, positive outside, from 200,000",
  "places spread evenly over the result; `back`: the same of the truth to the result, RMS and the part",
  "that is farther than half a voxel. Area and volume against the object's. Curvature: the median of how",
  "far the mean curvature at vertices is off the object's, 1/voxel. Seconds without reading and writing.",
  (.cases[] | case_table);
