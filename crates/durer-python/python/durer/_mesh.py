"""Triangle meshes from arrays and files."""

from __future__ import annotations

import os
from typing import final

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, Ints, index_table, read_only, table
from ._objects import Object, Union


@final
class Mesh(Object):
    """Triangles over shared vertices.

    Parameters
    ----------
    vertices : array (n, 3)
        float64; others are converted.
    faces : array (m, 3)
        Whole numbers, the vertices of each face. Its normal is ``cross(v1 - v0, v2 - v0)``.
    normals, normal_faces : arrays (k, 3) and (m, 3), optional
        Normals for shading, and those of each face; without `normal_faces` they go with the vertices.
    uv, uv_faces : arrays (k, 2) and (m, 3), optional
        Texture coordinates, likewise.
    solid : bool, optional
        Whether the mesh bounds a solid (for `spans`, `contains` and solids of solids). By default that of a closed mesh.

    Faces without area, or with a vertex that is not finite, keep their numbers and are never hit.

    Examples
    --------
    >>> import durer
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> mesh = durer.Mesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> mesh
    <Mesh of 4 vertices and 4 faces, a solid>
    """

    __slots__ = ("_is_solid",)
    _is_solid: bool

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        normal_faces: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        uv_faces: npt.ArrayLike | None = None,
        solid: bool | None = None,
    ) -> None:
        points, corners = table(vertices, 3, "vertices"), index_table(faces, "faces")
        shading = None if normals is None else table(normals, 3, "normals")
        texture = None if uv is None else table(uv, 2, "uv")
        lists: list[Ints | None] = []
        for name, values, given in (("normals", shading, normal_faces), ("uv", texture, uv_faces)):
            if values is None:
                if given is not None:
                    raise ValueError(f"mesh: {name} are missing")
                lists.append(None)
                continue
            if given is None and len(values) != len(points):
                raise ValueError(f"mesh: {len(values)} {name} for {len(points)} vertices")
            of_faces = corners if given is None else index_table(given, f"{name} of faces")
            if len(of_faces) != len(corners):
                raise ValueError(f"mesh: {name} of {len(of_faces)} faces for {len(corners)} faces")
            lists.append(of_faces)
        arguments = (points, corners, shading, lists[0], texture, lists[1])
        native, is_solid = _native.mesh(*arguments, solid)
        # What is kept cannot be changed by others.
        kept = [None if a is None else a.copy() for a in arguments]
        read_only(kept)
        self._set(native, (*kept, is_solid))
        object.__setattr__(self, "_is_solid", is_solid)

    @property
    def vertices(self) -> Floats:
        """The vertices, shape (n, 3); read only."""
        vertices: Floats = self._arguments[0]
        return vertices

    @property
    def faces(self) -> Ints:
        """The vertices of each face, shape (m, 3); read only."""
        faces: Ints = self._arguments[1]
        return faces

    @property
    def is_solid(self) -> bool:
        """Whether the mesh bounds a solid."""
        return self._is_solid

    def __repr__(self) -> str:
        kind = "a solid" if self._is_solid else "a sheet"
        return f"<Mesh of {len(self.vertices)} vertices and {len(self.faces)} faces, {kind}>"


def read_mesh(path: str | os.PathLike[str], solid: bool | None = None) -> Object:
    """The mesh in an .obj, .ply, .stl, .gltf or .glb file: a `Mesh`, or a `Union` of placed ones where the file has several.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it cannot be read; it says where.

    Examples
    --------
    >>> import durer
    >>> import pathlib
    >>> file = pathlib.Path(getfixture("tmp_path")) / "part.obj"
    >>> _ = file.write_text("v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n")
    >>> durer.read_mesh(file)
    <Mesh of 3 vertices and 1 faces, a sheet>
    """
    if not os.path.exists(path):
        raise FileNotFoundError(f"there is no file {os.fspath(path)!r}")
    groups, placements, _ = _native.read_mesh(os.fspath(path))
    meshes = []
    for _, vertices, faces, normals, uv in groups:
        n, n_faces = normals or (None, None)
        t, t_faces = uv or (None, None)
        meshes.append(Mesh(vertices, faces, n, n_faces, t, t_faces, solid))
    identity = np.eye(3, 4).tolist()
    objects = [
        meshes[group] if rows == identity else meshes[group].placed(rows) for group, rows in placements
    ]
    return objects[0] if len(objects) == 1 else Union(*objects)
