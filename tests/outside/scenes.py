"""Random scenes of the surfaces that `check_trace.py` examines, with numbers that the text holds exactly."""

from fractions import Fraction as F
from itertools import product

from shapes import (
    Form, IDENTITY, Loops, Map, Sheet, Solid, TURNS, UNITS, add, cross, distance_form, dot, dyadic, frame, halfspace, on_circle,
    signed_permutation, small, sub, text, times, vec, wall_form,
)
from fields import Copies, height_field, ifs, terrain_sheet
from lathes import lathe
from parametrics import parametric
from patches import bilinear, patch
from prisms import curved_prism, prism, straight_sweep
from rounded import blob, isosurface, julia, superellipsoid
from solids import Region, lemon, ovus, sor
from sphere_sweeps import sphere_sweep
from splines import curved_patch, nurbs, trimmed
from zero_sets import ZeroSet, cyclide, polynomial, torus


def wild(rng, low=-4, high=4):
    """Any f64 of a decent size."""
    return F(rng.choice((-1, 1)) * rng.uniform(1, 2) * 2.0 ** rng.randint(low, high))


def centre(rng, u):
    reach = rng.choice((0, 1, 10, 1000))
    return tuple(F(rng.randint(-reach, reach)) * u for _ in range(3))


def unit(rng):
    """The power of two that scales whole-number shapes."""
    return F(2) ** rng.choice((0, 0, 0, -3, 4, -10, 10, -30, 30))


def rounded(p):
    return tuple(F(float(x)) for x in p)


def sphere(rng):
    if rng.random() < 0.3:
        c, r = tuple(wild(rng) for _ in range(3)), abs(wild(rng))
    else:
        u = unit(rng)
        c, r = centre(rng, u), rng.choice((1, 3, 5, 7, 9, 15, 45, 63, 315)) * u
    form = distance_form(c, r)

    def points():
        m, v = rng.choice([x for x in UNITS if F(r) / x[0] == F(float(F(r) / x[0]))])
        yield add(c, times(r / m, signed_permutation(rng, v)))
        yield add(c, times(r * rng.choice((0, dyadic(rng))), small(rng, 1)))
        yield rounded(add(c, times(r / F(dot(v := small(rng, 50), v) ** 0.5), v)))

    return Solid(f"sphere {{ {vec(c)}, {text(r)} }}", [form], points, size=r)


def box_forms(lo, hi):
    forms = []
    for i in range(3):
        e = tuple(int(i == j) for j in range(3))
        forms += [halfspace(e, lo, -1), halfspace(e, hi, 1)]
    return forms


def box(rng):
    if rng.random() < 0.3:
        a, b = tuple(wild(rng) for _ in range(3)), tuple(wild(rng) for _ in range(3))
    else:
        u = unit(rng)
        a = centre(rng, u)
        b = tuple(x + u * rng.choice((-1, 1)) * rng.choice((1, 1, 2, 7, 64)) for x in a)
    lo, hi = tuple(map(min, a, b)), tuple(map(max, a, b))

    def points():
        part = lambda l, h: rng.choice((l, h, l + (h - l) * dyadic(rng)))
        yield tuple(rng.choice(e) for e in zip(lo, hi))
        yield rounded(part(l, h) for l, h in zip(lo, hi))

    return Solid(f"box {{ {vec(a)}, {vec(b)} }}", box_forms(lo, hi), points, size=max(sub(hi, lo)) / 2)


def tube(rng, word):
    """Cylinders and cones, capped or open."""
    closed = rng.random() < 0.6
    if rng.random() < 0.25:
        c0, c1 = tuple(wild(rng) for _ in range(3)), tuple(wild(rng) for _ in range(3))
        r0 = abs(wild(rng))
        r1 = r0 if word == "cylinder" else abs(wild(rng))
        m, u, v, j, w = 1, (1, 0, 0), (0, 1, 0), 1, (0, 0, 1)
    else:
        s = unit(rng)
        m, u, v, w = frame(rng)
        c0 = centre(rng, s)
        j = rng.choice((1, 2, 5, 16)) * s
        c1 = add(c0, times(j, w))
        r0 = m * s * rng.choice((1, 5, 13, 65))
        r1 = r0 if word == "cylinder" else rng.choice((0, r0, r0 / 2, m * s * 5, m * s * 65))
        if word == "cone" and rng.random() < 0.3:
            r0, r1 = r1, r0
        if r0 == r1 == 0:
            r0 = m * s
    axis = sub(c1, c0)
    wall = wall_form(c0, c1, r0, r1)
    caps = [halfspace(axis, c0, -1), halfspace(axis, c1, 1)]
    slanted = r0 != r1
    apex = add(c0, times(r0 / (r0 - r1), axis)) if slanted else None

    def points():
        p0, p1 = on_circle(rng, c0, m, u, v, F(r0)), on_circle(rng, c1, m, u, v, F(r1))
        yield rng.choice((p0, p1))
        yield rng.choice((c0, c1, add(c0, times(dyadic(rng), axis))))
        f = dyadic(rng)
        q = on_circle(rng, (0, 0, 0), m, u, v, F(1))
        # The same direction at both ends: a generator.
        yield rounded(add(add(c0, times(f, axis)), times(r0 + f * (r1 - r0), q)))
        if slanted:
            yield rounded(apex)

    side = on_circle(rng, (0, 0, 0), m, u, v, F(1))
    generator = add(axis, times(r1 - r0, side))
    radii = text(r0) if word == "cylinder" else ""
    head = f"{word} {{ {vec(c0)}, " + (f"{vec(c1)}, {radii}" if radii else f"{text(r0)}, {vec(c1)}, {text(r1)}")
    size = max(abs(x) for x in (*axis, r0, r1))
    if closed:
        return Solid(head + " }", [wall, *caps], points, [axis, generator, u, v, w], size)
    tip = apex if slanted and min(r0, r1) == 0 else None
    return Sheet(head + " open }", wall, caps, points, [axis, generator, u, v, w], size, tip)


def cylinder(rng):
    return tube(rng, "cylinder")


def cone(rng):
    return tube(rng, "cone")


def plane(rng):
    """n . x = h |n|, with a normal of rational length; or h = 0 and any normal."""
    m, n = rng.choice(UNITS)
    n = signed_permutation(rng, n)
    if rng.random() < 0.3:
        n, h, m = tuple(wild(rng) for _ in range(3)), F(0), 1
    else:
        n, h = times(F(2) ** rng.randint(-3, 3), n), rng.choice((0, 1, -1, 3, 1000)) * unit(rng)
        m = F(dot(n, n).numerator ** 0.5) / F(dot(n, n).denominator ** 0.5)
        assert m * m == dot(n, n)
    foot = times(h * m / dot(n, n), n)

    def points():
        yield rounded(foot)
        yield rounded(add(foot, cross(n, small(rng, 9))))

    return Solid(f"plane {{ {vec(n)}, {text(h)} }}", [Form.linear(n, -h * m)], points, [cross(n, small(rng))], max(abs(h), 1))


def disc(rng):
    s = unit(rng)
    m, u, v, w = frame(rng)
    c = centre(rng, s)
    r = m * s * rng.choice((1, 5, 13, 65))
    hole = rng.choice((0, 0, r / 2, r / 8, r * 63 / 64))
    n = times(F(2) ** rng.randint(-9, 9), w)
    if rng.random() < 0.2:
        n, c, r = tuple(wild(rng) for _ in range(3)), tuple(wild(rng) for _ in range(3)), abs(wild(rng))
        hole = rng.choice((F(0), F(float(r) * rng.random())))
    limits = [distance_form(c, r)]
    if hole:
        k = distance_form(c, hole).k
        limits.append(Form(*(-x for x in k)))

    def points():
        yield on_circle(rng, c, m, u, v, F(r))
        yield on_circle(rng, c, m, u, v, F(hole))
        yield rounded(add(c, times(r * dyadic(rng), small(rng, 1))))

    body = f"disc {{ {vec(c)}, {vec(n)}, {text(r)}" + (f", {text(hole)} }}" if hole else " }")
    return Sheet(body, halfspace(n, c), limits, points, [u, v, w, n], r)


def plane_grid(rng):
    """An exact affine plane: origin and two vectors of whole numbers times a unit."""
    s = unit(rng)
    while True:
        o, u, v = centre(rng, s), small(rng, 4), small(rng, 4)
        if cross(u, v) != (0, 0, 0):
            return o, times(s, u), times(s, v)


def corner_points(rng, corners, edges):
    def points():
        yield rng.choice(corners)
        a, b = rng.choice(edges)
        yield rounded(add(a, times(dyadic(rng), sub(b, a))))
        a, b, c = (rng.choice(corners) for _ in range(3))
        f = dyadic(rng)
        yield rounded(add(a, add(times(f, sub(b, a)), times((1 - f) * dyadic(rng), sub(c, a)))))

    return points


def spread(corners):
    return max(abs(x) for c in corners for x in sub(c, corners[0]))


def triangle(rng):
    while True:
        if rng.random() < 0.4:
            corners = [tuple(wild(rng) for _ in range(3)) for _ in range(3)]
        else:
            s, o = unit(rng), centre(rng, F(1))
            corners = [times(s, add(o, small(rng, rng.choice((1, 4, 60))))) for _ in range(3)]
        a, b, c = corners
        if cross(sub(b, a), sub(c, a)) != (0, 0, 0):
            break
    edges = [(a, b), (b, c), (c, a)]
    body = f"triangle {{ {vec(a)}, {vec(b)}, {vec(c)} }}"
    return Loops(body, [[corners]], corner_points(rng, corners, edges), [sub(q, p) for p, q in edges], spread(corners))


STAR = [(0, 9), (3, 3), (9, 3), (4, -1), (6, -8), (0, -4), (-6, -8), (-4, -1), (-9, 3), (-3, 3)]


def polygon(rng):
    o, u, v = plane_grid(rng)
    at = lambda p: add(o, add(times(p[0], u), times(p[1], v)))
    square = lambda r, x=0, y=0: [(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)]
    loops = rng.choice([
        [square(4)],
        [STAR],
        [square(8), square(3)],
        [square(8), square(4)[::-1], square(1)],
        [square(5), square(5, 4, 4)],
        [[(0, 0), (8, 0), (0, 8), (8, 8)]],
        [STAR, square(1), square(1, 0, -3)],
        [square(4), square(4, 8, 0)],
        [[(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)]],
        [[(0, 9), (5, -7), (-8, 3), (8, 3), (-5, -7)]],
    ])
    solid = [[at(p) for p in loop] for loop in loops]
    listed = [p for loop in solid for p in (*loop, loop[0])]
    edges = [e for loop in solid for e in zip(loop, loop[1:] + loop[:1])]
    body = f"polygon {{ {len(listed)}, " + ", ".join(map(vec, listed)) + " }"
    points = corner_points(rng, [p for loop in solid for p in loop], edges)
    return Loops(body, [solid], points, [u, v] + [sub(q, p) for p, q in edges[:6]], spread(listed), oriented=False)


def octahedron():
    corners = [(3, 0, 0), (-3, 0, 0), (0, 3, 0), (0, -3, 0), (0, 0, 3), (0, 0, -3)]
    faces = []
    for i, j, k in product((0, 1), (2, 3), (4, 5)):
        faces.append((i, j, k) if (i + j + k) % 2 == 0 else (i, k, j))
    return corners, faces


def cube():
    corners = [tuple(p) for p in product((-2, 2), repeat=3)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]


def fan(rng):
    """A closed double fan around two poles, with a vertex of high degree."""
    ring = [(5, 0), (4, 3), (0, 5), (-3, 4), (-5, 0), (-4, -3), (0, -5), (3, -4)]
    corners = [(x, y, rng.randint(-2, 2)) for x, y in ring] + [(0, 0, 6), (0, 0, -6)]
    n = len(ring)
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n), (j, i, n + 1)]
    return corners, faces


def terrain(rng):
    """An open sheet of triangles on a grid: shared edges in all directions."""
    n = 5
    corners = [(2 * x, rng.randint(-1, 1), 2 * z) for x in range(n) for z in range(n)]
    faces = []
    for x, z in product(range(n - 1), repeat=2):
        a, b, c, d = x * n + z, (x + 1) * n + z, (x + 1) * n + z + 1, x * n + z + 1
        faces += [(a, b, c), (a, c, d)] if rng.random() < 0.5 else [(a, b, d), (b, c, d)]
    return corners, faces


def mesh(rng):
    corners, faces = rng.choice((octahedron, cube, lambda: fan(rng), lambda: terrain(rng)))()
    s, o = unit(rng), centre(rng, F(1))
    corners = [times(s, add(o, c)) for c in corners]
    if rng.random() < 0.3:
        corners = [tuple(F(float(x) * (1 + rng.uniform(-0.1, 0.1))) for x in c) for c in corners]
    if rng.random() < 0.5:
        body = "mesh { " + " ".join("triangle { " + ", ".join(vec(corners[i]) for i in f) + " }" for f in faces) + " }"
    else:
        body = f"mesh2 {{ vertex_vectors {{ {len(corners)}, " + ", ".join(map(vec, corners)) + " } "
        body += f"face_indices {{ {len(faces)}, " + ", ".join(f"<{a}, {b}, {c}>" for a, b, c in faces) + " } }"
    edges = [(corners[f[i]], corners[f[i - 1]]) for f in faces for i in range(3)]
    outlines = [[[corners[i] for i in f]] for f in faces]
    ways = [sub(q, p) for p, q in edges[:8]]
    return Loops(body, outlines, corner_points(rng, corners, edges), ways, spread(corners), touches=True)


QUADRICS = {
    "ellipsoid": (1, 1, 1, -1), "one sheet": (1, 1, -1, -1), "two sheets": (1, 1, -1, 1), "cone": (1, 1, -1, 0),
    "cylinder": (1, 1, 0, -1), "hyperbolic cylinder": (1, -1, 0, -1), "pair of planes": (1, -1, 0, 0), "slab": (1, 0, 0, -1),
    "double plane": (1, 0, 0, 0), "imaginary": (1, 1, 1, 1), "line": (1, 1, 0, 0), "point": (1, 1, 1, 0),
}
PARABOLIC = {"paraboloid": (1, 1), "saddle": (1, -1), "parabolic cylinder": (1, 0), "linear": (0, 0)}


def quadric(rng):
    """Every kind by its coefficients, diagonal or sheared, both signs, through a point with whole coordinates."""
    linear, mixed = [F(0)] * 3, [F(0)] * 3
    style = rng.random()
    p = tuple(F(x) for x in small(rng, 6))
    if style < 0.45:
        a, b, c, k = rng.choice(list(QUADRICS.values()))
        squares = [F(a), F(b), F(c)]
        scale = rng.choice((1, 1, 4, 9, F(1, 4)))
        squares = [x * rng.choice((1, 1, 4, 9, F(1, 4))) for x in squares]
        constant = k * scale
    elif style < 0.75:
        a, b = rng.choice(list(PARABOLIC.values()))
        squares, constant = [F(a), F(b), F(0)], F(rng.choice((0, 0, 1, -3)))
        linear = [F(0), F(0), F(rng.choice((1, -1, 2, F(1, 2))))]
    else:
        squares, mixed = [F(rng.randint(-3, 3)) for _ in range(3)], [F(rng.randint(-3, 3)) for _ in range(3)]
        linear, constant = [F(rng.randint(-3, 3)) for _ in range(3)], F(rng.randint(-9, 9))
        if not any(squares + mixed + linear):
            squares[0] = F(1)
    if rng.random() < 0.3:
        squares, mixed, linear, constant = [-x for x in squares], [-x for x in mixed], [-x for x in linear], -constant
    if style > 0.9:
        squares, mixed, linear = ([F(float(x) * rng.uniform(0.5, 2)) for x in xs] for xs in (squares, mixed, linear))
        constant = F(float(constant))
    elif rng.random() < 0.4:
        # Through p exactly, whatever kind that makes.
        constant = -value(Form(*squares, *mixed, *linear, 0), p)
    if rng.random() < 0.4:
        order = rng.choice([(0, 1, 2), (1, 2, 0), (2, 0, 1)])
        squares, linear = [squares[i] for i in order], [linear[i] for i in order]
        # D E F stand for xy xz yz: the opposite axes are z y x.
        m = {2: mixed[0], 1: mixed[1], 0: mixed[2]}
        mixed = [m[order[2]], m[order[1]], m[order[0]]]
    form = Form(*squares, *mixed, *linear, constant)
    null = [d for d in product(range(-3, 4), repeat=3) if any(d) and value(Form(*squares, *mixed, 0, 0, 0, 0), d) == 0]

    def points():
        found = on_surface(rng, form)
        if found:
            yield found
        yield (F(0), F(0), F(0))
        yield tuple(F(x) for x in small(rng, 4))

    body = f"quadric {{ {vec(squares)}, {vec(mixed)}, {vec(linear)}, {text(constant)} }}"
    return Solid(body, [form], points, [rng.choice(null) for _ in range(3)] if null else [], 2)


def value(form, p):
    x, y, z = p
    a, b, c, d, e, f, g, h, i, j = form.k
    return a * x * x + b * y * y + c * z * z + d * x * y + e * x * z + f * y * z + g * x + h * y + i * z + j


def on_surface(rng, form):
    """A point on the surface, exact if luck will have it, else rounded."""
    from exact import roots

    for _ in range(20):
        o, d = tuple(F(rng.randint(-4, 4), rng.choice((1, 1, 2))) for _ in range(3)), small(rng, 2)
        ray = IDENTITY.ray(tuple(map(float, o)), tuple(map(float, d)))
        found = roots(form.along(ray))
        if found:
            return rounded(add(o, times(rng.choice(found)[0].rational(), d)))
    return None


# Named quadrics: a word, the squares' signs with the linear term's axis and the constant, and a point with parameters (cos, sin), k.
BRANCH = [(F(0), F(1)), (F(3, 4), F(5, 4)), (F(15, 8), F(17, 8)), (F(-3, 4), F(5, 4))]
NAMED = {
    "ellipsoid": ((1, 1, 1), None, -1, lambda c, s, k: (c, s, 0)),
    "spheroid": ((1, 1, 1), None, -1, lambda c, s, k: meridian(k, c, s)),
    "paraboloid": ((1, 1, 0), 2, 0, lambda c, s, k: (c * k, s * k, k * k)),
    "hyperbolic_paraboloid": ((1, -1, 0), 2, 0, lambda c, s, k: (k, 2 * k - 1, k * k - (2 * k - 1) ** 2)),
    "hyperboloid 1": ((1, 1, -1), None, -1, lambda c, s, k: (c - s * k, s + c * k, k)),
    "hyperboloid 2": ((1, 1, -1), None, 1, lambda c, s, k: (BRANCH[int(8 * k) % 4][0] * c, BRANCH[int(8 * k) % 4][0] * s, BRANCH[int(8 * k) % 4][1])),
    "elliptic_cone": ((1, 1, -1), None, 0, lambda c, s, k: (c * k, s * k, k)),
    "circular_cone": ((1, 1, -1), None, 0, lambda c, s, k: (c * k, s * k, k)),
    "elliptic_cylinder": ((1, 1, 0), None, -1, lambda c, s, k: (c, s, k)),
    "circular_cylinder": ((1, 1, 0), None, -1, lambda c, s, k: (c, s, k)),
    "hyperbolic_cylinder": ((1, -1, 0), None, -1, lambda c, s, k: (BRANCH[int(8 * k) % 4][1], BRANCH[int(8 * k) % 4][0], k)),
    "parabolic_cylinder": ((1, 0, 0), 1, 0, lambda c, s, k: (k, k * k, s)),
}


def meridian(k, c, s):
    return (c, 0, s) if k < F(1, 2) else (0, 0, 1)


def named(rng):
    """The quadrics that durer's own words name, whole or between two planes, capped or open."""
    word, (signs, linear, constant, point) = rng.choice(list(NAMED.items()))
    u = unit(rng)
    axes = [u * rng.choice((65, 65, 130, 5, 1, 2, F(1, 2))) for _ in range(3)]
    round_ = word in ("spheroid", "circular_cone", "circular_cylinder")
    flat = word.endswith("_cylinder")
    if round_:
        axes[1] = axes[0]
    if flat:
        axes[2] = F(1)
    squares = [F(s) / (a * a) for s, a in zip(signs, axes)]
    slopes = [-1 / axes[i] if i == linear else F(0) for i in range(3)]
    form = Form(*squares, 0, 0, 0, *slopes, constant)
    name, *sheets = word.split()
    numbers = text(axes[0]) + ("" if flat else f", {text(axes[2])}") if round_ else vec(axes[:2] if flat else axes)
    body = f"{name} {{ {numbers}" + (f", sheets {sheets[0]}" if sheets else "")
    extent = None
    if rng.random() < 0.7:
        extent = sorted(rng.sample([axes[2] * F(n, 4) for n in (-17, -8, -5, -4, -1, 0, 1, 2, 4, 5, 6, 17)], 2))
        body += f", from {text(extent[0])} to {text(extent[1])}"
    scaled = lambda p: tuple(a * x for a, x in zip(axes, p))
    levels = [e / axes[2] for e in extent] if extent else [F(0), F(1)]

    def points():
        m, c, s = rng.choice(TURNS)
        k = rng.choice((*levels, dyadic(rng)))
        yield scaled(point(F(c, m), F(s, m), k))
        p = scaled(point(F(-s, m), F(c, m), rng.choice((*levels, dyadic(rng)))))
        yield p if not extent else rng.choice((p, (p[0], p[1], rng.choice(extent))))
        yield (F(0), F(0), rng.choice((*(extent or ()), F(0))))
        yield rounded(scaled(small(rng, 2)))

    ways = [(0, 0, 1), scaled((1, 0, 1)), scaled((0, 1, -1)), scaled((1, 1, 0)), sub(scaled(point(F(3, 5), F(4, 5), F(1))), scaled(point(F(3, 5), F(4, 5), F(0))))]
    ways = [w for w in ways if any(w)]
    caps = [Form.linear((0, 0, -1), extent[0]), Form.linear((0, 0, 1), -extent[1])] if extent else []
    size = max(axes)
    if extent and rng.random() < 0.3:
        tip = (0, 0, 0) if "cone" in word and extent[0] * extent[1] >= 0 else None
        return Sheet(body + " open }", form, caps, points, ways, size, tip)
    return Solid(body + " }", [form, *caps], points, ways, size)


# ---- modifiers, placements, whole scenes ----


def clip(rng, leaf):
    """Clips by a convex solid whose faces run through points of the surface."""
    points = [rounded(p) for _ in range(4) for p in leaf.points()]
    a, b = rng.choice(points), rng.choice(points)
    kind = rng.choice(("box", "box", "plane", "sphere"))
    if kind == "box" and all(x != y for x, y in zip(a, b)):
        lo, hi = tuple(map(min, a, b)), tuple(map(max, a, b))
        leaf.clip, leaf.clip_text = box_forms(lo, hi), f"box {{ {vec(a)}, {vec(b)} }}"
    elif kind == "sphere":
        r = rng.choice((1, 3, 7, 9)) * leaf.size
        m, v = rng.choice(UNITS)
        c = rounded(add(a, times(r / m, signed_permutation(rng, v))))
        leaf.clip, leaf.clip_text = [distance_form(c, F(float(r)))], f"sphere {{ {vec(c)}, {text(F(float(r)))} }}"
    else:
        i, s = rng.randrange(3), rng.choice((-1, 1))
        n = tuple(s * int(i == j) for j in range(3))
        leaf.clip, leaf.clip_text = [halfspace(n, a)], f"plane {{ {vec(n)}, {text(s * a[i])} }}"


def placement(rng):
    """Maps of all kinds: rigid, mirrored, scaled, sheared, ill-conditioned, any f64."""
    style = rng.choice(("none", "none", "whole", "turned", "mirrored", "shear", "stretched", "any", "words"))
    c = tuple(F(rng.choice((0, 1, -7, 1000)) * rng.choice((1, F(1, 8)))) for _ in range(3))
    if style == "none":
        return IDENTITY
    if style == "words":
        s, t = [F(rng.choice((1, 2, 0.5, -1, 3))) for _ in range(3)], c
        return Map(((s[0], 0, 0), (0, s[1], 0), (0, 0, s[2])), t, words=f"scale {vec(s)} translate {vec(t)}")
    if style == "turned":
        m, u, v, w = frame(rng)
        return Map((u, v, w), c)
    if style == "mirrored":
        rows = [signed_permutation(rng, (1, 0, 0))]
        i = [abs(x) for x in rows[0]].index(1)
        a, b = [j for j in range(3) if j != i]
        e = lambda j, s: tuple(s if j == k else 0 for k in range(3))
        return Map((rows[0], e(b, rng.choice((-1, 1))), e(a, rng.choice((-1, 1)))), c)
    if style == "shear":
        k = rng.choice((1, 3, 64, 500))
        return Map(((1, k, 0), (0, 1, rng.choice((0, k))), (0, 0, 1)), c)
    if style == "stretched":
        return Map([tuple(F(2) ** rng.randint(-10, 9) if i == j else 0 for j in range(3)) for i in range(3)], c)
    while True:
        draw = (lambda: F(rng.randint(-3, 3))) if style == "whole" else (lambda: F(rng.uniform(-1, 1)))
        rows = [tuple(draw() for _ in range(3)) for _ in range(3)]
        det = dot(rows[0], cross(rows[1], rows[2]))
        if abs(det) >= (1 if style == "whole" else F(1, 1000)):
            return Map(rows, c)


MAKERS = {
    "sphere": sphere, "box": box, "cylinder": cylinder, "cone": cone, "plane": plane, "disc": disc, "triangle": triangle,
    "polygon": polygon, "mesh": mesh, "quadric": quadric, "named": named, "torus": torus, "polynomial": polynomial,
    "cyclide": cyclide,
}
# Examined unless kinds are named, and what unions are made of.
USUAL = list(MAKERS)
UNITED = [k for k in MAKERS if k != "plane"]
# Put together from pieces, or rounded: slower to examine.
MAKERS |= {
    "sor": sor, "ovus": ovus, "lemon": lemon, "prism": prism, "curved prism": curved_prism,
    "superellipsoid": superellipsoid, "blob": blob, "julia": julia, "isosurface": isosurface, "lathe": lathe, "sphere sweep": sphere_sweep,
    "height field": height_field, "terrain": terrain_sheet, "ifs": ifs,
    "bilinear": bilinear, "patch": patch, "nurbs": nurbs, "trimmed": trimmed, "parametric": parametric, "curved patch": curved_patch, "sweep": straight_sweep,
}


class Scene:
    """The text, and for each object its leaves in order, each with its whole map."""

    def __init__(self, words, objects, kind):
        self.words, self.objects, self.kind = words, objects, kind


DECOYS = "camera { location <0, 0, -9> look_at 0 }\nlight_source { <9, 9, -9>, rgb 1 }\n#declare Unused = sphere { 0, 1 }\n"


def leaf_of(rng, kind, clips=True):
    leaf = MAKERS[kind](rng)
    # Where a clip's border is next to a rounded crossing is not decided; a tangled prism's caps have no side once they are clipped.
    plain = getattr(leaf, "certain", True) and getattr(leaf, "exact_ends", True) and kind not in ("prism", "curved prism", "sweep")
    if clips and plain and rng.random() < 0.2:
        clip(rng, leaf)
    elif isinstance(leaf, (Solid, ZeroSet, Region, Copies)) and rng.random() < 0.12:
        leaf.inverse = True
    leaf.map = placement(rng)
    while not leaf.accepts(leaf.map):
        leaf.map = placement(rng)
    return leaf


def single(rng, kind):
    leaf = leaf_of(rng, kind)
    leaf.whole = leaf.map
    decoys = DECOYS if rng.random() < 0.3 else ""
    return Scene(decoys + leaf.sdl() + "\n", [[leaf]], kind)


def union_scene(rng):
    """Some objects, some of them unions (nested, placed as a whole)."""
    objects, words = [], []
    for _ in range(rng.randint(1, 3)):
        leaves = []
        parts = []
        for _ in range(rng.randint(1, 3)):
            leaf = leaf_of(rng, rng.choice(UNITED), clips=False)
            leaf.inverse = False
            leaves.append(leaf)
            parts.append(leaf)
        if len(parts) == 1:
            parts[0].whole = parts[0].map
            words.append(parts[0].sdl())
        else:
            inner = Map(((1, 0, 0), (0, 1, 0), (0, 0, 1)), tuple(rng.randint(-9, 9) for _ in range(3)))
            outer = rng.choice((IDENTITY, Map(((0, 2, 0), (-2, 0, 0), (0, 0, 2)), (1, 2, 3))))
            nested = rng.random() < 0.4 and len(parts) == 3
            for i, leaf in enumerate(parts):
                leaf.whole = outer.after(inner.after(leaf.map) if nested and i > 0 else leaf.map)
            inside = [p.sdl() for p in parts]
            if nested:
                inside = [inside[0], "union { " + " ".join(inside[1:]) + " " + inner.sdl() + " }"]
            words.append("union {\n  " + "\n  ".join(inside) + "\n  " + outer.sdl() + "\n}")
        objects.append(leaves)
    return Scene("\n".join(words) + "\n", objects, "union")
