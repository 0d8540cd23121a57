#!/usr/bin/env bash
# What hosts get: the tree that is installed, what the library exports, and two hosts built against
# it by find_package and by pkg-config, with the shared and with the static library.
#   tests/consumers/test_install.sh BUILD_FOLDER
set -uo pipefail
build=$(realpath "$1")
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
failures=0

fails() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# quietly WHAT COMMAND...: its output is shown where it fails.
quietly() {
  local what=$1
  shift
  "$@" >"$here/log" 2>&1 </dev/null && return
  fails "$what"
  tail -30 "$here/log" | sed 's/^/    /'
  return 1
}

# Moved after it has been installed: nothing in it may say where it was.
quietly "installing" cmake --install "$build" --prefix "$here/first" || exit 1
mv "$here/first" "$here/moved"
prefix=$here/moved
libdir=$(dirname "$(find "$prefix" -name libpellicle.so)")
library=$libdir/libpellicle.so
header=$prefix/include/pellicle.h

# ---- what is there
headers=$(cd "$prefix/include" && find . -type f | sort | tr '\n' ' ')
[ "$headers" = "./pellicle.h ./pellicle.hpp " ] || fails "other headers than pellicle.h and .hpp: $headers"
for file in libpellicle.a pkgconfig/pellicle.pc cmake/Pellicle/PellicleConfig.cmake \
  cmake/Pellicle/PellicleConfigVersion.cmake; do
  [ -s "$libdir/$file" ] || fails "not installed: $file"
done
named=$(grep -rIl -e "$build" -e "$source" -e "$here/first" "$prefix")
[ -z "$named" ] || fails "paths of the build in $named"
if grep -rIiq mimalloc "$libdir/cmake/Pellicle" "$libdir/pkgconfig"; then
  fails "a host is told to link mimalloc, which would replace its malloc"
fi
needed=$(readelf -d "$library" | sed -nE 's/.*NEEDED.*\[(.*)\]/\1/p')
grep -q mimalloc <<<"$needed" && fails "the library links mimalloc, which replaces the host's malloc"

# ---- versions: the header is where they come from
number() { sed -nE "s/^#define PLC_VERSION_$1 ([0-9]+)$/\1/p" "$header"; }
version=$(number MAJOR).$(number MINOR).$(number PATCH)
soname=$(readelf -d "$library" | sed -nE 's/.*SONAME.*\[(.*)\]/\1/p')
[ "$soname" = "libpellicle.so.$(number MAJOR).$(number MINOR)" ] || fails "the SONAME is $soname"
[ -f "$library.$version" ] || fails "no libpellicle.so.$version"
[ "$("$prefix/bin/pellicle" --version)" = "$version" ] || fails "pellicle --version is not $version"
export PKG_CONFIG_PATH=$libdir/pkgconfig
[ "$(pkg-config --modversion pellicle)" = "$version" ] || fails "pkg-config's version is not $version"
PKG_CONFIG_LIBDIR=$libdir/pkgconfig quietly "a host of the shared library needs no other package" \
  pkg-config --cflags --libs pellicle
found=$(ldd "$prefix/bin/pellicle" | awk -v name="$soname" '$1 == name {print $3}')
[ "$(realpath "$found")" = "$library.$version" ] || fails "the command finds $found, not $library"

"$prefix/bin/pellicle" --man | cmp -s - "$prefix/share/man/man1/pellicle.1" ||
  fails "the manual page is not that of the command"
[ -s "$prefix/share/bash-completion/completions/pellicle" ] || fails "not installed: the completion for bash"

module=$libdir/pellicle/cli-modules/PellicleExtract
"$module" --xml >"$here/module.xml" 2>&1
"$prefix/bin/pellicle" extract --xml | cmp -s - "$here/module.xml" ||
  fails "Slicer's module does not run the command: $(head -3 "$here/module.xml")"

"${module%Extract}Labels" --xml >"$here/module.xml" 2>&1
"$prefix/bin/pellicle" extract --xml-labels | cmp -s - "$here/module.xml" ||
  fails "Slicer's module of labels does not run the command: $(head -3 "$here/module.xml")"

# ---- exports: just what the header declares, with a version
declarations=$(grep -c '^PLC_API' "$header")
sed -nE 's/^PLC_API .*[ *](plc_[a-z0-9_]+)\(.*/\1/p' "$header" | sort >"$here/declared"
[ "$(wc -l <"$here/declared")" -eq "$declarations" ] || fails "not every PLC_API could be read"
nm -D --defined-only "$library" | awk '$2 != "A" {print $3}' | sort >"$here/exported"
sed 's/$/@@PELLICLE_0/' "$here/declared" | diff - "$here/exported" >"$here/difference" ||
  fails "declared (<) and exported (>) differ: $(grep '^[<>]' "$here/difference" | head -20)"

# The layer for C++ has all that the header declares. What tells of the library itself needs no layer.
while read -r name; do
  case $name in plc_version | plc_version_string | plc_parameter_at) continue ;; esac
  grep -qw "$name" "$prefix/include/pellicle.hpp" || fails "pellicle.hpp does not call $name"
done <"$here/declared"

# ---- hosts
cp -r "$source/tests/consumers" "$here/consumers"

# uses SHARED_OR_STATIC PROGRAM: fails unless it was linked with that library.
uses() {
  local wanted=$1 dynamic
  dynamic=$(readelf -d "$2" | grep -c 'NEEDED.*libpellicle')
  if [ "$wanted" = shared ] && [ "$dynamic" -eq 0 ]; then fails "$2: not the shared library"; fi
  if [ "$wanted" = static ] && [ "$dynamic" -ne 0 ]; then fails "$2: not the static library"; fi
}

runs() {  # KIND PROGRAM ARGUMENTS...
  local kind=$1
  shift
  uses "$kind" "$1"
  quietly "$* ($kind)" env LD_LIBRARY_PATH="$libdir" "$@"
}

for host in host_c host_cpp; do
  folder=$here/consumers/$host
  for kind in shared static; do
    target=Pellicle::pellicle
    make_static=()
    if [ $kind = static ]; then target=Pellicle::pellicle_static make_static=(STATIC=1); fi
    out=$here/$host-$kind
    quietly "$host by find_package, $kind" cmake -S "$folder" -B "$out" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_PREFIX_PATH="$prefix" -DHOST_PELLICLE=$target &&
      quietly "$host by find_package, $kind" cmake --build "$out" &&
      runs $kind "$out/$host"
    rm -f "$folder/$host"
    quietly "$host by pkg-config, $kind" make -C "$folder" "${make_static[@]}" &&
      runs $kind "$folder/$host"
  done
done
runs shared "$here/host_c-shared/host_c" "$here/torus.obj"
# As engine/README.md has it: the host finds the library by itself.
# shellcheck disable=SC2046
quietly "a host that is told where the library lies" cc "$here/consumers/host_c/host.c" \
  $(pkg-config --cflags --libs pellicle) -Wl,-rpath,"$(pkg-config --variable=libdir pellicle)" -lm \
  -o "$here/host_rpath" && quietly "a host that knows where the library lies" "$here/host_rpath"
quietly "check of what host_c writes" "$prefix/bin/pellicle" check "$here/torus.obj"

# Another minor version than there is, and a component that there is not, are refused.
printf 'cmake_minimum_required(VERSION 3.18)\nproject(p LANGUAGES C)\nfind_package(Pellicle ${ASK} REQUIRED)\n' \
  >"$here/CMakeLists.txt"
for ask in "99.0" "0.2" "COMPONENTS;nonsense"; do
  if cmake -S "$here" -B "$here/ask" -DCMAKE_PREFIX_PATH="$prefix" "-DASK=$ask" >"$here/log" 2>&1
  then fails "find_package(Pellicle $ask) finds $version"; fi
  grep -qi pellicle "$here/log" || fails "find_package(Pellicle $ask) does not say what is wrong"
done

# ---- without oneTBB
# Only base/tbb_arena.cpp is compiled otherwise then (engine/CMakeLists.txt): all else is taken from the build.
without=$here/without
quietly "configuring without oneTBB" cmake -G "Unix Makefiles" -S "$source" -B "$without" -DPELLICLE_TBB=OFF \
  -DCMAKE_BUILD_TYPE=Release -DPELLICLE_TOOLS=OFF -DPELLICLE_TESTS=OFF -DPELLICLE_SHARED=OFF
quietly "compiling without oneTBB" cmake --build "$without/engine" --target base/tbb_arena.cpp.o
cp "$libdir/libpellicle.a" "$without/engine/"
ar d "$without/engine/libpellicle.a" tbb_arena.cpp.o
ar qs "$without/engine/libpellicle.a" "$(find "$without" -name tbb_arena.cpp.o)"
quietly "installing without oneTBB" cmake --install "$without" --prefix "$here/alone"
alone=$(dirname "$(find "$here/alone" -name libpellicle.a)")
nm -u "$alone/libpellicle.a" | grep -q "U _ZN3tbb" && fails "the library without oneTBB calls it"
named=$(grep -rIil tbb "$alone/pkgconfig" "$alone"/cmake/Pellicle/Pellicle-*.cmake)
[ -z "$named" ] || fails "installed without oneTBB, but named in $named"
for host in host_c host_cpp; do
  folder=$here/consumers/$host
  out=$here/$host-alone
  # As on a machine without it.
  quietly "$host without oneTBB" cmake -S "$folder" -B "$out" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$here/alone" -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON -DHOST_PELLICLE=Pellicle::pellicle &&
    quietly "$host without oneTBB" cmake --build "$out" && runs static "$out/$host"
  rm -f "$folder/$host"
  quietly "$host by pkg-config without oneTBB" env PKG_CONFIG_PATH="$alone/pkgconfig" make -C "$folder" STATIC=1 &&
    runs static "$folder/$host"
  readelf -d "$out/$host" "$folder/$host" | grep -q tbb && fails "$host links oneTBB, which it does not need"
done
# With it a host of the static library needs it, and is told.
if cmake -S "$here/consumers/host_c" -B "$here/missing" -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON -DHOST_PELLICLE=Pellicle::pellicle_static >"$here/log" 2>&1
then fails "the static library is found without the oneTBB that it needs"; fi

if [ $failures -gt 0 ]; then echo "$failures failures"; exit 1; fi
echo "All as expected."
