#!/usr/bin/python3
"""How far a box can fall everywhere in a room: 10,000 radar queries between arrays of vertices and faces.

Vertices (N, 3) and faces (M, 3) are those of trimesh and other mesh libraries: trimesh.Trimesh(**arrays_of(mesh)).

usage: clearance.py MAP PICTURE.png
"""
import sys
from typing import Any

import matplotlib  # type: ignore[import]

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # type: ignore[import]  # noqa: E402
import numpy as np  # noqa: E402
from numpy.typing import NDArray  # noqa: E402

import roomradar as rr  # noqa: E402

FROM_M = 1.6  # height from which the box falls


def arrays_of(mesh: rr.Mesh) -> dict[str, NDArray[Any]]:
    """Returns a mesh as other libraries have it: double vertices in the world, signed faces."""
    return {"vertices": mesh.vertices + mesh.origin, "faces": mesh.triangles.astype(np.int64)}


def mesh_of(vertices: NDArray[Any], faces: NDArray[Any]) -> rr.Mesh:
    """Returns a mesh of such arrays. The origin keeps the precision of vertices far from zero."""
    origin = vertices.mean(axis=0)
    return rr.Mesh((vertices - origin).astype(np.float32), faces.astype(np.uint32), origin=origin)


def box(size_m: float) -> rr.Mesh:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size_m / 2
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    return mesh_of(corners, np.array(faces))


def fall_m(room: rr.Mesh, size_m: float, per_side: int = 100) -> NDArray[np.float64]:
    """Returns the way that a box falls from each point of a grid over the room, NaN where nothing stops it."""
    scene = rr.RadarScene()
    scene.add(rr.TriangleTree(mesh_of(**arrays_of(room))))
    low, high = room.vertices.min(axis=0) + room.origin, room.vertices.max(axis=0) + room.origin
    x, y = np.meshgrid(*(np.linspace(low[i], high[i], per_side) for i in (0, 1)))
    T_world_box = np.tile(np.eye(4), (x.size, 1, 1))
    T_world_box[:, :3, 3] = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, FROM_M)])
    down = np.tile([0.0, 0.0, -1.0], (x.size, 1))
    contacts = rr.CyberRadar().query_many(rr.TriangleTree(box(size_m)), T_world_box, down, FROM_M + 1.0, scene)
    is_contact = contacts.status == int(rr.ContactStatus.CONTACT)
    return np.where(is_contact, contacts.contact_distance_m, np.nan).reshape(x.shape)


if __name__ == "__main__":
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit()
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    way = fall_m(rr.open_map(sys.argv[1]).mesh, 0.1)
    plt.imsave(sys.argv[2], np.kron(FROM_M - way, np.ones((4, 4))), origin="lower", cmap="viridis", vmin=0, vmax=1.2)
    print(f"{np.count_nonzero(np.isfinite(way))} of {way.size} boxes are stopped")
