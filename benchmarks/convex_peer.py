# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Makes convex parts of one closed mesh with another program, for `benchmarks/import_parts --peer`.

    convex_peer.py coacd THRESHOLD PARTS IN.obj OUT.obj

THRESHOLD is the concavity that it stops at (CoACD's own default is 0.05), PARTS the most that it may
make. The package is not needed by anything else; where it is missing this ends with an error and the
benchmark leaves it out.
"""
import sys


def read_obj(path):
    vertices, faces = [], []
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "v":
                vertices.append([float(x) for x in words[1:4]])
            elif words and words[0] == "f":
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return vertices, faces


def write_obj(path, parts):
    first = 1
    with open(path, "w") as out:
        for number, (vertices, faces) in enumerate(parts):
            out.write(f"o part{number}\n")
            for x, y, z in vertices:
                out.write(f"v {x:.9g} {y:.9g} {z:.9g}\n")
            for a, b, c in faces:
                out.write(f"f {a + first} {b + first} {c + first}\n")
            first += len(vertices)


def with_coacd(threshold, parts, source, target):
    import coacd
    import numpy

    coacd.set_log_level("error")
    vertices, faces = read_obj(source)
    mesh = coacd.Mesh(numpy.array(vertices), numpy.array(faces))
    hulls = coacd.run_coacd(mesh, threshold=float(threshold), max_convex_hull=int(parts), seed=1)
    write_obj(target, hulls)


def main():
    if len(sys.argv) != 6 or "with_" + sys.argv[1] not in globals():
        sys.exit(__doc__)
    globals()["with_" + sys.argv[1]](*sys.argv[2:])


if __name__ == "__main__":
    main()
