"""1,000 wrong calls: each raises an exception with a sentence, and the process lives on."""
import os
import unittest

import numpy as np

import roomradar as rr
import support

EXPECTED = (TypeError, ValueError, IndexError, OverflowError, StopIteration, rr.Error)
WRONG = 1000


def closed(thing):
    thing.close()
    return thing


class Pool:
    """Right values by kind, and wrong ones for any argument."""

    def __init__(self):
        self.room = support.table_map()
        self.tree = rr.TriangleTree(support.box_mesh(0.1))
        self.scene = rr.RadarScene()
        self.scene.add(self.tree)
        self.frame = rr.open_source(support.VIEW).next_frame()
        self.session = rr.Session(self.room, poses="recorded")
        self.session.add("pot")
        self.closed_session = closed(rr.Session(self.room))
        self.locator = rr.Locator(self.room)
        self.octree = rr.StaticMap(0.05)
        self.source = rr.open_source(support.VIEW)
        self.simulator = rr.Simulator("sim:table?frames=3&width=160")
        self.closed_source = closed(rr.open_source(support.VIEW))
        self.closed_simulator = closed(rr.Simulator("sim:table?frames=3&width=160"))
        self.radar = rr.CyberRadar()
        self.mesh = support.box_mesh()
        self.poses = np.tile(np.eye(4), (5, 1, 1))
        self.directions = np.tile([0.0, 0.0, -1.0], (5, 1))

    def wrong(self, random):
        nan, inf = float("nan"), float("inf")
        broken = np.eye(4)
        broken[random.integers(3), random.integers(4)] = random.choice([nan, inf, 7.0])
        frozen = np.zeros((120, 160, 3), np.uint8)
        frozen.flags.writeable = False
        shape = tuple(random.integers(0, 6, random.integers(0, 4)))
        kind = random.choice(["f2", "f4", "f8", "u1", "u4", "i8", "c8", "U3", "O", "?", ">f8", "M8[s]"])
        values = [None, -1, 0, 2**70, -2**70, nan, inf, -inf, 1e308, "", "nonsense", "a\0b", "\udcff", b"bytes", (), (1, 2),
                  (nan, 0, 0), ("a", "b", "c"), [1, 2, 3, 4], {}, {"depth_stride": nan}, {1: 2}, object(), type, len,
                  broken, frozen, np.zeros(shape, kind), np.zeros((4, 8))[:, ::2], np.float32(nan),
                  np.full((120, 160), nan, np.float32), np.full((120, 160), -1, np.float32),
                  np.zeros((120, 160), np.float32)[::-1], np.eye(4)[::-1].copy(), np.lib.stride_tricks.as_strided(
                      np.zeros(4), (4, 4), (0, 8)), np.frombuffer(b"\0" * 129, np.uint8)[1:].view(np.float64).reshape(4, 4),
                  self.closed_session, self.closed_source, self.closed_simulator, self.room, self.mesh, self.frame,
                  rr.SurfaceKind.STATIC, rr.Error]
        return values[random.integers(len(values))]

    def calls(self):
        """Functions with right arguments. All are quick, also with wrong ones."""
        depth, camera, out = np.ones((120, 160), np.float32), support.camera(), np.zeros((120, 160, 3), np.uint8)
        T, direction = np.eye(4), np.array([0.0, 0.0, -1.0])
        s, at = self.session, (0.0, 0.0, 1.0)
        return [
            (rr.Frame, [depth, camera], {"colour": out, "colour_camera": camera, "T_world_camera": T, "stamp_s": 1.0,
                                         "down_camera": at, "index": 3, "depth_noise": rr.DepthNoise()}),
            (rr.Intrinsics, [160, 120, 146.0, 146.0, 79.5, 59.5], {}),
            (rr.DepthNoise, [], {"base_m": 0.001, "linear": 0.0, "quadratic_per_m": 0.001}),
            (rr.SensorTiming, [], {"depth_readout_s": 0.03}),
            (rr.Mesh, [self.mesh.vertices, self.mesh.triangles], {"origin": at, "normals": self.mesh.vertices}),
            (self.mesh.transformed, [T], {}),
            (rr.Mesh.read, ["no.ply"], {}),
            (rr.Source.of_frames, [[self.frame]], {"name": "mine"}),
            (rr.open_source, ["sim:table?frames=2&width=160"], {"frames": (0, 1), "calibration": ""}),
            (self.source.seek, [3], {}),
            (rr.Simulator, ["sim:table?frames=2&width=160"], {}),
            (self.simulator.look, [0, T], {}),
            (rr.open_map, ["no/map"], {}),
            (rr.map_info, ["no/map"], {}),
            (rr.export_map, [support.table_folder(), "x.xyz"], {}),
            (rr.diff_maps, [self.room, self.room], {}),
            (rr.merge_maps, [self.room, self.room], {}),
            (self.room.occupancy, [np.zeros((3, 3))], {}),
            (self.room.level_surfaces, [], {"min_area_m2": 0.1}),
            (rr.StaticMap, [0.05], {"max_range_m": 4.0, "threads": 1}),
            (self.octree.fuse, [self.frame, T], {}),
            (self.octree.occupancy, [np.zeros((3, 3))], {}),
            (self.octree.write, ["octree.xyz"], {}),
            (rr.prescan, ["sim:nothing"], {"poses": "tracked", "resolution_m": 0.05, "up": at, "hold_out": 2}),
            (rr.TriangleTree, [self.mesh], {}),
            (self.scene.add, [self.tree, T], {"kind": rr.SurfaceKind.OBJECT}),
            (self.scene.add_frame, [self.frame, T], {"stride_px": 4, "max_jump_m": 0.1}),
            (self.scene.set_pose, [0, T], {}),
            (rr.CyberRadar, [], {"mode": "sampled", "resolution_px": 32}),
            (self.radar.query, [self.tree, T, direction, 1.0, self.scene], {"margin_m": 0.0, "own_tree": 0}),
            (self.radar.query_many, [self.tree, self.poses, self.directions, 1.0, self.scene], {"margin_m": 0.01}),
            (rr.Locator, [self.room], {}),
            (self.locator.locate, [self.frame], {"moved_mask": np.zeros((120, 160), np.uint8)}),
            (self.locator.set_pose, [T], {}),
            (self.locator.expected_depth, [camera, T], {}),
            (rr.Session, [self.room], {"poses": "recorded", "surfaces": "map", "unknown": "free", "quality": {}}),
            (s.step, [self.frame], {}),
            (s.add, ["pan", "teapot"], {"size_m": 0.2, "up": "z", "mass_kg": 1.0, "friction": 0.5}),
            (s.place, ["pot", at], {"R_world_object": np.eye(3), "velocity_world_mps": at}),
            (s.throw, ["pot", at, at], {}),
            (s.drop, ["pot"], {"position_world": at, "near_world": at, "height_m": 0.1}),
            (s.carry, ["pot", at], {}),
            (s.release, ["pot", at], {}),
            (s.turn, ["pot", at], {}),
            (s.set_material, ["pot"], {"friction": 0.5, "restitution": 0.1}),
            (s.set_quality, [{"radar_px": 32}], {}),
            (s.set_unknown, ["free"], {}),
            (s.set_surfaces, ["map"], {}),
            (s.query, [self.tree, T, direction, 1.0], {"margin_m": 0.0}),
            (s.read_picture, [out], {}),
        ]


class Fuzz(unittest.TestCase):
    def test_wrong_calls_raise_and_nothing_crashes(self):
        os.chdir(support.temporary_folder())
        random = np.random.default_rng(int(os.environ.get("ROOMRADAR_FUZZ_SEED", "1")))
        pool = Pool()
        calls = pool.calls()
        raised, made = 0, 0
        while raised < WRONG:
            function, right, named = calls[made % len(calls)]
            arguments, keywords = list(right), dict(named)
            for _ in range(random.integers(1, 3)):
                which = random.integers(len(arguments) + len(keywords))
                if which < len(arguments):
                    arguments[which] = pool.wrong(random)
                else:
                    keywords[list(keywords)[which - len(arguments)]] = pool.wrong(random)
            if random.random() < 0.05:
                arguments.append(pool.wrong(random))
            if random.random() < 0.05:
                keywords["nonsense"] = 1
            made += 1
            self.assertLess(made, 20 * WRONG)
            try:
                function(*arguments, **keywords)
            except EXPECTED as fault:
                raised += 1
                self.assertGreater(len(str(fault)), 10, (function, arguments, keywords))
            except BaseException as fault:
                raise AssertionError(f"{function}{arguments}{keywords}") from fault
        print(f"{made} calls, {raised} raised")

    def test_members_of_nothing_raise(self):
        pool, random = Pool(), np.random.default_rng(2)
        for name in dir(rr):
            for member in vars(getattr(rr, name)).values() if isinstance(getattr(rr, name), type) else ():
                function = getattr(member, "fget", None) or member
                if not callable(function) or isinstance(function, (staticmethod, type)) or name == "_item":
                    continue
                for this in (None, object(), pool.frame, pool.closed_session, pool.closed_source):
                    for more in ((), (None,), (pool.wrong(random), pool.wrong(random))):
                        try:
                            function(this, *more)
                        except EXPECTED + (AttributeError, RuntimeError):
                            pass

    def test_closed_handles_raise(self):
        pool = Pool()
        source, simulator, session = pool.closed_source, pool.closed_simulator, pool.closed_session
        calls = [source.next_frame, source.rewind, lambda: source.seek(0), lambda: len(source), lambda: next(source),
                 lambda: list(source), lambda: source.name, lambda: source.frame_count, lambda: rr.prescan(source),
                 lambda: simulator.truth, lambda: simulator.look(0, np.eye(4)), simulator.room_mesh,
                 lambda: session.step(pool.frame), lambda: session.picture, lambda: session.moved_mask,
                 lambda: session.expected_depth_m, session.moved_mesh, session.fingerprint, session.close,
                 lambda: session.objects, lambda: session.add("pot"), lambda: session.drop("pot"),
                 lambda: session.place("pot", (0, 0, 0)), lambda: session.carry("pot", (0, 0, 0)),
                 lambda: session.remove("pot"), lambda: session.set_quality({}), lambda: session.set_unknown("free"),
                 lambda: session.query(pool.tree, np.eye(4), (0, 0, 1), 1.0), lambda: session.renderer,
                 lambda: session.read_picture(np.zeros((1, 1, 3), np.uint8)), lambda: session.stage_ms]
        for number, call in enumerate(calls):
            with self.subTest(number), self.assertRaisesRegex(rr.Error, "is closed"):
                call()


if __name__ == "__main__":
    unittest.main()
