"""Surfaces of any degree: the torus, the cyclide, and the zero sets of polynomials in x, y and z.

Along a ray the surface is a polynomial with whole-number coefficients. Sturm's theorem on whole numbers counts its real roots, separates them and
says on which side of a number each lies; the greatest common divisor with the derivative takes multiple roots apart.
"""

from fractions import Fraction as F
from functools import reduce
from math import gcd, isqrt, lcm

from exact import LINE, Number, complement, sign
from shapes import Answer, Event, Leaf, small, text, times


def trim(p):
    while p and p[-1] == 0:
        p.pop()
    return p


def primitive(p):
    p = trim(list(p))
    g = reduce(gcd, p, 0)
    return [x // g for x in p] if g else p


def remainder(a, b):
    """a mod b, times a positive number."""
    a = list(a)
    while len(a) >= len(b):
        top, lead = a[-1], b[-1]
        if lead < 0:
            top, lead = -top, -lead
        shift = len(a) - len(b)
        a = [x * lead for x in a]
        for i, x in enumerate(b):
            a[shift + i] -= x * top
        a.pop()
        trim(a)
    return primitive(a)


def derivative(p):
    return [i * x for i, x in enumerate(p)][1:]


def chain_of(p):
    chain = [p, primitive(derivative(p))]
    while len(chain[-1]) > 1:
        r = [-x for x in remainder(chain[-2], chain[-1])]
        if not r:
            break
        chain.append(r)
    return [q for q in chain if q]


def quotient(a, b):
    """a / b, which leaves no remainder, times a number."""
    a, out = [F(x) for x in a], []
    while len(a) >= len(b):
        q = a[-1] / b[-1]
        shift = len(a) - len(b)
        for i, x in enumerate(b):
            a[shift + i] -= q * x
        out.append(q)
        a.pop()
    common = reduce(lcm, (q.denominator for q in out))
    return primitive([int(q * common) for q in reversed(out)])


def value(p, x):
    """The sign of a polynomial at a Fraction."""
    n, m = x.numerator, x.denominator
    total, power = 0, 1
    for c in reversed(p):
        total = total * n + c * power
        power *= m
    return sign(total)


def value_over(p, x, e):
    """The value of a polynomial at x / 2^e, times 2^(e n)."""
    total, shift = 0, 0
    for c in reversed(p):
        total = total * x + (c << shift)
        shift += e
    return total


def changes(chain, x):
    signs = [s for s in (value(p, x) for p in chain) if s]
    return sum(a != b for a, b in zip(signs, signs[1:]))


class Root:
    """One real root of a polynomial with simple roots, the only one in (l, r), whose ends are dyadic; or the number l = r."""

    __slots__ = ("poly", "l", "r", "before", "after")

    def __init__(self, poly, l, r, before, after):
        self.poly, self.l, self.r, self.before, self.after = poly, l, r, before, after

    def against(self, x):
        """-1, 0 or 1: the root against a Fraction."""
        if self.l == self.r or x <= self.l or x >= self.r:
            return sign(self.l - x) if self.l == self.r else 1 if x <= self.l else -1
        s = value(self.poly, x)
        return 0 if s == 0 else -1 if s == value(self.poly, self.r) else 1

    def halve(self):
        m = (self.l + self.r) / 2
        c = self.against(m)
        if c == 0:
            self.l = self.r = m
        elif c < 0:
            self.r = m
        else:
            self.l = m

    def narrow(self, bits):
        """Until the interval is 2^-bits of its own size; a root at or near zero ends at 2^-6000.

        By quadratic interval refinement: a chord says in which of 2^k parts the root should be, and where that is so, the next step tries 2^2k (J. Abbott, "Quadratic interval
        refinement for real roots", ISSAC 2006).
        """
        if self.l == self.r:
            return
        # The ends are dyadic: whole numbers over 2^e.
        e = max(self.l.denominator, self.r.denominator).bit_length() - 1
        a, b, k = int(self.l * (1 << e)), int(self.r * (1 << e)), 2
        high = value(self.poly, self.r)
        while not (a * b > 0 and (b - a) << bits <= abs(a)) and (b - a) << 6000 >= 1 << e:
            low_value, high_value = value_over(self.poly, a, e), value_over(self.poly, b, e)
            width, a, b, e = b - a, a << k, b << k, e + k
            m = min(max((low_value << k) // (low_value - high_value), 1), (1 << k) - 1)
            x = a + m * width
            s = sign(value_over(self.poly, x, e))
            if s == 0:
                self.l = self.r = F(x, 1 << e)
                return
            # The other end of the part that the chord names, or of the one beside it.
            y = x - width if s == high else x + width
            s_y = -high if y == a else high if y == b else sign(value_over(self.poly, y, e))
            if s_y == 0:
                self.l = self.r = F(y, 1 << e)
                return
            a, b = (max(a, x), b) if s != high else (a, x)
            if s_y == s:
                a, b = (y, b) if s != high else (a, y)
                k = max(2, k // 2)
            else:
                a, b = min(x, y), max(x, y)
                k *= 2
            self.l, self.r = F(a, 1 << e), F(b, 1 << e)

    def rational(self, bits=160):
        self.narrow(bits)
        return (self.l + self.r) / 2

    def cmp(self, other):
        if isinstance(other, float):
            if other in (float("inf"), float("-inf")):
                return -sign(other)
            return self.against(F(other))
        if isinstance(other, Number) and other.q == 0:
            return self.against(F(other.p, other.a))
        if not isinstance(other, (Root, Number)):
            return -other.cmp(self)
        for bits in (60, 400, 1600, 6400):
            a, b = self.rational(bits), other.rational(bits)
            if isinstance(other, Root):
                if self.r < other.l or other.r < self.l:
                    return sign(a - b)
                if self.equals(other):
                    return 0
            elif abs(a - b) * (1 << (bits - 8)) > abs(a) + abs(b):
                return sign(a - b)
        return 0

    def equals(self, other):
        """Whether two roots, of different polynomials perhaps, are one number."""
        if self.l == self.r:
            return other.against(self.l) == 0
        if other.l == other.r:
            return self.against(other.l) == 0
        return self.sign_of(other.poly) == 0 and self.against(other.l) > 0 > self.against(other.r)

    def sign_of(self, q):
        """The sign of another polynomial, the constant first."""
        q = trim(list(q))
        if not q:
            return 0
        if len(q) == 1:
            return sign(q[0])
        a, b = (self.poly, primitive(q)) if len(self.poly) >= len(q) else (primitive(q), self.poly)
        while len(b) > 1:
            a, b = b, remainder(a, b)
        if not b and self.l != self.r and value(a, self.l) != value(a, self.r):
            return 0
        chain = chain_of(primitive(q))
        while True:
            l, r = value(q, self.l), value(q, self.r)
            if self.l == self.r or l == r != 0 and changes(chain, self.l) == changes(chain, self.r):
                return l
            self.halve()

    def __float__(self):
        try:
            return float(self.rational())
        except OverflowError:
            return float("inf") * sign(self.l)

    def __repr__(self):
        return f"{float(self)!r}"


def real_roots(p):
    """The distinct real roots, ascending, with the signs of p before and after; None if p is zero."""
    whole = primitive(p)
    if not whole:
        return None
    if len(whole) == 1:
        return []
    if len(whole) == 2:
        x = F(-whole[0], whole[1])
        return [Root(whole, x, x, sign(-whole[1]), sign(whole[1]))]
    chain = chain_of(whole)
    simple = whole
    if len(chain[-1]) > 1:
        simple = quotient(whole, chain[-1])
        chain = chain_of(simple)
    reach = F(1 << max(1, max(abs(c).bit_length() - abs(whole[-1]).bit_length() + 2 for c in whole)))
    out, todo = [], [(-reach, reach, changes(chain, -reach), changes(chain, reach))]
    while todo:
        l, r, a, b = todo.pop()
        if a - b == 1:
            # A root at zero would never be narrow against its own size.
            ends = (F(0), F(0)) if simple[0] == 0 and l < 0 < r else (l, r)
            out.append(Root(simple, *ends, value(whole, l), value(whole, r)))
        elif a - b > 1:
            m = (l + r) / 2
            while value(simple, m) == 0:
                m = (m + r) / 2
            c = changes(chain, m)
            todo += [(m, r, c, b), (l, m, a, c)]
    return out


def multiply(a, b):
    out = [0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            out[i + j] += x * y
    return out


class Field:
    """A polynomial in space: {(i, j, k): the factor of x^i y^j z^k}."""

    def __init__(self, terms):
        self.terms = {n: F(c) for n, c in terms.items() if c}
        self.order = max(sum(n) for n in self.terms)
        common = reduce(lcm, (c.denominator for c in self.terms.values()))
        self.ints = {n: int(c * common) for n, c in self.terms.items()}

    def along(self, ray):
        x, d, w = ray
        powers = []
        for a in range(3):
            rows = [[1]]
            for _ in range(self.order):
                rows.append(multiply(rows[-1], [x[a], d[a]]))
            powers.append(rows)
        out = [0] * (self.order + 1)
        for (i, j, k), c in self.ints.items():
            c *= w ** (self.order - i - j - k)
            for m, v in enumerate(multiply(multiply(powers[0][i], powers[1][j]), powers[2][k])):
                out[m] += c * v
        return out

    def value(self, p):
        return sum(c * p[0] ** i * p[1] ** j * p[2] ** k for (i, j, k), c in self.terms.items())

    def gradient(self, p):
        def slope(axis):
            total = F(0)
            for n, c in self.terms.items():
                if n[axis]:
                    m = [e - (a == axis) for a, e in enumerate(n)]
                    total += c * n[axis] * p[0] ** m[0] * p[1] ** m[1] * p[2] ** m[2]
            return total

        return tuple(slope(a) for a in range(3))

    def bend(self, p):
        """A bound of the second derivatives near p."""
        far = max(map(abs, p)) * F(5, 4)
        return sum(abs(c) * sum(n) * (sum(n) - 1) * far ** (sum(n) - 2) for n, c in self.terms.items() if sum(n) > 1)


class ZeroSet(Leaf):
    """Where a polynomial is <= 0."""

    def __init__(self, body, field, points, directions=(), size=1):
        super().__init__(body, points, directions, size)
        self.forms = [field]

    def solid(self):
        return not self.clip

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        field = self.forms[0]
        poly = field.along(ray)
        found = real_roots(poly)
        if found is None:
            return Answer([], LINE, True)
        flip = -1 if self.inverse else 1
        normals = [(field, flip)]
        events = [Event(r, flip * ((r.after > 0) - (r.after < 0) if r.before != r.after else 0), normals, self) for r in found]
        inside, lo = [], None
        starts_in = found[0].before < 0 if found else sign(trim(list(poly))[0]) < 0
        for r in found:
            if r.before < 0:
                inside.append((lo, r))
            lo = r
        if (found[-1].after < 0) if found else starts_in:
            inside.append((lo, None))
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, False)


# ---- scenes ----


def torus(rng):
    """About the y axis; ring, horn or spindle, with sin = r / R rational where there is a plane that touches it twice."""
    u = F(2) ** rng.choice((0, 0, -8, -8, 3, -20, 20))
    m, r, c = rng.choice(((5, 3, 4), (5, 4, 3), (13, 5, 12), (13, 12, 5), (1, 1, 0), (3, 5, 0), (4, 5, 0), (1000, 1, 0)))
    major, minor = m * 325 * u, r * 325 * u
    if rng.random() < 0.2:
        major, minor, c = F(rng.uniform(0.5, 2)), F(rng.uniform(0.01, 2)), 0
    q = {(2, 0, 0): 1, (0, 2, 0): 1, (0, 0, 2): 1, (0, 0, 0): -(major**2) - minor**2}
    terms = {(0, 2, 0): 4 * major**2, (0, 0, 0): -4 * major**2 * minor**2}
    for a, x in q.items():
        for b, y in q.items():
            n = tuple(i + j for i, j in zip(a, b))
            terms[n] = terms.get(n, 0) + x * y

    def points():
        (a, b), (p, q) = rng.choice(TURNS), rng.choice(TURNS)
        p, q = rng.choice((-1, 1)) * p, rng.choice((-1, 1)) * q
        rho = major + minor * p
        yield near((rho * a, minor * q, rho * b))
        # On the circles where a plane rests on it; the axis, its tips; where the plane through the middle touches.
        yield rng.choice((near((major * a, minor, major * b)), (F(0), F(0), F(0)), near((major * a, F(0), major * b))))
        if minor > major:
            h = minor**2 - major**2
            y = F(isqrt(h.numerator), isqrt(h.denominator))
            yield near((F(0), y, F(0)))
        elif c:
            yield near((major * F(c, m) * F(c, m), major * F(c, m) * F(r, m), F(0)))
            yield near((major * F(c, m) * F(c, m), major * F(c, m) * F(r, m), rng.choice((1, -1)) * minor * F(c, m)))

    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4), (4, 3, 0)]
    if c:
        # In the plane that touches it twice: its lines meet two circles (Y. Villarceau, 1848).
        ways += [(c, r, 0), (c, r, 0), (c, r, m), (c, r, -m), (2 * c, 2 * r, m)]
    return ZeroSet(f"torus {{ {text(major)}, {text(minor)} }}", Field(terms), points, ways, major + minor)


def product(a, b):
    out = {}
    for m, x in a.items():
        for n, y in b.items():
            k = tuple(i + j for i, j in zip(m, n))
            out[k] = out.get(k, 0) + x * y
    return out


def total(*parts):
    out = {}
    for part in parts:
        for n, x in part.items():
            out[n] = out.get(n, 0) + x
    return out


TURNS = [(F(1), F(0)), (F(0), F(1)), (F(3, 5), F(4, 5)), (F(4, 5), F(3, 5)), (F(5, 13), F(12, 13))]


def cyclide(rng):
    """Ring, horn or spindle; the planes y = 0 and z = 0 cut it in circles."""
    u = F(2) ** rng.choice((0, 0, -8, 3, -20, 20))
    a, c, d = rng.choice(((5, 3, 4), (5, 4, 2), (13, 5, 9), (5, 3, 3), (5, 3, 2), (3, 1, 4), (5, 3, 5), (64, 1, 2)))
    a, c, d = a * u, c * u, d * u
    if rng.random() < 0.2:
        a, c, d = F(rng.uniform(1, 2)), F(rng.uniform(0, 1)), F(rng.uniform(0.01, 3))
    bb = a * a - c * c
    q = {(2, 0, 0): 1, (0, 2, 0): 1, (0, 0, 2): 1, (0, 0, 0): -bb - d * d}
    l = {(0, 0, 0): 2 * a * d, (1, 0, 0): -2 * c}
    terms = total(product(q, q), {(0, 2, 0): 4 * bb}, {n: -x for n, x in product(l, l).items()})

    def points():
        p, q = rng.choice(TURNS)
        p, q = rng.choice((-1, 1)) * p, rng.choice((-1, 1)) * q
        yield near((-c + (a + d) * p, F(0), (a + d) * q))
        yield near((c + (a - d) * p, F(0), (a - d) * q))
        yield near((a + (d - c) * p, (d - c) * q, F(0)))
        yield near((-a + (d + c) * p, (d + c) * q, F(0)))
        # Double points of horns, highest points of the circles, the middle.
        yield rng.choice((near((a, F(0), F(0))), near((-a, d + c, F(0))), near((a, d - c, F(0))), (F(0), F(0), F(0))))

    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4), (4, 3, 0), (3, 4, 0)]
    return ZeroSet(f"cyclide {{ {text(a)}, {text(c)}, {text(d)} }}", Field(terms), points, ways, a + c + d)


def near(p):
    return tuple(F(float(x)) for x in p)


FAMOUS = [
    # Cayley's cubic, with four nodes; Steiner's surface, with three double lines; Whitney's umbrella; a cone of order three.
    ({(2, 0, 0): 1, (0, 2, 0): 1, (2, 0, 1): -1, (0, 2, 1): 1, (0, 0, 2): 1, (0, 0, 0): -1}, [(1, 0, 1), (-1, 0, 1), (0, 1, -1), (1, 0, 0)], [(0, 1, 0), (2, 0, 0), (0, 2, -2), (0, 1, 1)]),
    ({(2, 2, 0): 1, (0, 2, 2): 1, (2, 0, 2): 1, (1, 1, 1): -2}, [(0, 0, 0), (1, 1, 1), (F(1, 2), 0, 0), (0, F(1, 4), 0)], [(1, 1, 1), (0, 1, 0), (1, 2, 0)]),
    ({(2, 0, 0): 1, (0, 2, 1): -1}, [(0, 0, 0), (2, 1, 4), (0, 0, -3), (0, 0, 5)], [(0, 0, 1), (0, 1, 0), (1, 0, 0)]),
    ({(3, 0, 0): 1, (0, 3, 0): 1, (0, 0, 3): -1}, [(0, 0, 0), (1, 0, 1), (1, -1, 0)], [(1, 0, 1), (1, -1, 0)]),
    # The cushion x^8 + ... = 1, flat to the seventh order; a curve's cylinder y^2 = x^5 with a cusp; a sphere three times over.
    ({(8, 0, 0): 1, (0, 8, 0): 1, (0, 0, 8): 1, (0, 0, 0): -1}, [(1, 0, 0), (0, -1, 0), (0, 0, 1)], [(0, 1, 0), (1, 0, 2), (0, 0, 1)]),
    ({(0, 2, 0): 1, (5, 0, 0): -1}, [(0, 0, 0), (1, 1, 3), (4, 32, 0)], [(0, 1, 0), (1, 0, 0), (0, 0, 1)]),
    ({(6, 0, 0): 1, (0, 0, 6): 1, (3, 0, 3): -2, (0, 1, 0): -1}, [(0, 0, 0), (1, 0, 1), (1, 1, 0)], [(1, 0, 1), (0, 1, 0)]),
    ({(12, 0, 0): 1, (0, 12, 0): 1, (0, 0, 11): -1}, [(0, 0, 0), (1, 0, 1)], [(1, 0, 1), (0, 0, 1)]),
    ({(16, 0, 0): 1, (0, 14, 2): -3, (0, 0, 16): 2, (2, 2, 2): 1, (0, 0, 0): -1}, [(1, 0, 0), (-1, 0, 0)], [(0, 1, 0), (0, 0, 1)]),
]


def polynomial(rng):
    """Surfaces with names, and any others through a point with whole coordinates."""
    if rng.random() < 0.5:
        terms, on, ways = rng.choice(FAMOUS)
        terms = dict(terms)
    else:
        order = rng.choice((2, 3, 3, 4, 4, 5, 6, 7))
        terms, on, ways = {}, [tuple(F(x) for x in small(rng, 3))], [small(rng, 2)]
        while len(terms) < rng.randint(3, 12):
            n = tuple(rng.randint(0, order) for _ in range(3))
            if 0 < sum(n) <= order:
                terms[n] = F(rng.randint(-4, 4) or 1) if rng.random() < 0.8 else F(rng.uniform(-2, 2))
        if rng.random() < 0.7 and all(c.denominator < 5 for c in terms.values()):
            terms[0, 0, 0] = -Field(terms).value(on[0])
    if rng.random() < 0.3:
        terms = {n: -c for n, c in terms.items()}
    field = Field(terms)
    order = max(field.order, 2)

    def points():
        yield tuple(F(x) for x in rng.choice(on))
        yield tuple(F(x) for x in small(rng, 2))
        o, d = tuple(F(rng.randint(-3, 3)) for _ in range(3)), small(rng, 2)
        found = real_roots(field.along((tuple(int(x) for x in o), d, 1)))
        if found:
            yield near(tuple(a + rng.choice(found).rational() * b for a, b in zip(o, d)))

    spelled = lambda c: text(F(c))
    if rng.random() < 0.5:
        listed = ", ".join(f"xyz({i}, {j}, {k}): {spelled(c)}" for (i, j, k), c in field.terms.items())
        body = f"polynomial {{ {order}, {listed} }}"
    else:
        every = [(i, j, k) for i in range(order, -1, -1) for j in range(order - i, -1, -1) for k in range(order - i - j, -1, -1)]
        listed = "<" + ", ".join(spelled(field.terms.get(n, 0)) for n in every) + ">"
        body = {3: f"cubic {{ {listed} }}", 4: f"quartic {{ {listed} }}"}.get(order, f"poly {{ {order}, {listed} }}")
    return ZeroSet(body, field, points, [times(1, w) for w in ways], 2)
