#!/usr/bin/env bash
# `pellicle extract` as a command-line module of 3D Slicer.   tests/tools/test_slicer.sh PELLICLE
set -uo pipefail
pellicle=$(realpath "$1")
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
python3 "$(dirname "${BASH_SOURCE[0]}")/slicer_host.py" "$pellicle" "$here"
