#!/usr/bin/env bash
# Who may include whom: the project's files as they are, and made-up ones that tools/rooms must not let
# pass.   tests/tools/test_rooms.sh
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
failures=0
fails() { echo "FAILED: $1"; failures=$((failures + 1)); }

"$root/tools/rooms" || fails "the project's own files"

# made FILE INCLUDED: a line of a file in a folder of made-up ones.
made() {
  mkdir -p "$here/made/$(dirname "$1")"
  printf '#include "%s"\n' "$2" >>"$here/made/$1"
}
# All are looked at by one call.
wrong=()
refuses() {  # FILE INCLUDED WHAT
  made "$1" "$2"
  wrong+=("$1: $3")
}

made engine/guard/made.h engine/mesh/mesh.h
made engine/mesh/made.h engine/mesh/mesh.h
made engine/base/made.h pyramid/executor.h
made engine/api/made.h engine/pellicle.h
made tools/mesh/made.h engine/pellicle.h
made tests/api/made.h engine/pellicle.hpp
made engine/pellicle.hpp pellicle.h
made tools/command/made.h tools/file/failure.h
made tests/mesh/made.h engine/api/handles.h
made tests/perf/made.h perf/truth/scene.h
"$root/tools/rooms" "$here/made" >"$here/said" || fails "includes that may be: $(cat "$here/said")"
rm -r "$here/made"

refuses tests/perf/made.h perf/peers/peer.h 'includes perf/peers/peer.h: nobody includes perf/'
refuses engine/mesh/made.h perf/truth/scene.h 'includes perf/truth/scene.h: nobody includes perf/'
refuses engine/mesh/made.h engine/guard/trials.h 'includes engine/guard/trials.h: engine/guard/ is above'
refuses pyramid/made.h engine/base/vec3.h 'includes engine/base/vec3.h: engine/base/ is above'
refuses kernels/made.cpp pyramid/buffer.h 'includes pyramid/buffer.h: pyramid/ is above'
refuses engine/mesh/made.h engine/pellicle.h 'includes engine/pellicle.h, which is for'
refuses engine/made.h engine/mesh/mesh.h 'is in no room'
refuses engine/other/made.h engine/mesh/mesh.h 'is in no room'
refuses engine/mesh/made.h engine/mesh.h 'includes engine/mesh.h, which is in no room'
refuses engine/mesh/made.h mesh.h 'includes mesh.h: paths begin at the root'
refuses engine/guard/made.h ../mesh/mesh.h 'includes ../mesh/mesh.h: paths begin at the root'
refuses tools/mesh/made.h tools/volume/volume_io.h 'includes tools/volume/volume_io.h: tools/volume/ is above'
refuses tools/mesh/made.h engine/mesh/mesh.h 'includes engine/mesh/mesh.h: hosts include nothing'
refuses tools/command/made.h tests/samples/sample_files.h 'includes tests/samples/sample_files.h: nobody includes tests/'
refuses engine/pellicle.h engine/mesh/mesh.h 'includes engine/mesh/mesh.h: hosts have no other file'
refuses engine/pellicle.hpp engine/mesh/mesh.h 'includes engine/mesh/mesh.h: hosts have no other file'
refuses engine/pellicle.hpp other.h 'includes ./other.h: hosts have no other file'
refuses engine/api/made.h engine/pellicle.hpp 'includes engine/pellicle.hpp, which is for hosts'
"$root/tools/rooms" "$here/made" >"$here/said" && fails "includes that may not be pass"
for line in "${wrong[@]}"; do
  grep -qF -- "$line" "$here/said" || fails "not told: $line; it says: $(cat "$here/said")"
done
rm -r "$here/made"

# The drawing is that of the includes.
made engine/guard/made.h engine/mesh/mesh.h
printf '<!-- tools/rooms --draw -->\n<!-- end -->\n' >"$here/made/engine/README.md"
"$root/tools/rooms" "$here/made" >/dev/null && fails "a drawing that is not there passes"
"$root/tools/rooms" --draw "$here/made" >/dev/null || fails "no drawing"
"$root/tools/rooms" "$here/made" >/dev/null || fails "its own drawing does not pass"
grep -q 'guard --> mesh' "$here/made/engine/README.md" || fails "the drawing has no guard --> mesh"

[ $failures -eq 0 ] && echo "rooms: every made-up include is told"
exit $((failures > 0))
