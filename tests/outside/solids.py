"""Solids whose boundary is put together from zero sets of polynomials.

Along a ray everything that can change at the boundary changes at a root of one of a few polynomials in t, whole numbers all of them. Between two roots that follow
each other the ray is inside or outside, which one point tells, exactly; where it is the same before and after a root, the boundary is touched there or it is
not, which the value there tells. So a solid says two things: its polynomials along a ray, and whether a point is inside.

Square roots, where a solid has them, are taken to 2^-2400 of their numbers.
"""

from fractions import Fraction as F
from functools import cmp_to_key, reduce
from math import isqrt, lcm

from exact import complement
from shapes import Answer, Event, Leaf, text
from zero_sets import Field, TURNS, multiply, near, product, real_roots, total, trim


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
    """The square root of a Fraction that is not negative, to 2^-2400 of it."""
    x = F(x)
    if x == 0:
        return F(0)
    shift = 2400 + max(0, x.denominator.bit_length() - x.numerator.bit_length() + 1)
    return F(isqrt((x.numerator << (2 * shift)) // x.denominator), 1 << shift)


# ---- the solid ----


class Region(Leaf):
    """A solid; `certain` if every decision about it can be exact, else tangents may be told as clusters."""

    certain = True
    # Whether it is decided exactly on which side of a range's end, or of a clip's border, a crossing is.
    exact_ends = True
    # Where the last line may meet the boundary, and what has its normal there.
    met = ()

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
        self.met = [(root, source) for group in groups for root, source, _ in group]
        states = [self.value(point(t)) < 0 for t in between([g[0][0] for g in groups])]
        flip = -1 if self.inverse else 1
        events, inside, start = [], [], None
        for group, before, after in zip(groups, states, states[1:]):
            root = group[0][0]
            if before == after:
                if not self.is_met(root, ray):
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

    def is_met(self, root, ray):
        """Whether the boundary passes through a root: the value there, where rounding leaves 2^-100 or 2^-1100 of zero."""
        for bits, left in ((300, 100), (2600, 1100)):
            t = root.rational(bits)
            if abs(self.value(tuple(at(c, t) for c in places(ray)))) > F(1, 1 << left) * self.unit():
                return False
        return True

    def unit(self):
        """About the size of the value a length away from the surface."""
        return 1

    def steepness(self, p):
        """What grows where the solid's own surface is crossed, and not where its walls are."""
        return self.value(p)

    def passes_an_edge(self, ray, lo, hi):
        """Whether two faces, or what parts them, are met between two places that are next to each other, or as far from there as these are apart; or an edge is missed by less than 2^-100."""
        along = places(ray)
        length = self.size / max(abs(c[1]) for c in along)
        lo, hi = F(lo), F(hi)
        if (hi - lo) * (1 << 26) > length:
            return False
        lo, hi = lo - (hi - lo), hi + (hi - lo)
        held = [(r, source) for r, source, _ in self.candidates(ray) if r.against(lo) >= 0 and r.against(hi) <= 0]
        if len(grouped([(r, s, True) for r, s in held])) > 1 and len({id(s) for _, s in held}) > 1:
            return True
        return any(abs(self.value(tuple(at(c, r.rational(300)) for c in along))) <= self.unit() / (1 << 100) for r, _ in held)

    def is_tangent(self, ray, lo, hi):
        """Whether the value hardly changes along the ray at an end or in the middle: less than a millionth of what it could."""
        along = places(ray)
        lo, hi = F(lo), F(hi)
        middle, length = (lo + hi) / 2, self.size / max(abs(c[1]) for c in along)
        point = lambda t: tuple(at(c, t) for c in along)
        if any(not any(f.gradient(point(middle))) for f in self.forms if isinstance(f, Slope)):
            return True
        step = max(length / (1 << 26), (hi - lo) / 2)

        def change(a, b):
            return abs(self.steepness(a) - self.steepness(b))

        def could(p):
            """By as long a way along the axes; much less than a change by the unit over the size where the surface has a point of its own."""
            way = self.size * step / length
            moved = lambda i, d: tuple(x + d * (i == j) for j, x in enumerate(p))
            return max(change(moved(i, way), moved(i, -way)) for i in range(3))

        usual = 2 * step * self.unit() / length
        hardly = lambda t: change(point(t - step), point(t + step)) * (1 << 20) <= max(usual, could(point(t)))
        return any(hardly(t) or could(point(t)) * (1 << 20) <= usual for t in (lo, middle, hi))


def grouped(found):
    """Roots in order, equal ones together."""
    found = sorted(found, key=cmp_to_key(lambda a, b: a[0].cmp(b[0])))
    out = []
    for entry in found:
        if out and out[-1][0][0].cmp(entry[0]) == 0:
            out[-1].append(entry)
        else:
            out.append([entry])
    return out


def between(roots):
    """A number before the first root, between each two, and behind the last."""
    if not roots:
        return [F(0)]
    ends = [r.rational(64) for r in roots]
    out = [min(ends) - abs(min(ends)) / 1024 - 1]
    for a, b in zip(roots, roots[1:]):
        for bits in (64, 200, 800, 3200, 12800):
            a.rational(bits)
            b.rational(bits)
            if a.r < b.l:
                break
        out.append((a.r + b.l) / 2)
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
