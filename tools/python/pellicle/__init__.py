"""Closed, oriented, non-self-intersecting triangulated surfaces from 3D images.

``read`` reads an image and ``extract`` makes a surface of it in one call, ``extract_labels`` one of
each label; ``Volume``, ``Pyramid`` and ``Run`` make it in
steps of any size. ``distributed.extract`` takes an image that is too large for one machine.
``check_mesh``, ``component_measures``, ``curvature``, ``geodesic``, ``distance``
and ``nearest_vertex`` measure any mesh. Images are arrays indexed [z, y, x], or [x, y, z] with
``order="xyz"``; coordinates, spacing and all other triples are x, y, z.
"""

from . import distributed
from ._context import Context
from ._errors import (
    Cancelled,
    InternalError,
    InvalidArgument,
    InvalidData,
    OutOfMemory,
    PellicleError,
)
from ._extract import extract
from ._images import Geometry, Image, Order, geometry_from_affine
from ._labels import extract_labels
from ._meshes import (
    check_mesh,
    component_measures,
    curvature,
    distance,
    geodesic,
    nearest_vertex,
    round_mesh,
    simplify,
)
from ._parameters import Parameters
from ._pellicle import version
from ._read import read
from ._records import (
    Check,
    ComponentMeasures,
    Components,
    Curvature,
    Distances,
    ForcePoints,
    LevelReport,
    Measures,
    Memory,
    Progress,
    PyramidLevel,
    BrickCounts,
    Range,
    Scalar,
    Seconds,
    Simd,
    Simplified,
    Space,
    Verdict,
)
from ._steps import Pyramid, Run, Volume
from ._surface import Surface
from ._threshold import threshold_otsu

__version__ = version()

__all__ = [
    "Cancelled",
    "Check",
    "ComponentMeasures",
    "Components",
    "Context",
    "Curvature",
    "Distances",
    "ForcePoints",
    "Geometry",
    "Image",
    "InternalError",
    "InvalidArgument",
    "InvalidData",
    "LevelReport",
    "Measures",
    "Memory",
    "Order",
    "OutOfMemory",
    "Parameters",
    "PellicleError",
    "Progress",
    "Pyramid",
    "PyramidLevel",
    "BrickCounts",
    "Range",
    "Run",
    "Scalar",
    "Seconds",
    "Simd",
    "Simplified",
    "Space",
    "Surface",
    "Verdict",
    "Volume",
    "check_mesh",
    "component_measures",
    "curvature",
    "distance",
    "distributed",
    "extract",
    "extract_labels",
    "geodesic",
    "geometry_from_affine",
    "nearest_vertex",
    "read",
    "round_mesh",
    "simplify",
    "threshold_otsu",
    "version",
]
