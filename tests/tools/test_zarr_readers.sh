#!/usr/bin/env bash
# OME-Zarr, beside Debian's zarr: see zarr_readers.py.   tests/tools/test_zarr_readers.sh PELLICLE
set -uo pipefail
# That of Debian, which has Debian's zarr, where there is another one, too.
python=$(for p in /usr/bin/python3 python3; do command -v $p && break; done)
[ -n "$python" ] || { echo "skipped: no python3"; exit 77; }
"$python" -c 'import zarr' 2>/dev/null || { echo "skipped: no python3-zarr"; exit 77; }
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
"$python" -B "$(dirname "${BASH_SOURCE[0]}")/zarr_readers.py" "$(realpath "$1")" "$here"
