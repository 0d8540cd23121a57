"""The parameters of an extraction."""

from __future__ import annotations

import dataclasses
import difflib
import inspect
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, Unpack

from . import _pellicle
from ._changes import Changes

T = TypeVar("T", bound=Callable[..., Any])

# The only place of the defaults is the engine.
_D: dict[str, Any] = _pellicle.parameter_defaults()


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """What to extract, from what start, and how the surface moves.

    Every function that takes `**parameters` takes the fields below by name. Defaults are those of
    the engine; numbers in parentheses are equations and sections of Lachaud & Montanvert, 1999.

    Parameters
    ----------
    iso : float or None
        The value of the surface, in the image's units, within its range. None: not set, for
        ``force="gradient"``.
    inside_below : bool
        False: the object is where the image is >= iso; True: where it is <= iso.
    level_iso : sequence of float or None
        The value for each level, coarse to fine: the full image last, one more than `levels`.
        None: derived. Since 0.3; before, the full image came first.
    window_low, window_high : float or None
        Image values mapped to 0 and 1. None: derived.
    pad_value : float or None
        What surrounds the image, not on the object's side of iso. None: the outside end of the window.
    feature : {"none", "gradient_norm"}
        What the evolution takes for the image: itself, or the norm of its gradient per mm.
    feature_sigma : float
        Of the Gaussian before the gradient, mm; 0: none.
    levels : int or None
        Levels above the full image. 0: direct. None: as `init` has it, else 3, or fewer when the
        image is small.
    reduction : float
        Of the size from level to level, 1 < reduction <= 2.
    init : {"bubble", "bubbles", "seeds", "iso", "mask", "mesh", "auto"}
        What the surface starts from (3.6). `seeds=`, `mask=`, `mesh=` and `bubbles=` imply theirs
        where `init` is not given. auto: the iso-surface of the full image, with 0 levels, for an
        adaptive mesh where noise is not too much for that, without attachments and pins; else
        a bubble.
    bubbles : tuple of int
        How many bubbles along x, y, z, each 1 .. 256.
    mesh : {"uniform", "adaptive", "auto"}
        Edges of one length, the voxels' (3.2), or by how much the image's iso-surface bends; auto:
        adaptive where `force` is "iso", without `spring` and `edge`, but uniform for labels and
        blocks.
    edge : float
        Of a uniform mesh: about the mean of its edges, mm, from a quarter of a voxel to a tenth of
        the image; 0: 1.25 voxels.
    tolerance : float
        Of an adaptive mesh: the mean distance of its facets from that surface, mm; 0: 1/24 of a
        voxel.
    edge_min, edge_max : float
        Of an adaptive mesh: its mean edges lie between, mm; 0: 0.625 and 5 voxels.
    curvature : float
        alpha_c (5), smoothing, >= 0.
    spring : float
        alpha_e (6), >= 0.
    rest_length : {"zero", "mean", "value"}
        Of the springs: minimise the area, even out edges, or `rest_length_value`.
    rest_length_value : float
        In units of delta, >= 0.
    force : {"iso", "gradient", "both"}
        Which forces of the image act (3.8).
    attraction : float
        Of the value iso (7), > 0.
    gradient, gradient_tangent : float
        Of the gradient (8), along the normal (< 0: away from bright) and the tangent plane.
    gradient_bound : float
        The gradient, in window per U_h, at which (8) is 1; > 0.
    mass, damping, time_step : float
        m and gamma (4), dt, which is lowered where the forces make it unstable.
    max_move : float
        Bound of a vertex's movement per iteration, in delta, (0, 1].
    bound : {"clamp", "scale"}
        Bound the speed of each vertex, or scale the time step to the fastest one (3.6).
    anisotropy : {"physical", "voxel", "metric"}
        Where the mesh lives: in mm, in voxel proportions, or in those of each level with forces
        in mm (4.4).
    epsilon : float
        Kinetic energy along the normals below which a level has converged, > 0.
    calm_speed : float
        Also no vertex may be as fast, in delta per time; 0: not asked.
    max_iterations : int
        Per level, >= 1.
    late_bubbles : bool
        Bubbles start in what a level's surface has missed; False: as the paper.
    sleeping : bool
        Regions where nothing has moved for long are left alone until something near them moves.
    """

    iso: float | None = _D["iso"]
    inside_below: bool = _D["inside_below"]
    level_iso: tuple[float, ...] | None = _D["level_iso"]
    window_low: float | None = _D["window_low"]
    window_high: float | None = _D["window_high"]
    pad_value: float | None = _D["pad_value"]
    feature: Literal["none", "gradient_norm"] = _D["feature"]
    feature_sigma: float = _D["feature_sigma"]
    levels: int | None = _D["levels"]
    reduction: float = _D["reduction"]
    init: Literal["bubble", "bubbles", "seeds", "iso", "mask", "mesh", "auto"] = _D["init"]
    bubbles: tuple[int, int, int] = _D["bubbles"]
    mesh: Literal["uniform", "adaptive", "auto"] = _D["mesh"]
    edge: float = _D["edge"]
    tolerance: float = _D["tolerance"]
    edge_min: float = _D["edge_min"]
    edge_max: float = _D["edge_max"]
    curvature: float = _D["curvature"]
    spring: float = _D["spring"]
    rest_length: Literal["zero", "mean", "value"] = _D["rest_length"]
    rest_length_value: float = _D["rest_length_value"]
    force: Literal["iso", "gradient", "both"] = _D["force"]
    attraction: float = _D["attraction"]
    gradient: float = _D["gradient"]
    gradient_tangent: float = _D["gradient_tangent"]
    gradient_bound: float = _D["gradient_bound"]
    mass: float = _D["mass"]
    damping: float = _D["damping"]
    time_step: float = _D["time_step"]
    max_move: float = _D["max_move"]
    bound: Literal["clamp", "scale"] = _D["bound"]
    anisotropy: Literal["physical", "voxel", "metric"] = _D["anisotropy"]
    epsilon: float = _D["epsilon"]
    calm_speed: float = _D["calm_speed"]
    max_iterations: int = _D["max_iterations"]
    late_bubbles: bool = _D["late_bubbles"]
    sleeping: bool = _D["sleeping"]

    def replace(self, **changes: Unpack[Changes]) -> Parameters:
        """These parameters but for some.

        Raises
        ------
        TypeError
            Where a name is not one of a parameter.
        """
        for name in changes:
            if name not in _D:
                near = difflib.get_close_matches(name, _D, 3, 0.6)
                hint = f": did you mean {' or '.join(near)}?" if near else ""
                raise TypeError(f"there is no parameter {name!r}{hint}")
        return dataclasses.replace(self, **changes)


def fields_of(parameters: Parameters) -> dict[str, Any]:
    """As the engine takes them."""
    return {name: getattr(parameters, name) for name in _D}


def told(without: Collection[str] = ()) -> Callable[[T], T]:
    """A decorator: the signature names each parameter, but for some, in place of ``**changes``.

    For what looks when the program runs: `help`, and completion in IPython and Jupyter.
    """

    def decorated(function: T) -> T:
        signature = inspect.signature(function)
        before = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        taken = {p.name for p in before}
        fields = [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                default=getattr(Parameters, name),
                annotation=annotation,
            )
            for name, annotation in Parameters.__annotations__.items()
            if name not in taken and name not in without
        ]
        shown = [p for p in before if not p.name.startswith("_")] + fields
        function.__signature__ = signature.replace(parameters=shown)  # type: ignore[attr-defined]
        return function

    return decorated
