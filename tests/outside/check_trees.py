"""Solids of every kind made into solids: what `durer trace` says of a tree, against set operations on what it says of each leaf alone.

`check_csg.py` knows its leaves exactly, which are quadrics. Here a leaf is any closed solid of the language, about as large as the others, and one in four is
one that was there before, so that whole surfaces coincide. Only stretches longer than a bound count, since the ends of what rounding leaves open may be on either side.
"""

import argparse
import math
import random
import sys
import tempfile
from pathlib import Path

import numpy as np
import scenes
from command import Wrong, trace
from shapes import IDENTITY

INF = math.inf
# Stretches up to this are not looked at, by far longer than brackets of solids of size 1 that are seen from 4 away.
SHORT = 1e-7
# Sheets, and what may be endless: there places beside an end are not f64's.
NO_SOLIDS = ("plane", "disc", "triangle", "polygon", "named", "quadric", "polynomial")


def leaf(rng):
    """A solid about 1 in size, near the origin."""
    while True:
        made = scenes.MAKERS[rng.choice([k for k in scenes.MAKERS if k not in NO_SOLIDS])](rng)
        if not made.solid() or not 1e-8 < made.size < 1e8:
            continue
        made.map = IDENTITY
        scale = float(rng.choice((1, 1, 0.5, 1.5)) / made.size)
        turn = [rng.choice((0, 0, 90, rng.uniform(0, 360))) for _ in range(3)]
        move = [rng.choice((0, 0.5, rng.uniform(-1, 1))) for _ in range(3)]
        listed = lambda v: "<" + ", ".join(repr(float(x)) for x in v) + ">"
        return f"object {{ {made.sdl()} scale {scale!r} rotate {listed(turn)} translate {listed(move)} }}"


def tree(rng, leaves, depth):
    """A tree as nested tuples, whose leaves are numbers, and as text."""
    if depth == 0 or rng.random() < 0.2:
        leaves.append(rng.choice(leaves) if leaves and rng.random() < 0.25 else leaf(rng))
        return len(leaves) - 1, leaves[-1]
    operation = rng.choice(("merge", "intersection", "difference", "difference"))
    parts = [tree(rng, leaves, depth - 1) for _ in range(rng.choice((2, 2, 3)))]
    return (operation, [node for node, _ in parts]), f"{operation} {{ {' '.join(words for _, words in parts)} }}"


def holds(node, inside):
    """Whether a point is in a tree, if it is known of each leaf."""
    if isinstance(node, int):
        return inside[node]
    operation, parts = node
    first, *others = [holds(part, inside) for part in parts]
    return first or any(others) if operation == "merge" else first and all(others) if operation == "intersection" else first and not any(others)


def differs(node, leaves, whole):
    """The first stretch on which the tree is not what its leaves make of it."""
    ends = sorted({x for spans in (*leaves, whole) for span in spans for x in span})
    within = lambda spans, x: any(a <= x <= b for a, b in spans)
    for a, b in zip(ends, ends[1:]):
        x = (a + b) / 2
        if b - a > SHORT and holds(node, [within(spans, x) for spans in leaves]) != within(whole, x):
            return a, b
    return None


def ray(rng):
    """From outside through the solids' middle, now and then along an axis."""
    through = [rng.choice((0, 0.5, rng.uniform(-1, 1))) for _ in range(3)]
    if rng.random() < 0.2:
        k = rng.randrange(3)
        return [-4.0 if i == k else x for i, x in enumerate(through)] + [float(i == k) for i in range(3)] + [-INF, INF]
    origin = [rng.uniform(-3, 3) for _ in range(3)]
    way = [b - a for a, b in zip(origin, through)]
    length = math.sqrt(sum(x * x for x in way))
    return origin + [x / length for x in way] + [-INF, INF]


def rows(found, names, i):
    at = found["offsets"].astype(int)
    return [tuple(float(found[name][j]) for name in names) for j in range(at[i], at[i + 1])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--durer", type=Path, default=Path(__file__).parents[2] / "target/release/durer")
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--rays", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    examined = spans = open_ = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        scene, rays_file, out = (Path(folder) / name for name in ("scene.pov", "rays.npy", "hits.npz"))
        for i in range(args.scenes):
            rng = random.Random(f"{args.seed}/{i}")
            leaves = []
            node, words = tree(rng, leaves, rng.choice((1, 2, 2, 3)))
            rays = [ray(rng) for _ in range(args.rays)]
            np.save(rays_file, np.array(rays))

            def ask(text, query):
                scene.write_text(text + "\n")
                return trace(args.durer, scene, rays_file, query, out, threads=2)

            try:
                each = [(ask(text, "spans"), ask(text, "all")) for text in leaves]
                whole = ask(words, "spans")
            except Wrong as problem:
                wrong += 1
                print(f"{i}: {problem}\n{words}")
                continue
            for k, line in enumerate(rays):
                # A line along a surface, or tangent to it, within rounding: on which side it is there is nobody's business.
                if any(kind == 2 for _, found in each for (kind,) in rows(found, ("kind",), k)):
                    open_ += 1
                    continue
                examined += 1
                sides = [rows(found, ("t_in", "t_out"), k) for found, _ in each]
                told = rows(whole, ("t_in", "t_out"), k)
                spans += len(told)
                if stretch := differs(node, sides, told):
                    wrong += 1
                    print(f"{i}: {words}\n  ray      {line}\n  leaves   {sides}\n  tree     {node}\n  told     {told}\n  wrong in {stretch}")
    print(f"{args.scenes} trees, {examined} rays, {spans} spans, {open_} rays not examined because a leaf leaves them open, {wrong} violations")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
