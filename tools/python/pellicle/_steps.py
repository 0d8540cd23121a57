"""An image to a surface in steps: `Volume`, `Pyramid`, `Run`."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any, Literal, Unpack

import numpy as np
import numpy.typing as npt

from . import _pellicle
from ._changes import PyramidChanges, RunChanges
from ._context import Context, core_of
from ._errors import InvalidArgument
from ._extras import Extras, ForceFunction, LevelFunction, ProgressFunction, mesh_of
from ._images import (
    Image,
    Order,
    Sliced,
    Vector,
    brick_of,
    brick_reader,
    brick_type,
    frame_of,
    located,
)
from ._meshes import MeshLike
from ._parameters import Parameters, fields_of, told
from ._records import BrickCounts, Progress, PyramidLevel, Range, Space
from ._surface import Surface
from ._values import integer

# The values of plc_amount.
_ONE_ITERATION, _ONE_LEVEL, _ALL_LEVELS = 0, 1, 2


class Volume:
    """An image for pyramids.

    Parameters
    ----------
    image, spacing, origin, direction, order
        As in `extract`.
    copy : bool
        False: the voxels stay in the array where they are of a type of the engine and x is fastest
        in memory (see `borrowed`); they must not change then while the volume, a pyramid or a run
        of it is there. The array itself is kept alive. True: the volume has voxels of its own.
    context : Context, optional
        Also of what is made from the volume, unless told otherwise.

    Raises
    ------
    InvalidData
        For fewer than two voxels along an axis, spacing that is not positive, an origin that is
        not finite, or singular directions.
    """

    def __init__(
        self,
        image: npt.ArrayLike | Image,
        *,
        spacing: Vector = (1, 1, 1),
        origin: Vector = (0, 0, 0),
        direction: npt.ArrayLike | None = None,
        order: Order = "zyx",
        copy: bool = False,
        context: Context | None = None,
    ) -> None:
        voxels, self._frame = located(image, order, spacing, origin, direction)
        self._order = order
        self._core = _pellicle.volume_create(
            core_of(context), voxels, self._frame.core(), not copy
        )
        given = image.values if isinstance(image, Image) else image
        self._borrowed = isinstance(given, np.ndarray) and np.shares_memory(
            given, self._core.voxels(), max_work=1
        )

    @classmethod
    def by_bricks(
        cls,
        array: Sliced,
        *,
        brick: Sequence[int] | None = None,
        cache: int = 0,
        spacing: Vector = (1, 1, 1),
        origin: Vector = (0, 0, 0),
        direction: npt.ArrayLike | None = None,
        order: Order = "zyx",
        context: Context | None = None,
    ) -> Volume:
        """An image that memory does not hold, read slice by slice as it is needed.

        `extract`, `Pyramid` and `Run` give the same bits as of the array as a whole.

        Parameters
        ----------
        array : zarr.Array, h5py.Dataset, numpy.memmap ...
            Whatever has a shape of three axes, a dtype and gives arrays for slices. It is asked in
            any thread, one at a time, and must not change. bool, int8, uint8, int16, uint16 and
            floats; float16 and float64 become float32, int8 becomes int16.
        brick : sequence of int, optional
            Voxels along x, y, z of what is read at once, 16 to 4096. Where it is left out, whole
            chunks of the array, or 64.
        cache : int
            Bytes that bricks may take. 0: half of the context's `memory_limit`, or 1 GiB where
            that is 0.
        spacing, origin, direction, order
            As in `extract`.
        context : Context, optional
            Also of what is made from the volume, unless told otherwise.
        """
        if order not in ("zyx", "xyz"):
            raise ValueError(f"order {order!r}: must be 'zyx' or 'xyz'")
        if len(array.shape) != 3:
            raise ValueError(f"array: must have three axes, not {len(array.shape)}")
        shape = array.shape[::-1] if order == "zyx" else array.shape
        dims = [integer(n, "array") for n in shape]
        sides = brick_of(array, dims, order) if brick is None else brick
        if len(sides) != 3:
            raise ValueError("brick: must be three numbers: x, y, z")
        volume = cls.__new__(cls)
        volume._order = order
        volume._frame = frame_of(spacing, origin, direction)
        volume._borrowed = True
        dtype = brick_type(array.dtype)
        volume._core = _pellicle.volume_create_bricks(
            core_of(context),
            brick_reader(array, order, dtype),
            dtype,
            dims,
            [integer(n, "brick") for n in sides],
            volume._frame.core(),
            integer(cache, "cache"),
        )
        return volume

    @property
    def brick_counts(self) -> BrickCounts:
        """Of a volume by bricks: how many there are, were read, and were read again."""
        return BrickCounts(*self._core.brick_counts())

    @property
    def context(self) -> Context:
        """The one that the volume was made with."""
        return Context._of(self._core.context)

    @property
    def borrowed(self) -> bool:
        """Whether the voxels are those of the array that was given."""
        return self._borrowed

    @property
    def voxels(self) -> npt.NDArray[Any]:
        """The voxels, indexed as the image was, not copied and not writable.

        Raises
        ------
        InvalidArgument
            For a volume by bricks.
        """
        voxels = self._core.voxels()
        return voxels.transpose() if self._order == "zyx" else voxels

    def range(self) -> Range:
        """Smallest and largest voxel.

        Raises
        ------
        InvalidData
            Where some are NaN or infinite.
        """
        return Range(*self._core.range())


class Pyramid:
    """The images of all levels, for any number of runs, in any threads.

    Parameters
    ----------
    volume : Volume
        May go afterwards.
    iso : float, optional
        As in `extract`.
    parameters : Parameters, optional
        Instead of the defaults.
    context : Context, optional
        That of the volume where it is left out.
    **changes
        Fields of `Parameters` by name. Those from `iso` to `reduction` matter here.

    Raises
    ------
    InvalidData
        For voxels that are NaN or infinite, or an image too small for the levels.
    """

    @told()
    def __init__(
        self,
        volume: Volume,
        iso: float | None = None,
        *,
        parameters: Parameters | None = None,
        context: Context | None = None,
        **changes: Unpack[PyramidChanges],
    ) -> None:
        if not isinstance(volume, Volume):
            raise TypeError(f"volume: must be a Volume, not {type(volume).__name__}")
        wanted = chosen(parameters, iso, {**changes})
        core = volume._core.context if context is None else core_of(context)
        self._order = volume._order
        self._frame = volume._frame
        self._core = _pellicle.pyramid_create(core, volume._core, fields_of(wanted))

    @property
    def context(self) -> Context:
        """The one that the pyramid was made with."""
        return Context._of(self._core.context)

    @property
    def parameters(self) -> Parameters:
        """As given, with everything that was derived from the image filled in."""
        return Parameters(**self._core.parameters())

    @property
    def levels(self) -> tuple[PyramidLevel, ...]:
        """The images: `levels[h]` is I_h, so that the full one comes first."""
        return tuple(PyramidLevel(**level) for level in self._core.levels())

    def values(self, level: int) -> npt.NDArray[np.float32]:
        """The image of a level: a new array of values 0 .. 1, indexed as the volume's image."""
        number = integer(level, "level")
        if not 0 <= number < len(self.levels):
            raise InvalidArgument(f"level {number}: the pyramid has 0 .. {len(self.levels) - 1}")
        values = self._core.values(number)
        return values if self._order == "zyx" else values.transpose()


class Run:
    """An evolution in progress: look at it, save it, or stop between any two iterations.

    Exactly `extract`, in as many calls as one likes. A call that a callback has stopped leaves
    the run between two iterations: it can go on.

    Parameters
    ----------
    pyramid : Pyramid
        May go afterwards.
    parameters : Parameters, optional
        Instead of those of the pyramid. What the pyramid does not read may differ.
    space, seeds, mask, mesh, obstacles, obstacle_gap, attachments, pins, extra_force, progress, level
        As in `extract`. The mask is indexed as the volume's image.
    context : Context, optional
        That of the pyramid where it is left out. Give each run its own to use several at the same
        time.
    **changes
        Fields of `Parameters` by name.
    """

    @told()
    def __init__(
        self,
        pyramid: Pyramid,
        *,
        parameters: Parameters | None = None,
        space: Space = "lps",
        seeds: npt.ArrayLike | None = None,
        mask: npt.ArrayLike | None = None,
        mesh: MeshLike | Literal["uniform", "adaptive", "auto"] | None = None,
        obstacles: MeshLike | None = None,
        obstacle_gap: float = 0,
        attachments: npt.ArrayLike | None = None,
        pins: npt.ArrayLike | None = None,
        extra_force: ForceFunction | None = None,
        progress: ProgressFunction | None = None,
        level: LevelFunction | None = None,
        context: Context | None = None,
        _state: bytes | None = None,
        **changes: Unpack[RunChanges],
    ) -> None:
        if not isinstance(pyramid, Pyramid):
            raise TypeError(f"pyramid: must be a Pyramid, not {type(pyramid).__name__}")
        self._frame = pyramid._frame
        fields, start = mesh_of(mesh, {**changes})
        extras = Extras(
            frame=self._frame,
            order=pyramid._order,
            space=space,
            seeds=seeds,
            mask=mask,
            mesh=start,
            obstacles=obstacles,
            obstacle_gap=obstacle_gap,
            attachments=attachments,
            pins=pins,
            extra_force=extra_force,
            progress=progress,
            level=level,
        )
        if parameters is None:
            parameters = pyramid.parameters
        wanted = extras.start(parameters.replace(**fields), fields)
        core = pyramid._core.context if context is None else core_of(context)
        self._space = space
        self._callbacks = extras.callbacks()
        self._core = _pellicle.Run(
            core, pyramid._core, fields_of(wanted), extras.core(), _state
        )
        self._look(self._core.state())

    @classmethod
    def restore(cls, pyramid: Pyramid, state: bytes, **arguments: Any) -> Run:
        """A run that goes on from a saved state, to the bits that the saved one would have had.

        Parameters
        ----------
        pyramid : Pyramid
            Equal to that of the saved run.
        state : bytes
            Of `save`, of this version of the library.
        **arguments
            Those of `Run`, equal to those of the saved run but for callbacks and context.

        Raises
        ------
        InvalidData
            Where the bytes are no state of a run, or of another version, pyramid, parameters or
            extras.
        """
        if not isinstance(state, (bytes, bytearray, memoryview)):
            raise TypeError(f"state: must be bytes, not {type(state).__name__}")
        return cls(pyramid, _state=bytes(state), **arguments)

    @property
    def context(self) -> Context:
        """The one that the run was made with."""
        return Context._of(self._core.context)

    @property
    def done(self) -> bool:
        """Whether the full image has been left, or `level` has said "stop"."""
        return self._done

    @property
    def between_levels(self) -> bool:
        """Whether a level has come to its end: the next call starts the next one."""
        return self._between_levels

    @property
    def progress(self) -> Progress:
        """Of the last iteration, whether the call has ended or was stopped; zeros before the first."""
        return self._progress

    def iterate(self, count: int = 1) -> bool:
        """Goes on for some iterations.

        Returns
        -------
        bool
            `done`.
        """
        for _ in range(integer(count, "count")):
            if self._advance(_ONE_ITERATION):
                break
        return self._done

    def next_level(self) -> bool:
        """Goes on to the end of the level; returns `done`."""
        return self._advance(_ONE_LEVEL)

    def finish(self) -> Surface:
        """Goes on to the end.

        Returns
        -------
        Surface
            What `extract` gives.
        """
        self._advance(_ALL_LEVELS)
        return self.surface()

    def surface(self) -> Surface:
        """The surface as it is now, a copy: valid after every iteration."""
        return Surface._of(self._core.surface(), self._space, self._frame)

    def save(self) -> bytes:
        """The state between two iterations, for `restore`: without image and callbacks."""
        return self._core.save()

    def _advance(self, amount: int) -> bool:
        try:
            state = self._core.advance(amount, *self._callbacks)
        except BaseException:
            with suppress(ValueError):  # of a run that has failed, or is in the middle of a call
                self._look(self._core.state())
            raise
        self._look(state)
        return self._done

    def _look(self, state: dict[str, Any]) -> None:
        self._done: bool = state["done"]
        self._between_levels: bool = state["between_levels"]
        self._progress = Progress(**state["progress"])


def chosen(
    parameters: Parameters | None, iso: float | None, changes: dict[str, Any]
) -> Parameters:
    """The parameters of a call."""
    if parameters is None:
        parameters = Parameters()
    elif not isinstance(parameters, Parameters):
        raise TypeError(f"parameters: must be Parameters, not {type(parameters).__name__}")
    if iso is not None:
        changes = {**changes, "iso": iso}
    return parameters.replace(**changes)
