"""Rays aimed at points of interest of a surface, from all distances."""

import math
from fractions import Fraction as F

import scenes
from exact import to_float
from shapes import cross, small, sub, times

INF = float("inf")


def nudge(rng, x):
    for _ in range(rng.choice((0, 0, 1, 1, 2))):
        if x or rng.random() < 0.1:
            x = math.nextafter(x, rng.choice((-INF, INF)))
    return x


def aim(rng, leaf):
    """A local point of interest and a local direction through it."""
    points = list(leaf.points())
    p = rng.choice(points)
    forms = [f for f in (*getattr(leaf, "forms", ()), *leaf.clip, getattr(leaf, "face", None)) if hasattr(f, "gradient")]
    slopes = [g for g in (f.gradient(p) for f in forms) if any(g)]
    ways = ["axis", "small", "any", "chord"] + ["special"] * 2 * bool(leaf.directions) + ["tangent"] * 4 * bool(slopes)
    ways += ["rim", "normal"] * (len(slopes) > 1)
    way = rng.choice(ways)
    if way == "tangent":
        d = cross(rng.choice(slopes), small(rng))
    elif way == "rim":
        d = cross(*rng.sample(slopes, 2))
    elif way == "normal":
        d = rng.choice(slopes)
    elif way == "special":
        d = times(rng.choice((-1, 1)), rng.choice(leaf.directions))
    elif way == "chord":
        d = sub(rng.choice(points), p)
    elif way == "axis":
        d = scenes.signed_permutation(rng, (1, 0, 0))
    elif way == "small":
        d = small(rng)
    else:
        d = tuple(F(rng.gauss(0, 1)) for _ in range(3))
    return p, d if any(d) else small(rng), way


def make_ray(rng, leaf, ranges):
    """Eight floats: a ray through (or within a few ulps of) a point of interest, and its range."""
    p, d, _ = aim(rng, leaf)
    p, d = leaf.whole.point(p), leaf.whole.vector(d)
    # A length between 1e-6 and 1e6, most often by a power of two, which keeps an exact aim exact.
    exponent = math.frexp(to_float(max(map(abs, d))))[1]
    factor = F(2) ** (rng.choice((0, 0, rng.randint(-20, 20))) - exponent)
    if rng.random() < 0.1:
        factor *= F(rng.uniform(0.5, 1))
    d = tuple(float(x * factor) for x in d)
    if not any(d):
        d = (0.0, 0.0, 1.0)
    reach = to_float(leaf.size * max(abs(x) for row in leaf.whole.rows for x in row)) / max(map(abs, d))
    steps = rng.choice((0, 0, 1, rng.randint(1, 9), rng.randint(-9, 9), rng.uniform(0.5, 2)))
    t = F(steps) * F(2) ** (math.frexp(reach)[1] + rng.choice((0, 0, -1, rng.randint(-4, 4), 20, -30)))
    o = tuple(float(a - t * F(b)) for a, b in zip(p, d))
    if rng.random() < 0.25:
        o = tuple(nudge(rng, x) for x in o)
    elif rng.random() < 0.1:
        d = tuple(nudge(rng, x) for x in d)
    lo, hi = 0.0, INF
    if ranges and rng.random() < 0.6:
        end = to_float(t)
        ends = [0.0, end, math.nextafter(end, INF), math.nextafter(end, -INF), -INF, INF, end + reach, end - reach, -0.0]
        lo, hi = rng.choice(ends), rng.choice(ends)
        if rng.random() < 0.9:
            lo, hi = min(lo, hi), max(lo, hi)
    return (*o, *d, lo, hi)
