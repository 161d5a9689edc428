"""A LiDAR scan of a room with a column, and a picture of it from above.

    python lidar.py           prints what was seen and writes lidar.png
"""

import numpy as np

import durer

ROOM = durer.Box((-5, -4, 0), (5, 4, 3)) - durer.Cylinder((2, 1, -1), (2, 1, 4), 0.3)


def image(points, size=400):
    """The points from above, brighter where there are more."""
    edges = np.linspace(-6, 6, size + 1)
    counts, _, _ = np.histogram2d(-points[:, 1], points[:, 0], bins=[edges, edges])
    light = np.minimum(counts / 4, 1.0)
    return np.repeat(light[::-1, :, None], 3, axis=2).view(durer.Picture)


if __name__ == "__main__":
    pose = np.hstack([durer.rotation((0, 0, 1), 0.3), [[-1], [-1], [1.2]]])
    scan = durer.lidar(ROOM, pose, durer.lidar_pattern(1800, 32), noise=0.005)
    print(scan)
    print(f"nearest {scan.ranges.min():.3f}, farthest {scan.ranges.max():.3f}, bound {scan.range_errors.max():.1e}")
    image(scan.points[scan.hit]).save("lidar.png")
