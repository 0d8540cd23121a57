"""The tasks of a plan by two workers of Dask: blocks_by_dask.py PELLICLE DIR IMAGE SIDE.

The Python package is that of the build of PELLICLE.
"""

import pathlib
import sys
import tempfile

import distributed


def package(command: str, folder: str) -> None:
    """The package and its extension side by side, as they are when installed."""
    sources = pathlib.Path(__file__).resolve().parents[2] / "tools/python/pellicle"
    built = pathlib.Path(command).parent / "python"
    to = pathlib.Path(folder) / "pellicle"
    to.mkdir()
    for path in [*sources.iterdir(), *built.glob("_pellicle*.so")]:
        (to / path.name).symlink_to(path)


def main() -> None:
    command, folder, image, side = sys.argv[1:]
    with tempfile.TemporaryDirectory() as path:
        package(command, path)
        sys.path.insert(0, path)
        import pellicle.distributed

        with (
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            pellicle.distributed.extract(
                image,
                client,
                folder,
                127.5,
                side=int(side),
                command=command,
                memory="3G",
                collect=False,
            )


if __name__ == "__main__":
    main()
