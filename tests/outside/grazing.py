#!/usr/bin/env python3
"""How near to a tangent two crossings are still told apart: prints figures, checks nothing.

Rays that meet a surface squarely give points and normals. From each point a ray goes along a random tangent, moved into the solid by `delta`: it
enters and leaves within some `2 sqrt(2 delta)` of each other. Printed is the share of rays with a crossing that is not simple (a cluster or a grazing
one), by `delta` and by how far away the rays start; solids are about 1 in size, as written and in a random shear.

    grazing.py [--durer PATH] [--rays N] [--seed N] [KIND ...]
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np

OUTLINE = "<-1,-0.6>,<0.5,-1>,<0.9,0.7>,<-0.8,0.9>,<-1,-0.6>,<0.5,-1>,<0.9,0.7>"
KINDS = {
    "sphere": "sphere { 0, 1",
    "torus": "torus { 1, 0.3",
    "quartic": "polynomial { 4, xyz(4,0,0): 1, xyz(0,4,0): 1, xyz(0,0,4): 1, xyz(0,0,0): -1",
    "sextic": "polynomial { 6, xyz(6,0,0): 1, xyz(0,6,0): 1, xyz(0,0,6): 1, xyz(0,0,0): -1",
    "sor": "sor { 5, <0,-1>, <0.6,-0.5>, <0.4,0>, <0.8,0.5>, <0,1> open",
    "ovus": "ovus { 0.8, 0.5",
    "lemon": "lemon { <0,-1,0>, 0.3, <0,1,0>, 0.2, 1.5",
    "prism": f"prism {{ linear_sweep cubic_spline -1, 1, 7, {OUTLINE}",
    "conic_prism": f"prism {{ conic_sweep cubic_spline 0.4, 1, 7, {OUTLINE}",
    "blob": "blob { threshold 0.6 sphere { <-0.4,0,0>, 1, 1 } sphere { <0.4,0.1,0>, 1, 1 }",
    "blob_cylinder": "blob { threshold 0.6 cylinder { <-0.4,0,0>, <0.5,0.3,0.2>, 0.8, 1 } sphere { <0.4,0.1,0.5>, 1, -0.6 }",
    "superellipsoid": "superellipsoid { <0.25, 0.25>",
    "superellipsoid_star": "superellipsoid { <2.5, 1>",
    "isosurface": "isosurface { function { x*x + y*y + 1.5*z*z + 0.3*sin(3*x)*cos(2*y) - 0.8 } contained_by { box { -1.3, 1.3 } }",
    "julia": "julia_fractal { <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 8",
}
DELTAS = [10.0**-k for k in (4, 6, 8, 10, 11, 12, 13, 14, 15)]
DISTANCES = (3.0, 1e3, 1e6)


def trace(durer, scene, rays, folder):
    np.save(folder / "rays.npy", rays)
    told = folder / "hits.npz"
    subprocess.run([durer, "trace", scene, "--rays", folder / "rays.npy", "--query", "all", "-o", told], check=True)
    return np.load(told)


def rays_of(origin, direction):
    rays = np.zeros((len(origin), 8))
    rays[:, :3], rays[:, 3:6], rays[:, 7] = origin, direction, np.inf
    return rays


def examine(durer, text, placement, n, rng, folder):
    """Shares by distance and delta."""
    matrix, centre = placement
    numbers = ", ".join(repr(float(x)) for x in (*matrix.ravel(), *centre))
    scene = folder / "scene.pov"
    scene.write_text(f"#version 3.7; global_settings {{ assumed_gamma 1 }}\n{text} matrix <{numbers}> }}\n")
    origin = centre + 4.0 * rng.normal(size=(2 * n, 3))
    hits = trace(durer, scene, rays_of(origin, centre + 0.5 * rng.normal(size=(2 * n, 3)) - origin), folder)
    simple = np.flatnonzero(hits["kind"] == 0)
    chosen = rng.choice(simple, n)
    point, normal = hits["position"][chosen], hits["normal"][chosen]
    shares = []
    for distance in DISTANCES:
        for delta in DELTAS:
            along = np.cross(normal, rng.normal(size=point.shape))
            along /= np.linalg.norm(along, axis=1)[:, None]
            kinds = trace(durer, scene, rays_of(point - delta * normal - distance * along, along), folder)["kind"]
            shares.append(np.count_nonzero(kinds) / n)
    return np.reshape(shares, (len(DISTANCES), len(DELTAS)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--durer", default="target/release/durer")
    parser.add_argument("--rays", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    unknown = [kind for kind in args.kinds if kind not in KINDS]
    if unknown:
        parser.error(f"no such kind: {unknown[0]}")
    rng = np.random.default_rng(args.seed)
    print("delta".ljust(40) + "".join(f"{delta:8.0e}" for delta in DELTAS))
    with tempfile.TemporaryDirectory() as name:
        for kind in args.kinds or KINDS:
            shear = np.linalg.qr(rng.normal(size=(3, 3)))[0] @ (np.eye(3) + 0.4 * rng.normal(size=(3, 3)))
            for how, placement in (("as written", (np.eye(3), np.zeros(3))), ("sheared", (shear, 3.0 * rng.normal(size=3)))):
                shares = examine(args.durer, KINDS[kind], placement, args.rays, rng, Path(name))
                for distance, row in zip(DISTANCES, shares):
                    title = f"{kind}, {how}, from {distance:g}"
                    print(title.ljust(40) + "".join(f"{share:8.3f}" for share in row), flush=True)


if __name__ == "__main__":
    main()
