# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Repairs one mesh with another program, for `benchmarks/repair --peer`.

    repair_peer.py manifold|open3d|pymeshfix|pymeshlab|trimesh IN OUT

Each does what its documentation recommends for making a mesh closed. The packages are not needed
by anything else; where one is missing this ends with an error and the benchmark leaves it out.
"""
import sys


def with_manifold(source, target):
    import manifold3d
    import numpy
    import trimesh

    soup = trimesh.load_mesh(source, process=False)
    mesh = manifold3d.Mesh(
        numpy.asarray(soup.vertices, numpy.float32), numpy.asarray(soup.faces, numpy.uint32)
    )
    mesh.merge()
    solid = manifold3d.Manifold(mesh)
    if solid.is_empty():
        sys.exit(f"not manifold: {solid.status()}")
    out = solid.to_mesh()
    trimesh.Trimesh(out.vert_properties[:, :3], out.tri_verts, process=False).export(target)


def with_open3d(source, target):
    import open3d

    mesh = open3d.io.read_triangle_mesh(source)
    mesh.remove_duplicated_vertices()
    mesh.remove_duplicated_triangles()
    mesh.remove_degenerate_triangles()
    mesh.remove_non_manifold_edges()
    mesh.orient_triangles()
    # named, since the filled mesh shares its memory (0.20): freed early, its vertices are garbage
    unfilled = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    mesh = unfilled.fill_holes(hole_size=1e6).to_legacy()
    mesh.compute_triangle_normals()  # which STL needs
    open3d.io.write_triangle_mesh(target, mesh)


def with_pymeshfix(source, target):
    import pymeshfix

    pymeshfix.clean_from_file(source, target, verbose=False, joincomp=False)


def with_pymeshlab(source, target):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(source)
    meshes.meshing_merge_close_vertices()
    meshes.meshing_remove_duplicate_faces()
    meshes.meshing_remove_null_faces()
    meshes.meshing_repair_non_manifold_edges()
    meshes.meshing_repair_non_manifold_vertices()
    meshes.meshing_re_orient_faces_coherently()
    meshes.meshing_close_holes(maxholesize=1000)
    meshes.save_current_mesh(target)


def with_trimesh(source, target):
    import trimesh

    mesh = trimesh.load_mesh(source)
    mesh.merge_vertices()
    mesh.update_faces(mesh.unique_faces() & mesh.nondegenerate_faces())
    trimesh.repair.fix_normals(mesh)
    trimesh.repair.fill_holes(mesh)
    mesh.export(target)


def main():
    if len(sys.argv) != 4 or "with_" + sys.argv[1] not in globals():
        sys.exit(__doc__)
    globals()["with_" + sys.argv[1]](sys.argv[2], sys.argv[3])


if __name__ == "__main__":
    main()
