"""Surfaces to files: the same bytes as the command writes."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import InvalidData
from ._meshes import check_mesh, round_mesh

if TYPE_CHECKING:
    from ._surface import Surface

# As files name a space after "SPACE=".
_NAMES = {"lps": "LPS", "ras": "RAS", "voxel": "voxel"}

Floats = npt.NDArray[np.floating[Any]]
Faces = npt.NDArray[np.uint32]


def settled_vertices(surface: Surface) -> Floats:
    """Coordinates with which the mesh is valid: float32 where they will do, else float64."""
    mesh = (surface.vertices_f64, surface.faces)
    try:
        return round_mesh(mesh, context=surface.context)
    except InvalidData:
        if check_mesh(mesh, context=surface.context).valid:
            return mesh[0]
    raise InvalidData(
        "the voxels are so small beside their distance from the origin that faces meet in mm, even "
        "in double precision: in_space('voxel') holds the surface"
    )


def save(surface: Surface, path: str | os.PathLike[str]) -> None:
    """Writes beside the target and renames: nothing half-written is left behind."""
    target = Path(path)
    writer = _WRITERS.get(target.suffix.lower())
    if writer is None:
        raise ValueError(
            f"{target}: save writes {', '.join(_WRITERS)}; for other formats see to_meshio and "
            "`pellicle mesh`"
        )
    data = writer(settled_vertices(surface), surface.normals, surface.faces, _NAMES[surface.space])
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)  # as of any new file
        os.replace(name, target)
    except BaseException:
        os.unlink(name)
        raise


def _ply(vertices: Floats, normals: Floats, faces: Faces, space: str) -> bytes:
    real = "double" if vertices.dtype == np.float64 else "float"
    header = [
        "ply",
        "format binary_little_endian 1.0",
        "comment Pellicle",
        f"comment SPACE={space}",
        f"element vertex {len(vertices)}",
        *(f"property {real} {axis}" for axis in "xyz"),
        *(f"property float n{axis}" for axis in "xyz"),
        f"element face {len(faces)}",
        "property list uchar uint vertex_indices",
        "end_header\n",
    ]
    place = vertices.dtype.newbyteorder("<")
    points = np.empty(len(vertices), [("place", place, 3), ("normal", "<f4", 3)])
    points["place"], points["normal"] = vertices, normals
    corners = np.empty(len(faces), [("count", "u1"), ("face", "<u4", 3)])
    corners["count"], corners["face"] = 3, faces
    return "\n".join(header).encode() + points.tobytes() + corners.tobytes()


def parsed_ply(data: bytes) -> tuple[Floats, Faces]:
    """Vertices and faces of a file as the command writes it, without normals."""
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode().splitlines()
    count = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element ")}
    place = np.dtype("<f8" if "property double x" in lines else "<f4")
    vertices = np.frombuffer(body, place, 3 * count["vertex"]).reshape(-1, 3)
    corners = np.frombuffer(
        body, [("count", "u1"), ("face", "<u4", 3)], count["face"], vertices.nbytes
    )
    return vertices, corners["face"]


def _stl(vertices: Floats, normals: Floats, faces: Faces, space: str) -> bytes:
    corners = vertices.astype(np.float64)[faces]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    (ux, uy, uz), (vx, vy, vz) = u.T, v.T
    facing = np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], axis=1)
    nx, ny, nz = facing.T
    length = np.sqrt(nx * nx + ny * ny + nz * nz)[:, np.newaxis]
    facing = np.divide(facing, length, out=np.zeros_like(facing), where=length > 0)
    if vertices.dtype == np.float64:  # the binary kind has floats only
        lines = [f"solid Pellicle SPACE={space}"]
        for normal, triangle in zip(facing.tolist(), corners.tolist(), strict=True):
            lines.append("facet normal {:.9g} {:.9g} {:.9g}\nouter loop".format(*normal))
            lines += ["vertex {!r} {!r} {!r}".format(*corner) for corner in triangle]
            lines.append("endloop\nendfacet")
        return "\n".join([*lines, "endsolid Pellicle\n"]).encode()
    records = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("", "<u2")])
    records["normal"], records["corners"] = facing, corners
    header = f"Binary STL by Pellicle, mm SPACE={space}".ljust(80).encode()
    return header + len(faces).to_bytes(4, "little") + records.tobytes()


def _obj(vertices: Floats, normals: Floats, faces: Faces, space: str) -> bytes:
    place = "v {!r} {!r} {!r}" if vertices.dtype == np.float64 else "v {:.9g} {:.9g} {:.9g}"
    lines = ["# Pellicle", f"# SPACE={space}"]
    lines += [place.format(*vertex) for vertex in vertices.tolist()]
    lines += ["vn {:.9g} {:.9g} {:.9g}".format(*normal) for normal in normals.tolist()]
    lines += [
        f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in (faces.astype(np.int64) + 1).tolist()
    ]
    return ("\n".join(lines) + "\n").encode()


_WRITERS = {".ply": _ply, ".stl": _stl, ".obj": _obj}
