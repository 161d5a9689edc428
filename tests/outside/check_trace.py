#!/usr/bin/env python3
"""Examines `durer trace` from outside, against exact arithmetic.

Random scenes of one surface (and some unions), rays aimed at silhouettes, rims, edges, vertices, apexes, axes and generators, from near, inside,
on the surface and far, with directions and ranges of all sizes. Every crossing has to be there once, with its sign and a bracket that holds
the exact parameter; the four queries, any number of threads and all instruction sets have to agree. See README.md.

    check_trace.py [--durer PATH] [--scenes N] [--rays N] [--seed N] [--kind NAME]... [--keep DIR]
"""

import argparse
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import scenes
from command import COLUMNS, MISS, SPANS, Wrong, check_layout, same_bits, trace
from comparison import Report, check_ray, check_spans
from rays import make_ray

INF = float("inf")


def check_scene(report, durer, scene, rng, count, folder):
    file, rays_file, out = folder / "scene.pov", folder / "rays.npy", folder / "hits.npz"
    file.write_text(scene.words)
    for leaves in scene.objects:
        for name, data in (item for leaf in leaves for item in getattr(leaf, "files", {}).items()):
            (folder / name).write_bytes(data)
    leaves = [leaf for object_ in scene.objects for leaf in object_]
    ranges = rng.random() < 0.6
    rays = [make_ray(rng, rng.choice(leaves), ranges) for _ in range(count)]
    array = np.array(rays, dtype="<f8")[:, : 8 if ranges else 6]
    np.save(rays_file, np.asfortranarray(array) if rng.random() < 0.3 else array)
    try:
        found = trace(durer, file, rays_file, "all", out, threads=1)
        hits = len(found.get("t", ()))
        length = {"offsets": count + 1, "sign": hits, **{c: hits for c in COLUMNS}}
        check_layout(found, {"offsets": ("<u8", ()), "sign": ("|i1", ()), **COLUMNS}, length)
        others = [(None, 2), ("reference", 1), ("avx2", 1)]
        for isa, threads in others:
            if not same_bits(found, trace(durer, file, rays_file, "all", out, isa, threads)):
                report.add(f"other bits with isa={isa} threads={threads}", scene, None, "", "")
        unfused = trace(durer, file, rays_file, "all", out, "unfused", 1)
        if any(not np.array_equal(found[k], unfused[k]) for k in ("offsets", "object", "sign", "kind")):
            report.add("unfused decides otherwise", scene, None, "", "")
        closest = trace(durer, file, rays_file, "closest", out)
        check_layout(closest, COLUMNS, count)
        anyhit = trace(durer, file, rays_file, "any", out)
        check_layout(anyhit, {"hit": ("|b1", ())}, count)
        spans = trace(durer, file, rays_file, "spans", out)
        check_layout(spans, {"offsets": ("<u8", ()), **SPANS}, {"offsets": count + 1, **{c: len(spans.get("t_in", ())) for c in SPANS}})
    except Wrong as wrong:
        refusal = re.search(r"[^:\n]*not supported yet", str(wrong))
        if refusal:
            report.counted[f"refused by name: {refusal[0].strip()}"] += 1
        else:
            report.add(str(wrong), scene, None, "", "")
        return
    except subprocess.TimeoutExpired:
        report.add("no answer within two minutes", scene, None, "", "")
        return
    at, span_at = found["offsets"].astype(int), spans["offsets"].astype(int)
    for offsets, n in ((at, hits), (span_at, len(spans["t_in"]))):
        if offsets[0] != 0 or offsets[-1] != n or (np.diff(offsets) < 0).any():
            report.add("offsets are not ascending from 0 to the number of rows", scene, None, "", "")
            return
    check_queries_agree(report, scene, rays, found, at, closest, anyhit["hit"])
    lines, line_at = found, at
    if ranges and not all(getattr(leaf, "certain", True) and getattr(leaf, "exact_ends", True) for leaf in leaves):
        array[:, 6:] = -INF, INF
        np.save(rays_file, array)
        lines = trace(durer, file, rays_file, "all", out)
        line_at = lines["offsets"].astype(int)
    row = lambda arrays, j: {k: arrays[k][j] for k in (*COLUMNS, "sign")}
    widths = []
    for i, ray in enumerate(rays):
        report.rays += 1
        rows = [row(found, j) for j in range(at[i], at[i + 1])]
        on_the_line = [row(lines, j) for j in range(line_at[i], line_at[i + 1])]
        expected, pairs = check_ray(report, scene, ray, rows, on_the_line, widths)
        stretches = [tuple(spans[k][j] for k in SPANS) for j in range(span_at[i], span_at[i + 1])]
        check_spans(report, scene, ray, expected, pairs, stretches)
    report.widths[scene.kind] += widths
    most = 100 if all(getattr(leaf, "certain", True) for leaf in leaves) else 1000
    if len(widths) >= 30 and np.median(widths) >= most:
        report.add(f"median bracket width of {most} ulp or more", scene, None, f"< {most}", float(np.median(widths)))


def check_queries_agree(report, scene, rays, found, at, closest, anyhit):
    """closest is the first of all, any says whether there is one: bit for bit."""
    for i, ray in enumerate(rays):
        some = at[i + 1] > at[i]
        if bool(anyhit[i]) != bool(some):
            report.add("any differs from all", scene, ray, bool(some), bool(anyhit[i]))
        for name in COLUMNS:
            wanted = found[name][at[i]] if some else np.full(closest[name][i].shape, MISS[name], closest[name].dtype)
            if closest[name][i].tobytes() != wanted.tobytes() and not (not some and np.isnan(wanted).all() and np.isnan(closest[name][i]).all()):
                report.add(f"closest differs from the first of all in {name}", scene, ray, wanted, closest[name][i])


def check_refusals(report, durer, folder):
    """Arrays of another type or shape: exit code 1, a message that names both, no output."""
    scene = scenes.Scene("sphere { 0, 1 }\n", [], "arrays")
    (folder / "s.pov").write_text(scene.words)
    good = np.array([[0, 0, -3, 0, 0, 1]] * 4, dtype="<f8")
    bad = [
        (good.astype("<f4"), ("f4", "(4, 6)")), (good.astype(">f8"), (">f8", "(4, 6)")), (good.astype("<i8"), ("i8", "(4, 6)")),
        (good[:, :5], ("f8", "(4, 5)")), (np.zeros((4, 7)), ("f8", "(4, 7)")), (good[0], ("f8", "(6,)")), (np.zeros((2, 2, 6)), ("f8", "(2, 2, 6)")),
        (np.zeros(()), ("f8", "()")), (good.astype("<c16"), ("c16", "(4, 6)")), (np.zeros((4, 6), "?"), ("b1", "(4, 6)")),
    ]
    for array, words in bad:
        np.save(folder / "r.npy", array)
        out = folder / "refused.npz"
        done = subprocess.run([durer, "trace", folder / "s.pov", "--rays", folder / "r.npy", "-o", out], capture_output=True, text=True)
        if done.returncode != 1 or any(w not in done.stderr for w in words) or out.exists():
            report.add("refusal of an array", scene, None, f"exit 1, a message with {words}, no output", f"exit {done.returncode}: {done.stderr!r}")
    np.save(folder / "r.npy", np.zeros((0, 6)))
    for query in ("all", "closest", "any", "spans"):
        try:
            trace(durer, folder / "s.pov", folder / "r.npy", query, folder / "o.npz")
        except Wrong as wrong:
            report.add(f"no rays at all, {query}: {wrong}", scene, None, "", "")
    check_odd_rays(report, durer, folder, scene)


def check_odd_rays(report, durer, folder, scene):
    """Rays that cannot meet anything miss; ranges are closed."""
    nan = math.nan
    rows = [
        (0, 0, -3, 0, 0, 1, 0, INF, 2), (0, 0, -3, 0, 0, 0, 0, INF, 0), (nan, 0, -3, 0, 0, 1, 0, INF, 0), (0, 0, -3, 0, INF, 1, 0, INF, 0),
        (0, 0, -INF, 0, 0, 1, 0, INF, 0), (0, 0, -3, 0, 0, 1, 5, 1, 0), (0, 0, -3, 0, 0, 1, nan, INF, 0), (0, 0, -3, 0, 0, 1, 0, nan, 0),
        (0, 0, -3, 0, 0, 1, 2, 4, 2), (0, 0, -3, 0, 0, 1, 2, 2, 1), (0, 0, -3, 0, 0, 1, 2.5, 3.5, 0), (0, 0, -1, 0, 0, 1, 0, INF, 2),
        (0, 0, 3, 0, 0, 1, -INF, 0, 2), (0, 0, 3, 0, 0, 1, -INF, INF, 2), (0, 0, 1, 0, 0, 1, 0, INF, 1), (0, 0, -3, 0, 0, 1, INF, INF, 0),
        (0, 0, -1, -0.0, -0.0, 1, -0.0, INF, 2), (1, 0, 0, 0, 1, 0, 0, INF, 1), (1, 0, 0, 0, 1, 0, 0, 0, 1),
    ]
    np.save(folder / "r.npy", np.array([r[:8] for r in rows], dtype=float))
    found = trace(durer, folder / "s.pov", folder / "r.npy", "all", folder / "o.npz")
    for row, n in zip(rows, np.diff(found["offsets"].astype(int))):
        if n != row[8]:
            report.add("count of an odd ray", scene, row[:8], row[8], int(n))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--durer", type=Path, default=Path(__file__).parents[2] / "target/release/durer")
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--rays", type=int, default=150, help="rays for each scene")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", action="append", choices=[*scenes.MAKERS, "union"])
    parser.add_argument("--show", type=int, default=2, help="examples to print for each kind of mistake")
    args = parser.parse_args()
    report = Report()
    kinds = args.kind or [*scenes.USUAL, "union"]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        check_refusals(report, args.durer, folder)
        for i in range(args.scenes):
            rng = random.Random(f"{args.seed}/{i}")
            kind = kinds[i % len(kinds)]
            scene = scenes.union_scene(rng) if kind == "union" else scenes.single(rng, kind)
            check_scene(report, args.durer, scene, rng, args.rays, folder)
    for (kind, what), n in sorted(report.wrong.items()):
        print(f"\n== {kind}: {what}: {n} times")
        for words, ray, expected, got in report.examples[kind, what][: args.show]:
            print(words.strip())
            print("  ray     ", None if ray is None else ", ".join(repr(float(x)) for x in ray))
            print("  expected", expected)
            print("  got     ", got)
    print(f"\n{report.rays} rays, {report.hits} crossings, {report.spans} spans; median width of simple brackets in ulp: "
          + ", ".join(f"{k} {np.median(w):.1f}" for k, w in sorted(report.widths.items()) if w))
    for what, n in [*report.counted.items(), *((f"{kind}: clusters", n) for kind, n in report.clusters.items())]:
        print(f"note: {what}: {n} times")
    print(f"{sum(report.wrong.values())} violations")
    return 1 if report.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
