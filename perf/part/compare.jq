# What perf/compare prints. $before, $after: results of perf/run; $noise in percent; $allow: other
# hashes are no failure. Output: {lines, failures}.
def short: if . >= 100 then round elif . >= 10 then . * 10 | round / 10
  else . * 1000 | round / 1000 end;
def padded($n): tostring | . + " " * ([$n - length, 0] | max);
# Of these units more is better.
def gains: .unit == "x" and (.name | startswith("speedup"));

def judged($noise):
  (.after.median / .before.median) as $ratio
  | (if gains then {slower: (1 / $ratio), apart: (.after.max < .before.min), better: (.before.max < .after.min)}
     else {slower: $ratio, apart: (.after.min > .before.max), better: (.before.min > .after.max)} end) as $j
  | . + {ratio: $ratio,
      verdict: (if $j.slower > 1 + $noise / 100 and $j.apart then "WORSE"
        elif $j.slower > 1 + $noise / 100 then "worse, within the spread"
        elif $j.slower < 1 / (1 + $noise / 100) and $j.better then "better"
        else "" end),
      hash: (if .before.hash != null and .after.hash != null and .before.hash != .after.hash
        then "OTHER RESULT" else "" end)};

$before[0] as $a | $after[0] as $b
| [$a.measures | keys_unsorted[] | select($b.measures[.] != null)
   | {name: ., unit: $a.measures[.].unit, before: $a.measures[.], after: $b.measures[.]}
   | select(.before.median > 0) | judged($noise)] as $rows
| ([$a.measures | keys[] | select($b.measures[.] == null)]) as $gone
| ($rows | map(select(.verdict == "WORSE")) | length) as $worse
| ($rows | map(select(.hash != "")) | length) as $other
| {failures: ($worse + (if $allow then 0 else $other end) + (if $rows == [] then 1 else 0 end)),
   lines: (
     ["\($a.date) \($a.commit) against \($b.date) \($b.commit), noise \($noise) %"]
     + [("machine", "compiler", "flags") as $k | select($a[$k] != $b[$k])
        | "warning: another \($k): \($a[$k] | tostring) against \($b[$k] | tostring)"]
     + [$rows[] | "\(.name | padded(28)) \(.before.median | short | padded(9)) \(.after.median | short | padded(9)) \(.unit | padded(5)) \(.ratio * 1000 | round / 1000 | padded(6)) \([.verdict, .hash] | map(select(. != "")) | join(", "))"
        | sub(" +$"; "")]
     + (if $gone == [] then [] else ["not measured again: \($gone | join(", "))"] end)
     + ["\($worse) worse, \($other) with another result, of \($rows | length) measures in both"])}
