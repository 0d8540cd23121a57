"""Where NIfTI files lie: the command, this module and nibabel agree."""

import json
import os
import subprocess

import nibabel
import numpy as np
import pytest

import pellicle

COMMAND = os.environ.get("PELLICLE_COMMAND")
pytestmark = pytest.mark.skipif(COMMAND is None, reason="there is no command")


def lopsided():
    """[i, j, k] values of a body without any symmetry, whose mirror images show."""
    i, j, k = np.mgrid[:26, :22, :18]
    body = 7 - np.sqrt(((i - 11) / 1.3) ** 2 + (j - 10) ** 2 + ((k - 8) / 0.8) ** 2)
    ear = 4 - np.sqrt((i - 19) ** 2 + (j - 14) ** 2 + (k - 11) ** 2)
    return np.clip(0.5 + np.maximum(body, ear), 0, 1).astype(np.float32)


def rotation(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array(
        [[1, 0, 0], [0, c, -s], [0, s, c]]
    )


def affine(linear, origin):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, origin
    return matrix


ROTATED = affine(rotation(0.4) * [1, 1.2, 1.5], [-20, 5, 31])
MIRRORED = affine(rotation(-0.3) * [-1, 1.2, 1.5], [90, -12, 3])
SHEARED = affine([[1, 0.3, 0.1], [0, 1.2, -0.4], [0.1, 0, 1.5]], [4, 50, -60])
FLAT = affine(np.diag([1, 1.2, 1.5]), [0, 0, 0])

# The qform and its code, the sform and its code.
FORMS = {
    "q": (ROTATED, 1, None, 0),
    "q mirrored": (MIRRORED, 2, None, 0),
    "s": (None, 0, ROTATED, 2),
    "s mirrored": (None, 0, MIRRORED, 4),
    "both alike": (ROTATED, 1, ROTATED, 1),
    "both, differing": (ROTATED, 1, MIRRORED, 2),
    "both, differing, scanner": (MIRRORED, 1, ROTATED, 1),
    "q sheared s": (ROTATED, 1, SHEARED, 4),
    "s sheared": (None, 0, SHEARED, 2),
    "neither": (None, 0, None, 0),
}


def nifti(kind, forms, folder, suffix=".nii.gz", endianness="<"):
    q, q_code, s, s_code = FORMS[forms]
    header = kind.header_class(endianness=endianness)
    image = kind(lopsided(), FLAT, header=header)
    # In this order: setting one form may write into the other one.
    image.set_sform(s, s_code)
    image.set_qform(q if q is not None else FLAT, q_code)
    image.header.set_data_dtype(np.float32)
    path = folder / ("image" + suffix)
    nibabel.save(image, path)
    return path, nibabel.load(path)


def extracted(path, folder, *options):
    """Centroid, volume and lines of the command's surface, and its report."""
    run = subprocess.run(
        [COMMAND, "extract", path, "-o", folder / "mesh.ply", "--iso", "0.5", "--levels", "0",
         "--space", "ras", "--report", folder / "report.json", "--quiet", *options],
        check=True, capture_output=True, text=True,
    )
    assert subprocess.run([COMMAND, "check", folder / "mesh.ply"], capture_output=True).returncode == 0
    subprocess.run([COMMAND, "measure", folder / "mesh.ply", "--json", folder / "measures.json"],
                   check=True, capture_output=True)
    whole = json.loads((folder / "measures.json").read_text())["whole"]
    report = json.loads((folder / "report.json").read_text())
    return np.array(whole["centroid"]), whole["volume"], run.stderr, report


# All forms in the usual kind of file, some in each other.
CASES = [(nibabel.Nifti1Image, ".nii.gz", "<", forms) for forms in FORMS] + [
    (kind, suffix, endianness, forms)
    for kind, suffix, endianness in (
        (nibabel.Nifti1Image, ".nii", ">"),
        (nibabel.Nifti2Image, ".nii", "<"),
        (nibabel.Nifti2Image, ".nii.gz", ">"),
    )
    for forms in ("q mirrored", "q sheared s")
]


@pytest.mark.parametrize("kind, suffix, endianness, forms", CASES)
def test_the_command_and_the_module_put_an_image_where_nibabel_has_it(
    tmp_path, kind, suffix, endianness, forms
):
    path, image = nifti(kind, forms, tmp_path, suffix, endianness)
    centroid, volume, told, report = extracted(path, tmp_path)
    weights = lopsided()
    voxels = np.argwhere(weights > 0)
    middle = np.average(voxels, axis=0, weights=weights[tuple(voxels.T)])
    assert centroid == pytest.approx(nibabel.affines.apply_affine(image.affine, middle), abs=0.1)
    assert volume == pytest.approx(
        weights.sum() * abs(np.linalg.det(image.affine[:3, :3])), rel=0.05
    )
    assert ("differ" in told) == ("differing" in forms or "q sheared" in forms)
    assert ("mirror image" in told) == ("differing" in forms)
    assert ("says nothing of its place" in told) == (forms == "neither")

    geometry = pellicle.geometry_from_affine(image.affine)
    assert report["input"]["spacing"] == pytest.approx(geometry["spacing"], rel=1e-6)
    assert report["input"]["origin"] == pytest.approx(geometry["origin"], rel=1e-6, abs=1e-5)
    assert np.ravel(geometry["direction"]) == pytest.approx(report["input"]["direction"], abs=1e-6)
    surface = pellicle.extract(
        np.asarray(image.dataobj), 0.5, order="xyz", space="ras", levels=0, **geometry
    )
    assert f"{surface.hash:016x}" == report["hash"]
    assert surface.measures().volume == pytest.approx(volume, rel=1e-4)


def test_a_form_can_be_chosen(tmp_path):
    path, image = nifti(nibabel.Nifti1Image, "both, differing", tmp_path)
    weights = lopsided()
    middle = np.array([np.average(axis, weights=weights) for axis in np.indices(weights.shape)])
    for name, matrix in (("sform", image.get_sform()), ("qform", image.get_qform())):
        centroid, _, told, report = extracted(path, tmp_path, "--nifti-frame", name)
        assert told == "" and report["parameters"]["nifti_frame"] == name
        assert centroid == pytest.approx(nibabel.affines.apply_affine(matrix, middle), abs=0.1)
    path, _ = nifti(nibabel.Nifti1Image, "q", tmp_path)
    run = subprocess.run(
        [COMMAND, "extract", path, "-o", tmp_path / "no.ply", "--iso", "0.5", "--nifti-frame",
         "sform"], capture_output=True, text=True)
    assert run.returncode == 2 and "has no sform" in run.stderr and run.stderr.count("\n") == 1


def test_labels_lie_on_the_side_where_nibabel_has_them(tmp_path):
    labels = np.zeros((30, 20, 20), np.uint8)
    labels[4:12, 5:15, 5:15] = 1
    labels[18:26, 5:15, 5:15] = 2
    left_first = affine(np.diag([-1, 1, 1]), [15, -10, -10])
    image = nibabel.Nifti1Image(labels, left_first)
    image.set_sform(left_first, 2)
    image.set_qform(affine(np.eye(3), [-15, -10, -10]), 2)
    nibabel.save(image, tmp_path / "labels.nii.gz")
    subprocess.run([COMMAND, "extract", "--labels", tmp_path / "labels.nii.gz", "-o",
                    tmp_path / "part.stl", "--space", "ras", "--quiet"], check=True,
                   capture_output=True)
    for label in (1, 2):
        subprocess.run([COMMAND, "measure", tmp_path / f"part-{label}.stl", "--json",
                        tmp_path / "m.json"], check=True, capture_output=True)
        found = json.loads((tmp_path / "m.json").read_text())["whole"]["centroid"]
        expected = nibabel.affines.apply_affine(
            nibabel.load(tmp_path / "labels.nii.gz").affine,
            np.argwhere(labels == label).mean(axis=0))
        assert found == pytest.approx(expected, abs=0.2)
