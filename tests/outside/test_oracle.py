#!/usr/bin/env python3
"""The exact answers about solids, zero sets and meshes against plain definitions read from the scene's text.

    python3 test_oracle.py
"""

import math
import random
import unittest
from fractions import Fraction as F

import numpy as np

import scenes
from comparison import Expected, in_world
from definitions import at, cases, local, numbers, profile_of
from exact import Number, holds, sign
from rays import make_ray
from shapes import Solid, dot, sub
from solids import places
from zero_sets import ZeroSet, multiply, real_roots

TINY = F(1, 1 << 4000)  # below all products of subnormal numbers


def holds_point(body, p):
    """Whether a shape, read from its text, holds a point: the closed set."""
    word = body.split()[0]
    x = numbers(body.replace("mesh2", "mesh"))
    if word == "sphere":
        return sum((a - b) ** 2 for a, b in zip(p, x[:3])) <= x[3] ** 2
    if word == "box":
        return all(min(a, b) <= c <= max(a, b) for a, b, c in zip(x[:3], x[3:6], p))
    if word in ("cylinder", "cone"):
        c0, r0, c1, r1 = (x[:3], x[6], x[3:6], x[6]) if word == "cylinder" else (x[:3], x[3], x[4:7], x[7])
        a, q = sub(c1, c0), sub(p, c0)
        h = dot(q, a) / dot(a, a)
        foot = [c + h * e for c, e in zip(c0, a)]
        return 0 <= h <= 1 and sum((s - f) ** 2 for s, f in zip(p, foot)) <= (r0 + h * (r1 - r0)) ** 2
    if word == "plane":
        s, n, h = dot(p, x[:3]), dot(x[:3], x[:3]), x[3]
        # s <= h sqrt(n)
        return s <= 0 if h == 0 else (s <= 0 or s * s <= h * h * n) if h > 0 else (s < 0 and s * s >= h * h * n)
    if word == "quadric":
        monomials = (p[0] ** 2, p[1] ** 2, p[2] ** 2, p[0] * p[1], p[0] * p[2], p[1] * p[2], *p, 1)
        return sum(a * b for a, b in zip(x, monomials)) <= 0
    if word == "torus":
        k = dot(p, p) + x[0] ** 2 - x[1] ** 2
        return k * k <= 4 * x[0] ** 2 * (p[0] ** 2 + p[2] ** 2)
    if word == "cyclide":
        a, c, d = x
        k = dot(p, p) - (a * a - c * c) - d * d
        return k * k + 4 * (a * a - c * c) * p[1] ** 2 <= 4 * (a * d - c * p[0]) ** 2
    if word == "polynomial":
        return sum(c * p[0] ** i * p[1] ** j * p[2] ** k for i, j, k, c in ((*map(int, x[n : n + 3]), x[n + 3]) for n in range(1, len(x), 4))) <= 0
    if word in ("cubic", "quartic", "poly"):
        n, terms = {"cubic": (3, x), "quartic": (4, x)}.get(word) or (int(x[0]), x[1:])
        powers = sorted(((i, j, k) for i in range(n + 1) for j in range(n + 1 - i) for k in range(n + 1 - i - j)), reverse=True)
        return sum(c * p[0] ** i * p[1] ** j * p[2] ** k for c, (i, j, k) in zip(terms, powers, strict=True)) <= 0
    raise AssertionError(word)


def between(a, b):
    """A rational number strictly between two numbers a < b."""
    bits = 160
    while True:
        middle = (a.rational(bits) + b.rational(bits)) / 2
        if a.cmp(Number.of(middle)) < 0 < b.cmp(Number.of(middle)):
            return middle
        bits *= 2


def value_of(body, p):
    """Negative inside a solid that is put together, read from its text, in floats: another make again."""
    word = body.split()[0]
    x, p = [float(n) for n in numbers(body)], [float(c) for c in p]
    rho = math.hypot(p[0], p[2])
    if word == "sor":
        curve = [x[i : i + 2] for i in range(1, len(x), 2)]
        for (r0, h0), (r1, h1), (r2, h2), (r3, h3) in zip(curve, curve[1:], curve[2:], curve[3:]):
            if h1 <= p[1] <= h2:
                # Hermite's basis on [0, 1].
                u, w = (p[1] - h1) / (h2 - h1), h2 - h1
                m1, m2 = 2 * r1 * (r2 - r0) / (h2 - h0) * w, 2 * r2 * (r3 - r1) / (h3 - h1) * w
                square = r1**2 * (1 + 2 * u) * (1 - u) ** 2 + m1 * u * (1 - u) ** 2 + r2**2 * u * u * (3 - 2 * u) - m2 * u * u * (1 - u)
                return rho**2 - square
        return 1.0
    if word == "ovus":
        # Within one of the balls, or between them within the circle that touches both from outside.
        a, b = x
        balls = min(math.dist(p, (0, 0, 0)) - a, math.dist(p, (0, a, 0)) - b)
        if b >= 2 * a:
            return balls
        r = 2 * max(a, b)
        c = (a * a + (r - a) ** 2 - (r - b) ** 2) / (2 * a)
        major = math.sqrt((r - a) ** 2 - c * c)
        low, high = -c * a / (r - a), a + (a - c) * b / (r - b)
        return math.hypot(rho + major, p[1] - c) - r if low <= p[1] <= high else balls
    if word == "lemon":
        radius, h, inner = x[3], x[5], x[8]
        major = math.sqrt(inner**2 - (h / 2) ** 2) - radius
        return max(-p[1], p[1] - h, math.hypot(rho + major, p[1] - h / 2) - inner)
    if word == "lathe":
        # The walls beyond the point, by the roots that numpy finds; of a point next to one nothing is told.
        near, odd = math.inf, False
        for r, y in profile_of(body):
            for w in np.roots((y - p[1]).coeffs):
                if abs(w.imag) < 1e-9 and -1e-9 < w.real < 1 + 1e-9:
                    near = 0.0 if w.imag else near
                    near = min(near, abs(w.real), abs(1 - w.real), abs(abs(r(w.real)) - rho))
                    odd ^= abs(r(w.real)) > rho
        return -near if odd else near
    if word == "superellipsoid":
        e, n = x
        return (abs(p[0]) ** (2 / e) + abs(p[1]) ** (2 / e)) ** (e / n) + abs(p[2]) ** (2 / n) - 1
    if word == "julia_fractal":
        c, count, normal, distance = x[:4], int(x[4]), x[5:9], x[9]
        length = math.hypot(*normal)
        w = (distance * length - sum(a * b for a, b in zip(normal, p))) / normal[3]
        hyper = "hypercomplex" in body
        radius = 4.0 if hyper else min(2.0, 1 + math.hypot(*c))
        z, worst = (*p, w), -math.inf
        for _ in range(count):
            worst = max(worst, math.hypot(*z) - radius)
            if worst > 9:
                return worst
            # Two complex numbers each: of hypercomplex ones the idempotents' (1 ± k) / 2 shares, of quaternions a power by its angle.
            n = 3 if "cube" in body else 2
            if hyper:
                f, g = complex(z[0] + z[3], z[1] - z[2]) ** n, complex(z[0] - z[3], z[1] + z[2]) ** n
                z = ((f.real + g.real) / 2, (f.imag + g.imag) / 2, (g.imag - f.imag) / 2, (f.real - g.real) / 2)
            else:
                v = math.hypot(*z[1:])
                turned = complex(z[0], v) ** n
                z = (turned.real, *(turned.imag * e / v if v else 0.0 for e in z[1:]))
            z = tuple(a + b for a, b in zip(z, c))
        return worst
    raise AssertionError(word)


def faces_met(body, ray, du, dv):
    """The faces of outlines that a ray meets which is moved aside by du and dv."""
    k = max(range(3), key=lambda i: (abs(ray[3 + i]), -i))
    a, b = [i for i in range(3) if i != k]
    o = [F(x) for x in ray[:3]]
    o[a] += du
    o[b] += dv
    met = set()
    for number, loops in enumerate(body.outlines):
        points = [[tuple(F(x, 1 << body.bits) for x in v) for v in loop] for loop in loops]
        n = body.planes[number]
        slope = dot(n, [F(x) for x in ray[3:6]])
        if slope == 0:
            continue
        t = dot(n, sub(points[0][0], o)) / slope
        p = tuple(x + t * F(y) for x, y in zip(o, ray[3:6]))
        drop = max(range(3), key=lambda i: abs(n[i]))
        i, j = [c for c in range(3) if c != drop]
        odd = False
        for loop in points:
            for u, v in zip(loop, loop[1:] + loop[:1]):
                if (u[j] > p[j]) != (v[j] > p[j]):
                    odd ^= u[i] + (p[j] - u[j]) * (v[i] - u[i]) / (v[j] - u[j]) > p[i]
        if odd:
            met.add(number)
    return met


class Solids(unittest.TestCase):
    def test_solids_are_the_sets_of_their_text(self):
        for kind in ("sphere", "box", "cylinder", "cone", "plane", "quadric", "torus", "cyclide", "polynomial"):
            with self.subTest(kind):
                for rng, _, leaf, ray in cases(kind, 12 if kind in ("torus", "cyclide", "polynomial") else 40):
                    if not isinstance(leaf, (Solid, ZeroSet)):
                        continue
                    leaf.inverse = False
                    inside = leaf.answer(ray[:3], ray[3:6], leaf.whole).inside
                    ends = [e.rational(300) for s in inside for e in s if e is not None]
                    for t in [x + s * d for x in ends or [F(0)] for s in (-1, 1) for d in (F(1, 1 << 250) * max(abs(x), 1), F(1, 1 << 20), 1, F(rng.gauss(0, 9)))]:
                        said = any(holds(a, b, Number.of(t)) for a, b in inside)
                        self.assertEqual(said, holds_point(leaf.body, local(leaf, at(ray, t))), (leaf.sdl(), ray, t))

    def test_events_are_the_changes_of_the_set(self):
        for kind in ("sphere", "box", "cylinder", "cone", "quadric", "torus", "cyclide", "polynomial"):
            for _, _, leaf, ray in cases(kind, 12 if kind in ("torus", "cyclide", "polynomial") else 40):
                if not isinstance(leaf, (Solid, ZeroSet)) or leaf.clip:
                    continue
                answer = leaf.answer(ray[:3], ray[3:6], leaf.whole)
                ts = [e.t for e in answer.events]
                self.assertTrue(all(a.cmp(b) < 0 for a, b in zip(ts, ts[1:])), (leaf.sdl(), ray))
                turns = [e.sign for e in answer.events if e.sign]
                self.assertTrue(all(a == -b for a, b in zip(turns, turns[1:])))
                stretches = [ts[0].rational() - 1] if ts else []
                stretches += [between(a, b) for a, b in zip(ts, ts[1:])]
                stretches += [ts[-1].rational() + 1] if ts else []
                held = [any(holds(a, b, Number.of(t)) for a, b in answer.inside) for t in stretches]
                for e, before, after in zip(answer.events, held, held[1:]):
                    wanted = {-1: (False, True), 1: (True, False)}.get(e.sign)
                    self.assertTrue((before, after) == wanted if wanted else before == after, (leaf.sdl(), ray, e))

    def test_solids_that_are_put_together_are_those_of_their_text(self):
        for kind in ("sor", "ovus", "lemon", "superellipsoid", "julia", "lathe"):
            told = 0
            with self.subTest(kind):
                for rng, _, leaf, ray in cases(kind, 12):
                    body = scenes.times(leaf.size, tuple(F(rng.uniform(-1.2, 1.2)) for _ in range(3)))
                    middle = sum(leaf.heights[:: len(leaf.heights) - 1]) / 2 if kind in ("sor", "ovus", "lemon") else rng.choice(leaf.ends) if kind == "lathe" else 0
                    p = (body[0], body[1] + middle, body[2])
                    theirs, ours = value_of(leaf.body, p), leaf.value(p)
                    if abs(theirs) > (1e-9 * float(leaf.size) ** 2 if kind != "lathe" else 1e-6 * max(1, float(leaf.size))):
                        told += 1
                        self.assertEqual(theirs < 0, ours < 0, (leaf.body, p))
            self.assertGreater(told, 100)

    def test_the_polynomials_of_a_solid_vanish_where_its_value_does(self):
        """The roots of the polynomials along a ray against signs of the value, which knows none of them."""
        for kind in ("sor", "ovus", "lemon", "superellipsoid", "blob", "julia", "isosurface", "lathe"):
            found = 0
            for rng, _, leaf, ray in cases(kind, 8):
                leaf.clip, leaf.inverse = [], False
                answer = leaf.answer(ray[:3], ray[3:6], leaf.whole)
                if answer.within or not leaf.solid():
                    continue
                found += len(answer.events)
                along = places(leaf.whole.ray(ray[:3], ray[3:6]))
                reach = max(abs(c[1]) for c in along)
                for t in [F(rng.uniform(-2, 2)) * leaf.size / reach + (e.t.rational() if e else 0) for e in (*answer.events, None)]:
                    value = leaf.value(tuple(c[0] + t * c[1] for c in along))
                    self.assertEqual(value < 0, any(holds(a, b, Number.of(t)) for a, b in answer.inside), (leaf.sdl(), ray, t))
            self.assertGreater(found, 20, kind)

    def test_outlines_are_met_by_a_ray_that_is_really_moved(self):
        """The symbolic displacement against one of 2^-4000; of a mesh's touches, that some displacement misses their faces and of its crossings that none does."""
        touches = 0
        for kind in ("triangle", "polygon", "mesh"):
            for _, _, leaf, ray in cases(kind, 25):
                body = in_world(leaf)
                answer = body.answer(ray[:3], ray[3:6], body.whole)
                touched = [e.faces for e in answer.events if e.faces]
                crossed = {e.face for e in answer.events if not e.faces}
                met = faces_met(body, ray, TINY, TINY * TINY)
                self.assertEqual(met.difference(*touched), crossed, (leaf.sdl(), ray))
                if kind == "mesh" and (crossed or touched):
                    around = [(x, y) for x in range(-8, 9) for y in range(-8, 9) if max(abs(x), abs(y)) == 8]
                    # Off the symmetries of the scenes.
                    moved = [faces_met(body, ray, TINY * (x + F(1, 97)), TINY * (y + F(1, 89))) for x, y in around]
                    for faces in touched:
                        self.assertTrue(any(not faces & met for met in moved), (leaf.sdl(), ray))
                        touches += 1
                    if not touched:
                        self.assertTrue(all(moved), (leaf.sdl(), ray))
        self.assertGreater(touches, 20)

    def test_closed_meshes_have_parity(self):
        for i in range(60):
            rng = random.Random(f"parity/{i}")
            leaf = scenes.mesh(rng)
            leaf.whole = leaf.map
            if leaf.faces == 32:
                continue
            for _ in range(20):
                ray = make_ray(rng, leaf, False)
                self.assertEqual(sum(e.sign for e in leaf.answer(ray[:3], ray[3:6], leaf.whole).events), 0)

    def test_roots_of_products_are_those_of_the_factors(self):
        rng = random.Random(2)
        for _ in range(300):
            zeros = sorted(F(rng.randint(-20, 20), rng.choice((1, 1, 2, 7))) for _ in range(rng.randint(0, 6)))
            p = [rng.choice((-3, 1))]
            for z in zeros:
                p = multiply(p, [-z.numerator, z.denominator])
            for _ in range(rng.randint(0, 2)):
                p = multiply(p, [rng.randint(1, 5), 0, 1])
            found = real_roots(p)
            self.assertEqual([r.against(z) for r, z in zip(found, sorted(set(zeros)), strict=True)], [0] * len(found))
            for r, z in zip(found, sorted(set(zeros))):
                self.assertEqual(r.before == r.after, zeros.count(z) % 2 == 0)
                self.assertEqual(r.sign_of([-z.numerator, z.denominator]), 0)
                n, m = z.numerator, z.denominator
                self.assertEqual((r.sign_of([-n - m, m]), r.sign_of([m - 9 * n, 9 * m])), (-1, 1))

    def test_surds_compare_as_rationals_say(self):
        rng = random.Random(1)
        draw = lambda: Number(rng.randint(-9, 9), rng.randint(-3, 3), rng.randint(0, 12), rng.randint(1, 4))
        for _ in range(20000):
            a, b = draw(), draw()
            gap = a.rational() - b.rational()
            self.assertEqual(a.cmp(b), 0 if abs(gap) < F(1, 1 << 100) else sign(gap))

    def test_an_examiner_that_sees_nothing_wrong_is_not_blind(self):
        rng = random.Random(3)
        scene = scenes.single(rng, "sphere")
        ray = make_ray(rng, scene.objects[0][0], False)
        self.assertIsInstance(Expected(scene, ray).count(), int)


if __name__ == "__main__":
    unittest.main()
