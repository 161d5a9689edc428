"""The ray classes of trimesh and Open3D, as these libraries' users call them."""

import copy
import pickle

import numpy as np
import pytest

import durer.open3d

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))], np.uint32)


@pytest.fixture
def trimesh():
    return pytest.importorskip("trimesh")


@pytest.fixture
def intersector(trimesh):
    import durer.trimesh

    return durer.trimesh.RayMeshIntersector


def test_trimesh_all_hits_without_a_limit(trimesh, intersector):
    z = np.arange(300.0) / 10
    vertices = np.concatenate([[[-1, -1, q], [2, -1, q], [-1, 2, q]] for q in z])
    ray = intersector(trimesh.Trimesh(vertices, np.arange(900).reshape(-1, 3), process=False))
    locations, rays, triangles = ray.intersects_location([[0.1, 0.1, -1]], [[0, 0, 1]])
    assert len(locations) == 300 and triangles.tolist() == list(range(300)) and (rays == 0).all()
    assert len(ray.intersects_id([[0.1, 0.1, -1]], [[0, 0, 1]], max_hits=7)[0]) == 7


def test_trimesh_interface(trimesh, intersector):
    box = trimesh.creation.box()
    box.ray = intersector(box)
    origins, directions = [[0, 0.1, 5], [9, 9, 9]], [[0, 0, -3], [0, 0, 1]]
    assert box.ray.intersects_any(origins, directions).tolist() == [True, False]
    first = box.ray.intersects_first(origins, directions)
    assert first[1] == -1 and box.face_normals[first[0]].tolist() == [0, 0, 1] and first.dtype == np.int64
    triangles, rays, locations = box.ray.intersects_id(origins, directions, multiple_hits=False, return_locations=True)
    assert triangles.tolist() == [first[0]] and rays.tolist() == [0] and np.allclose(locations, [[0, 0.1, 0.5]], atol=1e-15)
    assert box.contains([[0, 0, 0], [0.6, 0, 0]]).tolist() == [True, False]
    for other in (copy.copy(box.ray), copy.deepcopy(box.ray), pickle.loads(pickle.dumps(box.ray))):
        assert other.intersects_any(origins, directions).tolist() == [True, False]
    box.apply_translation([20, 0, 0])
    assert not box.ray.intersects_any(origins, directions).any()


def test_trimesh_open_meshes_have_an_inside_by_vote(trimesh, intersector):
    box = trimesh.creation.box()
    box.update_faces(np.arange(len(box.faces)) != 3)
    ray = intersector(box)
    inside = ray.contains_points(np.random.default_rng(1).uniform(-0.4, 0.4, (100, 3)))
    assert inside.mean() > 0.7 and not ray.contains_points([[3, 0, 0]]).any()


def test_open3d_conventions():
    scene = durer.open3d.RaycastingScene()
    assert scene.add_triangles(CUBE, FACES) == 0 and scene.add_triangles(CUBE + np.float32(3), FACES) == 1
    rays = np.array([[[0.5, 0.25, 3, 0, 0, -1], [0.5, 0.25, 3, 0, 0, 1]], [[3.5, 3.25, 9, 0, 0, -2], [0, 0, 0, 0, 0, 0]]], np.float32)
    answer = {name: array.numpy() for name, array in scene.cast_rays(rays).items()}
    assert answer["t_hit"].tolist() == [[2, np.inf], [2.5, np.inf]] and answer["t_hit"].dtype == np.float32
    invalid = scene.INVALID_ID
    assert answer["geometry_ids"].tolist() == [[0, invalid], [1, invalid]]
    assert answer["primitive_normals"][0, 0].tolist() == [0, 0, 1] and (answer["primitive_normals"][1, 1] == 0).all()
    assert scene.count_intersections(rays).numpy().tolist() == [[2, 0], [2, 0]]
    assert scene.test_occlusions(rays, tfar=2.2).numpy().tolist() == [[True, False], [False, False]]
    listed = scene.list_intersections(rays)
    assert listed["ray_splits"].numpy().tolist() == [0, 2, 2, 4, 4] and listed["ray_ids"].numpy().tolist() == [0, 0, 2, 2]
    assert scene.compute_occupancy(np.float32([[0.5, 0.5, 0.5], [2, 2, 2]])).numpy().tolist() == [1, 0]
    with pytest.raises(ValueError, match=r"\(6,\)"):
        scene.cast_rays(np.zeros(6, np.float32))
