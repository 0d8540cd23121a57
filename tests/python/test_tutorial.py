"""The tutorial runs as it is written."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import pellicle

SOURCE = Path(os.environ.get("PELLICLE_SOURCE", Path(__file__).parents[2]))
TUTORIAL = SOURCE / "tools" / "python" / "tutorial" / "tutorial.ipynb"


def cells(notebook):
    return ["".join(c["source"]) for c in notebook["cells"] if c["cell_type"] == "code"]


def test_cells_of_the_tutorial_run_in_plain_python(capsys):
    notebook = json.loads(TUTORIAL.read_text())
    assert all(not c.get("outputs") for c in notebook["cells"])  # none are kept in the sources
    names = {}
    for number, cell in enumerate(cells(notebook)):
        exec(compile(cell, f"cell {number} of {TUTORIAL.name}", "exec"), names)
    printed = capsys.readouterr().out
    assert "did you mean curvature" in printed
    assert sorted(re.findall(r"genus (\d)", printed)) == ["0", "1"]


def test_tutorial_runs_in_jupyter(tmp_path):
    for name in ("nbconvert", "ipykernel"):
        pytest.importorskip(name, reason=f"{name} is missing: tools/setup.sh python")
    environment = {**os.environ, "PYTHONPATH": str(Path(pellicle.__file__).parents[1])}
    environment |= {"HOME": str(tmp_path), "IPYTHONDIR": str(tmp_path / "ipython")}
    command = [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", TUTORIAL]
    run = subprocess.run(
        [*command, "--output-dir", tmp_path, "--output", "done"],
        env=environment, capture_output=True, text=True,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    done = json.loads((tmp_path / "done.ipynb").read_text())
    html = [
        "".join(output["data"]["text/html"])
        for cell in done["cells"]
        for output in cell.get("outputs", [])
        if "text/html" in output.get("data", {})
    ]
    assert len(html) == 2 and all("data:image/png;base64," in text for text in html)
