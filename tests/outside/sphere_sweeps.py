"""Sphere sweeps: the union of all balls whose centres and radii follow a spline.

With `F(u, t)`, the squared distance of a ray's point from the centre at `u` less the squared radius there, a point is inside where the least value of `F` over `u` is below zero; that is decided by
the real roots of a polynomial in `u`. On the boundary the least value is zero, so that `u` is an end of a piece or a double root: the ray's parameter is a root of an end's
quadratic or of the discriminant of `F` in `u`, a polynomial of degree ten at most. The discriminant is put together from its values at whole numbers.
"""

import math
from fractions import Fraction as F

from exact import complement, sign
from lathes import slope, spline
from shapes import Answer, Event, cross, dot, sub, text, vec
from solids import Region, at, between, grouped, minus, places, plus, scaled, whole
from zero_sets import TURNS, multiply, near, real_roots, trim


def resultant(f, g):
    """Of two polynomials, by Euclid's algorithm."""
    f, g, out = list(f), list(g), F(1)
    while len(g) > 1:
        r = [F(a) for a in f]
        while len(r) >= len(g):
            q = r[-1] / g[-1]
            for i in range(1, len(g) + 1):
                r[-i] -= q * g[-i]
            r.pop()
        trim(r)
        if not r:
            return F(0)
        m, n = len(f) - 1, len(g) - 1
        out *= F(-1) ** (m * n) * F(g[-1]) ** (m - (len(r) - 1))
        f, g = g, r
    return out * F(g[0]) ** (len(f) - 1) if g else F(0)


def interpolated(values):
    """The polynomial with these values at 0, 1, 2 ... , by Newton's differences."""
    out, basis, rows = [F(0)], [F(1)], list(values)
    for k in range(len(values)):
        out = plus(out, scaled(rows[0], basis))
        rows = [(b - a) / (k + 1) for a, b in zip(rows, rows[1:])]
        basis = multiply(basis, [F(-k), F(1)])
    return out


def discriminant(parts):
    """Of a polynomial in u, the values of which are `parts[0] + t parts[1] + t^2 parts[2]`, as a polynomial in t."""
    n = max(len(trim(list(p))) for p in parts) - 1
    if n < 2:
        return None if n < 1 else [F(1)]
    # With t as heavy as u^3, no term is heavier than u^6.
    degree = (6 * (n - 1) + 5 * n - n * (n - 1)) // 3
    values = []
    for t in range(degree + 1):
        f = plus(parts[0], plus(scaled(t, parts[1]), scaled(t * t, parts[2])))
        f += [F(0)] * (n + 1 - len(f))
        values.append(F(0) if f[n] == 0 else resultant(f[: n + 1], trim(slope(f[: n + 1]))))
    return interpolated(values)


class Ball:
    """The ball that is on the boundary at a point: the normal there, and how it changes with the point."""

    def __init__(self, centre, bend):
        self.centre, self.bent = centre, bend

    def gradient(self, p):
        return sub(p, self.centre)

    def bend(self, _):
        return self.bent


class SphereSweep(Region):
    exact_ends = False

    def __init__(self, body, pieces, points, directions, size):
        super().__init__(body, points, directions, size)
        # Each piece: the centre's three coordinates and the radius.
        self.pieces, self.known, self.forms = pieces, {}, [self]

    def gradient(self, p):
        """Only of the points that rays are aimed at."""
        return self.known.get(p, (F(0), F(0), F(0)))

    def unit(self):
        return self.size**2

    def about(self, piece, p):
        """The squared distance from the centre less the squared radius, as a polynomial in u."""
        out = scaled(-1, multiply(piece[3], piece[3]))
        for c, x in zip(piece, p):
            away = minus(c, [F(x)])
            out = plus(out, multiply(away, away))
        return out

    def value(self, p):
        """Below zero within a ball: exactly."""
        known = [self.about(piece, p) for piece in self.pieces]
        if any(f[0] < 0 or sum(f) < 0 for f in known):
            return F(-1)
        for f in known:
            for r in real_roots(whole(f)) or []:
                if (r.before < 0 or r.after < 0) and r.against(F(0)) > 0 > r.against(F(1)):
                    return F(-1)
        return F(1)

    def least(self, p, bits=320):
        """The least value over all balls, to twice the bits, and the places (piece, u) where it is: those that 2^-100 does not tell from it."""
        seen = []
        for piece in self.pieces:
            f = self.about(piece, p)
            us = [F(0), F(1)]
            for r in real_roots(whole(slope(f))) or []:
                if r.against(F(0)) > 0 > r.against(F(1)):
                    us.append(r.rational(bits))
            seen += [(at(f, u), piece, u) for u in us]
        low = min(v for v, _, _ in seen)
        return low, [(piece, u) for v, piece, u in seen if v - low <= self.unit() / (1 << 100)]

    def is_met(self, root, ray):
        for bits, left in ((300, 100), (2600, 1100)):
            t = root.rational(bits)
            if abs(self.least(tuple(at(c, t) for c in places(ray)), bits)[0]) > self.unit() / (1 << left):
                return False
        return True

    def balls(self, p):
        """What has its normal at a point of the boundary; nothing next to a ball of radius 0, a tip, which has no tangent plane.

        A tip is next to it if it is within 2^-40 of the size: brackets are about that wide (1000 ulp is 2^-43).
        """
        zeros = [(piece, r.rational(300)) for piece in self.pieces for r in real_roots(whole(piece[3])) or [] if r.against(F(0)) >= 0 >= r.against(F(1))]
        tips = [tuple(at(c, u) for c in piece[:3]) for piece, u in zeros]
        if any(dot(sub(p, c), sub(p, c)) <= self.unit() / (1 << 80) for c in tips):
            return []
        out = []
        # Where a piece goes over into the ball at its end, rounding does not tell which of them is met: the ball's boundary then passes the bracket, too.
        off = (max(map(abs, p)) + self.size) / 10**13
        ends = [(piece, F(u)) for piece in self.pieces for u in (0, 1) if abs(at(self.about(piece, p), F(u))) <= 2 * abs(at(piece[3], F(u))) * off]
        least = self.least(p)[1]
        for piece, u in least + [end for end in ends if end not in least]:
            f2 = at(slope(slope(self.about(piece, p))), u)
            speed = max(abs(at(slope(c), u)) for c in piece[:3])
            inner = 0 < u < 1
            if inner and speed and f2 <= 0:
                return []
            out.append(Ball(tuple(at(c, u) for c in piece[:3]), 1 + (6 * speed**2 / f2 if f2 > 0 else 0)))
        return out

    def candidates(self, ray):
        x = places(ray)
        out = []
        knots = {tuple(at(c, F(u)) for c in piece) for piece in self.pieces for u in (0, 1)}
        for *c, r in knots:
            far = [F(0)]
            for a, b in zip(x, c):
                far = plus(far, multiply(minus(a, [b]), minus(a, [b])))
            out += [(t, None, True) for t in real_roots(whole(minus(far, [r * r])))]
        for piece in self.pieces:
            o, d = tuple(c[0] for c in x), tuple(c[1] for c in x)
            tilt = [2 * dot(o, d)]
            for a, c in zip(d, piece):
                tilt = plus(tilt, scaled(-2 * a, c))
            poly = discriminant([self.about(piece, o), tilt, [dot(d, d)]])
            if poly is None:
                continue
            found = real_roots(whole(poly))
            if found is None:
                self.within = True
                continue
            out += [(t, None, True) for t in found]
        return out

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        self.within = False
        along = places(ray)
        point = lambda t: tuple(at(c, t) for c in along)
        groups = grouped(self.candidates(ray))
        states = [self.value(point(t)) < 0 for t in between([g[0][0] for g in groups])]
        flip = -1 if self.inverse else 1
        events, inside, start = [], [], None
        for group, before, after in zip(groups, states, states[1:]):
            root = group[0][0]
            if before == after and not self.is_met(root, ray):
                continue
            turn = 0 if before == after else flip * (1 if before else -1)
            event = Event(root, turn, [(b, flip) for b in self.balls(point(root.rational(600)))], self)
            # A touch where balls of several pieces meet may be told or not. A touch from inside is none: balls that touch are one body.
            event.optional = before == after and (len(group) > 1 or after)
            events.append(event)
            if before != after:
                if after:
                    start = root
                else:
                    inside.append((start, root))
        # Brackets do not tell a touch from a crossing that is nearer than they are wide.
        for e in events:
            for other in events:
                if e.sign == 0 and other.sign and max(abs(x - y) for x, y in zip(point(e.t.rational(300)), point(other.t.rational(300)))) <= self.size / (1 << 43):
                    e.optional = True
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, self.within)


LINES = [
    [(0, 0, 0, 65), (130, 0, 0, 65)], [(0, 0, 0, 65), (325, 0, 0, 260)], [(0, 0, 0, 65), (65, 0, 0, 260)], [(0, 0, 0, 130), (0, 130, 0, 0)],
    [(0, 0, 0, 65), (0, 195, 260, 65), (195, 195, 0, 130)], [(0, 0, 0, 65), (260, 0, 0, 65), (260, 0, 260, 65), (0, 0, 260, 65), (0, 0, 0, 65)],
    [(0, 0, 0, 0), (325, 0, 0, 195)], [(0, 0, 0, 65), (0, 0, 0, 65), (260, 0, 0, 130)], [(-130, 0, 0, 65), (130, 0, 0, -65)], [(0, 0, 0, 130), (130, 0, 0, 0), (260, 0, 0, 130)],
]
CUBICS = [
    [(-1, 0, 0, 1), (0, 0, 0, 1), (2, 0, 0, 1), (4, 0, 0, 1)], [(0, 0, 0, 1), (1, 2, 0, 1), (3, 0, 1, 2), (4, 2, 0, 1), (6, 0, 0, 1)],
    [(0, 0, 0, 0), (0, 2, 0, 1), (2, 2, 2, 0), (2, 0, 0, 1)], [(4, 0, 0, 1), (0, 4, 0, 1), (-4, 0, 0, 1), (0, -4, 0, 1), (4, 0, 0, 1), (0, 4, 0, 1), (-4, 0, 0, 1)],
    [(0, 0, 0, 3), (1, 0, 0, 1), (2, 0, 0, 4), (3, 0, 0, 1)], [(0, 0, 0, 1), (4, 4, 0, F(1, 4)), (0, 4, 0, F(1, 4)), (4, 0, 0, 1)], [(0, 0, 0, 1), (3, 3, 0, -1), (6, 0, 3, 2), (9, 3, 0, 1)],
    [(2, 0, 0, 1), (0, 0, 0, 1), (2, 0, 0, 1), (0, 0, 0, 1)],
]


def sphere_sweep(rng):
    u = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    word = rng.choice(("linear_spline", "b_spline", "cubic_spline"))
    line = rng.choice(LINES if word == "linear_spline" else CUBICS)
    if rng.random() < 0.25:
        line = [(*(F(rng.uniform(-3, 3)) for _ in range(3)), F(rng.uniform(0, 1.5))) for _ in range(rng.randint(2, 4) if word == "linear_spline" else rng.randint(4, 5))]
    base = tuple(rng.choice((0, 0, 1, -100)) for _ in range(3))
    u = u / 64 if word == "linear_spline" and all(F(x).denominator == 1 for p in line for x in p) else u
    line = [(*(F(float((F(x) + b) * u)) for x, b in zip(p, base)), F(p[3]) * u) for p in line]
    pieces = spline(word, line)
    listed = ", ".join(f"{vec(p[:3])}, {text(p[3])}" for p in line)
    body = f"sphere_sweep {{ {word} {len(line)}, {listed}{rng.choice(('', '', ' tolerance 0.001'))} }}"
    size = max(max(abs(x - y) for p in line for x, y in zip(p[:3], line[0])), *(abs(p[3]) for p in line))
    leaf = None

    def points():
        for _ in range(2):
            piece = rng.choice(pieces)
            s = rng.choice((F(0), F(1), F(1, 2), F(rng.randint(0, 8), 8), F(rng.random())))
            c, r = tuple(at(a, s) for a in piece[:3]), at(piece[3], s)
            way, grows = tuple(at(slope(a), s) for a in piece[:3]), at(slope(piece[3]), s)
            p = near(tuple(a + r * b for a, b in zip(c, contact(rng, way, grows))))
            leaf.known[p] = sub(p, c)
            yield p
            # A pole of the ball, which may be within others; the centre.
            yield near(tuple(a + r * b for a, b in zip(c, rng.choice(((1, 0, 0), (0, -1, 0), (0, 0, 1), (F(3, 5), F(4, 5), 0))))))
            yield near(c)

    ways = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (3, 4, 0)]
    for piece in rng.sample(pieces, min(2, len(pieces))):
        ways += [tuple(at(c, F(1)) - c[0] for c in piece[:3]), tuple(at(slope(c), F(1, 2)) for c in piece[:3])]
    leaf = SphereSweep(body, pieces, points, [w for w in ways if any(w)], size)
    return leaf


def contact(rng, way, grows):
    """A direction in which the balls' hull touches one, about: it goes back along the way as fast as the balls grow."""
    square = dot(way, way)
    c, s = rng.choice(TURNS)
    if not square:
        return (c, s, F(0))
    across = cross(way, (F(0), F(0), F(1)) if way[0] or way[1] else (F(1), F(0), F(0)))
    third = cross(way, across)
    unit = lambda v: tuple(x / root for x in v) if (root := square_root(dot(v, v))) else v
    back = -grows / square_root(square)
    if abs(back) >= 1:
        return tuple(sign(back) * x for x in unit(way))
    out = square_root(1 - back * back)
    return tuple(back * a + out * (c * b + s * e) for a, b, e in zip(unit(way), unit(across), unit(third)))


def square_root(x):
    r = F(math.isqrt((x.numerator << 400) // x.denominator), 1 << 200)
    # Exact where it is rational.
    about = F(float(r))
    return about if about * about == x else r
