#!/usr/bin/python3
"""Where `pellicle extract` puts the templates of Debian's mricron-data, against nibabel.

tests/tools/nifti_templates.py PELLICLE [FILE...]

Draws the surface of the object of each file (all labels, or the brighter values) and tells how far
its centroid lies from that of the voxels by nibabel's affine, mm. Exit code 1 where one is off by
more than the shortest side of a voxel. Needs python3-nibabel and, without FILEs, mricron-data.
"""

import glob
import json
import os
import subprocess
import sys
import tempfile

import nibabel
import numpy as np


def centroid_of_voxels(inside, affine):
    return nibabel.affines.apply_affine(affine, np.argwhere(inside).mean(axis=0))


def centroid_of_surface(pellicle, path, options, folder):
    mesh, told = os.path.join(folder, "mesh.ply"), os.path.join(folder, "mesh.json")
    lines = subprocess.run(
        [pellicle, "extract", path, "-o", mesh, "--space", "ras", "--levels", "1", "--init", "iso",
         "--pad", "0", "--curvature", "0.05", "--max-iterations", "9", "--no-late-bubbles", "--quiet", *options],
        check=True, capture_output=True, text=True).stderr
    subprocess.run([pellicle, "measure", mesh, "--json", told], check=True, capture_output=True)
    with open(told) as file:
        return np.array(json.load(file)["whole"]["centroid"]), lines


def main(pellicle, paths):
    wrong = 0
    print(f"{'file':44} {'off by, mm':>11}  told")
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            image = nibabel.load(path)
            voxels = np.asarray(image.dataobj)
            iso = 0.5 if np.issubdtype(voxels.dtype, np.integer) else voxels.max() / 4
            if len(np.unique(voxels[::3, ::3, ::3])) > 200:
                iso = float(voxels.max()) / 4
            expected = centroid_of_voxels(voxels >= iso, image.affine)
            found, lines = centroid_of_surface(
                pellicle, path, ["--iso", str(iso), "--window", f"{iso - 1},{iso + 1}"], folder)
            off = np.linalg.norm(found - expected)
            wrong += off > min(image.header.get_zooms()[:3])
            told = "forms differ" if "differ" in lines else ""
            print(f"{os.path.basename(path):44} {off:11.3f}  {told}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:] or
                  sorted(glob.glob("/usr/share/mricron/templates/*.nii.gz"))))
