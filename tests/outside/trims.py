"""Trims: loops of lines, cubics and rational splines in the plane of the parameters.

A line from a place to the right crosses the loops as often as their arcs do. An arc whose control points are all above or below the place, or left or right of it, crosses that line as its ends say; others
are cut in two. All numbers are whole ones of 2^-BITS of the largest, so a place is taken for one on a curve only if it is nearer than 2^-250 of the loop's size. How far the curves are is
found by the boxes of the nearest arcs.
"""

from fractions import Fraction as F
from heapq import heapify, heappop, heappush
from math import cos, pi, sin

from shapes import text, vec

BITS = 320
ON = 250
"""What is nearer than 2^-ON of a loop's size is on it."""


# ---- curves of B-splines ----


def blossom(points, knots, i, degree, places):
    """The polar form of a B-spline on [knots[i], knots[i + 1]]."""
    p = [points[i - degree + k] for k in range(degree + 1)]
    for r, t in enumerate(places, 1):
        for k in range(degree, r - 1, -1):
            a, b = knots[i - degree + k], knots[i + k - r + 1]
            s = (t - a) / (b - a)
            p[k] = tuple((1 - s) * x + s * y for x, y in zip(p[k - 1], p[k]))
    return p[degree]


def spans(points, knots, degree):
    """(index, a, b) of the spans of a B-spline that have a length."""
    return [(i, knots[i], knots[i + 1]) for i in range(degree, len(points)) if knots[i] < knots[i + 1]]


def bezier(points, knots, degree, span):
    i, a, b = span
    return [blossom(points, knots, i, degree, [a] * (degree - k) + [b] * k) for k in range(degree + 1)]


def knots_of(rng, count, degree):
    """Clamped knots, some of them multiple, uniform ones among them."""
    inner = count - degree - 1
    style = rng.choice(("uniform", "whole", "any"))
    if style == "uniform":
        values = [F(k) for k in range(1, inner + 1)]
    elif style == "whole":
        values, at_ = [], F(0)
        while len(values) < inner:
            at_ += rng.choice((1, 1, 2, 3, F(1, 2)))
            values += [at_] * min(rng.choice((1, 1, 1, 2, degree)), inner - len(values), degree)
    else:
        values = sorted(F(rng.uniform(0.125, 7)) for _ in range(inner))
    last = (values[-1] if values else 0) + rng.choice((1, 2))
    last = F(float(last))
    start = F(0)
    return [start] * (degree + 1) + values + [last] * (degree + 1)


QUARTERS = [(1, 0, 1), (1, 1, 1), (0, 1, 2), (-1, 1, 1), (-1, 0, 1), (-1, -1, 1), (0, -1, 2), (1, -1, 1), (1, 0, 1)]
"""A circle of four quarters: cosine, sine and weight."""
ARCS = [F(k) for k in (0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4)]


# ---- loops ----


class Loop:
    """Bezier arcs, each a list of (u w, v w, w), and the text that makes them."""

    is_round = False

    def __init__(self, words, arcs):
        self.words, self.arcs = f"trim {{ {words} }}", arcs

    @staticmethod
    def polygon(points):
        ends = zip(points, points[1:] + points[:1])
        return Loop(f"linear_spline {len(points)}, {', '.join(map(vec, points))}", [[(*a, F(1)), (*b, F(1))] for a, b in ends])

    @staticmethod
    def cubics(points):
        arcs = [[(*p, F(1)) for p in points[k : k + 4]] for k in range(0, len(points), 4)]
        return Loop(f"bezier_spline {len(points)}, {', '.join(map(vec, points))}", arcs)

    @staticmethod
    def spline(degree, points, knots, weighted):
        """Points (u, v, w), not multiplied by their weights."""
        listed = ", ".join(vec(p if weighted else p[:2]) for p in points)
        curve = [(u * w, v * w, w) for u, v, w in points]
        arcs = [bezier(curve, knots, degree, s) for s in spans(curve, knots, degree)]
        return Loop(f"nurbs_curve degree {degree}, {len(points)}, {listed} knots {len(knots)}, {', '.join(map(text, knots))}", arcs)

    def left(self):
        """Whether it runs counter-clockwise: the area of a polygon with eight corners an arc."""
        corners = [on(arc, F(k, 8)) for arc in self.arcs for k in range(8)]
        return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1])) > 0

    def blur(self):
        """How near to it the command need not decide, in parameters: within six errors of a piece of the curve that was halved until it was as small as four of them. A control point counts as off by
        four roundings of the largest coordinate times the ratio of the weights, and by two for each point of the piece in each halving; 64 halvings leave less than a rounding."""
        def error(arc):
            heavy, light = max(p[2] for p in arc), min(p[2] for p in arc)
            return (4 + 2 * len(arc) * 64) * max(abs(x / p[2]) for p in arc for x in p[:2]) * heavy / light

        return 6 * max(map(error, self.arcs)) / (1 << 53)


def on(arc, t):
    """The point of an arc."""
    while len(arc) > 1:
        arc = [tuple((1 - t) * x + t * y for x, y in zip(a, b)) for a, b in zip(arc, arc[1:])]
    u, v, w = arc[0]
    return u / w, v / w


def halved(arc):
    """Both halves of an arc of whole numbers; half a unit is lost in each step."""
    left, right = [arc[0]], [arc[-1]]
    while len(arc) > 1:
        arc = [((p[0] + q[0]) >> 1, (p[1] + q[1]) >> 1, (p[2] + q[2]) >> 1) for p, q in zip(arc, arc[1:])]
        left.append(arc[0])
        right.append(arc[-1])
    return left, right[::-1]


def crosses(arc):
    """Whether an arc crosses the line from the origin to the right an odd number of times; None if it passes through the origin."""
    odd, todo = False, [arc]
    while todo:
        arc = todo.pop()
        a, b = [p[0] for p in arc], [p[1] for p in arc]
        if max(a) < 0 or min(b) > 0 or max(b) <= 0:
            continue
        if min(a) > 0:
            odd ^= (b[0] > 0) != (b[-1] > 0)
        elif max(max(a) - min(a), max(b) - min(b)) >> (BITS - ON) == 0:
            return None
        else:
            todo += halved(arc)
    return odd


def gap(arc):
    """Less and more than the distance of an arc from the origin, along an axis, in 2^-BITS."""
    a, b = ([(p[k] << BITS) // p[2] for p in arc] for k in (0, 1))
    least = max(min(a), -max(a), min(b), -max(b), 0)
    return least, min(max(abs(a[i]), abs(b[i])) for i in (0, -1)), max(max(a) - min(a), max(b) - min(b))


def distance(arcs):
    """Of some arcs from the origin, or up to a quarter less; 0 on them."""
    queue = []
    for arc in arcs:
        queue.append((*gap(arc), len(queue), arc))
    best, count = min(entry[1] for entry in queue), len(queue)
    heapify(queue)
    while True:
        least, _, wide, _, arc = heappop(queue)
        if 4 * least >= 3 * best:
            return least
        if wide >> (BITS - ON) == 0:
            return 0
        for half in halved(arc):
            entry = gap(half)
            best = min(best, entry[1])
            count += 1
            heappush(queue, (*entry, count, half))


def beside_loops(loops):
    """How far from loops, and whether what is there stays: what lies to the left of them does. A place on one of them stays."""
    around = not loops[0].left()

    def inside(place, ku, kv):
        # The place is the origin; lengths are counted in the largest one.
        moved = [[(ku * (p[0] - place[0] * p[2]), kv * (p[1] - place[1] * p[2]), p[2]) for p in arc] for loop in loops for arc in loop.arcs]
        top, heavy = max(max(abs(x) for x in p[:2]) for arc in moved for p in arc), max(p[2] for arc in moved for p in arc)
        k, w = F(1 << BITS) / top, F(1 << BITS) / heavy
        moved = [[(int(p[0] * k), int(p[1] * k), int(p[2] * w)) for p in arc] for arc in moved]
        kept, is_on = around, False
        for odd in map(crosses, moved):
            is_on |= odd is None
            kept ^= bool(odd)
        far = F(distance(moved), 1 << BITS) * top / heavy
        return (F(0), True) if is_on or far == 0 else (far, kept)

    return inside


# ---- random ones ----


def ring(rng, count, left, low):
    """Points about the origin, one after the other."""
    start = rng.choice((0.0, 0.5, rng.random()))
    out = []
    for k in range(count):
        angle = 2 * pi * (k + start + rng.choice((0.0, rng.uniform(-0.2, 0.2)))) / count
        r = rng.choice((1.0, rng.uniform(low, 1), low))
        out.append((r * cos(angle), r * sin(angle) * (1 if left else -1)))
    return out


def shape(rng, left, place, low=0.6):
    """A loop within the unit disc, which `place` puts into the plane."""
    style = rng.choice(("circle", "circle", "egg", "egg", "cusped", "spline", "spline", "wave"))
    if style == "circle":
        points = [(*place(c, s if left else -s), F(w)) for c, s, w in QUARTERS]
        loop = Loop.spline(2, points, ARCS, True)
        loop.is_round = True
        return loop
    if style in ("egg", "cusped"):
        n = rng.randint(2, 4)
        points = [place(*p) for p in ring(rng, 3 * n, left, low)]
        points = [p for k in range(n) for p in [*points[3 * k : 3 * k + 3], points[(3 * k + 3) % (3 * n)]]]
        if style == "cusped":
            # Pieces that begin or end at rest, straight ones among them; but two straight ones would be the same line.
            bent = points[5]
            for k in range(n):
                if rng.random() < 0.6:
                    points[4 * k + 1] = points[4 * k]
                if rng.random() < 0.6:
                    points[4 * k + 2] = points[4 * k + 3]
            if n == 2 and all(points[4 * k + 1] == points[4 * k] and points[4 * k + 2] == points[4 * k + 3] for k in range(2)):
                points[5] = bent
        return Loop.cubics(points)
    degree, weighted = rng.randint(1, 5), rng.random() < 0.6
    n = rng.randint(degree + 4, degree + 7)
    found = ring(rng, n, left, low)
    if style == "wave":
        # In and out, so that it bends both ways.
        found = [(x * s, y * s) for (x, y), s in zip(found, [1, low] * n)]
    points = [(*place(*p), F(rng.choice((1, 1, 2, F(1, 2), F(rng.uniform(0.25, 4))))) if weighted else F(1)) for p in found]
    points.append(points[0])
    return Loop.spline(degree, points, knots_of(rng, n + 1, degree), weighted)


def polygons_of(rng, at):
    """Polygons: one outside, perhaps, and holes in it; `at` puts sixteenths of the domain into it."""
    loops = []
    outer = rng.random() < 0.6
    if outer:
        corners = [(1, 1), (15, 1), (15, 15), (1, 15)]
        if rng.random() < 0.5:
            corners = [(0, 0), (16, 0), (16, 16), (0, 16)] if rng.random() < 0.3 else [(a + rng.choice((0, 1, F(rng.random()))), b + rng.choice((0, -1, 1, F(rng.random()))) * (0 < b)) for a, b in [(1, 1), (14, 1), (14, 14), (8, 14), (1, 14)]]
            corners = [(a, b if b < 13 else max(b, F(27, 2))) for a, b in corners]
        loops.append(Loop.polygon([at(*p) for p in corners]))
    for a, b in rng.sample([(3, 3), (8, 3), (3, 8), (8, 8)], rng.randint(0 if outer else 1, 3)):
        corners = [(a, b), (a, b + 4), (a + 4, b + 4), (a + 4, b)]
        if rng.random() < 0.5:
            corners = [(x + rng.choice((0, 0, F(rng.random()) / 2)), y + rng.choice((0, F(rng.random()) / 2))) for x, y in corners[: rng.choice((3, 4))]]
        loops.append(Loop.polygon([at(*p) for p in corners]))
    return loops


def in_sixteenths(domain):
    """Places as f64 numbers, so that the text holds them."""
    (u0, u1), (v0, v1) = domain
    return lambda a, b: (F(float(u0 + (u1 - u0) * F(a) / 16)), F(float(v0 + (v1 - v0) * F(b) / 16)))


def loops_of(rng, domain):
    return polygons_of(rng, in_sixteenths(domain))


def curves_of(rng, domain):
    """Curves of all kinds: an outer one, perhaps up to the border, holes in it, and islands in these, some of which leave only a thin gap."""
    at = in_sixteenths(domain)
    disc = lambda a, b, r: lambda x, y: at(a + r * F(x), b + r * F(y))
    scale = [16 / (b - a) for a, b in domain]
    loops = []

    def fits(loop, kept, room):
        """Whether a loop is within what stays so far, or what does not; no loop is yet within it."""
        if not loops:
            return True
        inside = beside_loops(loops)
        found = [inside(on(arc, F(k, 16)), *scale) for arc in loop.arcs for k in range(16)]
        return all(far >= room and stays == kept for far, stays in found)

    outer = rng.random() < 0.6
    if outer:
        square = Loop.polygon([at(*p) for p in ((1, 1), (15, 1), (15, 15), (1, 15))])
        loops.append(square if rng.random() < 0.2 else shape(rng, True, disc(8, 8, rng.choice((7, 8))), 0.8))
    holes = [(5, 5), (11, 5), (5, 11), (11, 11)]
    for a, b in rng.sample(holes, rng.randint(0 if outer else 1, 3)):
        seed, r = rng.random(), rng.choice((2, F(5, 2)))
        again = lambda left, r: shape(type(rng)(seed), left, disc(a, b, r))
        hole = again(False, r)
        if not fits(hole, True, F(1, 8)):
            continue
        loops.append(hole)
        if rng.random() < 0.4:
            # The same again, mirrored and smaller; of a circle sometimes with a thin gap.
            thin = hole.is_round and rng.random() < 0.5
            island = again(True, r * (1 - F(1, 1 << rng.choice((4, 8, 12, 16)))) if thin else r / 4)
            if fits(island, False, F(1, 1 << 18) if thin else F(1, 16)):
                loops.append(island)
    return loops
