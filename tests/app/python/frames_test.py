"""Frames, sources, meshes, simulator: views share memory, and what does not fit is refused with a sentence."""
import gc
import unittest
import warnings
import weakref

import numpy as np

import roomradar as rr
import support
from support import address


def make_frame(**more):
    depth = np.arange(120 * 160, dtype=np.float32).reshape(120, 160) / 1e4
    colour = np.arange(120 * 160 * 3, dtype=np.uint32).reshape(120, 160, 3).astype(np.uint8)
    return rr.Frame(depth, support.camera(), colour=colour, colour_camera=support.camera(), **more), depth, colour


class Views(unittest.TestCase):
    def test_images_are_those_given_and_are_not_copied_when_read(self):
        frame, depth, colour = make_frame()
        np.testing.assert_array_equal(frame.depth_m, depth)
        np.testing.assert_array_equal(frame.colour, colour)
        self.assertEqual((frame.depth_m.dtype, frame.colour.dtype), (np.float32, np.uint8))
        self.assertEqual(address(frame.depth_m), address(frame.depth_m))
        self.assertEqual(address(frame.colour), address(frame.colour))
        self.assertNotEqual(address(frame.depth_m), address(depth))

    def test_views_are_read_only_and_keep_the_frame_alive(self):
        frame, depth, _ = make_frame()
        view = frame.depth_m
        with self.assertRaises(ValueError):
            view[0, 0] = 1.0
        del frame
        gc.collect()
        np.testing.assert_array_equal(view, depth)

    def test_a_mesh_of_a_map_shares_the_maps_memory_and_keeps_it(self):
        room = rr.open_map(support.table_folder())
        vertices = room.mesh.vertices
        self.assertEqual(address(vertices), address(room.mesh.vertices))
        copy = vertices.copy()
        del room
        gc.collect()
        np.testing.assert_array_equal(vertices, copy)
        self.assertEqual((vertices.dtype, vertices.shape[1]), (np.float32, 3))

    def test_poses_come_back_to_the_bit(self):
        T = support.random_poses(1, 3, -5, 5)[0]
        frame, _, _ = make_frame(T_world_camera=T, T_colour_depth=np.asfortranarray(T), index=7, stamp_s=0.25)
        np.testing.assert_array_equal(frame.T_world_camera, T)
        np.testing.assert_array_equal(frame.T_colour_depth, T)
        self.assertEqual((frame.index, frame.stamp_s, frame.down_camera), (7, 0.25, None))


class Refused(unittest.TestCase):
    def refuse(self, kind, words, *arguments, **keywords):
        with self.assertRaises(kind) as caught:
            rr.Frame(*arguments, **keywords)
        self.assertIn(words, str(caught.exception))

    def test_what_is_no_depth_image_is_named(self):
        good = np.ones((120, 160), np.float32)
        camera = support.camera()
        self.refuse(TypeError, "depth_m: holds float64; must be float32 of shape (H, W)", good.astype(float), camera)
        self.refuse(TypeError, "depth_m: must be a NumPy array, float32 of shape (H, W), not list", [[1.0]], camera)
        self.refuse(ValueError, "depth_m: has the shape (120, 160, 1); must be (H, W)", good[..., None], camera)
        self.refuse(ValueError, "depth_m: is not contiguous", np.ones((160, 120), np.float32).T, camera)
        self.refuse(ValueError, "depth_m: is not contiguous", np.ones((120, 320), np.float32)[:, ::2], camera)
        self.refuse(TypeError, "depth_m: holds >f4", good.astype(">f4"), camera)
        self.refuse(ValueError, "Frame: ", np.ones((60, 80), np.float32), camera)
        for wrong in (np.nan, np.inf, -1.0):
            bad = good.copy()
            bad[3, 4] = wrong
            self.refuse(ValueError, "depth_m: holds a depth that is negative or not finite", bad, camera)

    def test_what_is_no_colour_pose_or_number_is_named(self):
        depth = np.ones((120, 160), np.float32)
        colour = np.zeros((120, 160, 3), np.uint8)
        camera = support.camera()
        self.refuse(ValueError, "colour_camera: is missing", depth, camera, colour=colour)
        self.refuse(ValueError, "colour: has the shape (120, 160, 4)", depth, camera,
                    colour=np.zeros((120, 160, 4), np.uint8), colour_camera=camera)
        self.refuse(ValueError, "colour: is not contiguous", depth, camera, colour=colour[:, :, ::-1],
                    colour_camera=camera)
        self.refuse(TypeError, "T_world_camera: holds float32", depth, camera,
                    T_world_camera=np.eye(4, dtype=np.float32))
        self.refuse(ValueError, "T_world_camera: must be a finite rigid transform", depth, camera,
                    T_world_camera=2 * np.eye(4))
        self.refuse(ValueError, "T_world_camera: has the shape (3, 4)", depth, camera, T_world_camera=np.eye(4)[:3])
        self.refuse(ValueError, "stamp_s: must be a finite number", depth, camera, stamp_s=float("nan"))
        self.refuse(ValueError, "down_camera: must be a direction", depth, camera, down_camera=(0, 0, 0))

    def test_cameras_and_noise_are_checked(self):
        with self.assertRaises(rr.Error):
            rr.Intrinsics(0, 120, 1, 1, 0, 0)
        with self.assertRaises(rr.Error):
            rr.Intrinsics(160, 120, float("nan"), 1, 0, 0)
        with self.assertRaises(ValueError):
            rr.DepthNoise(base_m=-1)

    def test_meshes_are_checked(self):
        box = support.box_mesh()
        with self.assertRaisesRegex(ValueError, "triangles: row 0 names a vertex that does not exist; there are 8"):
            rr.Mesh(box.vertices, np.array([[0, 1, 8]], np.uint32))
        with self.assertRaisesRegex(TypeError, "triangles: holds int64; must be uint32 of shape \\(M, 3\\)"):
            rr.Mesh(box.vertices, np.array([[0, 1, 2]]))
        with self.assertRaisesRegex(ValueError, "vertices: row 1 is not finite"):
            rr.Mesh(np.array([[0, 0, 0], [np.nan, 0, 0]], np.float32), np.zeros((0, 3), np.uint32))
        with self.assertRaisesRegex(ValueError, "normals: has the shape \\(1, 3\\)"):
            rr.Mesh(box.vertices, box.triangles, normals=np.zeros((1, 3), np.float32))
        with self.assertRaisesRegex(rr.Error, "no.ply"):
            rr.Mesh.read("no.ply")


class Sources(unittest.TestCase):
    def test_frames_begin_again_with_each_loop(self):
        source = rr.open_source("sim:table?frames=5&width=160&noise=0")
        first = [frame.index for frame in source]
        self.assertEqual(first, [0, 1, 2, 3, 4])
        self.assertEqual([frame.index for frame in source], first)
        self.assertEqual((len(source), source.frame_count, source.skipped), (5, 5, 0))
        self.assertIsNone(source.next_frame())

    def test_frames_of_a_loop_are_separate_objects(self):
        frames = list(rr.open_source("sim:table?frames=3&width=160"))
        self.assertEqual(len({address(frame.depth_m) for frame in frames}), 3)

    def test_a_range_and_a_seek_choose_frames(self):
        source = rr.open_source("sim:table?frames=9&width=160&noise=0", frames=(2, 4))
        self.assertEqual([frame.index for frame in source], [2, 3, 4])
        whole = rr.open_source("sim:table?frames=9&width=160&noise=0")
        self.assertTrue(whole.seek(6))
        self.assertEqual(whole.next_frame().index, 6)
        with self.assertRaises(IndexError):
            whole.seek(9)

    def test_frames_in_memory_are_a_source(self):
        frames = list(rr.open_source("sim:table?frames=3&width=160"))
        source = rr.Source.of_frames(frames, name="mine")
        self.assertEqual(source.name, "mine")
        for given, read in zip(frames, source):
            np.testing.assert_array_equal(given.depth_m, read.depth_m)
        with self.assertRaisesRegex(ValueError, "stamp_s of frame 1 must be later"):
            rr.Source.of_frames(frames[::-1])

    def test_a_closed_source_says_so(self):
        with rr.open_source("sim:table?frames=3&width=160") as source:
            source.next_frame()
        for use in (source.next_frame, source.rewind, lambda: len(source), lambda: source.name, lambda: list(source)):
            with self.assertRaisesRegex(rr.Error, "the source is closed"):
                use()
        source.close()  # again: nothing

    def test_decisions_about_a_recording_are_listed_and_advice_is_a_warning(self):
        recording = support.temporary_folder() / "table"
        support.command("record", "sim:table?frames=30&width=160&rate=15", recording, "--format", "7scenes")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertFalse([each for each in rr.open_source(recording).input if each["advice"]])
        with self.assertWarnsRegex(UserWarning, "unit"):
            source = rr.open_source(recording, depth_unit_m=0.0001)
        self.assertIn("unit", [each["topic"] for each in source.input if each["advice"]])
        frames = [next(iter(rr.open_source(recording, depth_unit_m=unit_m))) for unit_m in (0.001, 0.002)]
        np.testing.assert_allclose(frames[1].depth_m, 2 * frames[0].depth_m, rtol=1e-6)
        with self.assertRaisesRegex(ValueError, "poses_convention"):
            rr.open_source(recording, poses_convention="sideways")

    def test_what_is_no_source_is_named(self):
        with self.assertRaisesRegex(rr.Error, "no such file or folder"):
            rr.open_source("nothing/here")
        with self.assertRaises(rr.Error):
            rr.open_source("sim:castle")


class Simulated(unittest.TestCase):
    def test_the_truth_is_that_of_the_last_frame(self):
        simulator = rr.Simulator("sim:table?frames=3&width=160&noise=0&moving=hand&path=view")
        for frame in simulator:
            truth = simulator.truth
            np.testing.assert_array_equal(frame.depth_m, truth.depth_m)
            np.testing.assert_array_equal(frame.T_world_camera, truth.T_world_camera)
        self.assertEqual((truth.moved.shape, truth.moved.dtype), ((120, 160), np.uint8))
        again = simulator.look(2, truth.T_world_camera)
        np.testing.assert_array_equal(again.depth_m, frame.depth_m)

    def test_the_room_has_a_floor(self):
        mesh = rr.Simulator("sim:table?frames=1").room_mesh()
        self.assertTrue(np.any(np.abs(mesh.vertices[:, 2] + mesh.origin[2]) < 1e-6))

    def test_a_closed_simulator_says_so(self):
        simulator = rr.Simulator("sim:table?frames=1&width=160")
        simulator.close()
        for use in (lambda: simulator.truth, simulator.room_mesh, lambda: simulator.look(0, np.eye(4))):
            with self.assertRaisesRegex(rr.Error, "the source is closed"):
                use()

    def test_a_simulated_recording_is_that_of_the_command(self):
        folder = support.temporary_folder()
        seen = []
        rr.simulate(folder / "python", "sim:table?frames=3&seed=4&path=scan", progress=lambda *n: seen.append(n))
        support.command("simulate", folder / "command", "--frames", 3, "--seed", 4)
        self.assertEqual(seen, [(1, 3), (2, 3), (3, 3)])
        files = sorted(f.relative_to(folder / "command") for f in (folder / "command").rglob("*") if f.is_file())
        self.assertGreater(len(files), 8)
        for file in files:
            self.assertEqual((folder / "command" / file).read_bytes(), (folder / "python" / file).read_bytes(), file)


class Lifetimes(unittest.TestCase):
    def test_a_frame_is_freed_with_its_last_view(self):
        frame, _, _ = make_frame()
        view = frame.colour
        reference = weakref.ref(view)
        del frame, view
        gc.collect()
        self.assertIsNone(reference())


if __name__ == "__main__":
    unittest.main()
