#!/usr/bin/env python3
"""One shape, many kernels: the same crossings, whoever finds them.

A sphere as a quadric, as rational patches, as NURBS, as three formulas and as a level set; a cylinder's wall as a quadric, a lathe, patches, NURBS and
formulas; a torus as a quartic, patches, NURBS and formulas. The rational forms are exact: the weights of a quarter of a circle are 1, 1 and 2. Every
crossing has to be there in each, with the same sign, and brackets that have a point in common.

    check_kernels.py [--durer PATH] [--rays N] [--seed N] [--only WORD]
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from traced import all_crossings

HERE = Path(__file__).resolve().parent
ARCS = "12, 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4"
# A circle of four quarters: cosine, sine and weight.
CIRCLE = [(1, 0, 1), (1, 1, 1), (0, 1, 2), (-1, 1, 1), (-1, 0, 1), (-1, -1, 1), (0, -1, 2), (1, -1, 1), (1, 0, 1)]


def turned(profile):
    """Rows of points about y from radii, heights and weights."""
    return [[(r * c, y, r * s, w * v) for c, s, v in CIRCLE] for r, y, w in profile]


def point(p):
    return "<" + ", ".join(repr(float(x)) for x in p) + ">"


def nurbs(rows, degree, v_knots):
    points = ", ".join(point(p) for row in rows for p in row)
    return f"nurbs {{ degree 2, {degree} points 9, {len(rows)}, {points} u_knots {ARCS} {v_knots} }}"


def patches(rows, degree):
    out = []
    for j in range(0, len(rows) - 1, degree):
        for i in range(0, 8, 2):
            net = [rows[j + b][i + a] for b in range(degree + 1) for a in range(3)]
            out.append(f"patch {{ 3, {degree + 1}, {', '.join(map(point, net))} }}")
    return "union { " + " ".join(out) + " }"


def parametric(x, y, z, domain):
    return f"parametric {{ function {{ {x} }} function {{ {y} }} function {{ {z} }} {domain} contained_by {{ box {{ -2, 2 }} }} }}"


BALL = turned([(0, -1, 1), (1, -1, 1), (1, 0, 2), (1, 1, 1), (0, 1, 1)])
WALL = turned([(1, -1, 1), (1, 1, 1)])
RING = turned([(1 + 0.375 * c, 0.375 * s, w) for c, s, w in CIRCLE])
SHAPES = {
    "sphere": {
        "quadric": "sphere { 0, 1 }",
        "patches": patches(BALL, 2),
        "nurbs": nurbs(BALL, 2, "v_knots 8, 0, 0, 0, 1, 1, 2, 2, 2"),
        "parametric": parametric("cos(u)*cos(v)", "sin(v)", "sin(u)*cos(v)", "<0, -pi/2>, <2*pi, pi/2>"),
        "isosurface": "isosurface { function { x*x + y*y + z*z - 1 } contained_by { box { -1.5, 1.5 } } }",
    },
    "cylinder": {
        "quadric": "cylinder { -y, y, 1 open }",
        "lathe": "lathe { linear_spline 2, <1, -1>, <1, 1> }",
        "patches": patches(WALL, 1),
        "nurbs": nurbs(WALL, 1, ""),
        "parametric": parametric("cos(u)", "v", "sin(u)", "<0, -1>, <2*pi, 1>"),
    },
    "torus": {
        "quartic": "torus { 1, 0.375 }",
        "patches": patches(RING, 2),
        "nurbs": nurbs(RING, 2, f"v_knots {ARCS}"),
        "parametric": parametric("(1 + 0.375*cos(v))*cos(u)", "0.375*sin(v)", "(1 + 0.375*cos(v))*sin(u)", "<0, 0>, <2*pi, 2*pi>"),
    },
}


def aims(rng, name, count):
    """Points of the shape, half of them on seams."""
    u, v = rng.random(count) * 2 * np.pi, rng.random(count) * 2 * np.pi
    u = np.where(rng.random(count) < 0.25, np.round(u / (np.pi / 2)) * np.pi / 2, u)
    v = np.where(rng.random(count) < 0.25, np.round(v / (np.pi / 2)) * np.pi / 2, v)
    if name == "sphere":
        r, y = np.cos(v), np.sin(v)
    elif name == "cylinder":
        r, y = np.ones(count), v / np.pi * 0.99 - 0.99
    else:
        r, y = 1 + 0.375 * np.cos(v), 0.375 * np.sin(v)
    return np.stack([r * np.cos(u), y, r * np.sin(u)], axis=-1)


def once(hits):
    """Patches of their own share their edges, and a ray through an edge meets both: of hits from the same side with overlapping brackets the first stays."""
    offsets, kept = [0], []
    for first, last in zip(hits["offsets"][:-1], hits["offsets"][1:]):
        before = {}
        for k in range(int(first), int(last)):
            side = int(hits["sign"][k]), int(hits["kind"][k])
            if hits["t_lo"][k] > before.get(side, -np.inf):
                kept.append(k)
            before[side] = max(before.get(side, -np.inf), hits["t_hi"][k])
        offsets.append(len(kept))
    return {"offsets": np.array(offsets), **{k: hits[k][kept] for k in ("t_lo", "t_hi", "sign", "kind")}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--durer", default=str(HERE.parents[1] / "target/release/durer"))
    parser.add_argument("--rays", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    args = parser.parse_args()
    violations = 0
    for name, forms in SHAPES.items():
        if args.only not in name:
            continue
        rng = np.random.default_rng(args.seed)
        at = aims(rng, name, args.rays)
        d = rng.normal(size=(args.rays, 3))
        rays = np.concatenate([at - d * rng.uniform(1, 8, (args.rays, 1)), d], axis=-1)
        answers = {form: all_crossings(args.durer, text + "\n", rays) for form, text in forms.items()}
        answers = {form: once(hits) if form == "patches" else hits for form, hits in answers.items()}
        first = next(iter(forms))
        one = answers[first]
        for form, other in list(answers.items())[1:]:
            wrong = uncertain = crossings = 0
            # Which way a sheet faces is its own; it has to be one way everywhere. The first crossings are what most of all rays say.
            starts = lambda x: np.where(np.diff(x["offsets"].astype(np.int64)) > 0, np.append(x["sign"], 0).astype(int)[np.minimum(x["offsets"][:-1].astype(np.int64), len(x["sign"]))], 0)
            way = np.sign((starts(one) * starts(other)).sum())
            for k in range(args.rays):
                a, b = (slice(int(x["offsets"][k]), int(x["offsets"][k + 1])) for x in (one, other))
                crossings += b.stop - b.start
                if a.stop - a.start != b.stop - b.start:
                    if (one["kind"][a] != 0).any() or (other["kind"][b] != 0).any():
                        uncertain += 1
                        continue
                    bad = True
                else:
                    bad = (np.maximum(one["t_lo"][a], other["t_lo"][b]) > np.minimum(one["t_hi"][a], other["t_hi"][b])).any()
                    proven = (one["kind"][a] == 0) & (other["kind"][b] == 0)
                    bad |= (proven & (one["sign"][a] != way * other["sign"][b])).any()
                if bad:
                    wrong += 1
                    if wrong <= 3:
                        print("   ", " ".join(map(repr, map(float, rays[k]))), one["t_lo"][a], other["t_lo"][b], one["sign"][a], other["sign"][b])
            print(f"{name}: {form} beside {first}: {args.rays} rays, {crossings} crossings, {uncertain} rays differ by a tangent, {wrong} violations")
            violations += wrong
    print(f"{violations} violations")
    sys.exit(violations > 0)


if __name__ == "__main__":
    main()
