#!/usr/bin/env python3
"""Renders POV-Ray's own example scenes with durer and with POV-Ray, and compares the pictures.

The scenes are those of Debian's povray-examples. Both programs render each scene at 160x120, one ray through the middle of each pixel, on one thread, within a time limit. A pixel agrees if no channel differs by more than 2/255; a scene agrees if
99 % of its pixels do. POV-Ray's pictures are kept in a folder and made only once. If `durer learn-noise` has been run, noisy textures have POV-Ray's grains.

    check_distribution.py [--durer PATH] [--scenes FOLDER] [--work FOLDER] [--seconds N] [--jobs N] [--only WORD] [--least N]
"""

import argparse
import collections
import concurrent.futures
import gzip
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


def reference(scene, name, work, seconds):
    """POV-Ray's picture of a scene; None if it has none."""
    made, failed = work / "povray" / f"{name}.png", work / "povray" / f"{name}.failed"
    if not made.exists() and not failed.exists():
        # It writes beside the scenes, and takes anything but .png for a name without an ending.
        unfinished = made.with_suffix(".part.png")
        words = ["povray", f"+I{scene}", f"+O{unfinished}", f"+L{scene.parent}", "+FN8", f"+W{SIZE[0]}", f"+H{SIZE[1]}", "-A", "-D", "-P", "Work_Threads=1"]
        try:
            done = subprocess.run(words, cwd=scene.parent, capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL)
            if done.returncode == 0 and unfinished.exists():
                unfinished.rename(made)
            else:
                failed.write_bytes(done.stderr[-2000:])
        except subprocess.TimeoutExpired:
            failed.write_text("too slow")
    return made if made.exists() else None


def measured(scene, root, args):
    name = "__".join(scene.relative_to(root).with_suffix("").parts)
    theirs = reference(scene, name, args.work, args.seconds)
    ours = args.work / "durer" / f"{name}.png"
    words = [args.durer, "render", scene, "-o", ours, "--width", SIZE[0], "--height", SIZE[1], "--threads", 1, "--no-progress"]
    start = time.monotonic()
    try:
        done = subprocess.run([*map(str, words)], cwd=scene.parent, capture_output=True, text=True, errors="replace", timeout=args.seconds, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return name, "slow", 0.0, f"more than {args.seconds} s", theirs
    if done.returncode != 0:
        found = PLACE.search(done.stderr)
        text = found.group(0).replace(str(root) + "/", "") if found else done.stderr.strip()[-200:]
        return name, "refused" if theirs else "refused by both", 0.0, text, theirs
    if not theirs:
        return name, "only durer", 0.0, "", theirs
    agreement, largest = compared(ours, theirs)
    missing = re.findall(r"warning: (.*?) is not supported yet: the picture is rendered without it", done.stderr)
    text = f"largest difference {largest}" + (f", without {', '.join(missing)}" if missing else "")
    seconds = time.monotonic() - start
    return name, "agrees" if agreement >= REQUIRED else "differs", agreement, f"{text}, {seconds:.1f} s", theirs


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
    for folder in ("povray", "durer"):
        (args.work / folder).mkdir(exist_ok=True)
    scenes = [scene for scene in sorted(root.rglob("*.pov")) if args.only in str(scene.relative_to(root))]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        rows = list(pool.map(lambda scene: measured(scene, root, args), scenes))
    print("| scene | result | agreement | |\n|---|---|---:|---|")
    for name, result, agreement, text, _ in rows:
        shown = f"{agreement:.2f} %" if result in ("agrees", "differs") else ""
        print(f"| {name.replace('__', '/')} | {result} | {shown} | {text} |")
    counts = collections.Counter(row[1] for row in rows)
    print(f"{len(rows)} scenes: " + ", ".join(f"{count} {result}" for result, count in counts.most_common()))
    rendered = sum(counts[result] for result in ("agrees", "differs", "only durer"))
    if rendered < args.least:
        print(f"{rendered} scenes are rendered, at least {args.least} should be")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
