"""Checks and conversions of what callers pass: vectors, matrices, arrays of rays and points."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Vector = tuple[float, float, float]


def real_array(value: npt.ArrayLike, name: str) -> Floats:
    """`value` as an array of float64; numbers that are not real are refused."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiub" and array.size:
        raise ValueError(f"{name}: real numbers are needed, got an array of dtype {array.dtype}")
    return np.asarray(array, dtype=np.float64)


def number(value: Any, name: str) -> float:
    """One real number."""
    array = real_array(value, name)
    if array.ndim != 0:
        raise ValueError(f"{name}: one number is needed, got an array of shape {array.shape}")
    return float(array)


def vector(value: npt.ArrayLike, name: str) -> Vector:
    """Three real numbers."""
    array = real_array(value, name)
    if array.shape != (3,):
        raise ValueError(f"{name}: three numbers are needed, got shape {array.shape}")
    return (float(array[0]), float(array[1]), float(array[2]))


def table(value: npt.ArrayLike, columns: int, name: str) -> Floats:
    """An array of shape (n, columns); an empty list has no rows."""
    array = real_array(value, name)
    if array.shape == (0,):
        array = array.reshape(0, columns)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: shape (n, {columns}) is needed, got {array.shape}")
    return array


def row_tuples(value: npt.ArrayLike, columns: int, name: str) -> tuple[tuple[float, ...], ...]:
    """An array of shape (n, columns) as tuples, which are compared and pickled as they are."""
    return tuple(tuple(row) for row in table(value, columns, name).tolist())


def index_table(value: npt.ArrayLike, name: str) -> Ints:
    """An array of whole numbers of shape (n, 3)."""
    array = np.asarray(value)
    if array.shape == (0,):
        array = array.reshape(0, 3).astype(np.int64)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: whole numbers are needed, got an array of dtype {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: shape (n, 3) is needed, got {array.shape}")
    return np.asarray(array, dtype=np.int64)


def matrix(value: npt.ArrayLike, name: str = "matrix") -> Floats:
    """An affine map as an array of shape (3, 4); a last row of (0, 0, 0, 1) is taken off."""
    array = real_array(value, name)
    if array.shape == (4, 4):
        if array[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
            raise ValueError(f"{name}: its last row must be (0, 0, 0, 1), got {array[3].tolist()}")
        array = array[:3]
    if array.shape != (3, 4):
        raise ValueError(f"{name}: shape (3, 4) or (4, 4) is needed, got {array.shape}")
    return array


def rays(
    origins: npt.ArrayLike,
    directions: npt.ArrayLike | None,
    t_min: npt.ArrayLike | None = None,
    t_max: npt.ArrayLike | None = None,
) -> tuple[Floats, Floats, Floats | None]:
    """Origins (n, 3), directions (n, 3) and ranges (n, 2), from one array of 6 (or 8) columns or from two of 3."""
    first = real_array(origins, "rays" if directions is None else "origins")
    ranges: Floats | None = None
    if directions is None:
        if first.shape == (0,):
            first = first.reshape(0, 6)
        if first.ndim != 2 or first.shape[1] not in (6, 8):
            raise ValueError(
                f"rays: shape (n, 6), or (n, 8) with t_min and t_max, is needed, got {first.shape}"
            )
        start, along = first[:, :3], first[:, 3:6]
        if first.shape[1] == 8:
            ranges = first[:, 6:]
    else:
        start = table(first, 3, "origins")
        along = table(directions, 3, "directions")
        if len(start) != len(along):
            raise ValueError(
                f"as many directions as origins are needed, got shapes {start.shape} and {along.shape}"
            )
    if t_min is not None or t_max is not None:
        if ranges is not None:
            raise ValueError("rays: t_min and t_max are given twice, as columns and as arguments")
        ranges = np.empty((len(start), 2))
        for column, (value, name, default) in enumerate(
            ((t_min, "t_min", 0.0), (t_max, "t_max", np.inf))
        ):
            limit = real_array(default if value is None else value, name)
            if limit.shape not in ((), (len(start),)):
                raise ValueError(f"{name}: shape () or ({len(start)},) is needed, got {limit.shape}")
            ranges[:, column] = limit
    return start, along, ranges


def thread_count(threads: int | None) -> int:
    """The number that the native side knows; 0 is one for each processor."""
    if threads is None:
        return 0
    count = int(threads)
    if count < 1:
        raise ValueError(f"threads: at least 1 is needed, got {threads}")
    return count


class Progress:
    """What is called with the number of finished rays: a bar of tqdm, a callable, or nothing."""

    def __init__(self, wanted: bool | Callable[[int, int], object], total: int) -> None:
        self._bar: Any = None
        self._done = 0
        self.call: Callable[[int], object] | None = None
        if callable(wanted):

            def tell(count: int) -> None:
                self._done += count
                wanted(self._done, total)

            self.call = tell
        elif wanted:
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped, unused-ignore]
            except ImportError:
                return
            self._bar = tqdm(total=total, unit="ray", unit_scale=True)
            self.call = self._bar.update

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def read_only(arrays: Iterable[np.ndarray[Any, Any] | None]) -> None:
    """Makes arrays that others may hold unchangeable."""
    for array in arrays:
        if array is not None:
            array.flags.writeable = False
