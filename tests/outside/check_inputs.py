#!/usr/bin/env python3
"""Examines what the command `durer` does with wrong inputs, and with odd but good ones.

Wrong: exit code 1 (2 for wrong words on the command line), one clear message with its place and the text underlined, no output file, no
panic, within 10 seconds of work and 1 GB. See README.md.

    check_inputs.py [--durer PATH] [--mutants N] [--seed N] [--only WORD]
"""

import argparse
import base64
import json
import os
import random
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

ROOT = Path(__file__).parents[2]
SECONDS, BYTES = 10.0, 1 << 30
# Scenes without end run twice: with the default limit, which is half of the machine's memory, and with a small one.
# For each: the options, and how many bytes the process may take. An array that grows is held twice while it is copied.
MEMORY_LIMITS = {
    "default limit": ([], os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2),
    "256 MB": (["--limit", f"memory={256 << 20}"], 512 << 20),
}
PLACE = re.compile(r"^(?!warning|notice|\s)\S*?([^/\s]+):(\d+):(\d+): (.+)$", re.M)
FORBIDDEN = ("panicked", "RUST_BACKTRACE", "backtrace", "stack overflow", "unwrap()", "core dumped", "memory allocation")
CAMERA = "camera { location <0, 0, -5> look_at 0 }\nlight_source { <5, 9, -9>, rgb 1 }\n"
GOOD = CAMERA + "sphere { 0, 1 pigment { rgb <1, 0, 0> } }\n"


class Ended:
    def __init__(self, code, err, out, seconds, wall, peak):
        self.code, self.err, self.out, self.seconds, self.wall, self.peak = code, err, out, seconds, wall, peak


def run(durer, words, folder, stop_after=None):
    """Runs the command in a folder; its end, its words, its CPU seconds and its peak memory."""
    def bounds():
        resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
        resource.setrlimit(resource.RLIMIT_CPU, (40, 40))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as err, tempfile.TemporaryFile() as out:
        start = time.monotonic()
        child = subprocess.Popen([str(durer), *map(str, words)], cwd=folder, stdout=out, stderr=err, stdin=subprocess.DEVNULL, preexec_fn=bounds)
        if stop_after is not None:
            time.sleep(stop_after)
            child.send_signal(signal.SIGINT)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = code = os.waitstatus_to_exitcode(status)
        err.seek(0), out.seek(0)
        return Ended(code, err.read().decode("utf-8", "replace"), out.read().decode("utf-8", "replace"),
                     usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss * 1024)


class Examiner:
    def __init__(self, durer, only):
        self.durer, self.only = durer.resolve(), only
        self.done, self.wrong = 0, []

    def fail(self, name, what, words, ended, scene=None):
        self.wrong.append((name, what))
        print(f"\n== {name}: {what}")
        print("  durer " + " ".join(map(str, words)))
        if scene is not None:
            shown = scene if len(scene) < 700 else scene[:500] + f" ... ({len(scene)} bytes)".encode()
            print("  scene:", shown if isinstance(shown, str) else repr(shown)[:900])
        print(f"  exit {ended.code}, {ended.seconds:.1f} s, {ended.peak >> 20} MB, stderr:\n" + "\n".join("    " + s[:200] for s in ended.err.splitlines()[:14]))

    def examine(self, name, words, code, files=None, place=None, says=None, makes=(), scene=None, needs_place=False, setup=None, stop_after=None, chatty=False, most_bytes=BYTES):
        """Runs one case in a folder of its own and checks all that is asked of every end."""
        if self.only and self.only not in name:
            return None
        self.done += 1
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            for file, content in (files or {}).items():
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())
            if setup:
                setup(folder)
            before = {p.relative_to(folder) for p in folder.rglob("*")}
            ended = run(self.durer, words, folder, stop_after)
            after = {p.relative_to(folder) for p in folder.rglob("*")} - before
            codes = code if isinstance(code, tuple) else (code,)
            fail = lambda what: self.fail(name, what, words, ended, scene)
            low = ended.err.lower()
            if any(w.lower() in low for w in FORBIDDEN):
                fail("words of a crash")
            if ended.code not in codes:
                fail(f"exit code {ended.code}, expected {code}")
            if ended.seconds > SECONDS or ended.wall > 3 * SECONDS:
                fail(f"took {ended.seconds:.1f} s of work, {ended.wall:.1f} s of waiting")
            if ended.peak > most_bytes:
                fail(f"took {ended.peak >> 20} MB")
            expected = {Path(m) for m in makes} if ended.code in (0, 130) else set()
            if after != expected and not (ended.code == 0 and code != 0):
                fail(f"files left: {sorted(map(str, after))}, expected {sorted(map(str, expected))}")
            if ended.code in (1, 2) and not ended.err.strip():
                fail("no message")
            if ended.code == 1:
                self.check_message(fail, ended.err, place, needs_place)
            for word in [says] if isinstance(says, str) else says or ():
                if word.lower() not in low:
                    fail(f"the message does not say '{word}'")
            if len(ended.err) > 4000 and ended.code and not chatty:
                fail(f"a message of {len(ended.err)} bytes")
            return {p: (folder / p).read_bytes() for p in after if (folder / p).is_file()}

    def check_message(self, fail, err, place, needs_place):
        found = [m for m in PLACE.finditer(err) if not m[4].startswith(("warning", "notice"))]
        if len(found) > 1:
            fail("more than one message")
        if (needs_place or place) and not found:
            return fail("no place (file:line:column) in the message")
        if found:
            m = found[0]
            if place and (m[1], int(m[2]), int(m[3])) != place:
                fail(f"place {m[1]}:{m[2]}:{m[3]}, expected {':'.join(map(str, place))}")
            if not re.search(r"^[\s|\d]*\^", err[m.end():], re.M):
                fail("nothing underlined")

    def scene(self, name, text, code=1, place=None, says=None, files=None, needs_place=True, command="render", options=(), **rest):
        """A scene through `render`, small, or another command, with further options."""
        content = text if isinstance(text, bytes) else text.encode()
        words = {
            "render": ["render", "s.pov", "-o", "s.png", "--width", "8", "--height", "6"],
            "check": ["check", "s.pov"],
        }[command] + list(options)
        makes = ["s.png"] if command == "render" else []
        place = ("s.pov", *place) if place and len(place) == 2 else place
        return self.examine(name, words, code, {"s.pov": content, **(files or {})}, place, says, makes, content, needs_place and code == 1, **rest)


# ---- wrong scenes ----


def wrong_values(x):
    # POV-Ray draws these as surfaces without thickness, or draws nothing of them: they are no errors.
    without_extent = {
        "sphere { 0, 0 }": "radius 0", "cylinder { 0, y, 0 }": "radius 0", "cone { 0, 0, y, 0 }": "radii of this cone are 0", "disc { 0, y, 0 }": "no area",
        "disc { 0, 0, 1 }": "no length", "quadric { 0, 0, 0, 1 }": "no variable", "blob { sphere { 0, 0, 1 } }": "radius 0", "torus { 1, 0 }": "radius of this torus is 0",
        "poly { 2, <0, 0, 0, 0, 0, 0, 0, 0, 0, 5> }": "no variable", "polynomial { 3 }": "no variable",
        "sphere { 0, 1 matrix <1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 0> }": "column 3", "sphere { 0, 1 matrix <0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0> }": "column 1",
        "box { <0, 0, 0>, <1, 0, 1> }": None, "prism { 0, 0, 4, <0, 0>, <1, 0>, <1, 1>, <0, 0> }": None, "torus { 0, 1 }": None, "ovus { 0, 1 }": None,
    }
    for words, says in without_extent.items():
        for command in ("render", "check"):
            x.scene(f"without extent, {command}: {words}", GOOD + words, code=0, command=command, says=["warning", says] if says else None)
    wrong = {
        "cylinder { y, y, 1 }": "same", "cone { y, 1, y, 2 }": "same", "plane { 0, 1 }": "normal",
        
        
        "union { sphere { 0, 1 } matrix <1, 2, 3, 2, 4, 6, 0, 0, 1, 0, 0, 0> }": "", "sphere { 0, 1e400 }": "", "sphere { 0, 1/0 }": "zero",
        "sphere { <0, 0, 1/0>, 1 }": "zero", "sphere { 0, sqrt(-1) }": "", "sphere { 0, ln(0) }": "", "sphere { 0, asin(2) }": None,
        "#declare A = 1/0; sphere { 0, A }": "finite", "#if (1/0) #end sphere { 0, -1/0 }": "finite", "sphere { 0, mod(1, 0) }": "", "sphere { 0, 1 translate 1e999 }": "",
        "sphere { 0, exp(1e9) }": "", "sphere { 0, pow(10, 400) }": "", "box { -1e308, 1e308 scale 1e308 }": "", "sphere { 0, 1 matrix <1, 0, 0> }": "",
        "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 3> } }": "", "mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, -1> } }": "",
        "mesh2 { vertex_vectors { -3, 0, x, y } face_indices { 1, <0, 1, 2> } }": "", "mesh2 { vertex_vectors { 1e9, 0, x, y } face_indices { 1, <0, 1, 2> } }": "",
        "polygon { 2, 0, x }": "", "polygon { 1e18, 0, x, y }": "", "polygon { -4, 0, x, y, 0 }": "", "triangle { 0, x }": "", "sphere { 0 }": "", "sphere { }": "", "sphere": "",
        "mesh { }": None, "union { }": None, "sphere { 0, 1 clipped_by { disc { 0, y, 1 } } }": "disc", "text { 1 }": "expected ttf or internal, found a number",
        "blob { threshold 1 }": "no components", "blob { threshold -1 sphere { 0, 1, 1 } }": "greater than 0", "blob { sphere { 0, 1, 2 texture { gradient x } } }": "has no textures", "blob { sphere { 0, 1, 2 interior { ior 1.5 } } }": "a transform or the texture of the component",
        "deform { blob { sphere { 0, 1, 2 pigment { rgb 1 } } } twist { y, 90, from 0 to 1 } }": "whose components have textures",
        "julia_fractal { <0, 0, 0, 0> slice x, 0 }": "fourth component", "julia_fractal { <0, 0, 0, 0> max_iteration -1 }": "0 to 1000", "julia_fractal { 0 hypercomplex exp }": "not supported yet: exp", "superellipsoid { <0, 1> }": "between", "superellipsoid { <1, -1> }": "between", "superellipsoid { }": "", "blob { cylinder { 0, 0, 1, 1 } }": "same point", "isosurface { function { f_nowhere(x) } }": "f_nowhere",
        "camera { omnimax }": None, "sphere { 0, 1 pigment { spacing } }": "not supported yet: spacing", "sphere { 0, 1 pigment { image_map { png \"x.png\" } } }": "there is no picture", "sphere { 0, 1 pigment { image_map { png \"/dev/zero\" } } }": "is not a regular file", "#fopen F \"/tmp/durer-outside\" write": "relative path without", "#fopen F \"../durer-outside\" append": "relative path without", "#fopen F \"/dev/zero\" read": "is not a regular file", "#fopen F \"a.txt\" write #while (1) #write (F, \"0123456789\") #end": "the limit",
        "#declare A = array[3] { 1, 2 }; sphere { 0, A[7] }": "", "#declare A = array[1e12]": "", "#declare A = array[0]": "", "sphere { Nothing, 1 }": "Nothing",
        "sphere { 0, 1 } }": "", "} sphere { 0, 1 }": "", "sphere { 0, 1": "", "#end": "", "#else": "", "#if (1) sphere { 0, 1 }": "", "#macro M() sphere { 0, 1 }": "",
        "/* never closed": "", '"never closed': "", "#declare A = \"x": "", "#nonsense": "", "#declare = 3;": "", "#declare A 3;": "", "#include": "", '#include ""': "",
        "#declare A = 1": ";", "#version 3.8;": "3.8", "#version 99;": "", "#error \"mine own words\"": "mine own words", "#undef": "", "#macro M(A,) #end": None, "#declare sphere = 1;": "sphere",
        "sphere { 0, 1 } @": "", "sphere { 0, 1 rotate }": "", "sphere { <1, 2>, 1 }": None, "sphere { <1, 2, 3, 4, 5, 6>, 1 }": "", "sphere { 0, <1, 2, 3> }": None,
        "#declare A = chr(-1);": "", "#declare A = substr(\"abc\", 5, 9);": "", "#declare S = \"a\"; sphere { 0, S }": "", "sphere { 0, \"1\" }": "", "#for (I, 1, 10, 0) #end": "", "#while #end": "",
        "#switch (1) #case (1) #break": "", "#break": "", "#case (1)": "", "#local": "", "#default { sphere { 0, 1 } }": "", "camera { location <0, 0, 0> look_at <0, 0, 0> direction 0 }": "",
        "camera { angle 180 }": "", "camera { angle -10 }": None, "camera { right 0 }": None, "global_settings { max_trace_level -1 }": None, "global_settings { max_trace_level 1e9 }": None, "global_settings { assumed_gamma 0 }": "",
        "light_source { 0, rgb 1 spotlight radius -1 falloff -2 }": None, "sphere { 0, 1 pigment { checker color_map { [0 rgb 1] } } }": "", "sphere { 0, 1 interior { ior 0 } }": None, "sphere { 0, 1 interior { ior -1 } }": None,
        "sphere { 0, 1 finish { phong_size -1 } }": None, "sphere { 0, 1 finish { roughness 0 } }": None, "hyperboloid { <1, 1, 0>, sheets 1 }": "", "ellipsoid { <1, 1, -1> }": "", "hyperboloid { <1, 1, 1>, sheets 3 }": "",
        "hyperboloid { 1, 1, sheets 1, from 1 to -1 }": "", "spherical_sector { 0, 1, y, 0 }": "", "parallelogram { 0, x, x }": "",
        "torus { 1 }": "", "poly { 40, <1, 2, 3> }": "from 2 to 16", "poly { 2.5, <1> }": "from 2 to 16", "poly { 1, <1, 2, 3, 4> }": "from 2 to 16",
        "quartic { <1, 2, 3> }": "35 coefficients", "poly { 2, <1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1> }": "10 coefficients", "cubic { 1 }": "",
        "prism { 0, 1, 2, <0, 0>, <1, 0> }": "at least 3 points", "prism { 0, 1, 5, <0, 0>, <1, 0> <0, 0>, <5, 5>, <6, 6> }": "outline 1",
        "prism { 0, 1, 4, <0, 0>, <1, 1>, <2, 2>, <0, 0> }": "one line", "prism { 0, 1, 4, <0, 0>, <1, 0>, <1, 1> }": "", "prism { cubic_spline 0, 1, 4, <0, 0>, <1, 0>, <1, 1>, <0, 0> }": "at least 6 points",
        "prism { quadratic_spline 0, 1, 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> }": "return to <1, 0>", "prism { bezier_spline 0, 1, 6, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 1>, <0, 0> }": "multiple of 4",
        "prism { bezier_spline 0, 1, 8, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 2>, <0, 1>, <1, 1>, <0, 0> }": "next begins at <0, 2>",
        "prism { 0, 1, 3, <0, 0>, <1, 0>, <1, 1> }": None, "prism { conic_sweep 1, 1e308, 3, <0, 0>, <9, 0>, <9, 9> }": "too large", "prism { }": "", "torus { 1, 1 open }": "open",
        "sor { 3, <1, 0>, <1, 1>, <1, 2> }": "at least 4 points", "sor { 4, <1, 0>, <1, 2>, <1, 1>, <1, 3> }": "ascend", "sor { 4, <1, 0>, <-1, 1>, <1, 2>, <1, 3> }": "negative",
        "sor { 4, <1, 5>, <1, 1>, <1, 2>, <1, 3> }": "ascend", "sor { 4, <1, 0>, <1e200, 1>, <1, 2>, <1, 3> }": "too large", "ovus { 1 }": "", "ovus { 1, 1 open }": "open",
        "lemon { 0, 0, 0, 0, 1 }": "same point", "lemon { 0, 0, y, 0, 0.5 }": "greater than 0.5", "lemon { 0, -1, y, 0, 5 }": "negative", "lemon { 0, 0, y }": "", "sor { 1e18, <0, 0> }": "",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0, 1>, <1, 0, 0, 0>, <0, 1, 0, 1>, <1, 1, 0, 1> }": "weight",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0, 1>, <1, 0, 0, -1>, <0, 1, 0, 1>, <1, 1, 0, 1> }": "weight",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1/0, 0> }": "zero",
        "nurbs { degree 40, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> }": "1 to 9",
        "nurbs { degree 3, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> }": "needs 4 points",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> u_knots 4, 0, 1, 0, 1 }": "not decrease",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> u_knots 3, 0, 0, 1 }": "4 knots",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> trim { linear_spline 4, <0, 0>, <1, 1>, <1, 0>, <0, 1> } }": "trim 1",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> trim { linear_spline 3, <0, 0>, <2, 0>, <0, 1> } }": "leaves the surface",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> trim { bezier_spline 4, <0, 0>, <1, 0>, <1, 1>, <0, 1> } }": "open",
        "nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> trim { linear_spline 3, <0, 0>, <1, 0>, <0, 1> } trim { linear_spline 3, <0.25, -0>, <0.75, 0.75>, <0.25, 0.75> } }": "trim",
        "sewn { nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> } closed }": "no partner",
        "sewn { nurbs { degree 1, 1 points 2, 2, <0, 0, 0>, <1, 0, 0>, <0, 1, 0>, <1, 1, 0> } seal -1 }": "seal",
        "sewn { }": "",
        "patch { 1, 4, <0, 0, 0>, <1, 0, 0>, <2, 0, 0>, <3, 0, 0> }": "",
        "patch { triangular 12, <0, 0, 0> }": "",
        "bilinear { 0, x, y }": "",
        "parametric { function { u } function { v } function { 0 } <0, 0>, <0, 1> }": "",
        "parametric { function { u } function { v } <0, 0>, <1, 1> }": "",
        "deform { bilinear { 0, x, x + y, y } }": "how it is deformed",
        "deform { bilinear { 0, x, x + y, y } lattice { 0, <1, 1, 0>, 2, 2, 2 } }": "not flat",
        "deform { bilinear { 0, x, x + y, y } lattice { 0, 1, 2, 9, 2 } }": "2 to 8 points",
        "deform { bilinear { 0, x, x + y, y } lattice { 0, 1, 2, 2.5, 2 } }": "how many points",
        "deform { bilinear { 0, x, x + y, y } lattice { 0, 1, 2, 2, 2 move <2, 0, 0>, y } }": "no point <2, 0, 0>",
        "deform { bilinear { 0, x, x + y, y } lattice { 0, 1, 2, 2, 2 move <0.5, 0, 0>, y } }": "whole numbers",
        "deform { bilinear { 0, x, x + y, y } formula { function { x } function { y } function { z } contained_by { box { -2, 2 } } } }": "twist, taper, bend or lattice",
        "deform { sphere { 0, 1 } lattice { -1, 1, 2, 2, 2 move <0, 0, 0>, y } }": "no inverse formula",
        "deform { intersection { sphere { 0, 1 } bilinear { 0, x, x + y, y } } twist { y, 90, from 0 to 1 } }": "by itself",
        "deform { parametric { function { 3*u } function { v } function { 0 } <0, 0>, <1, 1> } twist { y, 90, from 0 to 1 } }": "contained_by",
        "polynomial { 4, xyz(3, 2, 0): 1 }": "add up to 4", "polynomial { 4, xyz(-1, 2, 0): 1 }": "add up to 4", "polynomial { 4, xyz(1, 0.5, 0): 1 }": "add up to 4", "polynomial { 3, xyz(1, 0): 1 }": "",
    }
    for words, says in wrong.items():
        x.scene(f"wrong value: {words}", GOOD + words + "\n", code=(0, 1) if says is None else 1, says=says or None, needs_place=says is not None)
        x.scene(f"wrong value, checked: {words}", GOOD + words + "\n", code=(0, 1) if says is None else 1, command="check", needs_place=says is not None)
    x.scene("no camera", "sphere { 0, 1 }", code=0, says=["warning", "camera"])
    places = {
        "sphere { 0, 1 }\n  bicubic_patch { 1 }\n": (2, 3), "sphere { 0, 1\n}\n\tsphere { 0, 1/0 }\n": None, "#declare A = 3;\nsphere { A, B }\n": (2, 13),
        "\n\n   sphere { 0, 1 pigment { spacing } }": (3, 28), "/* a\n b */ bicubic_patch { 1 }": (2, 7), "#macro M()\n  bicubic_patch { 1 }\n#end\nM()\n": (2, 3),
        "#if (1)\n#while (0)\n#end\n": None, "sphere { 0, 1 }\r\n\r\nbicubic_patch { 1 }\r\n": (3, 1), "// \xe4\xf6\xfc\nsphere { 0, 1 } /* \xe9 */ bicubic_patch { 1 }": (2, 25),
    }
    for words, at in places.items():
        x.scene(f"place of: {words!r}", words, place=at)
    x.scene("place in a Latin-1 file", "// \xe4\xf6\xfc\n/* \xe9 */ bicubic_patch { 1 }".encode("latin-1"), place=(2, 9))
    x.scene("place in an included file", 'sphere { 0, 1 }\n#include "part.inc"\n', files={"part.inc": "\n bicubic_patch { 1 }"}, place=("part.inc", 2, 2))


def endless(x):
    cases = {
        "while forever": "#while (1) #end", "while forever with work": "#declare I = 0; #while (I < 2) #declare I = I - 1; #end",
        "while forever with text": '#declare S = "a"; #while (1) #declare S = concat(S, "b"); #end', "doubling text": '#declare S = "ab"; #while (1) #declare S = concat(S, S); #end',
        "huge for": "#for (I, 1, 1e15) #end", "for that stands still": "#for (I, 0, 1e300, 1e-300) #end", "for in for": "#for (I, 1, 1e6) #for (J, 1, 1e6) #end #end",
        "endless recursion": "#macro M() M() #end M()", "endless recursion in an argument": "#macro M(A) M(A + 1) #end M(0)", "mutual recursion": "#macro A() B() #end #macro B() A() #end A()",
        "endless recursion that grows": "#macro M(S) M(concat(S, S)) #end M(\"abcdefgh\")", "macro bomb": "\n".join(f"#macro M{i}() " + (f"M{i - 1}() " * 10 if i else "sphere { 0, 1 } ") + "#end" for i in range(20)) + "\nM19()",
        "expression bomb": "\n".join(f"#macro M{i}() " + (f"(M{i - 1}() + M{i - 1}())" if i else "1") + " #end" for i in range(60)) + "\nsphere { 0, M59() }",
        "object bomb": "#declare O0 = sphere { 0, 1 };\n" + "\n".join(f"#declare O{i} = union {{ object {{ O{i - 1} }} object {{ O{i - 1} translate x }} }}" for i in range(1, 45)) + "\nobject { O44 }",
        "array bomb": "#declare A = array[1000][1000][1000]", "many arrays": "#for (I, 1, 1e9) #declare A = array[100000] #end", "spheres without end": "#while (1) sphere { rand(seed(1)), 1 } #end",
        "spheres to memory": "#for (I, 1, 1e9) sphere { I, 1 } #end", "vectors without end": "#declare V = 0; #while (1) #declare V = V + <1, 2, 3>; #end", "triangles without end": "mesh { #while (1) triangle { 0, x, y } #end }",
        "declarations without end": "#for (I, 0, 1e9) #declare A = array[2]; #declare A[0] = concat(\"a\", str(I, 0, 0)); #end", "messages without end": '#while (1) #warning "again\\n" #end', "debug without end": '#while (1) #debug "again\\n" #end',
        "wait in a condition": "#while (vlength(<1, 2, 3>) > 0) #if (1) #else #end #end", "polygon without end": "polygon { 1e8, #while (1) x, #end }",
    }
    for limit, (options, most_bytes) in MEMORY_LIMITS.items():
        for name, words in cases.items():
            x.scene(f"endless: {name}, {limit}", GOOD + words + "\n", chatty="#debug" in words, options=options, most_bytes=most_bytes)
        x.scene(
            f"includes a file a million times, {limit}", '#for (I, 1, 1e9) #include "a.inc" #end\n',
            files={"a.inc": "sphere { 0, 1 }\n" * 100}, options=options, most_bytes=most_bytes,
        )
    x.scene("includes itself", '#include "s.pov"\n')
    x.scene("includes in a circle", '#include "a.inc"\n', files={"a.inc": '#include "b.inc"', "b.inc": '#include "a.inc"'})
    x.scene("includes itself twice", '#include "s.pov"\n#include "s.pov"\n')
    for depth in (100, 100_000):
        nests = {
            "parentheses": "sphere { 0, " + "(" * depth + "1" + ")" * depth + " }", "unclosed parentheses": "sphere { 0, " + "(" * depth, "minus signs": "sphere { 0, " + "-" * depth + "1 }", "not signs": "#if (" + "!" * depth + "1) #end",
            "angle brackets": "sphere { " + "<" * depth, "unions": "union { " * depth + "sphere { 0, 1 }" + " }" * depth, "unclosed unions": "union { " * depth, "ifs": "#if (1) " * depth + "#end " * depth, "unclosed ifs": "#if (1) " * depth,
            "elses": "#if (0) #else " * depth, "textures": "sphere { 0, 1 texture { " + "checker texture { " * depth, "pigments": "sphere { 0, 1 pigment { " + "checker pigment { " * depth, "comments": "/* " * depth, "macros": "#macro M() " * depth,
            "braces": "{" * depth, "functions": "sphere { 0, " + "sin(" * depth + "1" + ")" * depth + " }", "question marks": "#declare A = (" + "1 ? 1 : (" * depth + "1" + ")" * depth + ");", "pluses": "sphere { 0, 1" + "+1" * depth + " }",
            "mixed": "sphere { 0, " + "sin(-(<" * depth, "objects": "object { " * depth + "sphere { 0, 1 }" + "}" * depth, "clips": "sphere { 0, 1 clipped_by { " * depth, "whiles": "#while (0) " * depth, "switches": "#switch (1) #case (1) " * depth, "concat": "#declare S = " + "concat(\"a\", " * depth,
            "transforms": "#declare T = " + "transform { " * depth, "arrays": "#declare A = array[1] " + "{" * depth,
        }
        for name, words in nests.items():
            x.scene(f"nested {depth} deep: {name}", GOOD + words + "\n", code=(0, 1), needs_place=False)


def files_and_folders(x):
    x.examine("missing scene", ["render", "none.pov", "-o", "s.png"], 1, says="none.pov")
    x.examine("scene is a folder", ["render", "d.pov", "-o", "s.png"], 1, setup=lambda f: (f / "d.pov").mkdir(), says="d.pov")
    x.examine("scene of an unknown ending", ["render", "s.txt", "-o", "s.png"], 2, {"s.txt": GOOD})
    x.examine("scene without an ending", ["render", "s", "-o", "s.png"], 2, {"s": GOOD})
    x.scene("empty scene", "", code=0)
    x.scene("empty scene, checked", "", code=0, command="check")
    x.scene("missing include", '\n #include "none.inc"\n', place=None, says="none.inc")
    x.scene("include is a folder", '#include "d.inc"\n', setup=lambda f: (f / "d.inc").mkdir(), says="d.inc")
    x.scene("include is /dev/zero", '#include "/dev/zero"\n', says="/dev/zero")
    x.scene("include is a pipe", '#include "pipe.inc"\n', setup=lambda f: os.mkfifo(f / "pipe.inc"), says="pipe.inc")
    x.examine("scene is a pipe", ["render", "p.pov", "-o", "s.png"], 1, setup=lambda f: os.mkfifo(f / "p.pov"), says="p.pov")
    x.scene("include is a dead link", '#include "l.inc"\n', setup=lambda f: (f / "l.inc").symlink_to("nowhere"), says="l.inc")
    x.scene("include is a circle of links", '#include "l.inc"\n', setup=lambda f: (f / "l.inc").symlink_to("l.inc"), says="l.inc")
    if os.geteuid() != 0:
        x.scene("include cannot be read", '#include "a.inc"\n', files={"a.inc": ""}, setup=lambda f: (f / "a.inc").chmod(0), says="a.inc")
        x.examine("output folder is read-only", ["render", "s.pov", "-o", "d/s.png", "--width", "8"], 1, {"s.pov": GOOD}, setup=lambda f: (f / "d").mkdir(0o500))
    render = ["render", "s.pov", "--width", "8", "--height", "6"]
    good = {"s.pov": GOOD}
    x.examine("output into a missing folder", [*render, "-o", "no/s.png"], 1, good, says="no")
    x.examine("output is a folder", [*render, "-o", "d.png"], 1, good, setup=lambda f: (f / "d.png").mkdir(), says="d.png")
    x.examine("output below a file", [*render, "-o", "s.pov/s.png"], 1, good)
    x.examine("output of a trace into a missing folder", ["trace", "s.pov", "--rays", "r.npy", "-o", "no/h.npz"], 1, {**good, "r.npy": npy()}, says="no")
    x.examine("output of a trace is a folder", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": npy()}, setup=lambda f: (f / "h.npz").mkdir())
    for ending in ("jpg", "txt", "", "png.", "npz"):
        x.examine(f"output ending in '{ending}'", [*render, "-o", "s." + ending if ending else "s"], 2, good)
    x.examine("trace to a wrong ending", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npy"], 2, {**good, "r.npy": npy()})
    x.examine("rays missing", ["trace", "s.pov", "--rays", "none.npy", "-o", "h.npz"], 1, good, says="none.npy")
    x.examine("rays are a folder", ["trace", "s.pov", "--rays", "d", "-o", "h.npz"], 1, good, setup=lambda f: (f / "d").mkdir())
    whole = npy()
    for cut in (0, 1, 6, 9, 40, 100, 127, 128, 129, len(whole) - 1):
        x.examine(f"rays cut at {cut}", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": whole[:cut]}, says="r.npy")
    for shape in ("(1000000000000, 6)", "(18446744073709551615, 6)", "(3074457345618258603, 6)", "(99999999999999999999999, 6)", "(-1, 6)", "(2,)", "6", "(2, 6", "('a', 6)", "(2, 6, )) "):
        x.examine(f"rays of shape {shape}", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": npy(shape)})
    x.examine("rays that are noise", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": random.Random(1).randbytes(4000)})
    x.examine("rays of objects", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": npy(descr="'|O'")})
    x.examine("rays of records", ["trace", "s.pov", "--rays", "r.npy", "-o", "h.npz"], 1, {**good, "r.npy": npy(descr="[('a', '<f8'), ('b', '<f8')]")})


def npy(shape="(2, 6)", descr="'<f8'"):
    """An .npy file of two rays, by hand, so that its header may lie."""
    head = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (-(10 + len(head) + 1) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + struct.pack("<12d", *(0, 0, -3, 0, 0, 1) * 2)


# ---- mesh files ----


def gltf(positions=(0, 0, 0, 1.5, 0, 0, 0, 2.25, 0, 0, 0, 3), indices=(0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3), uri=None, change=None):
    """A tetrahedron as a glTF document and its buffer; `change` alters the document."""
    data = struct.pack(f"<{len(positions)}f", *positions) + struct.pack(f"<{len(indices)}H", *indices)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions) // 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 4 * len(positions)}, {"buffer": 0, "byteOffset": 4 * len(positions), "byteLength": 2 * len(indices)}],
        "buffers": [{"byteLength": len(data)}],
    }
    if uri != "":
        document["buffers"][0]["uri"] = uri or "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    if change:
        change(document)
    return json.dumps(document).encode(), data


def glb(document, data):
    document += b" " * (-len(document) % 4)
    data += b"\0" * (-len(data) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(document) + len(data))
    return head + struct.pack("<I4s", len(document), b"JSON") + document + struct.pack("<I4s", len(data), b"BIN\0") + data


def mesh_files(x, rng):
    def mesh(name, file, content, code=1, says=None, files=None, commands=("render", "check"), **rest):
        for command in commands:
            words = ["render", file, "-o", "m.png", "--width", "8", "--height", "6"] if command == "render" else ["check", file]
            makes = ["m.png"] if command == "render" else []
            x.examine(f"mesh file: {name}, {command}", words, code, {file: content, **(files or {})}, says=says, makes=makes, scene=content, **rest)

    text, data = gltf()
    whole = glb(gltf(uri="")[0], data)
    mesh("glTF as text", "m.gltf", text, code=0)
    mesh("glTF as binary", "m.glb", whole, code=0)
    mesh("glTF with a buffer beside it", "m.gltf", gltf(uri="a%20b.bin")[0], code=0, files={"a b.bin": data})
    x.examine("mesh file: trace", ["trace", "m.glb", "--rays", "r.npy", "-o", "h.npz"], 0, {"m.glb": whole, "r.npy": npy()}, makes=["h.npz"])
    beside = gltf(uri="b.bin")[0]
    mesh("its buffer is missing", "m.gltf", beside, says=["m.gltf", "buffer 0", "b.bin"])
    mesh("its buffer is short", "m.gltf", beside, says="buffer 0: it promises 72 bytes", files={"b.bin": data[:-1]})
    mesh("its buffer is a folder", "m.gltf", beside, says="buffer 0", setup=lambda f: (f / "b.bin").mkdir())
    mesh("its buffer is a pipe", "m.gltf", beside, says="buffer 0", setup=lambda f: os.mkfifo(f / "b.bin"))
    mesh("its buffer is /dev/zero", "m.gltf", beside, says="buffer 0", setup=lambda f: (f / "b.bin").symlink_to("/dev/zero"))
    mesh("its buffer is far away", "m.gltf", gltf(uri="https://example.org/b.bin")[0], says="buffer 0")
    for ending in ("glb", "gltf", "obj", "ply", "stl"):
        x.examine(f"mesh file: a pipe, .{ending}", ["check", f"p.{ending}"], 1, setup=lambda f, e=ending: os.mkfifo(f / f"p.{e}"), says=f"p.{ending}")
        x.examine(f"mesh file: a link to /dev/zero, .{ending}", ["check", f"p.{ending}"], 1, setup=lambda f, e=ending: (f / f"p.{e}").symlink_to("/dev/zero"), says=f"p.{ending}")
        for size in (0, 1, 100, 100000):
            mesh(f"noise of {size} bytes", f"m.{ending}", rng.randbytes(size), commands=("check",))
            mesh(f"noise of {size} bytes behind a head", f"m.{ending}", {"glb": whole[:12], "ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 2147483648\nproperty float x\n"}.get(ending, b"") + rng.randbytes(size), commands=("check",))
    for cut in list(range(0, 30)) + list(range(30, len(whole), 41)):
        mesh(f"cut at byte {cut}", "m.glb", whole[:cut], says="m.glb", commands=("check",))
    for cut in range(1, len(text), 61):
        mesh(f"cut at byte {cut}", "m.gltf", text[:cut], says="m.gltf", commands=("check",))

    def put(path, value):
        def change(document):
            *way, last = path
            for step in way:
                document = document[step]
            document[last] = value
        return change

    big = (1 << 31, 1 << 32, (1 << 64) - 1)
    places = [("accessors", 0, "count"), ("accessors", 1, "count"), ("accessors", 0, "byteOffset"), ("bufferViews", 0, "byteLength"), ("bufferViews", 1, "byteOffset"), ("buffers", 0, "byteLength"),
              ("accessors", 0, "bufferView"), ("bufferViews", 0, "buffer"), ("nodes", 0, "mesh"), ("scenes", 0, "nodes", 0), ("scene",), ("meshes", 0, "primitives", 0, "indices")]
    for path in places:
        for value in (*big, -1, 1.5, None, "x", [], 1e400):
            if value is not None or path[-1] not in ("scene", "mesh", "indices", "byteOffset", "bufferView"):
                mesh(f"{'.'.join(map(str, path))} = {value}", "m.glb", glb(gltf(uri="", change=put(path, value))[0], data), says="m.glb", commands=("check",))
    said = {
        "a cycle of nodes": ((("nodes", 0, "children"), [0]), "node 0: it is among its own descendants"),
        "a node twice": ((("scenes", 0, "nodes"), [0, 0]), "node 0: it is in the tree twice"),
        "a singular scale": ((("nodes", 0, "scale"), [1, 0, 1]), "node 0: a scale of 0 in y"),
        "no rotation": ((("nodes", 0, "rotation"), [0, 0, 0, 0]), "node 0: its rotation"),
        "an extension": ((("extensionsRequired",), ["KHR_draco_mesh_compression"]), "not supported yet: KHR_draco_mesh_compression"),
        "a stride": ((("bufferViews", 0, "byteStride"), 0), "bufferView 0: its byteStride of 0"),
        "an old version": ((("asset", "version"), "1.0"), "version 1.0"),
        "zeros that are nowhere": ((("accessors", 0), {"componentType": 5126, "count": 1 << 31, "type": "VEC3"}), "accessor 0: it promises 2147483648 elements"),
        "the same list again and again": ((("meshes", 0, "primitives"), [{"attributes": {"POSITION": 0}, "indices": 1}] * 20000), ""),
    }
    for name, ((path, value), says) in said.items():
        code = (0, 1) if name.startswith("the same") else 1
        mesh(name, "m.glb", glb(gltf(uri="", change=put(path, value))[0], data), code=code, says=says or None, commands=("check",))
    mesh("an index out of range", "m.gltf", gltf(indices=(0, 1, 4))[0], says="accessor 1: there is no vertex 4, there are 4 so far")
    mesh("coordinates that are not finite", "m.gltf", gltf(positions=(float("nan"), 0, 0, float("inf"), 0, 0, 0, 1, 0, 0, 0, 1))[0], code=0, says=None)
    many = gltf(uri="", change=lambda d: (d.update(nodes=[{"mesh": 0, "translation": [2 * i, 0, 0]} for i in range(20000)]), put(("scenes", 0, "nodes"), list(range(20000)))(d)))
    mesh("many instances", "m.glb", glb(many[0], data), code=0)
    for i in range(60):
        bad = bytearray(rng.choice((whole, text)))
        for _ in range(rng.choice((1, 1, 3, 10))):
            bad[rng.randrange(len(bad))] = rng.randrange(256)
        mesh(f"glTF with wrong bytes {i}", "m.glb", bytes(bad), code=(0, 1), commands=("check",))


def wrong_words(x):
    good = {"s.pov": GOOD, "r.npy": npy()}
    lines = [
        [], ["nonsense"], ["render"], ["trace", "s.pov"], ["trace", "s.pov", "--rays", "r.npy"], ["explain", "s.pov"], ["render", "s.pov", "--width", "0"], ["render", "s.pov", "--width", "-3"],
        ["render", "s.pov", "--width", "x"], ["render", "s.pov", "--width", "99999999999"], ["render", "s.pov", "--aa", "on"], ["render", "s.pov", "--aa", "0x0"], ["render", "s.pov", "--aa", "2x3"], ["render", "s.pov", "--aa", "method3"],
        ["render", "s.pov", "--bits", "7"], ["render", "s.pov", "--region", "0,0,1"], ["render", "s.pov", "--region", "4,4,4,8"], ["render", "s.pov", "--region", "a,b,c,d"], ["render", "s.pov", "--threads", "0"], ["render", "s.pov", "--threads", "-1"],
        ["render", "s.pov", "--clock", "x"], ["render", "s.pov", "--clock", "nan"], ["render", "s.pov", "--declare", "X"], ["render", "s.pov", "--declare", "1=2"], ["render", "s.pov", "--declare", "X=y"], ["render", "s.pov", "--limit", "X=1"],
        ["render", "s.pov", "--limit", "steps"], ["render", "s.pov", "--nonsense"], ["render", "s.pov", "t.pov"], ["trace", "s.pov", "--rays", "r.npy", "--query", "some", "-o", "h.npz"], ["explain", "s.pov", "--pixel", "1"],
        ["explain", "s.pov", "--ray", "0,0,0,0,0,0"], ["explain", "s.pov", "--ray", "0,0,0"], ["explain", "s.pov", "--ray", "0,0,-5,0,0,1", "--pixel", "1,1"], ["explain", "s.pov", "--pixel", "-1,0"], ["check"], ["check", "s.pov", "t.pov"],
        ["render", "s.pov", "--declare", "X=nan"], ["render", "s.pov", "-o"], ["render", "s.pov", "--region", "5000,5000,5001,5001"], ["explain", "s.pov", "--pixel", "5000,0"],
    ]
    for words in lines:
        x.examine("wrong words: " + " ".join(words), words, (1, 2) if words[-1:] == ["5000,0"] else 2, good)


# ---- mutants ----


RICH = CAMERA + """#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 5 }
#declare Red = rgb <1, 0.25, 0>; // a colour
#declare N = 3;
/* a block
   comment */
#macro Ball(P, R)
  sphere { P, R pigment { color Red filter 0.5 } finish { phong 0.5 reflection { 0.1, 0.4 } } }
#end
#for (I, 0, N - 1)
  #if (mod(I, 2) = 0) Ball(<I * 1.5, sin(I), 0>, 0.5) #else object { Ball(x, 0.25) rotate y * 45 * I } #end
#end
#switch (N) #case (3) box { -1, <1, 2, 3> matrix <1, 0, 0, 0.5, 1, 0, 0, 0, 1, 0, 0, 4> } #break #else #error "no" #end
union { cylinder { 0, y, 0.5 open } cone { y, 0.5, 2*y, 0 } texture { pigment { checker rgb 1, rgb 0 scale 0.25 } } translate <2, 0, 1> }
plane { y, -1 pigment { gradient x color_map { [0 rgb 0] [0.5 Red] [1 rgb <0, 0, 1>] } } }
mesh { triangle { 0, x, y } smooth_triangle { 0, z, x, -z, y, -z } }
quadric { <1, 0, 1>, <0, 0, 0>, <0, -1, 0>, 0 clipped_by { box { -2, 2 } } interior { ior 1.5 } }
polygon { 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> no_shadow }
#debug concat("done ", str(N, 0, 2), "\\n")
"""


def cut_files(x, every):
    x.scene("the rich scene", RICH, code=0)
    for cut in range(0, len(RICH), every):
        x.scene(f"cut at byte {cut}", RICH[:cut], code=(0, 1), needs_place=False)


def noise(x, rng, count):
    for i in range(count):
        x.scene(f"noise {i}", rng.randbytes(rng.choice((1, 10, 100, 5000))), code=(0, 1), needs_place=False)
        x.scene(f"noise behind a scene {i}", GOOD.encode() + rng.randbytes(rng.choice((1, 3, 100))), code=(0, 1), needs_place=False)
    for name, content in (("zeros", b"\0" * 10000), ("a mark of UTF-8", b"\xef\xbb\xbf" + GOOD.encode()), ("UTF-16", GOOD.encode("utf-16")), ("a long line", b"sphere { 0, 1 } " * 100000 + b"@"),
                          ("a long word", b"a" * 3_000_000), ("a long number", b"sphere { 0, " + b"1" * 1_000_000 + b" }"), ("a long text", b'#declare A = "' + b"a" * 3_000_000 + b'";'), ("many points", b"." * 1_000_000), ("old Macintosh lines", GOOD.replace("\n", "\r").encode())):
        x.scene(f"noise of a kind: {name}", content, code=(0, 1), needs_place=False)


def mutants(x, rng, count):
    sources = [RICH.encode()] + [p.read_bytes() for folder in ("tests/conformance", "scenes") for p in sorted((ROOT / folder).glob("*.pov"))]
    words = re.compile(rb'"[^"\n]*"|[A-Za-z_]\w*|#\w+|\d[\d.e]*|\s+|.', re.S)
    odd = [b"0", b"-1", b"1e308", b"1/0", b"<", b"}", b"{", b"#end", b"#if", b"nan", b'"', b",", b"-", b"(", b")", b"1e-320", b"#while(1)", b"union{", b"0.0000001", b"matrix<0,0,0,0,0,0,0,0,0,0,0,0>", b"\xff"]
    for i in range(count):
        source = rng.choice(sources)
        tokens = words.findall(source)
        for _ in range(rng.choice((1, 1, 1, 2, 5))):
            at, other = rng.randrange(len(tokens)), rng.randrange(len(tokens))
            how = rng.randrange(5)
            if how == 0:
                del tokens[at]
            elif how == 1:
                tokens[at] = tokens[other]
            elif how == 2:
                tokens.insert(at, rng.choice(odd))
            elif how == 3:
                tokens[at] = rng.choice(odd)
            else:
                tokens[at], tokens[other] = tokens[other], tokens[at]
            if not tokens:
                break
        includes = {"stage.inc": (ROOT / "scenes/stage.inc").read_bytes()} if (ROOT / "scenes/stage.inc").exists() else {}
        x.scene(f"mutant {i}", b"".join(tokens), code=(0, 1), needs_place=False, files=includes)


# ---- good inputs of odd shapes ----


def png(data):
    """Width, height, bits, colour type and the decoded rows of a PNG."""
    at, idat, head = 8, b"", None
    while at < len(data):
        n, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + n]
        head = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else head
        idat += body if kind == b"IDAT" else b""
        at += 12 + n
    width, height, bits, colour = head[:4]
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    stride = channels * bits // 8
    raw, rows, above = zlib.decompress(idat), [], bytes(width * stride)
    for y in range(height):
        line = bytearray(raw[y * (width * stride + 1) + 1 : (y + 1) * (width * stride + 1)])
        how = raw[y * (width * stride + 1)]
        for i in range(len(line)):
            a, b, c = (line[i - stride] if i >= stride else 0), above[i], (above[i - stride] if i >= stride else 0)
            p = a + b - c
            paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[how]) & 255
        rows.append(bytes(line))
        above = bytes(line)
    return width, height, bits, channels, rows


def good_inputs(x):
    good = {"s.pov": GOOD, "r.npy": npy()}

    def picture(name, words, size, made="s.png", bits=8):
        made_files = x.examine(name, ["render", "s.pov", *words], 0, good, makes=[made])
        if made_files and made.endswith(".png"):
            w, h, b, channels, rows = png(made_files[Path(made)])
            if (w, h, b) != (*size, bits):
                x.wrong.append((name, "size"))
                print(f"\n== {name}: a picture of {w}x{h} with {b} bits, expected {size} with {bits}")
            return channels, rows
        return None

    picture("default size and name", [], (800, 600))
    picture("width alone", ["--width", "160"], (160, 120))
    picture("height alone", ["--height", "240"], (320, 240))
    picture("one pixel", ["--width", "1", "--height", "1"], (1, 1))
    picture("one column", ["--width", "1", "--height", "301"], (1, 301))
    picture("one row", ["--width", "301", "--height", "1"], (301, 1))
    picture("sixteen bits", ["--width", "9", "--height", "7", "--bits", "16"], (9, 7), bits=16)
    picture("another name", ["--width", "9", "--height", "7", "-o", "t.png"], (9, 7), "t.png")
    for aa in ("off", "method1", "method2", "method1,0.1", "method2,0.1,2", "1x1", "3x3"):
        picture(f"--aa {aa}", ["--width", "13", "--height", "11", "--aa", aa], (13, 11))
    for ending in ("ppm", "exr", "PNG"):
        x.examine(f"a picture in .{ending}", ["render", "s.pov", "--width", "9", "--height", "7", "-o", f"t.{ending}"], 0, good, makes=[f"t.{ending}"])
    whole = picture("the whole picture", ["--width", "40", "--height", "30"], (40, 30))
    part = picture("a region", ["--width", "40", "--height", "30", "--region", "10,5,30,25"], (40, 30))
    if whole and part:
        check_region(x, whole, part)
    picture("a region beyond the border", ["--width", "40", "--height", "30", "--region", "10,5,3000,2500"], (40, 30))
    same = [picture(f"{n} threads", ["--width", "40", "--height", "30", "--threads", str(n)], (40, 30)) for n in (1, 2, 7)]
    if len({str(s) for s in same}) > 1:
        x.wrong.append(("threads", "other picture"))
        print("\n== another number of threads gives another picture")
    x.examine("trace without a camera", ["trace", "t.pov", "--rays", "r.npy", "-o", "h.npz"], 0, {"t.pov": "sphere { 0, 1 }", "r.npy": npy()}, makes=["h.npz"])
    x.examine("check", ["check", "s.pov"], 0, good)
    x.examine("explain a pixel", ["explain", "s.pov", "--pixel", "5,5", "--width", "11", "--height", "11"], 0, good)
    x.examine("explain a ray", ["explain", "s.pov", "--ray", "0,0,-5,0,0,1"], 0, good)
    x.examine("explain a ray that misses", ["explain", "s.pov", "--ray", "0,9,-5,0,0,1"], 0, good)
    x.examine("help", ["--help"], 0)
    x.examine("version", ["--version"], 0)
    x.scene("clock and declare", CAMERA + "#if (clock != 0.25 | Size != 2) #error \"wrong\" #end sphere { 0, Size }", code=1)
    x.examine("clock and declare given", ["render", "s.pov", "--clock", "0.25", "--declare", "Size=2", "--width", "8"], 0,
              {"s.pov": CAMERA + "#if ((clock != 0.25) | (Size != 2)) #error \"wrong\" #end sphere { 0, Size }"}, makes=["s.png"])
    x.examine("-L finds an include", ["render", "s.pov", "-L", "lib", "--width", "8"], 0, {"s.pov": CAMERA + '#include "a.inc"', "lib/a.inc": "sphere { 0, 1 }"}, makes=["s.png"])
    x.scene("include of another case", CAMERA + '#include "PART.INC"', code=0, files={"part.inc": "sphere { 0, 1 }"})
    x.examine("scene of another case", ["render", "S.POV", "-o", "s.png", "--width", "8"], 0, {"S.POV": GOOD}, makes=["s.png"])
    x.examine("a scene in another folder", ["render", "d/s.pov", "--width", "8"], 0, {"d/s.pov": GOOD}, makes=["s.png"])
    x.examine("an old picture is replaced", ["render", "s.pov", "--width", "8"], 0, {**good, "s.png": b"old"})
    interrupt(x)


def check_region(x, whole, part):
    channels, rows = part
    full = whole[0]
    for j, row in enumerate(rows):
        for i in range(40):
            pixel, all_ = row[i * channels : (i + 1) * channels], whole[1][j][i * full : i * full + 3]
            inside = 10 <= i < 30 and 5 <= j < 25
            if channels != 4 or (pixel[3] == 0) == inside or inside and pixel[:3] != all_:
                x.wrong.append(("region", "pixels"))
                print(f"\n== region: pixel {i},{j} is {list(pixel)}, whole picture {list(all_)}, inside {inside}")
                return


SLOW = CAMERA + "#declare R = seed(1); union { #for (I, 1, 3000) sphere { <rand(R)*4-2, rand(R)*4-2, rand(R)*4>, 0.1 pigment { rgb 1 } finish { reflection 0.5 } } #end }\n"

GLASSY = ("global_settings { max_trace_level 30 adc_bailout 0 }\n"
          + SLOW.replace("pigment { rgb 1 } finish { reflection 0.5 }", "pigment { rgb 1 transmit 0.9 } finish { reflection 0.9 }"))


def interrupt(x):
    """Ctrl-C keeps what is done beside the output, and an older picture stays."""
    old = b"an older picture"
    for wait in (0.5, 3.0):
        words = ["render", "s.pov", "--width", "3000", "--height", "3000", "--aa", "9x9", "-o", "s.png"]
        made = x.examine(f"Ctrl-C after {wait} s", words, 130, {"s.pov": SLOW, "s.png": old}, makes=["s.partial.png"], stop_after=wait)
        if made:
            w, h, *_ = png_head(made[Path("s.partial.png")])
            if (w, h) != (3000, 3000):
                x.wrong.append(("Ctrl-C", "size"))
                print(f"\n== Ctrl-C: the partial picture has {w}x{h} pixels")
    # A pixel of this takes minutes, and there are only a few: it is answered within one, too.
    for aa in ("off", "9x9", "method1", "method2,0.1,5"):
        words = ["render", "s.pov", "--width", "40", "--height", "30", "--aa", aa, "-o", "s.png"]
        start = time.monotonic()
        made = x.examine(f"Ctrl-C within a pixel, {aa}", words, 130, {"s.pov": GLASSY, "s.png": old}, makes=["s.partial.png"], stop_after=2.0)
        waited = time.monotonic() - start - 2.0
        if made and waited > 2.0:
            x.wrong.append(("Ctrl-C", "late"))
            print(f"\n== Ctrl-C within a pixel, {aa}: answered after {waited:.1f} s")


def png_head(data):
    return struct.unpack(">II", data[16:24])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--durer", type=Path, default=ROOT / "target/release/durer")
    parser.add_argument("--mutants", type=int, default=200)
    parser.add_argument("--cut-every", type=int, default=7, help="bytes between the cuts of the rich scene")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="only the cases with this in their name")
    args = parser.parse_args()
    x, rng = Examiner(args.durer, args.only), random.Random(args.seed)
    good_inputs(x)
    wrong_words(x)
    files_and_folders(x)
    mesh_files(x, rng)
    wrong_values(x)
    cut_files(x, args.cut_every)
    noise(x, rng, max(3, args.mutants // 10))
    mutants(x, rng, args.mutants)
    endless(x)
    print(f"\n{x.done} cases, {len(x.wrong)} violations")
    return 1 if x.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
