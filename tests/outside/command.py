"""`durer trace` as a user calls it: its arrays, their layout, and what a miss looks like."""

import math
import os
import subprocess

import numpy as np

INF = float("inf")
COLUMNS = {
    "t": ("<f8", ()), "t_lo": ("<f8", ()), "t_hi": ("<f8", ()), "object": ("<i4", ()), "primitive": ("<u4", ()), "uv": ("<f8", (2,)),
    "position": ("<f8", (3,)), "normal": ("<f8", (3,)), "kind": ("|u1", ()),
}
SPANS = {"t_in": ("<f8", ()), "t_out": ("<f8", ()), "object_in": ("<i4", ()), "object_out": ("<i4", ())}
MISS = {"t": INF, "t_lo": INF, "t_hi": INF, "object": -1, "primitive": 4294967295, "uv": math.nan, "position": math.nan, "normal": math.nan, "kind": 255}


class Wrong(Exception):
    """The command did not do what its contract says."""


def trace(durer, scene, rays, query, out, isa=None, threads=None):
    command = [durer, "trace", scene, "--rays", rays, "--query", query, "-o", out] + (["--threads", str(threads)] if threads else [])
    env = {**os.environ, **({"DURER_ISA": isa} if isa else {})}
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=env, timeout=120)
    if done.returncode != 0:
        raise Wrong(f"exit code {done.returncode} of a good scene: {done.stderr.strip()[:600]}")
    with np.load(out) as file:
        return {name: file[name] for name in file.files}


def check_layout(arrays, wanted, length):
    """Names, types and shapes, to the letter."""
    if set(arrays) != set(wanted):
        raise Wrong(f"arrays {sorted(arrays)}, expected {sorted(wanted)}")
    for name, (dtype, rest) in wanted.items():
        a = arrays[name]
        n = length[name] if isinstance(length, dict) else length
        if a.dtype.str != dtype or a.shape != (n, *rest):
            raise Wrong(f"{name} is {a.dtype.str} {a.shape}, expected {dtype} {(n, *rest)}")


def same_bits(a, b):
    return a.keys() == b.keys() and all(a[k].tobytes() == b[k].tobytes() for k in a)
