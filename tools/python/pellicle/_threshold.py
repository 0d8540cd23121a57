"""Values for surfaces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._errors import InvalidData
from ._images import Image, voxels_of

_BINS = 65536
_PART = 1 << 20  # voxels at a time, which bounds the memory


def threshold_otsu(image: npt.ArrayLike | Image) -> float:
    """The value between two classes of voxels that are as far apart as can be (Otsu, 1979).

    Exactly what ``--iso otsu`` of the command takes. The histogram has a bin for each value of
    integers within a range of 65,536, else 65,536 bins over the range; the threshold lies between
    two bins. Voxels that are NaN or infinite are left out.

    Parameters
    ----------
    image : array_like or Image
        As of `extract`.

    Returns
    -------
    float

    Raises
    ------
    InvalidData
        Where all voxels have one value.
    """
    voxels = voxels_of(image.values if isinstance(image, Image) else image, "xyz")
    if voxels.dtype.kind == "f":
        voxels = voxels[np.isfinite(voxels)]
    low = float(voxels.min()) if voxels.size > 0 else np.nan
    high = float(voxels.max()) if voxels.size > 0 else np.nan
    if not low < high:
        raise InvalidData("image: has no two values for a threshold to lie between")
    whole = voxels.dtype.kind != "f" and high - low < _BINS
    bins = int(high - low) + 1 if whole else _BINS
    width = 1.0 if whole else (high - low) / _BINS
    counts = np.zeros(bins)
    flat = voxels.reshape(-1, order="A")  # a view where x is fastest
    for start in range(0, flat.size, _PART):
        place = (flat[start : start + _PART].astype(np.float64) - low) / width
        counts += np.bincount(np.minimum(place.astype(np.int64), bins - 1), minlength=bins)

    sums = np.arange(bins) * counts
    below, left = np.cumsum(counts)[:-1], np.cumsum(sums)[:-1]
    above, right = voxels.size - below, sums.sum() - left
    apart = left / np.where(below > 0, below, 1) - right / np.where(above > 0, above, 1)
    between = np.where((below > 0) & (above > 0), below * above * apart * apart, -1.0)
    best = np.flatnonzero(between == between.max())  # of bins of no voxels all are equally good
    return float(low + (0.5 if whole else width) + width * float(best[0] + best[-1]) / 2)
