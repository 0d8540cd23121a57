"""Image files, by numpy and, for NIfTI, nibabel."""

from __future__ import annotations

import os
import zlib
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._errors import InvalidData
from ._images import Geometry, Image, geometry_from_affine

_NRRD_TYPES = {
    np.dtype(numpy): names.split(", ")
    for numpy, names in {
        "i1": "signed char, int8, int8_t",
        "u1": "uchar, unsigned char, uint8, uint8_t",
        "i2": "short, short int, signed short, signed short int, int16, int16_t",
        "u2": "ushort, unsigned short, unsigned short int, uint16, uint16_t",
        "i4": "int, signed int, int32, int32_t",
        "u4": "uint, unsigned int, uint32, uint32_t",
        "i8": "longlong, long long, long long int, signed long long, int64, int64_t",
        "u8": "ulonglong, unsigned long long, unsigned long long int, uint64, uint64_t",
        "f4": "float",
        "f8": "double",
    }.items()
}
# Signs of x and y that lead to LPS. LAS is left out: where it means y, ITK
# mirrors x, and so does what reads by it.
_NRRD_SPACES = {
    "left-posterior-superior": (1, 1),
    "lps": (1, 1),
    "right-anterior-superior": (-1, -1),
    "ras": (-1, -1),
}
_META_TYPES = {
    "MET_CHAR": "i1",
    "MET_UCHAR": "u1",
    "MET_SHORT": "i2",
    "MET_USHORT": "u2",
    "MET_INT": "i4",
    "MET_UINT": "u4",
    "MET_LONG_LONG": "i8",
    "MET_ULONG_LONG": "u8",
    "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}


def read(path: str | os.PathLike[str]) -> Image:
    """Reads a 3D image with its place in patient space.

    Parameters
    ----------
    path : str or path
        NIfTI (.nii, .nii.gz, .hdr, .img), which needs nibabel; NRRD (.nrrd, .nhdr) and MetaImage
        (.mha, .mhd) in raw or gzip encoding. Where an image lies is what the command says of it.

    Returns
    -------
    Image

    Raises
    ------
    InvalidData
        Where the file is damaged or has what is not read, or is of another format: says what reads
        it.
    ImportError
        For NIfTI without nibabel.
    """
    file = Path(path)
    name = file.name.lower()
    for suffixes, reader in _READERS.items():
        if name.endswith(suffixes):
            try:
                return reader(file)
            except (KeyError, IndexError, ValueError, EOFError, zlib.error) as error:
                if isinstance(error, InvalidData):
                    raise
                what = f"{error} is missing" if isinstance(error, KeyError) else str(error)
                raise InvalidData(f"{file}: {what}") from error
    raise InvalidData(
        f"{file}: read takes {', '.join(s for suffixes in _READERS for s in suffixes)}; for DICOM, "
        "TIFF and others use SimpleITK.ReadImage, or the command pellicle"
    )


def _nifti(file: Path) -> Image:
    try:
        nibabel = import_module("nibabel")
    except ImportError:
        raise ImportError(f"{file}: to read NIfTI, pellicle.read needs nibabel") from None
    try:
        image = nibabel.load(file)
        values = np.asanyarray(image.dataobj)
    except (nibabel.filebasedimages.ImageFileError, OSError) as error:
        if isinstance(error, FileNotFoundError):
            raise
        raise InvalidData(f"{file}: {error}") from error
    while values.ndim > 3 and values.shape[-1] == 1:
        values = values[..., 0]
    _three_axes(file, values.ndim)
    affine = np.array(image.affine, dtype=np.float64)
    # The codes of metre and micron; everything else is taken for mm.
    affine[:3] *= {1: 1e3, 3: 1e-3}.get(int(image.header.get("xyzt_units", 0)) & 7, 1)
    return Image(values.transpose(), geometry_from_affine(affine))


def _nrrd(file: Path) -> Image:
    data = file.read_bytes()
    if not data.startswith(b"NRRD"):
        raise InvalidData(f"{file}: is no NRRD file")
    header, _, body = data.partition(b"\n\n")
    fields: dict[str, str] = {}
    for line in header.decode("ascii", "replace").splitlines()[1:]:
        name, colon, value = line.partition(":")
        if colon and not line.startswith("#") and not value.startswith("="):
            fields[name.strip().lower()] = value.strip()
    _three_axes(file, int(fields["dimension"]))
    for name in ("line skip", "byte skip"):
        if int(fields.get(name, fields.get(name.replace(" ", ""), 0))) != 0:
            raise InvalidData(f"{file}: read does not know \"{name}\"")
    kind = next((t for t, names in _NRRD_TYPES.items() if fields["type"].lower() in names), None)
    if kind is None:
        raise InvalidData(f"{file}: read does not know the type \"{fields['type']}\"")
    encoding = fields["encoding"].lower()
    if encoding not in ("raw", "gzip", "gz"):
        raise InvalidData(f"{file}: read knows the encodings raw and gzip, not \"{encoding}\"")
    if detached := fields.get("data file", fields.get("datafile")):
        if detached.startswith("LIST") or " " in detached:
            raise InvalidData(f"{file}: read does not know data in several files")
        body = (file.parent / detached).read_bytes()
    values = _voxels(
        file,
        body,
        kind.newbyteorder(">" if fields.get("endian", "little").lower() == "big" else "<"),
        _numbers(fields["sizes"]),
        encoding != "raw",
    )
    space = fields.get("space", "lps").lower()
    if space not in _NRRD_SPACES:
        raise InvalidData(f"{file}: read does not know the space \"{space}\"")
    affine = np.eye(4)
    if "space directions" in fields:
        vectors = [_numbers(text) for text in _vectors(fields["space directions"])]
        affine[:3, :3] = np.array(vectors).T
    elif "spacings" in fields:
        affine[:3, :3] = np.diag(_numbers(fields["spacings"]))
    if "space origin" in fields:
        affine[:3, 3] = _numbers(_vectors(fields["space origin"])[0])
    elif any(_numbers(fields.get("axis mins", fields.get("axismins", "0")))):
        raise InvalidData(f"{file}: read does not know \"axis mins\"")
    affine[:2] *= np.array(_NRRD_SPACES[space])[:, np.newaxis]
    return Image(values, geometry_from_affine(affine, "lps"))


def _vectors(text: str) -> list[str]:
    """The insides of "(1,0,0) (0,1,0) (0,0,1)"."""
    return [part.partition("(")[2] for part in text.split(")")[:-1]]


def _meta(file: Path) -> Image:
    fields: dict[str, str] = {}
    with file.open("rb") as stream:
        while "ElementDataFile" not in fields:
            line = stream.readline(65536).decode("ascii", "replace")
            name, sign, value = line.partition("=")
            if not sign:
                raise InvalidData(f"{file}: is no MetaImage file: it has no ElementDataFile")
            fields[name.strip()] = value.strip()
        body = stream.read()
    _three_axes(file, int(fields["NDims"]))
    known = {"ElementNumberOfChannels": "1", "BinaryData": "True", "HeaderSize": "0"}
    for name, plain in known.items():
        if fields.get(name, plain).lower() != plain.lower():
            raise InvalidData(f"{file}: read does not know {name} = {fields[name]}")
    if fields["ElementType"] not in _META_TYPES:
        raise InvalidData(f"{file}: read does not know ElementType = {fields['ElementType']}")
    source = fields["ElementDataFile"]
    if source == "LIST" or "%" in source:
        raise InvalidData(f"{file}: read does not know data in several files")
    if source != "LOCAL":
        body = (file.parent / source).read_bytes()

    def first(names: str, otherwise: str) -> list[float]:
        return _numbers(next((fields[n] for n in names.split() if n in fields), otherwise))

    order: Literal["<", ">"] = "<"
    if "true" in (
        fields.get(name, "").lower() for name in ("BinaryDataByteOrderMSB", "ElementByteOrderMSB")
    ):
        order = ">"
    values = _voxels(
        file,
        body,
        np.dtype(_META_TYPES[fields["ElementType"]]).newbyteorder(order),
        _numbers(fields["DimSize"]),
        fields.get("CompressedData", "False").lower() == "true",
    )
    axes = np.array(first("TransformMatrix Rotation Orientation", "1 0 0 0 1 0 0 0 1"))
    sx, sy, sz = first("ElementSpacing ElementSize", "1 1 1")
    x, y, z = first("Offset Position Origin", "0 0 0")
    # Row by row the file has the axis of x, of y, of z: these are the columns.
    return Image(
        values,
        Geometry(spacing=(sx, sy, sz), origin=(x, y, z), direction=axes.reshape(3, 3).T.copy()),
    )


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.replace(",", " ").split()]


def _three_axes(file: Path, count: int) -> None:
    if count != 3:
        raise InvalidData(f"{file}: must have three axes, not {count}")


def _voxels(
    file: Path, body: bytes, kind: np.dtype[Any], sizes: list[float], compressed: bool
) -> npt.NDArray[Any]:
    nx, ny, nz = (int(size) for size in sizes)
    wanted = nx * ny * nz * kind.itemsize
    if min(nx, ny, nz) < 1:
        raise InvalidData(f"{file}: has no voxels")
    if compressed:
        inflater = zlib.decompressobj(wbits=zlib.MAX_WBITS | 32)  # zlib or gzip
        body = inflater.decompress(body, wanted)
    if len(body) < wanted:
        raise InvalidData(f"{file}: is truncated ({len(body)} bytes of voxels, not {wanted})")
    values = np.frombuffer(body, kind, nx * ny * nz).reshape(nz, ny, nx)
    return values.astype(kind.newbyteorder("="), copy=False)


_READERS: dict[tuple[str, ...], Callable[[Path], Image]] = {
    (".nii", ".nii.gz", ".hdr", ".img"): _nifti,
    (".nrrd", ".nhdr"): _nrrd,
    (".mha", ".mhd"): _meta,
}
