"""Lathes: profiles of lines, parabolas and cubics that are turned about the y axis.

On a piece of the profile `(r(w), y(w))` a slanted ray is at the height `y(w)` where its parameter is a polynomial in `w`, so it meets the surface where one polynomial in `w`
vanishes. A level ray is at the height of finitely many `w`, of which the distance from the axis makes a quadratic in `t`. Whether a point is inside is told by counting the
walls beyond it, away from the axis at its height.
"""

from fractions import Fraction as F

from exact import Number, complement, sign
from prisms import OnCurve, eliminated
from shapes import Answer, Event, dot, text
from solids import Region, at, grouped, between, minus, places, plus, scaled, whole
from zero_sets import TURNS, multiply, near, real_roots


def slope(p):
    return [k * a for k, a in enumerate(p)][1:]


def composed(outer, inner):
    """outer(inner(w))."""
    out = [F(0)]
    for a in reversed(outer):
        out = plus(multiply(out, inner), [a])
    return out


class Image:
    """The number p(u) of an algebraic number u."""

    def __init__(self, root, p):
        self.root, self.p, self.l, self.r = root, [F(a) for a in p], None, None

    def bound(self):
        u, v = self.root.l, self.root.r
        middle, far = (u + v) / 2, max(abs(u), abs(v))
        spread = sum(k * abs(a) * far ** (k - 1) for k, a in enumerate(self.p) if k) * (v - u) / 2
        value = at(self.p, middle)
        self.l, self.r = value - spread, value + spread

    def rational(self, bits=160):
        if self.root.l != self.root.r and self.root.sign_of(whole(self.p)) == 0:
            self.l = self.r = F(0)
            return self.l
        wanted = bits
        while True:
            self.root.narrow(wanted)
            self.bound()
            if (self.r - self.l) * (1 << bits) <= min(abs(self.l), abs(self.r)):
                return (self.l + self.r) / 2
            wanted = wanted + max(64, bits // 2)

    def against(self, x):
        if self.l is None:
            self.rational(80)
        if x < self.l or x > self.r:
            return 1 if x < self.l else -1
        if self.l == self.r:
            return 0
        return self.root.sign_of(whole(minus(self.p, [F(x)])))

    def sign_of(self, q):
        """The sign of a polynomial there."""
        return self.root.sign_of(whole(composed([F(a) for a in q], self.p)))

    def cmp(self, other):
        """Against a float or another number; two of these are equal if they differ by less than 2^-3200 of themselves."""
        if isinstance(other, float):
            return -sign(other) if other in (float("inf"), float("-inf")) else self.against(F(other))
        if isinstance(other, Number):
            return self.against(F(other.p, other.a)) if other.q == 0 else sign(self.rational(2000) - other.rational(2000))
        if other.l is not None and other.l == other.r:
            return self.against(other.l)
        for bits in (60, 200, 800, 3200):
            self.rational(bits)
            other.rational(bits)
            if self.r < other.l or other.r < self.l:
                return -1 if self.r < other.l else 1
        return 0

    def __float__(self):
        return float(self.rational())

    def __repr__(self):
        return f"{float(self)!r}"


class Flank:
    """The surface at the place w of a piece of the profile: its normal, and how that changes with the point."""

    def __init__(self, r, y, w):
        (self.r, self.r1, r2), (self.y1, y2) = ([at(p, w) for p in (r, slope(r), slope(slope(r)))], [at(p, w) for p in (slope(y), slope(slope(y)))])
        self.speed = max(abs(self.r1), abs(self.y1))
        self.turn = abs(y2 * self.r) + abs(r2 * self.r) + self.r1**2

    def gradient(self, p):
        return (self.y1 * p[0], -self.r1 * self.r, self.y1 * p[2])

    def bend(self, _):
        return abs(self.y1) + self.turn / self.speed


# Where a sheet's end is as high: no place of its own.
LEVEL = object()


class Lathe(Region):
    def __init__(self, body, pieces, closed, points, directions, size):
        super().__init__(body, points, directions, size)
        self.pieces, self.closed, self.known = pieces, closed, {}
        self.ends = sorted({at(y, F(w)) for r, y in pieces for w in (0, 1)})
        self.forms = [self]

    def solid(self):
        return not self.clip and self.closed

    def gradient(self, p):
        """Only of the points that rays are aimed at."""
        return self.known.get(p, (F(0), F(0), F(0)))

    def candidates(self, ray):
        x, y, z = places(ray)
        out = []
        if not self.closed and y[1]:
            # Where the walls that are counted from one side to the other end.
            for h in self.ends:
                r = real_roots(whole(minus(y, [h])))[0]
                out.append((r, LEVEL, False))
        for r, height in self.pieces:
            if any(r):
                out += [(t, *self.face(r, height, w)) for w, t in self.meet(x, y, z, r, height)]
        return out

    def face(self, r, y, w):
        """What has its normal there, and whether a touch there is one of a smooth face."""
        inner = w.against(F(0)) > 0 > w.against(F(1))
        on_axis = w.sign_of(whole(r)) == 0
        cusp = w.sign_of(whole(slope(r)) or [0]) == 0 == w.sign_of(whole(slope(y)) or [0])
        flank = None if on_axis or cusp else Flank(r, y, w.rational(200))
        return flank, inner and flank is not None

    def meet(self, x, y, z, r, height):
        """Places w on a piece, and t on the ray."""
        if y[1]:
            rise = scaled(1 / y[1], minus(height, [y[0]]))
            along = [plus([c[0]], scaled(c[1], rise)) for c in (x, z)]
            poly = minus(plus(multiply(along[0], along[0]), multiply(along[1], along[1])), multiply(r, r))
            found = real_roots(whole(poly))
            if found is None:
                self.within = True
            for w in on_piece(found):
                yield w, Image(w, rise)
            return
        level = minus(height, [y[0]])
        found = real_roots(whole(level))
        if found is None:
            self.within = True
        # The squared distance from the axis along the ray.
        far = plus(multiply(x, x), multiply(z, z))
        for w in on_piece(found):
            square = multiply(r, r)
            if w.l == w.r:
                ts = real_roots(whole(minus(far, [at(square, w.l)])))
            else:
                s = OnCurve.at(w, level, square, [F(1)])
                ts = []
                for t in real_roots(whole(composed(eliminated(level, square, [F(1)]), far))):
                    # Of all that have the right distance for some w, those that have it for this one.
                    if t.sign_of(whole(composed(s.poly, far))) == 0 and t.sign_of(whole(minus(far, [s.l]))) >= 0 >= t.sign_of(whole(minus(far, [s.r]))):
                        ts.append(t)
            yield from ((w, t) for t in ts)

    def value(self, p):
        """By the walls beyond a point, at a height less by as little as one likes."""
        square, odd = p[0] ** 2 + p[2] ** 2, False
        for r, y in self.pieces:
            found = real_roots(whole(minus(y, [p[1]]))) or []
            beyond = whole(minus(multiply(r, r), [square]))
            for w in found:
                crossed = False
                start, end = w.against(F(0)), w.against(F(1))
                if start > 0 > end:
                    crossed = w.before != w.after
                elif start == 0:
                    crossed = w.after < 0
                elif end == 0:
                    crossed = w.before < 0
                if crossed:
                    odd ^= w.sign_of(beyond) > 0
        return F(-1) if odd else F(1)

    def outward(self, n, p, d, turn):
        along = dot(n.gradient(p), d)
        return (sign(along) * turn,) if self.closed and along and turn else (1, -1)

    def answer(self, o, d, m):
        """As for all regions; a touch is where a wall is met without being crossed."""
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
            walls = [g for g in group if g[1] is not LEVEL]
            rim = len(walls) < len(group)
            if walls:
                p = point(t.rational(200))
                turn = 0 if before == after else flip * (1 if before else -1)
                # At a corner a line may leave against one of the walls' normals.
                sides = lambda n: self.outward(n, p, ray[1], turn) if len(group) == 1 else (1, -1)
                normals = [(n, s) for _, n, _ in walls if n is not None for s in sides(n)]
                # None at a tip or a pole, where they turn within less than what a bracket leaves open.
                tip = p[0] ** 2 + p[2] ** 2 <= self.size**2 / (1 << 40) or any(n is None for _, n, _ in walls)
                event = Event(t, turn, [] if tip else normals, self, any_sign=not self.closed)
                event.optional = before == after and not (len(group) == 1 and group[0][2]) or rim
                # Of walls that end there, two are one branch.
                inner = sum(inner for _, _, inner in walls)
                event.branches = inner + (len(walls) - inner + 1) // 2
                events.append(event)
            if before != after:
                if after:
                    start = t
                else:
                    inside.append((start, t))
        if not self.closed:
            return Answer(self.clipped(events, ray), [], self.within)
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, self.within)


def on_piece(found):
    """Those from 0 to 1; the ends themselves are told as such."""
    for w in found or []:
        first, last = w.against(F(0)), w.against(F(1))
        if first == 0:
            w.l = w.r = F(0)
        if last == 0:
            w.l = w.r = F(1)
        if first >= 0 >= last:
            yield w


# ---- splines ----


def spline(word, points):
    """The powers of w of each piece, for each coordinate of the points."""
    pieces = []
    if word == "linear_spline":
        for a, b in zip(points, points[1:]):
            pieces.append([[p, q - p] for p, q in zip(a, b)])
    elif word == "quadratic_spline":
        for a, b, c in zip(points, points[1:], points[2:]):
            pieces.append([[q, (r - p) / 2, (p + r) / 2 - q] for p, q, r in zip(a, b, c)])
    elif word == "cubic_spline":
        for a, b, c, d in zip(points, points[1:], points[2:], points[3:]):
            pieces.append([[q, (r - p) / 2, p - F(5, 2) * q + 2 * r - s / 2, (s - p) / 2 + F(3, 2) * (q - r)] for p, q, r, s in zip(a, b, c, d)])
    elif word == "b_spline":
        for a, b, c, d in zip(points, points[1:], points[2:], points[3:]):
            pieces.append([[(p + 4 * q + r) / 6, (r - p) / 2, (p - 2 * q + r) / 2, (s - p) / 6 + (q - r) / 2] for p, q, r, s in zip(a, b, c, d)])
    else:
        for i in range(0, len(points), 4):
            pieces.append([[p, 3 * (q - p), 3 * (p - 2 * q + r), s - p + 3 * (q - r)] for p, q, r, s in zip(*points[i : i + 4])])
    return pieces


PROFILES = [
    # Open walls; ends on the axis; a closed one away from it; a bow; one that crosses the axis, one that touches it.
    [(1, 0), (1, 2)], [(2, 0), (1, 3)], [(3, 0), (1, 0)], [(2, -1), (3, 1), (1, 2), (2, 4)],
    [(0, 0), (2, 0), (2, 3), (0, 3)], [(0, -1), (2, 1), (0, 3)], [(0, 0), (1, 0), (3, 2), (1, 4), (0, 3)], [(0, 0), (3, 0), (0, 2)],
    [(1, 0), (3, 0), (3, 2), (1, 2), (1, 0)], [(2, 0), (4, 2), (2, 4), (1, 2), (2, 0)], [(1, 0), (3, 2), (3, 0), (1, 2), (1, 0)],
    [(-1, 0), (2, 0), (2, 2), (-1, 0)], [(-1, 0), (1, 2), (3, 1), (-1, 0)], [(-2, 0), (3, 0)], [(-1, 0), (2, 3)],
    [(1, 0), (0, 1), (1, 2), (3, 1), (1, 0)], [(0, 0), (2, 1), (0, 2), (2, 3), (0, 4)], [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (2, 2), (0, 4)],
]
CURVED = [
    # Bezier pieces: a ball of sorts, a vase, a ring, one with a cusp, one with a loop, one across the axis, two that are not joined.
    [(0, -2), (2, -2), (2, 2), (0, 2)],
    [(0, 0), (3, 0), (3, 2), (1, 2), (1, 2), (0, 2), (0, 4), (2, 4)],
    [(2, 0), (3, 0), (3, 2), (2, 2), (2, 2), (1, 2), (1, 0), (2, 0)],
    [(1, 0), (4, 3), (0, 3), (3, 0)],
    [(1, 0), (7, 4), (-3, 4), (3, 0)],
    [(2, 0), (7, 4), (-2, 4), (2, 0)],
    [(-1, 0), (1, 1), (1, 2), (2, 4)],
    [(1, 0), (1, 1), (2, 2), (2, 3), (0, 4), (1, 4), (1, 5), (0, 5)],
    [(3, 0), (1, 3), (3, -3), (1, 0)],
    [(1, 0), (2, 0), (3, 0), (4, 0), (4, 0), (4, 2), (2, 3), (1, 0)],
    [(1, 0), (1, 1), (1, 2), (1, 3)],
]


def is_closed(word, pieces):
    """Whether each of the curves comes back to where it begins, or begins and ends on the axis."""
    ends = [[tuple(at(c, F(w)) for c in piece) for w in (0, 1)] for piece in pieces]
    chains = []
    for a, b in ends:
        if chains and chains[-1][1] == a:
            chains[-1][1] = b
        else:
            chains.append([a, b])
    return all(a == b or a[0] == b[0] == 0 for a, b in chains)


def lathe(rng):
    u = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    word = rng.choice(("linear_spline", "linear_spline", "quadratic_spline", "cubic_spline", "cubic_spline", "bezier_spline", "bezier_spline"))
    while True:
        if word == "bezier_spline":
            line = rng.choice(CURVED)
        else:
            line = list(rng.choice(PROFILES))
            closed = line[0] == line[-1]
            ring = line[:-1]
            before, behind = (ring[-1], ring[1 % len(ring)]) if closed else ((rng.randint(-3, 3), rng.randint(-3, 5)) for _ in range(2))
            line = line if word == "linear_spline" else [before, *line] if word == "quadratic_spline" else [before, *line, behind]
        base = rng.choice((0, 0, -1, 3, -100))
        line = [(F(r), F(y + base)) for r, y in line]
        if rng.random() < 0.2:
            line = [(F(rng.uniform(-1, 3)), F(rng.uniform(-2, 2))) for _ in line]
        elif rng.random() < 0.15:
            line = [line[-1], *line[::-1]][1:]
        line = [(r * u, y * u) for r, y in line]
        pieces = spline(word, line)
        if any(any(r) for r, _ in pieces):
            break
    listed = ", ".join(f"<{text(r)}, {text(y)}>" for r, y in line)
    words = "" if word == "linear_spline" and rng.random() < 0.5 else word + " "
    body = f"lathe {{ {words}{len(line)}, {listed} }}"
    size = max(abs(x) for p in line for x in (p[0], p[1] - line[0][1]))
    leaf = None

    def points():
        for _ in range(2):
            r, y = rng.choice(leaf.pieces)
            # At knots, between them, and where the profile is level or upright.
            places_ = [F(0), F(1), F(1, 2), F(rng.randint(0, 8), 8), F(rng.random())]
            for p in (slope(r), slope(y)):
                places_ += [w.rational(80) for w in on_piece(real_roots(whole(p)))]
            w = rng.choice(places_)
            c, s = rng.choice(TURNS)
            p = near((at(r, w) * c, at(y, w), at(r, w) * s))
            leaf.known[p] = Flank(r, y, w).gradient(p)
            yield p
        # On the axis; where the profile meets it.
        r, y = rng.choice(leaf.pieces)
        yield near((F(0), at(y, F(rng.choice((0, 1, 0.5)))), F(0)))
        poles = list(on_piece(real_roots(whole(r))))
        if poles:
            yield near((F(0), at(y, rng.choice(poles).rational(120)), F(0)))
        yield near((size * F(rng.randint(-4, 4), 4), at(y, F(1, 2)), size * F(rng.randint(-4, 4), 4)))

    ways = [(0, 1, 0), (1, 0, 0), (0, 0, 1), (3, 0, 4)]
    for r, y in rng.sample(pieces, min(3, len(pieces))):
        c, s = rng.choice(TURNS)
        ways.append(((at(r, F(1)) - r[0]) * c, at(y, F(1)) - y[0], (at(r, F(1)) - r[0]) * s))
    leaf = Lathe(body, [tuple(p) for p in pieces], is_closed(word, pieces), points, [w for w in ways if any(w)], size)
    return leaf
