"""One surface of one very large image, by the workers of a Dask cluster.

The command `pellicle`, which must be installed where the workers are, cuts the image into blocks and
does each as a task (`pellicle blocks`). Here the tasks are handed to workers, step by step.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, Unpack

from . import _block_worker as worker
from ._block_worker import Processes
from ._changes import CommonChanges
from ._errors import InvalidArgument, PellicleError
from ._mesh_files import parsed_ply
from ._parameters import Parameters, told
from ._records import Space
from ._surface import Surface, checked_space

ProgressFunction = Callable[[int, int, float | None], object]

# Parameters by the names of the command's options, where these are the same but for "_".
_PLAIN = (
    "level_iso levels reduction anisotropy mesh edge tolerance curvature spring attraction mass damping "
    "time_step max_move bound epsilon calm_speed max_iterations"
).split()
_OTHERS = (
    "inside_below window_low window_high pad_value edge_min edge_max rest_length rest_length_value "
    "late_bubbles sleeping"
).split()
_NOT_BY_BLOCKS = tuple(
    name for name in Parameters.__annotations__ if name not in (*_PLAIN, *_OTHERS, "iso")
)


@told(without=_NOT_BY_BLOCKS)
def extract(
    image: str | os.PathLike[str],
    client: Any,
    folder: str | os.PathLike[str],
    iso: float | str | None = None,
    *,
    side: int = 512,
    from_level: int = 1,
    space: Space = "lps",
    collect: bool = True,
    progress: ProgressFunction | None = None,
    command: str = "pellicle",
    threads: int = 1,
    memory: int | str | None = None,
    retries: int = 3,
    **changes: Unpack[CommonChanges],
) -> Surface | Path:
    """Extracts one surface of an image that is too large for one machine, or for patience.

    The coarse levels are done by one worker; then all blocks of a step at a time, each by any
    worker, a step after the other. The result has the same bits as that of ``pellicle blocks`` by
    any other scheduler. What is done stays in the folder: workers that are killed cost the tasks
    that they were at, and a call that was stopped goes on when it is made again.

    Parameters
    ----------
    image : str or path
        OME-Zarr, NIfTI, NRRD or MetaImage that is not packed: a path that all workers see.
    client : dask.distributed.Client or str
        Or the address of a scheduler. The package must be installed where the workers are.
    folder : str or path
        Where the plan and the blocks are written: a path that all workers see.
    iso : float or str
        The value of the surface, in the image's units; or "otsu", or a percentile such as "p95".
    side : int
        Voxels of a block on each axis.
    from_level : int
        The coarsest level that is done by blocks; those above it are done by one worker.
    space : {"lps", "ras", "voxel"}
        Of the result.
    collect : bool
        False: the result is the folder, as the surface may be too large for this process;
        ``pellicle blocks mesh`` writes it as a mesh.
    progress : callable, optional
        ``progress(done, total, seconds_left)`` of tasks, after each; the seconds are None where
        nothing was measured. What it raises ends the call.
    command : str
        The command, where the workers do not find it on their PATH.
    threads : int
        Of each task. Workers do as many tasks at a time as they have threads themselves.
    memory : int or str, optional
        Of each task, bytes or as in "4G". By default a worker divides what Dask lets it have among
        its threads.
    retries : int
        How often a task is tried again that has failed.
    **changes
        Fields of `Parameters` by name, but for those of starts, features and gradients.

    Returns
    -------
    Surface
        Or a path, with ``collect=False``.

    Raises
    ------
    InvalidArgument, ValueError, TypeError
        Where the image or a parameter is not what can be done by blocks.
    PellicleError
        Where a task fails as often as it is tried, or ends the workers that try it.
    ImportError
        Without dask.distributed.

    Examples
    --------
    >>> from dask.distributed import Client                             # doctest: +SKIP
    >>> surface = pellicle.distributed.extract(                         # doctest: +SKIP
    ...     "/data/head.ome.zarr", Client("tcp://head:8786"), "/scratch/head", 226)
    """
    try:
        dask = import_module("distributed")
    except ImportError:
        raise ImportError(
            "pellicle.distributed needs dask.distributed, as of Debian's python3-distributed"
        ) from None
    checked_space(space)
    words = [
        f"--side={int(side)}",
        f"--from-level={int(from_level)}",
        *_options(iso, {**changes}),
    ]
    if isinstance(client, str):
        with dask.Client(client) as own:
            return _Extraction(dask, own, folder, command, threads, memory, retries, progress).run(
                image, words, space if collect else None
            )
    if getattr(client, "asynchronous", False):
        raise ValueError("client: must not be asynchronous")
    return _Extraction(dask, client, folder, command, threads, memory, retries, progress).run(
        image, words, space if collect else None
    )


def _options(iso: float | str | None, changes: dict[str, Any]) -> list[str]:
    """Of ``pellicle blocks plan``."""
    Parameters().replace(**changes)  # refuses what is no parameter
    for name in changes:
        if name in _NOT_BY_BLOCKS:
            raise ValueError(f"{name}: cannot be told of an image by blocks")
    if iso is None:
        raise InvalidArgument("iso: must be given for an image by blocks")
    words = [f"--iso={_text(iso)}"]
    for name in _PLAIN:
        if changes.get(name) is not None:
            words.append(f"--{name.replace('_', '-')}={_text(changes[name])}")
    if changes.get("inside_below"):
        words.append("--inside=below")
    window = [changes.get("window_low"), changes.get("window_high")]
    if window != [None, None]:
        if None in window:
            raise ValueError("window_low, window_high: must both be given for an image by blocks")
        words.append(f"--window={_text(window)}")
    edges = [changes.get("edge_min"), changes.get("edge_max")]
    if edges != [None, None]:
        if None in edges:
            raise ValueError("edge_min, edge_max: must both be given for an image by blocks")
        words.append(f"--edge-range={_text(edges)}")
    if changes.get("pad_value") is not None:
        words.append(f"--pad={_text(changes['pad_value'])}")
    if "rest_length" in changes:
        rest = changes["rest_length"]
        if rest == "value":
            rest = changes.get("rest_length_value", 0)
        words.append(f"--rest-length={_text(rest)}")
    words += [
        f"--no-{name.replace('_', '-')}"
        for name in ("late_bubbles", "sleeping")
        if not changes.get(name, True)
    ]
    return words


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, (tuple, list)):
        return ",".join(_text(one) for one in value)
    return repr(int(value) if float(value).is_integer() else float(value))


class _Extraction:
    """A call of `extract`."""

    def __init__(
        self,
        dask: Any,
        client: Any,
        folder: str | os.PathLike[str],
        command: str,
        threads: int,
        memory: int | str | None,
        retries: int,
        progress: ProgressFunction | None,
    ) -> None:
        self._dask = dask
        self._client = client
        self._folder = os.path.abspath(folder)
        self._processes = Processes(command, self._folder, int(threads), memory)
        self._retries = int(retries)
        self._progress = progress

    def run(
        self, image: str | os.PathLike[str], words: list[str], space: Space | None
    ) -> Surface | Path:
        """`space`: of the surface; None: it is not collected."""
        self._alone(worker.plan, os.path.abspath(image), words)
        self._estimate = _Estimate(json.loads(self._alone(worker.status)))
        self._tell()
        try:
            for step in self._estimate.steps:
                self._do(step)
        finally:
            try:
                self._client.run(worker.end, self._processes)
            except (OSError, RuntimeError):  # workers that are gone have none
                pass
        if space is None:
            return Path(self._folder)
        data, frame = self._alone(worker.mesh)
        vertices, faces = parsed_ply(data)
        return Surface.from_mesh(vertices, faces, space="voxel", **frame).in_space(space)

    def _alone(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """One call, on any worker."""
        return self._result(
            self._client.submit(function, self._processes, *arguments, pure=False),
            function.__name__,
        )

    def _do(self, step: dict[str, Any]) -> None:
        """All tasks of a step."""
        futures = self._client.map(
            worker.task,
            step["blocks_left"],
            processes=self._processes,
            step=step["step"],
            pure=False,
            retries=self._retries,
        )
        try:
            for future in self._dask.as_completed(futures):
                record = self._result(future, f"step {step['step']}")
                self._estimate.add(step, record["seconds"])
                self._tell()
        except BaseException:
            self._client.cancel(futures)
            raise

    def _result(self, future: Any, what: str) -> Any:
        try:
            return future.result()
        except self._dask.scheduler.KilledWorker as error:
            raise PellicleError(
                f"{what}: has ended the workers that it ran on, as for lack of memory: {error.task}"
            ) from None

    def _tell(self) -> None:
        if self._progress is not None:
            self._progress(self._estimate.done, self._estimate.total, self._estimate.seconds_left())


class _Estimate:
    """What is done, and when the rest is. As that of ``pellicle blocks status``."""

    def __init__(self, status: dict[str, Any]) -> None:
        self.steps: list[dict[str, Any]] = [s for s in status["steps"] if s["blocks_left"]]
        self.done: int = status["done"]
        self.total: int = status["tasks"]
        self._left = {step["step"]: len(step["blocks_left"]) for step in self.steps}
        levels = status["levels"]
        self._seconds: dict[int, float] = {one["level"]: one["seconds"] for one in levels}
        self._count: dict[int, int] = {one["level"]: one["recorded"] for one in levels}
        self._begin = time.monotonic()
        self._busy = 0.0

    def add(self, step: dict[str, Any], seconds: float) -> None:
        """A task that has ended."""
        self.done += 1
        self._left[step["step"]] -= 1
        self._seconds[step["level"]] += seconds
        self._count[step["level"]] += 1
        self._busy += seconds

    def _task_seconds(self, level: int) -> float | None:
        """On the level, or by the nearest one that was measured: a finer one has about four times
        the vertices."""
        measured = [other for other, count in self._count.items() if count > 0]
        if not measured:
            return None
        nearest = min(measured, key=lambda other: abs(other - level))
        return self._seconds[nearest] / self._count[nearest] * float(4 ** (nearest - level))

    def seconds_left(self) -> float | None:
        """None: nothing was measured."""
        elapsed = max(time.monotonic() - self._begin, 1e-3)
        pace = self._busy / elapsed if self._busy > 0 else 1
        seconds = 0.0
        for step in self.steps:
            left = self._left[step["step"]]
            one = self._task_seconds(step["level"])
            if one is None:
                return None
            if left > 0:
                seconds += max(one, left * one / pace)
        return seconds
