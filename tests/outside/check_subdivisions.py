"""Subdivision surfaces: every crossing of a ray against refinement in whole numbers, down to 2^-56 of the mesh.

The rules (Catmull and Clark's, Loop's, creases and boundaries by DeRose, Kass and Truong 1998) are written once more, as textbooks give them. Points are whole numbers of 2^-230, so that a step loses less than
2^-228. All weights are at least 0 and have the sum 1: the limit over a face is in the hull of the points of the faces that touch it. Faces whose hull the ray misses are left; the others are refined, until
their hulls are points for all that f64 can tell. What is left falls into places along the ray. A place is sure if all its faces are crossed from the same side, none flatter than 1 : 64, and none has an open edge: it
holds exactly one crossing. Every hit must be in some place, every sure place must have exactly one hit, with its sign.
"""

import argparse
import math
import random
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from mpmath import mp
from traced import Refused, all_crossings

BITS = 230
ONE = 1 << BITS
ROOM = 1 << 20
"""More than all roundings of 120 steps together."""
END = 56
"""Faces with hulls below 2^-END of the mesh are not refined further."""
mp.prec = BITS + 40
NEAR = 44
"""How near to a surface, as a power of a half, a ray may be for a hit that is not proven. The kernel takes values of less than 8 errors for zero;
an error is at most 16 roundings of 2^-53 of numbers below 2 (a mesh and the ray's nearest point), so the two values are below 2^-45 and the distance below 2^-44."""
INF = math.inf


def fixed(x):
    n, d = float(x).as_integer_ratio()
    return n * ONE // d


def loop_weight(n):
    return int(mp.floor((mp.mpf(5) / 8 - (mp.mpf(3) / 8 + mp.cos(2 * mp.pi / n) / 4) ** 2) / n * ONE))


def key(a, b):
    return (a, b) if a < b else (b, a)


class Mesh:
    """Faces as tuples of vertices; points as triples of whole numbers; sharp edges and vertices."""

    def __init__(self, loop, points, faces, creases, corners):
        self.loop, self.points, self.faces, self.creases, self.corners = loop, points, faces, creases, corners
        self.at = defaultdict(list)
        self.sides = defaultdict(list)
        for f, face in enumerate(faces):
            for k, v in enumerate(face):
                self.at[v].append(f)
                self.sides[key(v, face[(k + 1) % len(face)])].append(f)
        self.ends = defaultdict(list)

        for a, b in self.sides:
            self.ends[a].append(b)
            self.ends[b].append(a)

    def sharp(self, e):
        return INF if len(self.sides[e]) == 1 else self.creases.get(e, 0.0)

    def middle(self, f):
        face = self.faces[f]
        return tuple(sum(self.points[v][c] for v in face) // len(face) for c in range(3))

    def edge_point(self, e):
        a, b = (self.points[v] for v in e)
        s = min(self.sharp(e), 1.0)
        half = tuple((a[c] + b[c]) // 2 for c in range(3))
        if s == 1.0:
            return half
        if self.loop:
            p, q = (self.points[next(v for v in self.faces[f] if v not in e)] for f in self.sides[e])
            smooth = tuple((3 * (a[c] + b[c]) + p[c] + q[c]) // 8 for c in range(3))
        else:
            p, q = (self.middle(f) for f in self.sides[e])
            smooth = tuple((a[c] + b[c] + p[c] + q[c]) // 4 for c in range(3))
        return mixed(smooth, half, s)

    def ruled(self, v, sharp, corner):
        p = self.points[v]
        ends = [self.points[w] for w in self.ends[v]]
        edges = [e for e, s in zip(ends, sharp) if s > 0]
        if corner > 0 or len(edges) > 2:
            return "corner", p
        if len(edges) == 2:
            return "crease", tuple((6 * p[c] + edges[0][c] + edges[1][c]) // 8 for c in range(3))
        n = len(ends)
        if self.loop:
            w = loop_weight(n)
            return "smooth", tuple((p[c] * (ONE - n * w) + w * sum(e[c] for e in ends)) >> BITS for c in range(3))
        middles = [self.middle(f) for f in self.at[v]]
        return "smooth", tuple((n * (n - 2) * p[c] + sum(e[c] for e in ends) + sum(m[c] for m in middles)) // (n * n) for c in range(3))

    def vertex_point(self, v):
        now = [self.sharp(key(v, w)) for w in self.ends[v]]
        then = [max(s - 1, 0) for s in now]
        corner = self.corners.get(v, 0.0)
        (rule, p), (rule2, q) = self.ruled(v, now, corner), self.ruled(v, then, max(corner - 1, 0))
        if rule == rule2:
            return p
        ending = [s for s in [*now, corner] if 0 < s <= 1]
        return mixed(q, p, min(sum(ending) / len(ending), 1.0))

    def refined(self, wanted):
        """The children at these vertices, of which every face must be known; each with its parent."""
        number, points, faces, parents, creases, corners = {}, [], [], [], {}, {}

        def point(name, make):
            if name not in number:
                number[name] = len(points)
                points.append(make())
            return number[name]

        def of_edge(v, w):
            e = key(v, w)
            n = point(("e", e), lambda: self.edge_point(e))
            s = self.creases.get(e, 0.0) - 1
            if len(self.sides[e]) == 2 and s > 0 and v in wanted:
                creases[key(point(("v", v), lambda: self.vertex_point(v)), n)] = s
            return n

        for f in sorted({f for v in wanted for f in self.at[v]}):
            face = self.faces[f]
            n = len(face)
            for k, v in enumerate(face):
                if v not in wanted:
                    continue
                own = point(("v", v), lambda v=v: self.vertex_point(v))
                if self.corners.get(v, 0.0) > 1:
                    corners[own] = self.corners[v] - 1
                a, b = of_edge(v, face[(k + 1) % n]), of_edge(v, face[(k - 1) % n])
                faces.append((own, a, b) if self.loop else (own, a, point(("f", f), lambda f=f: self.middle(f)), b))
                parents.append(f)
            if self.loop and sum(v in wanted for v in face) >= 2:
                edges = [number.get(("e", key(face[k], face[(k + 1) % 3]))) for k in range(3)]
                if None not in edges:
                    faces.append(tuple(edges))
                    parents.append(f)
        return Mesh(self.loop, points, faces, creases, corners), parents, number


def mixed(p, q, s):
    n, d = float(s).as_integer_ratio()
    return tuple(((d - n) * p[c] + n * q[c]) // d for c in range(3))


def vector(p):
    return np.array([x / ONE for x in p])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Line:
    """A ray's two planes through it, and its parameter, as whole numbers."""

    def __init__(self, o, d, near=None):
        self.o = [fixed(x) for x in o]
        powers = [float(x).as_integer_ratio() for x in d]
        largest = max(q for _, q in powers)
        self.d = [p * (largest // q) for p, q in powers]
        small = min(range(3), key=lambda k: abs(self.d[k]))
        unit = [0, 0, 0]
        unit[small] = 1
        self.u = cross(self.d, unit)
        self.v = cross(self.d, self.u)
        # Both of about one length, for what is tested across them.
        shift = max(0, max(map(abs, self.v)).bit_length() - max(map(abs, self.u)).bit_length())
        self.u = tuple(x << shift for x in self.u)
        self.dd = dot(self.d, self.d)
        self.by = largest
        self.room = (ROOM if near is None else ONE >> near) * (sum(map(abs, self.u)) + sum(map(abs, self.v)))

    def plane(self, p):
        q = [a - b for a, b in zip(p, self.o)]
        return dot(q, self.u), dot(q, self.v), dot(q, self.d)

    def misses(self, planes):
        for a, b in ((1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (2, -1), (1, -2)):
            all_of = [a * x + b * y for x, y, _ in planes]
            if min(all_of) > 3 * self.room or max(all_of) < -3 * self.room:
                return True
        return False

    def t(self, s):
        # q . d = t dd / by, in whole numbers of 2^-BITS.
        return s * self.by / (self.dd * ONE)


def places(mesh, line, size):
    """The places along a line where it may cross the limit: (t from, t to, sign or None, whether an open edge is there)."""
    active = set(range(len(mesh.faces)))
    done = []
    for step in range(130):
        planes = [line.plane(p) for p in mesh.points]
        still = []
        for f in active:
            near = {g for v in mesh.faces[f] for g in mesh.at[v]}
            hull = sorted({v for g in near for v in mesh.faces[g]})
            if line.misses([planes[v] for v in hull]):
                continue
            low, high = (tuple(op(mesh.points[v][c] for v in hull) for c in range(3)) for op in (min, max))
            # Along a tangent there are ever more of them.
            if step == 129 or len(active) > 300 or max(b - a for a, b in zip(low, high)) < size >> END:
                s = [planes[v][2] for v in hull]
                done.append((min(s), max(s), side(mesh, f, line), is_open(mesh, f)))
            else:
                still.append(f)
        if not still:
            break
        wanted = {v for f in still for v in mesh.faces[f]}
        finer, parents, _ = mesh.refined(wanted)
        still = set(still)
        mesh, active = finer, {g for g, f in enumerate(parents) if f in still}
    done.sort(key=lambda place: place[:2])
    groups = []
    for low, high, sign, border in done:
        if groups and low <= groups[-1][1]:
            group = groups[-1]
            group[1] = max(group[1], high)
            group[2] = group[2] if group[2] == sign else None
            group[3] |= border
        else:
            groups.append([low, high, sign, border])
    return [(line.t(a), line.t(b), sign, border) for a, b, sign, border in groups]


def is_open(mesh, f):
    """Whether a face or one that touches it has an edge without a partner. All faces at a vertex of `f` are known, so that its edges with one face are borders."""
    return any(len(mesh.sides[key(v, w)]) == 1 for v in mesh.faces[f] for w in mesh.ends[v])


def side(mesh, f, line):
    """From which side a face is crossed, if that is plain: 1 along its normal. Its neighbours must agree."""
    if is_open(mesh, f):
        return None
    found = set()
    for g in {g for v in mesh.faces[f] for g in mesh.at[v]}:
        face = mesh.faces[g]
        p = [mesh.points[v] for v in face]
        n = cross([a - b for a, b in zip(p[2], p[0])], [a - b for a, b in zip(p[-1], p[1])]) if len(p) == 4 else cross(
            [a - b for a, b in zip(p[1], p[0])], [a - b for a, b in zip(p[2], p[0])])
        along = dot(n, line.d)
        if along * along * 4096 <= dot(n, n) * line.dd:
            return None
        found.add(1 if along > 0 else -1)
    return found.pop() if len(found) == 1 else None


# ---- meshes ----


def cube():
    points = [[float(k >> 2) * 2 - 1, float(k >> 1 & 1) * 2 - 1, float(k & 1) * 2 - 1] for k in range(8)]
    return points, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def pyramid(n):
    points = [[math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n), 0.0] for k in range(n)] + [[0.0, 0.0, 1.0], [0.1, 0.0, -1.0]]
    return points, [f for k in range(n) for f in ((k, (k + 1) % n, n), ((k + 1) % n, k, n + 1))]


def plate():
    """A plate of cubes with three holes."""
    full = {(x, y, 0) for x in range(7) for y in range(3)} - {(x, 1, 0) for x in (1, 3, 5)}
    number, points, faces = {}, [], []
    for cell in sorted(full):
        for axis in range(3):
            for end in (0, 1):
                other = list(cell)
                other[axis] += 2 * end - 1
                if tuple(other) in full:
                    continue
                face = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    p = list(cell)
                    p[axis] += end
                    p[(axis + 1) % 3] += a
                    p[(axis + 2) % 3] += b
                    p = tuple(p)
                    if p not in number:
                        number[p] = len(points)
                        points.append([(p[0] - 3.5) / 3, (p[1] - 1.5) / 3, (p[2] - 0.5) / 2])
                    face.append(number[p])
                faces.append(tuple(face if end else face[::-1]))
    return points, faces


def sheet(rng):
    points = [[i / 2 - 1, j / 2 - 1, rng.uniform(-0.4, 0.4)] for j in range(5) for i in range(5)]
    faces = [(5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5) for j in range(4) for i in range(4)]
    # A corner turned into two triangles, so that one vertex inside has five edges.
    a, b, c, d = faces.pop(5)
    return points, [*faces, (a, b, c), (a, c, d)]


def triangles(points, faces):
    return points, [(f[0], f[k - 1], f[k]) for f in faces for k in range(2, len(f))]


def examples(rng):
    for loop in (False, True):
        shapes = [("cube", cube()), ("genus 3", plate()), *((f"pyramid {n}", pyramid(n)) for n in range(3, 13)), ("sheet", sheet(rng)), ("smooth sheet", sheet(rng))]
        for name, (points, faces) in shapes:
            if loop:
                points, faces = triangles(points, faces)
            if "sheet" not in name:
                points = [[x + rng.uniform(-0.05, 0.05) for x in p] for p in points]
            for creased in (False, True):
                creases, corners = [], []
                if creased:
                    edges = sorted({key(a, b) for f in faces for a, b in zip(f, f[1:] + f[:1])})
                    for e in rng.sample(edges, max(2, len(edges) // 6)):
                        creases.append((*e, rng.choice([0.5, 1.0, 1.75, 3.0, 10.0, 10.0])))
                    corners = [(v, rng.choice([1.5, 10.0])) for v in rng.sample(range(len(points)), 1)]
                yield f"{'loop ' if loop else ''}{name}{' creased' if creased else ''}", loop, points, faces, creases, corners, name == "smooth sheet"


def scene_text(loop, points, faces, creases, corners, smooth):
    number = lambda x: f"{x!r}"
    words = ["subdivision {", "scheme loop" if loop else "", f"vertex_vectors {{ {len(points)},"]
    words += ["<" + ", ".join(map(number, p)) + ">" for p in points]
    words += ["}", f"face_indices {{ {len(faces)},"] + ["{ %d, %s }" % (len(f), ", ".join(map(str, f))) for f in faces] + ["}"]
    if creases:
        words += [f"creases {{ {len(creases)},"] + [f"<{a}, {b}, {s!r}>" for a, b, s in creases] + ["}"]
    if corners:
        words += [f"corners {{ {len(corners)},"] + [f"<{v}, {s!r}>" for v, s in corners] + ["}"]
    return "\n".join([*words, "boundary smooth" if smooth else "", "pigment { rgb 1 } }"]) + "\n"


def control_mesh(loop, points, faces, creases, corners, smooth):
    sharp = lambda s: INF if s >= 10 else s
    crease, corner = {}, {}
    for a, b, s in creases:
        crease[key(a, b)] = max(crease.get(key(a, b), 0.0), sharp(s))
    for v, s in corners:
        corner[v] = sharp(s)
    mesh = Mesh(loop, [tuple(map(fixed, p)) for p in points], faces, crease, corner)
    if not smooth:
        for v, at in mesh.at.items():
            if len(at) == 1:
                mesh.corners[v] = INF
    return mesh


def targets(mesh, rng, count):
    """Limits of vertices, of middles of edges and of faces: where it is, and a normal of a face there."""
    meshes = [mesh, mesh.refined(set(mesh.at))[0]]
    for _ in range(count):
        now = rng.choice(meshes)
        name = rng.choice(sorted(now.at))
        for _ in range(40):
            # The vertex and its neighbours are enough.
            now, _, number = now.refined({name})
            name = number["v", name]
        p = [now.points[v] for v in now.faces[0]]
        n = np.cross(vector([a - b for a, b in zip(p[1], p[0])]) * 2.0**20, vector([a - b for a, b in zip(p[-1], p[0])]) * 2.0**20)
        length = np.linalg.norm(n)
        yield vector(now.points[name]), n / length if length > 0 else np.array([0.0, 0.0, 1.0])


def draw_rays(mesh, rng, count):
    rays = []
    vec = lambda: np.array([rng.uniform(-1, 1) for _ in range(3)])
    for target, normal in targets(mesh, rng, count):
        if rng.random() < 0.3:
            target = target + vec() * 2.0 ** rng.uniform(-55, -5)
        if rng.random() < 0.25:
            d = np.cross(normal, vec())
            if rng.random() < 0.5:
                d = d + normal * 2.0 ** rng.uniform(-20, -3) * rng.choice([-1, 1])
            o = target - d * rng.uniform(2, 4)
        else:
            o = vec()
            o = o * rng.uniform(2, 4) / np.linalg.norm(o)
            d = target - o
        if rng.random() < 0.1:
            k = rng.randrange(3)
            o, d = target.copy(), np.zeros(3)
            d[k] = 1.0
            o[k] -= 4.0
        if np.any(d):
            rays.append([*o, *d])
    return np.array(rays)


def check(durer, seed, count, only, show):
    rng = random.Random(seed)
    wrong, rays_done, crossings, sure_count, widths = [], 0, 0, 0, []
    for name, *data in examples(rng):
        if only and only not in name:
            continue
        mesh = control_mesh(*data)
        rays = draw_rays(mesh, rng, count)
        try:
            found = all_crossings(durer, scene_text(*data), rays)
        except Refused as why:
            wrong.append((name, "refused", str(why), None))
            continue
        for i, ray in enumerate(rays):
            first, last = found["offsets"][i : i + 2]
            hits = [tuple(found[k][j] for k in ("t_lo", "t_hi", "sign", "kind")) for j in range(first, last)]
            expected = [p for p in places(mesh, Line(ray[:3], ray[3:]), ONE) if p[1] >= 0]
            problem = compare(expected, hits, lambda ray=ray: places(mesh, Line(ray[:3], ray[3:], NEAR), ONE))
            if problem:
                wrong.append((f"{name}: {problem}", data, ray.tolist(), (expected, hits)))
            rays_done += 1
            crossings += len(hits)
            sure_count += sum(p[2] is not None for p in expected)
            widths += [(b - a) / math.ulp(max(abs(a), abs(b))) for a, b, s, kind in hits if kind == 0]
        print(f"{name}: {len(rays)} rays, {len(wrong)} violations so far", flush=True)
    for what, data, ray, more in wrong[:show]:
        print("==", what, "\n  ray", ray, "\n ", more)
    print(f"{rays_done} rays, {crossings} hits, {sure_count} sure crossings; brackets in ulp: median {np.median(widths):.1f}, 99 % {np.percentile(widths, 99):.0f}, most {max(widths):.0f}")
    print(f"{len(wrong)} violations")
    return 1 if wrong else 0


def compare(expected, hits, almost):
    """What is wrong, if anything is: places and hits are matched where their intervals meet. A hit that says itself that it is not proven, and one beside an open edge, may be where the surface is passed by less than 2^-NEAR."""
    beside = None
    overlap = lambda p, q: p[0] <= q[1] and q[0] <= p[1]
    for hit in hits:
        if any(overlap(hit, p) for p in expected):
            continue
        beside = beside or almost()
        # In and out of a crease that is missed by rounding.
        twins = sum(h[2] for h in hits if overlap(h, hit)) == 0
        if not any(overlap(hit, p) and (hit[3] or p[3] or twins) for p in beside):
            return "a hit where there is no crossing"
    # Groups of places and hits that overlap: where all is sure, it is the same.
    rest = []
    for group in groups_of(expected, hits):
        places_, hits_ = group
        if all(p[2] is not None for p in places_) and all(h[3] == 0 for h in hits_) and places_:
            wanted, got = sorted(p[2] for p in places_), sorted(int(h[2]) for h in hits_)
            if wanted != got:
                return "a crossing is missing" if len(got) < len(wanted) else "a crossing is doubled" if len(got) > len(wanted) else "a sign is wrong"
        else:
            rest += places_
    for a, b, sign, _ in rest:
        if sign is None:
            continue
        own = [h for h in hits if h[0] <= b and a <= h[1]]
        if not own:
            return "a crossing is missing"
        if len(own) > 1:
            # A wide bracket beside an unsure place may reach here.
            near = [h for h in own if not any(p[2] is None and h[0] <= p[1] and p[0] <= h[1] for p in expected)]
            if len(near) > 1:
                return "a crossing is doubled"
        if own[0][2] not in (0, sign) and len(own) == 1:
            return "a sign is wrong"
    return None


def groups_of(places_, hits):
    """Places and hits in groups whose intervals overlap."""
    groups, end = [], None
    for lo, hi, k, item in sorted([(p[0], p[1], 0, p) for p in places_] + [(h[0], h[1], 1, h) for h in hits], key=lambda x: x[:3]):
        if end is None or lo > end:
            groups.append(([], []))
            end = hi
        groups[-1][k].append(item)
        end = max(end, hi)
    return groups


def inside_of(name, rng, count):
    """Points well within one of the examples."""
    vec = np.random.default_rng(rng.randrange(1 << 30)).uniform(-1, 1, (count, 3))
    return np.array([0.0, -0.333, 0.0]) + vec * [0.9, 0.02, 0.02] if "genus" in name else vec * 0.12


def check_in_turn(durer, seed, count, only, outside):
    """Rays from inside, or lines from outside, half of them through limits of vertices and edges, of the latter most beside the plane there: leaving and entering alternate, and all ends are outside."""
    rng = random.Random(seed)
    wrong, total = 0, 0
    for name, *data in examples(rng):
        if "sheet" in name or only and only not in name:
            continue
        mesh = control_mesh(*data)
        aims, normals = map(np.array, zip(*targets(mesh, rng, 200)))
        o = inside_of(name, rng, count)
        draw = np.random.default_rng(seed)
        which = draw.integers(len(aims), size=count)
        if outside:
            plane = np.cross(normals[which], draw.uniform(-1, 1, (count, 3)))
            tilt = draw.choice([-1, 0, 1], (count, 1)) * 2.0 ** draw.uniform(-50, 1, (count, 1))
            d = np.where((np.arange(count) % 4 == 0)[:, None], draw.uniform(-1, 1, (count, 3)), plane + normals[which] * tilt)
            d /= np.linalg.norm(d, axis=1, keepdims=True)
            o = aims[which] - d * draw.uniform(4, 6, (count, 1))
        else:
            d = np.where((np.arange(count) % 2 == 0)[:, None], aims[which] - o, draw.uniform(-1, 1, (count, 3)))
        hits = all_crossings(durer, scene_text(*data), np.hstack([o, d]))
        offsets, sign, kind = (hits[key].astype(np.int64) for key in ("offsets", "sign", "kind"))
        # The sums of signs so far, beginning with what the origin is: 1 outside, 0 inside.
        own = np.repeat(np.arange(count), np.diff(offsets))
        sums = np.cumsum(sign)
        before = np.concatenate([[0], sums])[offsets[:-1]]
        start = 1 if outside else 0
        out = start + sums - before[own]
        bad_rays = set(own[(out < 0) | (out > 1)]) | set(np.flatnonzero(start + np.concatenate([[0], sums])[offsets[1:]] - before != 1))
        bad = len(bad_rays)
        wrong += bad
        total += count
        print(f"{name}: {count} rays from {'outside' if outside else 'inside'}, {len(sign)} crossings, {bad} rays that do not leave in turn, {np.sum(kind != 0)} crossings that are not proven", flush=True)
        for i in sorted(bad_rays)[:2]:
            print("  ", o[i].tolist(), d[i].tolist(), sign[offsets[i] : offsets[i + 1]])
    print(f"{total} rays, {wrong} violations")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--durer", type=Path, default=Path(__file__).parents[2] / "target/release/durer")
    parser.add_argument("--rays", type=int, default=12, help="rays for each mesh")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="only meshes with this in their name")
    parser.add_argument("--show", type=int, default=3)
    parser.add_argument("--inside", type=int, help="so many rays from inside each closed mesh, and nothing else")
    parser.add_argument("--outside", type=int, help="so many lines from outside past edges of each closed mesh, and nothing else")
    args = parser.parse_args()
    if args.inside or args.outside:
        return check_in_turn(args.durer, args.seed, args.inside or args.outside, args.only, not args.inside)
    return check(args.durer, args.seed, args.rays, args.only, args.show)


if __name__ == "__main__":
    sys.exit(main())
