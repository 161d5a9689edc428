"""What exact arithmetic expects of one ray, and how the answers of the command compare with it."""

import math
import sys
from collections import Counter, defaultdict
from fractions import Fraction as F

from exact import to_float, union
from nets import Place
from patches import Patch
from shapes import IDENTITY, Event, Loops, dot
from solids import Region
from zero_sets import ZeroSet

INF = float("inf")
U = 2.0**-53
LARGEST = sys.float_info.max


class Expected:
    def __init__(self, scene, ray, world_ties=False, turn=None):
        o, d, (lo, hi) = ray[:3], ray[3:6], ray[6:]
        self.events = defaultdict(list)
        self.within = False
        sets, self.defined = [], True
        if not (lo <= hi):
            self.spans = []
            return
        for number, leaves in enumerate(scene.objects):
            first = 0
            for leaf in leaves:
                if world_ties and isinstance(leaf, Loops):
                    leaf = in_world(leaf)
                axes = leaf.axes(o, d, leaf.whole) if turn is not None and isinstance(leaf, Loops) else []
                answer = leaf.answer(o, d, leaf.whole, axes[turn % len(axes)]) if axes else leaf.answer(o, d, leaf.whole)
                self.within |= answer.within
                for e in answer.events:
                    if e.t.cmp(max(lo, -LARGEST)) >= 0 and e.t.cmp(min(hi, LARGEST)) <= 0:
                        self.events[number, first + e.face if leaf.faces > 1 else first].append((e, leaf))
                if leaf.solid():
                    sets.append(answer.inside)
                first += leaf.faces
        self.spans = [s for s in (cut(s, lo, hi) for s in union(sets)) if s]

    def count(self):
        return sum(map(len, self.events.values()))


def cut(span, lo, hi):
    """An interval within the range [lo, hi]; None if it has no length there."""
    a, b = span
    first, last = max(lo, -LARGEST), min(hi, LARGEST)
    a = None if a is None or a.cmp(first) <= 0 else a
    b = None if b is None or b.cmp(last) >= 0 else b
    if a is not None and a.cmp(last) >= 0 or b is not None and b.cmp(first) <= 0:
        return None
    return None if a is None and b is None and lo == hi else (a, b)


def in_world(leaf):
    """Outlines with their vertices where the map puts them."""
    if not hasattr(leaf, "moved"):
        faces = [[[leaf.whole.point(tuple(F(x, 1 << leaf.bits) for x in v)) for v in loop] for loop in loops] for loops in leaf.outlines]
        leaf.moved = leaf.with_faces(faces)
        leaf.moved.whole, leaf.moved.mirrored = IDENTITY, leaf.whole.det < 0
    return leaf.moved


class Report:
    """What was found, by kind of mistake, with the first examples."""

    def __init__(self):
        self.wrong, self.examples = Counter(), defaultdict(list)
        self.rays = self.hits = self.spans = self.notes = 0
        self.widths = defaultdict(list)
        self.counted, self.clusters = Counter(), Counter()

    def add(self, what, scene, ray, expected, got, limit=40):
        key = (scene.kind, what)
        self.wrong[key] += 1
        if len(self.examples[key]) < limit:
            self.examples[key].append((scene.words, ray, expected, got))


def ulp_of(x):
    return math.ldexp(1.0, max(math.frexp(x)[1] - 53, -1074)) if math.isfinite(x) else INF


def close_normal(event, leaf, n, ray, width, direction):
    """Whether a normal is that of one of the faces that may be meant; the allowance grows with the bracket and the map."""
    t = event.t.rational(100)
    x, v, w = leaf.whole.ray(ray[:3], ray[3:6])
    p = tuple((a + t * b) / w for a, b in zip(x, v))
    # How far the point may be off, in the leaf's frame: the bracket, and some ulps.
    off = max(abs(to_float(b * F(width) / w)) for b in v) + 1e-13 * (max(abs(to_float(c)) for c in p) + to_float(leaf.size))
    stretch = max(abs(to_float(x)) for r in leaf.whole.rows for x in r) * max(abs(to_float(F(x, leaf.whole.w))) for r in leaf.whole.n for x in r)
    best, allowed = INF, 1e-9 * stretch
    for source, flip in event.normals:
        curved = hasattr(source, "gradient")
        g = source.gradient(p) if curved else source
        if not any(g):
            return True
        # The gradient turns by the second derivatives times that distance.
        top = max(map(abs, map(F, g)))
        turn = 6 * F(source.bend(p)) * F(off) / top if curved else 0
        if turn > F(1, 1000):
            return True
        allowed = max(allowed, 1e-9 * stretch + 100 * stretch * to_float(turn))
        # Of length one, about, lest it leaves the range of f64.
        g = leaf.whole.normal(tuple(flip * F(x) / top for x in g))
        top = max(map(abs, g))
        g = [to_float(x / top) for x in g]
        length = math.sqrt(sum(x * x for x in g))
        g = [x / length for x in g]
        best = min(best, max(abs(a - b) for a, b in zip(g, n)))
        if isinstance(leaf, Loops):
            best = min(best, max(abs(a + b) for a, b in zip(g, n)))
    return best <= allowed


def sources_within(leaf, lo, hi):
    """What has its normal at the places, of all that a rounded surface's boundary may be at, that a bracket holds."""
    if getattr(leaf, "certain", True):
        return []
    return [s for r, s in leaf.met if s is not None and r.cmp(float(lo)) >= 0 and r.cmp(float(hi)) <= 0]


def check_hit(report, scene, ray, event, leaf, hit, widths):
    t, lo, hi = hit["t"], hit["t_lo"], hit["t_hi"]
    bad = lambda what, expected: report.add(what, scene, ray, expected, describe(hit))
    if not (lo <= t <= hi):
        bad("t outside its own bracket", event)
    if event.t.cmp(float(lo)) < 0 or event.t.cmp(float(hi)) > 0:
        bad("exact t outside the bracket", event)
    if hit["kind"] == 2:
        bad("cluster where exact arithmetic decides", event)
    elif (hit["kind"] == 1) != (hit["sign"] == 0):
        bad("kind and sign disagree", event)
    oriented = getattr(leaf, "oriented", True)
    mirrored = leaf.whole.det < 0 or getattr(leaf, "mirrored", False)
    sgn = event.sign
    n, d = hit["normal"], ray[3:6]
    # A touch of an edge has the normal of a face beside it.
    if isinstance(leaf, Loops) and not event.faces or event.any_sign and hit["sign"] and event.normals:
        along = sum(F(float(a)) * F(b) for a, b in zip(n, d))
        if abs(along) > 1e-9 * max(map(abs, d)) and (along > 0) != (hit["sign"] > 0):
            bad("sign against the reported normal", event)
    if hit["sign"] != sgn and not event.any_sign:
        if isinstance(leaf, Loops) and hit["sign"] == -sgn and (mirrored or not oriented):
            report.counted["normal of a mirrored or polygonal sheet: by the moved corners"] += 1
        else:
            bad("wrong sign", event)
    length = sum(x * x for x in n)
    if not abs(length - 1) < 1e-15 * 4:
        bad("normal without unit length", event)
    elif not math.isfinite(hi - lo):
        # Only where the exact parameter is next to the largest number.
        if abs(t) < 1e290:
            bad("bracket without an end", event)
        return
    elif event.normals and not close_normal(event, leaf, n, ray, hi - lo, d):
        # Of a rounded surface that meets its container's face, or a seam, within the bracket, either is told.
        beside = Event(event.t, event.sign, [(s, f) for s in sources_within(leaf, lo, hi) for f in (1, -1)], leaf)
        if not close_normal(beside, leaf, n, ray, hi - lo, d):
            bad("wrong normal", event)
    if not all(map(math.isfinite, hit["uv"])):
        bad("uv not finite", event)
    # The point: its error is not told, but it can hardly exceed the bracket's, and some ulps of the numbers on the way into the leaf's frame and back.
    exact = event.t.rational(120)
    world = [F(a) + exact * F(b) for a, b in zip(ray, ray[3:6])]
    back = max(sum(abs(to_float(F(n, leaf.whole.w) * (p - c))) for n, p, c in zip(row, world, leaf.whole.c)) for row in leaf.whole.n) + to_float(leaf.size)
    speed = max(abs(to_float(dot(row, tuple(map(F, ray[3:6]))) / leaf.whole.w)) for row in leaf.whole.n)
    for i, p in enumerate(world):
        about = sum(abs(to_float(m)) for m in leaf.whole.rows[i]) * back + abs(to_float(leaf.whole.c[i]))
        # Zero sets and what is put together from them are resolved on the surface itself, in its own frame, so that what the bracket leaves open goes all ways there.
        moved = max(speed * sum(abs(to_float(m)) for m in leaf.whole.rows[i]), abs(ray[3 + i])) if isinstance(leaf, (Region, ZeroSet)) else abs(ray[3 + i])
        open_ = float(event.t.r - event.t.l) if isinstance(event.t, Place) else 0
        allowed = (4 * float(hi - lo) + open_) * moved + 1024 * U * about
        if not abs(to_float(F(float(hit["position"][i])) - p)) <= allowed:
            bad("wrong position", f"{event} position[{i}] = {to_float(p)!r}, not {float(hit['position'][i])!r}")
            break
    size = to_float(leaf.size * max(abs(x) for row in leaf.whole.rows for x in row)) / math.sqrt(sum(x * x for x in d))
    if hit["kind"] == 0:
        widths.append(float(hi - lo) / ulp_of(max(abs(float(t)), size)))


def describe(hit):
    return f"t={float(hit['t'])!r} [{float(hit['t_lo'])!r}, {float(hit['t_hi'])!r}] sign={hit['sign']} kind={hit['kind']} object={hit['object']} primitive={hit['primitive']} normal={[float(x) for x in hit['normal']]}"


def compare(expected, hits, ray):
    """Pairs of expected events and hits, or None if the counts differ."""
    found = defaultdict(list)
    for h in hits:
        found[int(h["object"]), int(h["primitive"])].append(h)
    # A touch may be reported by any of several faces.
    for (number, face), events in list(expected.events.items()):
        for e, leaf in [pair for pair in events if pair[0].faces]:
            for other in {face - e.face + f for f in e.faces} - {face}:
                for h in [h for h in found[number, other] if h["sign"] == 0 and e.t.cmp(float(h["t_lo"])) >= 0 and e.t.cmp(float(h["t_hi"])) <= 0]:
                    found[number, other] = [g for g in found[number, other] if g is not h]
                    found[number, face].append(h)
    found = {k: v for k, v in found.items() if v}
    for v in found.values():
        v.sort(key=lambda h: h["t"])
    if {k: len(v) for k, v in found.items()} != {k: len(v) for k, v in expected.events.items()}:
        return None
    return [(e, leaf, h) for key, events in expected.events.items() for (e, leaf), h in zip(events, in_turn(events, found[key], ray))]


def in_turn(events, hits, ray):
    """The hits in the order of the events, if they only stand in another order where their brackets overlap: on an edge, which two faces share. Normals say which is which."""
    if [h["sign"] for h in hits] == [e.sign for e, _ in events] and not any(e.any_sign for e, _ in events):
        return hits
    left, order = list(hits), []
    for e, leaf in events:
        inside = lambda h: h["t_lo"] <= left[0]["t_hi"] and e.t.cmp(float(h["t_lo"])) >= 0 and e.t.cmp(float(h["t_hi"])) <= 0
        normal = lambda h: close_normal(e, leaf, h["normal"], ray, h["t_hi"] - h["t_lo"], ray[3:6])
        same = [h for h in left if inside(h) and (e.any_sign or h["sign"] == e.sign)]
        if len(same) > 1:
            same.sort(key=lambda h: not normal(h))
        order.append(same[0] if same else left[0])
        left = [h for h in left if h is not order[-1]]
    return order


def rows_of(hits, mine):
    return [h for h in hits if any(h is m for m in mine)]


def matched(report, scene, ray, expected, hits, on_the_line):
    """Hits and crossings where clusters stand for what rounding leaves open, and touches of edges may be told or not: the pairs, or None.

    A simple crossing's bracket holds one crossing, and that of a cluster any number of them, which add up to its sign. `on_the_line` are the hits of the ray without its range.
    """
    everywhere = Expected(scene, (*ray[:6], -INF, INF))
    found, wrong = defaultdict(list), []
    for h in hits:
        found[int(h["object"]), int(h["primitive"])].append(h)
    pairs, clear = [], True
    overlap = lambda g, h: g["t_lo"] <= h["t_hi"] and h["t_lo"] <= g["t_hi"]
    for key in {*found, *expected.events}:
        leaf = scene.objects[key[0]][0] if len(scene.objects[key[0]]) == 1 else None
        certain = leaf is None or getattr(leaf, "certain", True)
        exact_ends = certain and getattr(leaf, "exact_ends", True)
        left, loose = list(everywhere.events[key]), []
        inside = lambda e, h: e.t.cmp(float(h["t_lo"])) >= 0 and e.t.cmp(float(h["t_hi"])) <= 0
        # Of several at a corner those whose normal is that of a crossing are that.
        is_plain = lambda e, at, h: (e.sign == h["sign"] or e.any_sign) and inside(e, h) and (not e.normals or close_normal(e, at, h["normal"], ray, h["t_hi"] - h["t_lo"], ray[3:6]))
        crowded = [h for h in found[key] if any(g is not h and overlap(g, h) for g in found[key])]
        unlike = lambda h: any(h is c for c in crowded) and not any(is_plain(e, at, h) for e, at in left)
        # Where a rounded surface meets its container's face within the bracket.
        is_rim = lambda h: not certain and leaf.passes_an_edge(leaf.whole.ray(ray[:3], ray[3:6]), float(h["t_lo"]), float(h["t_hi"]))
        # A patch tells what is as small as its rounding errors as a touch or a cluster; at its border a crossing counts or not, and a touch may be half of one.
        is_patch = isinstance(leaf, Patch)
        is_open = lambda h: h["kind"] == 2 or is_patch and h["kind"] == 1
        joined = []
        # Simple ones first; of rounded surfaces one whose bracket holds an end of the range may be on either side of it.
        for h in sorted(found[key], key=lambda h: (is_open(h), unlike(h))):
            if any(h is g for g in joined):
                continue
            held = [pair for pair in left if inside(pair[0], h)]
            if is_open(h):
                report.clusters[scene.kind] += h["kind"] == 2
                total = h["sign"]
                if is_patch:
                    # Open ones that overlap are one.
                    mine = [h]
                    for g in mine:
                        mine += [other for other in found[key] if is_open(other) and overlap(other, g) and not any(other is r for r in mine)]
                    joined += mine
                    held = [pair for pair in left if any(inside(pair[0], g) for g in mine)]
                    total = sum(g["sign"] for g in mine)
                clear = False
                # What is beyond an end of the range may have a bracket of its own, which is not told.
                told = [e for e, _ in held if e.t.cmp(max(ray[6], -LARGEST)) >= 0 and e.t.cmp(min(ray[7], LARGEST)) <= 0]
                straddles = any(h["t_lo"] <= end <= h["t_hi"] for end in ray[6:])
                sums = {sum(e.sign for e, _ in held)} | ({sum(e.sign for e in told)} if straddles else set())
                for e, _ in held if is_patch else ():
                    if e.optional or straddles:
                        sums |= {s - e.sign + k for s in sums for k in (-1, 0, 1)}
                if is_patch and total not in sums:
                    # Each of them at a border may have any sign.
                    free = sum(leaf.passes_the_border(leaf.whole.ray(ray[:3], ray[3:6]), float(g["t_lo"]), float(g["t_hi"])) for g in mine)
                    report.counted["unproven crossing at a border, any sign"] += free
                    sums |= {s + k for s in sums for k in range(-free, free + 1)}
                # Those that are told next to it, from one to the next.
                reach = [h]
                for g in reach:
                    reach += [other for other in found[key] if overlap(other, g) and not any(other is r for r in reach)]
                beside = [g for g in loose if any(g is r for r in reach)]
                if total + sum(g["sign"] for g in beside) not in sums and not (leaf and leaf.clip):
                    wrong.append("cluster with another sign")
                if certain:
                    wrong.append("cluster where exact arithmetic decides")
                elif len(held) < 2 and not any(e.sign == 0 or len(e.normals) > 1 for e, _ in held) and not any(near(leaf.whole.ray(ray[:3], ray[3:6]), float(h["t_lo"]), float(h["t_hi"])) for near in (leaf.is_tangent, leaf.passes_an_edge)):
                    wrong.append("cluster away from tangents and edges")
                left = [pair for pair in left if pair not in held]
                continue
            mine = [pair for pair in held if pair[0].sign == h["sign"] and not pair[0].any_sign]
            mine = mine or sorted(held, key=lambda pair: bool(pair[0].normals) and not close_normal(*pair, h["normal"], ray, h["t_hi"] - h["t_lo"], ray[3:6]))
            if exact_ends or not any(h["t_lo"] <= end <= h["t_hi"] for end in ray[6:]):
                mine = [pair for pair in mine if any(pair[0].t.cmp(e.t) == 0 for e, _ in expected.events[key])]
            if not mine:
                # Into a corner and out of it again, or not at all, where the corner is only touched.
                corner = any((e.optional or len(e.normals) > 1) and inside(e, h) for e, _ in everywhere.events[key]) or is_rim(h)
                twin = any(g is not h and g["sign"] == -h["sign"] and overlap(g, h) for g in found[key])
                clear = False
                loose.append(h)
                # Where a profile crosses or touches itself, each branch is met by itself; the signs of a solid's add up to that of the point.
                met = [e for e, _ in everywhere.events[key] if inside(e, h)]
                mates = [g for g in found[key] if any(inside(e, g) for e in met)]
                summed = any(e.any_sign for e in met) or sum(e.sign for e in met) == sum(g["sign"] for g in mates)
                branches = any(e.branches > 1 for e in met) and len(mates) <= sum(e.branches for e in met) and summed
                if not (corner and twin or branches):
                    wrong.append("extra crossing")
                continue
            if mine[0][0].sign != h["sign"] and not (mine[0][0].any_sign and h["sign"]) and (mine[0][0].optional or len(mine[0][0].normals) > 1):
                # One of several at a corner.
                clear = False
                loose.append(h)
                continue
            left.remove(mine[0])
            pairs.append((*mine[0], h))
            more = [pair for pair in left if inside(pair[0], h)]
            alone = not any(g is not h and overlap(g, h) for g in found[key])
            if more and alone and sum(e.sign for e, _ in more) == 0 and is_rim(h):
                # There it is one, told as the container's is.
                clear = False
                left = [pair for pair in left if pair not in more]
        left = [e for e, _ in left if e.t.cmp(max(ray[6], -LARGEST)) >= 0 and e.t.cmp(min(ray[7], LARGEST)) <= 0]
        # What a rounded surface tells on the other side of an end of the range, within its bracket.
        straddled = lambda e: isinstance(e.t, Place) and any(e.t.l < end < e.t.r for end in ray[6:])
        beyond = lambda e: straddled(e) or not exact_ends and any(inside(e, h) and any(h["t_lo"] <= end <= h["t_hi"] for end in ray[6:]) for h in on_the_line)
        if not all(e.optional and not e.needed or beyond(e) for e in left):
            wrong.append("missing crossing")
        clear &= not left
    if expected.within:
        report.counted["line within a surface that is put together: not examined"] += 1
        return None, []
    for what in sorted(set(wrong)):
        shown = {k: [e for e, _ in v] for k, v in expected.events.items() if v}
        report.add(what, scene, ray, shown, [describe(h) for h in hits])
    return (None, []) if wrong else (clear and len(pairs) == expected.count(), pairs)


def check_ray(report, scene, ray, hits, on_the_line, widths):
    expected = Expected(scene, ray)
    report.hits += len(hits)
    if any(isinstance(leaf, Region) for leaves in scene.objects for leaf in leaves):
        clear, pairs = matched(report, scene, ray, expected, hits, on_the_line)
        for event, leaf, hit in pairs:
            check_hit(report, scene, ray, event, leaf, hit, widths)
        return expected, pairs if clear else None
    ts = [h["t"] for h in hits]
    if any(a > b for a, b in zip(ts, ts[1:])):
        report.add("all: not ascending", scene, ray, "", ts)
    pairs = compare(expected, hits, ray)
    fits = lambda pairs: pairs is not None and all(e.t.cmp(float(h["t_lo"])) >= 0 and e.t.cmp(float(h["t_hi"])) <= 0 for e, _, h in pairs)
    if not fits(pairs) and any(isinstance(leaf, Loops) for leaves in scene.objects for leaf in leaves):
        placed = any(isinstance(leaf, Loops) and leaf.whole.rows != IDENTITY.rows for leaves in scene.objects for leaf in leaves)
        for way in ({"world_ties": True}, {"turn": 0}, {"turn": 1}) if placed else ():
            other = Expected(scene, ray, **way)
            others = compare(other, hits, ray)
            if fits(others):
                report.counted[f"ties of placed outlines taken otherwise: {way}"] += 1
                expected, pairs = other, others
                break
    if pairs is None:
        more = len(hits) - expected.count()
        what = "missing crossing" if more < 0 else "extra crossing" if more > 0 else "crossing of another primitive"
        if expected.within:
            what += " (line within the surface)"
        shown = {k: [e for e, _ in v] for k, v in expected.events.items()}
        report.add(what, scene, ray, shown, [describe(h) for h in hits])
        return expected, None
    for leaf in {leaf for _, leaf, _ in pairs if leaf.solid()}:
        mine = [h for _, other, h in pairs if other is leaf]
        if isinstance(leaf, Loops) and any(a["t_hi"] >= b["t_lo"] for a, b in zip(mine, mine[1:])):
            continue  # On an edge: the two faces at one t come in any order.
        signs = [h["sign"] for h in rows_of(hits, mine) if h["sign"]]
        if any(a == b for a, b in zip(signs, signs[1:])) or signs and signs[0] != next(e.sign for e, other, _ in pairs if other is leaf and e.sign):
            report.add("not entered and left in turn", scene, ray, [e for e, other, _ in pairs if other is leaf], [describe(h) for h in rows_of(hits, mine)])
    for event, leaf, hit in pairs:
        check_hit(report, scene, ray, event, leaf, hit, widths)
    return expected, pairs


def is_thin(span, pairs, lo, hi):
    """Whether a span is not longer than the bracket of one of its ends."""
    ends = [F(x) if isinstance(x, float) else x.rational(100) for x in (e if e is not None else r for e, r in zip(span, (lo, hi))) if not (isinstance(x, float) and math.isinf(x))]
    return len(ends) == 2 and any(h["t_lo"] <= ends[0] and ends[1] <= h["t_hi"] for _, _, h in pairs)


def check_spans(report, scene, ray, expected, pairs, rows):
    """Against the exact set, and bit for bit against the crossings of `all`."""
    report.spans += len(rows)
    if expected.within or pairs is None:
        return
    lo, hi = ray[6:]
    bad = lambda what: report.add(what, scene, ray, expected.spans, [tuple(map(float, r)) for r in rows])
    by_end = {}
    for _, _, h in pairs:
        by_end.setdefault((h["sign"], float(h["t"])), []).append(h)
    holds = lambda hits, inside: any(inside(h["t_lo"], h["t_hi"]) for h in hits)
    wanted = expected.spans
    if lo == hi:
        return  # A range without length: whether it makes a span is nobody's business.
    if len(rows) != len(wanted):
        # Neighbours whose brackets overlap may fuse, a span thinner than its brackets may vanish.
        closest = [h for _, _, h in sorted(pairs, key=lambda p: p[2]["t"])]
        overlap = any(a["t_hi"] >= b["t_lo"] for a, b in zip(closest, closest[1:]))
        thin = any(is_thin(span, pairs, lo, hi) for span in wanted) or any(h["t_lo"] <= r[0] <= r[1] <= h["t_hi"] for r in rows for _, _, h in pairs)
        return None if overlap or thin else bad("spans: wrong number")
    for (t_in, t_out, object_in, object_out), (a, b) in zip(rows, wanted):
        for t, number, end, side, bound in ((t_in, object_in, a, -1, lo), (t_out, object_out, b, 1, hi)):
            word = "t_in" if side < 0 else "t_out"
            if end is None:
                if t == bound and number == -1:
                    continue
                # A range that ends exactly on the surface may name it.
                if holds(by_end.get((side, float(t)), []), lambda low, high: low <= bound <= high):
                    continue
                bad(f"spans: {word} should be the range's end with object -1")
            elif number == -1 and t == bound and len({h["sign"] for _, _, h in pairs if h["t_lo"] <= bound <= h["t_hi"]} & {-1, 1}) == 2:
                # A gap at the end of the range that is thinner than the brackets around it may be closed.
                continue
            elif (side, float(t)) not in by_end:
                bad(f"spans: {word} is no crossing of `all`")
            else:
                if not holds(by_end[side, float(t)], lambda low, high: end.cmp(float(low)) >= 0 >= end.cmp(float(high))):
                    bad(f"spans: {word} is the wrong crossing")
                if number < 0 or number >= len(scene.objects):
                    bad(f"spans: object of {word}")
