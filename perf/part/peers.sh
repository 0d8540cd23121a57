# Other programs at the same task, those whose libraries are there: perf/peers/peer_*.cpp. Reading is
# not in their times, which they take themselves.
peer() { "$build/perf/peers/$1" "${@:2}" >"$report"; }
# Name of the variant and of its measure; program; its arguments.
while read -r name program arguments; do
  if [ -x "$build/perf/peers/$program" ]; then
    # shellcheck disable=SC2086
    variant "$name" peer "$program" "$head_ct" $arguments
  else
    echo "peers: $program is not built, left out"
  fi
done <<END
peer_pyramid peer_pyramid
peer_flying_edges peer_flying_edges
peer_remeshing peer_remeshing
peer_make_mesh peer_make_mesh
peer_level_set peer_level_set 3
peer_level_set_direct peer_level_set 0
END
run_variants
for name in "${variants[@]}"; do
  cat "$dir/$name".*.json | jq .seconds | record "$name" s ""
  jq 'del(.seconds)' "$dir/$name.1.json" | detail "$name"
done
printf '%s\n' "${variants[@]}" | jq -R 'select(. != "")' | jq -s . | detail peers
