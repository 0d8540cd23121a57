#!/usr/bin/env python3
"""tests/tools/nifti_of_nrrd.py IN.nrrd OUT.nii.gz: a phantom of the command (raw floats) as NIfTI-1."""
import gzip
import struct
import sys

head, _, voxels = open(sys.argv[1], "rb").read().partition(b"\n\n")
fields = dict(line.split(": ", 1) for line in head.decode().splitlines()[1:] if ": " in line)
if fields["type"] != "float" or fields["encoding"] != "raw":
    sys.exit(f"{sys.argv[1]}: is not made of raw floats")
nx, ny, nz = map(int, fields["sizes"].split())
header = bytearray(352)
struct.pack_into("<i", header, 0, 348)
struct.pack_into("<8h", header, 40, 3, nx, ny, nz, 1, 1, 1, 1)
struct.pack_into("<2h", header, 70, 16, 32)  # float, of 32 bits
struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 0, 0, 0, 0)
struct.pack_into("<f", header, 108, 352)
struct.pack_into("<h", header, 254, 1)  # an sform
for row in range(3):
    struct.pack_into("<4f", header, 280 + 16 * row, *[float(row == k) for k in range(3)], 0)
header[344:348] = b"n+1\0"
with gzip.open(sys.argv[2], "wb") as out:
    out.write(header + voxels)
