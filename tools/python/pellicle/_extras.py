"""Starts, places and callbacks of an extraction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._images import Frame, Order, voxels_of
from ._meshes import MeshLike, arrays_of
from ._parameters import Parameters
from ._records import ForcePoints, LevelReport, Progress, Space, Verdict
from ._surface import Surface, checked_space
from ._values import plain_array, real_array

ProgressFunction = Callable[[Progress], object]
LevelFunction = Callable[[LevelReport, Surface], Verdict | None]
ForceFunction = Callable[[ForcePoints], npt.ArrayLike | None]

# The values of plc_verdict.
_VERDICTS = {word: value for value, word in enumerate(get_args(Verdict))}


@dataclass(frozen=True, kw_only=True)
class Extras:
    """What `extract` and `Run` take beside images and parameters, as it was given."""

    frame: Frame
    order: Order
    space: Space = "lps"
    seeds: npt.ArrayLike | None = None
    mask: npt.ArrayLike | None = None
    mesh: MeshLike | None = None
    obstacles: MeshLike | None = None
    obstacle_gap: float = 0
    attachments: npt.ArrayLike | None = None
    pins: npt.ArrayLike | None = None
    extra_force: ForceFunction | None = None
    progress: ProgressFunction | None = None
    level: LevelFunction | None = None

    def core(self) -> _pellicle.Extras:
        """For the engine."""
        progress, level, force = self.callbacks()
        return _pellicle.Extras(
            space=checked_space(self.space),
            seeds=_rows(self.seeds, "seeds", 4),
            attachments=_attachments(self.attachments),
            pins=_rows(self.pins, "pins", 4),
            mask=None if self.mask is None else voxels_of(self.mask, self.order, "mask"),
            mesh=self._arrays(self.mesh, "mesh"),
            obstacles=self._arrays(self.obstacles, "obstacles"),
            obstacle_gap=float(self.obstacle_gap),
            progress=progress,
            level=level,
            force=force,
        )

    def _arrays(self, mesh: MeshLike | None, name: str) -> _pellicle.Mesh | None:
        if mesh is None:
            return None
        return arrays_of(mesh.in_space(self.space) if isinstance(mesh, Surface) else mesh, name)

    def callbacks(self) -> _pellicle.Callbacks:
        """The user's, for the engine's records."""
        return (
            None if self.progress is None else _progress(self.progress),
            None if self.level is None else _level(self.level, self.space, self.frame),
            None if self.extra_force is None else _force(self.extra_force),
        )

    def start(self, parameters: Parameters, given: dict[str, Any]) -> Parameters:
        """The parameters with the start that is implied.

        given: the parameters that the caller has named.
        """
        starts = [name for name in ("seeds", "mask", "mesh") if getattr(self, name) is not None]
        implied = starts or [name for name in ("bubbles",) if name in given]
        if "init" not in given and parameters.init == Parameters.init and len(implied) == 1:
            parameters = parameters.replace(init=implied[0])  # type: ignore[arg-type]
        drawn = self.attachments is not None or self.pins is not None
        if drawn and parameters.init == "auto":
            parameters = parameters.replace(init="bubble")
        for name in starts:
            if parameters.init != name:
                raise ValueError(f"{name} are for init={name!r}, not for {parameters.init!r}")
        return parameters


def mesh_of(
    mesh: MeshLike | str | None, fields: dict[str, Any]
) -> tuple[dict[str, Any], MeshLike | None]:
    """Parameters and start of an argument `mesh`, which may be the parameter or the start."""
    if isinstance(mesh, str):
        return {**fields, "mesh": mesh}, None
    return fields, mesh


def _rows(values: npt.ArrayLike | None, name: str, columns: int) -> _pellicle.Rows | None:
    if values is None:
        return None
    rows = np.ascontiguousarray(real_array(values, name))
    if rows.size == 0:
        return None
    if rows.ndim == 1:
        rows = rows[np.newaxis]
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ValueError(f"{name}: must be rows of {columns} numbers, not of shape {rows.shape}")
    return rows


def _attachments(values: npt.ArrayLike | None) -> _pellicle.Rows | None:
    """Rows of x, y, z, radius, strength; the strength is 1 where it is left out."""
    if values is None:
        return None
    rows = np.atleast_2d(real_array(values, "attachments"))
    if rows.ndim == 2 and rows.shape[1] == 4:
        rows = np.hstack([rows, np.ones((len(rows), 1))])
    return _rows(rows, "attachments", 5)


def _callable(function: object, name: str) -> None:
    if not callable(function):
        hint = ": the number of levels is levels=" if name == "level" else ""
        raise TypeError(f"{name}: must be callable, not {type(function).__name__}{hint}")


def _progress(function: ProgressFunction) -> Callable[[dict[str, Any]], None]:
    _callable(function, "progress")

    def call(fields: dict[str, Any]) -> None:
        function(Progress(**fields))

    return call


def _level(
    function: LevelFunction, space: Space, frame: Frame
) -> Callable[[dict[str, Any], _pellicle.Surface], int]:
    _callable(function, "level")

    def call(fields: dict[str, Any], surface: _pellicle.Surface) -> int:
        answer = function(LevelReport(**fields), Surface._of(surface, space, frame))
        verdict = _VERDICTS.get(answer if answer is not None else "accept")
        if verdict is None:
            raise ValueError(
                f"level: must return 'accept', 'more', 'stop' or None, not {answer!r}"
            )
        return verdict

    return call


def _force(
    function: ForceFunction,
) -> Callable[[int, _pellicle.Positions, _pellicle.Positions], _pellicle.Positions | None]:
    _callable(function, "extra_force")

    def call(
        level: int, positions: _pellicle.Positions, normals: _pellicle.Positions
    ) -> _pellicle.Positions | None:
        shape = positions.shape
        answer = function(ForcePoints(level, positions, normals))
        if answer is None:
            return None
        forces = plain_array(answer, "extra_force").astype(np.float32, copy=False)
        if forces.shape not in (shape, (3,)):
            raise ValueError(
                f"extra_force: must return an array of shape {shape}, not {forces.shape}"
            )
        return np.ascontiguousarray(np.broadcast_to(forces, shape))

    return call
