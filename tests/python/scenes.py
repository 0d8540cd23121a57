"""Images and meshes of the tests."""

import numpy as np


def ball(size=32, radius=10.0, centre=None, dtype=np.float32):
    """[z, y, x] values 0 .. 1, 0.5 on the sphere."""
    middle = (size - 1) / 2 if centre is None else 0
    x0, y0, z0 = centre or (0, 0, 0)
    z, y, x = np.mgrid[:size, :size, :size] - middle
    distance = np.sqrt((x - x0) ** 2 + (y - y0) ** 2 + (z - z0) ** 2)
    return np.clip(0.5 + (radius - distance) / 2, 0, 1).astype(dtype)


def pill():
    """An image without any symmetry: mixed-up axes show."""
    z, y, x = np.mgrid[:30, :34, :40].astype(np.float64)
    values = 0.5 + 7 - np.sqrt(((x - 22) / 1.6) ** 2 + (y - 15) ** 2 + ((z - 14) / 1.2) ** 2)
    return np.round(np.clip(values, 0, 1) * 200).astype(np.uint8)


def endless():
    """Parameters with which an extraction goes on until it is stopped: an adaptive mesh would come to
    lie still, to the last bit."""
    return {"mesh": "uniform", "epsilon": 1e-300, "max_iterations": 2**30, "sleeping": False}


def octahedron(radius=1.0):
    vertices = radius * np.array(
        [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float
    )
    faces = np.array(
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    )
    return vertices, faces
