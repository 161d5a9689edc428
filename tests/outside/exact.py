"""Exact numbers of degree two, and sets of them on a line.

Every f64 is a dyadic number, so along a ray `o + t d` a plane is a polynomial of degree one in `t` and a quadric one of degree two, with
whole-number coefficients (after a common factor). Their roots are `(p + q sqrt(d)) / a` with whole `p, q, d, a`; whether one such number is
less than another is a question about signs of whole numbers, and Python's are unbounded. Nothing here is rounded.
"""

from fractions import Fraction
from functools import cmp_to_key
from math import isqrt


def sign(x):
    return (x > 0) - (x < 0)


def sign_surd(p, q, d):
    """The sign of p + q sqrt(d), d >= 0."""
    a, b = sign(p), sign(q) if d else 0
    if a == b or b == 0:
        return a
    if a == 0:
        return b
    return a * sign(p * p - q * q * d)


class Number:
    """(p + q sqrt(d)) / a with a > 0."""

    __slots__ = ("p", "q", "d", "a")

    def __init__(self, p, q=0, d=0, a=1):
        if a < 0:
            p, q, a = -p, -q, -a
        if q == 0 or d == 0:
            q = d = 0
        self.p, self.q, self.d, self.a = p, q, d, a

    @staticmethod
    def of(x):
        """The exact value of a finite float, an int or a Fraction."""
        n, m = x.as_integer_ratio()
        return Number(n, 0, 0, m)

    def cmp(self, other):
        """-1, 0 or 1: this number against another, or against a float (infinities included)."""
        if isinstance(other, float):
            if other in (float("inf"), float("-inf")):
                return -sign(other)
            other = Number.of(other)
        if not isinstance(other, Number):
            return -other.cmp(self)
        p = self.p * other.a - other.p * self.a
        q, r = self.q * other.a, -other.q * self.a
        if r == 0:
            return sign_surd(p, q, self.d)
        if q == 0:
            return sign_surd(p, r, other.d)
        x, y = sign_surd(p, q, self.d), sign(r)
        if x == y or x == 0:
            return y
        square = p * p + q * q * self.d - r * r * other.d
        return x * sign_surd(square, 2 * p * q, self.d)

    def rational(self, bits=160):
        """A Fraction within a relative 2^-bits or so."""
        if self.q == 0:
            return Fraction(self.p, self.a)
        shift = max(0, bits - self.d.bit_length() // 2) + 8
        root = Fraction(isqrt(self.d << (2 * shift)), 1 << shift)
        if self.p == 0 or sign(self.p) == sign(self.q):
            return (self.p + self.q * root) / self.a
        # Opposite signs: the other form has no cancellation.
        return Fraction(self.p * self.p - self.q * self.q * self.d) / ((self.p - self.q * root) * self.a)

    def __float__(self):
        return to_float(self.rational())

    def __repr__(self):
        return f"{float(self)!r}"


def to_float(x):
    try:
        return float(x)
    except OverflowError:
        return float("inf") * sign(x)


def sign_at(poly, t):
    """The sign of c0 + c1 t + c2 t^2 at a Number."""
    c0, c1, c2 = poly
    if not isinstance(t, Number):
        return t.sign_of(poly)
    p, q, d, a = t.p, t.q, t.d, t.a
    if q == 0:
        return sign((c2 * p + c1 * a) * p + c0 * a * a)
    return sign_surd(c0 * a * a + c1 * a * p + c2 * (p * p + q * q * d), c1 * a * q + 2 * c2 * p * q, d)


def slope_at(poly, t):
    """The sign of the derivative at a Number."""
    return sign_at((poly[1], 2 * poly[2], 0), t)


def roots(poly):
    """The real roots, ascending, each with its multiplicity; None if every number is one."""
    c0, c1, c2 = poly
    if c2 == 0:
        if c1 == 0:
            return None if c0 == 0 else []
        return [(Number(-c0, 0, 0, c1), 1)]
    disc = c1 * c1 - 4 * c0 * c2
    if disc < 0:
        return []
    if disc == 0:
        return [(Number(-c1, 0, 0, 2 * c2), 2)]
    s = sign(c2)
    return [(Number(-c1, -s, disc, 2 * c2), 1), (Number(-c1, s, disc, 2 * c2), 1)]


# Sets of numbers: lists of closed intervals (lo, hi), ascending, interiors disjoint; None stands for an infinite end. Two intervals
# that share an end say that the line touches the boundary there from within.

LINE = [(None, None)]


def below(poly):
    """Where the polynomial is <= 0."""
    found = roots(poly)
    if found is None:
        return LINE
    if not found:
        return LINE if (poly[2] or poly[0]) < 0 else []
    rising = sign(poly[2]) if poly[2] else sign(poly[1])
    first = found[0][0]
    if poly[2] == 0:
        return [(None, first)] if rising > 0 else [(first, None)]
    last = found[-1][0]
    return [(first, last)] if rising > 0 else [(None, first), (last, None)]


def later(a, b):
    """The greater of two lower ends."""
    return b if a is None else a if b is None else a if a.cmp(b) >= 0 else b


def sooner(a, b):
    """The lesser of two upper ends."""
    return b if a is None else a if b is None else a if a.cmp(b) <= 0 else b


def meets(lo, hi):
    """Whether [lo, hi] holds a number: -1 no, 0 one, 1 many."""
    return 1 if lo is None or hi is None else hi.cmp(lo)


def intersect(xs, ys):
    """What two sets have in common; a lone point beside an interval that has it as its end is dropped."""
    parts = []
    for a, b in xs:
        for c, d in ys:
            lo, hi = later(a, c), sooner(b, d)
            if meets(lo, hi) >= 0:
                parts.append((lo, hi))
    parts.sort(key=cmp_to_key(by_ends))
    kept = []
    for i, (lo, hi) in enumerate(parts):
        if meets(lo, hi) == 0:
            near = parts[max(0, i - 2) : i] + parts[i + 1 : i + 3]
            if any(meets(a, b) > 0 and holds(a, b, lo) for a, b in near):
                continue
            if kept and kept[-1][1] is not None and kept[-1][1].cmp(lo) == 0:
                continue
        kept.append((lo, hi))
    return kept


def by_ends(x, y):
    for a, b, none in ((x[0], y[0], -1), (x[1], y[1], 1)):
        if a is None or b is None:
            if a is not b:
                return none if a is None else -none
            continue
        c = a.cmp(b)
        if c:
            return c
    return 0


def holds(lo, hi, t):
    return (lo is None or lo.cmp(t) <= 0) and (hi is None or hi.cmp(t) >= 0)


def complement(xs):
    """The closure of what is outside."""
    outside, at = [], None
    for i, (lo, hi) in enumerate(xs):
        if meets(lo, hi) == 0:
            continue
        if lo is not None and (i == 0 or at is None or at.cmp(lo) < 0):
            outside.append((at, lo))
        if hi is None:
            return outside
        at = hi
    outside.append((at, None))
    return outside


def union(sets):
    """Where at least one of the sets is, as disjoint intervals longer than a point."""
    parts = sorted((p for xs in sets for p in xs if meets(*p) > 0), key=cmp_to_key(by_ends))
    merged = []
    for lo, hi in parts:
        if merged and (merged[-1][1] is None or lo is None or merged[-1][1].cmp(lo) >= 0):
            last = merged[-1]
            merged[-1] = (last[0], None if last[1] is None or hi is None else later(last[1], hi))
        else:
            merged.append((lo, hi))
    return merged
