#!/usr/bin/env bash
# Meshes of every format, read by others: see mesh_readers.py.   tests/tools/test_mesh_readers.sh PELLICLE
set -uo pipefail
# That of Debian, which has Debian's nibabel, where there is another one, too.
python=$(for p in /usr/bin/python3 python3; do command -v $p && break; done)
[ -n "$python" ] || { echo "skipped: no python3"; exit 77; }
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
"$python" -B "$(dirname "${BASH_SOURCE[0]}")/mesh_readers.py" "$(realpath "$1")" "$here"
