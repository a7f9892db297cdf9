#!/usr/bin/python3
"""Draws a map from above with matplotlib: surface by height, level surfaces, the scan's path.

usage: plot_map.py MAP PICTURE.png
"""
import sys

import matplotlib  # type: ignore[import]

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # type: ignore[import]  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import PolyCollection  # type: ignore[import]  # noqa: E402

import roomradar as rr  # noqa: E402


def plot(room: rr.Map, picture: str) -> None:
    mesh = room.mesh
    corners_world = (mesh.vertices + mesh.origin)[mesh.triangles]  # (M, 3, 3)
    height_m = corners_world[:, :, 2].mean(axis=1)
    order = np.argsort(height_m)  # what is higher is drawn last
    order = order[height_m[order] < 1.8]  # without ceiling
    figure, axes = plt.subplots(figsize=(8, 7), layout="constrained")
    faces = PolyCollection(corners_world[order, :, :2], array=height_m[order], cmap="viridis", antialiased=False)
    axes.add_collection(faces)
    _, T_world_camera = room.trajectory
    axes.plot(*T_world_camera[:, :2, 3].T, color="tab:red", label="path of the scan")
    for surface in room.level_surfaces(min_area_m2=0.3)[:4]:
        x, y, z = surface.middle_world
        axes.annotate(f"z {z:.2f} m\n{surface.area_m2:.2f} m²", (x, y), ha="center", va="center",
                      bbox={"boxstyle": "round", "facecolor": "white", "alpha": 0.8})
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m", title=f"{len(mesh.triangles)} triangles")
    axes.legend(loc="lower right")
    figure.colorbar(faces, label="height, m")
    figure.savefig(picture, dpi=100)


if __name__ == "__main__":
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit()
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    plot(rr.open_map(sys.argv[1]), sys.argv[2])
