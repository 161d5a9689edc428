"""Solids whose boundary is put together from zero sets of polynomials.

Along a ray everything that can change at the boundary changes at a root of one of a few polynomials in t, whole numbers all of them. Between two roots that follow
each other the ray is inside or outside, which one point tells, exactly; where it is the same before and after a root, the boundary is touched there or it is
not, which the value there tells. So a solid says two things: its polynomials along a ray, and whether a point is inside.

Square roots, where a solid has them, are taken to 2^-400 of their numbers: they are asked at points that are no roots, and the sign is plain.
"""

from fractions import Fraction as F
from functools import cmp_to_key, reduce
from math import isqrt, lcm

from exact import complement, sign
from shapes import Answer, Event, Leaf, Map, dot, small, sub, text, times, vec
from zero_sets import FAMOUS, Field, TURNS, multiply, near, real_roots, total, trim, product


# ---- polynomials in t with rational coefficients ----


def plus(a, b):
    n = max(len(a), len(b))
    return [(a[i] if i < len(a) else 0) + (b[i] if i < len(b) else 0) for i in range(n)]


def scaled(s, a):
    return [s * x for x in a]


def minus(a, b):
    return plus(a, scaled(-1, b))


def power(a, n):
    return reduce(multiply, [a] * n, [F(1)])


def whole(p):
    """The same roots and signs, whole numbers."""
    p = [F(x) for x in p]
    common = reduce(lcm, (x.denominator for x in p), 1)
    return trim([int(x * common) for x in p])


def at(p, t):
    return reduce(lambda total, c: total * t + c, reversed(p), F(0))


def places(ray):
    """The three coordinates along a local ray."""
    x, d, w = ray
    return [[F(a, w), F(b, w)] for a, b in zip(x, d)]


def root_of(x):
    """The square root of a Fraction that is not negative, to 2^-400 of it."""
    x = F(x)
    if x == 0:
        return F(0)
    shift = 400 + max(0, x.denominator.bit_length() - x.numerator.bit_length() + 1)
    return F(isqrt((x.numerator << (2 * shift)) // x.denominator), 1 << shift)


# ---- the solid ----


class Region(Leaf):
    """A solid; `certain` if every decision about it can be exact, else tangents may be told as clusters."""

    certain = True

    def solid(self):
        return not self.clip

    def candidates(self, ray):
        """Where the boundary may be met: (root, what has its normal there, whether a touch there is one of a smooth face)."""
        out = []
        for poly, source in self.polynomials(ray):
            found = real_roots(poly)
            if found is None:
                self.within = True
                continue
            out += [(r, source, True) for r in found]
        return out

    def normals(self, sources, p):
        return sources

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
            if before == after:
                t = root.rational(260)
                if abs(self.value(point(t))) > F(1, 1 << 90) * self.unit():
                    continue
            sources = self.normals([s for _, s, _ in group if s is not None], point(root.rational(80)))
            event = Event(root, 0 if before == after else flip * (1 if before else -1), [(s, flip) for s in sources], self)
            # A touch of an edge or a seam may be told or not.
            event.optional = before == after and (len(group) > 1 or not all(smooth for _, _, smooth in group))
            events.append(event)
            if before != after:
                if after:
                    start = root
                else:
                    inside.append((start, root))
        if states[-1]:
            inside.append((start, None))
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, self.within)

    def unit(self):
        """About the size of the value a length away from the surface."""
        return 1

    def steepness(self, p):
        """What grows where the solid's own surface is crossed, and not where its walls are."""
        return self.value(p)

    def is_tangent(self, ray, lo, hi):
        """Whether the value hardly changes along the ray about there: less than a millionth of what it could."""
        along = places(ray)
        middle, length = (F(lo) + F(hi)) / 2, self.size / max(abs(c[1]) for c in along)
        if any(not any(f.gradient(tuple(at(c, middle) for c in along))) for f in self.forms if isinstance(f, Slope)):
            return True
        step = max(length / (1 << 26), F(hi) - F(lo))
        values = [self.steepness(tuple(at(c, t) for c in along)) for t in (middle - step, middle + step)]
        return abs(values[1] - values[0]) * length * (1 << 20) <= 2 * step * self.unit()


def grouped(found):
    """Roots in order, equal ones together."""
    found = sorted(found, key=cmp_to_key(lambda a, b: order_of(a[0], b[0])))
    out = []
    for entry in found:
        if out and order_of(out[-1][0][0], entry[0]) == 0:
            out[-1].append(entry)
        else:
            out.append([entry])
    return out


def order_of(a, b):
    x, y = a.rational(60), b.rational(60)
    if abs(x - y) * (1 << 52) > abs(x) + abs(y) > F(1, 1 << 180):
        return sign(x - y)
    return -b.cmp(a) if hasattr(b, "num") else a.cmp(b)


def between(roots):
    """A number before the first root, between each two, and behind the last."""
    if not roots:
        return [F(0)]
    ends = [r.rational(64) for r in roots]
    out = [min(ends) - abs(min(ends)) / 1024 - 1]
    for a, b in zip(roots, roots[1:]):
        for bits in (64, 200, 800, 3200):
            x, y = a.rational(bits), b.rational(bits)
            if (y - x) * (1 << (bits - 20)) > abs(x) + abs(y):
                break
        out.append((x + y) / 2)
    return out + [max(ends) + abs(max(ends)) / 1024 + 1]


class Slope:
    """A gradient as a function, and a bound of the second derivatives."""

    def __init__(self, gradient, bend):
        self.gradient, self.bent = gradient, bend

    def bend(self, _):
        return self.bent


# ---- turned solids ----


class Turned(Region):
    """Between heights each a wall: ("cubic", at, four coefficients) or ("spindle", at, R, r)."""

    def __init__(self, body, heights, walls, points, directions, size):
        super().__init__(body, points, directions, size)
        self.heights, self.walls = [F(h) for h in heights], [(k, *map(F, rest)) for k, *rest in walls]
        self.fields = [self.field(w) for w in self.walls]
        self.forms = self.fields

    def field(self, wall):
        kind, at_, *a = wall
        v = {(0, 1, 0): F(1), (0, 0, 0): -at_}
        n = {(2, 0, 0): F(1), (0, 0, 2): F(1)}
        if kind == "cubic":
            terms, power_ = dict(n), {(0, 0, 0): F(1)}
            for c in a:
                terms = total(terms, {k: -c * x for k, x in power_.items()})
                power_ = product(power_, v)
            return Field(terms)
        major, minor = a
        q = total(n, product(v, v), {(0, 0, 0): major**2 - minor**2})
        return Field(total({k: 4 * major**2 * x for k, x in n.items()}, {k: -x for k, x in product(q, q).items()}))

    def normals(self, sources, p):
        """None at a tip or a pole, where they turn within less than what a bracket leaves open."""
        return sources if p[0] ** 2 + p[2] ** 2 > self.size**2 / (1 << 40) else []

    def wall_value(self, i, p):
        kind, at_, *a = self.walls[i]
        n, v = p[0] ** 2 + p[2] ** 2, p[1] - at_
        if kind == "cubic":
            return n - at(a, v)
        major, minor = a
        q = n + v * v + major**2 - minor**2
        return 4 * major**2 * n - q * q if q <= 0 else 4 * major**2 * n + q * q

    def value(self, p):
        y = p[1]
        ends = max(self.heights[0] - y, y - self.heights[-1])
        if ends > 0:
            return ends
        i = max(k for k in range(len(self.walls)) if self.heights[k] <= y)
        return max(ends, self.wall_value(i, p))

    def candidates(self, ray):
        y = places(ray)[1]
        out, ends = [], []
        for i, h in enumerate(self.heights):
            found = real_roots(whole(minus(y, [h])))
            outer = i in (0, len(self.heights) - 1)
            plane = (0, -1 if i == 0 else 1, 0)
            self.within |= found is None and outer
            out += [(r, plane if outer else None, False) for r in found or []]
            ends.append(found[0] if found else None)
        for i, field in enumerate(self.fields):
            lo, hi = self.heights[i], self.heights[i + 1]
            found = real_roots(field.along(ray))
            if found is None:
                self.within = True
                continue
            for r in found:
                s = [r.sign_of(whole(minus(y, [h]))) for h in (lo, hi)]
                if s[0] >= 0 >= s[1] and not (s[0] == 0 and s[1] == 0):
                    out.append((r, field, True))
        return out

    def unit(self):
        return self.size**4 if any(w[0] == "spindle" for w in self.walls) else self.size**2


def sor(rng):
    """Heights at equal steps, so that the coefficients are numbers of the text."""
    u = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    count, step = rng.randint(4, 7), rng.choice((1, 2, 4, F(1, 4)))
    radii = [F(rng.choice((0, 1, 1, 2, 3, 3, 5, 8))) * rng.choice((1, 1, F(1, 2))) for _ in range(count)]
    if not any(radii[1:-1]):
        radii[1] = F(3)
    base = rng.choice((0, -1, 3, -100))
    heights = [(base + k * step) * u for k in range(count)]
    radii = [r * u for r in radii]
    walls = []
    slope = lambda i: 2 * radii[i] * (radii[i + 1] - radii[i - 1]) / (heights[i + 1] - heights[i - 1])
    for i in range(1, count - 2):
        width = heights[i + 1] - heights[i]
        p0, p1, m0, m1 = radii[i] ** 2, radii[i + 1] ** 2, slope(i), slope(i + 1)
        secant = (p1 - p0) / width
        walls.append(("cubic", heights[i], p0, m0, (3 * secant - 2 * m0 - m1) / width, (m0 + m1 - 2 * secant) / width**2))
    listed = ", ".join(f"<{text(r)}, {text(h)}>" for r, h in zip(radii, heights))
    size = max(*radii, (heights[-2] - heights[1]) / 2)

    def points():
        c, s = rng.choice(TURNS)
        i = rng.randrange(1, count - 1)
        yield near((radii[i] * c, heights[i], radii[i] * s))
        # Where the profile is widest or narrowest, on a wall, on the axis.
        wall = rng.choice(walls)
        _, h, a0, a1, a2, a3 = wall
        v = step * u * rng.choice((F(1, 2), F(rng.random()), F(1, 4)))
        square = a0 + v * (a1 + v * (a2 + v * a3))
        if square >= 0:
            rho = root_of(square)
            yield near((rho * c, h + v, -rho * s))
        flat = real_roots(whole([a1, 2 * a2, 3 * a3])) if a1 or a2 or a3 else []
        for r in flat or []:
            v = r.rational()
            if 0 <= v <= step * u and at(wall[2:], v) >= 0:
                yield near((root_of(at(wall[2:], v)), h + v, F(0)))
        yield (F(0), rng.choice(heights), F(0))

    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4)]
    return Turned(f"sor {{ {count}, {listed} }}", heights[1:-1], walls, points, ways, size)


def profile_points(rng, heights, radius_at):
    c, s = rng.choice(TURNS)
    y = rng.choice((*heights, heights[0] + (heights[-1] - heights[0]) * F(rng.random())))
    square = radius_at(y)
    if square >= 0:
        yield near((root_of(square) * c, y, root_of(square) * s))
        yield near((-root_of(square), y, F(0)))
    yield (F(0), rng.choice(heights), F(0))


def ovus(rng):
    """Radii for which the linking torus has rational numbers: sides of Heron's triangles."""
    u = F(2) ** rng.choice((0, 0, -8, 5, -20, 20))
    a, b, centre_, major, low, high = rng.choice((
        (25, 10, -7, 24, 7, 33), (25, 20, 7, 24, -7, 37), (15, 20, 15, 20, -9, 15), (845, 910, 495, 840, -429, 1195), (1, 2, None, None, None, None),
        (3, 7, None, None, None, None),
    ))
    a, b = a * u, b * u
    ball = lambda h, r: ("cubic", h, r * r, 0, -1, 0)
    if major is None:
        heights, walls = [a - b, a + b], [ball(a, b)]
    else:
        r = 2 * max(a, b)
        centre_, major, low, high = centre_ * u, major * u, low * u, high * u
        heights, walls = [-a, low, high, a + b], [ball(F(0), a), ("spindle", centre_, major, r), ball(a, b)]

    def square(y):
        i = max(k for k in range(len(walls)) if heights[k] <= y or k == 0)
        kind, h, *w = walls[i]
        if kind == "cubic":
            return at(w, y - h)
        rest = w[1] ** 2 - (y - h) ** 2
        return (root_of(rest) - w[0]) ** 2 if rest >= 0 else F(-1)

    def points():
        yield from profile_points(rng, heights, square)

    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4), (3, 4, 0)]
    return Turned(f"ovus {{ {text(a)}, {text(b)} }}", heights, walls, points, ways, max(a, b))


def lemon(rng):
    u = F(2) ** rng.choice((0, 0, -8, 5, -20, 20))
    inner, h, back = rng.choice(((5, 8, 3), (5, 6, 4), (13, 24, 5), (13, 10, 12), (17, 16, 15), (65, 2 * 63, 16)))
    radius = rng.choice((0, 0, 1, 2, F(1, 2)))
    inner, h, back, radius = inner * u, h * u, back * u, radius * u
    major, middle = back - radius, h / 2

    def inward(end, step):
        """A tip: the solid ends the first power of two inward at which the sheet is reached, in f64."""
        y, k = end, 0
        while radius == 0 and (F(y) - middle) ** 2 >= inner**2 - major**2:
            k += 1
            y = end + step * 2.0 ** (k - 53)
        return F(y)

    heights = [inward(0.0, float(h)), inward(float(h), -float(h))]

    def square(y):
        rest = inner**2 - (y - middle) ** 2
        return (root_of(rest) - major) ** 2 if rest >= 0 else F(-1)

    def points():
        yield from profile_points(rng, heights, square)

    body = f"lemon {{ <0, 0, 0>, {text(radius)}, <0, {text(h)}, 0>, {text(radius)}, {text(inner)} }}"
    return Turned(body, heights, [("spindle", middle, major, inner)], points, [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4)], max(h / 2, inner - major))


# ---- formulas ----


class Formula(Region):
    """Where a polynomial is negative, within a box or a ball."""

    certain = False

    def __init__(self, body, field, walls, points, directions, size):
        super().__init__(body, points, directions, size)
        self.walls, self.inner, self.forms = walls, field, [field, *walls]

    def polynomials(self, ray):
        return [(f.along(ray), f) for f in self.forms]

    def value(self, p):
        return max(f.value(p) for f in self.forms)

    def steepness(self, p):
        return self.inner.value(p)


def isosurface(rng):
    terms, on, ways = rng.choice([f for f in FAMOUS if max(sum(n) for n in f[0]) <= 8])
    field = Field(dict(terms))
    spelled = " + ".join("*".join([f"({text(c)})"] + [f"pow({v},{e})" if e > 1 else v for v, e in zip("xyz", n) if e]) for n, c in field.terms.items())
    if rng.random() < 0.5:
        half = rng.choice((1, 2, 3, F(1, 2)))
        centre_ = rng.choice(((0, 0, 0), (1, 0, 0), rng.choice(on)))
        lo, hi = tuple(c - half for c in centre_), tuple(c + half for c in centre_)
        walls = []
        for i in range(3):
            e = tuple(int(i == j) for j in range(3))
            walls += [Field({e: -1, (0, 0, 0): lo[i]}), Field({e: 1, (0, 0, 0): -hi[i]})]
        container = f"box {{ {vec(lo)}, {vec(hi)} }}"
        size = half
    else:
        centre_, size = (F(0), F(0), F(0)), F(rng.choice((1, 2, 3)))
        walls = [Field({(2, 0, 0): 1, (0, 2, 0): 1, (0, 0, 2): 1, (0, 0, 0): -size * size})]
        container = f"sphere {{ 0, {text(size)} }}"

    def points():
        yield tuple(F(x) for x in rng.choice(on))
        yield tuple(F(c) + size * rng.choice((-1, 0, 1, F(1, 2))) for c in centre_)
        o, d = tuple(F(rng.randint(-3, 3)) for _ in range(3)), small(rng, 2)
        found = real_roots(field.along((tuple(int(x) for x in o), d, 1)))
        if found:
            yield near(tuple(a + rng.choice(found).rational() * b for a, b in zip(o, d)))

    return Formula(f"isosurface {{ function {{ {spelled} }} contained_by {{ {container} }} }}", field, walls, points, [times(1, w) for w in ways], size)


# ---- superellipsoids ----


class Superellipsoid(Region):
    """(|x|^p + |y|^p)^(q/p) + |z|^q = 1; p and q are powers of two."""

    certain = False

    def __init__(self, body, p, q, points, directions):
        super().__init__(body, points, directions, 1)
        self.p, self.q, self.forms = p, q, [self.slope()]

    def polynomials(self, ray):
        x, y, z = places(ray)
        out = [(whole(c), None) for c in (x, y, z)]
        # In each of the octants a polynomial; those that belong to others come to nothing.
        turns = [(1, 1, 1)]
        if self.p <= 1 or self.q <= 1:
            turns = [(a, b, c) for a in (1, -1) for b in (1, -1) for c in (1, -1)]
        seen = set()
        for a, b, c in turns:
            poly = whole(self.octant(scaled(a, x), scaled(b, y), scaled(c, z)))
            key = tuple(poly)
            if key not in seen:
                seen.add(key)
                out.append((poly, self.slope()))
        return [e for e in out if e[0]] if any(not e[0] for e in out) else out

    def octant(self, x, y, z):
        p, q, one = self.p, self.q, [F(1)]
        if p >= 1 and q >= 1:
            a, b = plus(power(x, int(p)), power(y, int(p))), minus(one, power(z, int(q)))
            return minus(power(a, int(q / p)), b) if q >= p else minus(a, power(b, int(p / q)))
        s = plus(x, y)
        if (p, q) == (F(1, 2), F(1, 2)):
            # √x + √y = 1 - √z  =>  2√(xy) = b - 2√z, b = 1 + z - x - y  =>  (4xy - b² - 4z)² = 16 b² z
            b = minus(plus(one, z), s)
            left = minus(minus(scaled(4, multiply(x, y)), multiply(b, b)), scaled(4, z))
            return minus(multiply(left, left), scaled(16, multiply(multiply(b, b), z)))
        if (p, q) == (F(1, 2), 1):
            b = minus(minus(one, z), s)
            return minus(scaled(4, multiply(x, y)), multiply(b, b))
        if (p, q) == (1, F(1, 2)):
            b = minus(plus(one, z), s)
            return minus(scaled(4, z), multiply(b, b))
        if (p, q) == (F(1, 2), 2):
            b = minus(one, multiply(z, z))
            d = minus(x, y)
            left = plus(b, multiply(d, d))
            return minus(multiply(left, left), scaled(4, multiply(b, multiply(s, s))))
        n, e, f = plus(multiply(x, x), multiply(y, y)), minus(one, z), plus(one, z)
        left = plus(multiply(e, e), n)
        return minus(multiply(left, left), scaled(4, multiply(multiply(f, f), n)))

    def raised(self, x, e):
        """x >= 0 to a power that is a power of two."""
        while e < 1:
            x, e = root_of(x), e * 2
        return x ** int(e)

    def value(self, p):
        x, y, z = map(abs, p)
        if max(x, y, z) > 2:
            return F(1)
        a = self.raised(x, self.p) + self.raised(y, self.p)
        return self.raised(a, F(self.q) / self.p) + self.raised(z, self.q) - 1

    def slope(self):
        def gradient(p):
            a, b, c = map(abs, p)
            tiny = F(1, 1 << 40)
            if self.p < 2 and min(a, b) < tiny or self.q < 2 and (c < tiny or max(a, b) < tiny):
                return (F(0), F(0), F(0))
            s = self.raised(a, self.p) + self.raised(b, self.p)
            if s == 0:
                return (F(0), F(0), F(sign(p[2])))
            outer = self.q * self.raised(s, F(self.q) / self.p) / s
            part = lambda x: sign(x) * self.raised(abs(x), self.p) / abs(x) if x else F(0)
            return (outer * part(p[0]), outer * part(p[1]), self.q * sign(p[2]) * self.raised(c, self.q) / c if c else F(0))

        class Near(Slope):
            def bend(self, p):
                # Powers below two bend without bound where a coordinate vanishes.
                least = min(map(abs, p))
                return F(1000) / max(least, F(1, 1 << 40)) ** 2

        return Near(gradient, 0)


def superellipsoid(rng):
    p, q = rng.choice(((2, 2), (4, 4), (8, 8), (2, 4), (4, 2), (2, 8), (8, 2), (1, 1), (1, 2), (2, 1), (1, 4), (4, 1),
                       (F(1, 2), F(1, 2)), (F(1, 2), 1), (1, F(1, 2)), (F(1, 2), 2), (2, F(1, 2))))
    p, q = F(p), F(q)
    body = f"superellipsoid {{ <{text(2 / p)}, {text(2 / q)}> }}"

    def points():
        e = [F(0), F(0), F(0)]
        e[rng.randrange(3)] = F(rng.choice((-1, 1)))
        yield tuple(e)
        yield (F(0), F(0), F(0))
        # On the surface: in a plane of coordinates, and anywhere.
        leaf = Superellipsoid(body, p, q, None, [])
        d = tuple(F(rng.choice((0, 1, 1, 2, 3, rng.randint(-5, 5)))) for _ in range(3))
        if any(d):
            lo, hi = F(0), F(2)
            for _ in range(70):
                m = (lo + hi) / 2
                lo, hi = (m, hi) if leaf.value(times(m, d)) < 0 else (lo, m)
            yield near(times(lo, d))
            yield near(times(lo, (d[1], -d[0], d[2])))

    ways = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 1, 1), (0, 1, -1)]
    return Superellipsoid(body, p, q, points, ways)


# ---- blobs ----


class Blob(Region):
    """The sum of S (1 - q)² over the components is T. Components: (S, R, A, B or None, map)."""

    certain = False

    def __init__(self, body, threshold, parts, points, directions, size):
        super().__init__(body, points, directions, size)
        self.threshold, self.parts = threshold, parts

    def pieces(self, part, ray):
        """A component along a ray: (bounds, in which case which polynomial q); bounds are polynomials."""
        strength, radius, a, b, m = part
        x, d, w = ray
        # The ray in the component's frame.
        rows = [[F(e, m.w) for e in r] for r in m.n]
        start = sub(tuple(F(e, w) for e in x), m.c)
        along = [[dot(r, start), dot(r, tuple(F(e, w) for e in d))] for r in rows]
        rel = [minus(c, [e]) for c, e in zip(along, a)]
        ball = lambda rel: scaled(1 / radius**2, reduce(plus, (multiply(c, c) for c in rel)))
        if b is None:
            return [], lambda t: ball(rel)
        v = sub(b, a)
        vv = dot(v, v)
        h = reduce(plus, (scaled(e, c) for e, c in zip(v, rel)))
        side = minus(ball(rel), scaled(1 / (vv * radius**2), multiply(h, h)))
        far = ball([minus(c, [e]) for c, e in zip(rel, v)])
        return [h, minus(h, [vv])], lambda t: ball(rel) if at(h, t) <= 0 else far if at(h, t) >= vv else side

    def candidates(self, ray):
        borders, parts = [], []
        for part in self.parts:
            bounds, q = self.pieces(part, ray)
            ends = list(bounds)
            # Where q is 1 in each of its forms.
            forms = [q(F(0))] if not bounds else None
            if forms is None:
                rest = real_roots(whole(bounds[0])), real_roots(whole(bounds[1]))
                marks = sorted(r[0].rational(100) for r in rest if r)
                tests = [F(0)] if not marks else [marks[0] - 1, sum(marks) / len(marks), marks[-1] + 1]
                forms = [q(t) for t in tests]
            for form in forms:
                ends.append(minus(form, [F(1)]))
            for e in ends:
                borders += [(r, None, False) for r in real_roots(whole(e)) or []]
            parts.append((part[0], q))
        groups = grouped(borders)
        edges = [g[0][0] for g in groups]
        out, source = [], self.slope()
        for i, t in enumerate(between(edges)):
            lo, hi = edges[i - 1] if i else None, edges[i] if i < len(edges) else None
            poly = [-self.threshold]
            for strength, q in parts:
                form = q(t)
                if at(form, t) < 1:
                    rest = minus([F(1)], form)
                    poly = plus(poly, scaled(strength, multiply(rest, rest)))
            found = real_roots(whole(poly))
            for r in found or []:
                if (lo is None or r.cmp(lo) >= 0) and (hi is None or r.cmp(hi) <= 0):
                    out.append((r, source, True))
        return out

    def fields(self, p):
        for strength, radius, a, b, m in self.parts:
            y = sub(p, m.c)
            y = tuple(F(dot(r, y)) / m.w for r in m.n)
            rel = sub(y, a)
            if b is not None:
                v = sub(b, a)
                s = min(max(dot(rel, v) / dot(v, v), F(0)), F(1))
                rel = sub(rel, times(s, v))
            q = dot(rel, rel) / radius**2
            if q < 1:
                yield strength, q, rel, radius, m

    def value(self, p):
        return self.threshold - sum(s * (1 - q) ** 2 for s, q, *_ in self.fields(p))

    def slope(self):
        def gradient(p):
            g = (F(0), F(0), F(0))
            for s, q, rel, radius, m in self.fields(p):
                inner = m.normal(times(4 * s * (1 - q) / radius**2 / m.w, rel))
                g = tuple(a + b for a, b in zip(g, inner))
            return g

        bend = sum(24 * abs(s) / r**2 * max(abs(F(e, m.w)) for row in m.n for e in row) ** 2 for s, r, _, _, m in self.parts)
        return Slope(gradient, bend)

    def unit(self):
        return self.threshold


def blob(rng):
    u = F(2) ** rng.choice((0, 0, -8, 5, -20, 20))
    threshold = F(rng.choice((1, 1, F(1, 4), F(1, 2), 9, F(1, 64))))
    parts, words, anchors = [], [], []
    for i in range(rng.choice((1, 1, 2, 2, 3, 5))):
        strength = threshold * rng.choice((4, 1, 2, F(1, 2), 100)) * (rng.choice((1, 1, -1)) if i else 1)
        if threshold == 9 and rng.random() < 0.5:
            strength = F(16)
        if i == 0 and strength < threshold:
            strength = 4 * threshold
        radius = u * rng.choice((1, 2, 2, 4, 5))
        a = tuple(F(rng.randint(-3, 3)) * u for _ in range(3)) if i else (F(0), F(0), F(0))
        if i and rng.random() < 0.3:
            # So that the fields begin at one point: balls that touch.
            a = (rng.choice((2, 4, -4, 1)) * u, F(0), F(0))
        b = None
        place, placed = Map(words=""), ""
        if rng.random() < 0.4:
            b = tuple(x + rng.choice((0, 1, -1, 2, 4)) * u for x in a)
            b = None if b == a else b
        if rng.random() < 0.3:
            rows = rng.choice((((1, 0, 0), (0, 2, 0), (0, 0, 1)), ((1, 1, 0), (0, 1, 0), (0, 0, 1)), ((0, -1, 0), (1, 0, 0), (0, 0, F(1, 2)))))
            place = Map(rows, tuple(F(rng.choice((0, 1, -2))) * u for _ in range(3)))
            placed = " " + place.sdl()
        parts.append((strength, radius, a, b, place))
        anchors.append(place.point(a))
        if b is None:
            words.append(f"sphere {{ {vec(a)}, {text(radius)}, strength {text(strength)}{placed} }}" if placed or rng.random() < 0.7 else f"component {text(strength)}, {text(radius)}, {vec(a)}")
        else:
            anchors.append(place.point(b))
            words.append(f"cylinder {{ {vec(a)}, {vec(b)}, {text(radius)}, strength {text(strength)}{placed} }}")
    leaf = None

    def points():
        strength, radius, a, b, place = rng.choice(parts)
        # Exact where a strong ball is alone: 1 - q = 1/2 or 3/4.
        yield place.point(tuple(x + d for x, d in zip(a, rng.choice(((radius / 2, 0, 0), (radius / 2, radius / 2, 0), (0, 0, -radius / 2), (0, radius, 0))))))
        yield rng.choice(anchors)
        o = rng.choice(anchors)
        d = times(u, small(rng, 2))
        ray = (tuple(map(float, o)), tuple(map(float, d)))
        found = leaf.answer(*ray, Map(words="")).events
        if found:
            t = rng.choice(found).t.rational()
            yield near(tuple(a + t * b for a, b in zip(o, d)))

    ways = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -1, 0), (0, 1, 1)]
    leaf = Blob(f"blob {{ threshold {text(threshold)} {' '.join(words)} }}", threshold, parts, points, ways, 2 * u)
    leaf.forms = [leaf.slope()]
    return leaf


# ---- Julia sets ----


def quaternion(a, b, add_=plus, mul=multiply, sub_=minus):
    s = lambda i, j: mul(a[i], b[j])
    return [
        sub_(sub_(s(0, 0), s(1, 1)), add_(s(2, 2), s(3, 3))),
        add_(add_(s(0, 1), s(1, 0)), sub_(s(2, 3), s(3, 2))),
        add_(sub_(s(0, 2), s(1, 3)), add_(s(2, 0), s(3, 1))),
        add_(add_(s(0, 3), s(1, 2)), sub_(s(3, 0), s(2, 1))),
    ]


def hypercomplex(a, b, add_=plus, mul=multiply, sub_=minus):
    s = lambda i, j: mul(a[i], b[j])
    return [
        add_(sub_(s(0, 0), add_(s(1, 1), s(2, 2))), s(3, 3)),
        sub_(add_(s(0, 1), s(1, 0)), add_(s(2, 3), s(3, 2))),
        sub_(add_(s(0, 2), s(2, 0)), add_(s(1, 3), s(3, 1))),
        add_(add_(s(0, 3), s(3, 0)), add_(s(1, 2), s(2, 1))),
    ]


class Julia(Region):
    """The points with |z_n| <= R for n = 0 .. N - 1."""

    certain = False

    def __init__(self, body, c, rule, cube, count, radius, slice_, points, directions):
        super().__init__(body, points, directions, 2)
        self.c, self.rule, self.cube, self.count, self.radius, self.slice, self.forms = c, rule, cube, count, radius, slice_, []

    def orbit(self, p, add_, mul, sub_, one):
        n, distance = self.slice
        w = sub_(scale_by(distance / n[3], one), reduce(add_, (scale_by(n[i] / n[3], p[i]) for i in range(3))))
        z = [*p, w]
        for step in range(self.count):
            yield z
            if step + 1 < self.count:
                square = self.rule(z, z, add_, mul, sub_)
                z = self.rule(square, z, add_, mul, sub_) if self.cube else square
                z = [add_(a, scale_by(c, one)) for a, c in zip(z, self.c)]

    def polynomials(self, ray):
        out = []
        for z in self.orbit(places(ray), plus, multiply, minus, [F(1)]):
            size = reduce(plus, (multiply(a, a) for a in z))
            out.append((whole(minus(size, [self.radius**2])), None))
        return out

    def value(self, p):
        worst = None
        for z in self.orbit(p, lambda a, b: a + b, lambda a, b: a * b, lambda a, b: a - b, F(1)):
            size = sum(a * a for a in z) - self.radius**2
            if size > 10**6:
                return size
            worst = size if worst is None else max(worst, size)
        return worst


def scale_by(s, x):
    return [s * e for e in x] if isinstance(x, list) else s * x


def julia(rng):
    count = rng.choice((1, 2, 3, 3, 4)) if rng.random() < 0.6 else 2
    cube = rng.random() < 0.4
    if cube:
        count = min(count, 3)
    kind = rng.choice(("quaternion", "hypercomplex"))
    c, length = rng.choice((
        ((F(-1), F(1, 4), F(0), F(0)), None), ((F(1, 4), F(1, 2), F(1, 2), F(1, 4)), None), ((F(1, 2), F(0), F(0), F(0)), F(1, 2)), ((F(0), F(0), F(0), F(0)), F(0)),
        ((F(1, 4), F(-1, 4), F(1, 4), F(-1, 4)), F(1, 2)), ((F(3, 8), F(0), F(-1, 2), F(0)), F(5, 8)), ((F(-9, 8), F(0), F(0), F(1, 8)), None),
    ))
    if length is None and kind == "quaternion" and sum(x * x for x in c) < 1:
        c, length = (F(1, 4), F(-1, 4), F(1, 4), F(-1, 4)), F(1, 2)
    radius = F(4) if kind == "hypercomplex" else min(F(2), 1 + length) if length is not None else F(2)
    normal, norm = rng.choice((((0, 0, 0, 1), 1), ((0, 0, 0, 1), 1), ((1, 2, 2, 4), 5), ((0, 3, 0, -4), 5), ((1, 1, 1, 1), 2)))
    normal = tuple(F(x) for x in normal)
    distance = rng.choice((F(0), F(0), F(1, 8), F(-1, 4)))
    rule = quaternion if kind == "quaternion" else hypercomplex
    listed = lambda v: "<" + ", ".join(text(x) for x in v) + ">"
    body = f"julia_fractal {{ {listed(c)} {kind} {'cube' if cube else 'sqr'} max_iteration {count} slice {listed(normal)}, {text(distance)} }}"
    leaf = None

    def points():
        yield (F(0), F(0), F(0))
        yield near(tuple(F(rng.uniform(-1, 1)) for _ in range(3)))
        o, d = (F(0), F(0), F(0)), small(rng, 3)
        found = leaf.answer(tuple(map(float, o)), tuple(map(float, d)), Map(words="")).events
        if found:
            t = rng.choice(found).t.rational()
            yield near(times(t, d))

    leaf = Julia(body, c, rule, cube, count, radius, (normal, distance * norm), points, [(1, 0, 0), (0, 1, 0), (0, 0, 1)])
    return leaf
