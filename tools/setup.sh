#!/usr/bin/env bash
# Installs what is missing of the Debian packages that the named purposes need:
#   tools/setup.sh [build] [test] [python] [demo] [lint] [compilers] [perf] [peers] [fuzz]
#     [package] [coverage] [valgrind] [page] [view] [arm] [counts] [wasm] [cohort] [windows]
# Without a purpose: build and test, as cmake builds the tests, too, unless told otherwise.
# Does nothing, and needs no rights and no network, where all of them are there.
set -euo pipefail

build=(g++ cmake make libhwy-dev libtbb-dev libmimalloc2.0 libinsighttoolkit5-dev libarchive-dev
  libexpat1-dev zlib1g-dev libembree-dev libpng-dev libcli11-dev nlohmann-json3-dev libxxhash-dev
  libblosc-dev libzstd-dev libdraco-dev)
test=(catch2 invesalius-examples jq mricron-data pkg-config python3)
python=(python3-dev pybind11-dev python3-numpy python3-nibabel python3-pip python3-venv python3-setuptools
  python3-wheel python3-pytest python3-mypy)
python+=(python3-nbconvert python3-ipykernel python3-meshio)  # the tutorial; one that takes meshes
python+=(python3-distributed)  # what runs pellicle.distributed
demo=(invesalius-examples)
test+=(python3-nibabel python3-zarr gmsh tetgen man-db)  # that read what the command writes
lint=(clang-format clang-tidy)
compilers=(clang)
perf=(jq gnuplot-nox invesalius-examples libbenchmark-dev)
fuzz=(clang libclang-rt-14-dev python3)  # libFuzzer and the sanitizers
peers=(libvtk9-dev libcgal-dev)  # programs that perf/run compares with
package=(dpkg-dev file)
coverage=(gcovr jq)
valgrind=(valgrind)
arm=(g++-aarch64-linux-gnu qemu-user-static libtbb-dev:arm64 libhwy-dev:arm64 libmimalloc2.0:arm64)
counts=(qemu-user)  # what perf/instructions counts by: plugins need the one that is not static
wasm=(emscripten nodejs catch2)
windows=(g++-mingw-w64-x86-64-posix)
page=(nodejs npm)  # the page of pellicle view
view=("${page[@]}" chromium)  # its test
cohort=(slurmctld slurmd slurm-client munge snakemake)  # what runs pellicle cohort in its tests

[ $# -gt 0 ] || set -- build test
wanted=()
for purpose in "$@"; do
  case $purpose in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    python) wanted+=("${python[@]}") ;;
    demo) wanted+=("${demo[@]}") ;;
    lint) wanted+=("${lint[@]}") ;;
    compilers) wanted+=("${compilers[@]}") ;;
    perf) wanted+=("${perf[@]}") ;;
    fuzz) wanted+=("${fuzz[@]}") ;;
    peers) wanted+=("${peers[@]}") ;;
    package) wanted+=("${package[@]}") ;;
    coverage) wanted+=("${coverage[@]}") ;;
    valgrind) wanted+=("${valgrind[@]}") ;;
    page) wanted+=("${page[@]}") ;;
    view) wanted+=("${view[@]}") ;;
    arm) wanted+=("${arm[@]}") ;;
    counts) wanted+=("${counts[@]}") ;;
    wasm) wanted+=("${wasm[@]}") ;;
    cohort) wanted+=("${cohort[@]}") ;;
    windows) wanted+=("${windows[@]}") ;;
    *)
      echo "setup.sh: unknown purpose $purpose: build, test, python, demo, lint, compilers, perf," \
        "peers, fuzz, package, coverage, valgrind, page, view, arm, counts, wasm, cohort or windows" >&2
      exit 2
      ;;
  esac
done

# Programs that may have come another way than from Debian's packages.
declare -A program=([nodejs]=node [npm]=npm [chromium]=chromium)
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  if [ "$status" = installed ] || command -v "${program[$package]:-}" >/dev/null; then continue; fi
  missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Needed, and only root can install them: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
if [[ " ${missing[*]} " == *:arm64\ * ]]; then "${as_root[@]}" dpkg --add-architecture arm64; fi
"${apt[@]}" update </dev/null
"${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null
