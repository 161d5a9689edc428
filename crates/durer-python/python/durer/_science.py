"""Measurements with rays: volumes, areas, view factors, thickness, chords, scans. What is estimated comes with its standard error.

Uniform random lines through a ball around a body do the work (M. W. Crofton, "On the theory of local probability",
Philosophical Transactions 158, 1868; L. A. Santalo, *Integral Geometry and Geometric Probability*, 1976): they meet a surface in
proportion to its area, at directions that are distributed as the cosine, so the crossings of one batch of lines are a uniform
sample of every surface at once, with Lambert's directions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Floats, Ints, matrix, real_array, table, vector
from ._objects import Object
from ._results import Spans
from ._scene import Scene

Body = Scene | Object | Iterable[Object]


def _scene(body: Body) -> Scene:
    if isinstance(body, Scene):
        return body
    return Scene((body,) if isinstance(body, Object) else body)


@dataclass(frozen=True)
class Estimate:
    """A value with its standard error.

    Examples
    --------
    >>> import durer
    >>> durer.Estimate(4.19, 0.01)
    4.19 +- 0.01
    """

    value: float
    standard_error: float

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"{self.value:.6g} +- {self.standard_error:.2g}"


def random_lines(centre: npt.ArrayLike, radius: float, count: int, seed: int = 0) -> Floats:
    """Uniform random lines through a ball, as rays (count, 6) that start on its far side, with directions of length 1.

    Every line is as likely as any other, and they are independent. The same seed gives the same lines.

    Examples
    --------
    >>> import durer
    >>> durer.random_lines((0, 0, 0), 1, 1000).shape
    (1000, 6)
    """
    middle = np.asarray(vector(centre, "centre"))
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    # A frame across each line.
    side = np.where(np.abs(direction[:, :1]) < 0.8, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    u = np.cross(direction, side)
    u /= np.linalg.norm(u, axis=1)[:, None]
    v = np.cross(direction, u)
    r = radius * np.sqrt(rng.uniform(size=count))
    angle = rng.uniform(0, 2 * math.pi, count)
    origin = middle + u * (r * np.cos(angle))[:, None] + v * (r * np.sin(angle))[:, None]
    return np.hstack([origin - direction * (2.0 * radius), direction])


def _ball(scene: Scene, name: str) -> tuple[Floats, float]:
    bounds = scene.bounds
    if not np.isfinite(bounds).all():
        raise ValueError(f"{name}: something here has no end; intersect it with a box")
    centre: Floats = bounds.mean(axis=0)
    # The bounds hold everything; their half diagonal with a little more, for the roundings of the lines.
    return centre, float(np.linalg.norm(bounds[1] - bounds[0])) / 2 * (1 + 1e-9)


def _mean(values: Floats, scale: float) -> Estimate:
    count = len(values)
    if count < 2:
        raise ValueError("samples: at least 2 are needed")
    return Estimate(float(values.mean()) * scale, float(values.std(ddof=1)) / math.sqrt(count) * scale)


def _count(samples: int) -> int:
    count = int(samples)
    if count < 2:
        raise ValueError(f"samples: at least 2 are needed, got {samples}")
    return count


def volume(body: Body, *, samples: int = 100_000, seed: int = 0, threads: int | None = None) -> Estimate:
    """The volume of the union of all solids, from the lengths of random lines inside.

    Parameters
    ----------
    body : Scene, Object or several objects
    samples : int
        How many lines.
    seed : int
        The same seed gives the same lines.

    Examples
    --------
    >>> import durer, math
    >>> found = durer.volume(durer.Sphere((0, 0, 0), 1))
    >>> abs(found.value - 4 / 3 * math.pi) < 5 * found.standard_error < 0.2
    True
    """
    scene = _scene(body)
    centre, radius = _ball(scene, "volume")
    lines = random_lines(centre, radius, _count(samples), seed)
    # A line of a direction stands for the area of the disc across it.
    return _mean(scene.spans(lines, threads=threads).totals(), math.pi * radius**2)


def area(body: Body, *, samples: int = 100_000, seed: int = 0, threads: int | None = None) -> Estimate:
    """The area of all surfaces, from the number of their crossings with random lines; a sheet counts once.

    Examples
    --------
    >>> import durer
    >>> found = durer.area(durer.Box((0, 0, 0), (1, 1, 1)))
    >>> abs(found.value - 6) < 5 * found.standard_error < 0.2
    True
    """
    scene = _scene(body)
    centre, radius = _ball(scene, "area")
    lines = random_lines(centre, radius, _count(samples), seed)
    hits = scene.all(lines, threads=threads)
    # A touch has no area.
    counts = np.bincount(hits.ray[hits.sign != 0], minlength=len(lines)).astype(np.float64)
    return _mean(counts, 2.0 * math.pi * radius**2)


@dataclass(frozen=True)
class ViewFactors:
    """View factors between the objects of a scene.

    Attributes
    ----------
    factors : float64 (n, n)
        ``factors[i, j]``: the share of what leaves object i that arrives at object j directly.
    standard_errors : float64 (n, n)
    escaped : float64 (n,)
        The share that arrives nowhere.
    areas : float64 (n,)
        Areas of the sides that radiate.
    area_errors : float64 (n,)
        Their standard errors.
    counts : int64 (n,)
        How many samples left each object.

    Examples
    --------
    >>> import durer
    >>> durer.view_factors([durer.Sphere((0, 0, 0), 1), durer.Sphere((5, 0, 0), 1)], samples=1000)
    <ViewFactors of 2 objects from 1286 samples>
    """

    factors: Floats
    standard_errors: Floats
    escaped: Floats
    areas: Floats
    area_errors: Floats
    counts: Ints

    def __repr__(self) -> str:
        return f"<ViewFactors of {len(self.areas)} objects from {int(self.counts.sum())} samples>"


def view_factors(
    body: Body,
    *,
    samples: int = 100_000,
    sides: str | Iterable[str] = "front",
    sources: Iterable[int] | None = None,
    seed: int = 0,
    threads: int | None = None,
) -> ViewFactors:
    """View factors between all objects: the share of the diffuse radiation of one that arrives at another directly.

    Parameters
    ----------
    body : Scene, Object or several objects
        Each object is one surface; objects are opaque.
    samples : int
        How many random lines for each object; each crossing is a sample.
    sides : "front", "back" or "both", or one of them for each object
        Which side radiates: the one where normals point (the outside of solids), the other, or both.
    sources : numbers of objects, optional
        Only what leaves these is found; the rows of others are NaN. An object without end arrives, but cannot be a source.

    Returns
    -------
    ViewFactors
        With the standard error of each factor.

    Examples
    --------
    The inner of two concentric spheres sees the outer one only; the outer one sees it by the ratio of areas.

    >>> import durer
    >>> spheres = [durer.Sphere((0, 0, 0), 1), durer.Sphere((0, 0, 0), 2)]
    >>> found = durer.view_factors(spheres, sides=["front", "back"])
    >>> float(found.factors[0, 1]), bool(abs(found.factors[1, 0] - 0.25) < 5 * found.standard_errors[1, 0] < 0.1)
    (1.0, True)
    """
    scene = _scene(body)
    count, lines = scene.object_count, _count(samples)
    wanted = [sides] * count if isinstance(sides, str) else list(sides)
    if len(wanted) != count:
        raise ValueError(f"sides: one for each of {count} objects is needed, got {len(wanted)}")
    for side in wanted:
        if side not in ("front", "back", "both"):
            raise ValueError(f"sides: 'front', 'back' or 'both' is needed, got {side!r}")
    chosen = list(range(count)) if sources is None else [int(i) for i in sources]
    if any(not 0 <= i < count for i in chosen):
        raise ValueError(f"sources: numbers of {count} objects are needed, got {chosen}")
    parts = scene._parts()
    factors, errors = np.full((count, count), np.nan), np.full((count, count), np.nan)
    left, areas, area_errors = np.zeros(count), np.full(count, np.nan), np.full(count, np.nan)
    for i in chosen:
        centre, radius = _ball(parts[i], "view_factors")
        # Sums over lines: what leaves and its squares; what arrives at each object, its squares, and its products with what leaves.
        leaves, left_squares = 0.0, 0.0
        arrives, squares, products = np.zeros(count), np.zeros(count), np.zeros(count)
        for done in range(0, lines, _PIECE):
            piece = min(lines - done, _PIECE)
            rays = random_lines(centre, radius, piece, seed=_seed(seed, i, done))
            hits = scene.all(rays, t_min=-np.inf, threads=threads)
            # A touch has no area.
            crossing = hits.sign != 0
            line, what, sign = hits.ray[crossing], hits.object[crossing], hits.sign[crossing]
            ahead, behind = _next(line, what, 1), _next(line, what, -1)
            # Where the line goes along the normal, what is ahead is in front.
            front, back = np.where(sign > 0, ahead, behind), np.where(sign > 0, behind, ahead)
            own = what == i
            shown = [front[own]] * (wanted[i] != "back") + [back[own]] * (wanted[i] != "front")
            target = np.concatenate(shown)
            line = np.tile(line[own], len(shown))
            by_line = np.bincount(line, minlength=piece).astype(np.float64)
            leaves += by_line.sum()
            left_squares += (by_line**2).sum()
            arrived = target >= 0
            keys, numbers = np.unique(line[arrived] * count + target[arrived], return_counts=True)
            there, weights = keys % count, numbers.astype(np.float64)
            arrives += np.bincount(there, weights, count)
            squares += np.bincount(there, weights**2, count)
            products += np.bincount(there, weights * by_line[keys // count], count)
        left[i] = leaves
        scale = 2.0 * math.pi * radius**2 / lines
        areas[i] = leaves * scale
        area_errors[i] = scale * math.sqrt(max(left_squares - leaves**2 / lines, 0.0))
        if leaves:
            share = arrives / leaves
            # A ratio of two means over lines: its variance to first order; where all or nothing arrived, one sample more or less.
            variance = np.maximum(squares - 2 * share * products + share**2 * left_squares, 1.0)
            factors[i], errors[i] = share, np.sqrt(variance) / leaves
    return ViewFactors(
        factors, errors, 1.0 - factors.sum(axis=1), areas, area_errors, left.astype(np.int64)
    )


#: Lines of one batch.
_PIECE = 1 << 18


def _seed(*numbers: int) -> int:
    """The seed of a batch: a function of these numbers alone."""
    return int(np.random.SeedSequence(numbers).generate_state(1, np.uint64)[0])


def _next(line: Ints, what: Ints, step: int) -> Ints:
    """The object of the next crossing (or the last one) of the same line, -1 for none."""
    result = np.full(len(line), -1)
    if len(line) > 1:
        same = line[1:] == line[:-1]
        if step > 0:
            result[:-1][same] = what[1:][same]
        else:
            result[1:][same] = what[:-1][same]
    return result


def overlaps(
    body: Body, *, samples: int = 100_000, seed: int = 0, threads: int | None = None
) -> tuple[Floats, Floats]:
    """The volumes that each two objects have in common.

    Returns
    -------
    volumes, standard_errors : float64 (n, n)
        The diagonal has the objects' own volumes. Open surfaces have none.

    Examples
    --------
    >>> import durer, math
    >>> found, error = durer.overlaps([durer.Sphere((0, 0, 0), 1), durer.Sphere((1, 0, 0), 1)])
    >>> bool(abs(found[0, 1] - 5 / 12 * math.pi) < 5 * error[0, 1] < 0.2)
    True
    """
    scene = _scene(body)
    centre, radius = _ball(scene, "overlaps")
    lines = random_lines(centre, radius, _count(samples), seed)
    chords = chord_lengths(scene, lines, threads=threads)
    count = scene.object_count
    means, errors = np.zeros((count, count)), np.zeros((count, count))
    scale = math.pi * radius**2
    for i in range(count):
        for j in range(i, count):
            lengths = _common(chords.of(i), chords.of(j)) if i != j else chords.of(i).totals()
            found = _mean(lengths, scale)
            means[i, j] = means[j, i] = found.value
            errors[i, j] = errors[j, i] = found.standard_error
    return means, errors


def _common(a: Spans, b: Spans) -> Floats:
    """The length that two lists of spans have in common, for each ray."""
    rays = len(a.offsets) - 1
    ray = np.concatenate([a.ray, a.ray, b.ray, b.ray])
    t = np.concatenate([a.t_in, a.t_out, b.t_in, b.t_out])
    step = np.concatenate([np.ones(len(a)), -np.ones(len(a)), np.ones(len(b)), -np.ones(len(b))])
    order = np.lexsort((step, t, ray))
    ray, t, depth = ray[order], t[order], np.cumsum(step[order])
    both = np.nonzero(depth == 2)[0]
    common = np.zeros(rays)
    np.add.at(common, ray[both], t[both + 1] - t[both])
    return common


@dataclass(frozen=True)
class Chords:
    """Where rays are inside each object: `of(i)` has the spans of object i.

    Examples
    --------
    >>> import durer
    >>> chords = durer.chord_lengths([durer.Sphere((0, 0, 0), 1)], [[0, 0, 5]], [[0, 0, -1]])
    >>> chords, chords.of(0).t_in
    (<Chords in 1 objects>, array([4.]))
    """

    spans: tuple[Spans, ...]

    def of(self, i: int) -> Spans:
        """The spans of the object with a number."""
        return self.spans[i]

    def lengths(self) -> Floats:
        """The length of each ray inside each object, in units of its direction: float64 (rays, objects)."""
        return np.stack([spans.totals() for spans in self.spans], axis=1)

    def __repr__(self) -> str:
        return f"<Chords in {len(self.spans)} objects>"


def chord_lengths(
    body: Body,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None = None,
    *,
    threads: int | None = None,
) -> Chords:
    """Where each ray is inside each object, which may overlap: for doses along chords, say.

    Arguments are those of `Scene.closest`.

    Examples
    --------
    >>> import durer
    >>> bodies = [durer.Sphere((0, 0, 0), 2), durer.Sphere((0, 0, 0), 1)]
    >>> durer.chord_lengths(bodies, [[0, 0, -5]], [[0, 0, 1]]).lengths()
    array([[4., 2.]])
    """
    scene = _scene(body)
    spans = scene.spans(origins, directions, by="object", threads=threads)
    return Chords(tuple(spans.of(i) for i in range(scene.object_count)))


def thickness(
    body: Body, points: npt.ArrayLike, normals: npt.ArrayLike, *, threads: int | None = None
) -> Floats:
    """How thick the solids are below points of their surface: the length of the first span inside, against the outward normal.

    Parameters
    ----------
    points, normals : arrays (n, 3)
        Points on (or next to) the surface, and directions out of the solid of any length: the answer is in units of the scene.

    Returns
    -------
    float64 (n,)
        NaN where no solid is below a point.

    Examples
    --------
    >>> import durer
    >>> plate = durer.Box((0, 0, 0), (9, 9, 0.5))
    >>> durer.thickness(plate, [[4, 4, 0.5]], [[0, 0, 1]])
    array([0.5])
    """
    scene = _scene(body)
    start, out = table(points, 3, "points"), table(normals, 3, "normals")
    if start.shape != out.shape:
        raise ValueError(f"as many normals as points are needed, got shapes {start.shape} and {out.shape}")
    length = np.linalg.norm(out, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        inward = -out / length[:, None]
    spans = scene.spans(np.hstack([start, inward]), threads=threads)
    result = np.full(len(start), np.nan)
    has = np.diff(spans.offsets) > 0
    result[has] = spans.lengths[spans.offsets[:-1][has]]
    return result


@dataclass(frozen=True)
class Scan:
    """What a LiDAR sees.

    Attributes
    ----------
    points : float64 (n, 3)
        In the frame of the scene; NaN for pulses without an echo.
    ranges : float64 (n,)
        Distances; inf for pulses without an echo.
    range_errors : float64 (n,)
        How far the exact distances can be from these: the bound of the intersection, without noise.
    intensities : float64 (n,)
        The cosine of the angle to the surface's normal; 0 without an echo.
    objects : int64 (n,)
    rays : float64 (n, 6)

    Examples
    --------
    >>> import durer
    >>> durer.lidar(durer.Sphere((0, 0, 0), 1), (5, 0, 0), [[-1, 0, 0], [1, 0, 0]])
    <Scan of 2 pulses: 1 echoes>
    """

    points: Floats
    ranges: Floats
    range_errors: Floats
    intensities: Floats
    objects: Ints
    rays: Floats

    @property
    def hit(self) -> Bools:
        """Which pulses have an echo."""
        return np.isfinite(self.ranges)

    def __repr__(self) -> str:
        return f"<Scan of {len(self.ranges)} pulses: {int(self.hit.sum())} echoes>"


def lidar_pattern(
    azimuths: npt.ArrayLike | int = 360,
    elevations: npt.ArrayLike | int = 16,
    vertical_angle: tuple[float, float] = (-0.2618, 0.2618),
) -> Floats:
    """Directions of a turning LiDAR, float64 (rows * columns, 3): x ahead, y left, z up.

    Azimuths and elevations are arrays of angles in radians, or how many there are: all round, and evenly between two angles.

    Examples
    --------
    >>> import durer
    >>> durer.lidar_pattern(4, [0.0]).round(12) + 0.0
    array([[ 1.,  0.,  0.],
           [ 0.,  1.,  0.],
           [-1.,  0.,  0.],
           [ 0., -1.,  0.]])
    """
    around = np.asarray(azimuths)
    if around.ndim == 0:
        around = np.arange(int(around)) * (2 * math.pi / int(around))
    heights = np.asarray(elevations)
    if heights.ndim == 0:
        heights = np.linspace(*vertical_angle, int(heights))
    e, a = np.meshgrid(real_array(heights, "elevations"), real_array(around, "azimuths"), indexing="ij")
    return np.stack([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)], axis=-1).reshape(-1, 3)


def lidar(
    body: Body,
    pose: npt.ArrayLike,
    pattern: npt.ArrayLike,
    *,
    max_range: float = math.inf,
    noise: float = 0.0,
    seed: int = 0,
    threads: int | None = None,
) -> Scan:
    """A scan: the first echo of each pulse.

    Parameters
    ----------
    pose : array (3,), (3, 4) or (4, 4)
        Where the scanner stands, or the map from its frame (x ahead, y left, z up) to the scene.
    pattern : array (n, 3)
        Directions in the scanner's frame, from `lidar_pattern` say; their lengths do not matter.
    max_range : float
        Farther echoes are not seen.
    noise : float
        Standard deviation of a normal error that is added to ranges and moves points along their rays.

    Examples
    --------
    >>> import durer
    >>> room = durer.Box((-2, -3, 0), (2, 3, 2.5))
    >>> scan = durer.lidar(room, (0, 0, 1), durer.lidar_pattern(4, [0.0]))
    >>> scan.ranges.round(12).tolist()
    [2.0, 3.0, 2.0, 3.0]
    """
    scene = _scene(body)
    frame = real_array(pose, "pose")
    if frame.shape == (3,):
        frame = np.hstack([np.eye(3), frame[:, None]])
    frame = matrix(frame, "pose")
    along = table(pattern, 3, "pattern")
    directions = along @ frame[:, :3].T
    length = np.linalg.norm(directions, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        directions = directions / length[:, None]
    rays = np.hstack([np.broadcast_to(frame[:, 3], directions.shape), directions])
    hits = scene.closest(rays, t_max=max_range, threads=threads)
    ranges, points = hits.t.copy(), hits.position.copy()
    with np.errstate(invalid="ignore"):
        errors = np.maximum(hits.t - hits.t_lo, hits.t_hi - hits.t)
        cosines = np.abs((hits.normal * directions).sum(axis=1))
    if noise:
        added = np.random.default_rng(seed).normal(0.0, noise, len(rays))
        ranges += added
        points += directions * added[:, None]
    return Scan(points, ranges, errors, np.where(hits.hit, cosines, 0.0), hits.object, rays)

