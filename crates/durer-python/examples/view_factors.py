"""View factors of an open can: base, wall and opening, beside the closed form.

    python view_factors.py
"""

import math

import numpy as np

import durer

RADIUS, HEIGHT = 1.0, 2.0

if __name__ == "__main__":
    names = ["base", "wall", "opening"]
    surfaces = [
        durer.Disc((0, 0, 0), (0, 0, 1), RADIUS),
        durer.Cylinder((0, 0, 0), (0, 0, HEIGHT), RADIUS).without_caps(),
        durer.Disc((0, 0, HEIGHT), (0, 0, 1), RADIUS),
    ]
    found = durer.view_factors(surfaces, sides=["front", "back", "back"], samples=400_000)
    np.set_printoptions(precision=5, suppress=True)
    for name, row, error in zip(names, found.factors, found.standard_errors):
        print(f"{name:8}", row, "+-", error)
    x = 2 + (HEIGHT / RADIUS) ** 2
    print(f"base to opening, closed form: {(x - math.sqrt(x * x - 4)) / 2:.5f}")
