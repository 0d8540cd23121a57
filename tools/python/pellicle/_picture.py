"""A small picture of a mesh, for notebooks."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from ._records import Space

_SIZE = 240  # pixels along both sides
_LIGHT = np.array([0.3, 0.4, 0.85])  # of the view's axes: from the right, above and the front
_COLOUR = np.array([235.0, 220.0, 195.0])

# Right, up and towards the viewer. All keep the mesh's handedness.
_AXES = {
    "lps": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    "ras": [[-1, 0, 0], [0, 0, 1], [0, 1, 0]],
    "voxel": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
}

Points = npt.NDArray[np.floating[Any]]


def picture(vertices: Points, faces: npt.NDArray[np.uint32], space: Space) -> bytes:
    """A PNG of the mesh from the front and a little above, with a transparent background.

    space: of the vertices. The front of a patient is where y is low in LPS and high in RAS; an
    image is seen along z, with y down, as slices are shown.
    """
    axes = np.array(_AXES[space], dtype=np.float64)
    places = (vertices.astype(np.float64) - vertices.mean(axis=0, dtype=np.float64)) @ axes.T
    a = np.radians(20)
    tilt = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    places = places @ tilt.T
    low, high = places.min(axis=0), places.max(axis=0)
    scale = (_SIZE - 8) / max(*(high - low)[:2], np.finfo(float).tiny)
    places = (places - (low + high) / 2) * scale
    corners = places[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    light = _LIGHT / np.linalg.norm(_LIGHT)
    shades = np.clip(normals @ light / np.maximum(lengths, 1e-300), 0, 1)

    seen = normals[:, 2] > 0
    extent = np.ptp(corners[:, :, :2], axis=1).max(axis=1)
    steps = np.maximum(np.ceil(1.5 * extent), 1).astype(int)  # no pixel within is missed
    depth, pixel, shade = [], [], []
    for n in np.unique(steps[seen]):
        chosen = seen & (steps == n)
        weights = np.array(
            [((3 * i + 1) / (3 * n), (3 * j + 1) / (3 * n)) for i in range(n) for j in range(n - i)]
        )
        a, b, c = corners[chosen].transpose(1, 0, 2)[:, :, np.newaxis]
        points = a + (b - a) * weights[:, :1] + (c - a) * weights[:, 1:]
        column = np.clip(points[..., 0] + _SIZE / 2, 0, _SIZE - 1).astype(int)
        row = np.clip(_SIZE / 2 - points[..., 1], 0, _SIZE - 1).astype(int)
        depth.append(points[..., 2].ravel())
        pixel.append((row * _SIZE + column).ravel())
        shade.append(np.repeat(shades[chosen], len(weights)))
    image = np.zeros((_SIZE * _SIZE, 4), np.uint8)
    if depth:
        order = np.argsort(np.concatenate(depth), kind="stable")  # the nearest is written last
        at, lit = np.concatenate(pixel)[order], np.concatenate(shade)[order]
        image[at, :3] = (_COLOUR * (0.25 + 0.75 * lit[:, np.newaxis])).astype(np.uint8)
        image[at, 3] = 255
    return _png(image.reshape(_SIZE, _SIZE, 4))


def _png(pixels: npt.NDArray[np.uint8]) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    height, width = pixels.shape[:2]
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)  # 0: a row without a filter
    parts = [(b"IHDR", header), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)
