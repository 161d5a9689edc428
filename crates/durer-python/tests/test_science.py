"""Measurements against their closed forms, within 4.5 standard errors."""

import math

import numpy as np
import pytest

import durer

# View factors: Howell's catalogue of configuration factors, evaluated with 50 digits; of two spheres, by quadrature.


def within(found, error, exact):
    assert 0 < error < math.inf and abs(found - exact) <= 4.5 * error, (found, error, exact)


def rectangle(corner, u, v):
    return durer.Parallelogram(corner, u, v)


def disc(r, h):
    return durer.Disc((0, 0, h), (0, 0, 1), r)


def tube(x, r, low, high):
    return durer.Cylinder((x, 0, low), (x, 0, high), r).without_caps()


def surfaces(g):
    """Surface 1, then surface 2, and the side of surface 1 that radiates. What is infinite is long: surface 1 is a piece of its middle."""
    far, kind = 5000.0, g["kind"]
    if kind == "discs":
        return [disc(g["r1"], 0), disc(g["r2"], g["h"])], "front"
    if kind == "sphere_disc":
        return [durer.Sphere((0, 0, 0), g["rs"]), disc(g["rd"], g["h"])], "front"
    if kind == "cylinders":
        return [tube(0, g["r"], 0, 1), tube(2 * g["r"] + g["gap"], g["r"], -far, far)], "front"
    if kind == "strips_parallel":
        w, h = g["w"], g["h"]
        return [rectangle((0, 0, 0), (w, 0, 0), (0, 1, 0)), rectangle((0, -far, h), (w, 0, 0), (0, 2 * far, 0))], "front"
    if kind == "strips_perpendicular":
        w, h = g["w1"], g["w2"]
        return [rectangle((0, 0, 0), (w, 0, 0), (0, 1, 0)), rectangle((0, -far, 0), (0, 2 * far, 0), (0, 0, h))], "front"
    if kind == "rect_parallel":
        a, b, c = g["a"], g["b"], g["c"]
        return [rectangle((0, 0, 0), (a, 0, 0), (0, b, 0)), rectangle((0, 0, c), (a, 0, 0), (0, b, 0))], "front"
    if kind == "rect_perpendicular":
        l, w, h = g["l"], g["w"], g["h"]
        return [rectangle((0, 0, 0), (w, 0, 0), (0, l, 0)), rectangle((0, 0, 0), (0, l, 0), (0, 0, h))], "front"
    if kind == "concentric_spheres":
        return [durer.Sphere((0, 0, 0), g["r2"]), durer.Sphere((0, 0, 0), g["r1"])], "back"
    if kind == "can_base_side":
        return [disc(g["r"], 0), tube(0, g["r"], 0, g["h"])], "front"
    if kind == "can_side_side":
        return [tube(0, g["r"], 0, g["h"])], "back"
    if kind == "hemisphere":
        return [durer.Sphere((0, 0, 0), 1).clipped(durer.Box((-2, -2, -2), (2, 2, 0)))], "back"
    assert kind == "spheres"
    return [durer.Sphere((0, 0, 0), g["r1"]), durer.Sphere((g["d"], 0, 0), g["r2"])], "front"


def view_factor(geometry, rays, seed):
    """F12 and its standard error, from about so many samples."""
    objects, side = surfaces(geometry)
    found = durer.view_factors(objects, sides=side, samples=3 * rays, sources=[0], seed=seed)
    return float(found.factors[0, -1]), float(found.standard_errors[0, -1])


CASES = [
    (dict(kind="discs", r1=1, r2=1, h=1), 0.381966011250105),
    (dict(kind="discs", r1=1, r2=2, h=1.5), 0.601653344388044),
    (dict(kind="discs", r1=1, r2=0.1, h=3), 0.000999100719505266),
    (dict(kind="sphere_disc", rs=1, rd=1, h=2), 0.0527864045000421),
    (dict(kind="sphere_disc", rs=0.5, rd=3, h=0.75), 0.378732187481834),
    (dict(kind="cylinders", r=1, gap=1), 0.110695969631673),
    (dict(kind="cylinders", r=1, gap=0.1), 0.169056894858101),
    (dict(kind="strips_parallel", w=1, h=1), 0.414213562373095),
    (dict(kind="strips_perpendicular", w1=1, w2=1), 0.292893218813452),
    (dict(kind="rect_parallel", a=1, b=1, c=1), 0.199824895698387),
    (dict(kind="rect_perpendicular", l=1, w=1, h=1), 0.200043776075403),
    (dict(kind="rect_parallel", a=2, b=1, c=0.5), 0.508988669041438),
    (dict(kind="rect_perpendicular", l=2, w=1, h=3), 0.308140292981996),
    (dict(kind="concentric_spheres", r1=1, r2=2), 0.25),
    (dict(kind="can_base_side", r=1, h=2), 0.82842712474619),
    (dict(kind="can_side_side", r=1, h=2), 0.585786437626905),
    (dict(kind="hemisphere"), 0.5),
    (dict(kind="spheres", r1=1, r2=1, d=3), 0.0295903122505504),
    (dict(kind="spheres", r1=1, r2=2, d=4), 0.0685886600242572),
]


@pytest.mark.parametrize(("geometry", "exact"), CASES, ids=[f"{i}-{g['kind']}" for i, (g, _) in enumerate(CASES)])
def test_view_factors_have_their_closed_forms(geometry, exact):
    within(*view_factor(geometry, 30_000, 1), exact)


def test_a_bowl_sees_itself_by_half():
    bowl = durer.Sphere((0, 0, 0), 1).clipped(durer.Box((-2, -2, -2), (2, 2, 0)))
    found = durer.view_factors([bowl], sides="back")
    within(found.factors[0, 0], found.standard_errors[0, 0], 0.5)
    within(found.areas[0], found.area_errors[0], 2 * math.pi)


def test_view_factors_are_reciprocal_and_add_up():
    can = durer.Cylinder((0, 0, 0), (0, 0, 2), 1).without_caps()
    found = durer.view_factors([disc(1, 0), can, disc(1, 2)], sides=["front", "back", "back"])
    assert np.allclose(found.factors.sum(axis=1), 1, atol=1e-3)
    for i, j in ((0, 1), (0, 2), (1, 2)):
        a, b = found.areas[i] * found.factors[i, j], found.areas[j] * found.factors[j, i]
        assert abs(a - b) < 5 * (found.areas[i] * found.standard_errors[i, j] + found.areas[j] * found.standard_errors[j, i])
    within(found.factors[0, 2], found.standard_errors[0, 2], 3 - math.sqrt(8))


SOLIDS = [
    (durer.Sphere((1, 2, 3), 1), 4 / 3 * math.pi, 4 * math.pi),
    (durer.Box((0, 0, 0), (1, 2, 3)), 6, 22),
    (durer.Cylinder((0, 0, 0), (0, 0, 2), 1), 2 * math.pi, 6 * math.pi),
    (durer.Cone((0, 0, 0), 1, (0, 0, 1)), math.pi / 3, math.pi * (1 + math.sqrt(2))),
    (durer.Torus(2, 0.5), math.pi**2, 4 * math.pi**2),
    (durer.Sphere((0, 0, 0), 1).scaled((1, 2, 3)), 8 * math.pi, None),
    (durer.Ellipsoid((1, 1, 1)), 4 / 3 * math.pi, 4 * math.pi),
    (durer.EllipticParaboloid((1, 1, 1), (0, 1)), math.pi / 2, None),
    (durer.Superellipsoid(1, 1), 4 / 3 * math.pi, None),
    (durer.Prism([[(0, 0), (1, 0), (1, 1), (0, 1)]], (0, 2)), 2, 10),
    (durer.SphericalSector((0, 0, 0), 1, (0, 0, 1), math.pi / 2), 2 / 3 * math.pi, 3 * math.pi),
    (durer.formula("x*x + y*y + z*z - 1", ball=((0, 0, 0), 1.5)), 4 / 3 * math.pi, None),
    (durer.Box((0, 0, 0), (1, 1, 1)) - durer.Box((0.5, 0.5, 0.5), (2, 2, 2)), 7 / 8, 6),
    (durer.Sphere((0, 0, 0), 1) & durer.Sphere((1, 0, 0), 1), 5 / 12 * math.pi, 2 * math.pi),
    (durer.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]), 1 / 6, None),
]


@pytest.mark.parametrize(("solid", "volume", "area"), SOLIDS, ids=[type(s[0]).__name__ + str(i) for i, s in enumerate(SOLIDS)])
def test_volumes_and_areas(solid, volume, area):
    found = durer.volume(solid, samples=40_000)
    within(found.value, found.standard_error, volume)
    if area is not None:
        found = durer.area(solid, samples=40_000)
        within(found.value, found.standard_error, area)


def test_overlaps_and_chords():
    bodies = [durer.Sphere((0, 0, 0), 1), durer.Sphere((1, 0, 0), 1), durer.Sphere((9, 0, 0), 0.5)]
    found, errors = durer.overlaps(bodies, samples=200_000)
    within(found[0, 1], errors[0, 1], 5 / 12 * math.pi)
    within(found[0, 0], errors[0, 0], 4 / 3 * math.pi)
    assert found[0, 2] == 0 and np.array_equal(found, found.T)
    chords = durer.chord_lengths(bodies, [[-5, 0, 0]], [[2, 0, 0]])
    assert chords.lengths().tolist() == [[1, 1, 0.5]]
    assert chords.of(1).t_in.tolist() == [2.5]


def test_thickness_is_along_the_normal():
    plate = durer.Box((0, 0, 0), (9, 9, 0.5)) - durer.Sphere((4, 4, 0.25), 0.1)
    found = durer.thickness(plate, [[1, 1, 0.5], [4, 4, 0.5], [20, 1, 1]], [[0, 0, 7], [0, 0, 1], [0, 0, 1]])
    assert found[0] == 0.5 and abs(found[1] - 0.15) < 1e-15 and np.isnan(found[2])


def test_a_scan_sees_the_room():
    room = durer.Box((-2, -3, 0), (2, 3, 2.5))
    pose = np.hstack([durer.rotation((0, 0, 1), math.pi / 2), [[0], [0], [1]]])
    scan = durer.lidar(room, pose, durer.lidar_pattern(360, 8))
    assert scan.hit.all() and scan.points.shape == (2880, 3) and (scan.objects == 0).all()
    assert np.allclose(np.linalg.norm(scan.points - [0, 0, 1], axis=1), scan.ranges)
    assert (scan.range_errors < 1e-14).all() and (scan.intensities > 0).all()
    ahead = durer.lidar(room, pose, [[1, 0, 0]])
    assert np.allclose(ahead.points, [[0, 3, 1]]) and ahead.intensities.tolist() == [1]
    assert not durer.lidar(room, pose, [[1, 0, 0]], max_range=2).hit.any()
    noisy = durer.lidar(room, pose, durer.lidar_pattern(360, 8), noise=0.01)
    assert 0.009 < (noisy.ranges - scan.ranges).std() < 0.011


def test_bodies_without_end_are_refused():
    for measure in (durer.volume, durer.area, durer.view_factors):
        with pytest.raises(ValueError, match="no end"):
            measure(durer.Plane((0, 0, 1)))
