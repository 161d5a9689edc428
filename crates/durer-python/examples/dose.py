"""Attenuation along the chords of overlapping bodies: a beam through water with a bone and an air gap.

    python dose.py            prints transmissions and writes dose.png, the shadow of the beam
"""

import numpy as np

import durer

# Each with its attenuation, in addition to what holds it.
BODIES = [
    (durer.Cylinder((0, 0, -10), (0, 0, 10), 6), 0.2),
    (durer.Cylinder((2, 0, -10), (2, 0, 10), 1), 0.3),
    (durer.Sphere((-2, 1, 0), 1.5), -0.2),
]

if __name__ == "__main__":
    scene = durer.Scene([body for body, _ in BODIES])
    rates = np.array([rate for _, rate in BODIES])
    camera = durer.Camera((0, -30, 0), (0, 0, 0), up=(0, 0, 1), orthographic=16.0, width=320, height=320)
    lengths = durer.chord_lengths(scene, camera.rays()).lengths()
    transmitted = np.exp(-lengths @ rates).reshape(camera.height, camera.width)
    print(f"least {transmitted.min():.4f}, through the middle {transmitted[160, 160]:.4f}")
    np.repeat(transmitted[:, :, None], 3, axis=2).view(durer.Picture).save("dose.png")
