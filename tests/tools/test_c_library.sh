#!/usr/bin/env bash
# The surface does not depend on the C library: nothing that could move it calls a mathematical
# function whose result is not exact or rounded correctly, and the C library's own choice, made by
# what the processor can do, changes nothing.
#   tests/tools/test_c_library.sh PELLICLE ARCHIVE...   exit code 77 where there is no glibc and no nm
# PELLICLE is - where the archives are another machine's, for which CXX then compiles.
set -uo pipefail
library=$(${CXX:-c++} -print-file-name=libm.so.6)
if ! [ -e "$library" ] || ! command -v nm >/dev/null; then echo "skipped: no glibc, or no nm"; exit 77; fi
pellicle=$1
if [ "$pellicle" != - ]; then pellicle=$(realpath "$pellicle"); fi
shift
failures=0

# Those of C17's annex F that are exact or rounded correctly, and the environment of arithmetic.
exact=' sqrt floor ceil trunc round rint nearbyint fabs fmod remainder ldexp scalbn frexp modf
  nextafter copysign fmin fmax fdim ilogb logb lround llround lrint llrint fma '
# What is told of a surface and never moves it: measures, and how far a run is.
told=' curvature:atan2 edge_ring:atan2 mesh_check:atan2 progress_estimate:log progress_estimate:expm1 '
told+='volume_frame:atan2 vertex_colours:pow '

# "object function" for each function of the mathematical library that an object calls. Files of the tools
# are compiled together, but for those of which something is told.
calls() {
  nm -D --defined-only "$library" | sed 's/.* //; s/@.*//' | sort -u >functions
  nm -A -u "$@" | sed -E 's/.*:([^:]*)\.c(pp|xx)\.o: *U /\1 /' | awk 'NR==FNR{is[$1]; next} $2 in is' functions -
}

here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
archives=()
for archive in "$@"; do archives+=("$(realpath "$archive")"); done
cd "$here" || exit 1

calls "${archives[@]}" >called
grep -q "^exponential ldexp" called || { echo "FAILED: nm does not tell what exponential.cpp calls"; failures=1; }
if [ "$pellicle" != - ] && ! grep -q "^vertex_colours pow" called; then
  echo "FAILED: nm does not tell what vertex_colours.cpp calls"
  failures=$((failures + 1))
fi
while read -r object function; do
  case $function in fe[a-z]*) continue ;; esac
  case $exact in *[[:space:]]${function%f}[[:space:]]* | *[[:space:]]"$function"[[:space:]]*) continue ;; esac
  case $told in *" $object:$function "*) continue ;; esac
  echo "FAILED: $object calls $function, whose last bits differ between C libraries"
  failures=$((failures + 1))
done <called

if [ "$pellicle" = - ]; then
  if [ "$failures" -eq 0 ]; then echo "every mathematical function that is called is exact"; fi
  exit $((failures > 0))
fi

# hash NAME [VARIABLE=VALUE]: of the surface.
hash() {
  env "${@:2}" "$pellicle" extract chain.nrrd -o "$1.ply" --iso 0.07 --feature gradient-norm --sigma 1.3 \
    --levels 1 --max-iterations 20 --quiet --report "$1.json" || return
  sed -nE 's/^ *"hash": "([0-9a-f]{16})".*/\1/p' "$1.json"
}
"$pellicle" phantom chain --size 40 -o chain.nrrd || failures=$((failures + 1))
with=$(hash with)
without=$(hash without GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2_Usable,-AVX2,-FMA4)
echo "with fused multiply-add: $with, without: $without"
if [ -z "$with" ] || [ "$with" != "$without" ]; then
  echo "FAILED: other surfaces"
  failures=$((failures + 1))
fi
exit $((failures > 0))
