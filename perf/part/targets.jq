# The rows of targets.md. Input: a result of perf/run; $targets: perf/part/targets.json.
def short: if . >= 100 then round elif . >= 10 then . * 10 | round / 10
  else . * 1000 | round / 1000 end;
def spread: "\(.median | short) \(.unit) [\(.min | short) .. \(.max | short)] of \(.runs | length)";

. as $result
| $targets[0][]
| (.measure | sub("CORES"; $result.machine.cores | tostring)) as $name
| $result.measures[$name] as $ours
| (if .check then $result.details[.check] else {met: true} end) as $check
| (if .sense == "most" then "\(.target) \(.unit)" else "at least \(.target) \(.unit)" end) as $goal
| (.comparison | map(
    (if .measure then $result.measures[.measure] else null end) as $peer
    | (if .measure then $result.details[.measure] else null end) as $more
    | (if $more then $more.self_intersections else .intersections end) as $meets
    | .title + " " + (if $peer then "**\($peer | spread)**" else .value end)
      + (if $meets and $meets > 0 then " (\($meets) self-intersections)" else "" end))
  | join("; ")) as $comparison
| (if $ours == null then "-"
   elif $check == null then "surface not checked"
   elif ($check.met | not) then "no: not the surface asked for"
   elif (if .sense == "most" then $ours.median <= .target else $ours.median >= .target end)
   then "yes" else "no" end) as $met
| "| \(.title) | \($comparison) | \($goal) | \(if $ours then $ours | spread else "not measured" end) | \($met) |"
