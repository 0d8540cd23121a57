"""pellicle.extract: images in, surfaces out."""

import json
import os
import subprocess

import numpy as np
import pytest
from scenes import ball, octahedron, pill

import pellicle


@pytest.fixture(scope="module")
def pill_surface():
    return pellicle.extract(pill(), 100)


def test_a_ball_becomes_a_valid_sphere():
    surface = pellicle.extract(ball(), 0.5, curvature=0.1)
    check = surface.check()
    assert check.valid and check.closed and check.outward
    measures = surface.measures()
    assert (measures.components, measures.genus, measures.euler) == (1, 0, 2)
    assert measures.volume == pytest.approx(4 / 3 * np.pi * 10**3, rel=0.05)
    assert check.measures == measures
    middle = (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2
    assert middle == pytest.approx([15.5] * 3, abs=0.2)


def test_arrays_are_the_callers_own_and_the_documented_type(pill_surface):
    surface = pill_surface
    vertices, faces, normals = surface.vertices, surface.faces, surface.normals
    assert (vertices.dtype, faces.dtype, normals.dtype) == (np.float32, np.uint32, np.float32)
    assert vertices.shape == normals.shape == (surface.vertex_count, 3)
    assert faces.shape == (surface.face_count, 3)
    for array in (vertices, faces, normals):
        assert array.flags.c_contiguous and array.flags.writeable and array.flags.owndata
    before = surface.vertices
    vertices[:] = 0
    assert np.array_equal(surface.vertices, before)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1, abs=1e-5)
    outward = np.einsum("ij,ij->i", normals, before - before.mean(axis=0))
    assert (outward > 0).mean() > 0.99


def test_the_surface_lies_where_the_object_is_in_x_y_z(pill_surface):
    low, high = pill_surface.vertices.min(axis=0), pill_surface.vertices.max(axis=0)
    assert (low + high) / 2 == pytest.approx([22, 15, 14], abs=0.5)
    assert np.argsort(high - low).tolist() == [1, 2, 0]


def layouts(image):
    """The same [z, y, x] values in other layouts of memory."""
    yield "Fortran", np.asfortranarray(image), "zyx"
    yield "xyz", image.transpose(), "xyz"
    yield "xyz, C", np.ascontiguousarray(image.transpose()), "xyz"
    gaps = np.zeros([2 * n for n in image.shape], image.dtype)
    gaps[::2, ::2, ::2] = image
    yield "gaps", gaps[::2, ::2, ::2], "zyx"
    backwards = np.ascontiguousarray(image[::-1, ::-1, ::-1])
    yield "negative", backwards[::-1, ::-1, ::-1], "zyx"
    yield "one negative", np.ascontiguousarray(image[:, :, ::-1])[:, :, ::-1], "zyx"
    odd = np.zeros(image.nbytes + 1, np.uint8)[1:].view(image.dtype).reshape(image.shape)
    odd[:] = image
    yield "unaligned", odd, "zyx"
    yield "big endian", image.astype(image.dtype.newbyteorder(">")), "zyx"
    constant = image.view()
    constant.flags.writeable = False
    yield "read-only", constant, "zyx"
    yield "list", image.astype(np.int32).tolist(), "zyx"


def test_layout_and_order_do_not_matter(pill_surface):
    image = pill().astype(np.int16)
    for name, array, order in layouts(image):
        surface = pellicle.extract(array, 100, order=order)
        assert surface.hash == pill_surface.hash, name


def test_order_is_not_guessed(pill_surface):
    mirrored = pellicle.extract(pill(), 100, order="xyz")
    assert mirrored.hash != pill_surface.hash
    assert mirrored.vertices.max(axis=0).argmax() == 2  # the pill is long on the array's last axis
    size = np.ptp(mirrored.vertices, axis=0)
    assert np.argsort(size).tolist() == [1, 0, 2]


def test_a_broadcast_image_is_taken_as_its_values():
    row = np.linspace(0, 200, 24).astype(np.float32)
    image = np.broadcast_to(row, (20, 22, 24))
    surface = pellicle.extract(image, 100)
    assert surface.hash == pellicle.extract(image.copy(), 100).hash


@pytest.mark.parametrize(
    "dtype",
    ["u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"],
)
def test_types_that_hold_the_values_give_the_same_surface(pill_surface, dtype):
    assert pellicle.extract(pill().astype(dtype), 100).hash == pill_surface.hash


def test_booleans_and_small_integers():
    inside = ball() > 0.5
    expected = pellicle.extract(inside.astype(np.uint8), 0.5).hash
    assert pellicle.extract(inside, 0.5).hash == expected
    assert pellicle.extract(inside.astype(np.int8), 0.5).hash == expected


def test_values_that_do_not_fit_are_refused():
    image = pill().astype(np.int64)
    image[0, 0, 0] = 2**31
    with pytest.raises(ValueError, match="do not fit into int32"):
        pellicle.extract(image, 100)
    with pytest.raises(ValueError, match="do not fit into int32"):
        pellicle.extract(image.astype(np.uint32), 100)
    large = pill().astype(np.float64)
    large[0, 0, 0] = 1e39
    with pytest.raises(ValueError, match="do not fit into float32"):
        pellicle.extract(large, 100)
    for dtype in (complex, object, "U3", np.longdouble):
        with pytest.raises(TypeError, match="not supported|must be real numbers"):
            pellicle.extract(pill().astype(dtype), 100)


def test_spacing_origin_and_direction_are_x_y_z():
    geometry = {"spacing": (0.5, 1, 2), "origin": (10, -20, 30)}
    surface = pellicle.extract(pill(), 100, **geometry)
    voxels = surface.in_space("voxel").vertices
    assert surface.vertices == pytest.approx(voxels * [0.5, 1, 2] + [10, -20, 30], abs=1e-3)
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    for direction in (turned, turned.ravel().tolist()):
        other = pellicle.extract(pill(), 100, direction=direction, **geometry)
        expected = (other.in_space("voxel").vertices * [0.5, 1, 2]) @ turned.T + [10, -20, 30]
        assert other.vertices == pytest.approx(expected, abs=1e-3)
    ras = surface.in_space("ras")
    assert ras.vertices == pytest.approx(surface.vertices * [-1, -1, 1], abs=1e-3)
    assert surface.space == "lps" and ras.space == "ras"
    assert ras.measures().volume == pytest.approx(surface.measures().volume, rel=1e-4)


def test_an_affine_of_nibabel_puts_the_surface_where_it_says():
    angle = 0.3
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    affine = np.eye(4)
    affine[:3, :3] = turn * [0.5, 1, 2]
    affine[:3, 3] = [7, 8, -9]
    surface = pellicle.extract(
        pill().transpose(), 100, order="xyz", space="ras", **pellicle.geometry_from_affine(affine)
    )
    voxels = surface.in_space("voxel").vertices
    assert surface.vertices == pytest.approx(voxels @ affine[:3, :3].T + [7, 8, -9], abs=1e-3)
    lps = pellicle.geometry_from_affine(affine, "lps")
    assert lps["origin"] == (7, 8, -9)
    with pytest.raises(ValueError, match="4 x 4"):
        pellicle.geometry_from_affine(np.eye(3))


def test_parameters_by_name_and_as_an_object_are_the_same():
    parameters = pellicle.Parameters(iso=100, curvature=0.2, levels=1)
    one = pellicle.extract(pill(), parameters=parameters)
    two = pellicle.extract(pill(), 100, curvature=0.2, levels=1)
    assert one.hash == two.hash
    used = one.parameters
    assert (used.iso, used.curvature, used.levels) == (100, 0.2, 1)
    assert used.window_low is not None and used.window_high is not None
    assert used.level_iso is not None and len(used.level_iso) == 2
    again = pellicle.extract(pill(), parameters=used)
    assert again.hash == one.hash
    assert pellicle.extract(pill(), parameters=used, curvature=0.4).hash != one.hash


def test_defaults_are_those_of_the_engine():
    surface = pellicle.extract(pill(), 100)
    defaults = pellicle.Parameters()
    assert (surface.parameters.init, surface.parameters.levels) == ("iso", 0)
    for name in ("curvature", "epsilon", "rest_length", "anisotropy", "late_bubbles"):
        assert getattr(surface.parameters, name) == getattr(defaults, name)
    assert defaults.iso is None and defaults.levels is None and defaults.window_low is None


def test_levels_seconds_and_range_are_told():
    surface = pellicle.extract(pill(), 100, levels=2)
    assert [level.level for level in surface.levels] == [2, 1, 0]
    last = surface.levels[-1]
    assert last.vertices == surface.vertex_count and last.converged
    assert last.dims[0] > last.dims[1] > last.dims[2] >= 30
    assert surface.seconds.evolution > 0
    assert surface.input_range == (0, 200)


def test_scalars():
    surface = pellicle.extract(ball(40, 14), 0.5)
    mean = surface.scalars("mean_curvature")
    assert mean.dtype == np.float32 and mean.shape == (surface.vertex_count,)
    assert np.median(mean) == pytest.approx(1 / 14, rel=0.15)
    assert surface.scalars("area").sum() == pytest.approx(surface.measures().area, rel=1e-3)
    valence = np.bincount(surface.faces.ravel(), minlength=surface.vertex_count)
    assert np.array_equal(surface.scalars("valence"), valence)
    assert np.isfinite(surface.scalars("movement")).all()
    with pytest.raises(ValueError, match="'mean_curvature', 'gaussian_curvature'"):
        surface.scalars("mean")


def two_balls():
    return np.maximum(
        ball(44, 7, (12, 12, 12)), ball(44, 7, (31, 30, 31))
    )


def test_starts_are_implied_by_what_is_given():
    image = two_balls()
    seeds = [[12, 12, 12, 5], [31, 30, 31, 5]]
    seeded = pellicle.extract(image, 0.5, seeds=seeds, levels=0)
    assert seeded.parameters.init == "seeds" and seeded.measures().components == 2
    one = pellicle.extract(image, 0.5, seeds=seeds[0], levels=0, late_bubbles=False)
    assert one.measures().components == 1
    masked = pellicle.extract(image, 0.5, mask=image > 0.3, levels=0)
    assert masked.parameters.init == "mask" and masked.measures().components == 2
    vertices, faces = octahedron(9)
    meshed = pellicle.extract(
        image, 0.5, mesh=(vertices + 12, faces), levels=0, late_bubbles=False
    )
    assert meshed.parameters.init == "mesh" and meshed.measures().components == 1
    grid = pellicle.extract(image, 0.5, bubbles=(2, 2, 2), levels=0)
    assert grid.parameters.init == "bubbles" and grid.check().valid


def test_a_mask_has_the_order_of_the_image():
    image = pill()
    mask = image > 120
    expected = pellicle.extract(image, 100, mask=mask, levels=0)
    turned = pellicle.extract(
        image.transpose(), 100, mask=mask.transpose(), order="xyz", levels=0
    )
    assert turned.hash == expected.hash
    with pytest.raises(ValueError):
        pellicle.extract(image, 100, mask=mask.transpose(), levels=0)


def test_a_start_that_would_be_ignored_is_refused():
    with pytest.raises(ValueError, match="seeds are for init='seeds'"):
        pellicle.extract(ball(), 0.5, seeds=[[15, 15, 15, 4]], init="bubble")
    with pytest.raises(ValueError, match="for init="):
        pellicle.extract(ball(), 0.5, seeds=[[15, 15, 15, 4]], mask=ball() > 0.5)
    with pytest.raises(pellicle.InvalidArgument):
        pellicle.extract(ball(), 0.5, init="seeds")


def test_a_surface_is_a_start_in_any_space():
    first = pellicle.extract(pill(), 100, spacing=(0.5, 1, 2), origin=(5, 6, 7))
    for space in ("lps", "ras", "voxel"):
        next_one = pellicle.extract(
            pill(), 60, mesh=first.in_space("ras"), space=space, levels=0, spacing=(0.5, 1, 2),
            origin=(5, 6, 7),
        )
        assert next_one.check().valid
        grown = next_one.in_space("lps").measures().volume / first.measures().volume
        assert 1 < grown < 1.3


def test_attachments_draw_the_surface_and_pins_hold_it():
    place = [15.5, 15.5, 27]
    free = pellicle.extract(ball(), 0.5, levels=0)
    drawn = pellicle.extract(ball(), 0.5, levels=0, attachments=[*place, 4, 20])
    assert (free.parameters.init, drawn.parameters.init) == ("iso", "bubble")

    def gap(surface):
        return np.linalg.norm(surface.vertices - place, axis=1).min()

    assert gap(drawn) < gap(free) / 2
    weak = pellicle.extract(ball(), 0.5, levels=0, attachments=[[*place, 4]])
    assert weak.hash == pellicle.extract(ball(), 0.5, levels=0, attachments=[*place, 4, 1]).hash
    start = pellicle.extract(ball(radius=12), 0.5)
    back = pellicle.extract(ball(), 0.5, mesh=start, levels=0)
    pinned = pellicle.extract(ball(), 0.5, mesh=start, levels=0, pins=[27.5, 15.5, 15.5, 5])
    assert back.vertices[:, 0].max() < 26 < 27 < pinned.vertices[:, 0].max()
    with pytest.raises(ValueError, match="rows of 4"):
        pellicle.extract(ball(), 0.5, pins=[[1, 2, 3]])


def test_a_force_of_the_callers_moves_the_surface():
    image = ball()
    seen = []

    def right(points):
        seen.append(points)
        return (0.3, 0, 0)

    def inward(points):
        return -0.2 * points.normals

    free = pellicle.extract(image, 0.5, levels=0)
    pushed = pellicle.extract(image, 0.5, levels=0, extra_force=right)
    assert pushed.vertices.mean(axis=0)[0] > free.vertices.mean(axis=0)[0] + 0.1
    smaller = pellicle.extract(image, 0.5, levels=0, extra_force=inward)
    assert smaller.measures().volume < 0.97 * free.measures().volume
    kept = seen[0].positions  # still there
    assert kept.shape == seen[0].normals.shape and kept.dtype == np.float32
    assert np.isfinite(kept).all() and 0 <= kept.min() and kept.max() <= 31
    awake = pellicle.extract(image, 0.5, levels=0, sleeping=False)
    idle = pellicle.extract(image, 0.5, levels=0, sleeping=False, extra_force=lambda points: None)
    assert idle.hash == awake.hash


@pytest.mark.skipif("PELLICLE_COMMAND" not in os.environ, reason="without the command")
def test_the_command_makes_the_same_surface(tmp_path):
    image = pill()
    header = (
        "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 40 34 30\n"
        "space directions: (0.5,0,0) (0,1,0) (0,0,2)\nspace origin: (1,2,3)\n"
        "kinds: domain domain domain\nencoding: raw\n\n"
    )
    (tmp_path / "pill.nrrd").write_bytes(header.encode() + image.tobytes())
    subprocess.run(
        [
            os.environ["PELLICLE_COMMAND"], "extract", "pill.nrrd", "-o", "pill.ply", "--iso", "100",
            "--curvature", "0.2", "--report", "pill.json",
        ],
        cwd=tmp_path,
        check=True,
        stdin=subprocess.DEVNULL,
    )
    report = json.loads((tmp_path / "pill.json").read_text())
    surface = pellicle.extract(
        image, 100, spacing=(0.5, 1, 2), origin=(1, 2, 3), curvature=0.2
    )
    assert f"{surface.hash:016x}" in json.dumps(report)


def test_frozen_sites_lie_where_the_surface_is():
    rng = np.random.default_rng(3)
    image = rng.uniform(0, 1, (24, 24, 24)).astype(np.float32)
    surface = pellicle.extract(image, 0.5, levels=0, mesh="uniform")
    places, vertices = surface.frozen_sites
    assert places.dtype == np.float64 and places.shape == (len(vertices), 3)
    assert len(vertices) == surface.levels[-1].frozen_sites > 0
    assert vertices.sum() == surface.levels[-1].frozen_vertices
    assert (places > -3).all() and (places < 27).all()


def test_small_voxels_far_away_are_told_in_float64(pill_surface):
    near = pill_surface
    far = pellicle.extract(pill(), 100, spacing=(1e-6,) * 3, origin=(1e5, 0, 0))
    assert far.vertices_f64.dtype == np.float64 and far.vertices_f64.flags.owndata
    assert np.array_equal(far.vertices_f64.astype(np.float32), far.vertices)
    assert (far.vertices_f64 - [1e5, 0, 0]) * 1e6 == pytest.approx(near.vertices_f64, abs=1e-3)
    assert not pellicle.check_mesh((far.vertices, far.faces)).valid
    assert pellicle.check_mesh((far.vertices_f64, far.faces)).valid
    assert pellicle.check_mesh(far).valid
    assert far.normals == pytest.approx(near.normals, abs=1e-4)
