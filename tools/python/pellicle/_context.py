"""Contexts."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Literal

from . import _pellicle
from ._records import Memory, Simd
from ._values import integer

LogLevel = Literal["warning", "info"]
LogFunction = Callable[[LogLevel, str], object]

_LEVELS: dict[int, tuple[LogLevel, int]] = {
    1: ("warning", logging.WARNING),
    2: ("info", logging.INFO),
}
_logger = logging.getLogger("pellicle")


class Context:
    """The threads, the SIMD target and the memory of calls into the engine.

    A context runs one call at a time: threads that call at the same time wait for each other.
    To compute in several threads at the same time give each its own context. Every function that
    takes ``context=None`` makes one of its own.

    Parameters
    ----------
    threads : int
        At most so many, 1 .. 1024. 0: one per core.
    simd : {"auto", "scalar", "sse4", "avx2", "avx512", "neon"}
        "auto": the best of this machine. Results are the same bits with all.
    memory_limit : int
        Bytes at a time beyond which a call raises `OutOfMemory`. 0: none.
    log : callable, optional
        ``log(level, line)``, level "warning" or "info". Without it lines go to the logger
        "pellicle" of the standard library's `logging`.

    Raises
    ------
    InvalidArgument
        Where a number is out of its range, or this machine does not have the SIMD target.
    """

    def __init__(
        self,
        threads: int = 0,
        simd: Simd = "auto",
        memory_limit: int = 0,
        log: LogFunction | None = None,
    ) -> None:
        if log is not None and not callable(log):
            raise TypeError("log: must be callable")

        if not isinstance(simd, str):
            raise TypeError(f"simd: must be a str, not {type(simd).__name__}")
        numbers = {"threads": threads, "memory_limit": memory_limit}
        for name, number in numbers.items():
            numbers[name] = integer(number, name)
        if not -(2**31) <= numbers["threads"] < 2**31:
            raise ValueError(f"threads: {threads} is out of range")

        def emit(level: int, line: str) -> None:
            word, number = _LEVELS[level]
            if log is not None:
                log(word, line)
            else:
                _logger.log(number, "%s", line)

        self._core = _pellicle.Context(numbers["threads"], simd, numbers["memory_limit"], emit)

    @classmethod
    def _of(cls, core: _pellicle.Context) -> Context:
        context = cls.__new__(cls)
        context._core = core
        return context

    @property
    def threads(self) -> int:
        """The number of threads that loops may run on."""
        return self._core.threads

    @property
    def simd(self) -> str:
        """The SIMD target in use."""
        return self._core.simd

    @property
    def memory(self) -> Memory:
        """Bytes that the context and all that was made with it have now, and at most had."""
        return Memory(*self._core.memory())

    def __repr__(self) -> str:
        return f"Context(threads={self.threads}, simd={self.simd!r})"


def core_of(context: Context | None) -> _pellicle.Context:
    """The context's, or that of a new one."""
    if context is None:
        context = Context()
    if not isinstance(context, Context):
        raise TypeError(f"context: must be a Context, not {type(context).__name__}")
    return context._core
