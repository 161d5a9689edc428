"""Parametric surfaces: formulas that are polynomials of both parameters, or of their cosines and sines.

On a quarter of a turn about its middle, a cosine is (1 - s s) / (1 + s s) and a sine 2 s / (1 + s s), where s is the tangent of half the angle. So a formula becomes a rational net, exact but for
2^-400, and a ray's crossings are a net's (`nets.py`); parameters are then counted in such parts.
"""

from fractions import Fraction as F
from math import sqrt

import mpmath

from nets import Net, Piece
from shapes import text, vec
from splines import AXES, aims_of, has_area, net_of

BITS = 400
ULP = F(1, 1 << 52)


def fixed(x):
    """A number of mpmath as a fraction."""
    return F(int(mpmath.floor(mpmath.ldexp(x, BITS))), 1 << BITS)


def exact_of(word):
    """A multiple of pi, or a number of the text."""
    with mpmath.workprec(BITS + 40):
        return fixed(word[0] * mpmath.pi) if isinstance(word, tuple) else F(word)


# ---- formulas ----


class Formula:
    """The words; the factors of u^a sin(u)^b v^c sin(v)^d, or of powers of cosines instead of u and v; a bound of the value; how far off its interval may be.

    An operation's interval reaches one unit in the last place beyond the rounded value, on either side: together 4 roundings of the value; those of sines and cosines four times as far.
    """

    def __init__(self, words, terms, most, off=F(0)):
        self.words, self.terms, self.most, self.off = words, {k: a for k, a in terms.items() if a}, most, off

    def __add__(self, other):
        terms = dict(self.terms)
        for k, a in other.terms.items():
            terms[k] = terms.get(k, 0) + a
        most, off = self.most + other.most, self.off + other.off
        return Formula(f"({self.words} + {other.words})", terms, most, off + 2 * ULP * (most + off))

    def __mul__(self, other):
        terms = {}
        for k, a in self.terms.items():
            for l, b in other.terms.items():
                m = tuple(x + y for x, y in zip(k, l))
                terms[m] = terms.get(m, 0) + a * b
        most, off = self.most * other.most, self.off * other.most + self.most * other.off + self.off * other.off
        return Formula(f"{self.words}*{other.words}", terms, most, off + 2 * ULP * (most + off))


def number(x):
    words = text(x)
    return Formula(f"({words})" if x < 0 else words, {(0, 0, 0, 0): F(x)}, abs(F(x)))


class Parameter:
    """u or v: its ends, as numbers of the text or (factor,) of pi; how often its angle goes into a cosine (None: it is no angle)."""

    def __init__(self, name, low, high, angle=None, closed=False, cuts=1):
        self.name, self.ends, self.angle, self.closed = name, (low, high), angle, closed
        self.low, self.high = exact_of(low), exact_of(high)
        # Parts of at most a quarter of a turn.
        self.parts = cuts if angle is None else max(1, -int(-(self.high - self.low) * F(angle) / F(3, 2) // 1))
        self.first = 0 if name == "u" else 2
        self.most = max(abs(self.low), abs(self.high))

    def unit(self, k):
        return tuple(int(i == self.first + k) for i in range(4))

    def plain(self):
        return Formula(self.name, {self.unit(0): F(1)}, self.most)

    def turned(self, word):
        """The cosine or sine of the angle."""
        inner = self.name if self.angle == 1 else f"{self.name}/2"
        return Formula(f"{word}({inner})", {self.unit(word == "sin"): F(1)}, F(1), 8 * ULP + self.most * ULP)

    def words(self, k):
        end = self.ends[k]
        return f"{text(end[0])}*pi" if isinstance(end, tuple) else text(end)

    def powers(self, part, a, b, degree):
        """The powers of t of a term on a part, times what makes polynomials of all up to a degree."""
        size = (self.high - self.low) / self.parts
        start = self.low + part * size
        if self.angle is None:
            return raised([start, size], a)
        with mpmath.workprec(BITS + 40):
            middle = mpmath.mpf((start + size / 2).numerator) / (start + size / 2).denominator * self.angle
            half = mpmath.mpf(size.numerator) / size.denominator * self.angle / 4
            c, s, far = fixed(mpmath.cos(middle)), fixed(mpmath.sin(middle)), fixed(mpmath.tan(half))
        w = [-far, 2 * far]
        square = times_(w, w)
        one_plus, one_minus = [1 + square[0], *square[1:]], [1 - square[0], *(-x for x in square[1:])]
        cosine = [c * x - s * y for x, y in zip(one_minus, [2 * x for x in w] + [0])]
        sine = [s * x + c * y for x, y in zip(one_minus, [2 * x for x in w] + [0])]
        return times_(times_(raised(cosine, a), raised(sine, b)), raised(one_plus, degree - a - b))


def times_(p, q):
    out = [F(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out


def raised(p, n):
    out = [F(1)]
    for _ in range(n):
        out = times_(out, p)
    return out


class Parametric(Net):
    """`container` says how far a point is within what holds it; `twisted` that u closes on v the other way round."""

    def __init__(self, formulas, parameters, held, container, wide):
        u, v = parameters
        domain = tuple((F(0), F(p.parts)) for p in parameters)
        functions = " ".join(f"function {{ {f.words} }}" for f in formulas)
        ends = f"<{u.words(0)}, {v.words(0)}>, <{u.words(1)}, {v.words(1)}>"
        body = f"parametric {{ {functions} {ends} contained_by {{ {held} }} }}"
        super().__init__(body, pieces_of(formulas, parameters), domain, None, AXES, 1, self.within_container, tuple(p.closed for p in parameters))
        self.parameters_, self.container, self.twisted = parameters, container, False
        self.off, self.size = max(f.off for f in formulas), wide

    def error(self, ray):
        stretch = max(abs(x) for row in self.whole.rows for x in row) * max(abs(F(x, self.whole.w)) for row in self.whole.n for x in row)
        return super().error(ray) + 2 * stretch * self.off

    def is_tangent(self, ray, lo, hi):
        """Also where a ray passes the surface by less than sixteen errors, and so near to a tangent that no crossing is sure: values below eight errors are as good as none to the command, and have an error."""
        if super().is_tangent(ray, lo, hi):
            return True
        for piece, u, v, square in self.search(ray, error=16 * self.error(ray)):
            if square is not None:
                ts = [self.depth(piece, ray, square.u + a * square.size_u, square.v + b * square.size_v) for a in (0, 1) for b in (0, 1)]
                if min(ts) <= 2 * F(hi) - F(lo) and max(ts) >= 2 * F(lo) - F(hi):
                    return True
        return self.gave_up

    def passes_the_border(self, ray, lo, hi):
        """Whether a ray passes a border of the domain by less than sixteen errors, where t is in a bracket: whether what is met there is on the surface, rounding decides."""
        for piece, u, v, square in self.search(ray, error=16 * self.error(ray)):
            if square is not None:
                sides = (square.u, 1 - square.u - square.size_u, square.v, 1 - square.v - square.size_v)
                if any(end and side <= 0 for side, end in zip(sides, piece.ends)):
                    ts = [self.depth(piece, ray, square.u + a * square.size_u, square.v + b * square.size_v) for a in (0, 1) for b in (0, 1)]
                    if min(ts) <= F(hi) and max(ts) >= F(lo):
                        return True
        return self.gave_up

    def clearance(self, place, su, sv):
        """The ends of the domain reach four units in the last place farther. A part's own parameter changes at most 1.2 times as fast as it would evenly, by 1 over the part's length."""
        apart, kept = super().clearance(place, su, sv)
        slopes = [max(map(abs, s)) / (b - a) for s, (a, b) in zip((su, sv), self.domain)]
        farther = max(6 * ULP * p.most * p.parts / (p.high - p.low) * s for p, s in zip(self.parameters_, slopes))
        return (apart if apart > farther else min(apart + farther, F(0)) if apart < 0 else F(0)), kept

    def within_container(self, place, _u, _v):
        columns = self.parameters_[0].parts
        i, j = (min(max(int(x // 1), 0), p.parts - 1) for x, p in zip(place, self.parameters_))
        p = self.pieces[j * columns + i].point(place[0] - i, place[1] - j)[0]
        far = self.container(tuple(x / p[3] for x in p[:3]))
        return abs(far), far >= 0

    def apart(self, p, q):
        """Across the turned seam the parameters of both parts, tangents of half an angle, differ in second order: by 4 sin(h / 2)^2 times the square of the distance from it, h half of a part's angle, and less of the domain. As h < 1, that is less than the square."""
        if self.is_turned_over(p, q):
            turn = self.domain[0][1]
            q = (q[0] + (turn if p[0] > q[0] else -turn), self.domain[1][1] - q[1])
            return max(F(0), super().apart(p, q) - min(abs(p[0]), abs(p[0] - turn)) ** 2)
        return super().apart(p, q)

    def is_turned_over(self, p, q):
        return self.twisted and abs(p[0] - q[0]) * 2 > self.domain[0][1]


def pieces_of(formulas, parameters):
    degrees = [max((k[p.first] + k[p.first + 1] for f in formulas for k in f.terms), default=0) for p in parameters]
    u, v = parameters
    out = []
    for j in range(v.parts):
        for i in range(u.parts):
            powers = {}
            one = (0, 0, 0, 0)
            for c, terms in enumerate([f.terms for f in formulas] + [{one: F(1)}]):
                for k, a in terms.items():
                    for x, p in enumerate(u.powers(i, k[0], k[1], degrees[0])):
                        for y, q in enumerate(v.powers(j, k[2], k[3], degrees[1])):
                            old = powers.setdefault((x, y), [F(0)] * 4)
                            old[c] += a * p * q
            n, m = (max(1, d * (1 if p.angle is None else 2)) for p, d in zip(parameters, degrees))
            rows = [[tuple(F(round(x * (1 << BITS)), 1 << BITS) for x in p) for p in row] for row in net_of({k: tuple(a) for k, a in powers.items()}, n, m)]
            inner = [not p.closed and (k == end) for p, k in ((u, i), (v, j)) for end in (0, p.parts - 1)]
            out.append(Piece(rows, (F(i), F(i + 1)), (F(j), F(j + 1)), inner))
    return out


# ---- random ones ----


def factor(rng, wild):
    return number(F(rng.uniform(-2, 2)) if wild else F(rng.choice((-4, -3, -2, -1, 1, 2, 3, 4)), rng.choice((1, 1, 2, 4))))


def drawn_sum(rng, wild, monomials):
    """A few terms, in any order."""
    chosen = rng.sample(monomials, min(len(monomials), rng.randint(1, 4)))
    out = None
    for m in chosen:
        term = factor(rng, wild)
        for f in m:
            term = term * f if rng.random() < 0.5 else f * term
        out = term if out is None else out + term
    return out


def domain_of(rng, name, wild):
    low = F(rng.uniform(-2, 1)) if wild else F(rng.choice((-1, -1, 0, 0, -2)))
    return Parameter(name, low, F(float(low + (F(rng.uniform(0.5, 2)) if wild else rng.choice((1, 2, 2))))), cuts=rng.choice((1, 1, 2)))


def angle_of(rng, name, pole=False):
    """All round, from pole to pole, or a part."""
    if rng.random() < 0.65:
        return Parameter(name, (F(-1, 2),), (F(1, 2),), 1) if pole else Parameter(name, (F(0),), (F(2),), 1, True)
    low = F(rng.uniform(-1.5, 0.5))
    return Parameter(name, low, F(float(low + F(rng.uniform(0.5, 1 if pole else 5)))), 1)


def formulas_of(rng, wild):
    """Three formulas, their parameters, and whether the surface is a band that was turned over."""
    style = rng.choice(("graph", "tensor", "tensor", "turned", "ball", "torus", "waves", "band"))
    if style in ("graph", "tensor"):
        u, v = domain_of(rng, "u", wild), domain_of(rng, "v", wild)
        high = [(u.plain(),) * i + (v.plain(),) * j for i in range(4) for j in range(4) if 0 < i + j < 5]
        if style == "graph":
            return (u.plain(), drawn_sum(rng, wild, high), v.plain()), (u, v), False
        low = [m for m in high if len(m) < 4]
        return (factor(rng, wild) * u.plain() + drawn_sum(rng, wild, low), drawn_sum(rng, wild, high), factor(rng, wild) * v.plain() + drawn_sum(rng, wild, low)), (u, v), False
    if style == "turned":
        u, v = angle_of(rng, "u"), domain_of(rng, "v", wild)
        r = drawn_sum(rng, wild, [(), (v.plain(),), (v.plain(),) * 2])
        return (r * u.turned("cos"), factor(rng, wild) * v.plain(), r * u.turned("sin")), (u, v), False
    if style == "ball":
        u, v = angle_of(rng, "u"), angle_of(rng, "v", True)
        a, b = factor(rng, wild), factor(rng, wild)
        return (a * u.turned("cos") * v.turned("cos"), b * v.turned("sin"), a * u.turned("sin") * v.turned("cos")), (u, v), False
    if style == "torus":
        u, v = angle_of(rng, "u"), angle_of(rng, "v")
        r = number(F(1)) + number(F(rng.choice((1, 3, 4, 8, 9)), 8)) * v.turned("cos")
        return (r * u.turned("cos"), number(F(3, 8)) * v.turned("sin"), r * u.turned("sin")), (u, v), False
    if style == "band":
        u, v = Parameter("u", (F(0),), (F(2),), F(1, 2)), Parameter("v", F(-1, 2), F(1, 2))
        c, s = u.turned("cos"), u.turned("sin")
        r = number(F(1)) + factor(rng, False) * v.plain() * c if rng.random() < 0.5 else number(F(1)) + number(F(1, 2)) * v.plain() * c
        # Cosine and sine of the whole angle.
        return (r * (c * c + number(F(-1)) * s * s), v.plain() * s, r * (number(F(2)) * s * c)), (u, v), True
    u, v = angle_of(rng, "u"), domain_of(rng, "v", wild)
    c, s = u.turned("cos"), u.turned("sin")
    waves = [(c,), (s,), (c, c), (s, c), (c, v.plain()), (s, v.plain())]
    return tuple(drawn_sum(rng, wild, waves) + factor(rng, wild) * f for f in (c, v.plain(), s)), (u, v), False


def container_of(rng, leaf_points, wide):
    """A box or a ball that holds all, or cuts something off: its text, and how far a point is within."""
    if rng.random() < 0.6:
        r = F(2) ** (2 + int(wide).bit_length())
        return rng.choice(((f"box {{ {vec((-r,) * 3)}, {vec((r,) * 3)} }}", lambda p: r - max(map(abs, p))), (f"sphere {{ <0, 0, 0>, {text(2 * r)} }}", lambda p: r)))
    middle = rng.choice(leaf_points)
    low, high = (tuple(F(float(middle[i] + s * wide * F(rng.choice((1, 1, F(1, 2), F(1, 4), F(rng.uniform(0.1, 1))))))) for i in range(3)) for s in (-1, 1))
    if rng.random() < 0.5:
        return f"box {{ {vec(low)}, {vec(high)} }}", lambda p: min(min(a - l, h - a) for a, l, h in zip(p, low, high))
    r = F(float(wide * F(rng.uniform(0.2, 1))))
    centre = tuple(F(float(x)) for x in middle)

    def beyond(p):
        square = sum((a - b) ** 2 for a, b in zip(p, centre))
        return (r * r - square) / (r + F(sqrt(float(square))))

    return f"sphere {{ {vec(centre)}, {text(r)} }}", beyond


def parametric(rng):
    while True:
        wild = rng.random() < 0.3
        formulas, parameters, twisted = formulas_of(rng, wild)
        pieces = pieces_of(formulas, parameters)
        met = [tuple(x / p[3] for x in p[:3]) for piece in pieces for a in (0, 2, 4) for b in (0, 2, 4) for p in [piece.point(F(a, 4), F(b, 4))[0]]]
        wide = F(float(max(abs(x) for p in met for x in p)))
        if not wide:
            continue
        held, inside = container_of(rng, met, wide)
        leaf = Parametric(formulas, parameters, held, inside, wide)
        leaf.twisted = twisted
        if has_area(leaf):
            break
    leaf.points = aims_of(rng, leaf)
    return leaf
