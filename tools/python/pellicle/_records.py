"""What the engine tells: plain records, all read-only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

Space = Literal["lps", "ras", "voxel"]
Scalar = Literal["mean_curvature", "gaussian_curvature", "area", "valence", "movement"]
Simd = Literal["auto", "scalar", "sse4", "avx2", "avx512", "neon"]
Verdict = Literal["accept", "more", "stop"]
Triple = tuple[float, float, float]
Dims = tuple[int, int, int]


class Memory(NamedTuple):
    """Bytes of a context and all that was made with it.

    Attributes
    ----------
    now : int
        Allocated now.
    peak : int
        The most there have been.
    """

    now: int
    peak: int


class Range(NamedTuple):
    """Smallest and largest value."""

    low: float
    high: float


class BrickCounts(NamedTuple):
    """Bricks of a volume."""

    bricks: int
    read: int
    read_again: int


@dataclass(frozen=True)
class Progress:
    """How far an evolution has come.

    Attributes
    ----------
    level : int
        Of the pyramid; counts down to 0, the full image.
    levels : int
        Levels above level 0.
    iteration : int
        Of this level, from 1; 0 before the first.
    vertices : int
        Of the surface.
    energy : float
        Kinetic energy along the normals, in m (delta / dt)^2.
    speed : float
        Of the fastest vertex, in delta per time.
    fraction : float
        An estimate of what is done, 0 .. 1, never falling.
    seconds : float
        Since the start of the call; in `Run.progress` those spent within calls on the run.
    """

    level: int
    levels: int
    iteration: int
    vertices: int
    energy: float
    speed: float
    fraction: float
    seconds: float


@dataclass(frozen=True)
class ForcePoints:
    """All living vertices, for a force of the caller's. The arrays are the caller's to keep.

    Attributes
    ----------
    level : int
        Of the pyramid.
    positions, normals : numpy.ndarray
        (n, 3) float32 in the space of the call; normals are unit and outward.
    """

    level: int
    positions: npt.NDArray[np.float32]
    normals: npt.NDArray[np.float32]


@dataclass(frozen=True)
class PyramidLevel:
    """One image of a pyramid.

    Attributes
    ----------
    dims : tuple of int
        Voxels along x, y, z, padding included.
    spacing : tuple of float
        mm between voxel centres.
    origin : tuple of float
        LPS position of the centre of voxel (0, 0, 0), mm.
    unit : float
        U_h, mm.
    iso : float or None
        pi_I of this level, in the image's units; None: not set.
    """

    dims: Dims
    spacing: Triple
    origin: Triple
    unit: float
    iso: float | None


@dataclass(frozen=True)
class LevelReport:
    """How the surface came through one level of the pyramid.

    Attributes
    ----------
    level : int
        Of the pyramid, 0: the full image.
    dims : tuple of int
        Voxels along x, y, z, padding included.
    unit : float
        U_h, mm.
    delta : float
        The invariant of the constraints (1)-(3), in voxels of level 0 (in their shortest sides where
        `anisotropy` is not "voxel").
    iso : float or None
        pi_I of this level, in the image's units; None: not set.
    iterations, vertices : int
        At the end of the level.
    converged : bool
        False: `max_iterations` ended it.
    energy, speed : float
        As in `Progress`, at the end.
    seconds_topology, seconds_normals, seconds_dynamics, seconds_total : float
        Where the time went.
    creations, inversions, deletions, annular, axial, tetrahedra, refinements : int
        Transformations of the mesh.
    deferred : int
        Operations that a limit put off to the next iteration.
    late_bubbles, late_cavities : int
        Started in parts and cavities that had been missed.
    late_volume : float
        Of all of them as they started, mm3.
    moves, checks : int
        Of single vertices, and of their constraints after a movement.
    frozen_sites, frozen_vertices : int
        Sites that would never have come to rest and were frozen, and their vertices.
    """

    level: int
    dims: Dims
    unit: float
    delta: float
    iso: float | None
    iterations: int
    vertices: int
    converged: bool
    energy: float
    speed: float
    seconds_topology: float
    seconds_normals: float
    seconds_dynamics: float
    seconds_total: float
    creations: int
    inversions: int
    deletions: int
    annular: int
    axial: int
    tetrahedra: int
    refinements: int
    deferred: int
    late_bubbles: int
    late_cavities: int
    late_volume: float
    moves: int
    checks: int
    frozen_sites: int
    frozen_vertices: int


@dataclass(frozen=True)
class Seconds:
    """Where the time of an extraction went.

    Attributes
    ----------
    preparation : float
        All before the evolution: range, window, pyramid, iso-values.
    images : float
        Of it: the images of the pyramid alone.
    evolution : float
        The rest.
    """

    preparation: float
    images: float
    evolution: float


@dataclass(frozen=True)
class Measures:
    """What a mesh is, over all components.

    Attributes
    ----------
    vertices, faces : int
        How many.
    components : int
        Of faces adjacent by an edge.
    euler : int
        V - E + F.
    genus : int or None
        Sum over the components; None unless they are closed and orientable.
    area, volume : float
        In the unit of the coordinates, squared and cubed. The volume is signed: positive where
        faces are outward.
    """

    vertices: int
    faces: int
    components: int
    euler: int
    genus: int | None
    area: float
    volume: float


@dataclass(frozen=True)
class Check:
    """Whether a mesh is a valid surface, by exact predicates, and if not, why.

    Attributes
    ----------
    measures : Measures
    valid : bool
        Closed, manifold, oriented, outward, no degenerate face, no self-intersection.
    closed : bool
        Every edge has an even, non-zero number of faces; no repeated index in a face.
    manifold : bool
        No edge of more than two faces, no vertex with more than one umbrella.
    oriented : bool
        Both faces of each edge run it in opposite directions.
    outward : bool or None
        Each component faces outward, walls of cavities inward; None: not defined.
    border_edges, non_manifold_edges, non_manifold_vertices, inconsistent_edges : int
    wrongly_oriented_components : int
    degenerate_faces : int
        Of exactly zero area, or with a repeated index.
    duplicate_points : int
        Whose coordinates equal those of an earlier point.
    isolated_vertices : int
    self_intersections : int
        Pairs of faces that meet elsewhere than in what they share.
    first_intersection : tuple of int or None
        The first such pair.
    edge_min, edge_mean, edge_max : float
    min_angle, max_angle : float
        Degrees.
    valence_min, valence_max : int
    """

    measures: Measures
    valid: bool
    closed: bool
    manifold: bool
    oriented: bool
    outward: bool | None
    border_edges: int
    non_manifold_edges: int
    non_manifold_vertices: int
    inconsistent_edges: int
    wrongly_oriented_components: int
    degenerate_faces: int
    duplicate_points: int
    isolated_vertices: int
    self_intersections: int
    first_intersection: tuple[int, int] | None
    edge_min: float
    edge_mean: float
    edge_max: float
    min_angle: float
    max_angle: float
    valence_min: int
    valence_max: int


@dataclass(frozen=True, eq=False)
class ComponentMeasures:
    """One component of a mesh (faces adjacent by an edge), or all of them together.

    Moments are of the enclosed volume with density 1, and signed as it.

    Attributes
    ----------
    first_face : int
        The smallest face of it; 0 for all together.
    vertices, faces, euler : int
    genus : int or None
        None unless closed and consistently oriented; the sum for all together.
    area, volume : float
        The volume is NaN unless the faces close.
    low, high : tuple of float
        The corners of the bounding box.
    centroid : tuple of float
        Of the enclosed volume; NaN, as all that follows, where that is 0 or NaN.
    moments : numpy.ndarray
        (3, 3), second moments about the centroid c: the integral of (x - c)(x - c)^T.
    principal_moments : tuple of float
        Eigenvalues of the second moments, the largest first.
    principal_axes : numpy.ndarray
        (3, 3), a right-handed frame: row i is the unit axis of principal moment i.
    """

    first_face: int
    vertices: int
    faces: int
    euler: int
    genus: int | None
    area: float
    volume: float
    low: Triple
    high: Triple
    centroid: Triple
    moments: npt.NDArray[np.float64]
    principal_moments: Triple
    principal_axes: npt.NDArray[np.float64]


class Components(NamedTuple):
    """The measures of all components together, and of each, the largest area first."""

    whole: ComponentMeasures
    each: list[ComponentMeasures]


class Curvature(NamedTuple):
    """Curvatures of each vertex, (n,) float64; NaN on borders.

    Attributes
    ----------
    mean, gaussian : numpy.ndarray
        1 / r and 1 / r^2 for a ball of radius r with outward faces.
    area : numpy.ndarray
        The mixed area of the vertex: their sum is the area of the mesh.
    """

    mean: npt.NDArray[np.float64]
    gaussian: npt.NDArray[np.float64]
    area: npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Distances:
    """Unsigned distances from one mesh to the nearest points of the faces of another.

    Attributes
    ----------
    at_vertices : numpy.ndarray
        (n,) float64, one for each vertex of the first mesh.
    mean, rms : float
        Over the area of the first mesh.
    max : float
        At most, and for small faces nearly, the one-sided Hausdorff distance.
    vertex_mean, vertex_max : float
        Of the vertices alone.
    """

    at_vertices: npt.NDArray[np.float64]
    mean: float
    rms: float
    max: float
    vertex_mean: float
    vertex_max: float


@dataclass(frozen=True, eq=False)
class Simplified:
    """A mesh of fewer vertices, and how far it is from the mesh that it was made of.

    Attributes
    ----------
    vertices : numpy.ndarray
        (n, 3) float64.
    faces : numpy.ndarray
        (m, 3) uint32.
    from_at_least, from_at_most : float
        Between these is the largest distance from a place of the result to the mesh.
    to_at_least, to_at_most : float
        The same from a place of the mesh to the result.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.uint32]
    from_at_least: float
    from_at_most: float
    to_at_least: float
    to_at_most: float


def check_of(fields: dict[str, Any]) -> Check:
    fields["measures"] = Measures(**fields["measures"])
    return Check(**fields)
