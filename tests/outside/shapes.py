"""Shapes as a scene file writes them, and as exact sets.

A `Leaf` is one primitive under one affine map: `{ c + L x : x in S }` with the numbers of the text. It knows its crossings with a ray, as exact
numbers, and points of interest (rims, apexes, vertices ...) at which rays can be aimed.

Three kinds: a *solid* is cut from space by quadrics and half-spaces, `{ x : f_i(x) <= 0 for all i }`, closed; a *sheet* is the part of one
such face where others are `<= 0`; *loops* are flat outlines (triangle, polygon) whose edges belong to one side by the tie rule: where
the ray meets an edge exactly, its origin is moved by `eps` along the first and `eps^2` along the second of the axes other than the
first on which |direction| is largest.
"""

from fractions import Fraction as F
from functools import cmp_to_key, reduce
from itertools import permutations, product
from math import gcd, lcm

from exact import LINE, Number, below, complement, intersect, meets, roots, sign, sign_at, slope_at


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(s, a):
    return (s * a[0], s * a[1], s * a[2])


def text(x):
    """A number as the scene writes it: its own f64, so that nothing is lost."""
    f = float(x)
    assert F(f) == x, "the scene would be rounded"
    return repr(f)


def vec(v):
    return "<" + ", ".join(text(x) for x in v) + ">"


class Form:
    """A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J."""

    def __init__(self, *coefficients):
        self.k = tuple(F(c) for c in coefficients)
        common = reduce(lcm, (c.denominator for c in self.k))
        self.ints = tuple(int(c * common) for c in self.k)

    @staticmethod
    def linear(normal, constant):
        return Form(0, 0, 0, 0, 0, 0, *normal, constant)

    @staticmethod
    def product_sum(terms, constant=0):
        """The sum of w (u.x + a)(v.x + b) over terms (w, u, a, v, b), plus a constant."""
        k = [F(0)] * 10
        for w, u, a, v, b in terms:
            for i in range(3):
                k[i] += w * u[i] * v[i]
                k[6 + i] += w * (u[i] * b + a * v[i])
            for slot, (i, j) in ((3, (0, 1)), (4, (0, 2)), (5, (1, 2))):
                k[slot] += w * (u[i] * v[j] + u[j] * v[i])
            k[9] += w * a * b
        k[9] += constant
        return Form(*k)

    def along(self, ray):
        """The polynomial along a local ray (x, d, w): positions are (x + t d) / w."""
        (x, y, z), (u, v, w), h = ray
        a, b, c, d, e, f, g, i, j, k = self.ints
        c2 = a * u * u + b * v * v + c * w * w + d * u * v + e * u * w + f * v * w
        c1 = 2 * (a * x * u + b * y * v + c * z * w) + d * (x * v + y * u) + e * (x * w + z * u) + f * (y * w + z * v)
        c1 += h * (g * u + i * v + j * w)
        c0 = a * x * x + b * y * y + c * z * z + d * x * y + e * x * z + f * y * z + h * (g * x + i * y + j * z) + h * h * k
        return (c0, c1, c2)

    def gradient(self, p):
        a, b, c, d, e, f, g, h, i, _ = self.k
        x, y, z = p
        return (2 * a * x + d * y + e * z + g, 2 * b * y + d * x + f * z + h, 2 * c * z + e * x + f * y + i)

    def bend(self, _):
        """The size of the second derivatives."""
        return max(map(abs, self.k[:6]))


class Map:
    """x -> L x + c, exact."""

    def __init__(self, rows=None, c=(0, 0, 0), words=None):
        self.rows = tuple(tuple(F(x) for x in r) for r in (rows or ((1, 0, 0), (0, 1, 0), (0, 0, 1))))
        self.c = tuple(F(x) for x in c)
        self.words = words
        (a, b, d) = self.rows
        det = dot(a, cross(b, d))
        assert det != 0, "singular"
        self.det = det
        columns = [times(1 / det, v) for v in (cross(b, d), cross(d, a), cross(a, b))]
        inverse = tuple(tuple(columns[j][i] for j in range(3)) for i in range(3))
        # The inverse as whole numbers over one positive whole number.
        self.w = reduce(lcm, (x.denominator for r in inverse for x in r))
        self.n = tuple(tuple(int(x * self.w) for x in r) for r in inverse)
        self.c_part = reduce(lcm, (x.denominator for x in self.c))

    def point(self, p):
        return add(self.vector(p), self.c)

    def vector(self, v):
        return tuple(dot(r, v) for r in self.rows)

    def after(self, inner):
        """This map applied after another."""
        columns = list(zip(*inner.rows))
        rows = tuple(tuple(dot(r, c) for c in columns) for r in self.rows)
        return Map(rows, self.point(inner.c))

    def ray(self, o, d):
        """The ray of floats o, d in the frame before the map: whole numbers (x, d, w)."""
        part = reduce(lcm, (f.as_integer_ratio()[1] for f in (*o, *d)), self.c_part)
        whole = lambda x: int(F(x) * part)
        x = sub(tuple(map(whole, o)), tuple(map(whole, self.c)))
        v = tuple(map(whole, d))
        return tuple(dot(r, x) for r in self.n), tuple(dot(r, v) for r in self.n), self.w * part

    def normal(self, n):
        """A covector (the gradient of a function) after the map, up to a positive factor."""
        return tuple(dot(c, n) for c in zip(*self.n))

    def sdl(self):
        if self.words is not None:
            return self.words
        columns = zip(*self.rows)
        numbers = [x for column in columns for x in column] + list(self.c)
        return "matrix <" + ", ".join(text(x) for x in numbers) + ">"


IDENTITY = Map(words="")


class Event:
    """One crossing: where, -1 entering / +1 leaving / 0 touching, and the normals it may have (functions of the point, outward). An optional one may be told or not; or, if it is needed, as a touch or in a cluster."""

    __slots__ = ("t", "sign", "any_sign", "normals", "leaf", "face", "optional", "needed", "faces", "branches")

    def __init__(self, t, sgn, normals, leaf, face=0, any_sign=False, optional=False):
        self.t, self.sign, self.normals, self.leaf, self.face, self.any_sign, self.optional = t, sgn, normals, leaf, face, any_sign, optional
        self.needed = False
        # The faces of which any may report it, if there are several.
        self.faces = None
        # How many branches of a profile meet there.
        self.branches = 1

    def __repr__(self):
        return f"(t={float(self.t)!r} sign={self.sign})"


class Answer:
    """All crossings on the whole line; the set inside; whether the line runs within the surface, where the rules leave freedom."""

    def __init__(self, events, inside=None, within=False):
        self.events, self.inside, self.within = events, inside, within


class Leaf:
    """One primitive. `points` makes exact local points of interest, `directions` special directions."""

    def __init__(self, body, points, directions=(), size=F(1)):
        self.body, self.points, self.directions, self.size = body, points, list(directions), F(size)
        self.map, self.clip, self.clip_text, self.inverse = IDENTITY, [], "", False
        self.faces = 1

    def accepts(self, m):
        """Whether the leaf may be placed by this map."""
        return True

    def sdl(self, with_map=True):
        words = [self.body]
        if self.clip_text:
            words.append(f"clipped_by {{ {self.clip_text} }}")
        if self.inverse:
            words.append("inverse")
        if self.map.sdl():
            words.append(self.map.sdl())
        head, rest = words[0], words[1:]
        return head[:-1] + " ".join([""] + rest) + " }"

    def solid(self):
        return False

    def clipped(self, events, ray):
        if not self.clip:
            return events
        forms = [f.along(ray) for f in self.clip]
        return [e for e in events if all(sign_at(f, e.t) <= 0 for f in forms)]


class Solid(Leaf):
    def __init__(self, body, forms, points, directions=(), size=1):
        super().__init__(body, points, directions, size)
        self.forms = forms

    def solid(self):
        return not self.clip

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        polys = [f.along(ray) for f in self.forms]
        inside = reduce(intersect, (below(p) for p in polys), LINE)
        within = any(p == (0, 0, 0) for p in polys)
        flip = -1 if self.inverse else 1
        events, last = [], None

        def push(t, s):
            normals = [(f, flip) for f, p in zip(self.forms, polys) if sign_at(p, t) == 0]
            events.append(Event(t, flip * s, normals, self))

        for lo, hi in inside:
            if meets(lo, hi) == 0:
                push(lo, 0)
                continue
            if lo is not None:
                if last is not None and last.cmp(lo) == 0:
                    events.pop()
                    push(lo, 0)
                else:
                    push(lo, -1)
            if hi is not None:
                push(hi, 1)
            last = hi
        # Touched from within by more than one face at a time: still one touch.
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, ray), inside, within)


class Sheet(Leaf):
    """The part of the surface face = 0 where all limits are <= 0."""

    def __init__(self, body, face, limits, points, directions=(), size=1, apex=None):
        super().__init__(body, points, directions, size)
        self.face, self.limits, self.apex = face, limits, apex

    def answer(self, o, d, m):
        ray = m.ray(o, d)
        poly = self.face.along(ray)
        limits = [f.along(ray) for f in self.limits]
        found = roots(poly)
        if found is None:
            return Answer([], None, True)
        events = []
        for t, times_ in found:
            if all(sign_at(p, t) <= 0 for p in limits):
                s = slope_at(poly, t) if times_ == 1 else 0
                # Through the apex of a single nappe: a touch of the form, and a passage into the nappe.
                apex = times_ == 2 and self.apex is not None and sign(poly[2]) < 0
                events.append(Event(t, s, [(self.face, 1)], self, any_sign=apex))
        return Answer(self.clipped(events, ray), None, False)


class Loops(Leaf):
    """Flat outlines by the even-odd rule; a mesh is one leaf with many faces of one loop each."""

    def __init__(self, body, faces, points, directions=(), size=1, oriented=True, touches=False):
        super().__init__(body, points, directions, size)
        self.touches = touches
        # Each face: (plane normal, list of loops of whole-number vertices over 2^bits).
        vertices = [x for loops in faces for loop in loops for v in loop for x in v]
        self.bits = max(F(x).denominator for x in vertices).bit_length() - 1
        whole = lambda v: tuple(int(F(x) * (1 << self.bits)) for x in v)
        self.outlines = [[[whole(v) for v in loop] for loop in loops] for loops in faces]
        self.planes = [face_normal(loops[0]) for loops in self.outlines]
        self.faces = len(faces)
        self.oriented = oriented

    def with_faces(self, faces):
        return Loops(self.body, faces, self.points, size=self.size, oriented=self.oriented, touches=self.touches)

    def axes(self, o, d, m):
        """The axes that a rounded direction in the leaf's frame may have as its largest."""
        v = m.ray(o, d)[1]
        top = max(map(abs, v))
        return [i for i in range(3) if (top - abs(v[i])) << 40 <= top]

    def answer(self, o, d, m, k=None):
        ray = m.ray(o, d)
        x, v, w = ray
        if k is None:
            k = max(range(3), key=lambda i: (abs(v[i]), -i))
        a, b = [i for i in range(3) if i != k]
        s = sign(v[k])
        events = []
        shift = times(1 << self.bits, x)
        for number, (loops, n) in enumerate(zip(self.outlines, self.planes)):
            slope = dot(n, v)
            if slope == 0:
                continue
            odd = False
            for loop in loops:
                # Vertices projected along the ray, positive multiples of their coordinates.
                flat = []
                for p in loop:
                    q = sub(times(w, p), shift)
                    flat.append((s * (q[a] * v[k] - q[k] * v[a]), s * (q[b] * v[k] - q[k] * v[b])))
                odd ^= encloses(flat)
            if odd:
                p = sub(times(w, loops[0][0]), shift)
                t = Number(dot(n, p), 0, 0, slope << self.bits)
                events.append(Event(t, sign(slope), [(n, 1)], self, face=number))
        if self.touches:
            events = self.with_touches(events, ray)
        events = self.clipped(events, ray)
        events.sort(key=lambda e: (e.t.rational(), e.face))
        return Answer(events)

    def with_touches(self, events, ray):
        """The crossings of a mesh, where one touch stands for what a line has in common with it but parallel lines as near as one likes have not."""
        x, v, w = ray
        k = max(range(3), key=lambda i: (abs(v[i]), -i))
        a, b = [i for i in range(3) if i != k]
        square = dot(v, v) << self.bits
        met = []
        for number, ((loop,), n) in enumerate(zip(self.outlines, self.planes)):
            seen = [sub(times(w, p), times(1 << self.bits, x)) for p in loop]
            flat = [(q[a] * v[k] - q[k] * v[a], q[b] * v[k] - q[k] * v[b]) for q in seen]
            t = common_places(flat, [F(dot(q, v), square) for q in seen])
            if t:
                met.append((*t, number, flat))
        met.sort()
        pieces = []
        for first, last, number, flat in met:
            if pieces and first <= pieces[-1][1]:
                pieces[-1][1] = max(last, pieces[-1][1])
            else:
                pieces.append([first, last, []])
            pieces[-1][2].append((number, flat))
        for first, last, faces in pieces:
            if covers_all_around([flat for _, flat in faces]):
                continue
            events = [e for e in events if not first <= e.t.rational() <= last]
            touch = Event(Number(first.numerator, 0, 0, first.denominator), 0, [(self.planes[number], 1) for number, _ in faces], self, face=faces[0][0])
            touch.faces = {number for number, _ in faces}
            events.append(touch)
        return events


def turn(p, q):
    return p[0] * q[1] - p[1] * q[0]


def common_places(flat, depths):
    """Where the line through the origin along which a triangle was projected has points in common with it: the first and the last depth, or None."""
    area = turn(sub2(flat[1], flat[0]), sub2(flat[2], flat[0]))
    sides = [turn(flat[i - 1], flat[i]) for i in range(3)]
    if area:
        if any(side * area < 0 for side in sides):
            return None
        # Each corner counts by the area beyond the opposite edge.
        at = sum(F(sides[(i + 2) % 3], area) * depths[i] for i in range(3))
        return at, at
    if any(sides):
        return None
    along = max(flat, key=lambda p: abs(p[0]) + abs(p[1]))
    c = [p[0] * along[0] + p[1] * along[1] for p in flat]
    places = [depth for depth, at in zip(depths, c) if at == 0]
    for i in range(3):
        p, q = c[i - 1], c[i]
        if p * q < 0:
            places.append((depths[i - 1] * q - depths[i] * p) / (q - p))
    return (min(places), max(places)) if places else None


def sub2(p, q):
    return p[0] - q[0], p[1] - q[1]


def covers_all_around(triangles):
    """Whether plane triangles that hold the origin cover all points near it."""
    def positive(flat):
        area = turn(sub2(flat[1], flat[0]), sub2(flat[2], flat[0]))
        return flat if area > 0 else flat[::-1] if area < 0 else None

    faces = [flat for flat in map(positive, triangles) if flat]
    if not faces:
        return False
    ways = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    for flat in faces:
        for i in range(3):
            x, y = sub2(flat[i], flat[i - 1])
            ways += [(x, y), (-x, -y)]
    half = lambda p: p[1] < 0 or p[1] == 0 and p[0] < 0
    ways.sort(key=cmp_to_key(lambda p, q: half(p) - half(q) or -sign(turn(p, q))))
    # Directions in between: no edge lies along one.
    between = [(p[0] + q[0], p[1] + q[1]) for p, q in zip(ways, ways[1:] + ways[:1]) if turn(p, q)]

    def holds(flat, way):
        sides = ((turn(flat[i - 1], flat[i]), sub2(flat[i], flat[i - 1])) for i in range(3))
        return all(side > 0 or side == 0 and turn(edge, way) > 0 for side, edge in sides)

    return all(any(holds(flat, way) for flat in faces) for way in between)


def face_normal(loop):
    for i in range(2, len(loop)):
        n = cross(sub(loop[i - 1], loop[0]), sub(loop[i], loop[0]))
        if n != (0, 0, 0):
            g = reduce(gcd, n)
            return tuple(x // g for x in n)
    raise AssertionError("no area")


def encloses(loop):
    """Whether the point (eps, eps^2) is within a plane outline, eps positive and smaller than any number: even-odd."""
    odd = False
    for (ax, ay), (bx, by) in zip(loop, loop[1:] + loop[:1]):
        if (ay > 0) != (by > 0):
            # Where the edge is at height 0, times (by - ay); at 0 exactly eps lies beyond it.
            at = ax * by - bx * ay
            odd ^= (at > 0) if by > ay else (at < 0)
    return odd


# ---- building blocks for the generators of scenes ----

UNITS = [(1, (1, 0, 0)), (3, (1, 2, 2)), (5, (0, 3, 4)), (7, (2, 3, 6)), (9, (1, 4, 8)), (9, (4, 4, 7)), (15, (2, 5, 14)), (15, (2, 10, 11))]
FRAMES = [
    (1, (1, 0, 0), (0, 1, 0), (0, 0, 1)),
    (3, (1, 2, 2), (2, 1, -2), (2, -2, 1)),
    (5, (3, 4, 0), (-4, 3, 0), (0, 0, 5)),
    (7, (2, 3, 6), (3, -6, 2), (6, 2, -3)),
    (9, (1, 4, 8), (4, 7, -4), (8, -4, 1)),
]
TURNS = [(1, 1, 0), (1, 0, 1), (5, 3, 4), (5, 4, 3), (13, 5, 12), (13, 12, 5)]


def signed_permutation(rng, v):
    return tuple(rng.choice((-1, 1)) * x for x in rng.choice(list(permutations(v))))


def small(rng, n=3):
    while True:
        v = tuple(rng.randint(-n, n) for _ in range(3))
        if v != (0, 0, 0):
            return v


def frame(rng):
    """(m, u, v, w): whole vectors of length m, at right angles."""
    m, *axes = rng.choice(FRAMES)
    order = rng.choice(list(permutations(range(3))))
    axes = [axes[i] for i in order]
    turn = rng.choice(list(permutations(range(3))))
    axes = [tuple(a[i] for i in turn) for a in axes]
    return (m, *[times(rng.choice((-1, 1)), a) for a in axes])


def on_circle(rng, centre, m, u, v, r):
    """A point with exact coordinates at distance r from the centre, in the plane of u, v (of length m)."""
    g, c, s = rng.choice([t for t in TURNS if r * t[1] % (t[0] * m) == 0 and r * t[2] % (t[0] * m) == 0] or TURNS[:2])
    c, s = rng.choice((-1, 1)) * F(r * c, g * m), rng.choice((-1, 1)) * F(r * s, g * m)
    return add(centre, add(times(c, u), times(s, v)))


def dyadic(rng, bits=4):
    return F(rng.randint(0, 1 << bits), 1 << bits)


def distance_form(centre, radius):
    eye = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    return Form.product_sum([(1, e, -c, e, -c) for e, c in zip(eye, centre)], -F(radius) ** 2)


def halfspace(normal, point, side=1):
    """side * normal . (x - point) <= 0."""
    return Form.linear(times(side, normal), -side * dot(normal, point))


def wall_form(c0, c1, r0, r1):
    """|(x - c0) x a|^2 |a|^2 - (r0 |a|^2 + (r1 - r0) (x - c0).a)^2 with a = c1 - c0."""
    a = sub(c1, c0)
    aa = dot(a, a)
    terms = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        u = [0, 0, 0]
        u[j], u[k] = a[k], -a[j]
        shift = -dot(u, c0)
        terms.append((aa, u, shift, u, shift))
    h = times(r1 - r0, a)
    constant = r0 * aa - dot(h, c0)
    terms.append((-1, h, constant, h, constant))
    return Form.product_sum(terms)


def all_signs(v):
    return [tuple(a * b for a, b in zip(v, s)) for s in product((-1, 1), repeat=3)]
