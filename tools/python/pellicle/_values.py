"""What callers give, as plain numbers: what would lose a part of it is refused."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
import numpy.typing as npt


def plain_array(values: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    """An array without a mask and without imaginary parts."""
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        raise ValueError(f"{name}: has masked elements; say what they are: .filled(value)")
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise TypeError(f"{name}: must be real numbers, not {array.dtype}")
    return array


def real_array(values: npt.ArrayLike, name: str) -> npt.NDArray[np.float64]:
    """Of float64."""
    array = plain_array(values, name)
    try:
        return array.astype(np.float64, copy=False)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be numbers, not {array.dtype}") from None


def integer(value: object, name: str) -> int:
    """Of 64 bits."""
    try:
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name}: must be an integer, not {type(value).__name__}") from None
    if not -(2**63) <= number < 2**63:
        raise ValueError(f"{name}: {number} is out of range")
    return number
