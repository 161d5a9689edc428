"""The wall thickness of a part at points all over its surface.

    python thickness.py [MESH]       a mesh file, or a block with a hole that is off its middle
"""

import sys

import numpy as np

import durer

PART = durer.Cylinder((0, 0, 0), (0, 0, 4), 2) - durer.Cylinder((0.6, 0, -1), (0.6, 0, 5), 1.2)

if __name__ == "__main__":
    part = durer.read_mesh(sys.argv[1]) if len(sys.argv) > 1 else PART
    scene = durer.Scene([part])
    centre, size = scene.bounds.mean(axis=0), np.linalg.norm(np.diff(scene.bounds, axis=0)) / 2
    # Uniform random lines meet the surface in proportion to its area.
    hits = scene.all(durer.random_lines(centre, size, 50_000))
    crossing = hits.sign != 0
    thick = durer.thickness(scene, hits.position[crossing], hits.normal[crossing])
    print(f"{crossing.sum()} points of the surface; thinnest {np.nanmin(thick):.4f}, median {np.nanmedian(thick):.4f}")
    thin = hits.position[crossing][np.nanargmin(thick)]
    print("thinnest at", thin.round(3))
