"""Rounded surfaces: formulas of polynomials within a container, superellipsoids, blobs, Julia sets of few iterations.

All are regions between the roots of their polynomials (`solids.py`). What rounding leaves open on them is told as clusters.
"""

from fractions import Fraction as F
from functools import reduce

from exact import sign
from shapes import Map, dot, small, sub, text, times, vec
from solids import Region, Slope, at, between, grouped, minus, multiply, places, plus, power, root_of, scaled, whole
from zero_sets import FAMOUS, Field, near, real_roots


# ---- formulas ----


class Formula(Region):
    """Where a polynomial is negative, within a box or a ball."""

    certain = False

    def __init__(self, body, field, walls, points, directions, size):
        super().__init__(body, points, directions, size)
        self.walls, self.inner, self.forms = walls, field, [field, *walls]

    def polynomials(self, ray):
        return [(f.along(ray), f) for f in self.forms]

    def is_met(self, root, ray):
        return max(root.sign_of(f.along(ray)) for f in self.forms) == 0

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

    def is_met(self, root, ray):
        """Beyond |z| = 1 there is none of it, only of what squaring adds, by which the least of numbers may be off."""
        z = places(ray)[2]
        return root.sign_of(whole(minus([F(1)], multiply(z, z)))) >= 0 and super().is_met(root, ray)

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

    def passes_an_edge(self, ray, lo, hi):
        """There is none: where fields begin the surface is smooth."""
        return False


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
