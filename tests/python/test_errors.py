"""Errors, names and the package itself."""

import ast
import dataclasses
import doctest
import inspect
import os
import pathlib
import re
import subprocess
import sys
import typing

import numpy as np
import pytest
from scenes import ball, octahedron, pill

import pellicle
from pellicle import _pellicle


def test_errors_of_the_engine_are_python_errors():
    for error, base in (
        (pellicle.InvalidArgument, ValueError),
        (pellicle.InvalidData, ValueError),
        (pellicle.OutOfMemory, MemoryError),
        (pellicle.InternalError, RuntimeError),
    ):
        assert issubclass(error, base) and issubclass(error, pellicle.PellicleError)
    with pytest.raises(pellicle.InvalidArgument, match="curvature"):
        pellicle.extract(pill(), 100, curvature=-1)
    with pytest.raises(pellicle.InvalidArgument, match="iso"):
        pellicle.extract(pill(), 1000)
    with pytest.raises(pellicle.InvalidArgument, match="iso"):
        pellicle.extract(pill())
    with pytest.raises(pellicle.InvalidData):
        pellicle.extract(np.full((20, 20, 20), np.nan), 0.5)
    with pytest.raises(pellicle.InvalidData, match="spacing"):
        pellicle.extract(pill(), 100, spacing=(1, 0, 1))
    with pytest.raises(pellicle.InvalidData):
        pellicle.extract(pill(), 100, direction=np.zeros((3, 3)))
    with pytest.raises(pellicle.InvalidData):
        pellicle.extract(np.zeros((1, 20, 20)), 0.5)


def test_a_memory_limit_holds():
    context = pellicle.Context(memory_limit=2**18)
    with pytest.raises(MemoryError) as caught:
        pellicle.extract(ball(64, 20), 0.5, context=context)
    assert isinstance(caught.value, pellicle.OutOfMemory)
    assert context.memory.peak <= 2**18
    assert pellicle.extract(ball(64, 20), 0.5).check().valid


def test_contexts_refuse_what_they_cannot_do():
    with pytest.raises(pellicle.InvalidArgument, match="threads"):
        pellicle.Context(threads=-1)
    with pytest.raises(ValueError, match="'auto', 'scalar'"):
        pellicle.Context(simd="mmx")
    with pytest.raises(TypeError):
        pellicle.Context(log="loud")
    with pytest.raises(TypeError, match="must be a Context"):
        pellicle.extract(pill(), 100, context=3)


@pytest.mark.parametrize(
    "wrong, hint",
    [("curvatur", "curvature"), ("level_isos", "level_iso"), ("max_iteration", "max_iterations")],
)
def test_unknown_parameters_are_told_with_what_may_have_been_meant(wrong, hint):
    with pytest.raises(TypeError, match=f"no parameter '{wrong}'.*{hint}"):
        pellicle.extract(pill(), 100, **{wrong: 1})
    with pytest.raises(TypeError, match=hint):
        pellicle.Pyramid(pellicle.Volume(pill()), 100, **{wrong: 1})


def test_values_of_the_wrong_kind_are_told_by_name():
    for error, name, value in (
        (TypeError, "curvature", "much"),
        (TypeError, "levels", 1.5),
        (TypeError, "max_iterations", None),
        (TypeError, "sleeping", "yes"),
        (TypeError, "init", 3),
        (ValueError, "init", "bubbel"),
        (ValueError, "rest_length", "Zero"),
        (ValueError, "bubbles", (1, 2)),
        (TypeError, "bubbles", 3),
        (TypeError, "level_iso", 100),
        (TypeError, "level_iso", ["a"]),
        (ValueError, "level_iso", range(40)),
        (ValueError, "level_iso", ()),
    ):
        with pytest.raises(error, match=name):
            pellicle.extract(pill(), 100, **{name: value})


def test_numpy_numbers_are_numbers():
    expected = pellicle.extract(pill(), 100, levels=1, curvature=0.25, level_iso=(100, 90))
    surface = pellicle.extract(
        pill(), np.uint8(100), levels=np.int64(1), curvature=np.float32(0.25),
        level_iso=np.array([100, 90]), sleeping=np.bool_(True), bubbles=np.array([1, 1, 1]),
        init="bubble",
    )
    assert surface.hash == expected.hash


def test_words_and_shapes_are_checked():
    for arguments in (
        {"order": "xzy"}, {"space": "mm"}, {"spacing": 1}, {"spacing": (1, 2)}, {"origin": "abc"},
        {"direction": np.eye(4)}, {"seeds": [[1, 2]]},
    ):
        with pytest.raises(ValueError):
            pellicle.extract(pill(), 100, **arguments)
    with pytest.raises(ValueError, match="three axes"):
        pellicle.extract(pill()[0], 100)
    surface = pellicle.extract(pill(), 100)
    with pytest.raises(ValueError, match="'lps', 'ras' or 'voxel'"):
        surface.in_space("mm")
    with pytest.raises(TypeError, match="Volume"):
        pellicle.Pyramid(pill(), 100)
    with pytest.raises(TypeError, match="Pyramid"):
        pellicle.Run(pellicle.Volume(pill()))


@pytest.mark.parametrize(
    "call, what",
    [
        (lambda s: pellicle.geodesic(s, 3.5), "source: must be an integer, not float"),
        (lambda s: pellicle.geodesic(s, "3"), "source: must be an integer, not str"),
        (lambda s: pellicle.geodesic(s, 2**70), "source: .* out of range"),
        (lambda s: pellicle.Context(threads=1.5), "threads: must be an integer"),
        (lambda s: pellicle.Context(threads=2**40), "threads: .* out of range"),
        (lambda s: pellicle.Context(memory_limit="1 GB"), "memory_limit: must be an integer"),
        (lambda s: pellicle.Context(simd=2), "simd: must be a str, not int"),
        (lambda s: s.scalars(3), "name: must be a str, not int"),
        (lambda s: pellicle.Run.restore(None, 5), "state: must be bytes, not int"),
        (lambda s: pellicle.Run.restore(None, "abc"), "state: must be bytes, not str"),
        (lambda s: _a_pyramid().values(0.5), "level: must be an integer, not float"),
        (lambda s: _a_pyramid().values(2**40), "level .*: the pyramid has 0 .. 0"),
        (lambda s: pellicle.Run(_a_pyramid()).iterate(2.5), "count: must be an integer"),
    ],
)
def test_arguments_of_the_wrong_kind_are_told_in_one_line(call, what):
    with pytest.raises((TypeError, ValueError), match=what) as caught:
        call(pellicle.Surface.from_mesh(*octahedron()))
    assert "\n" not in str(caught.value)


def _a_pyramid():
    return pellicle.Pyramid(pellicle.Volume(pill()), 100, levels=0)


def _masked(array):
    return np.ma.array(array, mask=np.asarray(array) == np.asarray(array).flat[0])


@pytest.mark.parametrize(
    "call, name",
    [
        (lambda: pellicle.extract(_masked(pill()), 100), "image"),
        (lambda: pellicle.extract(pill(), 100, mask=_masked(pill())), "mask"),
        (lambda: pellicle.extract(pill(), 100, seeds=_masked([[20, 15, 14, 5.0]])), "seeds"),
        (lambda: pellicle.extract(pill(), 100, attachments=_masked([[20, 15, 14, 5.0]])),
         "attachments"),
        (lambda: pellicle.extract(pill(), 100, pins=_masked([[20, 15, 14, 5.0]])), "pins"),
        (lambda: pellicle.extract(pill(), 100, spacing=_masked([1.0, 2, 3])), "spacing"),
        (lambda: pellicle.extract(pill(), 100, direction=_masked(np.eye(3))), "direction"),
        (lambda: pellicle.extract(pill(), 100, extra_force=lambda p: _masked(p.positions)),
         "extra_force"),
        (lambda: pellicle.geometry_from_affine(_masked(np.eye(4))), "affine"),
        (lambda: pellicle.check_mesh((_masked(octahedron()[0]), octahedron()[1])), "vertices"),
        (lambda: pellicle.check_mesh((octahedron()[0], _masked(octahedron()[1]))), "faces"),
        (lambda: pellicle.nearest_vertex(octahedron(), _masked([1.0, 2, 3])), "point"),
    ],
)
def test_masked_elements_are_not_taken_for_values(call, name):
    with pytest.raises(ValueError, match=f"{name}: has masked elements.*filled"):
        call()


def test_an_array_whose_mask_hides_nothing_is_an_array():
    expected = pellicle.extract(pill(), 100, levels=1).hash
    assert pellicle.extract(np.ma.array(pill()), 100, levels=1).hash == expected
    filled = np.ma.masked_less(pill(), 1).filled(0)
    assert pellicle.extract(filled, 100, levels=1).hash == expected


def test_subclasses_and_types_of_arrays_are_taken_or_refused():
    image = pill()
    expected = pellicle.extract(image, 100, levels=1).hash
    class Own(np.ndarray):
        pass

    for other in (image.astype(">u2"), image.astype(">i4"), image.astype(">f4"),
                  image.astype(">i8"), image.view(Own)):
        assert pellicle.extract(other, 100, levels=1).hash == expected
    vertices, faces = octahedron()
    assert pellicle.check_mesh((np.matrix(vertices), np.matrix(faces))).valid
    assert pellicle.check_mesh((vertices.astype(object), faces)).valid
    for wrong in (image.astype(complex), image.astype(object), image.astype("S3"),
                  image.astype("M8[s]")):
        with pytest.raises(TypeError, match="image: "):
            pellicle.extract(wrong, 100)
    for wrong in (vertices.astype(complex), [["a", "b", "c"]] * 6):
        with pytest.raises((TypeError, ValueError), match="vertices: must be"):
            pellicle.check_mesh((wrong, faces))
    with pytest.raises(TypeError, match="seeds: must be real"):
        pellicle.extract(image, 100, seeds=[[1j, 2, 3, 4]])


def test_places_outside_the_image_are_told_with_its_bounds():
    where = r"lies at \(100, 15, 14\), outside the image, which reaches from \(-0.5, -0.5, -0.5\) "
    for name in ("seeds", "pins", "attachments"):
        with pytest.raises(pellicle.InvalidArgument, match=name[:-1] + " 0: " + where):
            pellicle.extract(pill(), 100, **{name: [100, 15, 14, 5]})


def test_sizes_are_told_in_mm():
    with pytest.raises(pellicle.InvalidArgument, match="smallest radius is .* mm; use fewer"):
        pellicle.extract(pill(), 100, spacing=(3, 3, 3), seeds=[60, 45, 42, 0.5], levels=0)


def test_parameters_have_every_field_of_the_engine():
    fields = {field.name for field in dataclasses.fields(pellicle.Parameters)}
    assert fields == set(_pellicle.parameter_defaults())
    header = (pathlib.Path(os.environ["PELLICLE_SOURCE"]) / "engine/pellicle.h").read_text()
    struct = re.search(r"typedef struct plc_parameters {(.*?)} plc_parameters;", header, re.S)[1]
    struct = re.sub(r"/\*.*?\*/", "", struct, flags=re.S)
    declared = {
        re.sub(r"\[.*", "", name.split()[-1])
        for line in struct.split(";")
        if line.strip()
        for name in line.split(",")
    }
    assert declared - {"struct_size", "level_iso_count"} == fields


def test_the_version_is_that_of_the_header():
    header = (pathlib.Path(os.environ["PELLICLE_SOURCE"]) / "engine/pellicle.h").read_text()
    numbers = re.findall(r"^#define PLC_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", header, re.M)
    assert pellicle.__version__ == pellicle.version() == ".".join(numbers)
    from importlib.metadata import version

    assert version("pellicle") == pellicle.__version__


def test_this_is_the_installed_module_and_shows_nothing_of_the_engine():
    source = pathlib.Path(os.environ["PELLICLE_SOURCE"]).resolve()
    assert source not in pathlib.Path(pellicle.__file__).resolve().parents
    assert (pathlib.Path(pellicle.__file__).parent / "py.typed").exists()
    symbols = subprocess.run(
        ["nm", "-D", "--defined-only", _pellicle.__file__], capture_output=True, text=True,
        check=True,
    ).stdout
    assert "PyInit__pellicle" in symbols and "plc_" not in symbols


def test_the_stubs_name_what_is_there():
    stub = ast.parse((pathlib.Path(pellicle.__file__).parent / "_pellicle.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}

    def public(thing):
        return {name for name in vars(thing) if not name.startswith("_")}

    assert public(_pellicle) == functions | set(classes)
    for name, node in classes.items():
        members = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
        assert public(getattr(_pellicle, name)) == members - {"__init__"}, name


def test_everything_public_is_documented():
    for name in pellicle.__all__:
        thing = getattr(pellicle, name)
        if typing.get_origin(thing) is typing.Literal:
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and thing.__module__ in ("pellicle._steps", "pellicle._surface"):
            for member, value in vars(thing).items():
                if not member.startswith("_"):
                    assert inspect.getdoc(value), f"{name}.{member}"


def test_the_examples_of_the_documentation_run():
    extract_module = sys.modules[pellicle.extract.__module__]
    outcome = doctest.testmod(extract_module)
    assert outcome.attempted > 0 and outcome.failed == 0
