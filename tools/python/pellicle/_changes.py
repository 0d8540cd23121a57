"""The parameters as keyword arguments, for type checkers and editors.

A misspelt name is an error of mypy (from 1.7 on; before, --enable-incomplete-feature=Unpack) and of
pyright. The fields are those of `Parameters`; a test compares them.
"""

from __future__ import annotations

from typing import Literal, TypedDict


class CommonChanges(TypedDict, total=False):
    """Fields that every function has, and no argument is named as."""

    inside_below: bool
    level_iso: tuple[float, ...] | None
    window_low: float | None
    window_high: float | None
    pad_value: float | None
    feature: Literal["none", "gradient_norm"]
    feature_sigma: float
    levels: int | None
    reduction: float
    init: Literal["bubble", "bubbles", "seeds", "iso", "mask", "mesh", "auto"]
    bubbles: tuple[int, int, int]
    edge: float
    tolerance: float
    edge_min: float
    edge_max: float
    curvature: float
    spring: float
    rest_length: Literal["zero", "mean", "value"]
    rest_length_value: float
    force: Literal["iso", "gradient", "both"]
    attraction: float
    gradient: float
    gradient_tangent: float
    gradient_bound: float
    mass: float
    damping: float
    time_step: float
    max_move: float
    bound: Literal["clamp", "scale"]
    anisotropy: Literal["physical", "voxel", "metric"]
    epsilon: float
    calm_speed: float
    max_iterations: int
    late_bubbles: bool
    sleeping: bool


class PyramidChanges(CommonChanges, total=False):
    """Of a function that takes `iso` apart."""

    mesh: Literal["uniform", "adaptive", "auto"]


class RunChanges(CommonChanges, total=False):
    """Of a function that takes a mesh to start from as `mesh`."""

    iso: float | None


class Changes(RunChanges, total=False):
    """All fields."""

    mesh: Literal["uniform", "adaptive", "auto"]

