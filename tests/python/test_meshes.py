"""Functions of any mesh."""

import numpy as np
import pytest
from scenes import ball, octahedron

import pellicle


@pytest.fixture(scope="module")
def sphere():
    return pellicle.extract(ball(40, 14), 0.5, curvature=0.1, mesh="uniform", space="voxel")


def test_check_tells_what_is_wrong():
    vertices, faces = octahedron()
    check = pellicle.check_mesh((vertices, faces))
    assert check.valid and check.first_intersection is None and check.measures.genus == 0
    assert (check.valence_min, check.valence_max) == (4, 4)
    opened = pellicle.check_mesh((vertices, faces[1:]))
    assert not opened.valid and opened.border_edges == 3
    assert opened.outward is None and opened.measures.genus is None
    shifted = np.vstack([vertices, vertices + [0.4, 0.1, 0.2]])
    crossing = pellicle.check_mesh((shifted, np.vstack([faces, faces + 6])))
    assert not crossing.valid and crossing.self_intersections > 0
    assert crossing.first_intersection is not None
    inward = pellicle.check_mesh((vertices, faces[:, ::-1]))
    assert inward.closed and inward.outward is False


def test_a_surface_is_a_mesh(sphere):
    pair = (sphere.vertices, sphere.faces)
    assert pellicle.check_mesh(sphere) == pellicle.check_mesh(pair)
    assert pellicle.check_mesh(sphere).measures.area == pytest.approx(sphere.measures().area)


def test_components():
    vertices, faces = octahedron()
    both = np.vstack([vertices, 2 * vertices + 10])
    whole, each = pellicle.component_measures((both, np.vstack([faces, faces + 6])))
    assert [part.first_face for part in each] == [8, 0]
    assert [part.volume for part in each] == pytest.approx([8 * 4 / 3, 4 / 3])
    assert each[0].centroid == pytest.approx((10, 10, 10))
    assert (each[0].low, each[0].high) == ((8, 8, 8), (12, 12, 12))
    assert whole.volume == pytest.approx(9 * 4 / 3) and whole.euler == 4
    assert each[1].moments == pytest.approx(np.eye(3) * each[1].moments[0, 0])
    axes = each[1].principal_axes
    assert axes @ axes.T == pytest.approx(np.eye(3))
    many = 100
    shifts = np.arange(many)[:, None, None] * [5, 0, 0]
    scattered = (vertices + shifts).reshape(-1, 3)
    indices = (faces + 6 * np.arange(many)[:, None, None]).reshape(-1, 3)
    assert len(pellicle.component_measures((scattered, indices)).each) == many


def test_moments_are_about_the_right_axes():
    vertices, faces = octahedron()
    long = pellicle.component_measures((vertices * [3, 2, 1] + [1, 2, 3], faces)).each[0]
    assert np.diag(long.moments)[0] > np.diag(long.moments)[1] > np.diag(long.moments)[2]
    assert abs(long.principal_axes[0]) == pytest.approx([1, 0, 0], abs=1e-9)
    assert long.principal_moments == pytest.approx(tuple(np.diag(long.moments)))


def test_curvature(sphere):
    mean, gaussian, area = pellicle.curvature(sphere)
    assert np.median(mean) == pytest.approx(1 / 14, rel=0.15)
    assert (gaussian * area).sum() == pytest.approx(4 * np.pi)
    assert area.sum() == pytest.approx(sphere.measures().area)
    vertices, faces = octahedron()
    assert np.isnan(pellicle.curvature((vertices, faces[1:])).mean).sum() == 3


def test_geodesics_and_nearest_vertices(sphere):
    vertices = sphere.vertices
    top = pellicle.nearest_vertex(sphere, [19.5, 19.5, 40])
    assert top == np.linalg.norm(vertices - [19.5, 19.5, 40], axis=1).argmin()
    distance = pellicle.geodesic(sphere, top)
    assert distance[top] == 0 and distance.max() == pytest.approx(14 * np.pi, rel=0.05)
    straight = np.linalg.norm(vertices - vertices[top], axis=1)
    assert (distance >= straight - 1e-5).all()
    empty = (np.zeros((0, 3)), np.zeros((0, 3), int))
    assert pellicle.nearest_vertex(empty, [0, 0, 0]) is None
    with pytest.raises(pellicle.InvalidArgument):
        pellicle.geodesic(sphere, len(vertices))


def test_distances(sphere):
    smaller = pellicle.extract(ball(40, 12), 0.5, curvature=0.1, space="voxel")
    distances = pellicle.distance(sphere, smaller)
    assert distances.mean == pytest.approx(2, abs=0.2)
    assert distances.at_vertices.shape == (sphere.vertex_count,)
    assert distances.at_vertices.max() == pytest.approx(distances.vertex_max)
    assert pellicle.distance(sphere, sphere).max == pytest.approx(0, abs=1e-5)
    with pytest.raises(pellicle.InvalidData):
        pellicle.distance(sphere, (np.zeros((0, 3)), np.zeros((0, 3), int)))


def test_simplified_meshes_are_valid_and_within_the_tolerance(sphere):
    simple = pellicle.simplify(sphere, 0.1)
    assert len(simple.vertices) < sphere.vertex_count / 3
    assert pellicle.check_mesh((simple.vertices, simple.faces)).valid
    back = pellicle.distance(sphere, (simple.vertices, simple.faces)).max
    assert back <= simple.to_at_most <= 0.1 and simple.from_at_most <= 0.1
    nearer = pellicle.simplify(sphere, 0.1, one_sided=True)
    assert len(nearer.vertices) < sphere.vertex_count / 3 and nearer.from_at_most <= 0.1
    surface = sphere.simplify(0.1)
    assert surface.vertex_count == len(simple.vertices)
    assert surface.space == sphere.space and surface.check().valid
    with pytest.raises(pellicle.InvalidData, match="edge"):
        pellicle.simplify((simple.vertices, simple.faces[1:]), 0.1)
    with pytest.raises(pellicle.InvalidArgument, match="tolerance"):
        pellicle.simplify(sphere, float("nan"))


def test_rounded_meshes_are_valid():
    nearly = np.array([[x, y, z] for z in (0, 1, 1 + 1e-9, 2) for x, y in ((0, 0), (1, 0), (0, 1))])
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    below = nearly[[0, 1, 2, 3]]  # its apex all but touches the base of the other
    above = nearly[[6, 7, 8, 9]]
    mesh = (np.concatenate([below, above]) + 1e3, np.concatenate([tetrahedron, tetrahedron + 4]))
    assert pellicle.check_mesh(mesh).valid
    assert not pellicle.check_mesh((mesh[0].astype(np.float32), mesh[1])).valid
    rounded = pellicle.round_mesh(mesh)
    assert rounded.dtype == np.float32 and pellicle.check_mesh((rounded, mesh[1])).valid
    assert np.abs(rounded - mesh[0]).max() < 1e-3
    with pytest.raises(pellicle.InvalidData, match="edge"):
        pellicle.round_mesh((mesh[0], mesh[1][1:]))


def test_arrays_of_other_types_are_taken_where_they_fit():
    vertices, faces = octahedron()
    expected = pellicle.check_mesh((vertices, faces))
    for other in (
        (vertices.astype(np.float32), faces.astype(np.int8)),
        (vertices.tolist(), faces.tolist()),
        (np.asfortranarray(vertices), np.asfortranarray(faces.astype(np.uint64))),
        (np.repeat(vertices, 2, axis=1)[:, ::2], faces.astype(np.uint32)[::-1][::-1]),
    ):
        assert pellicle.check_mesh(other) == expected
    for wrong, error in (
        ((vertices, faces.astype(float)), TypeError),
        ((vertices, faces - 1), ValueError),
        ((vertices, faces.astype(np.int64) + 2**32), ValueError),
        ((vertices[:, :2], faces), ValueError),
        ((vertices, faces.ravel()), ValueError),
        ((vertices, faces + 3), pellicle.InvalidData),
        ((vertices * np.nan, faces), pellicle.InvalidData),
        (vertices, TypeError),
        (None, TypeError),
    ):
        with pytest.raises(error):
            pellicle.check_mesh(wrong)
