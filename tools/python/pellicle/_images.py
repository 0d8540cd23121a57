"""Arrays as images: axes, types and where they lie."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Protocol, TypedDict

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._records import Triple
from ._values import plain_array, real_array

Order = Literal["zyx", "xyz"]
Vector = Sequence[float] | npt.NDArray[np.floating[Any]]

_NATIVE = [np.dtype(t) for t in ("uint8", "int16", "uint16", "int32", "float32")]
_IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Geometry(TypedDict):
    """Where an image lies, for ``**``: see `geometry_from_affine`."""

    spacing: Triple
    origin: Triple
    direction: npt.NDArray[np.float64]


def geometry_from_affine(affine: npt.ArrayLike, space: Literal["ras", "lps"] = "ras") -> Geometry:
    """Spacing, origin and direction of a matrix from voxel indices to patient space.

    Parameters
    ----------
    affine : array_like
        (4, 4), as nibabel's ``image.affine``: of indices i, j, k and mm.
    space : {"ras", "lps"}
        Where it leads to. nibabel's lead to "ras".

    Returns
    -------
    Geometry
        For ``extract(voxels, iso, order="xyz", **geometry_from_affine(image.affine))``.
    """
    matrix = real_array(affine, "affine").copy()
    if matrix.shape != (4, 4):
        raise ValueError(f"affine: must be 4 x 4, not of shape {matrix.shape}")
    if space not in ("ras", "lps"):
        raise ValueError(f"space {space!r}: must be 'ras' or 'lps'")
    if space == "ras":
        matrix[:2] *= -1
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    if not (np.isfinite(matrix).all() and (spacing > 0).all()):
        raise ValueError("affine: an axis has no length")
    return Geometry(
        spacing=_triple("spacing", spacing),
        origin=_triple("origin", matrix[:3, 3]),
        direction=matrix[:3, :3] / spacing,
    )


def _triple(name: str, values: Vector) -> Triple:
    array = real_array(values, name)
    if array.shape != (3,):
        raise ValueError(f"{name}: must be three numbers: x, y, z")
    return (float(array[0]), float(array[1]), float(array[2]))


class Frame(NamedTuple):
    """Where an image lies, as numbers that can be kept."""

    spacing: Triple
    origin: Triple
    direction: tuple[float, ...]  # row by row

    def core(self) -> _pellicle.Geometry:
        """As the engine takes it."""
        return _pellicle.Geometry(*self)


def frame_of(spacing: Vector, origin: Vector, direction: npt.ArrayLike | None) -> Frame:
    """Of what a caller gives."""
    axes = real_array(_IDENTITY if direction is None else direction, "direction")
    if axes.shape not in ((3, 3), (9,)):
        raise ValueError("direction: must be 3 x 3, or its nine numbers row by row")
    return Frame(
        _triple("spacing", spacing), _triple("origin", origin), tuple(axes.ravel().tolist())
    )


@dataclass(frozen=True, eq=False)
class Image:
    """An image and where it lies, as `read` gives it. Functions take it in place of an array.

    Attributes
    ----------
    values : numpy.ndarray
        Indexed [z, y, x].
    geometry : Geometry
        ``spacing``, ``origin`` and ``direction`` in LPS and mm, for ``**image.geometry``.
    """

    values: npt.NDArray[Any]
    geometry: Geometry

    def __repr__(self) -> str:
        size = " x ".join(str(n) for n in reversed(self.values.shape))
        spacing = " x ".join(f"{mm:.4g}" for mm in self.geometry["spacing"])
        return f"<pellicle.Image of {size} voxels of {self.values.dtype}, {spacing} mm>"


def located(
    image: npt.ArrayLike | Image,
    order: Order,
    spacing: Vector,
    origin: Vector,
    direction: npt.ArrayLike | None,
) -> tuple[npt.NDArray[Any], Frame]:
    """An image's voxels indexed [x, y, z], and where they lie."""
    frame = frame_of(spacing, origin, direction)
    if isinstance(image, Image):
        if frame != frame_of((1, 1, 1), (0, 0, 0), None) or order != "zyx":
            raise TypeError("an Image tells its order and geometry: give image.values with others")
        return voxels_of(image.values, "zyx"), frame_of(**image.geometry)
    return voxels_of(image, order), frame


def voxels_of(image: npt.ArrayLike, order: Order, name: str = "image") -> npt.NDArray[Any]:
    """The array indexed [x, y, z], of a type of the engine. A view, where no value changes."""
    if order not in ("zyx", "xyz"):
        raise ValueError(f"order {order!r}: must be 'zyx' or 'xyz'")
    array = plain_array(image, name)
    if array.ndim != 3:
        raise ValueError(f"{name}: must have three axes, not {array.ndim}")
    array = _typed(array, name)
    if not array.flags.aligned or 0 in array.strides:
        array = array.copy()
    return array.transpose() if order == "zyx" else array


class Sliced(Protocol):
    """What a volume of bricks is read from: a zarr.Array, an h5py.Dataset, a numpy.memmap."""

    @property
    def shape(self) -> tuple[int, ...]: ...
    @property
    def dtype(self) -> Any: ...
    def __getitem__(self, index: Any) -> Any: ...


# What each type becomes that need not be looked at as a whole.
_BY_BRICKS = {
    "b1": "uint8", "u1": "uint8", "i1": "int16", "i2": "int16", "u2": "uint16",
    "f2": "float32", "f4": "float32", "f8": "float32",
}


def brick_type(dtype: Any) -> np.dtype[Any]:
    """That of the bricks of an array."""
    given = np.dtype(dtype)
    if (name := _BY_BRICKS.get(f"{given.kind}{given.itemsize}")) is None:
        raise TypeError(f"array: voxels of type {given} are not read by bricks")
    return np.dtype(name)


def brick_reader(
    array: Sliced, order: Order, dtype: np.dtype[Any]
) -> Callable[[list[int], list[int]], npt.NDArray[Any]]:
    """Gives the voxels from low to high, both x, y, z, indexed [z, y, x]."""

    def read(low: list[int], high: list[int]) -> npt.NDArray[Any]:
        box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        part = array[box[::-1] if order == "zyx" else box]
        part = plain_array(part, "array")
        if part.dtype.kind == "f" and part.dtype.itemsize == 8:
            part = _typed(part, "array")
        return np.ascontiguousarray(part if order == "zyx" else part.transpose(), dtype)

    return read


def brick_of(array: Sliced, dims: Sequence[int], order: Order) -> tuple[int, ...]:
    """Voxels along x, y, z of bricks that are best read at once: whole chunks."""
    chunks = getattr(array, "chunks", None)
    if not (
        isinstance(chunks, tuple) and len(chunks) == 3 and all(isinstance(n, int) for n in chunks)
    ):
        return (64, 64, 64)
    if order == "zyx":
        chunks = chunks[::-1]
    return tuple(-(-max(32, n) // n) * n for n in chunks)


def _typed(array: npt.NDArray[Any], name: str) -> npt.NDArray[Any]:
    kind, size = array.dtype.kind, array.dtype.itemsize
    native = array.dtype.newbyteorder("=")
    if native in _NATIVE:
        return array.astype(native, copy=False)
    if kind == "b":
        return array.view(np.uint8)
    if kind == "i" and size == 1:
        return array.astype(np.int16)
    if kind in "iu":
        info = np.iinfo(np.int32)
        if array.size > 0 and (array.min() < info.min or array.max() > info.max):
            raise ValueError(f"{name}: {array.dtype} values do not fit into int32")
        return array.astype(np.int32)
    if kind == "f" and size <= 8:
        with np.errstate(over="ignore"):
            rounded = array.astype(np.float32)
        if size == 8 and np.isinf(rounded).any() and not np.isinf(array).any():
            raise ValueError(f"{name}: {array.dtype} values do not fit into float32")
        return rounded
    raise TypeError(f"{name}: voxels of type {array.dtype} are not supported")
