"""Pictures: colours, depth, normals, numbers and bounds as arrays."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, Ints, thread_count
from ._camera import Camera
from ._results import Hits
from ._scene import Scene, Watch


class Picture(np.ndarray[Any, np.dtype[np.float64]]):
    """A picture: an array (height, width, 3) of light, red, green and blue, row 0 at the top, that notebooks show.

    It is made by `durer.render` and is an ordinary NumPy array otherwise.

    Examples
    --------
    >>> import durer
    >>> picture = durer.render(durer.Scene([durer.Sphere((0, 0, 0), 1)]), durer.Camera((0, 0, 5), (0, 0, 0), width=8, height=6))
    >>> picture.shape, picture.dtype
    ((6, 8, 3), dtype('float64'))
    """

    def to_bytes(self) -> npt.NDArray[np.uint8]:
        """The pixels as an 8-bit sRGB file holds them: uint8, (height, width, 3)."""
        light = np.ascontiguousarray(np.asarray(self, dtype=np.float64).reshape(-1, 3))
        return _native.Scene.bytes_of(light).reshape(self.shape)

    def png(self) -> bytes:
        """The picture as a PNG file."""
        import struct
        import zlib

        pixels = self.to_bytes()
        height, width, _ = pixels.shape

        def chunk(kind: bytes, data: bytes) -> bytes:
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        rows = np.zeros((height, 1 + 3 * width), np.uint8)
        rows[:, 1:] = pixels.reshape(height, -1)
        header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
        body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b"")
        return b"\x89PNG\r\n\x1a\n" + body

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture as a PNG file; its name must end in .png."""
        if not os.fspath(path).lower().endswith(".png"):
            raise ValueError(f"the name must end in .png, got {os.fspath(path)!r}")
        with open(path, "wb") as file:
            file.write(self.png())

    def _repr_png_(self) -> bytes | None:
        return self.png() if self.ndim == 3 and self.shape[-1] == 3 else None


def render(
    scene: Scene,
    camera: Camera | None = None,
    *,
    anti_aliasing: str = "off",
    threshold: float = 0.3,
    depth: int = 3,
    region: tuple[int, int, int, int] | None = None,
    threads: int | None = None,
    progress: Watch = False,
) -> Picture:
    """A picture of a scene.

    Parameters
    ----------
    scene : Scene
    camera : Camera, optional
        Who looks; by default the scene's camera, or one that frames everything.
    anti_aliasing : "off", "method1" or "method2"
        How rays are spread over pixels, with a threshold and a depth (see ``durer render --aa``).
    region : (x0, y0, x1, y1), optional
        Only these pixels, half open, from the top left; the rest is black.
    threads, progress
        As for `Scene.closest`.

    Returns
    -------
    Picture
        float64 (height, width, 3): light, 0 to 1 and above; `Picture.save` writes a PNG file.

    Examples
    --------
    >>> import durer
    >>> ball = durer.Sphere((0, 0, 0), 1).with_texture(durer.Texture((1, 0.5, 0)))
    >>> picture = durer.render(durer.Scene([ball]), durer.Camera((0, 0, 5), (0, 0, 0), width=32, height=24))
    >>> picture.shape, bool(picture[12, 16, 0] > 0.3), float(picture[0, 0].sum())
    ((24, 32, 3), True, 0.0)
    """
    seen, view = _seen(scene, camera)
    watch: Any = None
    bar: Any = None
    if callable(progress):
        watch = progress
    elif progress:
        try:
            from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]

            bar = tqdm(total=view.width * view.height, unit="pixel", unit_scale=True)

            def watch(done: int, total: int) -> None:
                bar.update(done - bar.n)

        except ImportError:
            pass
    try:
        light = seen.render(
            view.width,
            view.height,
            (anti_aliasing, float(threshold), int(depth)),
            None if region is None else [int(edge) for edge in region],
            thread_count(threads),
            watch,
        )
    finally:
        if bar is not None:
            bar.close()
    return light.reshape(view.height, view.width, 3).view(Picture)


def _seen(scene: Scene, camera: Camera | None) -> tuple[_native.Scene, Camera]:
    """The scene with a camera and light."""
    own = scene.camera
    view = camera or own or scene.view()
    if view is None:
        raise ValueError("the scene has no camera, and none can frame what has no end or is not there")
    lights = []
    if not scene._native.has_lights:
        # Behind the left shoulder.
        scale = float(np.linalg.norm(view.direction)) or 1.0
        place = np.array(view.location) + scale * (0.5 * np.array(view.up) - 0.5 * np.array(view.right))
        lights.append((tuple(place.tolist()), (1.0, 1.0, 1.0)))
    if view is own and not lights:
        return scene._native, view
    return scene._native.seen_by(view._native, lights), view


def _image(scene: Scene, camera: Camera | None, threads: int | None) -> tuple[Hits, tuple[int, int]]:
    view = camera or scene.camera or scene.view()
    if view is None:
        raise ValueError("the scene has no camera, and none can frame what has no end or is not there")
    return scene.closest(view.rays(), threads=threads), (view.height, view.width)


def depth_image(scene: Scene, camera: Camera | None = None, *, threads: int | None = None) -> Floats:
    """t of the first hit through each pixel, (height, width): the depth along the view; inf where nothing is.

    Examples
    --------
    >>> import durer
    >>> camera = durer.Camera((0, 0, 5), (0, 0, 0), width=3, height=3)
    >>> float(durer.depth_image(durer.Scene([durer.Sphere((0, 0, 0), 1)]), camera)[1, 1])
    4.0
    """
    hits, size = _image(scene, camera, threads)
    return hits.t.reshape(size)


def normal_image(scene: Scene, camera: Camera | None = None, *, threads: int | None = None) -> Floats:
    """The unit normal of the first hit through each pixel, (height, width, 3); NaN where nothing is.

    Examples
    --------
    >>> import durer
    >>> durer.normal_image(durer.Scene([durer.Sphere((0, 0, 0), 1)]), durer.Camera((0, 0, 5), (0, 0, 0), width=8, height=6)).shape
    (6, 8, 3)
    """
    hits, size = _image(scene, camera, threads)
    return hits.normal.reshape(*size, 3)


def object_image(scene: Scene, camera: Camera | None = None, *, threads: int | None = None) -> Ints:
    """The number of the object seen through each pixel, (height, width); -1 where nothing is.

    Examples
    --------
    >>> import durer
    >>> durer.object_image(durer.Scene([durer.Sphere((0, 0, 0), 1)]), durer.Camera((0, 0, 5), (0, 0, 0), width=5, height=1)).tolist()
    [[-1, -1, 0, -1, -1]]
    """
    hits, size = _image(scene, camera, threads)
    return hits.object.reshape(size)


def bound_image(scene: Scene, camera: Camera | None = None, *, threads: int | None = None) -> Floats:
    """How far the exact t of the first hit can be from the given one, (height, width); NaN where nothing is.

    Examples
    --------
    >>> import durer
    >>> durer.bound_image(durer.Scene([durer.Sphere((0, 0, 0), 1)]), durer.Camera((0, 0, 5), (0, 0, 0), width=5, height=1))[0, 2] < 1e-13
    np.True_
    """
    hits, size = _image(scene, camera, threads)
    with np.errstate(invalid="ignore"):
        width: Floats = np.maximum(hits.t - hits.t_lo, hits.t_hi - hits.t)
    return width.reshape(size)
