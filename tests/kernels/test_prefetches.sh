#!/usr/bin/env bash
# That the compiler has left the kernels what fetches voxels and streams early:
#   test_prefetches.sh LIBRARY
# It may take a function that does only that for one without effect. Skipped without objdump.
set -euo pipefail
command -v objdump >/dev/null || { echo "objdump is not installed; skipped"; exit 77; }
# x86: into the second cache, as kernels/ring-inl.h asks for; ARM has one name for all.
count=$(objdump -d --no-show-raw-insn "$1" | grep -cE 'prefetcht[12]|prfm' || true)
[ "$count" -ge 100 ] || { echo "$1: $count instructions fetch early, at least 100 are expected" >&2; exit 1; }
