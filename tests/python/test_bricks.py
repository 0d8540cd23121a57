"""Volumes by bricks."""

import numpy as np
import pytest
from scenes import ball

import pellicle


class Shelf:
    """An array that is given slice by slice, and counts how often it is asked."""

    def __init__(self, values, chunks=None):
        self.values = values
        self.shape, self.dtype = values.shape, values.dtype
        self.asked = 0
        if chunks is not None:
            self.chunks = chunks

    def __getitem__(self, index):
        self.asked += 1
        return self.values[index]


@pytest.fixture(name="image")
def an_image():
    values = np.zeros((70, 60, 50), np.float32)
    values[5:45, 10:50, 5:45] = ball(40)
    return values


@pytest.mark.parametrize("order", ["zyx", "xyz"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.float16])
def test_bricks_give_the_bits_of_the_array(image, order, dtype):
    array = image.astype(dtype)
    expected = pellicle.extract(array, 0.5, order=order, spacing=(1, 1, 2))
    shelf = Shelf(array, chunks=(16, 20, 10))
    volume = pellicle.Volume.by_bricks(shelf, order=order, spacing=(1, 1, 2))
    surface = pellicle.extract(volume, 0.5)
    assert surface.hash == expected.hash
    assert np.array_equal(surface.bounds, expected.bounds)
    counts = volume.brick_counts
    assert counts.read == shelf.asked >= counts.bricks > 1
    pyramid = pellicle.Pyramid(volume, 0.5)
    assert pellicle.Run(pyramid).finish().hash == expected.hash
    with pytest.raises(pellicle.InvalidArgument, match="by bricks"):
        _ = volume.voxels
    with pytest.raises(TypeError, match="tells its order and geometry"):
        pellicle.extract(volume, 0.5, spacing=(1, 2, 3))


def test_a_map_of_a_file_within_little_memory(image, tmp_path):
    path = tmp_path / "image.npy"
    np.save(path, image)
    array = np.load(path, mmap_mode="r")
    volume = pellicle.Volume.by_bricks(array, brick=(16, 16, 16), cache=1)
    assert pellicle.extract(volume, 0.5).hash == pellicle.extract(image, 0.5).hash
    assert volume.brick_counts.bricks == 4 * 4 * 5


def test_what_the_array_raises_comes_out_of_the_call(image):
    class Broken(Shelf):
        def __getitem__(self, index):
            if self.asked > 3:
                raise OSError("the disk is gone")
            return super().__getitem__(index)

    volume = pellicle.Volume.by_bricks(Broken(image), brick=(16, 16, 16))
    with pytest.raises(OSError, match="the disk is gone"):
        pellicle.extract(volume, 0.5)

    class Short(Shelf):
        def __getitem__(self, index):
            return super().__getitem__(index)[1:]

    with pytest.raises(ValueError, match="other voxels"):
        pellicle.extract(pellicle.Volume.by_bricks(Short(image)), 0.5)


def test_arrays_that_are_not_read_by_bricks(image):
    with pytest.raises(TypeError, match="int64"):
        pellicle.Volume.by_bricks(image.astype(np.int64))
    with pytest.raises(ValueError, match="three axes"):
        pellicle.Volume.by_bricks(image[0])
    with pytest.raises(pellicle.InvalidArgument, match="16 to 4096"):
        pellicle.Volume.by_bricks(image, brick=(8, 16, 16))
    with pytest.raises(ValueError, match="three numbers"):
        pellicle.Volume.by_bricks(image, brick=(16, 16))
    with pytest.raises(pellicle.InvalidArgument, match="no bricks"):
        _ = pellicle.Volume(image).brick_counts
