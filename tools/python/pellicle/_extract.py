"""An image to a surface in one call."""

from __future__ import annotations

from typing import Any, Literal, Unpack

import numpy.typing as npt

from . import _pellicle
from ._changes import CommonChanges
from ._context import Context, core_of
from ._extras import Extras, ForceFunction, LevelFunction, ProgressFunction, mesh_of
from ._images import Image, Order, Vector, frame_of, located
from ._meshes import MeshLike
from ._parameters import Parameters, fields_of, told
from ._records import Space
from ._steps import Volume, chosen
from ._surface import Surface


@told()
def extract(
    image: npt.ArrayLike | Image | Volume,
    iso: float | None = None,
    *,
    spacing: Vector = (1, 1, 1),
    origin: Vector = (0, 0, 0),
    direction: npt.ArrayLike | None = None,
    order: Order = "zyx",
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
    parameters: Parameters | None = None,
    **changes: Unpack[CommonChanges],
) -> Surface:
    """Extracts a closed, oriented surface without self-intersections from a 3D image.

    Other Python threads run meanwhile. Ctrl-C stops it.

    Parameters
    ----------
    image : array_like or Image
        An `Image` of `read`, which tells its geometry; or an array. Three axes, no masked elements. uint8, int16, uint16, int32 and float32 are taken as they are, without a copy
        where x is fastest in memory; bool, int8, uint32, int64, uint64 and float16 are converted
        where no value changes, else refused; float64 is rounded to float32. It must not change
        during the call. Or a `Volume`, as one by bricks, which tells its order and geometry.
    iso : float, optional
        The value of the surface, in the image's units. Needed unless ``force="gradient"``.
    spacing : sequence of float
        mm between voxel centres along x, y, z, whatever the order of the array's axes.
    origin : sequence of float
        LPS position of the centre of voxel (0, 0, 0), mm.
    direction : array_like, optional
        3 x 3, columns are the unit axes x, y, z of the image in LPS, as in ITK; or its nine
        numbers row by row. The identity where it is left out.
    order : {"zyx", "xyz"}
        How the array is indexed: image[z, y, x], as SimpleITK's GetArrayFromImage and scikit-image,
        or image[x, y, z], as nibabel. Strides may be any.
    space : {"lps", "ras", "voxel"}
        Of all places below and of the result. Places are x, y, z, whatever the order.
    seeds : array_like, optional
        Rows of x, y, z, radius (mm): spheres to start from, apart from each other, their centres
        in the image.
    mask : array_like, optional
        An array of the image's shape and order; the start is the surface of where it is not 0.
    mesh : Surface or (vertices, faces), optional
        Closed, oriented and free of self-intersections, to start from. "uniform", "adaptive"
        and "auto" are the parameter of that name: how fine the surface is.
    obstacles : Surface or (vertices, faces), optional
        Faces that never move, and that the surface neither meets nor passes over; it starts apart
        from them, with ``levels=0`` and ``late_bubbles=False``.
    obstacle_gap : float
        How near to them it may come, in units of delta, 0 to 1.
    attachments : array_like, optional
        Rows of x, y, z, radius[, strength]: places in the image that draw the surface near them until it goes
        through them. The strength is relative to `attraction`, 1 where it is left out.
    pins : array_like, optional
        Rows of x, y, z, radius: balls about places in the image in which no force moves a vertex.
    extra_force : callable, optional
        ``extra_force(points: ForcePoints)`` returns an (n, 3) array of forces in the space, or
        None. 1 is the pull of `iso` with attraction 1 on a vertex whose value is a whole window
        away from it. Called four times per iteration.
    progress : callable, optional
        ``progress(p: Progress)`` after every iteration, and now and then before the first, which
        is then iteration 0. What it returns is not looked at; to stop,
        it raises: `Cancelled`, or any other exception, which then comes out of this call.
    level : callable, optional
        ``level(report: LevelReport, surface: Surface)`` at the end of every level that holds a
        surface returns "accept" or None (on to the next one), "more" (up to `max_iterations` more)
        or "stop" (this is the result). The surface is there during the call only.
    context : Context, optional
        Threads, SIMD target, memory limit, log. One for this call where it is left out. Callbacks
        may not use it, but for the surface that `level` gets.
    parameters : Parameters, optional
        Instead of the defaults.
    **changes
        Fields of `Parameters` by name.

    Returns
    -------
    Surface

    Raises
    ------
    InvalidArgument, ValueError, TypeError
        Where a parameter is outside its range, of the wrong kind, or unknown.
    InvalidData
        Where the image, mask or mesh cannot be used.
    OutOfMemory
    KeyboardInterrupt
        And whatever callbacks raise.

    Examples
    --------
    >>> import numpy as np
    >>> import pellicle
    >>> z, y, x = np.mgrid[:40, :40, :40] - 19.5
    >>> ball = np.clip(0.5 + 12 - np.sqrt(x * x + y * y + z * z), 0, 1)
    >>> surface = pellicle.extract(ball, 0.5)
    >>> surface.check().valid, surface.measures().genus
    (True, 0)
    """
    fields, start = mesh_of(mesh, {**changes})
    if isinstance(image, Volume):
        if (order, frame_of(spacing, origin, direction)) != ("zyx", frame_of((1, 1, 1), (0, 0, 0), None)):
            raise TypeError("a Volume tells its order and geometry")
        frame, order = image._frame, image._order
    else:
        voxels, frame = located(image, order, spacing, origin, direction)
    extras = Extras(
        frame=frame,
        order=order,
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
    given: dict[str, Any] = {**fields, "iso": iso} if iso is not None else fields
    wanted = extras.start(chosen(parameters, iso, fields), given)
    if isinstance(image, Volume):
        owner = image._core.context if context is None else core_of(context)
        core = _pellicle.extract_volume(owner, image._core, fields_of(wanted), extras.core())
    else:
        core = _pellicle.extract(
            core_of(context), voxels, frame.core(), fields_of(wanted), extras.core()
        )
    return Surface._of(core, space, frame)
