#!/usr/bin/python3
"""Takes a map's mesh to Open3D, where it is compared with a depth image and simplified, and back, where a ball falls on it.

usage: open3d_mesh.py MAP PICTURE.png
"""
import sys
from typing import Any

import numpy as np
import open3d as o3d  # type: ignore[import]
from numpy.typing import NDArray

import roomradar as rr


def to_open3d(mesh: rr.Mesh) -> Any:
    """Returns a legacy Open3D mesh in the world."""
    out = o3d.geometry.TriangleMesh()
    out.vertices = o3d.utility.Vector3dVector(mesh.vertices + mesh.origin)
    out.triangles = o3d.utility.Vector3iVector(mesh.triangles.astype(np.int32))
    if mesh.colours is not None:
        out.vertex_colors = o3d.utility.Vector3dVector(mesh.colours / 255.0)
    return out


def from_open3d(mesh: Any) -> rr.Mesh:
    vertices = np.asarray(mesh.vertices)
    origin = vertices.mean(axis=0)
    return rr.Mesh((vertices - origin).astype(np.float32), np.asarray(mesh.triangles).astype(np.uint32), origin=origin)


def points_of(depth_m: NDArray[np.float32], camera: rr.Intrinsics, T_world_camera: NDArray[np.float64]) -> Any:
    """Returns the points of a depth image in the world, as Open3D back-projects them."""
    intrinsic = o3d.camera.PinholeCameraIntrinsic(camera.width_px, camera.height_px, camera.matrix)
    cloud = o3d.geometry.PointCloud.create_from_depth_image(
        o3d.geometry.Image(np.ascontiguousarray(depth_m)), intrinsic, np.linalg.inv(T_world_camera), depth_scale=1.0,
        depth_trunc=10.0)
    return o3d.core.Tensor(np.asarray(cloud.points).astype(np.float32))


def main(folder: str, picture: str) -> None:
    room = rr.open_map(folder)
    _, poses = room.trajectory
    camera = rr.Intrinsics(320, 240, 292.5, 292.5, 159.5, 119.5)
    mesh = to_open3d(room.mesh)
    depth_m = rr.Locator(room).expected_depth(camera, poses[0])
    surface = o3d.t.geometry.RaycastingScene()
    surface.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
    distance_m = surface.compute_distance(points_of(depth_m, camera, poses[0])).numpy()
    print(f"depth: {distance_m.size} points, {np.median(distance_m) * 1e3:.3f} mm from the mesh (median)")

    simple = from_open3d(mesh.simplify_quadric_decimation(len(room.mesh.triangles) // 4))
    scene = rr.RadarScene()
    scene.add(rr.TriangleTree(simple))
    ball = rr.TriangleTree(from_open3d(o3d.geometry.TriangleMesh.create_sphere(0.05)))
    table = max(room.level_surfaces(), key=lambda surface: surface.height_m)
    T_world_ball = np.eye(4)
    T_world_ball[:3, 3] = table.middle_world + [0, 0, 0.5]
    contact = rr.CyberRadar().query(ball, T_world_ball, (0, 0, -1), 1.0, scene)
    print(f"ball: falls {contact.contact_distance_m:.3f} m onto the simplified mesh of {len(simple.triangles)} triangles")
    grey = depth_m / max(float(depth_m.max()), 1e-6) * 255
    o3d.io.write_image(picture, o3d.geometry.Image(np.ascontiguousarray(grey.astype(np.uint8))))


if __name__ == "__main__":
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit()
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
