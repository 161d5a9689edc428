"""Where does this ray meet that surface? Every crossing, once, with a proven bound: arrays in, arrays out.

>>> import durer
>>> import numpy as np
>>> ring = durer.Torus(2, 0.5)
>>> scene = durer.Scene([ring, durer.Box((-1, -1, -1), (1, 1, 1)) - durer.Sphere((0, 0, 0), 1.2)])
>>> origins = np.array([[-5.0, 0.0, 0.0], [-5.0, 0.9, 0.9]])
>>> directions = np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
>>> scene.closest(origins, directions).t
array([2.5, 4. ])
>>> scene.all(origins, directions).counts
array([4, 2])

`Scene` answers `closest`, `any`, `all`, `spans` and `contains`; `load` reads POV-Ray scenes and meshes; `render` makes
pictures. Submodules: `durer.trimesh` and `durer.open3d` stand in for the ray classes of these libraries.
"""

from __future__ import annotations

from . import _native
from ._basic import (
    Box,
    Cone,
    Cyclide,
    Cylinder,
    Disc,
    Ellipsoid,
    EllipticCone,
    EllipticCylinder,
    EllipticParaboloid,
    HyperbolicCylinder,
    HyperbolicParaboloid,
    HyperboloidOneSheet,
    HyperboloidTwoSheets,
    ParabolicCylinder,
    Parallelogram,
    Plane,
    Polygon,
    Polynomial,
    Quadric,
    Sphere,
    Torus,
    Triangle,
)
from ._camera import Camera
from ._fields import Blob, Ifs, Julia, Menger, Sierpinski, Superellipsoid
from ._formula import Expression, Formula, Parametric, formula, parametric, where
from ._mesh import Mesh, read_mesh
from ._objects import (
    Clipped,
    Complement,
    Deformed,
    Difference,
    Intersection,
    Latticed,
    Merge,
    Object,
    Placed,
    Texture,
    Textured,
    Union,
    WithoutCaps,
    rotation,
)
from ._patches import BezierPatch, Nurbs, Sewn, Subdivision, TriangularPatch
from ._sheets import HeightField, Terrain
from ._swept import (
    Capsule,
    Lathe,
    Lemon,
    Ovus,
    Prism,
    SphereSweep,
    SphericalSector,
    SurfaceOfRevolution,
    Sweep,
)
from ._render import Picture, bound_image, depth_image, normal_image, object_image, render
from ._results import AllHits, Hits, ObjectSpans, Spans
from ._scene import Light, Scene, load
from ._science import (
    Chords,
    Estimate,
    Scan,
    ViewFactors,
    area,
    chord_lengths,
    lidar,
    lidar_pattern,
    overlaps,
    random_lines,
    thickness,
    view_factors,
    volume,
)

__version__: str = _native.__version__
__all__ = [
    "AllHits",
    "area",
    "BezierPatch",
    "Blob",
    "bound_image",
    "Box",
    "Camera",
    "Capsule",
    "chord_lengths",
    "Chords",
    "Clipped",
    "Complement",
    "Cone",
    "Cyclide",
    "Cylinder",
    "Deformed",
    "depth_image",
    "Difference",
    "Disc",
    "Ellipsoid",
    "EllipticCone",
    "EllipticCylinder",
    "EllipticParaboloid",
    "Estimate",
    "Expression",
    "Formula",
    "formula",
    "HeightField",
    "Hits",
    "HyperbolicCylinder",
    "HyperbolicParaboloid",
    "HyperboloidOneSheet",
    "HyperboloidTwoSheets",
    "Intersection",
    "Ifs",
    "Julia",
    "Lathe",
    "Latticed",
    "Lemon",
    "lidar",
    "lidar_pattern",
    "Light",
    "load",
    "Merge",
    "Menger",
    "Mesh",
    "normal_image",
    "Nurbs",
    "Object",
    "object_image",
    "ObjectSpans",
    "overlaps",
    "Ovus",
    "ParabolicCylinder",
    "Parallelogram",
    "Parametric",
    "parametric",
    "Picture",
    "Placed",
    "Plane",
    "Polygon",
    "Polynomial",
    "Prism",
    "Quadric",
    "random_lines",
    "read_mesh",
    "render",
    "rotation",
    "Scan",
    "Scene",
    "Sewn",
    "Spans",
    "Sierpinski",
    "Sphere",
    "SphereSweep",
    "SphericalSector",
    "Subdivision",
    "Superellipsoid",
    "SurfaceOfRevolution",
    "Sweep",
    "Terrain",
    "Texture",
    "Textured",
    "thickness",
    "Torus",
    "Triangle",
    "TriangularPatch",
    "Union",
    "view_factors",
    "ViewFactors",
    "volume",
    "where",
    "WithoutCaps",
]
