# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Open3D's RaycastingScene on the scenes of sensor_throughput, for comparison with it.

Needs Open3D from PyPI (Debian's finds no hits): run with the Python of an environment that has it,
  sensor_throughput && OMP_NUM_THREADS=1 python raycast_peer.py
Prints CPU time of the process, medians of ten; Open3D has no instances, so its scene is one flat tree.
"""

import statistics
import time

import numpy as np
import open3d as o3d

LINKS = 16


def capsule(around, along, radius=0.09, length=0.4):
    j, i = np.meshgrid(np.arange(along + 1), np.arange(around), indexing="ij")
    angle = 2 * np.pi * i / around
    t = 2.0 * j / along - 1
    r = radius * np.sqrt(np.maximum(0, 1 - np.abs(t) ** 8)) * (1 + 0.1 * np.sin(6 * angle + 4 * t))
    vertices = np.stack([r * np.cos(angle), r * np.sin(angle), length * t / 2], -1).reshape(-1, 3)
    triangles = []
    for row in range(along):
        for k in range(around):
            a, b = row * around + k, row * around + (k + 1) % around
            triangles += [(a, b, a + around), (b, b + around, a + around)]
    return vertices, np.array(triangles)


def scene_of(around, along):
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    vertices, triangles = capsule(around, along)
    count = 0
    for link in range(LINKS - 3):
        turn = 0.2 * link
        rotation = np.array([[1, 0, 0], [0, np.cos(turn), -np.sin(turn)], [0, np.sin(turn), np.cos(turn)]])
        place = np.array([0.5 + 0.1 * np.sin(link), -0.6 + 0.3 * (link % 5), 0.9 + 0.35 * (link // 5)])
        add(scene, vertices @ rotation.T + place, triangles)
        count += len(triangles)
    leaf = np.array([(0, -0.5, 0), (0, 0.5, 0), (0, 0.5, 2.1), (0, -0.5, 2.1)], float)
    for i in range(3):
        add(scene, leaf + np.array([-0.1 * i, 0.9 * (i - 1), 0]), np.array([(0, 1, 2), (0, 2, 3)]))
        count += 2
    return scene, count


def add(scene, vertices, triangles):
    scene.add_triangles(
        o3d.core.Tensor(vertices.astype(np.float32)), o3d.core.Tensor(triangles.astype(np.uint32))
    )


def rays_of(size=256):
    eye, target = np.array([1.8, 0, 1.8]), np.array([0.01, 0, 1.5])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    at = (np.arange(size) + 0.5 - size / 2) / (size / 2)  # 90 degrees wide
    x, y = np.meshgrid(at, at)
    directions = forward + x[..., None] * right + y[..., None] * down
    return np.concatenate([np.broadcast_to(eye, directions.shape), directions], -1).astype(np.float32)


def main():
    rays = o3d.core.Tensor(rays_of())
    for name, around, along in (("light scene", 48, 30), ("dense scene", 160, 98)):
        scene, triangles = scene_of(around, along)
        depth = scene.cast_rays(rays)["t_hit"].numpy()
        times = []
        for _ in range(10):
            start = time.process_time()
            scene.cast_rays(rays)
            times.append(time.process_time() - start)
        seen = np.isfinite(depth)
        print(
            f"{name}: {triangles} triangles, Open3D {o3d.__version__} "
            f"{depth.size / statistics.median(times) / 1e6:.1f} Mrays/s of CPU time, "
            f"{100 * seen.mean():.1f} % hits, mean depth {depth[seen].mean():.5f} m"
        )


if __name__ == "__main__":
    main()
