"""Checking and measuring any mesh: a `Surface`, or a pair of arrays (vertices, faces).

The arrays are (n, 3) numbers and (m, 3) indices, counter-clockwise seen from outside. float64 and
uint32 that are C-contiguous are not copied. The mesh need not be closed, manifold or oriented.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Union

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._context import Context, core_of
from ._records import (
    Check,
    ComponentMeasures,
    Components,
    Curvature,
    Distances,
    Simplified,
    check_of,
)
from ._values import integer, plain_array, real_array

if TYPE_CHECKING:
    from ._surface import Surface

MeshLike = Union["Surface", tuple[npt.ArrayLike, npt.ArrayLike]]


def rows_of_three(array: npt.NDArray[Any], name: str) -> None:
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: must be rows of 3, not of shape {array.shape}")


def arrays_of(mesh: MeshLike, name: str = "mesh") -> _pellicle.Mesh:
    """(n, 3) float64 and (m, 3) uint32, C-contiguous."""
    from ._surface import Surface

    if isinstance(mesh, Surface):
        return mesh.vertices_f64, mesh.faces
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2:
        raise TypeError(f"{name}: must be a Surface or (vertices, faces)")
    vertices = np.ascontiguousarray(real_array(mesh[0], f"{name}: vertices"))
    faces = plain_array(mesh[1], f"{name}: faces")
    rows_of_three(vertices, f"{name}: vertices")
    rows_of_three(faces, f"{name}: faces")
    if faces.dtype.kind not in "iu":
        raise TypeError(f"{name}: faces must be integers, not {faces.dtype}")
    if faces.dtype != np.uint32 and faces.size > 0:
        if faces.min() < 0 or faces.max() > np.iinfo(np.uint32).max:
            raise ValueError(f"{name}: a face has an index that is out of range")
    return vertices, np.ascontiguousarray(faces, dtype=np.uint32)


def check_mesh(mesh: MeshLike, *, context: Context | None = None) -> Check:
    """Whether a mesh is closed, manifold, oriented, outward and free of self-intersections.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
    context : Context, optional

    Returns
    -------
    Check
        Of predicates that are exact. An invalid mesh is no error.

    Raises
    ------
    InvalidData
        Where an index or a value is out of range.
    """
    return check_of(_pellicle.check_mesh(core_of(context), arrays_of(mesh)))


def component_measures(mesh: MeshLike, *, context: Context | None = None) -> Components:
    """Areas, volumes and moments of all components together, and of each.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
    context : Context, optional

    Returns
    -------
    Components
        ``whole`` and ``each``, the largest area first.
    """
    whole, each = _pellicle.component_measures(core_of(context), arrays_of(mesh))
    return Components(ComponentMeasures(**whole), [ComponentMeasures(**one) for one in each])


def curvature(mesh: MeshLike, *, context: Context | None = None) -> Curvature:
    """Mean and Gaussian curvature of each vertex, and its mixed area (Meyer et al., 2003).

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
    context : Context, optional

    Returns
    -------
    Curvature
    """
    return Curvature(*_pellicle.curvature(core_of(context), arrays_of(mesh)))


def nearest_vertex(
    mesh: MeshLike, point: npt.ArrayLike, *, context: Context | None = None
) -> int | None:
    """The vertex of a face nearest to a point, the first of equal ones.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
    point : array_like
        x, y, z.
    context : Context, optional

    Returns
    -------
    int or None
        None where the mesh has no face.
    """
    place = real_array(point, "point")
    if place.shape != (3,):
        raise ValueError("point: must be three numbers: x, y, z")
    vertex = _pellicle.nearest_vertex(core_of(context), arrays_of(mesh), place.tolist())
    return vertex if vertex >= 0 else None


def geodesic(
    mesh: MeshLike, source: int, *, context: Context | None = None
) -> npt.NDArray[np.float64]:
    """Lengths of the shortest paths over the faces from a vertex to each vertex, exact.

    Takes a time like n^1.5 for n vertices on usual meshes, on one thread; an interrupt is seen
    when it ends.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
    source : int
        A vertex.
    context : Context, optional

    Returns
    -------
    numpy.ndarray
        (n,) float64; infinity where no path leads.
    """
    return _pellicle.geodesic(core_of(context), arrays_of(mesh), integer(source, "source"))


def distance(mesh: MeshLike, other: MeshLike, *, context: Context | None = None) -> Distances:
    """Distances from a mesh to the nearest points of the faces of another.

    Parameters
    ----------
    mesh, other : Surface or (vertices, faces)
        In the same space.
    context : Context, optional

    Returns
    -------
    Distances

    Raises
    ------
    InvalidData
        Where the other mesh has no face.
    """
    arrays, others = arrays_of(mesh), arrays_of(other, "other")
    at_vertices, summary = _pellicle.distance(core_of(context), arrays, others)
    return Distances(at_vertices=at_vertices, **summary)


def simplify(
    mesh: MeshLike, tolerance: float, *, one_sided: bool = False, context: Context | None = None
) -> Simplified:
    """A mesh of fewer vertices within a distance.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
        Valid: `check_mesh` tells.
    tolerance : float
        No place of either mesh, on faces too, is farther from the other one.
    one_sided : bool
        That places of the given mesh are near the result is not asked for.
    context : Context, optional

    Returns
    -------
    Simplified
        Valid, too, with the same components and genus; the distances are proved.

    Raises
    ------
    InvalidData
        Where the mesh is not closed, oriented and free of self-intersections: says what is wrong.
    InvalidArgument
        Where the tolerance is not above 0 and finite.
    """
    vertices, faces, bounds = _pellicle.simplify(
        core_of(context), arrays_of(mesh), float(tolerance), bool(one_sided)
    )
    return Simplified(vertices, faces, **bounds)


def round_mesh(mesh: MeshLike, *, context: Context | None = None) -> npt.NDArray[np.float32]:
    """The vertices of a valid mesh in float32, with which it is valid, too.

    Where surfaces all but touch, rounding alone makes faces meet: their corners are moved apart,
    by a few times what float32 is rounded by there.

    Parameters
    ----------
    mesh : Surface or (vertices, faces)
        Valid: `check_mesh` tells. Of a `Surface`, `vertices_f64`.
    context : Context, optional

    Raises
    ------
    InvalidData
        Where the mesh is not valid, or too small beside its distance from the origin for float32.
    """
    return _pellicle.round_mesh(core_of(context), arrays_of(mesh))
