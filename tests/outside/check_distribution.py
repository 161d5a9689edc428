#!/usr/bin/env python3
"""Renders POV-Ray's own example scenes with durer and with POV-Ray, and compares the pictures.

The scenes are those of Debian's povray-examples. Both programs render each scene at 160x120, one ray through the middle of each pixel, on one thread, within a time limit. A pixel agrees if no channel differs by more than 2/255; a scene agrees if
99 % of its pixels do. POV-Ray's pictures are kept in a folder and made only once. If `durer learn-noise` has been run, noisy textures have POV-Ray's grains.

The table also has the structural similarity of the two pictures (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality
assessment: from error visibility to structural similarity", IEEE Transactions on Image Processing, 2004; on grey levels, in windows of
8 by 8 pixels, after a blur by 4 pixels), and durer's processor time divided by POV-Ray's. The page index.html in the folder shows the two
pictures of each scene and their difference, the worst first. Needs the packages numpy and pillow.

    check_distribution.py [--durer PATH] [--scenes FOLDER] [--work FOLDER] [--seconds N] [--jobs N] [--only WORD] [--least N]
"""

import argparse
import collections
import concurrent.futures
import dataclasses
import gzip
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
SIZE = (160, 120)
TOLERANCE, REQUIRED = 2, 99.0
# The first message of an error, and not of a warning.
PLACE = re.compile(r"^(?!.*warning)\S+:\d+:\d+: .*$|^error.*$|.*panicked.*", re.M)


def unpacked(scenes, work):
    """A copy of the scenes in which nothing is compressed, because POV-Ray reads only such files."""
    copy = work / "scenes"
    if copy.is_dir():
        return copy
    shutil.copytree(scenes, copy)
    for packed in list(copy.rglob("*.gz")):
        packed.with_suffix("").write_bytes(gzip.decompress(packed.read_bytes()))
        packed.unlink()
    return copy


def pixels(path):
    from PIL import Image

    with Image.open(path) as picture:
        return picture.convert("RGB").size, picture.convert("RGB").tobytes()


def compared(ours, theirs):
    """The percentage of pixels that agree, and the largest difference."""
    (size, a), (other, b) = pixels(ours), pixels(theirs)
    if size != other:
        return 0.0, 255
    differences = [abs(x - y) for x, y in zip(a, b)]
    worst = [max(differences[i : i + 3]) for i in range(0, len(differences), 3)]
    return 100.0 * sum(d <= TOLERANCE for d in worst) / len(worst), max(worst)


def structure(ours, theirs):
    """The structural similarity of two pictures: 1 if they are equal."""
    import numpy
    from PIL import Image, ImageFilter

    windows = []
    for path in (ours, theirs):
        with Image.open(path) as picture:
            grey = numpy.asarray(picture.convert("L").filter(ImageFilter.GaussianBlur(4)), float)
        windows.append(numpy.lib.stride_tricks.sliding_window_view(grey, (8, 8)))
    a, b = windows
    mean_a, mean_b = a.mean((2, 3)), b.mean((2, 3))
    covariance = (a * b).mean((2, 3)) - mean_a * mean_b
    # The constants of the paper, for levels from 0 to 255.
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    alike = (2 * mean_a * mean_b + c1) * (2 * covariance + c2)
    return float((alike / ((mean_a**2 + mean_b**2 + c1) * (a.var((2, 3)) + b.var((2, 3)) + c2))).mean())


def draw_difference(ours, theirs, drawn):
    """Writes the differences of two pictures, 16 times as bright."""
    from PIL import Image, ImageChops

    with Image.open(ours) as a, Image.open(theirs) as b:
        ImageChops.difference(a.convert("RGB"), b.convert("RGB")).point(lambda level: min(255, 16 * level)).save(drawn)


def run(words, folder, seconds):
    """Runs a program; returns its exit code, its errors and its processor seconds, or raises TimeoutError."""
    with tempfile.TemporaryFile() as errors:
        program = subprocess.Popen([*map(str, words)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        end = time.monotonic() + seconds
        while True:
            ended, status, used = os.wait4(program.pid, os.WNOHANG)
            if ended:
                break
            if time.monotonic() > end:
                program.kill()
                os.wait4(program.pid, 0)
                program.returncode = -9
                raise TimeoutError
            time.sleep(0.005)
        # The process has been waited for.
        program.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return program.returncode, errors.read().decode(errors="replace"), used.ru_utime + used.ru_stime


def reference(scene, name, work, seconds):
    """POV-Ray's picture of a scene; None if it has none. Its processor seconds are kept beside it."""
    made, failed = work / "povray" / f"{name}.png", work / "povray" / f"{name}.failed"
    if not made.exists() and not failed.exists():
        # It writes beside the scenes, and takes anything but .png for a name without an ending.
        unfinished = made.with_suffix(".part.png")
        words = ["povray", f"+I{scene}", f"+O{unfinished}", f"+L{scene.parent}", "+FN8", f"+W{SIZE[0]}", f"+H{SIZE[1]}", "-A", "-D", "-P", "Work_Threads=1"]
        try:
            code, errors, used = run(words, scene.parent, seconds)
            if code == 0 and unfinished.exists():
                made.with_suffix(".seconds").write_text(f"{used:.2f}")
                unfinished.rename(made)
            else:
                failed.write_text(errors[-2000:])
        except TimeoutError:
            failed.write_text("too slow")
    return made if made.exists() else None


@dataclasses.dataclass
class Row:
    """The result for a scene; the numbers are None where there is no pair of pictures."""

    name: str
    result: str
    text: str
    agreement: float | None = None
    structure: float | None = None
    ratio: float | None = None

    def line(self):
        numbers = [f"{self.agreement:.2f} %", f"{self.structure:.3f}"] if self.agreement is not None else ["", ""]
        numbers.append(f"{self.ratio:.2f}" if self.ratio is not None else "")
        return f"| {self.name.replace('__', '/')} | {self.result} | {' | '.join(numbers)} | {self.text} |"


def measured(scene, root, args):
    name = "__".join(scene.relative_to(root).with_suffix("").parts)
    theirs = reference(scene, name, args.work, args.seconds)
    ours = args.work / "durer" / f"{name}.png"
    words = [args.durer, "render", scene, "-o", ours, "--width", SIZE[0], "--height", SIZE[1], "--threads", 1, "--no-progress"]
    try:
        code, errors, used = run(words, scene.parent, args.seconds)
    except TimeoutError:
        return Row(name, "slow", f"more than {args.seconds} s")
    if code != 0:
        found = PLACE.search(errors)
        text = found.group(0).replace(str(root) + "/", "") if found else errors.strip()[-200:]
        return Row(name, "refused" if theirs else "refused by both", text)
    if not theirs:
        return Row(name, "only durer", "")
    agreement, largest = compared(ours, theirs)
    draw_difference(ours, theirs, args.work / "difference" / f"{name}.png")
    missing = re.findall(r"warning: (.*?) is not supported yet: the picture is rendered without it", errors)
    text = f"largest difference {largest}" + (f", without {', '.join(missing)}" if missing else "")
    kept = theirs.with_suffix(".seconds")
    ratio = used / max(float(kept.read_text()), 0.01) if kept.exists() else None
    result = "agrees" if agreement >= REQUIRED else "differs"
    return Row(name, result, text, agreement, structure(ours, theirs), ratio)


def page(rows):
    """The page with the pictures of all scenes that both programs render, the worst first."""
    shown = sorted((row for row in rows if row.agreement is not None), key=lambda row: row.agreement)
    parts = ["<!doctype html><meta charset=utf-8><title>POV-Ray's scenes</title><h1>durer, POV-Ray, 16 times their difference</h1>"]
    for row in shown:
        pictures = "".join(f'<img src="{folder}/{row.name}.png" alt="{folder}"> ' for folder in ("durer", "povray", "difference"))
        told = f"{row.agreement:.2f} % of the pixels agree, structure {row.structure:.3f}, {row.text}"
        parts.append(f"<h2>{html.escape(row.name.replace('__', '/'))}</h2><p>{html.escape(told)}</p>{pictures}")
    return "\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--durer", type=Path, default=ROOT / "target/release/durer")
    parser.add_argument("--scenes", type=Path, default=Path("/usr/share/doc/povray/examples"))
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "durer-distribution")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--least", type=int, default=0, help="fails if fewer scenes are rendered")
    args = parser.parse_args()
    if not args.scenes.is_dir() or not shutil.which("povray"):
        print("not run: povray and povray-examples (Debian) are not installed")
        return 0
    args.work.mkdir(parents=True, exist_ok=True)
    root = unpacked(args.scenes, args.work)
    for folder in ("povray", "durer", "difference"):
        (args.work / folder).mkdir(exist_ok=True)
    scenes = [scene for scene in sorted(root.rglob("*.pov")) if args.only in str(scene.relative_to(root))]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = list(pool.map(lambda scene: measured(scene, root, args), scenes))
    print("| scene | result | agreement | structure | time / POV-Ray's | |\n|---|---|---:|---:|---:|---|")
    for row in rows:
        print(row.line())
    counts = collections.Counter(row.result for row in rows)
    print(f"{len(rows)} scenes: " + ", ".join(f"{count} {result}" for result, count in counts.most_common()))
    (args.work / "index.html").write_text(page(rows))
    print(f"pictures: {args.work / 'index.html'}")
    rendered = sum(counts[result] for result in ("agrees", "differs", "only durer"))
    if rendered < args.least:
        print(f"{rendered} scenes are rendered, at least {args.least} should be")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
