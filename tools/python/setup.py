"""Builds the engine and the extension module with CMake; everything else is in pyproject.toml.

PELLICLE_BUILD_DIR names a build directory (an absolute path) to use and keep. One that has been
configured, which must be with -DPELLICLE_PYTHON=ON, is taken as it is. Without the variable the build
is made in a temporary directory.
"""

import atexit
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]


def version_of(header):
    """The version that the header's macros tell: written down nowhere else."""
    text = header.read_text()
    parts = [
        re.search(rf"^#define PLC_VERSION_{part} (\d+)$", text, re.MULTILINE)
        for part in ("MAJOR", "MINOR", "PATCH")
    ]
    if not all(parts):
        raise SystemExit(f"{header}: no PLC_VERSION_MAJOR, _MINOR, _PATCH")
    return ".".join(part[1] for part in parts)


def temporary():
    """A directory that goes with this process, so that the source tree stays as it is."""
    path = tempfile.mkdtemp(prefix="pellicle-")
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = Path(os.environ.get("PELLICLE_BUILD_DIR") or temporary())
        if not build.is_absolute():  # pip has changed the directory
            raise SystemExit(f"PELLICLE_BUILD_DIR={build}: must be an absolute path")
        if not (build / "CMakeCache.txt").exists():
            subprocess.run(
                [
                    "cmake", "--log-level=NOTICE", "-S", ROOT, "-B", build,
                    "-DCMAKE_BUILD_TYPE=Release",
                    "-DPELLICLE_PYTHON=ON",
                    "-DPELLICLE_TOOLS=OFF",
                    "-DPELLICLE_TESTS=OFF",
                    # The interpreter that a virtual environment is one of has the headers.
                    f"-DPython_EXECUTABLE={getattr(sys, '_base_executable', sys.executable)}",
                ],
                check=True,
            )
        jobs = str(os.cpu_count() or 1)
        subprocess.run(
            ["cmake", "--build", build, "--target", "pellicle_python", "-j", jobs], check=True
        )
        target = Path(self.get_ext_fullpath(extension.name)).absolute()
        # A module of another Python that the build directory is for would be left unnoticed.
        target.unlink(missing_ok=True)
        subprocess.run(
            ["cmake", "--install", build, "--component", "python", "--prefix", target.parent],
            check=True,
        )
        if not target.exists():
            raise SystemExit(f"{build}: was configured for another Python than {sys.executable}")


setup(
    version=version_of(ROOT / "engine" / "pellicle.h"),
    ext_modules=[Extension("pellicle._pellicle", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"egg_info": {"egg_base": temporary()}, "build": {"build_base": temporary()}},
)
