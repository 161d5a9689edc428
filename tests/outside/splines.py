"""Scenes of nets: NURBS with seams, creases and trims, rational Bezier patches, uniform B-splines and triangular patches."""

from fractions import Fraction as F
from math import comb

from nets import Net, Piece, columns
from shapes import text, vec
from trims import ARCS, QUARTERS, bezier, beside_loops, curves_of, knots_of, loops_of, on, spans
from zero_sets import near


def spline_pieces(rows, knots, degrees, closed):
    """The pieces of a net of homogeneous points, u along a row."""
    along_u = spans(rows[0], knots[0], degrees[0])
    along_v = spans(rows, knots[1], degrees[1])
    out = []
    for su in along_u:
        part = columns([bezier(row, knots[0], degrees[0], su) for row in rows])
        for sv in along_v:
            net = columns([bezier(column, knots[1], degrees[1], sv) for column in part])
            ends = [s == edge and not c for spans_, s, c in ((along_u, su, closed[0]), (along_v, sv, closed[1])) for edge in (spans_[0], spans_[-1])]
            out.append(Piece(net, su[1:], sv[1:], ends))
    return out


def lifted(p, w=1):
    return (*(F(x) * w for x in p), F(w))


def words_of(points, weights):
    """Points of the text, with their weights if there are any."""
    return ", ".join(vec((*p, w)) if weights else vec(p) for p, w in points)


def drawn(rng, wild):
    return F(rng.uniform(-2, 2)) if wild else F(rng.randint(-4, 4))


def drawn_weight(rng, wild):
    return F(rng.uniform(0.25, 4)) if wild else F(rng.choice((1, 1, 2, 3, 4, F(1, 2), F(1, 4))))


def grid(rng, nu, nv, scale, wild, weights):
    """Points somewhere, or near a grid, or graphs with some points moved; (point, weight) row by row."""
    style = rng.choice(("any", "near", "near", "graph"))
    rows = []
    for j in range(nv):
        row = []
        for i in range(nu):
            h = drawn(rng, wild)
            if style == "any":
                p = (drawn(rng, wild), h, drawn(rng, wild))
            else:
                p = (2 * i - nu + 1, h / 2, 2 * j - nv + 1)
                if style == "near":
                    p = tuple(x + drawn(rng, wild) / 4 for x in p)
            row.append((tuple(scale * F(float(x)) for x in p), drawn_weight(rng, wild) if weights else F(1)))
        rows.append(row)
    if rng.random() < 0.12:
        # An edge that is one point.
        rows[0] = [(rows[0][0][0], w) for _, w in rows[0]]
    if rng.random() < 0.08:
        # One that is doubled: no slope there along v.
        rows[1] = [(p, w) for (p, _), (_, w) in zip(rows[0], rows[1])] if nv > 2 else rows[1]
    return rows


def aims_of(rng, leaf, arcs=()):
    """Points at borders, knots, middles and trims, with their normals."""
    def points():
        for _ in range(3):
            for _ in range(20):
                piece = rng.choice(leaf.pieces)
                part = lambda: rng.choice((F(0), F(1), F(rng.randint(1, 7), 8), F(rng.random()), F(rng.random())))
                u, v = part(), part()
                if arcs and rng.random() < 0.6:
                    # On a trim, or next to it.
                    far = F(2) ** rng.randint(-50, -8) if rng.random() < 0.5 else F(0)
                    at_ = on(rng.choice(arcs), rng.choice((F(0), F(1, 2), F(rng.random()))))
                    u, v = (min(max(x + rng.choice((-1, 0, 1)) * far * (b - a), a), b) for x, (a, b) in zip(at_, leaf.domain))
                    piece = next(p for p in leaf.pieces if p.u[0] <= u <= p.u[1] and p.v[0] <= v <= p.v[1])
                    u, v = (u - piece.u[0]) / (piece.u[1] - piece.u[0]), (v - piece.v[0]) / (piece.v[1] - piece.v[0])
                if not leaf.triangular or u + v <= 1:
                    break
            p = piece.point(u, v)[0]
            n = leaf.normal_at(piece, u, v)[0]
            p = near(tuple(x / p[3] for x in p[:3]))
            leaf.known[p] = n
            yield p

    return points


AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 0)]


def has_area(leaf):
    return all(any(leaf.normal_at(piece, *at_)[0]) for piece in leaf.pieces for at_ in ((F(1, 3), F(2, 7)), (F(3, 5), F(2, 9))))


def nurbs(rng):
    leaf = any_nurbs(rng, rng.choice(("plain", "plain", "trimmed", "trimmed", "turned", "periodic")))
    while not has_area(leaf):
        leaf = any_nurbs(rng, "trimmed")
    return leaf


def trimmed(rng):
    """Trimmed by curves."""
    leaf = any_nurbs(rng, rng.choice(("trimmed", "trimmed", "turned", "periodic")), curves_of)
    while not has_area(leaf):
        leaf = any_nurbs(rng, "trimmed", curves_of)
    return leaf


def curved_patch(rng):
    leaf = any_patch(rng)
    while not has_area(leaf):
        leaf = any_patch(rng)
    return leaf


def any_nurbs(rng, style, curves=None):
    """Trimmed by polygons if its style says so; or by curves."""
    wild, weighted = rng.random() < 0.3, rng.random() < 0.6
    scale = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    closed = (False, False)
    if style == "turned":
        # About y, with a seam; the rows may begin and end on the axis.
        degrees = (2, rng.choice((1, 2, 3)))
        n = degrees[1] + rng.randint(1, 3)
        profile = [(F(rng.randint(1, 4)), F(drawn(rng, False)), drawn_weight(rng, False)) for _ in range(n)]
        if rng.random() < 0.4:
            profile[0] = (F(0), *profile[0][1:])
        rows = [[(tuple(scale * x for x in (r * c, y, r * s)), w * k) for c, s, k in QUARTERS] for r, y, w in profile]
        knots, weighted, closed = [ARCS, knots_of(rng, n, degrees[1])], True, (True, False)
    else:
        degrees = (rng.randint(1, 4), rng.randint(1, 4))
        counts = [d + rng.randint(1, 4) for d in degrees]
        rows = grid(rng, *counts, scale, wild, weighted)
        knots = [knots_of(rng, n, d) for n, d in zip(counts, degrees)]
    count = (len(rows[0]), len(rows))
    listed = [("u_knots", knots[0]), ("v_knots", knots[1])]
    if style == "periodic":
        k = rng.randrange(2)
        closed = (k == 0, k == 1)
        d, n = degrees[k], count[k]
        steps = [F(rng.choice((1, 1, 2, F(1, 2)))) if rng.random() < 0.5 else F(1) for _ in range(n)]
        around = [sum(steps[:i], F(0)) for i in range(n + 1)]
        listed[k] = (listed[k][0], around)
        knots[k] = [around[i % n] + i // n * around[-1] for i in range(-d, n + d + 1)]
        # The first span is made of the first points.
        full = [[row[i % n] for i in range(n + d)] for row in rows] if k == 0 else [rows[j % n] for j in range(n + d)]
    else:
        full = rows
    domain = tuple((kn[d], kn[len(kn) - 1 - d]) for kn, d in zip(knots, degrees))
    loops = curves(rng, domain) if curves else loops_of(rng, domain) if style == "trimmed" else []
    body = f"nurbs {{ degree {degrees[0]}, {degrees[1]} points {count[0]}, {count[1]}, {words_of([p for row in rows for p in row], weighted)}"
    for name, values in listed:
        body += f" {name} {len(values)}, {', '.join(map(text, values))}"
    if style == "periodic":
        body += " periodic " + "uv"[closed.index(True)]
    for loop in loops:
        body += " " + loop.words
    pieces = spline_pieces([[lifted(*p) for p in row] for row in full], knots, degrees, closed)
    size = max(abs(x) for row in rows for p, _ in row for x in p)
    leaf = Net(body + " }", pieces, domain, None, AXES, size, beside_loops(loops) if loops else None, closed)
    leaf.blur = max((loop.blur() for loop in loops), default=0)
    leaf.points = aims_of(rng, leaf, [arc for loop in loops for arc in loop.arcs])
    return leaf


def any_patch(rng):
    """Rational Bezier patches, uniform B-splines, triangles."""
    wild, weighted = rng.random() < 0.3, rng.random() < 0.6
    scale = F(2) ** rng.choice((0, 0, -6, 4, -20, 20))
    style = rng.choice(("bezier", "bezier", "b_spline", "bicubic", "triangular", "triangular"))
    square = ((F(0), F(1)), (F(0), F(1)))
    if style == "triangular":
        n = rng.randint(2, 5)
        rows = grid(rng, n, n, scale, wild, weighted)
        net = {(i, j): rows[j][i] for j in range(n) for i in range(n - j)}
        listed = [net[i, j] for j in range(n) for i in range(n - j)]
        body = f"patch {{ triangular {n}, {words_of(listed, weighted)} }}"
        leaf = Net(body, [Piece(triangle_net({k: lifted(*p) for k, p in net.items()}, n - 1), *square)], square, None, AXES, 1)
        # What is left of 2^-180 is on the long side.
        leaf.inside = lambda place, a, b: (abs(1 - place[0] - place[1]) * min(a, b), place[0] + place[1] - 1 <= F(1, 1 << 180))
        leaf.triangular = True
        points = [p for p, _ in listed]
    else:
        nu, nv = (4, 4) if style == "bicubic" else (rng.randint(2, 5), rng.randint(2, 5))
        if style == "b_spline":
            nu, nv = rng.randint(4, 6), rng.randint(4, 6)
        rows = grid(rng, nu, nv, scale, wild, weighted and style != "bicubic")
        listed = words_of([p for row in rows for p in row], weighted and style != "bicubic")
        full = [[lifted(*p) for p in row] for row in rows]
        points = [p for row in rows for p, _ in row]
        if style == "b_spline":
            knots = [[F(k - 3) for k in range(n + 4)] for n in (nu, nv)]
            domain = tuple((F(0), F(n - 3)) for n in (nu, nv))
            leaf = Net(f"patch {{ b_spline {nu}, {nv}, {listed} }}", spline_pieces(full, knots, (3, 3), (False, False)), domain, None, AXES, 1)
        else:
            body = f"bicubic_patch {{ type {rng.choice((0, 1))} u_steps 2 v_steps 3 {listed} }}" if style == "bicubic" else f"patch {{ {nu}, {nv}, {listed} }}"
            leaf = Net(body, [Piece(full, *square)], square, None, AXES, 1)
    leaf.size = max(abs(x) for p in points for x in p)
    leaf.points = aims_of(rng, leaf)
    return leaf


def triangle_net(net, m):
    """The net over the square of a triangle's, of degree m along both parameters."""
    powers = {}
    for (i, j), p in net.items():
        # m! / (i! j! k!) u^i v^j (1 - u - v)^k
        k = m - i - j
        for a in range(k + 1):
            for b in range(k - a + 1):
                factor = comb(m, i) * comb(m - i, j) * (-1) ** (a + b) * comb(k, a) * comb(k - a, b)
                old = powers.get((i + a, j + b), (F(0),) * 4)
                powers[i + a, j + b] = tuple(x + factor * y for x, y in zip(old, p))
    return net_of(powers, m, m)


def net_of(powers, n, m):
    """Bernstein's factors from those of u^a v^b, by rows along v."""
    def value(i, j):
        out = (F(0),) * 4
        for (a, b), p in powers.items():
            if a <= i and b <= j:
                factor = F(comb(i, a) * comb(j, b), comb(n, a) * comb(m, b))
                out = tuple(x + factor * y for x, y in zip(out, p))
        return out

    return [[value(i, j) for i in range(n + 1)] for j in range(m + 1)]
