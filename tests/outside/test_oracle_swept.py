#!/usr/bin/env python3
"""The same for swept and fractal surfaces: lathes, sphere sweeps, straight sweeps, height fields and iterated systems.

    python3 test_oracle_swept.py
"""

import itertools
import math
import random
import unittest
from fractions import Fraction as F

import numpy as np

import scenes
from definitions import at, cases, local, numbers, profile_of, solve
from exact import Number, holds, sign
from shapes import Sheet, dot, sub
from solids import places
from sphere_sweeps import discriminant, resultant
from zero_sets import multiply


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


class Swept(unittest.TestCase):
    def test_lathes_are_met_where_the_points_of_their_profiles_are(self):
        """Every crossing is at the distance from the axis that the profile has at its height; and so often as the distance less the profile's changes its sign along the profile."""
        found = 0
        for rng, _, leaf, ray in cases("lathe", 20):
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
        for rng, _, leaf, _ in cases("sphere sweep", 15):
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
        for rng, _, leaf, ray in cases("sphere sweep", 6):
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
        for rng, _, leaf, ray in cases("ifs", 20):
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

    def test_straight_sweeps_hold_what_their_profiles_hold(self):
        told = {True: 0, False: 0}
        for rng, _, leaf, ray in cases("sweep", 15):
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
            for _, _, leaf, ray in cases(kind):
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


if __name__ == "__main__":
    unittest.main()
