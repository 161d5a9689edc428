"""Curved patches of any kind: NURBS with and without trims, rational Bezier patches, triangular ones, formulas of two parameters.

Each is a few polynomial nets over a square: homogeneous control points, exact fractions of the numbers of the text. Two planes through a ray make two polynomials f and g of u and v; the ray meets the patch
where both are zero. A square is cut in two until the hulls of its control values show that it has no zero, or until the slopes show that it has one at most: adj(J) times the slopes is close to det(J) times the
unit matrix on all of it and an eighth beyond, so f and g take no value twice there. Then Newton's method finds it, to 2^-250. Everything is whole numbers of 2^-BITS of the largest value, so that cutting
100 times loses less than 2^-280. What is smaller than 2^-70 of the patch and still undecided (a tangent, a collapsed edge) is a place where any number of crossings may be.
"""

from fractions import Fraction as F
from functools import cmp_to_key
from math import comb, lcm

from exact import Number, sign
from patches import Patch, Tangents
from shapes import Answer, Event, cross, dot, sub, times
from solids import at

BITS = 320
END = 70
"""What is smaller than 2^-END of a net's largest value is not cut."""
BEYOND = F(1, 1 << 20)
"""How far beyond its outer borders a surface is looked at, as a part of a net."""
MOST = 3000
"""A ray that needs more squares is not examined."""


class Place:
    """A number known to lie between two fractions next to each other."""

    def __init__(self, l, r):
        self.l, self.r = F(l), F(r)

    def against(self, x):
        return (self.l > x) - (self.r < x)

    def cmp(self, other):
        if isinstance(other, float):
            return -sign(other) if other in (float("inf"), float("-inf")) else self.against(F(other))
        if isinstance(other, Place):
            return (self.l > other.r) - (self.r < other.l)
        if isinstance(other, Number):
            return self.against(other.rational(400))
        return -other.cmp(self)

    def rational(self, _=0):
        return (self.l + self.r) / 2

    def sign_of(self, poly):
        """At an end if both agree."""
        a, b = (sign(at(poly, x)) for x in (self.l, self.r))
        return a if a == b else 0

    def __float__(self):
        return float(self.rational())

    def __repr__(self):
        return f"{float(self)!r}"


# ---- polynomials on squares: rows[j][i] of Bernstein's factors, i along u ----


def split(row):
    """The control values of both halves; half a unit is lost in each step."""
    left, right = [row[0]], [row[-1]]
    while len(row) > 1:
        row = [(a + b) >> 1 for a, b in zip(row, row[1:])]
        left.append(row[0])
        right.append(row[-1])
    return left, right[::-1]


def cut(row, t, left):
    """The control values left or right of t, exactly."""
    out = [row[0] if left else row[-1]]
    while len(row) > 1:
        row = [(1 - t) * a + t * b for a, b in zip(row, row[1:])]
        out.append(row[0] if left else row[-1])
    return out if left else out[::-1]


def between(row, a, b):
    """The control values from a to b, exactly."""
    row = cut(row, b, True)
    return cut(row, a / b, False)


def columns(net):
    return [list(c) for c in zip(*net)]


def grown(row):
    """The control values an eighth beyond both ends, times a power of two."""
    return _from(_from(row, True), False)


def _from(row, first):
    row = row if first else row[::-1]
    out = [row[-1]]
    # One end moves from 0 to -1/8: (1 - t) a + t b = (9 a - b) / 8; then from 1 to 1 + 1/9 of the new length.
    p, q, d = (9, 1, 8) if first else (10, 1, 9)
    while len(row) > 1:
        row = [(p * a - q * b) // d for a, b in zip(row, row[1:])]
        out.append(row[-1])
    out = out[::-1]
    return out if first else out[::-1]


class Square:
    """One part of a net: where it is in the net, and f and g there."""

    __slots__ = ("u", "v", "size_u", "size_v", "f", "g")

    def __init__(self, u, v, size_u, size_v, f, g):
        self.u, self.v, self.size_u, self.size_v, self.f, self.g = u, v, size_u, size_v, f, g

    def reach(self):
        """The largest of both functions, and the changes along both parameters."""
        rows = self.f + self.g
        along_u = max((abs(a - b) for row in rows for a, b in zip(row, row[1:])), default=0)
        along_v = max((abs(a - b) for net in (self.f, self.g) for r, s in zip(net, net[1:]) for a, b in zip(r, s)), default=0)
        return along_u * (len(self.f[0]) - 1), along_v * (len(self.f) - 1)

    def halves(self, across_u):
        if across_u:
            f, g = ([split(row) for row in net] for net in (self.f, self.g))
            h = self.size_u / 2
            return [Square(self.u + k * h, self.v, h, self.size_v, [r[k] for r in f], [r[k] for r in g]) for k in (0, 1)]
        f, g = ([split(column) for column in columns(net)] for net in (self.f, self.g))
        h = self.size_v / 2
        return [Square(self.u, self.v + k * h, self.size_u, h, columns([c[k] for c in f]), columns([c[k] for c in g])) for k in (0, 1)]

    def slopes(self):
        """f_u, f_v, g_u, g_v in the middle, as sums of differences of the corners: only whether they fit decides anything."""
        out = []
        for net in (self.f, self.g):
            n = len(net) - 1
            a, b = net[n // 2], net[(n + 1) // 2]
            m = len(a) - 1
            out.append((a[-1] - a[0] + b[-1] - b[0]) // 2)
            left, right = [row[m // 2] for row in net], [row[(m + 1) // 2] for row in net]
            out.append((left[-1] - left[0] + right[-1] - right[0]) // 2)
        return out


def differences(row):
    n = len(row) - 1
    return [n * (b - a) for a, b in zip(row, row[1:])] or [0]


def no_zero(f, g, tests, room):
    flat = [(a, b) for r, s in zip(f, g) for a, b in zip(r, s)]
    for p, q in tests:
        by = room * (abs(p) + abs(q))
        values = [p * a + q * b for a, b in flat]
        if min(values) > by or max(values) < -by:
            return True
    return False


def is_single(square):
    """Whether f and g take no value twice on a square and an eighth beyond: the functions grown if so."""
    fu, fv, gu, gv = square.slopes()
    det = fu * gv - fv * gu
    if det == 0:
        return None
    if det < 0:
        fu, fv, gu, gv = -fu, -fv, gu, gv
        f = [[-a for a in row] for row in square.f]
        det = -det
    else:
        f = square.f
    f = columns([grown(c) for c in columns([grown(row) for row in f])])
    g = columns([grown(c) for c in columns([grown(row) for row in square.g])])
    # On the grown square lengths are 5/4.
    low, high, off = 8 * det, 17 * det, 4 * det
    for along_u in (True, False):
        df, dg = ([differences(row) for row in (net if along_u else columns(net))] for net in (f, g))
        for r, s in zip(df, dg):
            for a, b in zip(r, s):
                # adj(J) = [[gv, -fv], [-gu, fu]].
                first, second = gv * a - fv * b, fu * b - gu * a
                own, other = (first, second) if along_u else (second, first)
                if not low <= 10 * own <= high or abs(10 * other) > off:
                    return None
    return f, g


def value_at(net, u, v):
    """The value and both slopes of a net of whole numbers at whole numbers of 2^-BITS."""
    u1, v1 = (1 << BITS) - u, (1 << BITS) - v

    def halfway(row, t, s):
        while len(row) > 2:
            row = [(s * a + t * b) >> BITS for a, b in zip(row, row[1:])]
        return row if len(row) == 2 else row * 2

    rows = [halfway(row, u, u1) for row in net]
    n, m = len(net[0]) - 1, len(net) - 1
    first, second = (halfway([r[k] for r in rows], v, v1) for k in (0, 1))
    mixed = lambda pair, t, s: (s * pair[0] + t * pair[1]) >> BITS
    a, b = mixed(first, v, v1), mixed(second, v, v1)
    low, high = mixed([first[0], second[0]], u, u1), mixed([first[1], second[1]], u, u1)
    return mixed([a, b], u, u1), n * (b - a), m * (high - low)


def zero_of(f, g):
    """Newton's method from the middle of a (grown) square: the zero there as whole numbers of 2^-BITS, or None."""
    u = v = 1 << (BITS - 1)
    one = 1 << BITS
    for _ in range(60):
        a, au, av = value_at(f, u, v)
        b, bu, bv = value_at(g, u, v)
        det = au * bv - av * bu
        if det == 0:
            return None
        du, dv = ((b * av - a * bv) << BITS) // det, ((a * bu - b * au) << BITS) // det
        u, v = u + du, v + dv
        if not (-one // 64 <= u <= one + one // 64 and -one // 64 <= v <= one + one // 64):
            return None
        if max(abs(du), abs(dv)) <= 1 << 100:
            return u, v
    return None


EITHER = 2
"""The turn of a line through a seam where the surface comes back turned over: it is that of either side."""


class Piece:
    """A homogeneous net over [u0, u1] x [v0, v1] of a surface's parameters; `ends` says which of its four sides are outer borders of the surface that do not meet another. The net reaches BEYOND all of them."""

    def __init__(self, rows, u, v, ends=(True,) * 4):
        self.rows, self.u, self.v, self.ends = rows, u, v, ends
        wider = lambda row: [tuple(p) for p in zip(*(between(list(c), -BEYOND, 1 + BEYOND) for c in zip(*row)))]
        self.net = columns([wider(column) for column in columns([wider(row) for row in rows])])
        self.whole = lcm(*(F(x).denominator for row in self.net for p in row for x in p))
        self.ints = [[tuple(int(x * self.whole) for x in p) for p in row] for row in self.net]

    def functions(self, ray):
        """f and g, scaled to BITS bits: times two to the `shifts`."""
        x, d, w = ray
        k = max(range(3), key=lambda i: abs(d[i]))
        nets = []
        moved = [[tuple(w * p[i] - x[i] * p[3] for i in range(3)) for p in row] for row in self.ints]
        for i in range(3):
            if i != k:
                nets.append([[d[k] * p[i] - d[i] * p[k] for p in row] for row in moved])
        out, self.shifts = [], []
        for net in nets:
            top = max(abs(a) for row in net for a in row)
            shift = BITS - top.bit_length()
            self.shifts.append(shift)
            out.append([[a << shift if shift >= 0 else a >> -shift for a in row] for row in net])
        return out

    def units(self, ray, error):
        """How much of f or g an error in space makes at most, after `functions`."""
        _, d, w = ray
        heavy = max(abs(p[3]) for row in self.ints for p in row)
        return int(2 * error * max(map(abs, d)) * w * heavy * F(2) ** max(self.shifts)) + 1

    def point(self, u, v):
        """The homogeneous point and its first derivatives at fractions, by sums."""
        n, m = len(self.rows[0]) - 1, len(self.rows) - 1
        bu, cu = bernstein_at(n, u)
        bv, cv = bernstein_at(m, v)
        # First along u, which serves the derivatives too.
        p, pu = ([tuple(sum(b * q[i] for b, q in zip(weights, row)) for i in range(4)) for row in self.rows] for weights in (bu, cu))
        mixed = lambda weights, points: tuple(sum(b * q[i] for b, q in zip(weights, points)) for i in range(4))
        return mixed(bv, p), mixed(bv, pu), mixed(cv, p)


def bernstein_at(n, t):
    """Bernstein's polynomials and their derivatives at a fraction."""
    s = 1 - t
    low = [comb(n - 1, i) * t**i * s ** (n - 1 - i) for i in range(n)] if n else []
    values = [comb(n, i) * t**i * s ** (n - i) for i in range(n + 1)]
    slopes = [n * ((low[i - 1] if i else 0) - (low[i] if i < n else 0)) for i in range(n + 1)]
    return values, slopes


def is_flat(tangents, d, bits):
    """Whether a direction is in the patch's plane, but for an angle of about 2^-bits."""
    top = lambda v: max(map(abs, v))
    return abs(dot(tangents.normal, d)) * (1 << bits) <= top(tangents.normal) * top(d)


def outside(x, slack):
    return x < -slack


def rounded(x, bits=200):
    return F(int(x * (1 << bits)), 1 << bits)


class Net(Patch):
    """Pieces over a domain ((u0, u1), (v0, v1)), closed along some parameters. `inside(place, a, b)`, if not all of the domain counts, is the distance to what bounds it, where u counts a and v b, and whether the place counts. Within `blur`, in
    parameters, the command need not tell which."""

    blur = 0

    def __init__(self, body, pieces, domain, points, directions, size, inside=None, closed=(False, False)):
        super().__init__(body, points, directions, size)
        self.pieces, self.domain, self.inside, self.closed = pieces, domain, inside, closed
        self.last, self.triangular = None, False

    # -- zeros --

    def search(self, ray, room=64, end=None, error=None):
        """Zeros (piece, u, v, None) and squares that are left (piece, u, v, square): where f and g may be less than `room`, or than an error in space makes of them."""
        found, count, self.gave_up = [], 0, False
        for piece in self.pieces:
            f, g = piece.functions(ray)
            todo = [Square(-BEYOND, -BEYOND, 1 + 2 * BEYOND, 1 + 2 * BEYOND, f, g)]
            least = (1 << (BITS - END)) if end is None else end
            if error:
                room = piece.units(ray, error)
                least = 8 * room
            while todo:
                square = todo.pop()
                count += 1
                if count > MOST:
                    self.within = self.gave_up = True
                    return found
                if self.skips(piece, square):
                    continue
                if no_zero(square.f, square.g, ((1, 0), (0, 1), (1, 1), (1, -1)), room):
                    continue
                fu, fv, gu, gv = square.slopes()
                if no_zero(square.f, square.g, ((gv, -fv), (-gu, fu)), room):
                    continue
                along_u, along_v = square.reach()
                if max(along_u, along_v) <= least:
                    found.append((piece, square.u + square.size_u / 2, square.v + square.size_v / 2, square))
                    continue
                # Within an error there may be another one than the exact one.
                nets = None if error else is_single(square)
                zero = nets and zero_of(*nets)
                if zero:
                    u, v = (F(5 * a, 4 << BITS) - F(1, 8) for a in zero)
                    tiny = F(1, 1 << 200)
                    if -tiny <= u <= 1 + tiny and -tiny <= v <= 1 + tiny:
                        found.append((piece, square.u + u * square.size_u, square.v + v * square.size_v, None))
                    continue
                todo += square.halves(along_u >= along_v)
        return found

    def skips(self, piece, square):
        """Beyond the long side of a triangle."""
        return self.triangular and square.u + square.v > 1 + BEYOND

    # -- crossings --

    def depth(self, piece, ray, u, v):
        """t at parameters of a piece, exactly."""
        x, d, w = ray
        k = max(range(3), key=lambda i: abs(d[i]))
        p = piece.point(u, v)[0]
        return (w * p[k] / p[3] - x[k]) / d[k] if p[3] else None

    def normal_at(self, piece, u, v):
        """The normal and both slopes, where the domain is from 0 to 1."""
        p, pu, pv = piece.point(u, v)
        w = p[3]
        su, sv = (tuple((q[i] * w - p[i] * q[3]) / (w * w) for i in range(3)) for q in (pu, pv))
        spans = [b - a for a, b in self.domain]
        su, sv = times(spans[0] / (piece.u[1] - piece.u[0]), su), times(spans[1] / (piece.v[1] - piece.v[0]), sv)
        return cross(su, sv), su, sv

    def tangents(self, piece, u, v):
        u, v = rounded(u), rounded(v)
        n, su, sv = self.normal_at(piece, u, v)
        top = lambda a: max(map(abs, a))
        if not any(n):
            return None, su, sv
        h = F(1, 1 << 24)
        du, dv = (sub(self.normal_at(piece, u + a, v + b)[0], n) for a, b in ((h, 0), (0, h)))
        spans = [(p[1] - p[0]) / (b - a) for p, (a, b) in zip((piece.u, piece.v), self.domain)]
        rate = 2 * max(top(su), top(sv)) / top(n)
        bend = 4 * rate * (top(du) / (h * spans[0]) + top(dv) / (h * spans[1]))
        n, bend = tuple(rounded(x / top(n)) for x in n), bend / top(n)
        return Tangents(n, rounded(bend) + F(1, 1 << 200)), su, sv

    def meetings(self, ray):
        """(t, tangents or None, whether it is on a border, turn, whether it is told even so), for each place."""
        if self.last and self.last[0] == ray:
            self.within |= self.last[2]
            self.beside = self.last[3]
            return self.last[1]
        self.within = False
        slack = 4 * self.error(ray)
        d = tuple(F(x, ray[2]) for x in ray[1])
        top = lambda a: max(map(abs, a))
        raw, tiny = [], F(1, 1 << 180)
        self.beside = []
        for piece, u, v, square in self.search(ray):
            if square is not None:
                if any(outside(x, square.size_u + square.size_v) and not end for x, end in zip((u, 1 - u, v, 1 - v), piece.ends)):
                    continue
                # Anything may be here; the hull of the corners is where.
                ts = [self.depth(piece, ray, square.u + a * square.size_u, square.v + b * square.size_v) for a in (0, 1) for b in (0, 1)]
                if None in ts:
                    self.within = True
                    continue
                wide = F(top([F(x, ray[2]) for x in ray[0]]) + self.size) / top(d) / (1 << 66)
                raw.append([min(ts) - wide, max(ts) + wide, [], True, 0, self.parameters(piece, u, v), False, False])
                continue
            t = self.depth(piece, ray, rounded(u, 300), rounded(v, 300))
            if t is None:
                self.within = True
                continue
            tangents, su, sv = self.tangents(piece, u, v)
            place = self.parameters(piece, u, v)
            if tangents is None:
                raw.append([t, t, [], True, 0, place, False, False])
                continue
            # How far the ray's own rounding moves the place along the surface: more where it grazes.
            n = tangents.normal
            grazing = top(n) * top(d) / abs(dot(n, d)) if dot(n, d) else F(1 << 60)
            area = top(cross(su, sv))
            off = slack * grazing * 4 * top(su) * top(sv) / area
            apart, kept = self.clearance(place, su, sv)
            if apart < -off:
                continue
            # Beyond an inner border another piece is met, but for rounding.
            scales = [top(s) * (p[1] - p[0]) / (b - a) for s, p, (a, b) in zip((su, sv), (piece.u, piece.v), self.domain)]
            to_inner = min((x * scales[k // 2] for k, x in enumerate((u, 1 - u, v, 1 - v)) if not piece.ends[k]), default=2 * off)
            if any(outside(x, tiny) and not end for x, end in zip((u, 1 - u, v, 1 - v), piece.ends)):
                if to_inner > -off:
                    self.beside.append((t, tangents, sign(dot(n, d))))
                continue
            # Next to an edge that is one point there is no normal.
            tip = area * (1 << 20) < self.size * max(top(su), top(sv))
            needed = kept and not tip and to_inner > off
            raw.append([t, t, [] if tip else [tangents], tip or apart < off, sign(dot(n, d)), place, to_inner < off, needed])
        out = self.joined(raw, ray)
        self.last = (ray, out, self.within, self.beside)
        return out

    def parameters(self, piece, u, v):
        return piece.u[0] + u * (piece.u[1] - piece.u[0]), piece.v[0] + v * (piece.v[1] - piece.v[0])

    def clearance(self, place, su, sv):
        """How far from a border in space, about, negative outside; and whether a place is within all of them."""
        scale = [max(map(abs, slope)) / (b - a) for slope, (a, b) in zip((su, sv), self.domain)]
        ways = [F(1 << 200)]
        for k, (a, b) in enumerate(self.domain):
            if not self.closed[k]:
                ways += [(place[k] - a) * scale[k], (b - place[k]) * scale[k]]
        kept = min(ways) >= -self.size / (1 << 180)
        if self.inside:
            far, stays = self.inside(place, *scale)
            ways.append(max(far - self.blur * max(scale), 0) * (1 if stays else -1))
            kept &= stays
        return min(ways), kept

    def apart(self, p, q):
        """How far two places are from each other, also across a seam, as a part of the domain."""
        out = []
        for x, y, (a, b), closed in zip(p, q, self.domain, self.closed):
            far = abs(x - y) / (b - a)
            out.append(min(far, abs(far - 1)) if closed else far)
        return max(out)

    def is_turned_over(self, p, q):
        """Whether two places are on either side of a seam where the surface comes back turned over."""
        return False

    def joined(self, raw, ray):
        """Places on borders of pieces, which two of them find, are one; along a seam too."""
        raw.sort(key=lambda r: r[0] + r[1])
        tiny = F(1, 1 << 150)
        scale = self.size / max(abs(F(x, ray[2])) for x in ray[1])
        out = []
        for r in raw:
            same = next((o for o in out if r[0] - o[1] <= scale * tiny and (r[1] > r[0] or o[1] > o[0] or self.apart(r[5], o[5]) <= tiny)), None)
            if same is None:
                out.append(r)
                continue
            same[0], same[1] = min(same[0], r[0]), max(same[1], r[1])
            same[3] |= r[3]
            same[6] |= r[6]
            if same[4] != r[4] and self.is_turned_over(same[5], r[5]):
                # One end of the domain may be a rounding beyond the other.
                same[4], same[7] = EITHER, same[7] or r[7]
                same[2] += r[2]
                continue
            same[7] &= r[7]
            if same[4] != r[4]:
                # A crease that is touched, or what is left of a tangent.
                same[3], same[4], same[7] = True, 0, False
            same[2] += r[2]
        # Along a line of the surface.
        self.within |= any((o[1] - o[0]) * (1 << 20) > scale for o in out)
        eps = scale / (1 << 230)
        # Across a crease, where a ray passes it within rounding, the pieces may not agree which of them is met; on smooth borders they find the same.
        alike = lambda t, turn, beside: turn == beside[2] and abs(t - beside[0]) * (1 << 36) <= scale
        alone = [b for b in self.beside if not any(alike(o[0], o[4], b) for o in out)]
        for o in out:
            same = [b[0] for b in self.beside if alike(o[0], o[4], b)]
            if same:
                # Of the crossing on either side.
                o[0], o[1] = min(o[0], *same), max(o[1], *same)
            elif o[6]:
                o[3] = True
        out += [[t, t, [tangents], True, turn, None, True, False] for t, tangents, turn in alone]
        return [(Place(a - eps, b + eps), n, border, turn, needed) for a, b, n, border, turn, _, _, needed in out]

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        self.within = False
        found = sorted(self.meetings(ray), key=cmp_to_key(lambda a, b: a[0].cmp(b[0])))
        self.met = [(t, n) for t, normals, *_ in found for n in normals or [None]] + [(Place(t, t), n) for t, n, _ in self.beside]
        d = tuple(F(x, ray[2]) for x in ray[1])
        flip = -1 if self.inverse else 1
        events = []
        for t, normals, border, turn, needed in found:
            event = Event(t, flip * (turn if turn != EITHER else 1), [(n, flip) for n in normals], self, any_sign=turn == EITHER)
            # Within the patch's own plane but for some rounding errors.
            flat = any(is_flat(n, d, 44) for n in normals)
            event.optional, event.needed = border or flat, needed and not flat
            events.append(event)
        return Answer(self.clipped(events, ray), [], self.within)

    def is_tangent(self, ray, lo, hi):
        """Whether a ray is in the patch's plane next to a cluster but for an angle of 2^-18, or comes and goes as near as the cluster is wide."""
        lo, hi = F(lo), F(hi)
        wide = hi - lo + self.size / max(abs(F(x, ray[2])) for x in ray[1]) / (1 << 30)
        d = tuple(F(x, ray[2]) for x in ray[1])
        beside = lambda t: t.against(lo - 2 * wide) >= 0 >= t.against(hi + 2 * wide)
        if any(beside(t) and (not normals or any(is_flat(n, d, 18) for n in normals)) for t, normals, *_ in self.meetings(ray)):
            return True
        # What is met in so many places that they were not all looked at is a tangent of a high order.
        return any(lo - 2 * wide <= t <= hi + 2 * wide for t in self.low_places(ray)) or self.gave_up

    def passes_an_edge(self, ray, lo, hi):
        lo, hi = F(lo), F(hi)
        found = self.meetings(ray)
        wide = 2 * (hi - lo)
        near_crease = any(lo - wide <= t <= hi + wide for t, _, _ in self.beside)
        return near_crease or any((border or len(normals) > 1) and t.against(lo) >= 0 >= t.against(hi) for t, normals, border, *_ in found)

    def low_places(self, ray):
        """Where a ray passes the surface by less than 2^-34 of it without a sure crossing."""
        for piece, u, v, square in self.search(ray, 1 << (BITS - 36), 1 << (BITS - 32)):
            if square is not None:
                t = self.depth(piece, ray, u, v)
                if t is not None:
                    yield t
