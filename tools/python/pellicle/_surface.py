"""Surfaces."""

from __future__ import annotations

import base64
import os
from importlib import import_module
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._context import Context, core_of
from ._images import Frame, Vector, frame_of
from ._mesh_files import save, settled_vertices
from ._meshes import arrays_of, component_measures, simplify
from ._parameters import Parameters
from ._picture import picture
from ._records import (
    Check,
    ComponentMeasures,
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


class _Made(NamedTuple):
    """How a surface came to be, and what the engine loses when it makes it again."""

    faces: npt.NDArray[np.uint32]  # of "voxel", in their order
    levels: tuple[LevelReport, ...]
    parameters: Parameters
    seconds: Seconds
    input_range: Range


class Surface:
    """A closed, oriented surface without self-intersections.

    Coordinates are x, y, z in `space`: "lps" (mm, as ITK), "ras" (mm, as nibabel) or "voxel"
    (indices of the input image). Arrays are new at each access, filled by the engine and the
    caller's to change: keep them where they are used more than once. Surfaces do not change: a copy
    shares what it is made of. A pickled one comes back as the same bits, with a context of its own,
    but without `frozen_sites` and the scalar "movement".
    """

    def __init__(self) -> None:
        raise TypeError("a Surface comes from extract, Run.surface or Surface.from_mesh")

    @classmethod
    def _of(
        cls, core: _pellicle.Surface, space: Space, frame: Frame, made: _Made | None = None
    ) -> Surface:
        surface = cls.__new__(cls)
        surface._core = core
        surface._space = space
        surface._frame = frame
        surface._made = made
        return surface

    _core: _pellicle.Surface
    _space: Space
    _frame: Frame
    _made: _Made | None  # of one that was pickled

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
        frame = frame_of(spacing, origin, direction)
        core = _pellicle.surface_create(
            core_of(context), checked_space(space), frame.core(), arrays_of((vertices, faces))
        )
        return cls._of(core, space, frame)

    @property
    def space(self) -> Space:
        """Of coordinates and measures."""
        return self._space

    def in_space(self, space: Space) -> Surface:
        """The same surface, with coordinates and measures in another space; nothing is copied."""
        return self._of(self._core, checked_space(space), self._frame, self._made)

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
        space's origin, and rarely where parts of it all but touch, which `round_mesh` mends.
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
        faces = self._core.faces(self._space)
        if self._made is None:
            return faces
        mirrored = not np.array_equal(faces, self._core.faces("voxel"))
        return self._made.faces[:, [0, 2, 1] if mirrored else [0, 1, 2]]

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
        if self._made is not None:
            return self._made.levels
        return tuple(LevelReport(**report) for report in self._core.levels())

    @property
    def parameters(self) -> Parameters:
        """Those of the extraction, with everything that was derived filled in."""
        if self._made is not None:
            return self._made.parameters
        return Parameters(**self._core.parameters())

    @property
    def seconds(self) -> Seconds:
        """Where the time of the extraction went."""
        if self._made is not None:
            return self._made.seconds
        return Seconds(**self._core.seconds())

    @property
    def input_range(self) -> Range:
        """Smallest and largest voxel of the input."""
        if self._made is not None:
            return self._made.input_range
        return Range(*self._core.input_range())

    @property
    def area(self) -> float:
        """In the space: mm2, or faces of voxels."""
        return self.measures().area

    @property
    def volume(self) -> float:
        """In the space: mm3, or voxels."""
        return self.measures().volume

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(2, 3): the smallest and the largest x, y, z; NaN where there is no vertex."""
        vertices = self.vertices_f64
        if len(vertices) == 0:
            return np.full((2, 3), np.nan)
        return np.stack([vertices.min(axis=0), vertices.max(axis=0)])

    @property
    def components(self) -> list[ComponentMeasures]:
        """The measures of each component, the largest area first; walls of cavities are some."""
        return component_measures(self, context=self.context).each

    def simplify(self, tolerance: float, *, one_sided: bool = False) -> Surface:
        """A surface of fewer vertices within a distance of this one, which stays as it is.

        Parameters
        ----------
        tolerance : float
            In the space. No place of either surface is farther from the other one, but for the
            rounding to float32 of voxels; `pellicle.simplify` tells the distances.
        one_sided : bool
            That places of this surface are near the new one is not asked for.

        Raises
        ------
        InvalidData
            Where rounding makes faces meet.
        """
        made = simplify(self, tolerance, one_sided=one_sided, context=self.context)
        core = _pellicle.surface_create(
            self._core.context, self._space, self._frame.core(), (made.vertices, made.faces)
        )
        return self._of(core, self._space, self._frame)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a mesh file, whose comment names the space; the same bytes as the command.

        Coordinates are written as floats. Where that rounding would make faces meet they are
        written as doubles, which makes an STL text.

        Parameters
        ----------
        path : str or path
            Of suffix .ply, .stl or .obj.

        Raises
        ------
        ValueError
            For another suffix.
        InvalidData
            Where faces would meet even in doubles.
        """
        save(self, path)

    def to_trimesh(self) -> Any:
        """A ``trimesh.Trimesh``, whose vertices and faces are in the same order."""
        module = _module("trimesh")
        return module.Trimesh(settled_vertices(self), self.faces.astype(np.int64), process=False)

    def to_pyvista(self) -> Any:
        """A ``pyvista.PolyData``, whose points and faces are in the same order."""
        module = _module("pyvista")
        faces = self.faces.astype(np.int64)
        return module.PolyData(
            settled_vertices(self), np.insert(faces, 0, 3, axis=1).ravel()
        )

    def to_meshio(self) -> Any:
        """A ``meshio.Mesh``, whose points and triangles are in the same order."""
        module = _module("meshio")
        return module.Mesh(settled_vertices(self), [("triangle", self.faces.astype(np.int64))])

    def _moved(self, indices: npt.NDArray[np.int64], frame: Frame) -> Surface:
        """The surface of a part of an image, whose first voxel has these indices, in the whole."""
        vertices = self._core.positions_f64("voxel") + indices
        made = self._how()
        core = _pellicle.surface_create(
            self._core.context, "voxel", frame.core(), (vertices, made.faces)
        )
        return self._of(core, self._space, frame, made)

    def _how(self) -> _Made:
        faces = self.in_space("voxel").faces
        return _Made(faces, self.levels, self.parameters, self.seconds, self.input_range)

    def __copy__(self) -> Surface:
        return self.in_space(self._space)

    def __deepcopy__(self, memo: dict[int, Any]) -> Surface:
        return self.in_space(self._space)

    def __reduce__(self) -> tuple[Any, ...]:
        # The engine holds float32 of voxels: these are all bits.
        vertices = self._core.positions("voxel")
        return _unpickled, (vertices, self._space, self._frame, self._how())

    def _repr_html_(self) -> str:
        measures = self.measures()
        unit = "voxels" if self._space == "voxel" else "mm"
        rows = {
            "vertices": f"{measures.vertices:,}",
            "faces": f"{measures.faces:,}",
            "components": f"{measures.components:,}",
            "genus": f"{measures.genus:,}",
            "area": f"{measures.area:,.6g} {unit}\u00b2",
            "volume": f"{measures.volume:,.6g} {unit}\u00b3",
            "space": self._space,
        }
        cells = "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in rows.items())
        table = f"<table>{cells}</table>"
        if self.face_count == 0:
            return table
        png = base64.b64encode(picture(self.vertices_f64, self.faces, self._space)).decode()
        image = f'<img alt="The surface" src="data:image/png;base64,{png}">'
        return f'<div style="display:flex;align-items:center;gap:1em">{image}{table}</div>'

    def __repr__(self) -> str:
        return (
            f"<pellicle.Surface of {self.vertex_count} vertices and {self.face_count} faces "
            f"in {self._space!r}>"
        )


def _module(name: str) -> ModuleType:
    """A library that is needed by one function only."""
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(f"to_{name} needs {name}, which is not there: {error}") from None


def _unpickled(
    vertices: npt.NDArray[np.float32], space: Space, frame: Frame, made: _Made
) -> Surface:
    arrays = arrays_of((vertices, made.faces))
    core = _pellicle.surface_create(core_of(None), "voxel", frame.core(), arrays)
    return Surface._of(core, space, frame, made)
