# Memory for a volume of 1024^3 voxels of 8 bits, of which perf/large writes a report like that of
# `pellicle extract`.
if [ ! -x "$root/perf/large" ]; then
  echo "large: there is no perf/large, left out"
else
  large() { PELLICLE=$pellicle "$root/perf/large" "$report"; }
  variant large large
  run_variants
  # Beyond the volume itself.
  measure large_memory GiB large '(.peak_rss_bytes - 1073741824) / 1073741824'
  measure large s large .seconds.total
fi
