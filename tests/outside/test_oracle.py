#!/usr/bin/env python3
"""The examiner examined: its exact answers against plain definitions read from the scene's text, in rationals of another make.

    python3 test_oracle.py
"""

import itertools
import math
import random
import re
import unittest
from fractions import Fraction as F

import numpy as np

import scenes
import trims
from check_trace import Expected, in_world, make_ray
from exact import Number, holds, sign
from shapes import Loops, Sheet, Solid, dot, sub
from solids import places
from sphere_sweeps import discriminant, resultant
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


def balls_of(body):
    """400 balls of each piece of a sphere sweep: by de Boor's means, Hermite's basis or straight."""
    x = [float(n) for n in numbers(body.split(" tolerance")[0].replace("b_spline", ""))][1:]
    spheres = [x[i : i + 4] for i in range(0, len(x), 4)]
    mix = lambda f, p, q: [a + f * (b - a) for a, b in zip(p, q)]
    if "linear_spline" in body:
        return [[mix(k / 400, p, q) for k in range(401)] for p, q in zip(spheres, spheres[1:])]
    pieces = []
    for a, b, c, d in zip(spheres, spheres[1:], spheres[2:], spheres[3:]):
        piece = []
        for k in range(401):
            u = k / 400
            if "b_spline" in body:
                one, two, three = mix((u + 2) / 3, a, b), mix((u + 1) / 3, b, c), mix(u / 3, c, d)
                piece.append(mix(u, mix((u + 1) / 2, one, two), mix(u / 2, two, three)))
            else:
                h = ((1 + 2 * u) * (1 - u) ** 2, u * (1 - u) ** 2, u * u * (3 - 2 * u), -u * u * (1 - u))
                piece.append([h[0] * q + h[1] * (r - p) / 2 + h[2] * r + h[3] * (s - q) / 2 for p, q, r, s in zip(a, b, c, d)])
        pieces.append(piece)
    return pieces


def sylvester(p):
    """The resultant of a polynomial and its derivative, in floats."""
    q = [i * a for i, a in enumerate(p)][1:]
    m, n = len(p) - 1, len(q) - 1
    rows = [[0.0] * i + [float(a) for a in reversed(p)] + [0.0] * (n - 1 - i) for i in range(n)]
    rows += [[0.0] * i + [float(a) for a in reversed(q)] + [0.0] * (m - 1 - i) for i in range(m)]
    return float(np.linalg.det(np.array(rows)))


def holds_copies(body, p):
    """Whether an iterated function system, read from its text, holds a point."""
    if "menger" in body:
        (levels,) = map(int, numbers(body))

        def in_sponge(p, n):
            if any(abs(c) > 1 for c in p):
                return False
            # Of all thirds that hold the point, borders included, in each direction.
            thirds = [[k for k in (-1, 0, 1) if abs(3 * c - 2 * k) <= 1] for c in p]
            return n == 0 or any(sum(k == 0 for k in ks) < 2 and in_sponge([3 * c - 2 * k for c, k in zip(p, ks)], n - 1) for ks in itertools.product(*thirds))

        return in_sponge(p, levels)
    if "sierpinski" in body:
        (levels,) = map(int, numbers(body))
        corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
        inner = lambda p: all(dot(p, c) >= -1 for c in corners)
        system = lambda p, n: inner(p) if n == 0 else any(system([2 * a - b for a, b in zip(p, c)], n - 1) for c in corners)
        return system(p, levels)
    head, *maps = body.split("map {")
    leaf, x = head.split()[2], numbers(head)
    maps = [m.split("}")[0] for m in maps]
    depth = int(numbers(body.split("depth")[1])[0])
    matrices = []
    for words in maps:
        n = numbers(words)
        matrices.append(([[n[3 * j + i] for j in range(3)] for i in range(3)], n[9:12]))

    def held(p, n):
        if n:
            return any(held(solve(rows, sub(p, c)), n - 1) for rows, c in matrices)
        if leaf == "sphere":
            return sum((a - b) ** 2 for a, b in zip(p, x[:3])) <= x[3] ** 2
        if leaf == "box":
            return all(min(a, b) <= c <= max(a, b) for a, b, c in zip(x[:3], x[3:6], p))
        a, b, c, d = (x[i : i + 3] for i in range(0, 12, 3))
        columns = [sub(b, a), sub(c, a), sub(d, a)]
        weights = solve([[column[i] for column in columns] for i in range(3)], sub(p, a))
        return all(w >= 0 for w in weights) and sum(weights) <= 1

    return held(p, depth)


def height_of(leaf, x, z):
    """The height of a sheet at a place, from its text and pictures."""
    body = leaf.body
    if body.startswith("terrain"):
        words = body.replace("<", " ").replace(">", " ").replace(",", " ").split()
        value = lambda name: float(words[words.index(name) + 1])
        levels, corners = int(value("levels")), [float(words[words.index("corners") + k]) for k in (1, 2, 3, 4)]
        rows = displaced(levels, value("roughness"), value("amplitude"), int(words[words.index("seed") + 1]), corners)
    elif "function" in body:
        columns, count, a, b, c = map(float, numbers(body)[:5])
        rows = [[a + b * i / (columns - 1) + c * (1 - j / (count - 1)) ** 2 for i in range(int(columns))] for j in range(int(count))]
    else:
        magic, size, most, data = leaf.files["heights.pgm"].split(b"\n", 3)
        columns, count = map(int, size.split())
        deep = int(most) > 255
        values = [int.from_bytes(data[2 * i : 2 * i + 2], "big") if deep else data[i] * 257 for i in range(columns * count)]
        rows = [[v / 65536 for v in values[r * columns : (r + 1) * columns]] for r in range(count)][::-1]
    m, n = len(rows[0]) - 1, len(rows) - 1
    i, j = int(x * m), int(z * n)
    u, v = x * m - i, z * n - j
    a, b, c, d = rows[j][i], rows[j][i + 1], rows[j + 1][i], rows[j + 1][i + 1]
    return a + u * (b - a) + v * (c - a) if u + v <= 1 else d + (1 - u) * (c - d) + (1 - v) * (b - d)


def displaced(levels, roughness, amplitude, seed, corners):
    """A terrain's heights, square by square from the whole one down."""
    n = 2**levels
    h = np.full((n + 1, n + 1), np.nan)
    h[0, 0], h[0, n], h[n, 0], h[n, n] = corners

    def push(i, j, level):
        z = (seed * 0x9E3779B97F4A7C15 + i * 0xBF58476D1CE4E5B9 + j * 0x94D049BB133111EB) % 2**64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        z = (z ^ z >> 31) >> 11
        return amplitude * 2.0 ** (-roughness * level) * (2 * z / 2**53 - 1)

    def split(i, j, s, level):
        if s == 1:
            return
        k = s // 2
        for (pi, pj), (qi, qj) in (((i, j), (i + s, j)), ((i, j), (i, j + s)), ((i + s, j), (i + s, j + s)), ((i, j + s), (i + s, j + s)), ((i + s, j), (i, j + s))):
            x, y = (pi + qi) // 2, (pj + qj) // 2
            h[y, x] = (h[pj, pi] + h[qj, qi]) / 2 + push(x, y, level)
        for di in (0, k):
            for dj in (0, k):
                split(i + di, j + dj, k, level + 1)

    split(0, 0, n, 0)
    return h.tolist()


def casteljau(body, u, v):
    """A point of a patch by means of means; none of a place that a triangle lacks."""
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


def holds_point(body, p, room):
    """Whether the container of a parametric surface holds a point; None next to its border."""
    kind, words = re.search(r"contained_by \{ (\w+) \{ ([^}]*) \}", body).groups()
    x = [float(a) for a in re.findall(r"[-+0-9.e]+", words)]
    far = min(min(a - l, h - a) for a, l, h in zip(p, x[:3], x[3:])) if kind == "box" else x[3] - math.dist(p, x[:3])
    return None if abs(far) < room else far > 0


def holds_sweep(body, p):
    """Whether a straight sweep holds a point: its profile, turned from z onto the path by one rotation, holds the point's place."""
    profile, path = body.split("path")
    loops = [numbers(part)[1:] for part in profile.split("linear_spline")[1:]]
    x = numbers(path)[1:]
    start, end = x[:3], x[3:6]
    sizes = x[7:9] if "size" in path else [1, 1]
    way = sub(end, start)
    h = dot(sub(p, start), way) / dot(way, way)
    if not 0 <= h <= 1:
        return False
    k = sizes[0] + h * (sizes[1] - sizes[0])
    foot = sub(p, tuple(a + h * b for a, b in zip(start, way)))
    # The axes of the profile: x and y unless the path goes along one of them; then z, which has become the path, is exchanged with it.
    axis = max(range(3), key=lambda i: abs(way[i]))
    s = sign(way[axis])
    a, b = {2: (foot[0], foot[1]), 0: (-s * foot[2], foot[1]), 1: (foot[0], -s * foot[2])}[axis]
    a, b = a / k, b / k
    odd = False
    for loop in loops:
        corners = list(zip(loop[::2], loop[1::2]))
        for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
            if (y0 > b) != (y1 > b):
                odd ^= x0 + (b - y0) * (x1 - x0) / (y1 - y0) > a
    return odd


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

    def test_sphere_sweeps_are_the_unions_of_their_balls(self):
        """Points against many of the balls, by splines of another make, in floats."""
        told = {True: 0, False: 0}
        for rng, _, leaf, _ in self.cases("sphere sweep", 15):
            balls = [ball for piece in balls_of(leaf.body) for ball in piece]
            c = [sum(b[i] for b in balls) / len(balls) for i in range(3)]
            p = [F(a + float(leaf.size) * rng.uniform(-1.5, 1.5)) for a in c]
            depth = min(math.dist(tuple(map(float, p)), b[:3]) - abs(b[3]) for b in balls)
            # Between two of 400 balls there may be a little more.
            if abs(depth) > 0.02 * float(leaf.size):
                told[depth < 0] += 1
                self.assertEqual(depth < 0, leaf.value(tuple(p)) < 0, (leaf.body, p))
        self.assertGreater(min(told.values()), 8, told)

    def test_discriminants_vanish_at_double_roots(self):
        rng = random.Random(4)
        for _ in range(60):
            # |o + t d - c(u)|^2 - r^2 in the plane: at t = 0 with a double root u = 1/2, elsewhere without.
            f = multiply([F(1), F(-4), F(4)], [F(rng.randint(1, 5)), F(rng.randint(-3, 3)), F(rng.randint(1, 4))])
            tilt, square = [F(rng.randint(-5, 5)) for _ in range(4)], F(rng.randint(1, 9))
            found = discriminant([f, tilt, [square]])
            self.assertEqual(found[0], 0)
            for t in (F(1, 3), F(-5, 2)):
                at_t = [a + t * b + t * t * c for a, b, c in zip(f, [*tilt, 0], [square, 0, 0, 0, 0])]
                said = sum(a * t**i for i, a in enumerate(found))
                self.assertAlmostEqual(float(said / resultant(at_t, [i * a for i, a in enumerate(at_t)][1:])), 1.0)
                # By Sylvester's determinant, too.
                self.assertLess(abs(float(said) / sylvester(at_t) - 1), 1e-6)

    def test_sphere_sweeps_are_left_where_their_value_changes(self):
        found = 0
        for rng, _, leaf, ray in self.cases("sphere sweep", 6):
            leaf.clip, leaf.inverse = [], False
            answer = leaf.answer(ray[:3], ray[3:6], leaf.whole)
            if answer.within:
                continue
            found += len(answer.events)
            along = places(leaf.whole.ray(ray[:3], ray[3:6]))
            reach = max(abs(c[1]) for c in along)
            for t in [F(rng.uniform(-1, 1)) * leaf.size / reach + (e.t.rational() if e else 0) for e in (*answer.events, None)]:
                value = leaf.value(tuple(c[0] + t * c[1] for c in along))
                self.assertEqual(value < 0, any(holds(a, b, Number.of(t)) for a, b in answer.inside), (leaf.sdl(), ray, t))
        self.assertGreater(found, 20)

    def test_iterated_systems_are_the_unions_of_their_copies(self):
        """Points of a ray against maps that are read from the text and undone one after another."""
        told = {True: 0, False: 0}
        for rng, _, leaf, ray in self.cases("ifs", 20):
            leaf.inverse = False
            inside = leaf.answer(ray[:3], ray[3:6], leaf.whole).inside
            for t in [F(rng.gauss(0, 3)), *((e.rational(200) + F(k, 1 << 30) for pair in inside[:3] for e in pair if e is not None for k in (-1, 1)))]:
                said = any(holds(a, b, Number.of(t)) for a, b in inside)
                told[said] += 1
                self.assertEqual(said, holds_copies(leaf.body, local(leaf, at(ray, t))), (leaf.sdl(), ray, t))
        self.assertGreater(min(told.values()), 20, told)

    def test_sheets_have_the_heights_of_their_text(self):
        """Upright rays meet a sheet once, at the height that its three nearest vertices have."""
        for kind in ("height field", "terrain"):
            for i in range(25):
                rng = random.Random(f"sheet/{kind}/{i}")
                leaf = scenes.MAKERS[kind](rng)
                leaf.whole = leaf.map
                for _ in range(6):
                    x, z = rng.random(), rng.random()
                    events = leaf.answer((x, 0.0, z), (0.0, 1.0, 0.0), leaf.whole).events
                    height = height_of(leaf, x, z)
                    if leaf.water is not None and abs(height - leaf.water) < 1e-9:
                        continue
                    self.assertEqual(len(events), int(leaf.water is None or height > leaf.water), (leaf.body, x, z))
                    if events:
                        self.assertLess(abs(float(events[0].t) - height), 1e-9, (leaf.body, x, z))

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
        """NURBS by the recursion of their basis and by angles around their trims; rational and triangular patches by means of means, where they have no weights."""
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
                kept = holds_point(leaf.body, p, 1e-6 * float(leaf.size))
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

    def test_straight_sweeps_hold_what_their_profiles_hold(self):
        told = {True: 0, False: 0}
        for rng, _, leaf, ray in self.cases("sweep", 15):
            if leaf.open:
                continue
            inside = leaf.answer(ray[:3], ray[3:6], leaf.whole).inside
            for t in [F(rng.uniform(-2, 2)) * leaf.size] + [(a.rational() + b.rational()) / 2 for a, b in inside]:
                said = any(holds(a, b, Number.of(t)) for a, b in inside)
                told[said] += 1
                self.assertEqual(said, holds_sweep(leaf.body, local(leaf, at(ray, t))), (leaf.sdl(), ray, t))
        self.assertGreater(min(told.values()), 15, told)

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
