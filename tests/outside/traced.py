"""All crossings of rays with a scene, from the command."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np


class Refused(Exception):
    """The command's message."""


def all_crossings(durer, text, rays):
    """The arrays of `durer trace --query all` for a scene and rays of shape (n, 6): those of ray i are from offsets[i] to offsets[i + 1]."""
    with tempfile.TemporaryDirectory() as folder:
        scene, given, found = (Path(folder) / name for name in ("scene.pov", "rays.npy", "hits.npz"))
        scene.write_text(text)
        np.save(given, rays)
        command = [durer, "trace", scene, "--rays", given, "--query", "all", "-o", found]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode:
            raise Refused(done.stderr.strip())
        with np.load(found) as hits:
            return {name: hits[name] for name in hits.files}
