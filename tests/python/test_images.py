"""Images from files, their thresholds, and the surfaces of their labels."""

import gzip
import json
import logging
import os
import subprocess
import sys

import numpy as np
import pytest
from scenes import ball, pill

import pellicle

COMMAND = os.environ.get("PELLICLE_COMMAND")
needs_command = pytest.mark.skipif(COMMAND is None, reason="there is no command")


def told(path):
    """What the command says of an image."""
    run = subprocess.run([COMMAND, "info", "--json", path], capture_output=True, check=True)
    return json.loads(run.stdout)


def agrees(image, path):
    info = told(path)
    assert list(image.values.shape[::-1]) == info["dims"]
    for name in ("spacing", "origin"):
        assert image.geometry[name] == pytest.approx(info[name], rel=1e-12, abs=1e-12)
    assert image.geometry["direction"].ravel() == pytest.approx(info["direction"], abs=1e-12)
    assert [image.values.min(), image.values.max()] == info["range"]
    assert pellicle.threshold_otsu(image) == info["otsu"]


@needs_command
@pytest.mark.parametrize("suffix", ["nrrd", "mha", "mhd"])
@pytest.mark.parametrize("kind", ["u8", "i16", "u16", "i32", "f32"])
def test_what_the_command_writes_is_read(tmp_path, suffix, kind):
    path = tmp_path / f"blobs.{suffix}"
    arguments = ["--size", "21,18,12", "--spacing", "1,2,1.5", "--type", kind, "-o", path]
    subprocess.run([COMMAND, "phantom", "blobs", *arguments], check=True)
    agrees(pellicle.read(path), path)


# A rotation and a mirror image, so that mixed-up rows and columns show.
AXES = np.array([[0, 0.6, 0.8], [-1, 0, 0], [0, 0.8, -0.6]])
VALUES = pill().astype(np.int16)[9:16, 9:18, 9:20] * 100 - 50


def nrrd(space, encoding, endian):
    vectors = " ".join(f"({x!r},{y!r},{z!r})" for x, y, z in (AXES * [0.5, 2, 3]).T.tolist())
    header = [
        "NRRD0004", "# a comment", "type: short", "dimension: 3", "sizes: 11 9 7",
        f"space: {space}", f"space directions: {vectors}", "space origin: (-3.5,20,1e1)",
        f"encoding: {encoding}", f"endian: {endian}", "key:=value", "",
    ]  # fmt: skip
    body = VALUES.astype(">i2" if endian == "big" else "<i2").tobytes()
    data = gzip.compress(body) if encoding == "gzip" else body
    return "\n".join([*header, ""]).encode() + data


@needs_command
@pytest.mark.parametrize("space", ["left-posterior-superior", "LPS", "RAS"])
@pytest.mark.parametrize("encoding", ["raw", "gzip"])
@pytest.mark.parametrize("endian", ["little", "big"])
def test_nrrd_lies_where_the_command_has_it(tmp_path, space, encoding, endian):
    path = tmp_path / "x.nrrd"
    path.write_bytes(nrrd(space, encoding, endian))
    image = pellicle.read(path)
    agrees(image, path)
    assert np.array_equal(image.values, VALUES)


@needs_command
@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("big", [False, True])
def test_meta_image_lies_where_the_command_has_it(tmp_path, compressed, big):
    import zlib

    path = tmp_path / "x.mha"
    body = VALUES.astype(">i2" if big else "<i2").tobytes()
    data = zlib.compress(body) if compressed else body
    header = [
        "ObjectType = Image", "NDims = 3", "BinaryData = True",
        f"BinaryDataByteOrderMSB = {big}", f"CompressedData = {compressed}",
        *([f"CompressedDataSize = {len(data)}"] if compressed else []),
        f"TransformMatrix = {' '.join(map(str, AXES.T.ravel()))}", "Offset = -3.5 20 10",
        "ElementSpacing = 0.5 2 3", "DimSize = 11 9 7", "ElementType = MET_SHORT",
        "ElementDataFile = LOCAL", "",
    ]  # fmt: skip
    path.write_bytes("\n".join(header).encode() + data)
    image = pellicle.read(path)
    agrees(image, path)
    assert np.array_equal(image.values, VALUES)


@needs_command
@pytest.mark.parametrize("unit", ["mm", "meter", "micron"])
@pytest.mark.parametrize("scaled", [False, True])
def test_nifti_lies_where_the_command_has_it(tmp_path, unit, scaled):
    nibabel = pytest.importorskip("nibabel")
    matrix = np.eye(4)
    matrix[:3, :3] = np.diag([-1, -1, 1]) @ AXES * [0.5, 2, 3]
    matrix[:3, 3] = [3, -20, 10]
    written = nibabel.Nifti1Image(VALUES.T, matrix)
    written.header.set_xyzt_units(unit)
    if scaled:
        written.header.set_slope_inter(0.5, 3)
    path = tmp_path / "x.nii.gz"
    nibabel.save(written, path)
    image = pellicle.read(path)
    info = told(path)
    for name in ("spacing", "origin"):
        assert image.geometry[name] == pytest.approx(info[name], rel=1e-6)
    assert image.geometry["direction"].ravel() == pytest.approx(info["direction"], abs=1e-6)
    assert image.values.shape == VALUES.shape
    assert [image.values.min(), image.values.max()] == info["range"]


def test_image_tells_functions_its_geometry():
    geometry = pellicle.geometry_from_affine(np.diag([0.5, 2, 3, 1]))
    image = pellicle.Image(pill(), geometry)
    wanted = pellicle.extract(pill(), 100, **geometry)
    assert pellicle.extract(image, 100).hash == wanted.hash
    assert np.array_equal(pellicle.extract(image, 100).vertices, wanted.vertices)
    volume = pellicle.Volume(image)
    assert volume.borrowed
    run = pellicle.Run(pellicle.Pyramid(volume, 100))
    assert np.array_equal(run.finish().vertices, wanted.vertices)
    assert repr(image) == "<pellicle.Image of 40 x 34 x 30 voxels of uint8, 0.5 x 2 x 3 mm>"
    with pytest.raises(TypeError, match="tells its order and geometry"):
        pellicle.extract(image, 100, spacing=(1, 1, 2))


BROKEN = {
    "x.dcm": (b"", r"read takes .*\.mhd; for DICOM, TIFF and others use"),
    "a.nrrd": (b"P6", "is no NRRD file"),
    "b.nrrd": (nrrd("RAS", "raw", "little")[:-1], "is truncated"),
    "c.nrrd": (nrrd("RAS", "gzip", "little")[:-30], "is truncated"),
    "d.nrrd": (nrrd("RAS", "bzip2", "little"), "encodings raw and gzip"),
    "e.nrrd": (nrrd("LAS", "raw", "little"), "does not know the space"),
    "f.nrrd": (nrrd("RAS", "raw", "little").replace(b"sizes:", b"size:"), "'sizes' is missing"),
    "g.nrrd": (nrrd("RAS", "raw", "little").replace(b"short", b"block"), "the type \"block\""),
    "h.nrrd": (nrrd("RAS", "raw", "little").replace(b"ion: 3", b"ion: 4"), "three axes, not 4"),
    "i.nrrd": (nrrd("RAS", "raw", "little").replace(b"11 9 7", b"11 9 x"), "convert|invalid"),
    "a.mha": (b"NDims = 3\nHello\n", "has no ElementDataFile"),
    "b.mha": (b"NDims = 3\nElementType = MET_OTHER\nElementDataFile = LOCAL\n", "MET_OTHER"),
    "c.mha": (b"NDims = 2\nElementDataFile = LOCAL\n", "three axes, not 2"),
    "a.nii": (b"nothing", "a.nii"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_wrong_with_a_file_is_told_in_one_line(tmp_path, name):
    data, message = BROKEN[name]
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(pellicle.InvalidData, match=message) as caught:
        pellicle.read(path)
    assert str(caught.value).startswith(str(path)) and "\n" not in str(caught.value)


def test_missing_file_and_missing_library(tmp_path, monkeypatch):
    for name in ("x.nrrd", "x.mha", "x.nii"):
        with pytest.raises(FileNotFoundError):
            pellicle.read(tmp_path / name)
    monkeypatch.setitem(sys.modules, "nibabel", None)
    with pytest.raises(ImportError, match="x.nii: to read NIfTI, pellicle.read needs nibabel"):
        pellicle.read(tmp_path / "x.nii")


def test_threshold_lies_between_the_classes():
    values = np.zeros((4, 4, 4), np.uint8)
    values[:2] = 255
    assert pellicle.threshold_otsu(values) == 127.5
    with_holes = values.astype(np.float32)
    with_holes[3, 3, 3] = np.nan
    assert 0 < pellicle.threshold_otsu(with_holes) < 255
    assert pellicle.threshold_otsu(values[::2, ::-1]) == 127.5
    with pytest.raises(pellicle.InvalidData, match="no two values"):
        pellicle.threshold_otsu(np.ones((4, 4, 4)))


def nested():
    """Label 3 in a cavity of label 2, label -1 beside it, and a voxel of label 9."""
    values = np.zeros((40, 40, 60), np.int16)
    values[:, :, :40][ball(40, 15) > 0.5] = 2
    values[:, :, :40][ball(40, 7) > 0.5] = 3
    values[10:30, 10:30, 35:52][values[10:30, 10:30, 35:52] == 0] = -1
    values[2, 2, 2] = 9
    return values


FRAME = {"spacing": (0.5, 0.5, 0.8), "origin": (3, -40, 7), "direction": AXES}


def test_labels_are_disjoint_surfaces_where_the_labels_are(caplog):
    values = nested()
    with caplog.at_level(logging.WARNING, "pellicle"):
        surfaces = pellicle.extract_labels(values, **FRAME, curvature=0.1)
    assert list(surfaces) == [-1, 2, 3]
    assert "left out: [9]" in caplog.text
    meshes = [surface.in_space("voxel") for surface in surfaces.values()]
    for label, surface in surfaces.items():
        z, y, x = np.nonzero(values == label)
        low, high = surface.in_space("voxel").bounds
        assert np.abs(low - [x.min(), y.min(), z.min()]).max() < 1
        assert np.abs(high - [x.max(), y.max(), z.max()]).max() < 1
        assert surface.volume == pytest.approx(0.2 * len(x), rel=0.2)
        assert surface.check().valid and surface.levels
        assert surface.parameters.curvature == 0.1
    assert len(surfaces[2].components) == 2  # the wall of the cavity
    starts = np.cumsum([0] + [mesh.vertex_count for mesh in meshes[:-1]])
    faces = [mesh.faces.astype(int) + start for mesh, start in zip(meshes, starts, strict=True)]
    vertices = np.concatenate([mesh.vertices_f64 for mesh in meshes])
    assert pellicle.check_mesh((vertices, np.concatenate(faces))).valid
    same = pellicle.extract_labels(values.T, order="xyz", **FRAME, curvature=0.1)
    assert [s.hash for s in same.values()] == [s.hash for s in surfaces.values()]


def test_labels_have_the_volumes_of_their_voxels():  # but for the edges of a block, which are smoothed
    z, y, x = np.mgrid[:22, :22, :22] - 10.4
    values = np.where(x * x + y * y + z * z <= 64, 5, 9)
    values[[0, -1]] = values[:, [0, -1]] = values[:, :, [0, -1]] = 0
    for label, surface in pellicle.extract_labels(values).items():
        assert surface.volume == pytest.approx((values == label).sum(), rel=0.02 if label == 5 else 0.03)


def test_a_surface_stops_at_obstacles():
    z, y, x = np.mgrid[:26, :26, :26] - 12.5
    ball = np.clip(0.5 + 9 - np.sqrt(x * x + y * y + z * z), 0, 1)
    wall = np.array([[16.0, -9, -9], [16, 35, -9], [16, 35, 35], [16, -9, 35]])
    faces = [[0, 1, 2], [0, 2, 3]]
    start = {"seeds": [[10, 12.5, 12.5, 4]], "levels": 0, "late_bubbles": False}
    free = pellicle.extract(ball, 0.5, **start)
    held = pellicle.extract(ball, 0.5, obstacles=(wall, faces), obstacle_gap=0.1, **start)
    assert free.bounds[1][0] > 21
    assert 15.5 < held.bounds[1][0] < 16
    assert held.check().valid
    with pytest.raises(pellicle.InvalidArgument, match="late_bubbles"):
        pellicle.extract(ball, 0.5, obstacles=(wall, faces), seeds=start["seeds"])


@needs_command
def test_labels_are_those_of_the_command(tmp_path):
    path = tmp_path / "labels.nrrd"
    arguments = ["--size", "40", "--spacing", "1,1,2", "-o", path]
    subprocess.run([COMMAND, "phantom", "labels", *arguments], check=True)
    surfaces = pellicle.extract_labels(pellicle.read(path))
    run = subprocess.run(
        [COMMAND, "extract", "--labels", path, "-o", tmp_path / "x.ply"],
        check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert run.stdout.count("vertices") == len(surfaces) > 3
    for label, surface in surfaces.items():
        assert f" {surface.vertex_count} vertices" in next(
            line for line in run.stdout.splitlines() if line.startswith(f"label {label} ")
        )


@pytest.mark.parametrize(
    "values, message",
    [
        (np.zeros((4, 4, 4), int), "holds no label"),
        (np.full((4, 4, 4), 0.5), "is no integer"),
        (np.full((4, 4, 4), np.nan), "is no integer"),
        (np.pad([[[1]]], 2), "no label is large enough"),
    ],
)
def test_images_that_hold_no_labels_are_refused(values, message):
    with pytest.raises(pellicle.InvalidData, match=message):
        pellicle.extract_labels(values)


def test_labels_refuse_parameters_that_they_tell():
    with pytest.raises(TypeError, match="takes no levels"):
        pellicle.extract_labels(nested(), levels=2)
    with pytest.raises(TypeError, match="did you mean curvature"):
        pellicle.extract_labels(nested(), curvture=1)
