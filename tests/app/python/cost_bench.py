#!/usr/bin/python3
"""What the Python module costs over C++: radar queries, a batch of 10,000, a frame of Session.step(). Fixed settings.

Run by `ninja -C build python_bench`. The radar's figures are the least of 15 turns of Python and C++:
turns on a shared machine differ by 15 %.
"""
import subprocess
import time

import numpy as np

import roomradar as rr
import support

TURNS = 15


def radar():
    """Returns us per query, of single calls and in a batch: (Python, C++) each."""
    folder = support.temporary_folder()
    support.table_map().mesh.write(folder / "room.ply")
    support.box_mesh(0.15).write(folder / "box.ply")
    poses = support.random_poses(10000, 7, [-1.5, -1.5, 0.2], [1.5, 1.5, 1.5])
    directions = np.tile([0.0, 0.0, -1.0], (10000, 1))
    np.concatenate([poses[:, :3].reshape(-1, 12), directions], axis=1).tofile(folder / "queries")
    scene = rr.RadarScene()
    scene.add(rr.TriangleTree(rr.Mesh.read(folder / "room.ply")))
    tree = rr.TriangleTree(rr.Mesh.read(folder / "box.ply"))
    one, many = rr.CyberRadar(), rr.CyberRadar()
    rows = []
    for _ in range(TURNS):
        cpp = subprocess.run([support.RADAR_REFERENCE, folder / "room.ply", folder / "box.ply", folder / "queries",
                              folder / "answers"], check=True, capture_output=True, text=True).stdout.split()
        times = []
        for T, u in zip(poses, directions):
            start = time.perf_counter()
            one.query(tree, T, u, 2.0, scene)
            times.append(time.perf_counter() - start)
        many.query_many(tree, poses, directions, 2.0, scene)
        start = time.perf_counter()
        many.query_many(tree, poses, directions, 2.0, scene)
        batch = (time.perf_counter() - start) / len(poses)
        rows.append([np.median(times) * 1e6, float(cpp[0]), batch * 1e6, float(cpp[1])])
    return np.min(rows, axis=0)


def clock_us():
    times = [-time.perf_counter() + time.perf_counter() for _ in range(10000)]
    return np.median(times) * 1e6


def step():
    """Returns ms per frame: of Session.step(), and of the frame in it."""
    session = rr.Session(support.table_map(), poses="recorded")
    session.add("pot")
    session.drop("pot")
    frames = list(rr.open_source(support.VIEW.replace("frames=40&width=160", "frames=60&width=640")))
    rows = []
    for frame in frames:
        start = time.perf_counter()
        session.step(frame)
        rows.append([(time.perf_counter() - start) * 1e3, session.stage_ms["frame"]])
    rows = np.array(rows)
    return np.median(rows[:, 0]), np.median(rows[:, 1]), np.median(rows[:, 0] - rows[:, 1])


if __name__ == "__main__":
    python_us, cpp_us, batch_us, cpp_batch_us = radar()
    print(f"radar query, median: {python_us:.2f} us, in C++ {cpp_us:.2f}: {python_us - cpp_us - clock_us():.2f} us more "
          f"(bar 2)")
    print(f"10,000 in a batch: {batch_us:.2f} us a query, in C++ {cpp_batch_us:.2f}: "
          f"{100 * (batch_us / cpp_batch_us - 1):.1f} % more (bar 3)")
    whole_ms, frame_ms, more_ms = step()
    print(f"Session.step of 640 x 480: {whole_ms:.2f} ms, in C++ {frame_ms:.2f}: {more_ms:.3f} ms more (bar 0.1)")
