#!/usr/bin/env python3
"""Closed sets of faces: no ray from inside may escape, and every line enters and leaves in turn. Half of the rays are aimed exactly at corners and at points of shared edges.

The bodies: the body of the Utah teapot with its lid and bottom, closed by a ruled ring under the lid; a rational sphere and a rational torus; a box of
six bicubic NURBS faces whose edges are curved; a cube; the box and the teapot twisted; the box in a lattice. A ray that starts inside has to meet the body, and
to cross it an odd number of times, outward first and in turn.

With `--outside`, lines pass through points of edges, in directions beside the plane of one of the faces there by angles of all sizes (or within it); the crossings on
a whole line that are proven have to be entries and exits in turn, an entry first. It cannot see a body that is missed or met where it should not be.

    check_seams.py [--durer PATH] [--rays N] [--seed N] [--only WORD] [--plain] [--outside]
"""

import argparse
import math
import re
import sys
from pathlib import Path

import numpy as np
from traced import Refused, all_crossings

HERE = Path(__file__).resolve().parent
H = math.sqrt(0.5)
ARCS = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]


class Face:
    """A NURBS surface of Bezier patches: rows of points and weights, `u` along a row."""

    def __init__(self, degree, rows, knots=(None, None)):
        self.degree, self.rows, self.knots = degree, np.array(rows, dtype=float), knots

    def text(self):
        (v, u), (du, dv) = self.rows.shape[:2], self.degree
        number = lambda x: repr(float(x))
        point = lambda p: "<" + ", ".join(map(number, p)) + ">"
        points = ", ".join(point(p) for row in self.rows for p in row)
        out = f"nurbs {{ degree {du}, {dv} points {u}, {v}, {points}"
        for name, knots in zip("uv", self.knots):
            if knots:
                out += f" {name}_knots {len(knots)}, {', '.join(map(str, knots))}"
        return out + " }"

    def patches(self):
        """The homogeneous control points of each Bezier patch."""
        (v, u), (du, dv) = self.rows.shape[:2], self.degree
        net = np.concatenate([self.rows[..., :3] * self.rows[..., 3:], self.rows[..., 3:]], axis=-1)
        for j in range((v - 1) // dv):
            for i in range((u - 1) // du):
                yield net[j * dv : (j + 1) * dv + 1, i * du : (i + 1) * du + 1]


def bernstein(n, t):
    return np.stack([math.comb(n, i) * t**i * (1 - t) ** (n - i) for i in range(n + 1)])


def points_of(net, u, v):
    p = np.einsum("jn,in,jik->nk", bernstein(net.shape[0] - 1, v), bernstein(net.shape[1] - 1, u), net)
    return p[:, :3] / p[:, 3:]


def circle(r, y, w):
    return [
        (r, y, 0, w), (r, y, r, w * H), (0, y, r, w), (-r, y, r, w * H), (-r, y, 0, w), (-r, y, -r, w * H), (0, y, -r, w), (r, y, -r, w * H), (r, y, 0, w),
    ]


def turned(profile, knots):
    return Face((2, 2), [circle(*p) for p in profile], (ARCS, knots))


def sphere():
    return [turned([(0, -1, 1), (1, -1, H), (1, 0, 1), (1, 1, H), (0, 1, 1)], [0, 0, 0, 1, 1, 2, 2, 2])]


def torus():
    r = 0.375
    ring = [(1 + r, 0, 1), (1 + r, r, H), (1, r, 1), (1 - r, r, H), (1 - r, 0, 1), (1 - r, -r, H), (1, -r, 1), (1 + r, -r, H), (1 + r, 0, 1)]
    return [turned(ring, ARCS)]


def box():
    """Six bicubic faces; the twelve edges are cubics that bulge."""
    rng = np.random.default_rng(5)
    moves = {}

    def at(p):
        key = tuple(p)
        if key not in moves:
            moves[key] = np.array(p) * 2 / 3 - 1 + rng.uniform(-0.2, 0.2, 3)
        return (*moves[key], 1.0)

    faces = []
    for axis in range(3):
        for end in (0, 3):
            point = lambda i, j: at(tuple(np.roll((end, i, j), axis)))
            faces.append(Face((3, 3), [[point(i, j) for i in range(4)] for j in range(4)]))
    return faces


def cube():
    """Six plane faces."""
    point = lambda axis, end, i, j: (*map(float, np.roll((end, i, j), axis)), 1.0)
    return [Face((1, 1), [[point(axis, end, i, j) for i in (-1, 1)] for j in (-1, 1)]) for axis in range(3) for end in (-1, 1)]


def teapot():
    """Body, lid and bottom from the scene's own control points, and a ring between the rim and the lid."""
    text = (HERE.parents[1] / "scenes/teapot.pov").read_text()
    quarter = text[text.index("#declare Quarter") : text.index("#declare Side")]
    nets = []
    for patch in re.findall(r"bicubic_patch \{(.*?)\}", quarter, re.S):
        points = [tuple(map(float, p.split(","))) for p in re.findall(r"<([^>]*)>", patch)]
        nets.append(np.array(points).reshape(4, 4, 3))
    nets = joined(nets)
    faces = []
    for x, z in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        for net in nets:
            rows = np.concatenate([net * (x, 1, z), np.ones(net.shape[:2] + (1,))], axis=-1)
            faces.append(Face((3, net.shape[0] - 1), rows))
    return faces


def joined(nets):
    """The patches of a quarter, with a ruled one between the two edges that have no partner off the planes of symmetry."""
    edges = []
    for net in nets:
        for row in (net[0], net[-1]):
            if not (row == row[0]).all():
                edges.append(row)
    same = lambda a, b: (a == b).all() or (a == b[::-1]).all()
    free = [a for i, a in enumerate(edges) if not any(same(a, b) for k, b in enumerate(edges) if k != i)]
    assert len(free) == 2, [f.tolist() for f in free]
    a, b = free
    if np.abs(a[0] - b[0]).max() > np.abs(a[0] - b[-1]).max():
        b = b[::-1]
    return [*nets, np.stack([a, b])]


def twisted(points, degrees, start, end):
    a = math.radians(degrees) * np.clip((points[:, 1] - start) / (end - start), 0, 1)
    x, z = points[:, 0], points[:, 2]
    return np.stack([x * np.cos(a) + z * np.sin(a), points[:, 1], z * np.cos(a) - x * np.sin(a)], axis=-1)


def pushed(points):
    t = (points + 2) / 4
    weight = 4 * t[:, 0] * t[:, 1] * (1 - t[:, 0]) * t[:, 2]
    return points + weight[:, None] * np.array([0.5, 0.75, -0.25])


PUSH = "lattice { <-2, -2, -2>, <2, 2, 2>, 3, 2, 2 move <1, 1, 1>, <1, 1.5, -0.5> }"
BODIES = {
    "teapot": (teapot, "", lambda p: p, (0, 1, 0), 0.4),
    "sphere": (sphere, "", lambda p: p, (0, 0, 0), 0.5),
    "torus": (torus, "", lambda p: p, (1, 0, 0), 0.2),
    "box": (box, "", lambda p: p, (0, 0, 0), 0.4),
    "cube": (cube, "", lambda p: p, (0, 0, 0), 0.9),
    "twisted box": (box, "twist { y, 60, from -1 to 1 }", lambda p: twisted(p, 60, -1, 1), (0, 0, 0), 0.3),
    "twisted teapot": (teapot, "twist { y, 90, from 0 to 2 }", lambda p: twisted(p, 90, 0, 2), (0, 1, 0), 0.3),
    "box in a lattice": (box, PUSH, pushed, (0, 0, 0), 0.3),
}


def rays(rng, faces, move, centre, size, count):
    origins = np.array(centre) + rng.uniform(-size, size, (count, 3)) * (rng.random(count) < 0.75)[:, None]
    patches = [net for face in faces for net in face.patches()]
    targets = np.empty((count, 3))
    which = rng.integers(len(patches), size=count)
    ends = lambda n: rng.integers(2, size=n).astype(float)
    for k, net in enumerate(patches):
        here = np.flatnonzero(which == k)
        u, v, kind = rng.random(len(here)), rng.random(len(here)), rng.integers(4, size=len(here))
        # A quarter at corners, a quarter at edges.
        u = np.where((kind == 0) | (kind == 1) & (rng.random(len(here)) < 0.5), ends(len(here)), u)
        v = np.where((kind == 0) | (kind == 1) & (u != 0) & (u != 1), ends(len(here)), v)
        targets[here] = points_of(net, u, v)
    return np.concatenate([origins, move(targets) - origins], axis=-1)


def lines(rng, faces, count):
    """From outside through points of edges, beside the planes of faces."""
    patches = [net for face in faces for net in face.patches()]
    which = rng.integers(len(patches), size=count)
    out = np.empty((count, 6))
    for k, net in enumerate(patches):
        here = np.flatnonzero(which == k)
        n = len(here)
        along, end = rng.random(n), rng.integers(2, size=n).astype(float)
        along = np.where(rng.random(n) < 0.15, rng.integers(2, size=n), along)
        u, v = np.where(rng.random(n) < 0.5, (along, end), (end, along))
        h = 2.0**-20
        slope = lambda a, b: points_of(net, np.minimum(u + a, 1), np.minimum(v + b, 1)) - points_of(net, np.maximum(u - a, 0), np.maximum(v - b, 0))
        unit = lambda w: w / (np.linalg.norm(w, axis=-1, keepdims=True) + 1e-300)
        su, sv = unit(slope(h, 0)), unit(slope(0, h))
        turn = rng.uniform(0, 2 * np.pi, (n, 1))
        tilt = rng.choice([-1, 0, 1], (n, 1), p=[0.45, 0.1, 0.45]) * 2.0 ** rng.uniform(-50, 1, (n, 1))
        d = su * np.cos(turn) + sv * np.sin(turn) + unit(np.cross(su, sv)) * tilt
        out[here] = np.hstack([points_of(net, u, v) - d * rng.uniform(5, 9, (n, 1)), d])
    return out[np.any(out[:, 3:] != 0, axis=1)]


def out_of_turn(hits, inside, deep=1):
    """The rays whose proven crossings do not alternate, from inside or from outside on, an exit last. Where one is not proven it may be either, or none. A body may overlap itself `deep` times."""
    offsets, sign, kind = (hits[name].astype(np.int64) for name in ("offsets", "sign", "kind"))
    own = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    open_ = np.zeros(len(offsets) - 1, bool)
    open_[own[(kind != 0) & (sign != 0) | (kind == 2)]] = True
    sums = np.concatenate([[0], np.cumsum(sign)])
    first = 0 if inside else 1
    out = first + sums[1:] - sums[offsets[:-1]][own]
    bad = np.zeros(len(offsets) - 1, bool)
    bad[own[(out < 1 - deep) | (out > 1)]] = True
    bad |= first + sums[offsets[1:]] - sums[offsets[:-1]] != 1
    return np.flatnonzero(bad & ~open_)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--durer", default=str(HERE.parents[1] / "target/release/durer"))
    parser.add_argument("--rays", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--plain", action="store_true", help="no deformed bodies, which take a hundred times as long")
    parser.add_argument("--outside", action="store_true", help="lines past edges instead of rays from inside")
    args = parser.parse_args()
    violations = 0
    for name, (make, warp, move, centre, size) in BODIES.items():
        if args.only not in name or warp and (args.outside or args.plain):
            continue
        rng = np.random.default_rng(args.seed)
        faces = make()
        # The teapot's lid dips into its body.
        deep = 2 if "teapot" in name else 1
        body = f"sewn {{ {' '.join(face.text() for face in faces)} closed }}"
        if warp:
            body = f"deform {{ {body} {warp} }}"
        all_rays = lines(rng, faces, args.rays) if args.outside else rays(rng, faces, move, centre, size, args.rays)
        try:
            hits = all_crossings(args.durer, body + "\n", all_rays)
        except Refused as why:
            print(f"{name}: {why}")
            violations += 1
            continue
        if args.outside:
            wrong = out_of_turn(hits, False, deep)
            print(f"{name}: {len(faces)} surfaces, {len(all_rays)} lines, {len(hits['sign'])} crossings, {len(wrong)} lines do not enter and leave in turn", flush=True)
            for k in wrong[:3]:
                row = slice(int(hits["offsets"][k]), int(hits["offsets"][k + 1]))
                print("   ", " ".join(map(repr, map(float, all_rays[k]))), hits["t"][row], hits["sign"][row])
            violations += len(wrong)
            continue
        offsets, kinds = hits["offsets"].astype(np.int64), hits["kind"]
        counts = np.diff(offsets)
        # A crossing that is not proven may be a touch, which does not count.
        touches = np.add.reduceat(np.append(kinds == 1, 0), np.minimum(offsets[:-1], len(kinds))) * (counts > 0)
        escaped = np.flatnonzero((counts - touches) % 2 == 0)
        swapped = np.setdiff1d(out_of_turn(hits, True, deep), escaped)
        unproven = int((kinds != 0).sum())
        print(f"{name}: {len(faces)} surfaces, {args.rays} rays, {len(kinds)} crossings, {unproven} not proven, {len(escaped)} rays escaped, {len(swapped)} others do not leave in turn", flush=True)
        for k in [*escaped[:3], *swapped[:3]]:
            print("   ", " ".join(map(repr, map(float, all_rays[k]))), hits["sign"][offsets[k] : offsets[k + 1]])
        violations += len(escaped) + len(swapped)
    print(f"{violations} violations")
    sys.exit(violations > 0)


if __name__ == "__main__":
    main()
