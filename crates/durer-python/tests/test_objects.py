"""Surfaces: each kind, its repr, its errors; placement, solids, formulas."""

import math
import pickle

import numpy as np
import pytest

import durer

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))])

# Each kind with the parameter where the ray from (0.1, 0.2, 9) along -z meets it first.
KINDS = [
    (durer.Sphere((0, 0, 0), 1), 9 - math.sqrt(1 - 0.05)),
    (durer.Box((-1, -1, -1), (1, 1, 1)), 8),
    (durer.Cylinder((0, 0, 0), (0, 0, 2), 1), 7),
    (durer.Cone((0, 0, 0), 1, (0, 0, 2), 0.5), 7),
    (durer.Plane((0, 0, 1), 0.5), 8.5),
    (durer.Disc((0, 0, 1), (0, 0, 1), 1, 0.1), 8),
    (durer.Parallelogram((0, 0, 1), (1, 0, 0), (0, 1, 0)), 8),
    (durer.Triangle([(0, 0, 1), (1, 0, 1), (0, 1, 1)]), 8),
    (durer.Triangle([(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 0, 1), (0.1, 0, 1), (0, 0.1, 1)]), 8),
    (durer.Polygon([[(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]]), 8),
    (durer.Mesh(CUBE, FACES), 8),
    (durer.Quadric([1, 1, 1, 0, 0, 0, 0, 0, 0, -1]), 9 - math.sqrt(1 - 0.05)),
    (durer.Polynomial(2, [1, 0, 0, 0, 1, 0, 0, 1, 0, -1]), 9 - math.sqrt(1 - 0.05)),
    (durer.Torus(1, 0.9), None),
    (durer.Cyclide(2, 0.5, 1.9), None),
    (durer.Prism([[(-1, -1), (1, -1), (1, 1), (-1, 1)]], (-1, 1)), 8),
    (durer.SurfaceOfRevolution([(1, -2), (1, -1), (1, 1), (1, 2)]), 9 - math.sqrt(1 - 0.01)),
    (durer.Lathe([(1, -1), (1, 1)]), 9 - math.sqrt(1 - 0.01)),
    (durer.Sweep([[(-1, -1), (1, -1), (1, 1), (-1, 1)]], [(0, 0, -1), (0, 0, 1)]), 8),
    (durer.Sweep([[(-1, -1), (1, -1), (1, 1), (-1, 1)]], [(0, 0, 2), (0, 0, 0)], (0.5, 2), (0, 1, 0)), 7),
    (durer.Sweep([[(-1, -1), (1, -1), (1, 1), (-1, 1)]], [(0, 0, -1), (0, 0, 0), (0, 0, 1)], (1, 1, 1)), 8),
    (
        durer.Sweep(
            [[(-1, -1), (1, -1), (1, 1), (-1, 1)]],
            [(0, 0, -2), (0, 0, -1), (0, 0, 1), (0, 0, 2)],
            path_spline="cubic",
            twist=1.0,
        ),
        8,
    ),
    (durer.BezierPatch([[(-1, -1, 1), (1, -1, 1)], [(-1, 1, 1), (1, 1, 1)]]), 8),
    (durer.BezierPatch([[(-1, -1, 1, 1), (1, -1, 1, 2)], [(-1, 1, 1, 1), (1, 1, 1, 1)]]), 8),
    (durer.TriangularPatch([[(-2, -2, 1), (2, -2, 1)], [(0, 4, 1)]]), 8),
    (durer.Nurbs([[(-2, -2, 1), (0, -2, 1), (2, -2, 1)], [(-2, 2, 1), (0, 2, 1), (2, 2, 1)]], (2, 1)), 8),
    (
        durer.Subdivision(
            [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
            [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
            creases=[(0, 1, 2.5)],
            corners=[(7, 10)],
        ),
        None,
    ),
    (
        durer.Subdivision(
            [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)],
            [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)],
            scheme="loop",
            uv=[(0, 0), (1, 0), (0, 1)],
            uv_faces=[(0, 1, 2)] * 8,
            uv_interpolation="smooth",
        ),
        None,
    ),
    (
        durer.Nurbs(
            [[(-2, -2, 1), (2, -2, 1)], [(-2, 2, 1), (2, 2, 1)]],
            (1, 1),
            trims=[[(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)]],
        ),
        8,
    ),
    (durer.Sewn([durer.Nurbs([[(-2, -2, 1), (2, -2, 1)], [(-2, 2, 1), (2, 2, 1)]], (1, 1))]), 8),
    (durer.Ovus(1, 0.5), None),
    (durer.Capsule((0, 0, -2), (0, 0, 0), 1), 9 - math.sqrt(1 - 0.05)),
    (durer.SphereSweep([(0, 0, -2, 1), (0, 0, 0, 1)]), 9 - math.sqrt(1 - 0.05)),
    (durer.SphereSweep([(0, 0, -2, 1), (0, 0, -1, 1), (0, 0, 0, 1), (0, 0, 1, 1)], "b"), None),
    (durer.Lemon((0, 0, -1), 0.1, (0, 0, 1), 0.3, 2), None),
    (durer.Ellipsoid((1, 1, 2)), 9 - 2 * math.sqrt(1 - 0.05)),
    (durer.EllipticParaboloid((1, 1, 1), (0, 1)), 8),
    (durer.HyperbolicParaboloid((1, 1, 1)), 9 + 0.03),
    (durer.HyperboloidOneSheet((1, 1, 1), (-1, 1)), 8),
    (durer.HyperboloidTwoSheets((1, 1, 1), (1, 2)), 7),
    (durer.EllipticCone((1, 1, 1), (0.5, 2)), 7),
    (durer.EllipticCylinder((1, 1, 1), (-1, 1)), 8),
    (durer.HyperbolicCylinder((1, 1, 1), (-1, 1)), 8),
    (durer.ParabolicCylinder((1, 1, 1), (-1, 1)), 8),
    (durer.SphericalSector((0, 0, 0), 1, (0, 0, 1), 1.0), 9 - math.sqrt(1 - 0.05)),
    (durer.Superellipsoid(1, 1), 9 - math.sqrt(1 - 0.05)),
    (durer.Blob([((0, 0, 0), 1, 1)], 0.25), None),
    (durer.Blob([((0, 0, -1), (0, 0, 1), 1, 1)], 0.25), None),
    (durer.Julia((-0.1, 0.1, 0, 0)), None),
    (durer.Menger(4), None),
    (durer.Sierpinski(3), None),
    (durer.Ifs(durer.Sphere((0, 0, 0), 1), [0.5 * np.eye(3, 4)], 1), 9 - math.sqrt(0.25 - 0.05)),
    (durer.Ifs([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [0.5 * np.eye(3, 4)], 0), None),
    (durer.HeightField([[0, 0.5], [0.25, 1]]).rotated((1, 0, 0), 1.5), None),
    (durer.Terrain(3, seed=4, corners=(0, 0.5, 0, 0.5)).rotated((1, 0, 0), 1.5), None),
    (durer.parametric("u", "v", "1 + 0*u", u=(-1, 1), v=(-1, 1)), 8),
    (durer.parametric("u", "v", "u*v", u=(-2, 2), v=(-2, 2), ball=((0, 0, 0), 2)), 9 - 0.02),
    (durer.formula("x*x + y*y + z*z - 1"), 9 - math.sqrt(1 - 0.05)),
    (durer.Union(durer.Sphere((0, 0, 0), 1), durer.Box((0, 0, 0), (1, 1, 2))), 7),
    (durer.Sphere((0, 0, 0), 1) | durer.Box((0, 0, 0), (1, 1, 2)), 7),
    (durer.Sphere((0, 0, 0), 1) & durer.Box((0, 0, 0), (1, 1, 0.5)), 8.5),
    (durer.Box((0, 0, 0), (1, 1, 1)) - durer.Box((0, 0, 0.5), (1, 1, 2)), 8.5),
    (~durer.Sphere((0, 0, 0), 1), 9 - math.sqrt(1 - 0.05)),
    (durer.Cylinder((0, 0, 0), (0, 0, 2), 0.15).without_caps(), None),
    (durer.Sphere((0, 0, 0), 1).clipped(durer.Box((-1, -1, -1), (1, 1, 0))), 9 + math.sqrt(1 - 0.05)),
    (durer.Box((-1, -1, -1), (1, 1, 1)).twisted((0, 0, 1), 0.5, -1, 1), 8),
    (durer.Box((-1, -1, -1), (1, 1, 1)).tapered((0, 0, 1), 0.5, -1, 1), 8),
    (durer.Box((-1, -1, -1), (1, 1, 1)).bent((1, 0, 0), (0, 1, 0), 0.5, -1, 1), 8),
    (durer.Sphere((0, 0, 0), 1).with_texture(durer.Texture((1, 0, 0), reflection=0.5)), 9 - math.sqrt(1 - 0.05)),
]


@pytest.mark.parametrize(("thing", "t"), KINDS, ids=[f"{i}-{type(k).__name__}" for i, (k, _) in enumerate(KINDS)])
def test_each_kind_is_met_and_pickles(thing, t):
    ray = [[0.1, 0.2, 9.0, 0, 0, -1]]
    hits = durer.Scene([thing]).closest(ray)
    if t is not None:
        assert hits.t[0] == pytest.approx(t, abs=1e-12)
    back = pickle.loads(pickle.dumps(thing))
    assert type(back) is type(thing) and repr(back) == repr(thing)
    again = durer.Scene([back]).closest(ray)
    assert np.array_equal(again.t, hits.t) and np.array_equal(again.t_lo, hits.t_lo)
    if isinstance(thing, (durer.Mesh, durer.Formula, durer.Parametric, durer.Deformed)):
        return
    made = eval(repr(thing), vars(durer))  # noqa: S307
    assert repr(made) == repr(thing)
    assert np.array_equal(durer.Scene([made]).closest(ray).t, hits.t)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: durer.Sphere((0, 0), 1), r"centre: three numbers are needed, got shape \(2,\)"),
        (lambda: durer.Sphere((0, 0, 0), [1, 2]), r"radius: one number"),
        (lambda: durer.Sphere((0, 0, 0), math.nan), "radius"),
        (lambda: durer.Sphere("abc", 1), "centre"),
        (lambda: durer.Torus(-1, 0), "torus"),
        (lambda: durer.Plane((0, 0, 0)), "plane"),
        (lambda: durer.Quadric([1, 2]), r"\(10,\) is needed, got \(2,\)"),
        (lambda: durer.Polygon([[(0, 0, 0)]]), "polygon"),
        (lambda: durer.Mesh(CUBE, [[0, 1, 8]]), "face 0 uses vertex 8, but there are 8"),
        (lambda: durer.Mesh(CUBE, [[0, 1, -1]]), "face 0 uses vertex -1"),
        (lambda: durer.Mesh(CUBE, [[0.5, 1, 2]]), "faces: whole numbers"),
        (lambda: durer.Mesh(CUBE.ravel(), FACES), r"vertices: shape \(n, 3\) is needed, got \(24,\)"),
        (lambda: durer.Mesh(CUBE, FACES, normals=CUBE[:3]), "3 normals for 8 vertices"),
        (lambda: durer.Disc((0, 0, 0), (0, 0, 1), 1) & durer.Sphere((0, 0, 0), 1), "a disc has no inside"),
        (lambda: durer.Sphere((0, 0, 0), 1).placed(np.zeros((2, 2))), r"\(2, 2\)"),
        (lambda: durer.Sphere((0, 0, 0), 1).scaled((1, 0, 1)), "none may be zero"),
        (lambda: durer.formula("x +"), "formula"),
        (lambda: durer.formula("x^2"), r"powers are written \*\*"),
        (lambda: durer.formula("x + w"), "'w' is unknown"),
        (lambda: durer.formula("__import__('os')"), "no function"),
        (lambda: durer.parametric("u", "v", "x", u=(0, 1), v=(0, 1)), "'x' is unknown; there are u, v"),
        (lambda: durer.parametric("u", "v", "u", u=(1, 0), v=(0, 1)), "u must go from a number to a greater one"),
        (lambda: durer.parametric("u", "v", "floor(9*u)", u=(0, 1), v=(0, 1)), "jump"),
        (lambda: durer.Camera((0, 0, 0), (0, 0, 0)), "target"),
    ],
)
def test_bad_numbers_are_refused_by_name(make, said):
    with pytest.raises(ValueError, match=said):
        make()


def test_placement_is_that_of_the_matrix():
    m = np.array([[0.0, -2, 0, 1], [1, 0, 0.5, 2], [0, 0, 3, 3]])
    scene = durer.Scene([durer.Ellipsoid((1, 2, 3)).placed(m)])
    inverse = np.linalg.inv(m[:, :3])
    rng = np.random.default_rng(2)
    target = rng.uniform(-3, 3, (300, 3)) @ m[:, :3].T * 0.5 + m[:, 3]
    origins = target + rng.normal(size=(300, 3)) * 9
    hits = scene.closest(origins, target - origins)
    assert hits.hit.sum() > 100
    local = (hits.position[hits.hit] - m[:, 3]) @ inverse.T
    assert np.allclose(((local / [1, 2, 3]) ** 2).sum(1), 1, atol=1e-12)


def test_rotations_are_the_standard_ones():
    assert durer.rotation((0, 1, 0), math.pi / 2).tolist() == [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    scene = durer.Scene([durer.Box((1, -0.1, -0.1), (2, 0.1, 0.1)).rotated((0, 1, 0), math.pi / 2)])
    assert scene.contains([[0, 0, -1.5], [0, 0, 1.5]]).tolist() == [True, False]
    moved = durer.Box((0, 0, 0), (1, 1, 1)).scaled((2, 1, 1)).translated((1, 0, 0))
    assert durer.Scene([moved]).bounds.tolist() == [[1, 0, 0], [3, 1, 1]]


def test_formulas_from_callables_and_texts_are_the_same():
    box = ((-2, -2, -2), (2, 2, 2))
    text = durer.formula("sqrt(x**2 + y**2)**2 + abs(z)**2.5 - max(1, sin(z)) + 0*atan2(y, x + 9)", box=box)
    traced = durer.formula(
        lambda x, y, z: np.sqrt(x**2 + y**2) ** 2 + abs(z) ** 2.5 - np.maximum(1, np.sin(z)) + 0 * np.arctan2(y, x + 9),
        box=box,
    )
    rays = np.random.default_rng(3).uniform(-3, 3, (200, 6))
    rays[:, 3:] -= 0.9 * rays[:, :3] + rays[:, 3:] * 0.5
    a, b = durer.Scene([text]).closest(rays), durer.Scene([traced]).closest(rays)
    assert a.hit.sum() > 20 and np.array_equal(a.t, b.t)
    for p in [(0.3, -0.4, 0.5), (1.5, 0.2, -1.0)]:
        x, y, z = p
        value = x * x + y * y + abs(z) ** 2.5 - max(1, math.sin(z))
        assert text(*p) == pytest.approx(value, rel=1e-14)
        assert traced(*p) == pytest.approx(value, rel=1e-14)


def test_formulas_choose():
    f = durer.formula(lambda x, y, z: durer.where(z < 0, x + 10, x % 2 - 1))
    assert [f(1, 0, -1), f(1.5, 0, 1), f(-0.5, 0, 1)] == [11, 0.5, 0.5]
    assert durer.formula("1 if x <= y else 2")(1, 1, 0) == 1
    with pytest.raises(TypeError, match="where"):
        durer.formula(lambda x, y, z: x if x > 0 else y)
    with pytest.raises(TypeError, match="NumPy"):
        durer.formula(lambda x, y, z: math.sin(x))


def test_meshes_keep_their_arrays():
    vertices = CUBE.copy()
    mesh = durer.Mesh(vertices, FACES.astype(np.uint32))
    vertices[:] = 0
    assert mesh.is_solid and np.array_equal(mesh.vertices, CUBE) and mesh.faces.dtype == np.int64
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 1
    sheet = durer.Mesh(CUBE, FACES[:-1])
    assert not sheet.is_solid and durer.Scene([sheet]).spans([[0.5, 0.3, 5, 0, 0, -1]]).offsets[-1] == 0


def test_mesh_normals_and_coordinates_are_interpolated():
    normals, uv = [(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 0), (0.5, 0), (0, 0.25)]
    mesh = durer.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [[0, 1, 2]], normals=normals, uv=uv)
    hits = durer.Scene([mesh]).closest([[0.5, 0.25, 1, 0, 0, -1]])
    expected = np.array([0, 0, 1]) * 0.25 + np.array([1, 0, 1]) / math.sqrt(2) * 0.5 + np.array([0, 1, 1]) / math.sqrt(2) * 0.25
    n = hits.shading_normal[0]
    assert np.allclose(hits.uv[0], [0.25, 0.0625]) and hits.normal[0].tolist() == [0, 0, 1]
    assert np.allclose(np.cross(n, [0.5, 0.25, 1]), 0, atol=1e-9) or np.allclose(np.cross(n, expected), 0, atol=1e-9)
    assert hits.parameters[0].tolist() == [0.5, 0.25]


def test_a_patch_moves_with_a_lattice() -> None:
    flat = np.array([[[x, 0, z] for x in (0, 1)] for z in (0, 1)], float)
    moves = {(1, 1, 1): [0, 0.5, 0], (1, 0, 1): [0, 0.5, 0]}
    lifted = durer.BezierPatch(flat).in_lattice([0, -1, 0], [1, 1, 1], (2, 2, 2), moves)
    hits = durer.Scene([lifted]).closest(np.array([[0.75, 5, 0.75]]), np.array([[0.0, -1, 0]]))
    # The points of the far edge in x and z rise: y = x z / 2.
    assert np.allclose(hits.position, [[0.75, 0.28125, 0.75]], rtol=0, atol=1e-15)
    with pytest.raises(ValueError, match="2 to 8 points along each axis"):
        durer.BezierPatch(flat).in_lattice([0, -1, 0], [1, 1, 1], (1, 2, 2), {})
