"""Prescan a room with a depth camera, keep it as a map, and run augmented reality in it.

    import roomradar as rr

    scan = rr.prescan("RECORDING")
    scan.map.save("maps/kitchen")
    room = rr.open_map("maps/kitchen")
    with rr.Session(room) as session:
        session.add("pot", "teapot")
        session.drop("pot")
        for frame in rr.open_source("RECORDING"):
            if session.step(frame):
                show(session.picture)

Frames and units
    world          metres, right-handed, +z up; z = 0 is the floor
    camera         x right, y down, z forward (as in OpenCV); pixel (0, 0) is centred at image coordinates (0, 0)
    T_a_b          (4, 4) float64; maps coordinates in b to coordinates in a: p_world = T_world_camera @ p_camera
    depth_m        (H, W) float32, metres along the optical axis, 0 where nothing was measured
    colour         (H, W, 3) uint8, RGB
    vertices       (N, 3) float32, metres, relative to the mesh's own origin (3,) float64
    triangles      (M, 3) uint32, counter-clockwise seen from outside

Arrays of images and meshes share memory with their owner, which they keep alive, and are read-only. Arguments are never
converted silently: a wrong type raises TypeError, a wrong shape, stride or value ValueError, a failure with files, devices or
settings roomradar.Error. Long calls release the interpreter's lock.
"""
from ._roomradar import *  # noqa: F401,F403
from ._roomradar import __version__  # noqa: F401

for _item in list(globals().values()):
    if isinstance(_item, type):
        _item.__module__ = __name__  # the name by which it is imported
del _item
