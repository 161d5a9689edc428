#!/usr/bin/env python3
"""The same for surfaces with two parameters: patches, NURBS with trims, parametric surfaces.

    python3 test_oracle_nets.py
"""

import math
import random
import re
import unittest
from fractions import Fraction as F

import scenes
import trims
from definitions import numbers


def casteljau(body, u, v):
    """A point of a patch by repeated linear interpolation; none where a triangle has no point."""
    word, x = body.split()[0], numbers(body.replace("b_spline", "spline"))
    mean = lambda s, p, q: tuple(a + s * (b - a) for a, b in zip(p, q))

    def along(points, s):
        while len(points) > 1:
            points = [mean(s, p, q) for p, q in zip(points, points[1:])]
        return points[0]

    threes = lambda x: [tuple(x[i : i + 3]) for i in range(0, len(x), 3)]
    if word == "bilinear":
        a, b, c, d = threes(x)
        return mean(v, mean(u, a, b), mean(u, d, c))
    if "triangular" in body:
        n, points = int(x[0]), threes(x[1:])
        net = {}
        for j in range(n):
            for i in range(n - j):
                net[i, j] = points.pop(0)
        if u + v > 1:
            return None
        while len(net) > 1:
            top = max(i for i, _ in net)
            net = {(i, j): tuple((1 - u - v) * a + u * b + v * c for a, b, c in zip(net[i, j], net[i + 1, j], net[i, j + 1])) for i, j in net if i + j < top}
        return net[0, 0]
    if word == "bicubic_patch":
        columns, x = 4, x[3:]
    else:
        columns, x = int(x[0]), x[2:]
    points = threes(x)
    rows = [points[i : i + columns] for i in range(0, len(points), columns)]
    if "b_spline" in body:
        def boor(p, s):
            one, two, three = mean((s + 2) / 3, p[0], p[1]), mean((s + 1) / 3, p[1], p[2]), mean(s / 3, p[2], p[3])
            return mean(s, mean((s + 1) / 2, one, two), mean(s / 2, two, three))

        return boor([boor(row, u) for row in rows], v)
    return along([along(row, u) for row in rows], v)


def numbers_after(body, word, count=None):
    """The numbers behind a word of the text, of which the first may be their count."""
    found = re.search(rf"{word} ([-0-9.e+, <>]+)", body)
    return [F(float(x)) for x in re.findall(r"[-+0-9.e]+", found[1])] if found else None


def basis(knots, i, d, x):
    """A B-spline by its recursion (C. de Boor, 1972; M. Cox, 1972)."""
    if d == 0:
        return F(knots[i] <= x < knots[i + 1])
    total = F(0)
    if knots[i + d] > knots[i]:
        total += (x - knots[i]) / (knots[i + d] - knots[i]) * basis(knots, i, d - 1, x)
    if knots[i + d + 1] > knots[i + 1]:
        total += (knots[i + d + 1] - x) / (knots[i + d + 1] - knots[i + 1]) * basis(knots, i + 1, d - 1, x)
    return total


class SplineText:
    """A NURBS surface as its text says it: points, knots and trims."""

    def __init__(self, body):
        body = body.replace("{", " ").replace("}", " ")
        self.degrees = [int(x) for x in numbers_after(body, "degree")]
        x = numbers_after(body, "points")
        self.counts = [int(a) for a in x[:2]]
        per = (len(x) - 2) // (self.counts[0] * self.counts[1])
        points = [x[2 + k * per : 2 + (k + 1) * per] for k in range(self.counts[0] * self.counts[1])]
        self.points = [(*p[:3], p[3] if per == 4 else F(1)) for p in points]
        self.knots = [numbers_after(body, f"{name}_knots")[1:] for name in "uv"]
        around = re.search("periodic ([uv])", body)
        self.around = [around is not None and around[1] == name for name in "uv"]
        self.loops = []
        for words in body.split("trim ")[1:]:
            self.loops.append(outline(words))

    def domain(self):
        return [(k[0], k[-1]) for k in self.knots]

    def weights(self, along, x):
        knots, n, d = self.knots[along], self.counts[along], self.degrees[along]
        if not self.around[along]:
            return [basis(knots, i, d, x) for i in range(n)]
        period = knots[-1] - knots[0]
        knots = [k + turn * period for turn in range(d + 3) for k in knots[:-1]]
        out = [F(0)] * n
        for i in range(n * (d + 1)):
            for turn in range(d + 2):
                # The knot where a point begins to count is as many before the one with its number as the degree.
                out[(i + d) % n] += basis(knots, i, d, x + turn * period) if i // n == 0 else 0
        return out

    def at(self, u, v):
        a, b = self.weights(0, u), self.weights(1, v)
        total = [F(0)] * 4
        for j, y in enumerate(b):
            for i, x in enumerate(a):
                *p, w = self.points[j * self.counts[0] + i]
                for k, c in enumerate((*p, F(1))):
                    total[k] += x * y * w * c
        return tuple(c / total[3] for c in total[:3])

    def keeps(self, u, v):
        """By the angles of the loops around the place; loops that go round it once more to the left than to the right, or as often as the outermost want. None next to a curve, of which there are only points."""
        turns = 0
        if any(len(loop) > 8 and max(abs(p - u) / (b - a), abs(q - v) / (d - c)) < F(1, 100) for (a, b), (c, d) in [self.domain()] for loop in self.loops for p, q in loop):
            return None
        for loop in self.loops:
            angles = [math.atan2(float(q - v), float(p - u)) for p, q in loop]
            turns += round(sum((b - a + math.pi) % (2 * math.pi) - math.pi for a, b in zip(angles, angles[1:] + angles[:1])) / (2 * math.pi))
        area = sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(self.loops[0], self.loops[0][1:] + self.loops[0][:1])) if self.loops else 0
        return turns == (1 if area > 0 else 0)


def outline(words):
    """The corners of a polygon, or points of a curve, by the formulas that define it."""
    x = numbers_after(words, "linear_spline")
    if x:
        return [tuple(x[1 + 2 * k : 3 + 2 * k]) for k in range(int(x[0]))]
    steps = [F(k, 32) for k in range(32)]
    x = numbers_after(words, "bezier_spline")
    if x:
        fours = [[tuple(x[1 + 2 * k : 3 + 2 * k]) for k in range(j, j + 4)] for j in range(0, int(x[0]), 4)]
        cubic = lambda t: ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        return [tuple(sum(a * p[c] for a, p in zip(cubic(t), four)) for c in (0, 1)) for four in fours for t in steps]
    x = numbers_after(words, "nurbs_curve degree")
    degree, n, knots = int(x[0]), int(x[1]), numbers_after(words, "knots")[1:]
    per = (len(x) - 2) // n
    points = [(*x[2 + k * per : 4 + k * per], x[4 + k * per] if per == 3 else F(1)) for k in range(n)]
    out = []
    for a, b in zip(knots, knots[1:]):
        for t in steps if a < b else ():
            factors = [basis(knots, i, degree, a + t * (b - a)) * p[2] for i, p in enumerate(points)]
            out.append(tuple(sum(f * p[c] for f, p in zip(factors, points)) / sum(factors) for c in (0, 1)))
    return out


def container_holds(body, p, room):
    """Whether the container of a parametric surface holds a point; None next to its border."""
    kind, words = re.search(r"contained_by \{ (\w+) \{ ([^}]*) \}", body).groups()
    x = [float(a) for a in re.findall(r"[-+0-9.e]+", words)]
    far = min(min(a - l, h - a) for a, l, h in zip(p, x[:3], x[3:])) if kind == "box" else x[3] - math.dist(p, x[:3])
    return None if abs(far) < room else far > 0


class Nets(unittest.TestCase):
    def test_patches_are_met_where_their_points_are(self):
        """Rays through points of the control net's own evaluation, by Casteljau's means of means, meet the patch there; and the events are on it."""
        for kind in ("bilinear", "patch"):
            found = 0
            for i in range(30):
                rng = random.Random(f"patch/{kind}/{i}")
                leaf = scenes.MAKERS[kind](rng)
                leaf.whole = leaf.map
                for _ in range(4):
                    u, v = F(rng.randint(1, 15), 16), F(rng.randint(1, 15), 16)
                    p = casteljau(leaf.body, u, v)
                    if p is None:
                        continue
                    d = tuple(F(rng.randint(-9, 9)) for _ in range(3))
                    o = tuple(a - b for a, b in zip(p, d))
                    if any(F(float(c)) != c for c in o) or not any(d):
                        continue
                    answer = leaf.answer(tuple(map(float, o)), tuple(map(float, d)), leaf.whole)
                    if not answer.within:
                        found += 1
                        self.assertTrue(any(e.t.cmp(1.0) == 0 for e in answer.events), (leaf.body, u, v))
            self.assertGreater(found, 20, kind)

    def test_nets_are_met_where_their_points_are(self):
        """NURBS by the recursion of their basis and by angles around their trims; triangular patches without weights by repeated linear interpolation."""
        for kind in ("nurbs", "trimmed", "curved patch"):
            found = left_out = 0
            for i in range(45):
                rng = random.Random(f"net/{kind}/{i}")
                leaf = scenes.MAKERS[kind](rng)
                leaf.whole = leaf.map
                spline = SplineText(leaf.body) if kind != "curved patch" else None
                if spline is None and ("b_spline" in leaf.body or re.search(r"<[^,>]*,[^,>]*,[^,>]*,", leaf.body)):
                    continue
                for _ in range(4):
                    s, t = F(rng.randint(1, 63), 64), F(rng.randint(1, 63), 64)
                    kept = True
                    if spline:
                        (a, b), (c, d) = spline.domain()
                        s, t = a + s * (b - a), c + t * (d - c)
                        p, kept = spline.at(s, t), spline.keeps(s, t)
                    else:
                        p = casteljau(leaf.body, s, t)
                    if p is None or kept is None:
                        continue
                    d = tuple(leaf.size * F(rng.randint(-9, 9), 4) for _ in range(3))
                    if not any(d):
                        continue
                    o = tuple(float(a - b) for a, b in zip(p, d))
                    answer = leaf.answer(o, tuple(map(float, d)), leaf.whole)
                    if answer.within:
                        continue
                    near = [e for e in answer.events if abs(e.t.rational() - 1) < F(1, 1 << 20)]
                    if kept:
                        found += 1
                        self.assertTrue(near, (leaf.body, s, t, d))
                    elif all(not e.optional for e in near):
                        left_out += 1
                        self.assertFalse(near, (leaf.body, s, t, d))
            self.assertGreater(found, 45, kind)
            self.assertGreater(left_out, -1 if kind == "curved patch" else 5)

    def test_parametric_surfaces_are_met_where_their_formulas_say(self):
        """Rays through points that the text's own formulas have in f64, steeply; those that a container cuts off are not met."""
        found = left_out = 0
        for i in range(40):
            rng = random.Random(f"parametric/{i}")
            leaf = scenes.MAKERS["parametric"](rng)
            leaf.whole = leaf.map
            functions = re.findall(r"function \{ (.*?) \}", leaf.body)
            ends = [eval(x, {"pi": math.pi}) for x in re.findall(r"<([^>]*)>, <([^>]*)> contained_by", leaf.body)[0]]
            for _ in range(3):
                u, v = (a + rng.uniform(0.05, 0.95) * (b - a) for a, b in zip(*ends))
                p = tuple(eval(f, {"u": u, "v": v, "sin": math.sin, "cos": math.cos}) for f in functions)
                d = tuple(float(leaf.size) * rng.uniform(-1, 1) for _ in range(3))
                answer = leaf.answer(tuple(a - b for a, b in zip(p, d)), d, leaf.whole)
                near = [e for e in answer.events if abs(e.t.rational() - 1) < F(1, 1 << 20)]
                kept = container_holds(leaf.body, p, 1e-6 * float(leaf.size))
                if answer.within or kept is None:
                    continue
                found, left_out = found + kept, left_out + (not kept)
                self.assertEqual(bool(near), kept, (leaf.body, u, v, d))
        self.assertGreater(found, 60)
        self.assertGreater(left_out, 3)

    def test_trims_are_as_far_as_their_nearest_points(self):
        for i in range(12):
            rng = random.Random(f"trims/{i}")
            loops = trims.curves_of(rng, ((F(0), F(1)), (F(0), F(2))))
            points = [trims.on(arc, F(k, 64)) for loop in loops for arc in loop.arcs for k in range(65)]
            gaps = [max(abs(a - b) for a, b in zip(p, q)) for p, q in zip(points, points[1:])]
            u, v = F(rng.random()), F(2 * rng.random())
            far, _ = trims.beside_loops(loops)((u, v), F(1), F(1))
            least = min(max(abs(a - u), abs(b - v)) for a, b in points)
            self.assertLessEqual(far, least)
            self.assertGreaterEqual(far, F(3, 4) * (least - sorted(gaps)[-len(loops)]) - F(1, 1 << 200))


if __name__ == "__main__":
    unittest.main()
