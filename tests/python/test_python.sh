#!/usr/bin/env bash
# The Python module as a user gets it: installed by pip into a virtual environment, without network.
#   tests/python/test_python.sh [BUILD [PELLICLE]]
# BUILD is a build directory to use and keep (see tools/python/setup.py), PELLICLE the command that
# must make the same surfaces. Skipped (77) where the packages of `tools/setup.sh python` are missing.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
python=${PYTHON:-/usr/bin/python3}

missing=$("$python" - <<'END'
import importlib.util, os, sysconfig
modules = "ensurepip mypy nibabel numpy pip pytest setuptools venv wheel".split()
headers = [sysconfig.get_path("include") + "/Python.h", "/usr/include/pybind11/pybind11.h"]
print(*[name for name in modules if not importlib.util.find_spec(name)],
      *[path for path in headers if not os.path.exists(path)])
END
) || missing=$python
if [ -n "$missing" ]; then
  echo "Missing, of the packages of tools/setup.sh python: $missing"
  exit 77
fi

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
if [ -n "${1:-}" ]; then export PELLICLE_BUILD_DIR; PELLICLE_BUILD_DIR=$(realpath -m "$1"); fi
if [ -n "${2:-}" ]; then export PELLICLE_COMMAND; PELLICLE_COMMAND=$(realpath "$2"); fi
export PELLICLE_SOURCE=$root PYTHONDONTWRITEBYTECODE=1
unset PYTHONPATH

"$python" -m venv --system-site-packages "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check --no-build-isolation --no-index \
  "$root/tools/python"

left=$(find "$root/tools/python" -name '*.egg-info' -o -name build -o -name '*.so')
if [ -n "$left" ]; then
  printf 'pip has left in the sources:\n%s\n' "$left" >&2
  exit 1
fi

cd "$dir"
"$dir/venv/bin/python" -m pytest -q -p no:cacheprovider --rootdir "$root/tests/python" \
  "$root/tests/python"

# The types of the package, and of a program that uses it.
mypy=("$python" -m mypy --strict --python-executable "$dir/venv/bin/python" --cache-dir "$dir/mypy"
  --enable-incomplete-feature=Unpack)  # complete from mypy 1.7 on
"${mypy[@]}" -p pellicle
"${mypy[@]}" "$root/tests/python/typed_sample.py"
