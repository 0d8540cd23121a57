"""What a surface tells of itself, its copies, its files, and other libraries' meshes of it."""

import base64
import copy
import inspect
import os
import pickle
import re
import struct
import subprocess
import sys
import types
import zlib

import numpy as np
import pytest
from pellicle import _changes
from scenes import ball, octahedron, pill

import pellicle

COMMAND = os.environ.get("PELLICLE_COMMAND")
FRAME = {
    "spacing": (0.7, 0.8, 1.3),
    "origin": (-100.3, 20, 30),
    "direction": [[0, 1, 0], [0, 0, -1], [-1, 0, 0]],
}


@pytest.fixture(scope="module")
def surface():
    return pellicle.extract(pill(), 100, **FRAME)


def far_away():
    """An octahedron so far from the origin that floats would merge its vertices."""
    vertices, faces = octahedron(0.001)
    return pellicle.Surface.from_mesh(
        vertices * 1000 + 2, faces, spacing=(0.001, 0.001, 0.001), origin=(1e5, 1e5, 1e5),
        space="voxel",
    ).in_space("lps")


def test_keyword_arguments_are_those_of_the_parameters():
    def hints(changes):
        return changes.__annotations__

    def spelled(annotations):
        plain = {}
        for name, hint in annotations.items():
            plain[name] = getattr(hint, "__forward_arg__", hint)
        return plain

    fields = spelled(pellicle.Parameters.__annotations__)
    assert spelled(hints(_changes.Changes)) == fields
    common = {name: hint for name, hint in fields.items() if name not in ("iso", "mesh")}
    assert spelled(hints(_changes.CommonChanges)) == common
    assert spelled(hints(_changes.PyramidChanges)) == common | {"mesh": fields["mesh"]}
    assert spelled(hints(_changes.RunChanges)) == common | {"iso": fields["iso"]}


@pytest.mark.parametrize(
    "function", [pellicle.extract, pellicle.extract_labels, pellicle.Pyramid, pellicle.Run]
)
def test_signatures_name_every_parameter(function):
    shown = inspect.signature(function).parameters
    assert {"curvature", "tolerance", "max_iterations"} <= shown.keys()
    assert shown["curvature"].default == pellicle.Parameters().curvature
    assert ("levels" in shown) == (function is not pellicle.extract_labels)
    assert not any(name.startswith("_") or name == "changes" for name in shown)


def test_properties_are_the_measures(surface):
    measures = surface.measures()
    assert (surface.area, surface.volume) == (measures.area, measures.volume)
    vertices = surface.vertices_f64
    assert np.array_equal(surface.bounds, [vertices.min(axis=0), vertices.max(axis=0)])
    (component,) = surface.components
    assert component.volume == pytest.approx(surface.volume)
    assert "\n" not in repr(surface)


@pytest.mark.parametrize("space", ["lps", "ras", "voxel"])
def test_pickled_surface_is_the_same_bits(surface, space):
    before = surface.in_space(space)
    after = pickle.loads(pickle.dumps(before))
    assert after.hash == before.hash and after.space == space
    assert np.array_equal(after.vertices_f64, before.vertices_f64)
    assert np.array_equal(after.faces, before.faces)
    assert after.levels == before.levels and after.parameters == before.parameters
    assert after.seconds == before.seconds and after.input_range == before.input_range
    assert pickle.loads(pickle.dumps(after)).hash == before.hash


def test_surface_of_a_run_is_pickled_with_its_place():
    pyramid = pellicle.Pyramid(pellicle.Volume(pill(), **FRAME), 100)
    before = pellicle.Run(pyramid).finish()
    after = pickle.loads(pickle.dumps(before))
    assert np.array_equal(after.vertices_f64, before.vertices_f64)


def test_copies_share_the_surface(surface):
    for other in (copy.copy(surface), copy.deepcopy(surface), copy.deepcopy([surface])[0]):
        assert other is not surface and other.hash == surface.hash
        assert other.levels == surface.levels


def test_pickled_surface_of_a_mirrored_image_faces_outward():
    vertices, faces = octahedron(3)
    mirror = np.diag([1, 1, -1])
    before = pellicle.Surface.from_mesh(vertices, faces, direction=mirror)
    assert before.parameters == pellicle.Parameters()
    after = pickle.loads(pickle.dumps(before))
    for space in ("lps", "ras", "voxel"):
        assert np.array_equal(after.in_space(space).faces, before.in_space(space).faces)
        assert after.in_space(space).check().valid


@pytest.mark.skipif(COMMAND is None, reason="there is no command")
@pytest.mark.parametrize("suffix", ["ply", "stl", "obj"])
@pytest.mark.parametrize("space", ["lps", "ras", "voxel"])
def test_files_are_those_of_the_command(tmp_path, suffix, space):
    volume = tmp_path / "blobs.nrrd"
    phantom = ["phantom", "blobs", "--type", "u8", "--size", "32", "--spacing", "1,2,1.5"]
    subprocess.run([COMMAND, *phantom, "-o", volume], check=True)
    theirs, ours = tmp_path / f"theirs.{suffix}", tmp_path / f"ours.{suffix}"
    arguments = ["--iso", "120", "--space", space, "-o", theirs]
    subprocess.run([COMMAND, "extract", volume, *arguments], check=True, capture_output=True)
    pellicle.extract(pellicle.read(volume), 120, space=space).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        [volume.name, theirs.name, ours.name]
    )


@pytest.mark.skipif(COMMAND is None, reason="there is no command")
@pytest.mark.parametrize("suffix", ["ply", "stl", "obj"])
def test_what_floats_would_break_is_written_in_doubles(tmp_path, suffix):
    path = tmp_path / f"far.{suffix}"
    surface = far_away()
    assert not pellicle.check_mesh((surface.vertices, surface.faces)).valid
    surface.save(path)
    assert subprocess.run([COMMAND, "check", path], capture_output=True).returncode == 0


def test_other_suffixes_are_refused_in_one_line(tmp_path, surface):
    with pytest.raises(ValueError, match=r"x\.vtp: save writes \.ply, \.stl, \.obj; [^\n]*$"):
        surface.save(tmp_path / "x.vtp")
    with pytest.raises(FileNotFoundError):
        surface.save(tmp_path / "none" / "x.ply")
    assert not list(tmp_path.iterdir())


class Given:
    """What a library's class was given."""

    def __init__(self, *arguments, **named):
        self.arguments, self.named = arguments, named


def test_other_libraries_get_vertices_and_faces(monkeypatch, surface):
    for name, made in {"trimesh": "Trimesh", "pyvista": "PolyData"}.items():
        monkeypatch.setitem(sys.modules, name, types.SimpleNamespace(**{made: Given}))
    trimesh = surface.to_trimesh()
    assert np.array_equal(trimesh.arguments[0], surface.vertices)
    assert np.array_equal(trimesh.arguments[1], surface.faces)
    assert trimesh.named == {"process": False}  # it would merge and move vertices
    points, faces = surface.to_pyvista().arguments
    assert np.array_equal(points, surface.vertices)
    assert np.array_equal(faces.reshape(-1, 4)[:, 1:], surface.faces)
    assert (faces[::4] == 3).all()


def test_meshio_gets_vertices_and_faces(surface):
    pytest.importorskip("meshio", reason="meshio is missing: tools/setup.sh python")
    mesh = surface.to_meshio()
    assert np.array_equal(mesh.points, surface.vertices)
    assert np.array_equal(mesh.cells_dict["triangle"], surface.faces)


def test_other_libraries_get_doubles_where_floats_would_break_the_mesh(monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", types.SimpleNamespace(Trimesh=Given))
    vertices, faces = far_away().to_trimesh().arguments
    assert vertices.dtype == np.float64 and pellicle.check_mesh((vertices, faces)).valid


@pytest.mark.parametrize("name", ["trimesh", "pyvista", "meshio"])
def test_missing_library_is_named_in_one_line(monkeypatch, surface, name):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=f"^to_{name} needs {name}[^\n]*$"):
        getattr(surface, f"to_{name}")()


def pixels(html):
    """Rows of RGBA of the picture in the page, which has rows without a filter."""
    png = base64.b64decode(re.search(r"data:image/png;base64,([^\"]+)", html)[1])
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", png[16:24])
    size = struct.unpack(">I", png[33:37])[0]
    rows = zlib.decompress(png[41 : 41 + size])
    return np.frombuffer(rows, np.uint8).reshape(height, 1 + 4 * width)[:, 1:].reshape(
        height, width, 4
    )


@pytest.mark.parametrize("spacing", [0.01, 1, 300])
def test_notebooks_show_a_picture_without_holes(spacing):
    html = pellicle.extract(ball(24, 7), 0.5, spacing=(spacing,) * 3)._repr_html_()
    seen = pixels(html)[..., 3] > 0
    height, width = seen.shape
    rows, columns = np.mgrid[:height, :width] - np.array([(height - 1) / 2, (width - 1) / 2])[
        :, np.newaxis, np.newaxis
    ]
    away = np.hypot(rows, columns)
    radius = np.sqrt(seen.sum() / np.pi)
    assert radius > width / 3
    assert seen[away < 0.95 * radius].all() and not seen[away > 1.08 * radius].any()
    assert "mm\u00b2" in html


def test_pictures_show_a_patient_from_the_front():
    """The head is up, and the right hand on the left, in LPS and in RAS."""
    values = np.zeros((24, 24, 24), np.float32)  # [z, y, x]
    values[2:22, 8:14, 16:22] = 1  # upright, on the patient's left
    values[2:8, 8:14, 2:22] = 1  # a foot to the right
    surface = pellicle.extract(values, 0.5)
    for space in ("lps", "ras"):
        seen = pixels(surface.in_space(space)._repr_html_())[..., 3] > 0
        half = len(seen) // 2
        assert seen[:half, half:].mean() > 0.3 and seen[half:, :half].mean() > 0.2
        assert seen[: half // 2, :half].mean() < 0.05


def test_mesh_is_a_start_or_how_fine_the_surface_is():
    image = ball(32, 11)
    uniform = pellicle.extract(image, 0.5, mesh="uniform")
    adaptive = pellicle.extract(image, 0.5, mesh="adaptive", tolerance=0.3)
    auto = pellicle.extract(image, 0.5)
    assert auto.parameters.mesh == "adaptive" and auto.parameters.tolerance == pytest.approx(1 / 24)
    assert uniform.hash == pellicle.extract(image, 0.5, mesh="auto", edge=1.25).hash
    assert adaptive.parameters.mesh == "adaptive" and adaptive.vertex_count < uniform.vertex_count
    pyramid = pellicle.Pyramid(pellicle.Volume(image), 0.5, mesh="adaptive", tolerance=0.3)
    run = pellicle.Run(pyramid, mesh="adaptive")
    assert run.finish().hash == adaptive.hash
    with pytest.raises(ValueError, match="mesh"):
        pellicle.extract(image, 0.5, mesh="adaptve")
    parts = pellicle.extract_labels(image > 0.5, mesh="adaptive", tolerance=0.3)
    assert parts[1].parameters.mesh == "adaptive"
    assert pellicle.extract_labels(image > 0.5)[1].parameters.mesh == "uniform"
