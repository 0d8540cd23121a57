#!/usr/bin/env python3
"""The examples of the READMEs run as they are written.

    tests/tools/test_readme_examples.py BUILD PYTHON_BUILD [README...]

BUILD is a build of the project, PYTHON_BUILD one that pip may use for the Python module. Without a README it
runs README.md, engine/README.md, tools/README.md and those of the folders in tools/.

An indented block is of the shell, a fenced one of the language that it names. All blocks of a README run one after
the other in a folder of their own that looks like a fresh checkout, by a user with a home of their own. A block of C,
C++, CMake or JavaScript whose first line is a comment that begins with the name of a file is written there, one of
Python runs in the environment `venv` that the README makes. A README ends at the first command that fails.

What cannot run is in LEFT_OUT, and nowhere else. Skipped (77) where the files of the examples are missing.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD, PYTHON_BUILD = (Path(path).resolve() for path in sys.argv[1:3])
FILES = ("/usr/share/doc/invesalius-examples/examples/Cranium.inv3", "/usr/share/mricron/templates")
SYSTEM_PYTHON = "/usr/bin/python3"


def python_lacks():
    """What test_python.sh asks for, too, but what only its own tests need."""
    modules = ("distributed", "ensurepip", "nibabel", "numpy", "pip", "setuptools", "venv", "wheel")
    asked = subprocess.run(
        [SYSTEM_PYTHON, "-c", "import importlib.util, sys, sysconfig\n"
         "print(*[n for n in sys.argv[1:] if not importlib.util.find_spec(n)])\n"
         "print(sysconfig.get_path('include'))", *modules],
        capture_output=True, text=True)
    if asked.returncode != 0:
        return SYSTEM_PYTHON
    missing, include = asked.stdout.splitlines()
    headers = (f"{include}/Python.h", "/usr/include/pybind11/pybind11.h")
    return missing + " ".join(path for path in headers if not Path(path).exists())


NO_PYTHON = python_lacks()
NO_PAGE = not (BUILD / "tools/view/npm/node_modules").exists()
NO_PICTURE = NO_PAGE or BUILD != SOURCE / "build" or not Path("/usr/bin/chromium").exists()
NO_WASM = not (SOURCE / "build-wasm32/tools/wasm/pellicle/pellicle.mjs").exists() or not shutil.which("node")

# Commands that are not run, why, and whether that is so here.
LEFT_OUT = (
    (r"tools/setup\.sh\b", "installs packages", True),
    (r"tools/(demo|test)\b", "builds the project, and runs this test", True),
    (r"cmake -S \. -B build\b", "makes the build that this test is of", True),
    (r"tools/(package|compilers|wasm/build_demo)\b", "builds the project another time, for minutes", True),
    (r"(python3 -m venv|venv/bin/)", f"the packages of tools/setup.sh python are missing: {NO_PYTHON}", NO_PYTHON),
    (r"pellicle view\b", "node and npm were missing when the command was built", NO_PAGE),
    (r"tools/view/picture\.mjs\b", "needs chromium, and the build in build/", NO_PICTURE),
    (r"(ln -s build-wasm32|node)\b", "tools/compilers wasm32 has not been run", NO_WASM),
)


def blocks_of(text):
    """(number of the first line, language, lines) of each block; shell: "sh"."""
    lines = text.splitlines() + [""]
    at = 0
    while at < len(lines):
        fence = re.match(r"```(\w*)$", lines[at])
        begin = at
        if fence:
            at = lines.index("```", at + 1)
            yield begin + 2, fence[1], lines[begin + 1:at]
        elif lines[at].startswith("    ") and (at == 0 or not lines[at - 1].strip()):
            while lines[at].startswith("    ") or (not lines[at] and lines[at + 1:at + 2] and
                                                   lines[at + 1].startswith("    ")):
                at += 1
            yield begin + 1, "sh", [line[4:] for line in lines[begin:at]]
        at += 1


class Readme:
    """Makes the script of a README: in it, a block is told on descriptor $told when it has run."""

    def __init__(self, path, left_out):
        self.name = str(path.relative_to(SOURCE))
        self.left_out = left_out
        self.files = {}
        self.wrong = []
        self.script = ["set -Ee -o pipefail",
                       "trap 'printf \"FAILED: %s:%s: %s\\n\" \"$readme\" \"$line\" \"$BASH_COMMAND\" >&$told' ERR",
                       f"readme={self.name}"]
        self.python = []
        for number, language, lines in blocks_of(path.read_text()):
            if language == "python":
                self.python += [(number, lines)]
                continue
            self.end_python()
            if language in ("sh", "bash"):
                self.block(number, self.commands(lines))
            elif language in ("c", "cpp", "cmake", "js"):
                self.write(number, lines)
        self.end_python()

    def block(self, number, commands):
        self.script += [f"line={number}; begin=${{EPOCHREALTIME/./}}", *commands,
                        "tenths=$(( (${EPOCHREALTIME/./} - begin) / 100000 ))",
                        'printf "%4d.%d s  %s:%s\\n" $((tenths / 10)) $((tenths % 10)) "$readme" "$line" >&$told']

    def is_left_out(self, command):
        for pattern, reason, here in LEFT_OUT:
            if here and re.match(pattern, command):
                self.left_out.setdefault(reason, []).append(command)
                return True
        return False

    def commands(self, lines):
        whole = "\n".join(lines).replace("\\\n", "\\\0").split("\n")
        # A command that is left out is one line, with what continues it.
        return [":" if self.is_left_out(line) else line.replace("\0", "\n") for line in whole]

    def write(self, number, lines):
        name = re.match(r"(?://|/\*|#)\s*([\w./-]+\.\w+)", lines[0])
        if name is None:
            self.wrong.append(f"{self.name}:{number}: names no file to write it to")
        else:
            self.files[name[1]] = "\n".join(lines) + "\n"

    def end_python(self):
        """One program of what has come: later blocks use what earlier ones have made."""
        if not self.python:
            return
        program = ""
        for number, lines in self.python:
            program += "\n" * (number - 1 - program.count("\n")) + "\n".join(lines) + "\n"
        name = f"block{self.python[0][0]}.py"
        self.files[name] = program  # its lines have the numbers that they have in the README
        self.block(self.python[0][0], self.commands([f"venv/bin/python {name}"]))
        self.python = []

    def run(self, work):
        root = work / self.name.replace("/", "-")
        root.mkdir()
        for entry in SOURCE.iterdir():
            if not entry.name.startswith((".", "build")) and entry.name != "out":
                (root / entry.name).symlink_to(entry)
        (root / "build").symlink_to(BUILD)
        if not NO_WASM:
            (root / "build-wasm32").symlink_to(SOURCE / "build-wasm32")
        for name, text in self.files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        home = work / "home"
        home.mkdir(exist_ok=True)
        log = work / "log"
        environment = {**os.environ, "HOME": str(home), "PELLICLE_BUILD_DIR": str(PYTHON_BUILD),
                       "PATH": f"{BUILD / 'tools'}:/usr/bin:{os.environ['PATH']}",
                       "PYTHONDONTWRITEBYTECODE": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
        for name in ("PYTHONPATH", "PKG_CONFIG_PATH", "VIRTUAL_ENV"):
            environment.pop(name, None)
        sys.stdout.flush()
        with log.open("w") as output:
            told = os.dup(sys.stdout.fileno())
            code = subprocess.run(["bash", "-c", "\n".join([f"told={told}", *self.script])], cwd=root, env=environment,
                                  stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                  pass_fds=(told,)).returncode
            os.close(told)
        if code != 0:
            self.wrong.append(f"{self.name}: ended with {code}")
            print("\n".join("    " + line for line in log.read_text(errors="replace").splitlines()[-30:]))
        shutil.rmtree(root)
        return self.wrong


def main():
    for file in FILES:
        if not Path(file).exists():
            print(f"skipped: {file} is not there (tools/setup.sh test)")
            return 77
    named = [Path(path).resolve() for path in sys.argv[3:]]
    readmes = named or [SOURCE / "README.md", SOURCE / "engine/README.md", SOURCE / "tools/README.md",
                        *sorted((SOURCE / "tools").glob("*/README.md"))]
    wrong = []
    left_out = {}
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="pellicle-readme-") as work:
        for path in readmes:
            wrong += Readme(path, left_out).run(Path(work))
    for reason, commands in left_out.items():
        print(f"left out, {reason}:", *dict.fromkeys(commands), sep="\n    ")
    # The list is no longer than it must be.
    wrong += [f"nothing is left out for: {reason}" for _, reason, here in LEFT_OUT
              if here and not named and reason not in left_out]
    print(f"{time.monotonic() - begin:.0f} s")
    print("\n".join(wrong) if wrong else "All as expected.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
