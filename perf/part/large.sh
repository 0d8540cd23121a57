# Memory for a volume of 1024^3 voxels of 8 bits, by perf/large, which also checks the surface.
large() {
  local log=$dir/$name.log written=$out/large/blobs-1024.json
  rm -f "$written"
  # It fails where the target is not met, too, which is no failure of the measurement.
  PELLICLE=$pellicle LARGE=$out/large "$root/perf/large" >"$log" 2>&1 ||
    grep -q 'above the volume and 2 GiB' "$log" || { cat "$log" >&2; return 1; }
  mv "$written" "$report"
}

if [ ! -x "$root/perf/large" ]; then
  echo "large: there is no perf/large, left out"
else
  variant large large
  run_variants
  # Beyond the volume itself.
  measure large_memory GiB large \
    '(.peak_rss_bytes - .input.dims[0] * .input.dims[1] * .input.dims[2]) / 1073741824'
  measure large s large '.seconds | .pyramid + .evolution'
fi
