"""Prisms: outlines of straight edges or cubic curves in the plane of x and z, swept along y or towards the origin.

With straight edges a prism is a closed mesh of flat faces, and its edges follow the rule of all flat outlines (see `shapes.py`). With curves a ray meets a wall where a
cubic in the curve's parameter `u` vanishes; where on the ray, a quotient of polynomials in `u` says. Whether a point is inside is told by
counting the crossings of a line in the plane of the outlines, one that no vertex lies on.
"""

from fractions import Fraction as F

from exact import complement, sign
from shapes import Answer, Event, Loops, Map, cross, dot, text, times, vec
from solids import Region, at, between, grouped, minus, multiply, places, plus, scaled, whole
from zero_sets import Root, near, real_roots, trim


# ---- straight edges ----


class StraightPrism(Loops):
    """All faces are one primitive, which a line enters and leaves in turn."""

    def __init__(self, body, faces, points, directions, size, open_):
        super().__init__(body, faces, points, directions, size)
        self.faces, self.open = 1, open_

    def with_faces(self, faces):
        return StraightPrism(self.body, faces, self.points, self.directions, self.size, self.open)

    def solid(self):
        return not self.clip and not self.open

    def answer(self, o, d, m, k=None):
        clip, self.clip = self.clip, []
        found = super().answer(o, d, m, k).events
        self.clip = clip
        inside = []
        for i, e in enumerate(found):
            e.face = 0
            e.any_sign = self.open
            e.sign = e.sign if self.open else -1 if i % 2 == 0 else 1
        # On an edge either of the faces may be told.
        x, v, w = m.ray(o, d)
        for e in found:
            t = e.t.rational()
            p = tuple((a + t * b) / w for a, b in zip(x, v))
            corner = lambda loops: tuple(F(c, 1 << self.bits) for c in loops[0][0])
            e.normals = [(n, 1) for loops, n in zip(self.outlines, self.planes) if dot(n, minus3(p, corner(loops))) == 0]
        if not self.open:
            inside = [(a.t, b.t) for a, b in zip(found[::2], found[1::2]) if a.t.cmp(b.t) < 0]
        return Answer(self.clipped(found, m.ray(o, d)), inside)


OUTLINES = [
    [[(0, 0), (2, 0), (2, 2), (0, 2)]],
    [[(-1, -1), (3, -1), (0, 2)]],
    # An L, a star that crosses itself, a square with a hole, two squares that share a corner, a bow, edges in one line.
    [[(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]],
    [[(0, 4), (2, -3), (-4, 1), (4, 1), (-2, -3)]],
    [[(-4, -4), (4, -4), (4, 4), (-4, 4)], [(-2, -2), (-2, 2), (2, 2), (2, -2)]],
    [[(0, 0), (2, 0), (2, 2), (0, 2)], [(2, 2), (4, 2), (4, 4), (2, 4)]],
    [[(-2, -2), (2, 2), (2, -2), (-2, 2)]],
    [[(0, 0), (1, 0), (2, 0), (3, 0), (3, 3), (0, 3)]],
]


def prism(rng):
    u = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    loops = [[tuple(u * x for x in p) for p in loop] for loop in rng.choice(OUTLINES)]
    if rng.random() < 0.2:
        loops = [[tuple(F(rng.uniform(-3, 3)) for _ in range(2)) for _ in range(rng.randint(3, 7))]]
    conic = rng.random() < 0.4 and all(F(x).denominator < 1 << 30 for loop in loops for p in loop for x in p)
    low, high = rng.choice(((F(1), F(2)), (F(0), F(1)), (F(-1), F(2)), (F(-3), F(-1)), (F(1, 4), F(4)))) if conic else sorted(rng.sample([-3 * u, -u, F(0), u, 8 * u], 2))
    open_ = rng.random() < 0.15
    swept = lambda p, y: (p[0] * y, y, p[1] * y) if conic else (p[0], y, p[1])
    levels = [(low, F(0)), (F(0), high)] if conic and low < 0 < high else [(low, high)]
    faces = []
    for y0, y1 in levels:
        for loop in loops:
            for a, b in zip(loop, loop[1:] + loop[:1]):
                corners = [swept(a, y0), swept(b, y0), swept(b, y1), swept(a, y1)]
                kept = [c for i, c in enumerate(corners) if c != corners[i - 1]]
                if cross(minus3(kept[1], kept[0]), minus3(kept[2], kept[0])) != (0, 0, 0):
                    faces.append([kept])
    if not open_:
        faces += [[[swept(p, y) for p in loop] for loop in loops] for y in (low, high) if not (conic and y == 0)]
    count = sum(len(loop) + 1 for loop in loops)
    listed = ", ".join(f"<{text(p[0])}, {text(p[1])}>" for loop in loops for p in (*loop, loop[0]))
    words = f"prism {{ linear_spline {'conic_sweep' if conic else 'linear_sweep'} {text(low)}, {text(high)}, {count}, {listed}{' open' if open_ else ''} }}"

    def points():
        loop = rng.choice(loops)
        i = rng.randrange(len(loop))
        a, b = loop[i - 1], loop[i]
        s = F(rng.randint(0, 4), 4)
        p = tuple(x + s * (y - x) for x, y in zip(a, b))
        for y in (rng.choice((low, high)), low + (high - low) * F(rng.randint(0, 4), 4)):
            yield near(swept(p, y))
        yield near(swept(rng.choice(loop), rng.choice((low, high))))
        c = tuple(sum(p[k] for p in loop) / len(loop) for k in range(2))
        yield near(swept(c, rng.choice((low, high))))

    loop = loops[0]
    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), minus3(swept(loop[1], high), swept(loop[0], high)), minus3(swept(loop[0], high), swept(loop[0], low))]
    size = max(max(map(abs, c)) for face in faces for l in face for c in l)
    return StraightPrism(words, faces, points, [w for w in ways if any(w)], size, open_)


class StraightSweep(StraightPrism):
    """A prism in its own frame, which `inner` carries onto the path. All else is in the frame of the sweep."""

    def __init__(self, body, faces, points, size, open_, inner):
        super().__init__(body, faces, points, [], size, open_)
        self.inner, self.maps = inner, {}

    def accepts(self, m):
        """Whether the map onto the path and `m` make one map without rounding."""
        columns = [*zip(*self.inner.rows)]
        sums = [[r[k] * c[k] for k in range(3)] for r in m.rows for c in columns]
        sums += [[*(r[k] * self.inner.c[k] for k in range(3)), c] for r, c in zip(m.rows, m.c)]
        parts = (sum(x for k, x in enumerate(terms) if which >> k & 1) for terms in sums for which in range(1 << len(terms)))
        return all(F(float(x)) == x for x in parts)

    def answer(self, o, d, m, k=None):
        if id(m) not in self.maps:
            self.maps[id(m)] = m, m.after(self.inner)
        answer = super().answer(o, d, self.maps[id(m)][1], k)
        for e in answer.events:
            e.normals = [(self.inner.normal(n), side) for n, side in e.normals]
        return answer


def straight_sweep(rng):
    """A profile along a straight path, with one size or two: the exact image of a prism."""
    u = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    jitter = lambda: F(rng.randint(-(1 << 18), 1 << 18), 1 << 20)
    loops = [[(u * (a + jitter()), u * (b + jitter())) for a, b in loop] for loop in rng.choice(OUTLINES)]
    sizes = (F(1), rng.choice((F(1), F(2), F(1, 2), F(5, 4))))
    way = rng.choice(((0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)))
    # The smallest rotation of z onto the path.
    turned = lambda e: minus3(e, times(F(dot(e, way), 1 + way[2]), plus3((0, 0, 1), way)))
    start = times(u, rng.choice(((0, 0, 0), (1, -2, 3))))
    along = times(u * rng.choice((1, 4, 16)), way)
    conic = sizes[0] != sizes[1]
    if conic:
        axis, heights = times(1 / (sizes[1] - sizes[0]), along), sizes
    else:
        axis, heights = along, (F(0), F(1))
    inner = Map(tuple(zip(turned((1, 0, 0)), axis, turned((0, 1, 0)))), minus3(start, times(heights[0], axis)))
    swept = lambda p, y: (p[0] * y, y, p[1] * y) if conic else (p[0], y, p[1])
    first, last = ([[swept(p, y) for p in loop] for loop in loops] for y in heights)
    faces = [[[a[k - 1], a[k], b[k], b[k - 1]]] for a, b in zip(first, last) for k in range(len(a))]
    open_ = rng.random() < 0.15
    if not open_:
        faces += [first, last]
    profile = ", ".join(f"linear_spline {len(loop)}, " + ", ".join(f"<{text(a)}, {text(b)}>" for a, b in loop) for loop in loops)
    words = f"sweep {{ profile {profile} path linear_spline 2, {vec(start)}, {vec(plus3(start, along))}"
    words += f" size 2, {text(sizes[0])}, {text(sizes[1])}" * conic + " open" * open_ + " }"
    a, b = ([[inner.point(p) for p in loop] for loop in end] for end in (first, last))

    def points():
        k = rng.randrange(len(loops))
        j = rng.randrange(len(loops[k]))
        s, t = F(rng.random()), F(rng.random())
        between_ = lambda p, q, f: plus3(p, times(f, minus3(q, p)))
        yield near(between_(between_(a[k][j - 1], a[k][j], s), between_(b[k][j - 1], b[k][j], s), t))
        yield near(between_(a[k][j], b[k][j], s))
        yield near(between_(between_(a[k][0], a[k][1], s), b[k][2], t))

    size = max(max(map(abs, c)) for end in (a, b) for loop in end for c in loop)
    return StraightSweep(words, faces, points, size, open_, inner)


def plus3(a, b):
    return tuple(x + y for x, y in zip(a, b))


def minus3(a, b):
    return tuple(x - y for x, y in zip(a, b))


# ---- curves ----


class OnCurve(Root):
    """The place on a ray, num(u) / den(u), of a root u of g: as a root of the polynomial in t that is left when u is eliminated."""

    __slots__ = ()

    @staticmethod
    def at(u, g, num, den):
        found = real_roots(eliminated(g, num, den))
        side = u.sign_of(whole(den))
        index = 0
        for a, b in zip(found, found[1:]):
            a.cmp(b)
            index += side * u.sign_of(whole(minus(num, scaled((a.r + b.l) / 2, den)))) > 0
        r = found[index]
        return OnCurve(r.poly, r.l, r.r, r.before, r.after)


def eliminated(g, num, den):
    """The resultant of g(u) and num(u) - t den(u): E. Bezout's determinant, a polynomial in t."""
    n = max(len(trim(list(p))) for p in (g, num, den)) - 1
    g, num, den = ([F(p[i]) if i < len(p) else F(0) for i in range(n + 1)] for p in (g, num, den))
    pair = lambda i, j: [g[i] * num[j] - g[j] * num[i], g[j] * den[i] - g[i] * den[j]]
    rows = [[[F(0)] for _ in range(n)] for _ in range(n)]
    for i in range(n):
        for j in range(n):
            for k in range(max(0, i + j + 1 - n), min(i, j) + 1):
                rows[i][j] = plus(rows[i][j], pair(i + j + 1 - k, k))
    return whole(determinant(rows))


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    out = [F(0)]
    for i, row in enumerate(rows):
        minor = determinant([r[1:] for k, r in enumerate(rows) if k != i])
        out = plus(out, scaled((-1) ** i, multiply(row[0], minor)))
    return out


def curve(points):
    """The powers of u of a Bezier curve's coordinate."""
    a, b, c, d = points
    return [a, 3 * (b - a), 3 * (a - 2 * b + c), d - 3 * c + 3 * b - a]


class Wall:
    """A curved wall at the place `u` of its outline: which way its normal goes, and by how much that changes with the point."""

    def __init__(self, cx, cz, u, conic):
        bent = lambda c: [k * e for k, e in enumerate(c)][1:]
        (x, z), (dx, dz), (bx, bz) = ([at(c, u) for c in pair] for pair in ((cx, cz), (bent(cx), bent(cz)), (bent(bent(cx)), bent(bent(cz)))))
        self.normal = cross((x, F(1), z), (dx, F(0), dz)) if conic else (dz, F(0), -dx)
        self.speed, self.across = max(abs(dx), abs(dz)), abs(dx * bz - dz * bx)
        self.conic, self.reach = conic, 1 + abs(x) + abs(z)

    def gradient(self, _):
        return self.normal

    def bend(self, p):
        """The outline's curvature; a cone's plane at the height y is the outline's, y times as large."""
        turn = self.across / self.speed**3 * max(map(abs, self.normal))
        return turn * self.reach / abs(p[1]) if self.conic else turn


class CurvedPrism(Region):
    # No vertex lies on a line of this direction through a point that matters.
    AWAY = (F(1000003), F(7919))

    def __init__(self, body, pieces, low, high, conic, open_, points, directions, size):
        super().__init__(body, points, directions, size)
        self.pieces = [(curve([p[0] for p in piece]), curve([p[1] for p in piece])) for piece in pieces]
        self.low, self.high, self.conic, self.open, self.known = low, high, conic, open_, {}
        self.forms = [self]

    def solid(self):
        return not self.clip and not self.open

    def gradient(self, p):
        """Only of the points that rays are aimed at."""
        return self.known.get(p, (F(0), F(0), F(0)))

    def candidates(self, ray):
        x, y, z = places(ray)
        out = []
        for h in (self.low, self.high) + ((F(0),) if self.conic and self.low < 0 < self.high else ()):
            found = real_roots(whole(minus(y, [h])))
            if found is None:
                self.within |= h in (self.low, self.high)
                continue
            out += [(r, (0, -1 if h == self.low else 1, 0) if h in (self.low, self.high) else None, False) for r in found]
        for cx, cz in self.pieces:
            for u, poly, num, den in self.meet(x, y, z, cx, cz):
                wall = Wall(cx, cz, u.rational(120), self.conic) if self.has_way(cx, cz, u.rational(120)) else None
                out.append((OnCurve.at(u, poly, num, den), wall, u.against(F(0)) > 0 > u.against(F(1))))
        return out

    def meet(self, x, y, z, cx, cz):
        if not self.conic:
            ways = [(minus(cx, [x[0]]), [x[1]]), (minus(cz, [z[0]]), [z[1]])]
            poly = minus(scaled(z[1], ways[0][0]), scaled(x[1], ways[1][0]))
        else:
            ways = [(minus(scaled(y[0], c), [p[0]]), minus([p[1]], scaled(y[1], c))) for c, p in ((cx, x), (cz, z))]
            o, d = (x[0], y[0], z[0]), (x[1], y[1], z[1])
            n = cross(o, d)
            poly = plus(plus(scaled(n[0], cx), [n[1]]), scaled(n[2], cz))
        found = real_roots(whole(poly))
        if found is None:
            # Along an edge that is straight, or through the apex or along the sweep: then the line has one place among the outlines.
            one = len(trim(list(x))) < 2 and len(trim(list(z))) < 2 if not self.conic else not any(n)
            if one:
                h, k = (x[0], z[0]) if not self.conic else (d[0] / d[1], d[2] / d[1]) if d[1] else (None, None)
                on = h is not None and any(u.sign_of(whole(minus(cz, [k]))) == 0 for u in real_roots(whole(minus(cx, [h]))) or [u for u in real_roots(whole(minus(cz, [k]))) or []] if u.against(F(0)) >= 0 >= u.against(F(1)))
                self.within |= on
            else:
                self.within = True
            return
        for u in found:
            if u.against(F(0)) >= 0 >= u.against(F(1)):
                for num, den in ways:
                    if any(den) and u.sign_of(whole(den)):
                        yield u, poly, num, den
                        break

    def outward(self, n, d, turn):
        """The side on which a wall's normal is outside: a line that leaves goes there."""
        along = dot(n.normal if isinstance(n, Wall) else n, d)
        return (sign(along) * turn,) if along and turn else (1, -1)

    def has_way(self, cx, cz, u):
        """Whether a curve keeps its direction within 1e-10 as far as 16 ulps of its size go: not at a cusp."""
        slopes = [[k * e for k, e in enumerate(c)][1:] for c in (cx, cz)]
        bends = [[k * e for k, e in enumerate(c)][1:] for c in slopes]
        (dx, dz), (bx, bz) = ([at(c, u) for c in pair] for pair in (slopes, bends))
        size = sum(abs(e) for c in (cx, cz) for e in c)
        speed = max(abs(dx), abs(dz))
        return speed > 0 and abs(dx * bz - dz * bx) * size * F(16, 1 << 53) <= F(1, 10**10) * speed**3

    def is_within(self, p):
        """Whether a point of the plane is within the outlines."""
        a, b = self.AWAY
        odd = False
        for cx, cz in self.pieces:
            dx, dz = minus(cx, [p[0]]), minus(cz, [p[1]])
            for u in real_roots(whole(minus(scaled(b, dx), scaled(a, dz)))) or []:
                if u.before != u.after and u.against(F(0)) >= 0 > u.against(F(1)):
                    odd ^= u.sign_of(whole(plus(scaled(a, dx), scaled(b, dz)))) > 0
        return odd

    def value(self, p):
        x, y, z = p
        if not self.low < y < self.high:
            return F(1)
        if self.conic:
            if y == 0:
                return F(1)
            x, z = x / y, z / y
        return F(-1) if self.is_within((x, z)) else F(1)

    def answer(self, o, d, m):
        """As for all regions; a touch is where a curve is met without being crossed, between the ends."""
        ray = m.ray(o, d)
        self.within = False
        along = places(ray)
        point = lambda t: tuple(at(c, t) for c in along)
        groups = grouped(self.candidates(ray))
        states = [self.value(point(t)) < 0 for t in between([g[0][0] for g in groups])]
        flip = -1 if self.inverse else 1
        events, inside, start = [], [], None
        for group, before, after in zip(groups, states, states[1:]):
            t = group[0][0]
            smooth = len(group) == 1 and group[0][2]
            if before == after:
                y = at(along[1], t.rational(300))
                rim = any(not isinstance(g[0], OnCurve) for g in group)
                if not any(isinstance(g[0], OnCurve) for g in group) or not (rim or self.low <= y <= self.high):
                    continue
            ends = any(not isinstance(g[0], OnCurve) for g in group)
            if self.open and ends:
                # The ends are not there; the rims may be.
                if not any(isinstance(g[0], OnCurve) for g in group):
                    start = t
                    continue
            turn = 0 if before == after else flip * (1 if before else -1)
            # At a corner a line may leave against one of the walls' normals.
            sides = lambda n: self.outward(n, ray[1], turn) if len(group) == 1 else (1, -1)
            normals = [(n, s) for _, n, _ in group if n is not None for s in sides(n)]
            # Next to the apex the point is taken for the apex, whose normal is a direction to leave in.
            apex = self.conic and abs(at(along[1], t.rational(80))) < self.size / (1 << 30)
            cusp = any(n is None and isinstance(root, OnCurve) for root, n, _ in group)
            event = Event(t, turn, [] if apex or cusp else normals, self, any_sign=self.open)
            event.optional = (before == after and not smooth) or (self.open and ends)
            events.append(event)
            if before != after:
                if after:
                    start = t
                else:
                    inside.append((start, t))
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, self.within)


BEZIER = [
    # A rounded square, a heart with a cusp, a loop that crosses itself, a lens, a piece of order three with an inflection.
    [[((1, 0), (1, F(1, 2)), (F(1, 2), 1), (0, 1)), ((0, 1), (F(-1, 2), 1), (-1, F(1, 2)), (-1, 0)), ((-1, 0), (-1, F(-1, 2)), (F(-1, 2), -1), (0, -1)), ((0, -1), (F(1, 2), -1), (1, F(-1, 2)), (1, 0))]],
    [[((0, 0), (0, 2), (2, 2), (2, 0)), ((2, 0), (2, -1), (0, -2), (0, -2)), ((0, -2), (0, -2), (-2, -1), (-2, 0)), ((-2, 0), (-2, 2), (0, 2), (0, 0))]],
    [[((0, 0), (4, 4), (-4, 4), (0, 0))]],
    [[((-2, 0), (-1, 2), (1, 2), (2, 0)), ((2, 0), (1, -2), (-1, -2), (-2, 0))]],
    [[((0, 0), (1, 3), (2, -3), (3, 0)), ((3, 0), (3, 0), (3, 4), (3, 4)), ((3, 4), (2, 4), (1, 4), (0, 4)), ((0, 4), (0, 3), (0, 1), (0, 0))]],
    [[((-2, 0), (2, 3), (-2, 3), (2, 0)), ((2, 0), (1, -1), (-1, -1), (-2, 0))]],
]


def toward(start, a, b, part):
    return tuple(float(s) + part * (float(y) - float(x)) for s, x, y in zip(start, a, b))


def curved_prism(rng):
    conic = rng.random() < 0.4
    u = F(2) ** rng.choice((0, 0, -3, 4) if conic else (0, 0, -6, 4, -20, 20))
    word = rng.choice(("bezier_spline", "bezier_spline", "quadratic_spline", "cubic_spline"))
    listed, pieces = [], []
    if word == "bezier_spline":
        for outline in rng.choice(BEZIER):
            for piece in outline:
                piece = [tuple(u * F(x) for x in p) for p in piece]
                listed += piece
                pieces.append(piece)
    else:
        ring = rng.choice(([(2, 0), (0, 2), (-2, 0), (0, -2)], [(0, 0), (4, 0), (4, 3), (1, 5), (-2, 3)], [(0, 0), (2, 3), (3, -1), (-2, 2)]))
        ring = [tuple(float(u * x) for x in p) for p in ring]
        before, behind = ring[-1], ring[1]
        if rng.random() < 0.3:
            before = tuple(float(u * rng.randint(-3, 3)) for _ in range(2))
        line = [before, *ring, ring[0]]
        if word == "quadratic_spline":
            for p, a, b in zip(line, line[1:], line[2:]):
                middle = toward(a, p, b, 0.25)
                pieces.append([a, toward(a, a, middle, 2.0 / 3.0), toward(b, b, middle, 2.0 / 3.0), b])
        else:
            line.append(behind)
            for p, a, b, q in zip(line, line[1:], line[2:], line[3:]):
                pieces.append([a, toward(a, p, b, 1.0 / 6.0), toward(b, q, a, 1.0 / 6.0), b])
        listed = [tuple(map(F, p)) for p in line]
        pieces = [[tuple(map(F, p)) for p in piece] for piece in pieces]
    low, high = rng.choice(((F(1), F(2)), (F(0), F(1)), (F(-1), F(2)), (F(-3), F(-1)), (F(1, 4), F(4)))) if conic else sorted(rng.sample([-3 * u, -u, F(0), u, 8 * u], 2))
    open_ = rng.random() < 0.1
    numbers = ", ".join(f"<{text(p[0])}, {text(p[1])}>" for p in listed)
    body = f"prism {{ {word} {'conic_sweep' if conic else 'linear_sweep'} {text(low)}, {text(high)}, {len(listed)}, {numbers}{' open' if open_ else ''} }}"
    swept = lambda p, y: (p[0] * y, y, p[1] * y) if conic else (p[0], y, p[1])
    leaf = None

    def points():
        # Not at rims, where it is a matter of three surfaces which crossings there are.
        for y in (low + (high - low) * F(rng.randint(1, 3), 4) for _ in range(2)):
            cx, cz = rng.choice(leaf.pieces)
            s = F(rng.randint(0, 8), 8)
            p = near(swept((at(cx, s), at(cz, s)), y))
            leaf.known[p] = Wall(cx, cz, s, leaf.conic).normal
            yield p
        cx, cz = leaf.pieces[0]
        yield near(swept((cx[0], cz[0]), low + (high - low) * F(rng.randint(1, 7), 8)))
        yield near(swept((at(cx, F(1, 2)) / 2, at(cz, F(1, 2)) / 2), rng.choice((low, high))))

    size = max(abs(x) for piece in pieces for p in piece for x in p) * (max(abs(low), abs(high)) if conic else 1)
    leaf = CurvedPrism(body, pieces, low, high, conic, open_, points, [(0, 1, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)], max(size, abs(low), abs(high)))
    return leaf
