"""What type checkers see of the module: read by mypy --strict, never run.

Where a line is marked the checker must refuse it: a mark that is not needed is an error, too.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import pellicle


def watch(progress: pellicle.Progress) -> None:
    level: int = progress.level
    print(level, progress.fraction)


def validate(report: pellicle.LevelReport, surface: pellicle.Surface) -> pellicle.Verdict | None:
    return "more" if report.energy > 1 and surface.check().valid else None


def push(points: pellicle.ForcePoints) -> npt.NDArray[np.float32]:
    return points.normals * np.float32(0.1)


def sample(image: npt.NDArray[np.int16]) -> npt.NDArray[np.float32]:
    context = pellicle.Context(threads=2, simd="avx2", log=lambda level, line: print(level, line))
    surface = pellicle.extract(
        image, 100, spacing=(1, 1, 2), order="xyz", progress=watch, level=validate,
        extra_force=push, context=context, seeds=[[1, 2, 3, 4]], curvature=0.1,
    )
    geometry = pellicle.geometry_from_affine(np.eye(4))
    pellicle.extract(image, parameters=pellicle.Parameters(iso=3, init="bubble"), **geometry)
    faces: npt.NDArray[np.uint32] = surface.in_space("ras").faces
    run = pellicle.Run(pellicle.Pyramid(pellicle.Volume(image), 100))
    state: bytes = run.save()
    done: bool = run.iterate(3)
    area: float = pellicle.component_measures((surface.vertices, faces)).whole.area
    vertex: int | None = pellicle.nearest_vertex(surface, [0, 0, 0])
    print(state, done, area, vertex, surface.hash + 1)

    image_of_file: pellicle.Image = pellicle.read("head.nii.gz")
    threshold: float = pellicle.threshold_otsu(image_of_file)
    surfaces: dict[int, pellicle.Surface] = pellicle.extract_labels(image_of_file, curvature=0.1)
    surfaces[1].save("one.ply")
    print(threshold, surface.area + surface.volume, surface.bounds, surface.components[0].area)
    pellicle.Run(pellicle.Pyramid(pellicle.Volume(image), 100, levels=2), iso=100, spring=0.1)

    pellicle.extract(image, 100, mesh="adaptive", tolerance=0.1)
    pellicle.extract(image, 100, mesh="adaptve")  # type: ignore[arg-type]
    pellicle.extract(image, 100, curvture=1)  # type: ignore[call-arg]
    pellicle.extract(image, 100, curvature="much")  # type: ignore[arg-type]
    pellicle.extract(image, 100, force="isso")  # type: ignore[arg-type]
    pellicle.extract_labels(image, curvture=1)  # type: ignore[call-arg]
    pellicle.Pyramid(pellicle.Volume(image), 100, levls=2)  # type: ignore[call-arg]
    pellicle.Parameters().replace(curvture=1)  # type: ignore[call-arg]
    pellicle.Parameters(init="bubbel")  # type: ignore[arg-type]
    pellicle.Parameters(curvatur=1)  # type: ignore[call-arg]
    pellicle.extract(image, 100, order="xzy")  # type: ignore[arg-type]
    pellicle.extract(image, 100, progress=3)  # type: ignore[arg-type]
    pellicle.extract(image, 100, level=watch)  # type: ignore[arg-type]
    surface.scalars("mean")  # type: ignore[arg-type]
    surface.hash = 3  # type: ignore[misc]
    text: str = run.save()  # type: ignore[assignment]
    surface.check().valid = True  # type: ignore[misc]
    pellicle.Context(threads="all")  # type: ignore[arg-type]
    print(text)
    return surface.vertices
