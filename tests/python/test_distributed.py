"""One image by the workers of a Dask cluster."""

import json
import os
import pathlib
import shutil
import signal
import subprocess

import numpy as np
import pytest

import pellicle

COMMAND = os.environ.get("PELLICLE_COMMAND")
dask = pytest.importorskip("distributed", reason="without dask.distributed (python3-distributed)")
pytestmark = pytest.mark.skipif(COMMAND is None, reason="without the command (PELLICLE_COMMAND)")

# Levels 1 and 0 by blocks, 3 x 2 x 2 of them: 24 tasks in 16 steps, half of which have two.
PLAN = {"side": 100, "from_level": 1, "reduction": 1.2, "levels": 3}


def blocks(*words):
    return subprocess.run([COMMAND, "blocks", *words], check=True, capture_output=True, text=True)


def files_of(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in pathlib.Path(folder).rglob("*.blk")
    }


@pytest.fixture(scope="module", name="image")
def an_image(tmp_path_factory):
    path = tmp_path_factory.mktemp("image") / "chain.ome.zarr"
    subprocess.run(
        [COMMAND, "phantom", "chain", "--size", "250,160,160", "--spacing", "0.64,1,1", "--type", "u8",
         "-o", path],
        check=True,
    )
    return path


@pytest.fixture(scope="module", name="here")
def by_the_command(image, tmp_path_factory):
    """The folder of the same run in one process."""
    folder = tmp_path_factory.mktemp("run") / "here"
    words = [f"--{name.replace('_', '-')}={value}" for name, value in PLAN.items()]
    blocks("plan", image, "-o", folder, "--iso=127", "--no-sleeping", *words)
    blocks("run", folder)
    return folder


@pytest.fixture(name="client")
def a_cluster():
    with (
        dask.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, memory_limit="1GiB"
        ) as cluster,
        dask.Client(cluster) as client,
    ):
        yield client


def extract(image, client, folder, **changes):
    return pellicle.distributed.extract(
        image, client, folder, 127, command=COMMAND, sleeping=False, **PLAN, **changes
    )


def test_workers_make_the_bytes_of_one_process(image, here, client, tmp_path):
    told = []
    surface = extract(
        image, client, tmp_path / "run", progress=lambda *values: told.append(values), space="ras"
    )
    assert files_of(tmp_path / "run") == files_of(here)
    assert surface.check().valid and surface.space == "ras"
    assert [done for done, _, _ in told] == list(range(25))
    assert {total for _, total, _ in told} == {24}
    assert told[0][2] is None and told[-1][2] == 0
    assert all(seconds > 0 for _, _, seconds in told[1:-1])
    # As the command writes it.
    blocks("mesh", here, "-o", tmp_path / "here.ply", "--space=ras")
    checked = json.loads(subprocess.check_output([COMMAND, "info", tmp_path / "here.ply", "--json"]))
    assert surface.vertex_count == checked["vertices"]
    # Processes are kept from task to task, and end with the call.
    assert set(client.run(lambda: len(pellicle._block_worker._idle)).values()) == {0}
    # What is done is not done again; a scheduler may be named by its address.
    told.clear()
    address = client.scheduler.address
    folder = extract(
        image, address, tmp_path / "run", progress=lambda *values: told.append(values), collect=False
    )
    assert told == [(24, 24, 0)] and folder == tmp_path / "run"


def test_a_worker_that_is_killed_costs_no_more_than_its_task(image, here, client, tmp_path):
    pids = client.run(os.getpid)
    killed = []

    def kill(done, total, seconds):
        busy = [address for address, keys in client.processing().items() if keys]
        if done > 0 and busy and not killed:  # one is at work yet of the two of a step
            killed.append(pids[busy[0]])
            os.kill(killed[0], signal.SIGKILL)

    assert extract(image, client, tmp_path / "run", progress=kill, collect=False).is_dir()
    assert killed and killed[0] not in client.run(os.getpid).values()
    assert files_of(tmp_path / "run") == files_of(here)
    assert not list((tmp_path / "run").rglob(".*")), "something half-written is left"


def test_what_cannot_be_done_is_told_in_one_line(image, client, tmp_path):
    def refused(error, match, **changes):
        values = {"image": image, "client": client, "folder": tmp_path / "run", "iso": 127,
                  "command": COMMAND, **PLAN, **changes}  # fmt: skip
        with pytest.raises(error, match=match) as caught:
            pellicle.distributed.extract(**values)
        assert "\n" not in str(caught.value)

    refused(pellicle.InvalidArgument, "no such file", image=tmp_path / "none.ome.zarr")
    refused(pellicle.InvalidArgument, "iso 5000: outside", iso=5000)
    refused(pellicle.InvalidArgument, "iso: must be given", iso=None)
    refused(pellicle.InvalidArgument, "--side 20: must be", side=20)
    refused(pellicle.PellicleError, "none/pellicle: the command cannot be run", command="none/pellicle")
    refused(ValueError, "force: cannot be told", force="gradient")
    refused(ValueError, "must both be given", window_low=3)
    refused(TypeError, "did you mean curvature", curvture=1)
    refused(ValueError, "space 'mni'", space="mni")


def test_a_task_that_fails_ends_the_call(image, here, client, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(here, folder)
    damaged = folder / "level1" / "0-0-0.blk"
    damaged.write_bytes(damaged.read_bytes()[:100])
    for path in (folder / "level0").glob("*.blk"):
        path.unlink()
    with pytest.raises(pellicle.PellicleError, match="0-0-0.blk: is no file of blocks"):
        extract(image, client, folder, collect=False, retries=1)
    damaged.unlink()
    extract(image, client, folder, collect=False)
    assert files_of(folder) == files_of(here)


def test_parameters_become_options_of_the_command():
    options = pellicle.distributed._options(
        "otsu",
        {"curvature": np.float32(0.5), "levels": 2, "level_iso": (1, 2.5, 3), "inside_below": True,
         "window_low": 0, "window_high": 255, "pad_value": 1, "rest_length": "value",
         "rest_length_value": 0.25, "late_bubbles": False, "epsilon": 1e-7,
         "mesh": "adaptive", "edge_min": 0.5, "edge_max": 2},
    )  # fmt: skip
    assert options == [
        "--iso=otsu", "--level-iso=1,2.5,3", "--levels=2", "--mesh=adaptive", "--curvature=0.5",
        "--epsilon=1e-07", "--inside=below", "--window=0,255", "--edge-range=0.5,2", "--pad=1", "--rest-length=0.25", "--no-late-bubbles",
    ]  # fmt: skip
