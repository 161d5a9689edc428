"""Stands in for trimesh's ray classes: ``mesh.ray = durer.trimesh.RayMeshIntersector(mesh)``.

trimesh itself is not needed: a mesh is anything with ``vertices``, ``faces``, ``is_watertight`` and a hash that changes with them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Floats, Ints, table
from ._mesh import Mesh
from ._results import AllHits, Hits
from ._scene import Scene

__all__ = ["RayMeshIntersector", "install"]

#: Of a mesh that is not closed: points from which most of these directions cross it an odd number of times both ways are inside.
_PROBES = ((0.4395064455, 0.617598629942, 0.652231566745), (0.83, -0.27, 0.49), (-0.31, 0.52, 0.79))


#: A dot product with a unit normal whose components are rounded is off by less than this part of the other vector.
_ROUNDING = 16 * 2.0**-53


def _runs_along(hits: Hits | AllHits, directions: Floats) -> Bools:
    """Which hits are touches of rays that run along a face: by trimesh's convention these miss."""
    along: Bools = hits.kind == 1
    # Normals cost more than all the rest, and touches are rare.
    if along.any():
        rows = (directions[hits.ray] if isinstance(hits, AllHits) else directions)[along]
        slope = np.abs(np.einsum("ij,ij->i", hits.normal[along], rows))
        along[along] = slope <= _ROUNDING * np.abs(rows).max(axis=1)
    return along


class RayMeshIntersector:
    """Trimesh's interface over durer: float64 throughout, all hits in one pass, no limit on their number.

    Parameters
    ----------
    geometry : trimesh.Trimesh
        The mesh. Changes of it are seen.
    scale_to_box : bool
        Accepted as trimesh's own class accepts it; nothing depends on it.
    threads : int, optional
        How many threads work; by default one for each processor.

    Rays are arrays or lists (n, 3) of origins and of directions of any length; only hits with t >= 0 count, and rays
    that are not finite miss. Rows of answers are in the order of the rays and, for each ray, of its hits along it. A ray
    through a shared edge or vertex has one hit there, also if it only touches the mesh; a ray along a face has none.

    Examples
    --------
    >>> import trimesh, durer.trimesh
    >>> box = trimesh.creation.box()
    >>> box.ray = durer.trimesh.RayMeshIntersector(box)
    >>> box.ray.intersects_location([[0.1, 0.2, 5]], [[0, 0, -1]])[0]
    array([[ 0.1,  0.2,  0.5],
           [ 0.1,  0.2, -0.5]])
    >>> box.contains([[0, 0, 0], [0, 0, 3]])
    array([ True, False])
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True, threads: int | None = None) -> None:
        self.mesh = geometry
        self._scale_to_box = scale_to_box
        self.threads = threads
        self._built: tuple[Any, Scene] | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_built": None}

    def __deepcopy__(self, memo: Any = None) -> RayMeshIntersector:
        return self.__copy__()

    def __copy__(self, *_: Any) -> RayMeshIntersector:
        return type(self)(self.mesh, self._scale_to_box, self.threads)

    def copy(self) -> RayMeshIntersector:
        """Another intersector of the same mesh."""
        return self.__copy__()

    def _scene(self) -> Scene:
        """The scene of the mesh as it is now."""
        key = hash(self.mesh)
        if self._built is None or self._built[0] != key:
            vertices = np.asarray(self.mesh.vertices, dtype=np.float64)
            faces = np.asarray(self.mesh.faces, dtype=np.int64)
            # A sheet: rays alone are asked for, and whether a mesh closes takes as long as building its tree.
            mesh = Mesh(vertices.reshape(-1, 3), faces.reshape(-1, 3), solid=False)
            self._built = (key, Scene([mesh]))
        return self._built[1]

    def intersects_location(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        **kwargs: Any,
    ) -> tuple[Floats, Ints, Ints]:
        """The points of hits, and the ray and the triangle of each.

        Returns
        -------
        locations : float64 (h, 3)
        index_ray : int64 (h,)
        index_tri : int64 (h,)
        """
        index_tri, index_ray, locations = self.intersects_id(
            ray_origins, ray_directions, multiple_hits=multiple_hits, return_locations=True, **kwargs
        )
        return locations, index_ray, index_tri

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        return_locations: bool = False,
        **kwargs: Any,
    ) -> Any:
        """The triangle and the ray of each hit, and its point if that is wanted.

        Parameters
        ----------
        multiple_hits : bool
            All hits of each ray, or the first.
        max_hits : int, optional
            The first so many of each ray at most; all of them by default.

        Returns
        -------
        index_tri : int64 (h,)
        index_ray : int64 (h,)
        locations : float64 (h, 3), if `return_locations`
        """
        scene = self._scene()
        origins, directions = table(ray_origins, 3, "ray_origins"), table(ray_directions, 3, "ray_directions")
        threads = self.threads or None
        if not multiple_hits:
            first = scene.closest(origins, directions, threads=threads)
            if not _runs_along(first, directions).any():
                index_ray = np.nonzero(first.hit)[0]
                index_tri = first.primitive[index_ray]
                return (index_tri, index_ray, first.position[index_ray]) if return_locations else (index_tri, index_ray)
            max_hits = 1
        hits = scene.all(origins, directions, threads=threads)
        keep = ~_runs_along(hits, directions)
        if max_hits is not None:
            # The number of each hit among those of its ray that are kept.
            before = np.concatenate([[0], np.cumsum(keep)])
            keep &= before[:-1] - before[hits.offsets[:-1]][hits.ray] < max_hits
        rows: Any = slice(None) if keep.all() else keep
        index_tri, index_ray = hits.primitive[rows], hits.ray[rows]
        return (index_tri, index_ray, hits.position[rows]) if return_locations else (index_tri, index_ray)

    def intersects_first(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, **kwargs: Any
    ) -> Ints:
        """The triangle that each ray hits first, -1 if it misses: int64 (n,)."""
        scene = self._scene()
        origins, directions = table(ray_origins, 3, "ray_origins"), table(ray_directions, 3, "ray_directions")
        triangles, may_run_along = scene._closest_ids(origins, directions, self.threads or None)[1:]
        if may_run_along:
            first, ray = self.intersects_id(origins, directions, multiple_hits=False)[:2]
            triangles[:] = -1
            triangles[ray] = first
        return triangles

    def intersects_any(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, **kwargs: Any
    ) -> Bools:
        """Whether each ray hits anything, a face that it runs along included: bool (n,)."""
        scene = self._scene()
        return scene.any(ray_origins, ray_directions, threads=self.threads or None)

    def contains_points(self, points: npt.ArrayLike) -> Bools:
        """Whether each point lies inside the mesh, by the parity of crossings: bool (n,). Exact for points off a closed mesh."""
        scene = self._scene()
        rows = table(points, 3, "points")
        if self.mesh.is_watertight:
            along = np.broadcast_to(_PROBES[0], rows.shape)
            return self._odd(scene, rows, along)
        votes = np.zeros(len(rows), dtype=np.int64)
        for probe in _PROBES:
            both = np.ones(len(rows), dtype=np.bool_)
            for sign in (1.0, -1.0):
                along = np.broadcast_to(np.multiply(probe, sign), rows.shape)
                both &= self._odd(scene, rows, along)
            votes += both
        inside: Bools = votes * 2 > len(_PROBES)
        return inside

    def _odd(self, scene: Scene, points: Floats, along: npt.NDArray[Any]) -> Bools:
        """Whether each ray crosses the mesh an odd number of times; touches do not count."""
        odd: Bools = scene.all(points, along, threads=self.threads or None).crossings() % 2 == 1
        return odd

    def __repr__(self) -> str:
        return f"<durer.trimesh.RayMeshIntersector of {self.mesh!r}>"


def install() -> None:
    """Makes this class the one that new trimesh meshes get as ``mesh.ray``."""
    import importlib

    ray: Any = importlib.import_module("trimesh.ray")
    ray.ray_triangle.RayMeshIntersector = RayMeshIntersector
    if ray.has_embree:
        ray.ray_pyembree.RayMeshIntersector = RayMeshIntersector
