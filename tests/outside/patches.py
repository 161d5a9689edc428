"""Patches: ruled ones of any degree along one parameter (bilinear ones among them), and graphs of polynomials of both parameters.

A ray is where two planes meet. On a ruled patch `A(u) + v (B(u) - A(u))` each plane gives an equation that is linear in `v`; what is left when `v` is eliminated is one polynomial in `u`, and `v` and the
ray's `t` are quotients of polynomials in `u`. On a graph `(k u, f(u, v), l v)` the two parameters are linear in `t`, so that one polynomial in `t` is left. Every patch is taken through affine maps, so
the patch has no place of its own that these two kinds would favour.
"""

from fractions import Fraction as F
from math import comb

from lathes import Image, slope
from exact import sign
from shapes import Answer, Event, cross, dot, sub, vec
from solids import Region, at, grouped, minus, places, plus, scaled, whole
from zero_sets import multiply, near, real_roots


class Quotient(Image):
    """The number p(u) / q(u) of an algebraic number u, where q(u) is not zero."""

    def __init__(self, root, p, q):
        super().__init__(root, p)
        self.q = [F(a) for a in q]
        self.side = root.sign_of(whole(self.q))

    def bound(self):
        def enclosed(p):
            u, v = self.root.l, self.root.r
            far = max(abs(u), abs(v))
            spread = sum(k * abs(a) * far ** (k - 1) for k, a in enumerate(p) if k) * (v - u) / 2
            value = at(p, (u + v) / 2)
            return value - spread, value + spread

        (a, b), (c, d) = enclosed(self.p), enclosed(self.q)
        if c <= 0 <= d:
            # Not narrow enough yet.
            self.l, self.r = F(-1), F(1)
            return
        ends = [x / y for x in (a, b) for y in (c, d)]
        self.l, self.r = min(ends), max(ends)

    def against(self, x):
        return self.root.sign_of(whole(minus(self.p, scaled(F(x), self.q)))) * self.side

    def sign_of(self, poly):
        """The sign of a polynomial there: with as many factors q as it has degrees."""
        out, power = [F(0)], [F(1)]
        for a in reversed([F(a) for a in poly]):
            out = plus(multiply(out, self.p), scaled(a, power))
            power = multiply(power, self.q)
        return self.root.sign_of(whole(out)) * self.side ** (len(poly) - 1)


class Tangents:
    """The normal at a place of a patch, how it changes with the point, and whether a crossing there may be told without proof."""

    def __init__(self, normal, bend, is_open=False):
        self.normal, self.bent, self.is_open = normal, bend, is_open

    def gradient(self, _):
        return self.normal

    def bend(self, _):
        return self.bent


# The unit of roundings.
U = F(1, 1 << 53)
# How many roundings a function of the command makes, each of a length that is not larger than those in `Patch.error`. One of a control point and 40 of a sum of 5 by 5 Bernstein
# polynomials count twice, as the ray is sheared (the slope is 1 at most), and 1.2 times, as parts are evaluated a little beyond their edges: 98.4. The differences and products of
# the shear round 8 times; three numbers of a map and of its inverse, and the re-centred origin, 16 times.
ROUNDINGS = 128
# Nothing is searched farther beyond an edge, in parameters: the command's bounds hold there (docs/numerics.md).
MARGIN = F(1, 16)


class Doubt:
    """What rounding leaves open at a crossing, from the slopes there of both functions F of u and v that vanish on the ray (all three coordinates, less those of the ray where the
    largest one of its direction is the same).

    Let Y be the inverse of the slopes, `error` the error of F and h a bound on |F_uu| + 2 |F_uv| + |F_vv|. Newton's method ends with a step of at most 2 e, e = |Y| error. Krawczyk's
    test in a box of half-width r = 4 (step + e) <= 12 e proves the crossing if slopes change in it by less than half of themselves, c = r |Y| h <= 1/2; the bound on second derivatives
    holds a part's margin too, and may be four times that of the place. It is then within e + c r of the place that is told, which counts if that may be on the patch. So a
    crossing may be told that is 2 (e + c r) beyond an edge; one as far before it is within rounding of the edge.
    """

    def __init__(self, slopes, d, error, h):
        k = max(range(3), key=lambda i: abs(d[i]))
        (a, b), (c, e) = [[s[i] - d[i] / d[k] * s[k] for s in slopes] for i in range(3) if i != k]
        det = abs(a * e - b * c)
        rates = [(abs(e) + abs(b)) / det, (abs(a) + abs(c)) / det] if det else [1 / error] * 2
        r = 12 * max(rates) * error
        change = r * max(rates) * 4 * h
        self.is_open = not det or 2 * change > 1
        # Parameters round, too.
        self.slack = [min(MARGIN, 2 * (rate * error + min(change, F(1, 2)) * r) + 16 * U) for rate in rates]


def size_of(p):
    """A bound on a polynomial where its unknown is within the margin of [0, 1]."""
    return sum(abs(a) * (1 + MARGIN) ** k for k, a in enumerate(p))


class Patch(Region):
    certain = exact_ends = False

    def __init__(self, body, points, directions, size):
        super().__init__(body, points, directions, size)
        self.known, self.forms = {}, [self]

    def solid(self):
        return False

    def gradient(self, p):
        """Only of the points that rays are aimed at."""
        return self.known.get(p, (F(0), F(0), F(0)))

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        self.within = False
        groups = grouped(self.meetings(ray))
        flip = -1 if self.inverse else 1
        events = []
        self.met = [(t, n) for group in groups for t, n, _, _ in group]
        for group in groups:
            for t, normal, on_border, turn in group:
                event = Event(t, flip * turn, [(normal, flip)] if normal else [], self)
                event.optional = on_border
                events.append(event)
        return Answer(self.clipped(events, ray), [], self.within)

    def passes_an_edge(self, ray, lo, hi):
        return False

    def passes_the_border(self, ray, lo, hi):
        """Whether rounding decides if what is met in a bracket is on the surface, beyond what crossings on borders say."""
        return False

    def is_tangent(self, ray, lo, hi):
        """Whether a crossing that may not be proven, or a place where two of them come and go, is in a cluster's bracket: that holds all that is open, but for the error along the ray."""
        wide = self.error(ray) / max(abs(F(x, ray[2])) for x in ray[1])
        near_ = lambda t: F(lo) - wide <= t <= F(hi) + wide
        return any(near_(t) for t in self.low_places(ray)) or any(near_(t.rational(100)) and (n is None or n.is_open) for t, n, _, _ in self.meetings(ray))

    def error(self, ray):
        """How far off the command may count points of the patch and the ray to be: roundings of the numbers on the way there and back."""
        stretch = max(abs(x) for row in self.whole.rows for x in row) * max(abs(F(x, self.whole.w)) for row in self.whole.n for x in row)
        moved = max(abs(F(dot(row, self.whole.c))) / self.whole.w for row in self.whole.n)
        return ROUNDINGS * U * stretch * (self.size + moved + max(abs(F(x, ray[2])) for x in ray[0]))


def bernstein(rows):
    """The powers of a Bezier curve with these numbers as its control points."""
    n = len(rows) - 1
    return [comb(n, k) * sum((-1) ** (k - i) * comb(k, i) * rows[i] for i in range(k + 1)) for k in range(n + 1)]


class Ruled(Patch):
    """Between two Bezier curves of the same degree."""

    def __init__(self, body, first, last, points, directions, size):
        super().__init__(body, points, directions, size)
        self.last = last
        edges = (first, last, (first[0], last[0]), (first[-1], last[-1]))
        self.tips = [tuple(map(F, edge[0])) for edge in edges if all(p == edge[0] for p in edge)]
        self.a = [bernstein([F(p[i]) for p in first]) for i in range(3)]
        self.b = [minus(bernstein([F(p[i]) for p in last]), c) for i, c in enumerate(self.a)]
        uu = max(size_of(slope(slope(a))) + (1 + MARGIN) * size_of(slope(slope(b))) for a, b in zip(self.a, self.b))
        # Of the sheared functions, twice.
        self.second = 2 * (uu + 2 * max(size_of(slope(b)) for b in self.b))

    def passes_an_edge(self, ray, lo, hi):
        """Whether a ray passes an edge that is one point by less than its error: it meets the patch there, or misses it, or both ways."""
        x, d, w = ray
        o, d, error = tuple(F(a, w) for a in x), tuple(F(a, w) for a in d), self.error(ray)
        wide = error / max(map(abs, d))
        for tip in self.tips:
            t = dot(sub(tip, o), d) / dot(d, d)
            if F(lo) - wide <= t <= F(hi) + wide and max(abs(a + t * b - c) for a, b, c in zip(o, d, tip)) <= error:
                return True
        return False

    def equations(self, ray):
        x, d, w = ray
        k = max(range(3), key=lambda i: abs(d[i]))
        o, d = tuple(F(a, w) for a in x), tuple(F(a, w) for a in d)
        pairs = []
        for i in range(3):
            if i != k:
                a = minus(scaled(d[k], minus(self.a[i], [o[i]])), scaled(d[i], minus(self.a[k], [o[k]])))
                pairs.append((a, minus(scaled(d[k], self.b[i]), scaled(d[i], self.b[k]))))
        (a1, b1), (a2, b2) = pairs
        return o, d, k, pairs, minus(multiply(a1, b2), multiply(a2, b1))

    def place(self, o, d, k, pairs, u):
        """v as a quotient, and t: (numerator, denominator)."""
        for a, b in pairs:
            if u.sign_of(whole(b)):
                v = (scaled(-1, a), b)
                return v, (plus(multiply(minus(self.a[k], [o[k]]), b), multiply(self.b[k], v[0])), scaled(d[k], b))
        return None

    def meetings(self, ray):
        o, d, k, pairs, poly = self.equations(ray)
        found = real_roots(whole(poly))
        if found is None:
            self.within = True
            return []
        out = []
        error, within = self.error(ray), lambda x, far: x.against(-far) >= 0 >= x.against(1 + far)
        for u in found:
            if not within(u, MARGIN):
                continue
            place = self.place(o, d, k, pairs, u)
            if place is None:
                # Along a line of the patch, if it is met at all.
                self.within |= all(u.sign_of(whole(a)) == 0 for a, _ in pairs)
                continue
            v, t = Quotient(u, *place[0]), Quotient(u, *place[1])
            if not within(v, MARGIN):
                continue
            at_ = u.rational(200), v.rational(200)
            doubt = Doubt(self.slopes(*at_), d, error, self.second)
            if all(within(x, far) for x, far in zip((u, v), doubt.slack)):
                border = any(not within(x, -far) for x, far in zip((u, v), doubt.slack))
                normal, bend = self.normal(*at_)
                turn = 0 if u.before == u.after else sign(dot(normal, d))
                # An edge that is one point has no normal.
                out.append((t, Tangents(normal, bend, doubt.is_open) if any(normal) else None, border or not any(normal), turn))
        return out

    def low_places(self, ray):
        o, d, k, pairs, poly = self.equations(ray)
        for u in real_roots(whole(slope(poly))) or []:
            place = self.place(o, d, k, pairs, u)
            if place:
                yield Quotient(u, *place[1]).rational(100)

    def slopes(self, u, v):
        return [at(slope(a), u) + v * at(slope(b), u) for a, b in zip(self.a, self.b)], [at(b, u) for b in self.b]

    def normal(self, u, v):
        su, sv = self.slopes(u, v)
        suu = [at(slope(slope(a)), u) + v * at(slope(slope(b)), u) for a, b in zip(self.a, self.b)]
        suv = [at(slope(b), u) for b in self.b]
        n = cross(su, sv)
        top = lambda w: max(map(abs, w))
        # The parameters change by less than the point over the height of the parallelogram of both slopes.
        rate = 2 * max(top(su), top(sv)) / top(n) if any(n) else F(0)
        return n, 2 * rate * (top(suu) * top(sv) + 2 * top(suv) * top(su) + top(suv) * top(sv))


class Graph(Patch):
    """y = f(x / k, z / l); the factor of u^i v^j is terms[i][j]."""

    def __init__(self, body, terms, spans, inside, points, directions, size):
        super().__init__(body, points, directions, size)
        self.terms, self.spans, self.inside = terms, spans, inside
        along_u = lambda rows: [[i * a for a in row] for i, row in enumerate(rows)][1:] or [[F(0)]]
        along_v = lambda rows: [slope(row) or [F(0)] for row in rows]
        (_, k), (_, l) = spans
        self.steep = [[scaled(F(1, k), row) for row in along_u(terms)], [scaled(F(1, l), row) for row in along_v(terms)]]
        top = lambda rows: size_of([size_of(row) for row in rows])
        # Of the sheared functions, twice.
        self.second = 2 * (top(along_u(along_u(terms))) + 2 * top(along_u(along_v(terms))) + top(along_v(along_v(terms))))

    def along(self, ray):
        x, y, z = places(ray)
        (x0, k), (z0, l) = self.spans
        u, v = scaled(F(1, k), minus(x, [x0])), scaled(F(1, l), minus(z, [z0]))
        out, power = [F(0)], [F(1)]
        for row in self.terms:
            inner = [F(0)]
            for a in reversed(row):
                inner = plus(multiply(inner, v), [a])
            out = plus(out, multiply(power, inner))
            power = multiply(power, u)
        return u, v, minus(out, y)

    def meetings(self, ray):
        u, v, poly = self.along(ray)
        found = real_roots(whole(poly))
        if found is None:
            self.within = True
            return []
        out = []
        error, d = self.error(ray), tuple(F(x, ray[2]) for x in ray[1])
        for t in found:
            if not all(t.sign_of(whole(plus(p, [2 * MARGIN]))) >= 0 for p in self.inside(u, v)):
                continue
            at_ = at(u, t.rational(200)), at(v, t.rational(200))
            doubt = Doubt(self.slopes(*at_), d, error, self.second)
            a, b = doubt.slack
            slack = (a, a, b, b) if len(self.inside(u, v)) == 4 else (a, b, a + b)
            if all(t.sign_of(whole(plus(p, [far]))) >= 0 for p, far in zip(self.inside(u, v), slack)):
                border = any(t.sign_of(whole(minus(p, [far]))) <= 0 for p, far in zip(self.inside(u, v), slack))
                normal, bend = self.normal(*at_)
                out.append((t, Tangents(normal, bend, doubt.is_open), border, (t.after > 0) - (t.after < 0) if t.before != t.after else 0))
        return out

    def is_tangent(self, ray, lo, hi):
        """Also where the line is in it but for rounding: values below eight errors are as good as none to the command, and their own error is a ninth. A height is a sheared function of
        the patch and its slopes times another one."""
        poly, steep = self.along(ray)[2], 1 + sum(size_of([size_of(p) for p in self.steep[i]]) for i in (0, 1))
        return all(abs(at(poly, F(t))) <= 9 * steep * self.error(ray) for t in (lo, hi)) or super().is_tangent(ray, lo, hi)

    def low_places(self, ray):
        return [t.rational(100) for t in real_roots(whole(slope(self.along(ray)[2]))) or []]

    def slopes(self, u, v):
        (_, k), (_, l) = self.spans
        value = lambda rows: at([at(row, v) for row in rows], u)
        return (F(k), k * value(self.steep[0]), F(0)), (F(0), l * value(self.steep[1]), F(l))

    def normal(self, u, v):
        def d(i, j):
            fall = lambda n, k: [1, n, n * (n - 1)][k]
            return sum(a * fall(p, i) * fall(q, j) * u ** max(p - i, 0) * v ** max(q - j, 0) for p, row in enumerate(self.terms) for q, a in enumerate(row) if p >= i and q >= j)

        (_, k), (_, l) = self.spans
        bend = abs(d(2, 0)) / k**2 + 2 * abs(d(1, 1)) / abs(k * l) + abs(d(0, 2)) / l**2
        return (d(1, 0) / k, F(-1), d(0, 1) / l), 2 * bend


# ---- scenes ----


def draw(rng, wild):
    return F(rng.uniform(-2, 2)) if wild else F(rng.randint(-4, 4))


def points_of(rng, leaf, at_place):
    def points():
        for _ in range(3):
            part = lambda: rng.choice((F(0), F(1), F(rng.randint(1, 7), 8), F(rng.random()), F(rng.random())))
            p, n = at_place(part(), part())
            p = near(p)
            leaf.known[p] = n
            yield p

    return points


def ruled(rng, kind):
    n = 2 if kind == "bilinear" else rng.randint(2, 5)
    scale, wild = F(2) ** rng.choice((0, 0, -6, 4, -20, 20)), rng.random() < 0.3
    while True:
        first, last = ([tuple(scale * draw(rng, wild) for _ in range(3)) for _ in range(n)] for _ in range(2))
        if rng.random() < 0.15:
            last = [last[0]] * n
        leaf = Ruled("", first, last, None, [], 1)
        if all(any(leaf.normal(F(i, 7), F(j, 7))[0]) for i in (2, 5) for j in (1, 6)):
            break
    if kind == "bilinear":
        body = f"bilinear {{ {', '.join(map(vec, (*first, *last[::-1])))} }}"
    else:
        basis = rng.choice(("", "bezier_spline "))
        body = f"patch {{ {basis}{n}, 2, {', '.join(map(vec, (*first, *last)))} }}"
    place = lambda u, v: (tuple(at(a, u) + v * at(b, u) for a, b in zip(leaf.a, leaf.b)), leaf.normal(u, v)[0])
    ways = [(1, 0, 0), (0, 1, 0), (0, 0, 1), sub(first[1], first[0]), sub(last[0], first[0]), sub(last[-1], first[-1])]
    size = max(abs(x) for p in (*first, *last) for x in p)
    leaf = Ruled(body, first, last, None, [w for w in ways if any(w)], size)
    leaf.points = points_of(rng, leaf, place)
    return leaf


def bilinear(rng):
    return ruled(rng, "bilinear")


def tensor(rows):
    """The factors of u^i v^j of a net: rows along v, in each the points along u."""
    in_u = [bernstein(row) for row in rows]
    columns = [bernstein([row[i] for row in in_u]) for i in range(len(rows[0]))]
    return columns


def patch(rng):
    """Ruled ones, and graphs over a rectangle or a triangle."""
    style = rng.choice(("ruled", "bezier", "bicubic", "b_spline", "triangular"))
    if style == "ruled":
        return ruled(rng, "patch")
    wild, scale = rng.random() < 0.3, F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    square = lambda u, v: (u, minus([F(1)], u), v, minus([F(1)], v))
    inside = square
    if style == "triangular":
        n = rng.randint(2, 4)
        net = {(i, j): scale * draw(rng, wild) for j in range(n) for i in range(n - j)}
        listed = [(scale * i, net[i, j], scale * j) for j in range(n) for i in range(n - j)]
        body = f"patch {{ triangular {n}, {', '.join(map(vec, listed))} }}"
        m = n - 1
        terms = [[F(0)] * n for _ in range(n)]
        for (i, j), h in net.items():
            # m! / (i! j! k!) u^i v^j (1 - u - v)^k
            k = m - i - j
            for a in range(k + 1):
                for b in range(k - a + 1):
                    terms[i + a][j + b] += h * comb(m, i) * comb(m - i, j) * (-1) ** (a + b) * comb(k, a) * comb(k - a, b)
        inside = lambda u, v: (u, v, minus([F(1)], plus(u, v)))
        spans = ((F(0), scale * m), (F(0), scale * m))
        ns = (n, n)
    else:
        ns = (4, 4) if style != "bezier" else (rng.randint(2, 5), rng.randint(2, 5))
        net = [[scale * draw(rng, wild) for _ in range(ns[0])] for _ in range(ns[1])]
        listed = ", ".join(vec((scale * i, net[j][i], scale * j)) for j in range(ns[1]) for i in range(ns[0]))
        if style == "bicubic":
            body = f"bicubic_patch {{ type {rng.choice((0, 1))} u_steps 2 v_steps 3 {listed} }}"
        elif style == "bezier":
            body = f"patch {{ {ns[0]}, {ns[1]}, {listed} }}"
        else:
            body = f"patch {{ b_spline 4, 4, {listed} }}"
        if style == "b_spline":
            # The Bezier points of one span: means of neighbours.
            means = lambda p: [(p[0] + 4 * p[1] + p[2]) / 6, (2 * p[1] + p[2]) / 3, (p[1] + 2 * p[2]) / 3, (p[1] + 4 * p[2] + p[3]) / 6]
            rows = [means(row) for row in net]
            net = [list(r) for r in zip(*(means(column) for column in zip(*rows)))]
            spans = ((scale, scale), (scale, scale))
        else:
            spans = ((F(0), scale * (ns[0] - 1)), (F(0), scale * (ns[1] - 1)))
        terms = tensor(net)
    size = scale * max(*ns, 4)
    leaf = None

    def place(u, v):
        if style == "triangular" and u + v > 1:
            u, v = 1 - u, 1 - v
        height = sum(a * u**i * v**j for i, row in enumerate(terms) for j, a in enumerate(row))
        return tuple(x0 + k * s for (x0, k), s in ((spans[0], u),)) + (height,) + (spans[1][0] + spans[1][1] * v,), leaf.normal(u, v)[0]

    leaf = Graph(body, terms, spans, inside, None, [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 0)], size)
    leaf.points = points_of(rng, leaf, place)
    return leaf
