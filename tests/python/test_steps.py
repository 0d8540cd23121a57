"""Volumes, pyramids and runs."""

import gc
import weakref

import numpy as np
import pytest
from scenes import ball, octahedron, pill

import pellicle


def test_a_volume_refers_to_the_array_where_x_is_fastest():
    context = pellicle.Context()
    image = np.zeros((60, 70, 80), np.int16)
    image[20:40, 20:40, 20:40] = 100
    before = context.memory.now
    volume = pellicle.Volume(image, context=context)
    assert volume.borrowed
    assert context.memory.now - before < image.nbytes / 10
    assert np.shares_memory(volume.voxels, image)
    assert volume.voxels.shape == image.shape and volume.voxels.strides == image.strides
    assert not volume.voxels.flags.writeable
    assert volume.range() == (0, 100)
    image[0, 0, 0] = -7
    assert volume.voxels[0, 0, 0] == -7

    turned = pellicle.Volume(image.transpose(), order="xyz", context=context)
    assert turned.borrowed and np.shares_memory(turned.voxels, image)
    assert turned.voxels.shape == (80, 70, 60)


def test_a_volume_copies_where_it_must_or_is_asked_to():
    context = pellicle.Context()
    image = pill().astype(np.float32)
    before = context.memory.now
    volume = pellicle.Volume(image, copy=True, context=context)
    assert not volume.borrowed and not np.shares_memory(volume.voxels, image)
    assert context.memory.now - before >= image.nbytes
    image[0, 0, 0] = 17
    assert volume.voxels[0, 0, 0] == 0
    for other in (image[:, :, ::-1], np.asfortranarray(image), image.astype(np.float64)):
        strided = pellicle.Volume(other, context=context)
        assert not strided.borrowed
        assert np.array_equal(strided.voxels, other.astype(np.float32))


def test_booleans_are_not_copied():
    inside = ball() > 0.5
    volume = pellicle.Volume(inside)
    assert volume.borrowed and volume.voxels.dtype == np.uint8


def test_the_memory_of_a_volume_goes_with_it():
    context = pellicle.Context()
    before = context.memory.now
    volume = pellicle.Volume(pill(), copy=True, context=context)
    assert context.memory.now > before
    del volume
    assert context.memory.now == before
    assert context.memory.peak > before


def test_what_refers_to_an_array_keeps_it():
    image = ball()
    alive = weakref.ref(image)
    volume = pellicle.Volume(image)
    assert volume.borrowed
    del image
    pyramid = pellicle.Pyramid(volume, 0.5, levels=1)
    voxels = volume.voxels
    del volume
    gc.collect()
    assert alive() is not None
    assert voxels.max() == 1
    del voxels
    run = pellicle.Run(pyramid)
    del pyramid
    gc.collect()
    assert alive() is not None
    surface = run.finish()
    assert surface.hash == pellicle.extract(ball(), 0.5, levels=1).hash
    del run
    gc.collect()
    assert alive() is None
    assert surface.vertices.shape[0] == surface.vertex_count


def test_pyramids_tell_their_levels():
    pyramid = pellicle.Pyramid(pellicle.Volume(pill(), spacing=(1, 1, 2)), 100, levels=2)
    levels = pyramid.levels
    assert len(levels) == 3
    assert levels[0].spacing == pytest.approx((1, 1, 2))
    assert levels[0].unit < levels[1].unit < levels[2].unit
    for h, level in enumerate(levels):
        values = pyramid.values(h)
        assert values.shape == level.dims[::-1]
        assert values.dtype == np.float32 and 0 <= values.min() and values.max() <= 1
    assert pyramid.parameters.levels == 2
    assert pyramid.parameters.level_iso == tuple(level.iso for level in reversed(levels))
    assert pyramid.parameters.level_iso[-1] == 100 != pyramid.parameters.level_iso[0]
    turned = pellicle.Pyramid(
        pellicle.Volume(pill().transpose(), order="xyz", spacing=(1, 1, 2)), 100, levels=2
    )
    assert turned.values(1).shape == levels[1].dims
    assert np.array_equal(turned.values(1), pyramid.values(1).transpose())
    with pytest.raises(pellicle.InvalidArgument):
        pyramid.values(3)


@pytest.fixture(scope="module")
def pyramid():
    return pellicle.Pyramid(pellicle.Volume(pill()), 100, levels=2)


@pytest.fixture(scope="module")
def expected():
    return pellicle.extract(pill(), 100, levels=2).hash


def test_a_run_is_an_extraction_in_any_steps(pyramid, expected):
    assert pellicle.Run(pyramid).finish().hash == expected

    run = pellicle.Run(pyramid)
    assert not run.done and run.progress.iteration == 0
    iterations = 0
    while not run.iterate():
        iterations += 1
        if iterations % 20 == 0:
            assert run.surface().check().valid
    assert iterations > 10 and run.done
    assert run.surface().hash == expected
    assert run.progress.level == 0 and run.progress.vertices == run.surface().vertex_count
    assert run.iterate() and run.finish().hash == expected

    levels = pellicle.Run(pyramid)
    assert not levels.next_level() and levels.between_levels
    assert levels.iterate(5) is False and not levels.between_levels
    assert levels.finish().hash == expected


def test_runs_may_differ_in_what_the_pyramid_does_not_read(pyramid, expected):
    run = pellicle.Run(pyramid, curvature=0.1)
    assert run.finish().parameters.curvature == 0.1
    assert run.surface().hash != expected
    with pytest.raises(ValueError):
        pellicle.Run(pyramid, iso=50)


def test_a_saved_run_goes_on_to_the_same_bits(pyramid, expected):
    run = pellicle.Run(pyramid)
    run.iterate(7)
    state = run.save()
    assert isinstance(state, bytes) and len(state) > 1000
    assert run.save() == state
    other = pellicle.Run.restore(pyramid, state, context=pellicle.Context(threads=1, simd="scalar"))
    assert other.surface().hash == run.surface().hash
    assert run.finish().hash == expected
    assert other.finish().hash == expected
    # Another pyramid of the same image.
    again = pellicle.Pyramid(pellicle.Volume(pill()), 100, levels=2)
    assert pellicle.Run.restore(again, state).finish().hash == expected


def test_what_is_no_state_of_the_run_is_refused(pyramid):
    run = pellicle.Run(pyramid)
    run.iterate(3)
    state = run.save()
    for wrong in (b"", b"nonsense", state[:-1], state[: len(state) // 2]):
        with pytest.raises(pellicle.InvalidData):
            pellicle.Run.restore(pyramid, wrong)
    altered = bytearray(state)
    altered[len(state) // 2] ^= 1
    with pytest.raises(pellicle.InvalidData):
        pellicle.Run.restore(pyramid, bytes(altered))
    with pytest.raises(pellicle.InvalidData):
        pellicle.Run.restore(pyramid, state, curvature=0.11)


def test_a_run_takes_starts_and_masks_in_the_order_of_its_volume():
    image = pill()
    mask = image > 120
    expected = pellicle.extract(image, 100, mask=mask, levels=0).hash
    volume = pellicle.Volume(image.transpose(), order="xyz")
    run = pellicle.Run(pellicle.Pyramid(volume, 100, levels=0), mask=mask.transpose())
    assert run.finish().hash == expected
    saved = pellicle.Run(pellicle.Pyramid(volume, 100, levels=0), mask=mask.transpose())
    saved.iterate(2)
    other = pellicle.Run.restore(
        pellicle.Pyramid(volume, 100, levels=0), saved.save(), mask=mask.transpose()
    )
    assert other.finish().hash == expected


def test_a_run_gives_its_surface_in_its_space():
    volume = pellicle.Volume(pill(), origin=(100, 200, 300))
    run = pellicle.Run(pellicle.Pyramid(volume, 100, levels=0), space="voxel")
    run.iterate()
    assert run.surface().space == "voxel" and run.surface().vertices.max() < 60


def test_a_mesh_becomes_a_surface():
    vertices, faces = octahedron(5)
    surface = pellicle.Surface.from_mesh(vertices, faces, space="ras")
    assert surface.space == "ras"
    assert surface.vertices == pytest.approx(vertices.astype(np.float32))
    assert surface.check().valid and surface.levels == ()
    assert surface.measures().volume == pytest.approx(4 / 3 * 125)
    with pytest.raises(pellicle.InvalidData):
        pellicle.Surface.from_mesh(vertices, faces[:, ::-1])
    with pytest.raises(pellicle.InvalidData):
        pellicle.Surface.from_mesh(vertices, faces[1:])
    with pytest.raises(TypeError):
        pellicle.Surface()
