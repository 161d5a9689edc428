"""Pictures: colours, depth, normals, numbers, bounds."""

import io
import pickle
import struct
import zlib

import numpy as np
import pytest

import durer

BALL = durer.Sphere((0, 0, 0), 1)
CAMERA = durer.Camera((0, 0, 5), (0, 0, 0), width=41, height=31)
SCENE = durer.Scene([BALL, durer.Plane((0, 1, 0), -1)], camera=CAMERA, lights=[durer.Light((5, 5, 5))])


def decoded(png):
    """The pixels of a PNG file as this package writes them."""
    width, height = struct.unpack(">II", png[16:24])
    start = png.index(b"IDAT") + 4
    length = struct.unpack(">I", png[start - 8 : start - 4])[0]
    rows = np.frombuffer(zlib.decompress(png[start : start + length]), np.uint8).reshape(height, 1 + 3 * width)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 3)


def test_a_picture_is_an_array_that_notebooks_show(tmp_path):
    picture = durer.render(SCENE)
    assert picture.shape == (31, 41, 3) and picture.dtype == np.float64 and isinstance(picture, np.ndarray)
    png = picture._repr_png_()
    assert np.array_equal(decoded(png), picture.to_bytes())
    picture.save(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == png
    with pytest.raises(ValueError, match="png"):
        picture.save(tmp_path / "a.jpg")
    assert SCENE._repr_png_().startswith(b"\x89PNG")
    assert durer.Scene([BALL])._repr_png_().startswith(b"\x89PNG")
    assert durer.Scene([durer.Plane((0, 1, 0))])._repr_png_() is None


def test_the_picture_does_not_depend_on_threads():
    assert np.array_equal(durer.render(SCENE, threads=1), durer.render(SCENE, threads=3))


def test_pictures_are_right_side_up_and_not_mirrored():
    red, blue = durer.Texture((1, 0, 0), ambient=1), durer.Texture((0, 0, 1), ambient=1)
    scene = durer.Scene(
        [durer.Sphere((1, 0, 0), 0.5).with_texture(red), durer.Sphere((0, 1, 0), 0.5).with_texture(blue)]
    )
    picture = durer.render(scene, CAMERA)
    rows, columns = np.nonzero(picture[..., 0] > picture[..., 2])
    assert columns.min() > 20 and abs(rows.mean() - 15) < 1
    rows, columns = np.nonzero(picture[..., 2] > picture[..., 0])
    assert rows.max() < 15 and abs(columns.mean() - 20) < 1


def test_images_of_depth_normals_numbers_and_bounds():
    depth, normals = durer.depth_image(SCENE), durer.normal_image(SCENE)
    numbers, bounds = durer.object_image(SCENE), durer.bound_image(SCENE)
    assert depth.shape == numbers.shape == bounds.shape == (31, 41) and normals.shape == (31, 41, 3)
    assert depth[15, 20] == 4 and normals[15, 20].tolist() == [0, 0, 1] and numbers[15, 20] == 0
    assert set(np.unique(numbers)) == {-1, 0, 1} and np.isinf(depth[numbers == -1]).all()
    assert np.isnan(bounds[numbers == -1]).all() and (bounds[numbers >= 0] < 1e-12).all()


def test_cameras_pickle_and_make_the_rays_of_the_picture():
    for camera in (CAMERA, durer.Camera((1, 2, 3), (0, 0, 0), up=(0, 0, 1), orthographic=4.0), CAMERA.sized(5, 7)):
        back = pickle.loads(pickle.dumps(camera))
        assert repr(back) == repr(camera) and np.array_equal(back.rays(), camera.rays())
        assert eval(repr(camera), vars(durer)).rays().shape == camera.rays().shape  # noqa: S307
    rays = CAMERA.rays().reshape(31, 41, 6)
    assert np.allclose(rays[15, 20], [0, 0, 5, 0, 0, -1]) and rays[0, 20, 4] > 0 and rays[15, 40, 3] > 0
    flat = durer.Camera((0, 0, 5), (0, 0, 0), orthographic=2.0, width=2, height=2).rays()
    assert np.allclose(flat[:, :2], [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]])
    assert np.allclose(flat[:, 3:], [0, 0, -1])


def test_progress_and_regions():
    told = []
    durer.render(SCENE, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (41 * 31, 41 * 31)
    part = durer.render(SCENE, region=(10, 5, 20, 15))
    assert np.array_equal(part[5:15, 10:20], durer.render(SCENE)[5:15, 10:20]) and part[20:].sum() == 0

    def stop(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        durer.render(SCENE, progress=stop)
