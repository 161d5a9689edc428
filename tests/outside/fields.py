"""Sheets of triangles over the unit square (height fields, terrain), and iterated function systems.

A sheet is made of the same flat faces as a mesh, with one rule for edges. An iterated function system is the union of finitely many boxes, balls or tetrahedra: closed sets on the line, put
together exactly.
"""

from fractions import Fraction as F
from itertools import product

from exact import complement, holds, meets, sign_at, union
from shapes import Answer, Event, Form, Leaf, Loops, Map, Solid, add, cross, distance_form, dot, halfspace, sub, text, times, vec
from zero_sets import near


# ---- sheets ----


class FieldSheet(Loops):
    """All that is not below the water level."""

    water = None

    def __init__(self, *args, **words):
        super().__init__(*args, **words)
        # All triangles are one primitive.
        self.faces = 1

    def answer(self, o, d, m, k=None):
        found = super().answer(o, d, m, k)
        for e in found.events:
            e.face = 0
        return found

    def clipped(self, events, ray):
        events = super().clipped(events, ray)
        if self.water is None:
            return events
        below = Form.linear((0, -1, 0), self.water).along(ray)
        return [e for e in events if sign_at(below, e.t) <= 0]


def sheet(rng, body, heights, water):
    """`heights[j][i]` are those at `x = i / columns`, `z = j / rows`."""
    rows, columns = len(heights) - 1, len(heights[0]) - 1
    at = lambda i, j: (F(i / columns), heights[j][i], F(j / rows))
    faces, edges = [], []
    for j, i in product(range(rows), range(columns)):
        a, b, c, d = at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)
        faces += [[[a, c, b]], [[d, b, c]]]
        edges += [(a, b), (a, c), (b, c)]
    corners = [at(i, j) for j in range(rows + 1) for i in range(columns + 1)]

    def points():
        yield rng.choice(corners)
        for _ in range(2):
            a, b = rng.choice(edges)
            yield near(add(a, times(F(rng.randint(0, 8), 8), sub(b, a))))
        ((a, b, c),) = rng.choice(faces)
        s, t = sorted((F(rng.random()), F(rng.random())))
        yield near(add(a, add(times(s, sub(b, a)), times(t - s, sub(c, a)))))
        if water is not None:
            a, b = rng.choice(edges)
            if a[1] != b[1]:
                yield near(add(a, times((water - a[1]) / (b[1] - a[1]), sub(b, a))))

    ways = [(0, -1, 0), (1, 0, 0), (0, 0, 1), (1, 0, -1)] + [sub(q, p) for p, q in rng.sample(edges, min(6, len(edges)))]
    leaf = FieldSheet(body, faces, points, ways, max(1, *(abs(p[1]) for p in corners)))
    leaf.water = water
    return leaf


def with_water(rng, heights, words):
    """Words for a water level, sometimes exactly at a vertex, and the level; none above all heights."""
    if rng.random() < 0.6:
        return words, None
    every = sorted({h for row in heights for h in row})
    water = rng.choice((every[0], every[len(every) // 2], (every[0] + every[-1]) / 2))
    water = F(float(water))
    return f"{words} water_level {text(water)}", water


def height_field(rng):
    if rng.random() < 0.5:
        columns, rows = rng.randint(2, 7), rng.randint(2, 7)
        deep = rng.random() < 0.5
        most = 65535 if deep else 255
        picture = [[rng.choice((0, most, rng.randint(0, most), most // 2)) for _ in range(columns)] for _ in range(rows)]
        if rng.random() < 0.2:
            picture = [[most // 2] * columns for _ in range(rows)]
        data = b"".join(v.to_bytes(2 if deep else 1, "big") for row in picture for v in row)
        file = f"P5\n{columns} {rows}\n{most}\n".encode() + data
        heights = [[F(v if deep else v * 257, 65536) for v in row] for row in reversed(picture)]
        words = 'height_field { pgm "heights.pgm"'
    else:
        columns, rows = (rng.choice((2, 3, 5, 9)) for _ in range(2))
        a, b, c = (F(rng.randint(0, 8), 32) for _ in range(3))
        heights = [[a + b * F(i, columns - 1) + c * F(rows - 1 - j, rows - 1) ** 2 for i in range(columns)] for j in range(rows)]
        words = f"height_field {{ function {columns}, {rows} {{ {text(a)} + {text(b)} * x + {text(c)} * y * y }}"
        file = None
    words, water = with_water(rng, heights, words)
    leaf = sheet(rng, words + rng.choice(("", " smooth", " hierarchy off")) + " }", heights, water)
    if file:
        leaf.files = {"heights.pgm": file}
    return leaf


MASK = (1 << 64) - 1


def mix(z):
    """The output function of splitmix64."""
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 & MASK
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB & MASK
    return z ^ (z >> 31)


def terrain_heights(levels, roughness, amplitude, seed, corners):
    n = 1 << levels
    h = {(0, 0): corners[0], (n, 0): corners[1], (0, n): corners[2], (n, n): corners[3]}
    for level in range(1, levels + 1):
        s = 1 << (levels - level)
        reach = amplitude * 2.0 ** (-roughness * (level - 1))

        def new(i, j, a, b):
            place = (seed * 0x9E3779B97F4A7C15 + i * 0xBF58476D1CE4E5B9 + j * 0x94D049BB133111EB) & MASK
            h[i, j] = (h[a] + h[b]) / 2.0 + reach * (2.0 * ((mix(place) >> 11) * 2.0**-53) - 1.0)

        for j in range(0, n + 1, s):
            for i in range(0, n + 1, s):
                odd = (i // s % 2, j // s % 2)
                if odd == (1, 0):
                    new(i, j, (i - s, j), (i + s, j))
                elif odd == (0, 1):
                    new(i, j, (i, j - s), (i, j + s))
                elif odd == (1, 1):
                    new(i, j, (i + s, j - s), (i - s, j + s))
    return [[F(h[i, j]) for i in range(n + 1)] for j in range(n + 1)]


def terrain_sheet(rng):
    levels, seed = rng.randint(1, 3), rng.choice((0, 1, 7, rng.randrange(1 << 53)))
    # Powers of two, so that no exponential is rounded.
    roughness, amplitude = rng.choice((1.0, 1.0, 0.5)), rng.choice((0.25, 1.0, 0.0, 3.7))
    levels = min(levels, 1) if roughness == 0.5 else levels
    corners = [rng.choice((0.0, 1.0, -0.5, rng.uniform(-1, 1))) for _ in range(4)]
    heights = terrain_heights(levels, roughness, amplitude, seed, corners)
    words = f"terrain {{ levels {levels} roughness {roughness} amplitude {amplitude} seed {seed} corners <{', '.join(map(repr, corners))}>"
    words, water = with_water(rng, heights, words)
    return sheet(rng, words + rng.choice((" }", " smooth }")), heights, water)


# ---- iterated function systems ----


class Moved:
    """The gradient of a form in the frame of one copy, seen from that of all."""

    def __init__(self, form, place):
        self.form, self.place = form, place

    def gradient(self, p):
        inverse = self.place.n
        local = times(F(1, self.place.w), tuple(dot(row, sub(p, self.place.c)) for row in inverse))
        return times(F(1, self.place.w), self.place.normal(self.form.gradient(local)))

    def bend(self, p):
        stretch = max(abs(F(x, self.place.w)) for row in self.place.n for x in row)
        return 9 * self.form.bend(p) * stretch**2


class Copies(Leaf):
    """The union of copies of one convex solid."""

    def __init__(self, body, leaf, places, points, directions, size):
        super().__init__(body, points, directions, size)
        self.leaf, self.places = leaf, places

    def solid(self):
        return not self.clip

    def is_near(self, form, ray, t):
        """Whether rounding does not tell the point from one where the form is zero: the maps and brackets are off by less than 2^-43 of the size."""
        t = t.rational(200)
        x, v, w = ray
        p = tuple((a + t * b) / w for a, b in zip(x, v))
        value = form.k[9] + dot(add(form.gradient((F(0),) * 3), form.gradient(p)), p) / 2
        return abs(value) <= sum(map(abs, form.gradient(p))) * (max(map(abs, p)) + 1) / 2**43

    def answer(self, o, d, m):
        found = [(place, self.leaf.answer(o, d, m.after(place)).inside) for place in self.places]
        sets = [inside for _, inside in found if inside]
        inside = union(sets)
        flip = -1 if self.inverse else 1
        # Points that touch the set, and no stretch of it.
        lone = [lo for s in sets for lo, hi in s if meets(lo, hi) == 0 and not any(holds(a, b, lo) for a, b in inside)]
        ends = [(e, s) for lo, hi in inside for e, s in ((lo, -1), (hi, 1)) if e is not None]
        for e in lone:
            if not any(e.cmp(other) == 0 for other, _ in ends):
                ends.append((e, 0))
        events = []
        for t, s in ends:
            normals = []
            for place, stretches in found:
                if any(e is not None and e.cmp(t) == 0 for pair in stretches for e in pair):
                    ray = m.after(place).ray(o, d)
                    normals += [(Moved(f, place), flip) for f in self.leaf.forms if sign_at(f.along(ray), t) == 0 or self.is_near(f, ray, t)]
            events.append(Event(t, flip * s, normals, self))
        events.sort(key=lambda e: e.t.rational())
        inside = complement(inside) if self.inverse else inside
        return Answer(self.clipped(events, m.ray(o, d)), inside)


def box_forms(lo, hi):
    return [halfspace(tuple(int(i == j) for j in range(3)), c, s) for i in range(3) for c, s in ((lo, -1), (hi, 1))]


def tetrahedron_forms(corners):
    forms = []
    for i, p in enumerate(corners):
        a, b, c = (q for q in corners if q is not p)
        n = cross(sub(b, a), sub(c, a))
        forms.append(halfspace(n, a, -1 if dot(n, sub(p, a)) > 0 else 1))
    return forms


def menger_places(levels):
    if levels == 0:
        return [Map()]
    holes = [p for p in product((-1, 0, 1), repeat=3) if sum(x == 0 for x in p) < 2]
    third = F(1, 3)
    rows = ((third, 0, 0), (0, third, 0), (0, 0, third))
    return [Map(rows, tuple(F(2, 3) * x for x in p)).after(inner) for p in holes for inner in menger_places(levels - 1)]


def products(maps, depth):
    return [Map()] if depth == 0 else [m.after(inner) for m in maps for inner in products(maps, depth - 1)]


TETRAHEDRON = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]


def ifs(rng):
    half = lambda c, k=F(1, 2): (((k, 0, 0), (0, k, 0), (0, 0, k)), c)
    style = rng.choice(("menger", "sierpinski", "maps", "maps", "maps"))
    if style == "menger":
        levels = rng.randint(0, 1)
        body, places = f"ifs {{ menger {levels} }}", menger_places(levels)
        corners = list(product((-1, 1), repeat=3))
        leaf = Solid("", box_forms((F(-1),) * 3, (F(1),) * 3), None)
    elif style == "sierpinski":
        levels = rng.randint(0, 3)
        body = f"ifs {{ sierpinski {levels} }}"
        places = products([Map(*half(times(F(1, 2), p))) for p in TETRAHEDRON], levels)
        corners, leaf = TETRAHEDRON, Solid("", tetrahedron_forms(TETRAHEDRON), None)
    else:
        kind = rng.choice(("box", "sphere", "tetrahedron"))
        if kind == "box":
            lo, hi = (F(-1),) * 3, tuple(F(rng.choice((1, 1, 3, F(1, 2)))) for _ in range(3))
            leaf, corners, words = Solid("", box_forms(lo, hi), None), list(product(*zip(lo, hi))), f"box {{ {vec(lo)}, {vec(hi)} }}"
        elif kind == "sphere":
            c, r = tuple(F(rng.randint(-1, 1)) for _ in range(3)), F(rng.choice((1, 5, F(1, 2))))
            leaf, words = Solid("", [distance_form(c, r)], None), f"sphere {{ {vec(c)}, {text(r)} }}"
            corners = [add(c, times(r, e)) for e in ((1, 0, 0), (0, -1, 0), (0, 0, 1))]
        else:
            while True:
                corners = [tuple(F(rng.randint(-2, 2)) for _ in range(3)) for _ in range(4)]
                if dot(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])), sub(corners[3], corners[0])):
                    break
            leaf, words = Solid("", tetrahedron_forms(corners), None), "tetrahedron { " + ", ".join(map(vec, corners)) + " }"
        maps, listed = [], []
        for _ in range(rng.randint(1, 4)):
            k, c = rng.choice((F(1, 2), F(1, 2), F(1, 4), F(3, 4), F(-1, 2))), tuple(F(rng.randint(-4, 4), 4) for _ in range(3))
            rows = tuple(times(k, e) for e in rng.choice((((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 0, 1), (0, 1, 0), (-1, 0, 0)), ((1, 0, 0), (0, F(1, 2), F(1, 4)), (0, F(-1, 4), F(1, 2))))))
            maps.append(Map(rows, c))
            listed.append(f"map {{ {maps[-1].sdl()} }}")
        depth = rng.randint(0, 3 if len(maps) < 4 else 2)
        body, places = f"ifs {{ {words} {' '.join(listed)} depth {depth} }}", products(maps, depth)

    def points():
        for _ in range(3):
            place = rng.choice(places)
            p, q = rng.choice(corners), rng.choice(corners)
            yield near(place.point(add(p, times(F(rng.randint(0, 4), 4), sub(q, p)))))
        yield near(rng.choice(places).c)

    p, q, r = (rng.choice(places).point(rng.choice(corners)) for _ in range(3))
    ways = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), *(w for w in (sub(p, q), sub(q, r)) if any(w))]
    size = max(abs(x) for place in places for c in corners for x in place.point(c))
    return Copies(body, leaf, places, points, ways, max(size, F(1, 64)))
