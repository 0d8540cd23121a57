"""Surfaces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._context import Context, core_of
from ._images import Vector, geometry_of
from ._meshes import arrays_of
from ._parameters import Parameters
from ._records import (
    Check,
    LevelReport,
    Measures,
    Range,
    Scalar,
    Seconds,
    Space,
    check_of,
)

_SPACES = ("lps", "ras", "voxel")


def checked_space(space: Space) -> Space:
    if space not in _SPACES:
        raise ValueError(f"space {space!r}: must be 'lps', 'ras' or 'voxel'")
    return space


class Surface:
    """A closed, oriented surface without self-intersections.

    Coordinates are x, y, z in `space`: "lps" (mm, as ITK), "ras" (mm, as nibabel) or "voxel"
    (indices of the input image). Arrays are new at each access, filled by the engine and the
    caller's to change: keep them where they are used more than once.
    """

    def __init__(self) -> None:
        raise TypeError("a Surface comes from extract, Run.surface or Surface.from_mesh")

    @classmethod
    def _of(cls, core: _pellicle.Surface, space: Space) -> Surface:
        surface = cls.__new__(cls)
        surface._core = core
        surface._space = space
        return surface

    _core: _pellicle.Surface
    _space: Space

    @classmethod
    def from_mesh(
        cls,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        spacing: Vector = (1, 1, 1),
        origin: Vector = (0, 0, 0),
        direction: npt.ArrayLike | None = None,
        space: Space = "lps",
        context: Context | None = None,
    ) -> Surface:
        """The surface of a mesh from elsewhere.

        Parameters
        ----------
        vertices : array_like
            (n, 3) coordinates in `space`. They are rounded to float32 of voxels; those without a
            face are dropped, others keep their order.
        faces : array_like
            (m, 3) indices, counter-clockwise seen from outside.
        spacing, origin, direction
            Of the image in which the mesh lies; see `extract`.
        space : {"lps", "ras", "voxel"}
        context : Context, optional

        Raises
        ------
        InvalidData
            Where the mesh is not closed, oriented and free of self-intersections: says where.
        """
        core = _pellicle.surface_create(
            core_of(context),
            checked_space(space),
            geometry_of(spacing, origin, direction),
            arrays_of((vertices, faces)),
        )
        return cls._of(core, space)

    @property
    def space(self) -> Space:
        """Of coordinates and measures."""
        return self._space

    def in_space(self, space: Space) -> Surface:
        """The same surface, with coordinates and measures in another space; nothing is copied."""
        return self._of(self._core, checked_space(space))

    @property
    def context(self) -> Context:
        """The one that the surface was made with."""
        return Context._of(self._core.context)

    @property
    def vertex_count(self) -> int:
        """How many vertices there are."""
        return self._core.vertex_count

    @property
    def face_count(self) -> int:
        """How many faces there are."""
        return self._core.face_count

    @property
    def vertices(self) -> npt.NDArray[np.float32]:
        """(n, 3) float32, in the engine's canonical order."""
        return self._core.positions(self._space)

    @property
    def vertices_f64(self) -> npt.NDArray[np.float64]:
        """(n, 3) float64: as `vertices`, but not rounded to float32.

        That rounding makes faces meet where the surface lies millions of voxels away from the
        space's origin.
        """
        return self._core.positions_f64(self._space)

    @property
    def frozen_sites(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
        """Where the surface would never have come to rest and was frozen.

        (k, 3) float64 places and (k,) int64 vertices of each, those of most vertices first. The
        surface is as valid there as anywhere, but not where its forces would have it.
        """
        return self._core.frozen_sites(self._space)

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """(m, 3) uint32 indices, counter-clockwise seen from outside in the space."""
        return self._core.faces(self._space)

    @property
    def normals(self) -> npt.NDArray[np.float32]:
        """(n, 3) float32, unit and outward."""
        return self._core.normals(self._space)

    def scalars(self, name: Scalar) -> npt.NDArray[np.float32]:
        """A number for each vertex.

        Parameters
        ----------
        name : {"mean_curvature", "gaussian_curvature", "area", "valence", "movement"}
            Curvatures and the mixed area as `curvature`, the number of neighbours, or the movement
            of the last iteration along the normal, in delta: where it is not small the surface has
            not come to rest.

        Returns
        -------
        numpy.ndarray
            (n,) float32.
        """
        if not isinstance(name, str):
            raise TypeError(f"name: must be a str, not {type(name).__name__}")
        return self._core.scalars(name, self._space)

    @property
    def hash(self) -> int:
        """64 bits of the positions and the topology: equal where two surfaces are the same bits.

        ``f"{surface.hash:016x}"`` is what reports of the command `pellicle` tell.
        """
        return self._core.hash()

    def measures(self) -> Measures:
        """Counts, genus, area and volume, in the space."""
        return Measures(**self._core.measures(self._space))

    def check(self) -> Check:
        """Whether the surface is valid, by exact predicates; in mm of patient space."""
        return check_of(self._core.check())

    @property
    def levels(self) -> tuple[LevelReport, ...]:
        """How the surface came to be, from coarse to fine; empty for a mesh from elsewhere."""
        return tuple(LevelReport(**report) for report in self._core.levels())

    @property
    def parameters(self) -> Parameters:
        """Those of the extraction, with everything that was derived filled in."""
        return Parameters(**self._core.parameters())

    @property
    def seconds(self) -> Seconds:
        """Where the time of the extraction went."""
        return Seconds(**self._core.seconds())

    @property
    def input_range(self) -> Range:
        """Smallest and largest voxel of the input."""
        return Range(*self._core.input_range())

    def __repr__(self) -> str:
        return (
            f"<pellicle.Surface of {self.vertex_count} vertices and {self.face_count} faces "
            f"in {self._space!r}>"
        )

