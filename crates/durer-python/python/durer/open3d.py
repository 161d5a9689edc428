"""Stands in for Open3D's `open3d.t.geometry.RaycastingScene`: the same names, arrays and conventions, float64 inside.

Open3D itself is not needed: inputs are NumPy arrays or anything with ``numpy()``, answers are arrays that have ``numpy()``
too. Inputs that are Open3D's tensors are answered with Open3D's tensors. `compute_distance`, `compute_signed_distance` and
`compute_closest_points` are not here: they are no questions about rays.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Floats
from ._mesh import Mesh
from ._results import AllHits
from ._scene import Scene

__all__ = ["RaycastingScene", "Tensor"]

#: Directions of compute_occupancy, along no axis; one for each sample.
_PROBES = ((0.48, 0.6, 0.64), (-0.29, 0.83, 0.48), (0.73, -0.31, 0.61), (0.13, 0.57, -0.81), (-0.64, -0.52, 0.57))


class Tensor(np.ndarray[Any, np.dtype[Any]]):
    """An array with Open3D's method `numpy`."""

    def numpy(self) -> npt.NDArray[Any]:
        """The array itself."""
        return np.asarray(self)

    def cpu(self) -> Tensor:
        """The array itself."""
        return self


def _array(value: Any) -> npt.NDArray[Any]:
    if not isinstance(value, np.ndarray) and hasattr(value, "numpy"):
        value = value.numpy()
    return np.asarray(value)


def _like(value: Any, *arrays: npt.NDArray[Any]) -> list[Any]:
    """The arrays as tensors of the same library as `value`."""
    if type(value).__module__.partition(".")[0] == "open3d":
        import importlib

        core: Any = importlib.import_module("open3d.core")
        return [core.Tensor(np.ascontiguousarray(array)) for array in arrays]
    return [array.view(Tensor) for array in arrays]


class RaycastingScene:
    """Triangle meshes that rays are cast at.

    Parameters
    ----------
    nthreads : int
        How many threads work; 0 is one for each processor.
    device : optional
        Accepted as Open3D accepts it.

    Rays are arrays (.., 6), origin and direction; t is in units of the direction and starts at 0. Answers are float32, or
    float64 if the rays are. Rays that are not finite miss.

    Examples
    --------
    >>> import numpy as np, durer.open3d
    >>> scene = durer.open3d.RaycastingScene()
    >>> vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    >>> scene.add_triangles(vertices, np.array([[0, 1, 2]], np.uint32))
    0
    >>> answer = scene.cast_rays(np.array([[0.25, 0.25, 1, 0, 0, -2]], np.float32))
    >>> answer["t_hit"].numpy(), answer["primitive_normals"].numpy()
    (array([0.5], dtype=float32), array([[0., 0., 1.]], dtype=float32))
    """

    INVALID_ID = 4294967295

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        self._threads = int(nthreads)
        self._meshes: list[Mesh] = []
        self._built: Scene | None = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh: vertices (n, 3) and triangles (m, 3), or an Open3D TriangleMesh. Returns its geometry id: 0, 1, 2, ..."""
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions, triangle_indices = mesh.vertex.positions, mesh.triangle.indices
        self._meshes.append(Mesh(_array(vertex_positions), _array(triangle_indices), solid=False))
        self._built = None
        return len(self._meshes) - 1

    def _scene(self) -> Scene:
        if self._built is None:
            self._built = Scene(self._meshes)
        return self._built

    def _rays(self, rays: Any) -> tuple[Floats, tuple[int, ...], Any]:
        array = _array(rays)
        if array.ndim < 2 or array.shape[-1] != 6:
            raise ValueError(f"rays: shape (.., 6) with at least two dimensions is needed, got {array.shape}")
        if array.dtype.kind not in "fiu":
            raise ValueError(f"rays: real numbers are needed, got an array of dtype {array.dtype}")
        flat: Floats = array.reshape(-1, 6).astype(np.float64)
        kind = np.float64 if array.dtype == np.float64 else np.float32
        return flat, array.shape[:-1], kind

    def _workers(self, nthreads: int) -> int | None:
        return int(nthreads) or self._threads or None

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """The first hit of each ray.

        Returns
        -------
        dict
            ``t_hit`` (..), inf on a miss; ``geometry_ids`` and ``primitive_ids`` uint32 (..), INVALID_ID on a miss;
            ``primitive_uvs`` (.., 2) with p = (1 - u - v) v0 + u v1 + v v2; ``primitive_normals`` (.., 3), unit, from the
            winding; zero on a miss.
        """
        flat, shape, kind = self._rays(rays)
        hits = self._scene().closest(flat, threads=self._workers(nthreads))
        hit = hits.hit[:, None]
        arrays = {
            "t_hit": hits.t.astype(kind).reshape(shape),
            "geometry_ids": hits.object.astype(np.uint32).reshape(shape),
            "primitive_ids": hits.primitive.astype(np.uint32).reshape(shape),
            "primitive_uvs": np.where(hit, hits.parameters, 0.0).astype(kind).reshape(*shape, 2),
            "primitive_normals": np.where(hit, hits.normal, 0.0).astype(kind).reshape(*shape, 3),
        }
        return dict(zip(arrays, _like(rays, *arrays.values()), strict=True))

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"), nthreads: int = 0
    ) -> Any:
        """Whether each ray hits anything with t from tnear to tfar: bool (..)."""
        flat, shape, _ = self._rays(rays)
        hit = self._scene().any(flat, t_min=tnear, t_max=tfar, threads=self._workers(nthreads))
        return _like(rays, hit.reshape(shape))[0]

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """How many hits each ray has: int32 (..). A hit on an edge that triangles share counts once."""
        flat, shape, _ = self._rays(rays)
        counts = self._all(flat, nthreads).counts
        return _like(rays, counts.astype(np.int32).reshape(shape))[0]

    def _all(self, flat: Floats, nthreads: int) -> AllHits:
        return self._scene().all(flat, threads=self._workers(nthreads))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """All hits of each ray, in the order of the rays and ascending in t.

        Returns
        -------
        dict
            ``ray_splits`` uint32 (rays + 1,): where each ray's hits begin; ``ray_ids``, ``geometry_ids`` and
            ``primitive_ids`` uint32, ``t_hit`` and ``primitive_uvs``: a row for each hit.
        """
        flat, _, kind = self._rays(rays)
        hits = self._all(flat, nthreads)
        arrays = {
            "ray_splits": hits.offsets.astype(np.uint32),
            "ray_ids": hits.ray.astype(np.uint32),
            "t_hit": hits.t.astype(kind),
            "geometry_ids": hits.object.astype(np.uint32),
            "primitive_ids": hits.primitive.astype(np.uint32),
            "primitive_uvs": hits.parameters.astype(kind),
        }
        return dict(zip(arrays, _like(rays, *arrays.values()), strict=True))

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """1 for points (.., 3) inside a closed mesh, else 0, by the parity of crossings: float32 (..).

        `nsamples`, an odd number, is how many directions vote.
        """
        points = _array(query_points)
        if points.ndim < 1 or points.shape[-1] != 3:
            raise ValueError(f"query_points: shape (.., 3) is needed, got {points.shape}")
        if nsamples < 1 or nsamples % 2 == 0:
            raise ValueError(f"nsamples: an odd number is needed, got {nsamples}")
        flat = points.reshape(-1, 3).astype(np.float64)
        votes = np.zeros(len(flat), np.int64)
        for sample in range(nsamples):
            if sample < len(_PROBES):
                probe = np.asarray(_PROBES[sample])
            else:
                probe = np.random.default_rng(sample).normal(size=3)
            along = np.broadcast_to(probe, flat.shape)
            votes += self._all(np.hstack([flat, along]), nthreads).crossings() % 2
        inside = (2 * votes > nsamples).astype(np.float32).reshape(points.shape[:-1])
        return _like(query_points, inside)[0]

    @staticmethod
    def create_rays_pinhole(
        intrinsic_matrix: Any = None,
        extrinsic_matrix: Any = None,
        width_px: int = 0,
        height_px: int = 0,
        *,
        fov_deg: float | None = None,
        center: Any = None,
        eye: Any = None,
        up: Any = None,
    ) -> Any:
        """The rays of a pinhole camera: float32 (height_px, width_px, 6).

        With matrices K and [R t]: origins -R^T t, directions R^T K^-1 (x + 1/2, y + 1/2, 1), not normalised. Or with a
        horizontal angle in degrees, what is looked at, the eye and what is up: as Open3D has it, row 0 looks to -up.
        """
        if fov_deg is not None:
            target, start, top = (_array(v).astype(np.float64) for v in (center, eye, up))
            forward = target - start
            forward /= np.linalg.norm(forward)
            right = np.cross(forward, top)
            right /= np.linalg.norm(right)
            above = np.cross(right, forward)
            focal = 0.5 * width_px / np.tan(0.5 * np.deg2rad(fov_deg))
            intrinsic = np.array([[focal, 0, 0.5 * width_px], [0, focal, 0.5 * height_px], [0, 0, 1.0]])
            linear = np.stack([-right, above, forward])
            offset = -linear @ start
        else:
            intrinsic = _array(intrinsic_matrix).astype(np.float64)
            extrinsic = _array(extrinsic_matrix).astype(np.float64)
            if intrinsic.shape != (3, 3) or extrinsic.shape != (4, 4):
                raise ValueError(
                    f"matrices of shapes (3, 3) and (4, 4) are needed, got {intrinsic.shape} and {extrinsic.shape}"
                )
            linear, offset = extrinsic[:3, :3], extrinsic[:3, 3]
        y, x = np.mgrid[: int(height_px), : int(width_px)] + 0.5
        pixels = np.stack([x, y, np.ones_like(x)], axis=-1)
        rays = np.empty((int(height_px), int(width_px), 6), np.float32)
        rays[..., :3] = -linear.T @ offset
        rays[..., 3:] = pixels @ np.linalg.inv(intrinsic).T @ linear
        return _like(intrinsic_matrix if fov_deg is None else center, rays)[0]

    def __repr__(self) -> str:
        return f"<durer.open3d.RaycastingScene of {len(self._meshes)} meshes>"
