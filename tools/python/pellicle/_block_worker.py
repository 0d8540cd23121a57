"""What workers of `pellicle.distributed` do: they run the command `pellicle blocks`.

A process ``pellicle blocks run --serve`` does many tasks, one after the other: it keeps the image
open, and the pyramid and the bricks that it has read. A worker has one for each of its threads. Such a
process ends with the worker, as its stdin does then.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
import threading
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import IO, Any

from ._errors import InvalidArgument, PellicleError

_lock = threading.Lock()


@dataclass(frozen=True)
class Processes:
    """Which processes a call is served by."""

    command: str
    folder: str
    threads: int
    memory: int | str | None


class _Server:
    """A process that does the tasks it is told."""

    def __init__(self, processes: Processes, memory: int | str | None) -> None:
        words = [
            processes.command,
            "blocks",
            "run",
            processes.folder,
            "--serve",
            f"--threads={processes.threads}",
            *_memory_option(memory),
        ]
        self._errors: IO[str] = tempfile.TemporaryFile("w+")
        self._process = _started(
            words,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )

    def task(self, step: int, block: int) -> dict[str, Any]:
        """Its record."""
        assert self._process.stdin is not None and self._process.stdout is not None
        answer = ""
        try:
            self._process.stdin.write(f"{step} {block}\n")
            self._process.stdin.flush()
            answer = self._process.stdout.readline()
        except BrokenPipeError:
            pass
        if not answer:
            code = self._process.wait()
            self._errors.seek(0)
            raise PellicleError(_line_of(self._errors.read(), code))
        record: dict[str, Any] = json.loads(answer)
        if "error" in record:
            raise PellicleError(record["error"])
        return record

    def end(self) -> None:
        self._process.kill()
        self._process.wait()
        for file in (self._process.stdin, self._process.stdout, self._errors):
            try:
                if file is not None:
                    file.close()
            except BrokenPipeError:  # of a line that nobody has read
                pass


_idle: dict[Processes, list[_Server]] = {}


def task(block: int, processes: Processes, step: int) -> dict[str, Any]:
    """Does a task; its record."""
    with _lock:
        servers = _idle.get(processes)
        server = servers.pop() if servers else None
    if server is None:
        server = _Server(processes, processes.memory or _memory_of_worker(True))
    try:
        record = server.task(step, block)
    except BaseException:
        server.end()
        raise
    with _lock:
        _idle.setdefault(processes, []).append(server)
    return record


def end(processes: Processes) -> None:
    """Nothing more is done for the call."""
    with _lock:
        servers = _idle.pop(processes, [])
    for server in servers:
        server.end()


def plan(processes: Processes, image: str, words: list[str]) -> None:
    """The coarse levels."""
    memory = processes.memory or _memory_of_worker(False)
    threads = max(processes.threads, _worker().state.nthreads)
    _run(
        processes,
        "plan",
        image,
        f"--output={processes.folder}",
        "--quiet",
        f"--threads={threads}",
        *_memory_option(memory),
        *words,
    )


def status(processes: Processes) -> str:
    """As JSON."""
    return _run(processes, "status", processes.folder, "--json")


def mesh(processes: Processes) -> tuple[bytes, dict[str, Any]]:
    """The surface in voxel indices as a file .ply, and spacing, origin and direction."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "surface.ply"
        _run(processes, "mesh", processes.folder, f"--output={path}", "--space=voxel")
        data = path.read_bytes()
    image = json.loads((Path(processes.folder) / "plan.json").read_text())["image"]
    return data, {name: image[name] for name in ("spacing", "origin", "direction")}


def _run(processes: Processes, *words: str) -> str:
    """stdout of a command that is to end by itself: status does so with 1 where tasks are left."""
    process = _started(
        [processes.command, "blocks", *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    output, errors = process.communicate()
    if process.returncode not in (0, 1):
        kind = PellicleError if process.returncode < 0 else InvalidArgument
        raise kind(_line_of(errors, process.returncode))
    return str(output)


def _started(words: list[str], **options: Any) -> subprocess.Popen[str]:
    try:
        return subprocess.Popen(words, **options)
    except OSError as error:
        raise PellicleError(
            f"{words[0]}: the command cannot be run by a worker ({error.strerror}); command= tells "
            "where it is"
        ) from None


def _line_of(errors: str, code: int) -> str:
    """What a process has said last."""
    lines = errors.strip().splitlines()
    if code < 0:
        return f"pellicle blocks: was ended by signal {-code}"
    return lines[-1].removeprefix("pellicle: ") if lines else f"pellicle blocks: ended with {code}"


def _memory_option(memory: int | str | None) -> list[str]:
    return [] if memory is None else [f"--memory={memory}"]


def _worker() -> Any:
    return import_module("distributed").get_worker()


def _memory_of_worker(of_thread: bool) -> int | None:
    """What Dask lets the worker have, beside what Python needs; None: no limit is known."""
    own = _worker()
    limit = getattr(getattr(own, "memory_manager", None), "memory_limit", None)
    if not limit:
        return None
    python = 200 * 2**20
    left = max(int(limit) - python, int(limit) // 2)
    return left // own.state.nthreads if of_thread else left
