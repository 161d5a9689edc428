"""Queries of scenes: arrays in, arrays out."""

import copy
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import durer

BALL = durer.Sphere((0, 0, 0), 1)
SCENE = durer.Scene([BALL, durer.Box((2, -1, -1), (4, 1, 1))])


def some_rays(n=3000, seed=1):
    rng = np.random.default_rng(seed)
    origins = rng.uniform(-6, 6, (n, 3))
    return origins, rng.uniform(-2, 4, (n, 3)) - origins


def test_closest_any_and_all_agree():
    origins, directions = some_rays()
    first, every = SCENE.closest(origins, directions), SCENE.all(origins, directions)
    hit = first.hit
    assert 500 < hit.sum() < 2900
    assert (SCENE.any(origins, directions) == hit).all()
    assert ((every.counts > 0) == hit).all()
    heads = every.offsets[:-1][hit]
    for name in ("t", "t_lo", "t_hi", "object", "primitive", "kind", "sign", "normal", "position"):
        assert np.array_equal(every[name][heads], first[name][hit]), name
    assert (np.repeat(np.arange(len(origins)), every.counts) == every.ray).all()
    assert all((np.diff(every.t[a:b]) >= 0).all() for a, b in zip(every.offsets[:-1], every.offsets[1:]))


def test_positions_lie_on_surfaces_within_their_bounds():
    origins, directions = some_rays()
    hits = SCENE.closest(origins, directions)
    on_ball = hits.object == 0
    p, e = hits.position[on_ball], hits.position_error[on_ball]
    off = np.abs((p**2).sum(1) - 1)
    assert (off <= 2 * (np.abs(p) * e).sum(1) * (1 + 1e-9) + 1e-15).all()
    assert ((hits.t_lo <= hits.t) & (hits.t <= hits.t_hi))[hits.hit].all()
    assert np.allclose(hits.normal[on_ball], p, atol=1e-12)


def test_a_ray_that_misses_has_nothing():
    hits = SCENE.closest([[0, 0, 9]], [[0, 0, 1]])
    assert np.isinf(hits.t[0]) and hits.object[0] == -1 and hits.primitive[0] == -1 and hits.kind[0] == 255
    assert np.isnan(hits.position).all() and np.isnan(hits.normal).all() and np.isnan(hits.uv).all()


def test_rays_that_are_not_finite_miss_and_are_counted():
    rays = np.array([[np.nan, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0], [0, 0, -5, 0, 0, np.inf], [0, 0, -5, 0, 0, 1.0]])
    for result in (SCENE.closest(rays), SCENE.all(rays), SCENE.spans(rays)):
        assert result.invalid == 3
    assert SCENE.any(rays).tolist() == [False, False, False, True]
    assert SCENE.contains([[np.nan, 0, 0], [0, 0, 0]]).tolist() == [False, True]


@pytest.mark.parametrize("dtype", ["f4", ">f8", "i4", "f2", "u1"])
def test_other_dtypes_are_converted(dtype):
    rays = np.array([[0, 0, 9, 0, 0, 1], [3, 0, 9, 0, 0, 2]]).astype(dtype)
    expected = SCENE.closest(rays.astype(float)).t
    assert np.array_equal(SCENE.closest(rays).t, expected)
    assert np.array_equal(SCENE.closest(rays[:, :3], rays[:, 3:]).t, expected)


def test_layouts_do_not_matter():
    origins, directions = some_rays(100)
    rays = np.hstack([origins, directions])
    expected = SCENE.closest(rays).t
    wide = np.zeros((100, 12))
    wide[:, ::2] = rays
    backwards = rays[::-1].copy()[::-1]
    for other in (np.asfortranarray(rays), wide[:, ::2], backwards, rays.tolist()):
        assert np.array_equal(SCENE.closest(other).t, expected)
    assert np.array_equal(SCENE.closest(np.asfortranarray(origins), directions[::1]).t, expected)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((np.zeros(6),), r"\(6,\)"),
        ((np.zeros((4, 5)),), r"\(4, 5\)"),
        ((np.zeros((2, 3, 6)),), r"\(2, 3, 6\)"),
        ((np.zeros((4, 3)), np.zeros((3, 3))), r"\(4, 3\) and \(3, 3\)"),
        ((np.zeros((4, 2)), np.zeros((4, 3))), r"origins.*\(4, 2\)"),
        ((np.zeros((4, 6), complex),), "complex"),
        ((None,), "object"),
        ((np.array([["a"] * 6]),), "<U1"),
    ],
)
def test_wrong_arrays_are_refused_by_shape_and_dtype(arguments, said):
    for query in (SCENE.closest, SCENE.any, SCENE.all, SCENE.spans):
        with pytest.raises(ValueError, match=said):
            query(*arguments)


def test_no_rays_are_no_answers():
    for empty in ([], np.zeros((0, 6))):
        assert SCENE.closest(empty).t.shape == (0,)
        assert SCENE.closest(empty).position.shape == (0, 3)
        assert SCENE.all(empty).offsets.tolist() == [0]
    assert SCENE.any(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)
    assert durer.Scene().closest([[0, 0, 0, 1, 0, 0]]).hit.tolist() == [False]


def test_ranges_are_closed():
    rays = np.array([[0, 0, -5, 0, 0, 1.0, 4, 5], [0, 0, -5, 0, 0, 1.0, 4.5, 5], [0, 0, -5, 0, 0, 1.0, 0, 4]])
    assert SCENE.any(rays).tolist() == [True, False, True]
    given = SCENE.any(rays[:, :3], rays[:, 3:6], t_min=rays[:, 6], t_max=rays[:, 7])
    assert given.tolist() == [True, False, True]
    with pytest.raises(ValueError, match="twice"):
        SCENE.any(rays, t_min=0.0)
    with pytest.raises(ValueError, match=r"t_max.*\(2,\)"):
        SCENE.any(rays[:, :6], t_max=[1.0, 2.0])


def test_the_number_of_threads_changes_nothing():
    origins, directions = some_rays(70000)
    one, many = SCENE.all(origins, directions, threads=1), SCENE.all(origins, directions, threads=3)
    for name in one:
        assert np.array_equal(one[name], many[name], equal_nan=True), name
    with pytest.raises(ValueError, match="threads"):
        SCENE.any(origins, directions, threads=0)


def test_spans_merge_solids():
    spans = SCENE.spans([[-5, 0, 0], [0, 0, 0], [0, 5, 0]], [[1, 0, 0]] * 3)
    assert spans.offsets.tolist() == [0, 2, 4, 4]
    assert spans.t_in.tolist() == [4, 7, 0, 2] and spans.t_out.tolist() == [6, 9, 1, 4]
    assert spans.object_in.tolist() == [0, 1, -1, 1]
    assert spans.totals().tolist() == [4, 3, 0] and spans.ray.tolist() == [0, 0, 1, 1]


def test_spans_by_object_overlap():
    bodies = [durer.Sphere((0, 0, 0), 2), durer.Box((-1, -9, -9), (1, 9, 9)), durer.Plane((1, 0, 0), -4), durer.Disc((0, 0, 0), (1, 0, 0), 9)]
    scene = durer.Scene(bodies)
    spans = scene.spans([[-6, 0, 0], [0, 0, 0], [-6, 5, 0]], [[1, 0, 0]] * 3, by="object")
    assert spans.offsets.tolist() == [0, 3, 5, 7]
    assert spans.object.tolist() == [2, 0, 1, 0, 1, 2, 1]
    assert spans.t_in.tolist() == [0, 4, 5, 0, 0, 0, 5] and spans.t_out.tolist() == [2, 8, 7, 2, 1, 2, 7]
    assert spans.object_in.tolist() == [-1, 0, 1, -1, -1, -1, 1] and spans.object_out.tolist() == [2, 0, 1, 0, 1, 2, 1]
    back = pickle.loads(pickle.dumps(spans))
    assert type(back) is durer.ObjectSpans and back.to_structured().dtype == spans.to_structured().dtype
    rays = np.hstack(some_rays(2000))
    spans = scene.spans(rays, by="object")
    for i, body in enumerate(bodies):
        alone = durer.Scene([body]).spans(rays)
        for name in ("offsets", "t_in", "t_out"):
            assert np.array_equal(spans.of(i)[name], alone[name])
    with pytest.raises(ValueError, match="by: None or 'object'"):
        scene.spans(rays, by="solid")  # type: ignore[call-overload]


def box_mesh(divided=1):
    """The cube from -1 to 1, each side of so many squares."""
    n = divided
    points, faces = {}, []
    for axis in range(3):
        for side in (-1, 1):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0.0, 0.0, 0.0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, 2 * (i + a) / n - 1, 2 * (j + b) / n - 1
                        corners.append(points.setdefault(tuple(p), len(points)))
                    quad = corners if side > 0 else corners[::-1]
                    faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return durer.Mesh(list(points), faces)


@pytest.mark.parametrize("divided", [1, 2, 5])
def test_rays_along_the_outline_of_a_mesh_touch_it_once(divided):
    mesh = box_mesh(divided)
    assert mesh.is_solid
    moved = mesh.placed([[0, 0, 2, 3], [2, 0, 0, 5], [0, 2, 0, 7]])
    for axis in range(3):
        for sense in (1, -1):
            for x, y in [(1, 0.25), (-1, 0.4), (0.3, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (0, 0), (0.5, 0.5), (1.1, 0)]:
                o, d = np.zeros(3), np.zeros(3)
                o[axis], o[(axis + 1) % 3], o[(axis + 2) % 3], d[axis] = -5 * sense, x, y, sense
                for body, map in ((mesh, np.eye(3, 4)), (moved, np.array([[0, 0, 2, 3], [2, 0, 0, 5], [0, 2, 0, 7.0]]))):
                    scene = durer.Scene([body])
                    ray = [np.concatenate([map[:, :3] @ o + map[:, 3], map[:, :3] @ d])]
                    every, first, hit = scene.all(ray), scene.closest(ray), scene.any(ray)[0]
                    assert first.t[0] == (every.t[0] if len(every) else np.inf) and hit == (len(every) > 0)
                    if max(abs(x), abs(y)) > 1:
                        assert len(every) == 0
                    elif max(abs(x), abs(y)) == 1:
                        assert every.t.tolist() == [4] and every.sign.tolist() == [0] and every.kind.tolist() == [1]
                        assert first.kind.tolist() == [1] and len(scene.spans(ray)) == 0 and every.crossings().tolist() == [0]
                        at = map[:, :3] @ (o + 4 * d) + map[:, 3]
                        assert np.abs(every.position[0] - at).max() < 1e-13
                    else:
                        assert every.t.tolist() == [4, 6] and every.sign.tolist() == [-1, 1]
                        assert scene.spans(ray).totals().tolist() == [2]


def test_results_convert():
    pandas = pytest.importorskip("pandas")
    hits = SCENE.all([[-5, 0, 0]], [[1, 0, 0]])
    rows = hits.to_structured()
    assert rows.shape == (4,) and rows["position"].shape == (4, 3) and rows["t"].tolist() == [4, 6, 7, 9]
    frame = hits.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and frame["position_x"].tolist() == [-1, 1, 2, 4]
    assert set(hits.to_dict()) == set(hits.keys())
    with pytest.raises(KeyError):
        hits["nothing"]


def test_results_pickle():
    origins, directions = some_rays(50)
    for result in (SCENE.closest(origins, directions), SCENE.all(origins, directions), SCENE.spans(origins, directions)):
        back = pickle.loads(pickle.dumps(result))
        assert type(back) is type(result) and len(back) == len(result) and repr(back) == repr(result)
        for name in result:
            assert np.array_equal(back[name], result[name], equal_nan=True)


def test_scenes_pickle_and_copy():
    origins, directions = some_rays(500)
    scene = durer.Scene(
        [durer.Torus(2, 0.5).rotated((1, 0, 0), 1.0), durer.formula("x*x + y*y - 1", ball=((0, 0, 0), 2))],
        camera=durer.Camera((0, 0, 9), (0, 0, 0), width=16, height=12),
        lights=[durer.Light((9, 9, 9))],
    )
    back = pickle.loads(pickle.dumps(scene))
    assert np.array_equal(back.closest(origins, directions).t, scene.closest(origins, directions).t)
    assert np.array_equal(durer.render(back), durer.render(scene))
    assert copy.deepcopy(scene) is scene


def test_a_pickled_scene_of_changed_files_is_refused(tmp_path):
    part = tmp_path / "part.inc"
    part.write_text("sphere { 0, 1 }")
    file = tmp_path / "scene.pov"
    file.write_text('#include "part.inc"')
    scene = durer.load(file)
    pickled = pickle.dumps(scene)
    assert pickle.loads(pickled).closest([[0, 0, -5]], [[0, 0, 1]]).t.tolist() == [4.0]
    assert pickle.dumps(pickle.loads(pickled)) == pickled
    part.write_text("sphere { 0, 2 }")
    with pytest.raises(ValueError, match="a file has changed"):
        pickle.loads(pickled)


def test_nothing_can_be_changed():
    hits = SCENE.closest([[0, 0, 9]], [[0, 0, -1]])
    for thing in (BALL, SCENE, hits, durer.Camera((0, 0, 1), (0, 0, 0)), durer.Light((0, 0, 0)), durer.Texture((1, 1, 1))):
        with pytest.raises(AttributeError):
            thing.t = 1


def test_several_threads_may_ask_one_scene():
    origins, directions = some_rays(20000)
    expected = SCENE.closest(origins, directions).t
    found = []
    threads = [threading.Thread(target=lambda: found.append(SCENE.closest(origins, directions).t)) for _ in range(4)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert len(found) == 4 and all(np.array_equal(t, expected) for t in found)


def test_the_interpreter_is_free_meanwhile():
    origins, directions = some_rays(400_000)
    counted = 0
    done = threading.Event()

    def work():
        SCENE.all(origins, directions)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.001)
    thread.join()
    assert counted > 5


def test_control_c_stops_a_batch():
    origins, directions = some_rays(65536)
    many = np.broadcast_to(np.hstack([origins, directions]), (60, 65536, 6)).reshape(-1, 6)
    main = threading.main_thread().ident
    timer = threading.Timer(0.2, signal.pthread_kill, [main, signal.SIGINT])
    # A shell's background jobs ignore the signal.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        # On a busy machine the timer may be late for the first batch.
        with pytest.raises(KeyboardInterrupt):
            while True:
                SCENE.all(many)
    finally:
        signal.signal(signal.SIGINT, before)


def test_progress_is_told_and_may_stop():
    origins, directions = some_rays(140_000)
    told = []
    SCENE.any(origins, directions, progress=lambda done, total: told.append((done, total)))
    assert told == [(65536, 140000), (131072, 140000), (140000, 140000)]

    def stop(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        SCENE.closest(origins, directions, progress=stop)


def test_forked_processes_have_threads_of_their_own():
    import multiprocessing

    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    expected = SCENE.any([[0, 0, 9]], [[0, 0, -1]]).tolist()
    child = context.Process(target=lambda: queue.put(SCENE.any([[0, 0, 9]], [[0, 0, -1]]).tolist()))
    child.start()
    assert queue.get(timeout=60) == expected
    child.join()


def test_files_are_loaded(tmp_path):
    pov = tmp_path / "a.pov"
    pov.write_text("#declare R = Radius; sphere { 0, R } camera { location -5*z }")
    scene = durer.load(pov, declares={"Radius": 2.0}, width=40, height=30)
    assert scene.closest([[0, 0, -5]], [[0, 0, 1]]).t.tolist() == [3.0]
    assert (scene.camera.width, scene.camera.height) == (40, 30)
    assert pickle.loads(pickle.dumps(scene)).closest([[0, 0, -5]], [[0, 0, 1]]).t.tolist() == [3.0]
    with pytest.raises(FileNotFoundError):
        durer.load(tmp_path / "none.pov")
    pov.write_text("sphere { 0, }")
    with pytest.raises(ValueError, match=r"a\.pov"):
        durer.load(pov)
    with pytest.raises(ValueError, match="must be a .pov"):
        other = tmp_path / "a.xyz"
        other.write_text("")
        durer.load(other)


def test_mesh_files_are_loaded(tmp_path):
    file = tmp_path / "a.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    mesh = durer.read_mesh(file)
    assert isinstance(mesh, durer.Mesh) and mesh.is_solid and mesh.faces.shape == (4, 3)
    for scene in (durer.load(file), durer.Scene([mesh])):
        hits = scene.closest([[0.2, 0.2, -1]], [[0, 0, 1]])
        assert hits.t.tolist() == [1.0] and hits.primitive.tolist() == [0]
        assert scene.contains([[0.1, 0.1, 0.1], [1, 1, 1]]).tolist() == [True, False]
