# The finest level is where the time goes.
counts=()
for ((t = 1; t < cores; t *= 2)); do counts+=("$t"); done
counts+=("$cores")
for t in "${counts[@]}"; do
  variant "threads-$t" extract "$head_ct" "${bone[@]}" --levels 3 --no-late-bubbles --threads "$t"
done
run_variants
same_hash "${variants[@]}" >/dev/null

for t in "${counts[@]}"; do
  measure "fine_level_$t" s "threads-$t" '.levels[-1].seconds.total'
  # Run by run against one thread in the same turn.
  for report in "$dir/threads-$t".*.json; do
    one=${report/threads-$t./threads-1.}
    [ ! -e "$one" ] || jq -s '.[1].levels[-1].seconds.total / .[0].levels[-1].seconds.total' \
      "$report" "$one"
  done | record "speedup_$t" x ""
done
# Of all threads, by parts.
for part in topology dynamics; do
  for report in "$dir/threads-$cores".*.json; do
    jq -s --arg part "$part" '.[1].levels[-1].seconds[$part] / .[0].levels[-1].seconds[$part]' \
      "$report" "${report/threads-$cores./threads-1.}"
  done | record "speedup_$part" x ""
done
printf '%s\n' "${counts[@]}" | jq -s . | detail threads
