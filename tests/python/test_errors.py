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
from scenes import ball, pill

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


def test_the_examples_of_the_documentation_run(tmp_path):
    extract_module = sys.modules[pellicle.extract.__module__]
    outcome = doctest.testmod(extract_module)
    assert outcome.attempted > 0 and outcome.failed == 0
    readme = pathlib.Path(os.environ["PELLICLE_SOURCE"]) / "tools/python/README.md"
    blocks = re.findall(r"```python\n(.*?)```", readme.read_text(), re.S)
    assert blocks
    subprocess.run([sys.executable, "-c", "\n".join(blocks)], cwd=tmp_path, check=True)
