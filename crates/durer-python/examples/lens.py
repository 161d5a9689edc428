"""Where does a plano-convex lens focus? Parallel rays, refracted twice by Snell's law at the exact surfaces.

    python lens.py            prints the focal length and writes lens.png, the lens as a picture
"""

import numpy as np

import durer

INDEX, RADIUS = 1.5, 50.0
# Flat at z = 0, curved towards +z.
LENS = durer.Sphere((0, 0, 5 - RADIUS), RADIUS) & durer.Box((-20, -20, 0), (20, 20, 10))
SCENE = durer.Scene([LENS])


def refracted(directions, normals, ratio):
    """Snell's law for unit vectors; the normal points against the direction."""
    cosine = -(directions * normals).sum(axis=1, keepdims=True)
    root = np.sqrt(1 - ratio**2 * (1 - cosine**2))
    return ratio * directions + (ratio * cosine - root) * normals


def trace(heights):
    """Where rays at these heights, parallel to the axis, meet it behind the lens."""
    rays = np.zeros((len(heights), 6))
    rays[:, 0], rays[:, 2], rays[:, 5] = heights, -10, 1
    entry = SCENE.closest(rays)
    inside = refracted(rays[:, 3:], entry.normal, 1 / INDEX)
    # From the entry to the exit: all crossings of the line, and of those the one where it leaves.
    hits = SCENE.all(entry.position, inside)
    leaving = hits.sign > 0
    outside = refracted(inside, -hits.normal[leaving], INDEX)
    return hits.position[leaving][:, 2] - hits.position[leaving][:, 0] * outside[:, 2] / outside[:, 0]


if __name__ == "__main__":
    heights = np.array([0.01, 1, 2, 4, 8])
    for height, focus in zip(heights, trace(heights)):
        print(f"ray at {height:5.2f} meets the axis at z = {focus:.6f}")
    print(f"thin-lens formula: {5 + RADIUS / (INDEX - 1):.6f}")
    glass = durer.Texture((1, 1, 1), filter=0.9, diffuse=0.1, phong=0.5, refraction=INDEX)
    floor = durer.Plane((0, 1, 0), -20).with_texture(durer.Texture((0.7, 0.5, 0.3)))
    scene = durer.Scene([LENS.with_texture(glass), floor], lights=[durer.Light((100, 200, 100))], background=(0.3, 0.4, 0.6))
    durer.render(scene, durer.Camera((60, 30, 60), (0, -5, 0), width=480, height=360)).save("lens.png")
