"""What the tests of the examiner share: numbers, points and curves read from the text of a scene, in rationals."""

import random
import re
from fractions import Fraction as F

import numpy as np

import scenes
from rays import make_ray
from shapes import sub


def numbers(words):
    return [F(float(x)) for x in re.findall(r"-?\d[\d.]*(?:e[-+]?\d+)?", words)]


def solve(rows, b):
    """Cramer's rule with plain determinants."""
    det = lambda m: sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
    whole = det(rows)
    return tuple(det([[b[r] if c == i else rows[r][c] for c in range(3)] for r in range(3)]) / whole for i in range(3))


def local(leaf, p):
    return solve(leaf.whole.rows, sub(p, leaf.whole.c))


def at(ray, t):
    return tuple(F(a) + t * F(b) for a, b in zip(ray, ray[3:6]))


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


def cases(kind, count=40):
    """Scenes of one kind, ten rays each: the generator, the scene, its only leaf, the ray."""
    for i in range(count):
        rng = random.Random(f"oracle/{kind}/{i}")
        scene = scenes.single(rng, kind)
        leaf = scene.objects[0][0]
        for _ in range(10):
            yield rng, scene, leaf, make_ray(rng, leaf, False)
