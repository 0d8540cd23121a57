"""A label image to a surface for each label."""

from __future__ import annotations

import itertools
import logging
from collections.abc import Iterator
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from ._changes import PyramidChanges
from ._context import Context
from ._errors import InvalidData
from ._extract import extract
from ._images import Frame, Image, Order, Vector, located
from ._meshes import arrays_of, check_mesh
from ._parameters import Parameters, told
from ._records import Space
from ._surface import Surface, checked_space

_INSIDE = 255
# How a label is drawn, as the command does it: where its indicator is so far within it, in voxels,
# with so much of the curvature. Those that overlap are drawn again with the next ones. From there it
# grows to the half, this far from its neighbours, in units of delta.
_GAP = 0.02
_REACH = 2.0  # voxels, more than it grows by
_TRIES = [(0.25, 1.0), (0.35, 1.0), (0.45, 1.0), (0.45, 0.5), (0.45, 0.25), (0.45, 0.0)]
# Parameters that the labels tell, and those that have no sense for them.
_TAKEN = {
    *("iso", "window_low", "window_high", "pad_value", "levels", "init", "late_bubbles"),
    *("inside_below", "level_iso", "feature", "feature_sigma", "reduction", "bubbles", "force"),
}

_logger = logging.getLogger("pellicle")


@told(without=_TAKEN)
def extract_labels(
    image: npt.ArrayLike | Image,
    *,
    spacing: Vector = (1, 1, 1),
    origin: Vector = (0, 0, 0),
    direction: npt.ArrayLike | None = None,
    order: Order = "zyx",
    space: Space = "lps",
    context: Context | None = None,
    **changes: Unpack[PyramidChanges],
) -> dict[int, Surface]:
    """Extracts a surface of each label of a label image; no two of them overlap.

    A label inside another lies in a cavity of that one's surface, and neighbours are about 0.02 of
    a voxel apart.

    Parameters
    ----------
    image : array_like or Image
        Integers of 32 bits; each value but 0 is a label.
    spacing, origin, direction, order, space, context
        As in `extract`.
    **changes
        Fields of `Parameters` that tell how the surface moves, such as `curvature`.

    Returns
    -------
    dict of int to Surface
        In ascending order of labels. Those too small or too thin to hold a surface are left out,
        and named by a warning of the logger "pellicle".

    Raises
    ------
    InvalidData
        Where a voxel is no integer, no label holds a surface, or two surfaces overlap however far
        apart they are drawn.
    """
    taken = sorted(_TAKEN & changes.keys())
    if taken:
        raise TypeError(f"extract_labels() takes no {taken[0]}: the labels tell it")
    parameters = Parameters().replace(**changes)
    if parameters.mesh == "auto":  # labels touch: coarse facets would keep them apart
        parameters = parameters.replace(mesh="uniform")
    context = Context() if context is None else context
    voxels, frame = located(image, order, spacing, origin, direction)
    pieces = [
        _Piece(label, crop, low, frame, checked_space(space), parameters, context)
        for label, crop, low in _crops(voxels)
    ]
    if not pieces:
        raise InvalidData("image: holds no label: every voxel is 0")
    for piece in pieces:
        piece.draw()
    left_out = [piece.label for piece in pieces if piece.surface is None]
    if len(left_out) == len(pieces):
        raise InvalidData("image: no label is large enough for a surface")
    if left_out:
        _logger.warning("labels too small or too thin to hold a surface, left out: %s", left_out)
    drawn = [piece for piece in pieces if piece.surface is not None]
    _separate(drawn, context)
    boxes = [piece.box for piece in drawn]
    # The smallest first, which a neighbour that is smoothed over it would cost the largest part.
    for i in sorted(range(len(drawn)), key=lambda i: drawn[i].voxels):
        low, high = boxes[i][0] - _REACH, boxes[i][1] + _REACH
        near = [
            other
            for other, box in zip(drawn, boxes, strict=True)
            if other is not drawn[i] and (box[0] <= high).all() and (low <= box[1]).all()
        ]
        drawn[i].grow(near)
    return {piece.label: piece.surface for piece in pieces if piece.surface is not None}


def _crops(
    voxels: npt.NDArray[Any],
) -> Iterator[tuple[int, npt.NDArray[np.uint8], npt.NDArray[np.int64]]]:
    """Each label, its indicator with a voxel around it, and where in the image that begins."""
    if voxels.dtype.kind == "f":
        whole = voxels.astype(np.int32) if np.isfinite(voxels).all() else None
        if whole is None or (whole != voxels).any():
            raise InvalidData("image: a voxel is no integer of 32 bits: labels are")
        voxels = whole
    flat = voxels.ravel(order="F")
    places = np.flatnonzero(flat)
    labels = flat[places]
    sorting = np.argsort(labels, kind="stable")
    values, starts = np.unique(labels[sorting], return_index=True)
    for label, group in zip(values.tolist(), np.split(places[sorting], starts[1:]), strict=False):
        xyz = np.stack(np.unravel_index(group, voxels.shape, order="F"))
        low, high = xyz.min(axis=1) - 1, xyz.max(axis=1) + 1
        crop = np.zeros(high - low + 1, np.uint8, order="F")
        crop[tuple(xyz - low[:, np.newaxis])] = _INSIDE
        yield label, crop, low


class _Piece:
    """A label and its surface."""

    surface: Surface | None = None
    _cropped: Surface  # the same in the frame of the crop, whose coordinates are not rounded again
    attempt = 0  # of _TRIES

    def __init__(
        self,
        label: int,
        crop: npt.NDArray[np.uint8],
        low: npt.NDArray[np.int64],
        frame: Frame,
        space: Space,
        parameters: Parameters,
        context: Context,
    ) -> None:
        self.label = label
        self.voxels = int(np.count_nonzero(crop))
        self._crop = crop
        self._low = low
        self._frame = frame
        self._space = space
        self._parameters = parameters
        self._context = context

    def draw(self) -> None:
        """Makes the surface; where there is none with this try, the one of before stays."""
        margin, _ = _TRIES[self.attempt]
        try:
            surface = self._extract((0.5 + margin) * _INSIDE, init="iso")
        except InvalidData as error:
            if not str(error).startswith("no surface"):
                raise InvalidData(f"label {self.label}: {error}") from error
            return
        if surface.face_count > 0:
            self._take(surface)

    def grow(self, others: list[_Piece]) -> None:
        """On to where the label ends, between the others; or it stays where single precision does
        not hold it."""
        vertices, faces = _merged([other._cropped for other in others])
        try:
            surface = self._extract(
                _INSIDE / 2,
                init="mesh",
                mesh=self._cropped,
                obstacles=(vertices, faces) if len(faces) > 0 else None,
                obstacle_gap=_GAP,
            )
        except InvalidData:
            _logger.warning("label %s: drawn inside of where it is", self.label)
            return
        if surface.face_count > 0:
            self._take(surface)

    def _extract(self, iso: float, *, init: Any, **extras: Any) -> Surface:
        share = _TRIES[self.attempt][1]
        axes = np.reshape(self._frame.direction, (3, 3))
        parameters = self._parameters
        return extract(
            self._crop,
            iso,
            order="xyz",
            spacing=self._frame.spacing,
            origin=self._frame.origin + axes @ (self._low * self._frame.spacing),
            direction=axes,
            parameters=parameters.replace(
                window_low=0,
                window_high=_INSIDE,
                pad_value=0,
                levels=0,  # the start is the surface itself, and nothing of it is missed
                init=init,
                late_bubbles=False,
                curvature=parameters.curvature * share,
            ),
            context=self._context,
            **extras,
        )

    def _take(self, surface: Surface) -> None:
        self._cropped = surface
        self.surface = surface._moved(self._low, self._frame).in_space(self._space)

    @property
    def box(self) -> npt.NDArray[np.float64]:
        return self.mesh.in_space("voxel").bounds

    @property
    def mesh(self) -> Surface:
        assert self.surface is not None
        return self.surface


def _separate(pieces: list[_Piece], context: Context) -> None:
    """Draws those that overlap again until no two do."""
    while not _valid(pieces, context):
        boxes = [piece.box for piece in pieces]
        overlapping = [
            (a, b)
            for (a, p), (b, q) in itertools.combinations(zip(pieces, boxes, strict=True), 2)
            if (p[0] <= q[1]).all() and (q[0] <= p[1]).all() and not _valid([a, b], context)
        ]
        again = {piece for pair in overlapping for piece in pair}
        again = {piece for piece in again if piece.attempt + 1 < len(_TRIES)}
        if not again:
            names = ", ".join(f"{a.label} and {b.label}" for a, b in overlapping)
            raise InvalidData(
                f"labels {names}: their surfaces overlap, however far apart they are drawn"
            )
        for piece in again:
            piece.attempt += 1
            piece.draw()


def _valid(pieces: list[_Piece], context: Context) -> bool:
    """Whether the surfaces together are a valid one."""
    return check_mesh(_merged([piece.mesh for piece in pieces]), context=context).valid


def _merged(meshes: list[Surface]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Their vertices and faces, one after the other."""
    arrays = [arrays_of(mesh) for mesh in meshes]
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in arrays])
    faces = [f.astype(np.int64) + start for (_, f), start in zip(arrays, starts, strict=False)]
    vertices = [v for v, _ in arrays]
    return (
        np.concatenate([np.empty((0, 3)), *vertices]),
        np.concatenate([np.empty((0, 3), np.int64), *faces]),
    )
