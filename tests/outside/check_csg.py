"""Solids made of solids, by the command's contract: what `durer trace` says of random trees, against exact sets on the line.

A leaf is a set of intervals with exact ends (`shapes.Solid`), the tree's operations are those of sets, and what is left after each is closed and has no
lone points: the regularised set. Its ends are the crossings. Numbers are coarse, so faces, edges and whole leaves coincide often.
"""

import argparse
import random
import subprocess
import sys
import tempfile
from fractions import Fraction as F
from pathlib import Path

import numpy as np
from command import COLUMNS, Wrong, trace
from exact import complement, union
from scenes import box_forms
from shapes import IDENTITY, Form, Map, Solid, distance_form, halfspace, text, vec, wall_form


def nothing():
    yield (0, 0, 0)


def half(rng, low=-4, high=4):
    return F(rng.randint(low, high), 2)


def leaf(rng):
    c = tuple(half(rng) for _ in range(3))
    kind = rng.choice(("sphere", "box", "box", "cylinder", "cone", "plane", "quadric"))
    if kind == "sphere":
        r = half(rng, 1, 4)
        made = Solid(f"sphere {{ {vec(c)}, {text(r)} }}", [distance_form(c, r)], nothing, size=r)
    elif kind == "box":
        d = tuple(half(rng, 1, 4) for _ in range(3))
        e = tuple(a + b for a, b in zip(c, d))
        made = Solid(f"box {{ {vec(c)}, {vec(e)} }}", box_forms(c, e), nothing, size=max(d))
    elif kind == "plane":
        i, s = rng.randrange(3), rng.choice((-1, 1))
        n = tuple(s * int(i == j) for j in range(3))
        made = Solid(f"plane {{ {vec(n)}, {text(s * c[i])} }}", [halfspace(n, c)], nothing)
    elif kind == "quadric":
        k = [rng.choice((0, 1, 2, -1)) for _ in range(3)] + [rng.choice((0, 0, 1)) for _ in range(3)]
        k += [rng.choice((0, 1, -1)) for _ in range(3)] + [rng.choice((-1, -2, 1))]
        if not any(k[:9]):
            k[0] = 1
        words = f"quadric {{ {vec(k[:3])}, {vec(k[3:6])}, {vec(k[6:9])}, {text(F(k[9]))} }}"
        made = Solid(words, [Form(*k)], nothing)
    else:
        i = rng.randrange(3)
        axis = tuple(F(int(i == j)) * half(rng, 1, 4) for j in range(3))
        e = tuple(a + b for a, b in zip(c, axis))
        r0 = half(rng, 1, 3)
        r1 = r0 if kind == "cylinder" else rng.choice((F(0), r0 / 2, r0 + 1))
        numbers = f"{vec(c)}, {vec(e)}, {text(r0)}" if kind == "cylinder" else f"{vec(c)}, {text(r0)}, {vec(e)}, {text(r1)}"
        forms = [wall_form(c, e, r0, r1), halfspace(axis, c, -1), halfspace(axis, e, 1)]
        made = Solid(f"{kind} {{ {numbers} }}", forms, nothing, size=max(r0, *axis))
    if rng.random() < 0.2:
        made.inverse = True
    if rng.random() < 0.2:
        t = tuple(half(rng) for _ in range(3))
        rows = rng.choice((((0, 1, 0), (0, 0, 1), (1, 0, 0)), ((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((2, 0, 0), (0, 1, 0), (0, 0, F(1, 2))), ((1, 1, 0), (0, 1, 0), (0, 0, 1))))
        made.map = Map(rows, t)
    return made


class Tree:
    """An operation over parts, or a leaf; with `inverse` and a map of its own."""

    def __init__(self, rng, leaves, deep=0):
        self.map, self.inverse, self.leaf, self.parts = IDENTITY, False, None, []
        if leaves == 1:
            self.leaf = leaf(rng)
            return
        self.word = rng.choice(("merge", "intersection", "difference", "union") if deep else ("merge", "intersection", "difference"))
        cuts = sorted(rng.sample(range(1, leaves), rng.randint(1, min(3, leaves - 1))))
        for a, b in zip([0, *cuts], [*cuts, leaves]):
            self.parts.append(Tree(rng, b - a, deep + 1))
        if deep and rng.random() < 0.2:
            # The same part once more: whole trees coincide.
            self.parts.append(self.parts[0])
        self.inverse = rng.random() < 0.15
        if rng.random() < 0.2:
            self.map = Map(((0, 0, 1), (1, 0, 0), (0, 1, 0)), tuple(half(rng) for _ in range(3)))

    def sdl(self):
        if self.leaf:
            return self.leaf.sdl()
        parts = "\n".join(p.sdl() for p in self.parts)
        return f"{self.word} {{ {parts} {'inverse' if self.inverse else ''} {self.map.sdl()} }}"

    def leaves(self):
        return [self.leaf] if self.leaf else [l for p in self.parts for l in p.leaves()]

    def inside(self, ray, outer, ends):
        """The regularised set on the line; all ends of leaves go to `ends`. Raises where the line lies in a surface."""
        if self.leaf:
            answer = self.leaf.answer(ray[:3], ray[3:], outer.after(self.leaf.map))
            if answer.within:
                raise Degenerate
            found = union([answer.inside])
            ends.extend(x for part in found for x in part if x is not None)
            return found
        inner = outer.after(self.map)
        sets = [p.inside(ray, inner, ends) for p in self.parts]
        if self.word == "difference":
            sets = [sets[0]] + [union([complement(s)]) for s in sets[1:]]
        if self.word in ("merge", "union"):
            result = union(sets)
        else:
            result = union([complement(union([complement(s) for s in sets]))])
        return union([complement(result)]) if self.inverse else result


class Degenerate(Exception):
    """The line lies within a face: the rules leave freedom."""


def make_ray(rng):
    start = [float(half(rng, -8, 8)) / 2 for _ in range(3)]
    style = rng.randrange(4)
    if style == 0:
        i, s = rng.randrange(3), rng.choice((-1.0, 1.0))
        d = [s * (i == j) for j in range(3)]
        return [a - 16 * b for a, b in zip(start, d)] + d
    aim = [float(half(rng)) for _ in range(3)] if style < 3 else [rng.uniform(-2, 2) for _ in range(3)]
    if style == 1:
        start = [rng.uniform(-9, 9) for _ in range(3)]
    d = [a - b for a, b in zip(aim, start)]
    return start + (d if any(d) else [1.0, 0.0, 0.0])


CLOSE = F(1, 1 << 36)


def is_close(ends):
    """Whether different ends are so near to each other that enclosures may overlap."""
    numbers = sorted(((e.rational(), e) for e in ends), key=lambda x: x[0])
    for (a, x), (b, y) in zip(numbers, numbers[1:]):
        if b - a <= CLOSE * (1 + abs(a)) and x.cmp(y) != 0:
            return True
    return False


def expected_of(tree, ray):
    ends = []
    inside = tree.inside(ray, IDENTITY, ends)
    if is_close(ends):
        raise Degenerate
    crossings = []
    for lo, hi in inside:
        crossings += [(x, s) for x, s in ((lo, -1), (hi, 1)) if x is not None and x.cmp(0.0) >= 0]
    return crossings


def check(durer, rng, count, folder, show):
    tree = Tree(rng, rng.randint(2, 9))
    words = tree.sdl()
    file, rays_file, out = folder / "scene.pov", folder / "rays.npy", folder / "hits.npz"
    file.write_text(words + "\n")
    rays = [make_ray(rng) for _ in range(count)]
    np.save(rays_file, np.array(rays, dtype="<f8"))
    found = trace(durer, file, rays_file, "all", out, threads=1)
    for isa in ("reference", "avx2"):
        again = trace(durer, file, rays_file, "all", out, isa, 2)
        if any(found[k].tobytes() != again[k].tobytes() for k in found):
            raise Wrong(f"other bits with {isa}\n{words}")
    closest = trace(durer, file, rays_file, "closest", out)
    hit = trace(durer, file, rays_file, "any", out)["hit"]
    at, checked, wrong = found["offsets"].astype(int), 0, 0
    leaves = len(tree.leaves())
    for i, ray in enumerate(rays):
        rows = range(at[i], at[i + 1])
        problem = None
        if hit[i] != (len(rows) > 0):
            problem = "any disagrees with all"
        elif rows and any(closest[k][i].tobytes() != found[k][rows[0]].tobytes() for k in COLUMNS):
            problem = "closest is not the first of all"
        else:
            try:
                expected = expected_of(tree, ray)
            except Degenerate:
                continue
            crossed = [j for j in rows if found["sign"][j] != 0]
            checked += len(expected)
            if len(crossed) != len(expected):
                problem = f"{len(crossed)} crossings, expected {len(expected)}"
            for j, (t, s) in zip(crossed, expected):
                if found["sign"][j] != s:
                    problem = "wrong sign"
                elif t.cmp(float(found["t_lo"][j])) < 0 or t.cmp(float(found["t_hi"][j])) > 0:
                    problem = "exact t outside the bracket"
                elif found["object"][j] != 0 or found["primitive"][j] >= leaves:
                    problem = "wrong name"
                elif np.dot(found["normal"][j], ray[3:]) * s < -1e-9:
                    problem = "the normal does not point out"
        if problem:
            wrong += 1
            if show > 0:
                show -= 1
                told = [(float(found["t"][j]), int(found["sign"][j])) for j in rows]
                print(f"{problem}\n{words}\n  ray {ray}\n  found    {told}\n  expected {[(float(t), s) for t, s in expected]}")
    return checked, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--durer", type=Path, default=Path(__file__).parents[2] / "target/release/durer")
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--rays", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", type=int, default=2)
    args = parser.parse_args()
    crossings = violations = 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(args.scenes):
            rng = random.Random(f"csg/{args.seed}/{i}")
            try:
                c, w = check(args.durer, rng, args.rays, Path(folder), args.show)
            except (Wrong, subprocess.TimeoutExpired) as wrong:
                print(wrong)
                c, w = 0, 1
            crossings, violations = crossings + c, violations + w
    print(f"{args.scenes} trees, {crossings} crossings, {violations} violations")
    return 1 if violations or crossings < args.scenes else 0


if __name__ == "__main__":
    sys.exit(main())
