#!/usr/bin/env python3
"""The examiner examined: its exact answers against plain definitions read from the scene's text, in rationals of another make.

    python3 test_oracle.py
"""

import math
import random
import re
import unittest
from fractions import Fraction as F

import numpy as np

import scenes
from check_trace import Expected, in_world, make_ray
from exact import Number, holds, sign
from shapes import Loops, Sheet, Solid, dot, sub
from solids import places
from zero_sets import ZeroSet, multiply, real_roots

TINY = F(1, 1 << 4000)  # below all products of subnormal numbers


def numbers(words):
    return [F(float(x)) for x in re.findall(r"-?\d[\d.]*(?:e[-+]?\d+)?", words)]


def solve(rows, b):
    """Cramer's rule with plain determinants."""
    det = lambda m: sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
    whole = det(rows)
    return tuple(det([[b[r] if c == i else rows[r][c] for c in range(3)] for r in range(3)]) / whole for i in range(3))


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


def local(leaf, p):
    return solve(leaf.whole.rows, sub(p, leaf.whole.c))


def at(ray, t):
    return tuple(F(a) + t * F(b) for a, b in zip(ray, ray[3:6]))


def between(a, b):
    """A rational number strictly between two numbers a < b."""
    bits = 160
    while True:
        middle = (a.rational(bits) + b.rational(bits)) / 2
        if a.cmp(Number.of(middle)) < 0 < b.cmp(Number.of(middle)):
            return middle
        bits *= 2


def profile_of(body):
    """The pieces of a lathe's profile, each two polynomials in numpy's manner: through four places that its definition names."""
    word = next((w for w in ("quadratic_spline", "cubic_spline", "bezier_spline") if w in body), "linear_spline")
    x = [float(n) for n in numbers(body)][1:]
    line = list(zip(x[::2], x[1::2]))
    ws, pieces = np.array([0, 1 / 3, 2 / 3, 1]), []

    def hermite(a, b, m, n):
        return lambda w: (1 + 2 * w) * (1 - w) ** 2 * a + w * (1 - w) ** 2 * m + w * w * (3 - 2 * w) * b - w * w * (1 - w) * n

    for i in range(0, len(line), 4) if word == "bezier_spline" else range(len(line) - {"l": 1, "q": 2, "c": 3}[word[0]]):
        piece = []
        for axis in (0, 1):
            a, b, c, d = ([p[axis] for p in line[i : i + 4]] + [0, 0])[:4]
            if word == "bezier_spline":
                at_ = hermite(a, d, 3 * (b - a), 3 * (d - c))
            elif word == "cubic_spline":
                at_ = hermite(b, c, (c - a) / 2, (d - b) / 2)
            elif word == "quadratic_spline":
                # The parabola that has the first point at -1, the second at 0 and the third at 1.
                at_ = lambda w: a * w * (w - 1) / 2 - b * (w - 1) * (w + 1) + c * w * (w + 1) / 2
            else:
                at_ = lambda w: a + (b - a) * w
            degree = {"l": 1, "q": 2}.get(word[0], 3)
            piece.append(np.poly1d(np.polyfit(ws, [at_(w) for w in ws], degree)))
        pieces.append(piece)
    return pieces


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


class Oracle(unittest.TestCase):
    def cases(self, kind, count=40):
        for i in range(count):
            rng = random.Random(f"oracle/{kind}/{i}")
            scene = scenes.single(rng, kind)
            leaf = scene.objects[0][0]
            for _ in range(10):
                yield rng, scene, leaf, make_ray(rng, leaf, False)

    def test_solids_are_the_sets_of_their_text(self):
        for kind in ("sphere", "box", "cylinder", "cone", "plane", "quadric", "torus", "cyclide", "polynomial"):
            with self.subTest(kind):
                for rng, _, leaf, ray in self.cases(kind, 12 if kind in ("torus", "cyclide", "polynomial") else 40):
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
            for _, _, leaf, ray in self.cases(kind, 12 if kind in ("torus", "cyclide", "polynomial") else 40):
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
                for rng, _, leaf, ray in self.cases(kind, 12):
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
            for rng, _, leaf, ray in self.cases(kind, 8):
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

    def test_lathes_are_met_where_the_points_of_their_profiles_are(self):
        """Every crossing is at the distance from the axis that the profile has at its height; and so often as the distance less the profile's changes its sign along the profile."""
        found = 0
        for rng, _, leaf, ray in self.cases("lathe", 20):
            leaf.clip, leaf.inverse = [], False
            answer = leaf.answer(ray[:3], ray[3:6], leaf.whole)
            if answer.within:
                continue
            (x, dx), (y, dy), (z, dz) = places(leaf.whole.ray(ray[:3], ray[3:6]))
            pieces = profile_of(leaf.body)
            size = float(leaf.size)
            for e in answer.events:
                t = e.t.rational(200)
                rho, height = math.hypot(x + t * dx, z + t * dz), float(y + t * dy)
                near = [abs(abs(r(w.real)) - rho) + abs(h(w.real) - height) for r, h in pieces for w in [*np.roots((h - height).coeffs), *np.roots((r - rho).coeffs), *np.roots((r + rho).coeffs)] if -1e-4 < w.real < 1.0001]
                self.assertLess(min(near), 1e-5 * max(size, abs(height)), (leaf.sdl(), ray, e))
                found += 1
            if dy and leaf.closed is False:
                changes = 0
                for r, h in leaf.pieces:
                    values = []
                    for k in range(1, 40):
                        w = F(k, 40)
                        t = (sum(c * w**i for i, c in enumerate(h)) - y) / dy
                        values.append((x + t * dx) ** 2 + (z + t * dz) ** 2 > sum(c * w**i for i, c in enumerate(r)) ** 2)
                    changes += sum(a != b for a, b in zip(values, values[1:]))
                self.assertLessEqual(changes, len(answer.events), (leaf.sdl(), ray))
        self.assertGreater(found, 100)

    def test_a_sheet_is_crossed_where_its_equation_changes_sign(self):
        for kind in ("disc", "cylinder", "cone"):
            for _, _, leaf, ray in self.cases(kind):
                if not isinstance(leaf, Sheet):
                    continue
                answer = leaf.answer(ray[:3], ray[3:6], leaf.whole)
                for e in answer.events:
                    t = e.t.rational(400)
                    p = local(leaf, at(ray, t))
                    x = numbers(leaf.body)
                    if kind == "disc":
                        far = sum((a - b) ** 2 for a, b in zip(p, x[:3]))
                        hole = x[7] if len(x) > 7 else 0
                        near = F(1, 1 << 200) * max(1, far)
                        self.assertLessEqual(abs(dot(sub(p, x[:3]), x[3:6])), near)
                        self.assertTrue(hole**2 - near <= far <= x[6] ** 2 + near)

    def test_outlines_are_met_by_a_ray_that_is_really_moved(self):
        """The symbolic displacement against one of 2^-4000; of a mesh's touches, that some displacement misses their faces and of its crossings that none does."""
        touches = 0
        for kind in ("triangle", "polygon", "mesh"):
            for _, _, leaf, ray in self.cases(kind, 25):
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
