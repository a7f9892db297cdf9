"""Maps and scans: those of the command line, byte for byte."""
import json
import locale
import os
import shutil
import subprocess
import unittest

import numpy as np

import roomradar as rr
import support


class Scans(unittest.TestCase):
    def test_a_scan_is_that_of_the_command(self):
        spec = "sim:table?frames=25&width=160&seed=3"
        scan, stages = support.compare_scan(self, spec, [spec, "--resolution", "0.03"], resolution_m=0.03)
        self.assertEqual(scan.counts["frames_read"], 25)
        self.assertGreaterEqual(stages["track"], 25)
        self.assertEqual(stages["surface"], 1)
        self.assertTrue(all(hole.size_m > 0 for hole in scan.holes))

    def test_a_scan_with_recorded_poses_is_that_of_the_command(self):
        support.compare_scan(self, rr.open_source(support.SCAN, cache=True),
                             [support.SCAN, "--resolution", "0.03", "--poses", "recorded", "--texture", "off",
                              "--deviation", "0.004"],
                             resolution_m=0.03, poses="recorded", texture=False, deviation_m=0.004)

    def test_frames_in_memory_are_scanned(self):
        frames = list(rr.open_source("sim:table?frames=20&width=160&seed=3"))
        scan = rr.prescan(rr.Source.of_frames(frames), resolution_m=0.03, texture=False)
        self.assertEqual(scan.counts["frames_tracked"], 20)
        self.assertEqual(scan.map.info["source"], "frames")
        self.assertGreater(len(scan.map.mesh.triangles), 100)
        self.assertEqual(scan.map.folder, "")

    def test_wrong_settings_are_named(self):
        for words, settings in (("resolution_m", {"resolution_m": -1.0}), ("resolution_m", {"resolution_m": float("nan")}),
                                ("poses", {"poses": "guessed"}), ("up", {"up": (0, 0, 0)}),
                                ("hold_out", {"hold_out": -1}), ("max_memory_mb", {"max_memory_mb": -1.0}),
                                ("progress", {"progress": 3}), ("fuse_every", {"fuse_every": 0})):
            with self.assertRaisesRegex((rr.Error, ValueError, TypeError), words):
                rr.prescan("sim:table?frames=2&width=160", **settings)


class HostLocale(unittest.TestCase):
    def setUp(self):
        folder = support.temporary_folder()
        made = shutil.which("localedef") and subprocess.run(
            ["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], capture_output=True).returncode == 0
        if not made:
            self.skipTest("the package locales is missing")
        os.environ["LOCPATH"] = str(folder)
        locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
        self.addCleanup(locale.setlocale, locale.LC_ALL, "C")

    def test_a_german_python_scans_the_same_map_and_hears_the_same_words(self):
        self.assertEqual(locale.str(1.5), "1,5")
        spec = "sim:table?frames=25&width=160&seed=3&noise=0.5"
        scan, _ = support.compare_scan(self, spec, [spec, "--resolution", "0.03"], resolution_m=0.03)
        folder = support.temporary_folder()
        scan.map.save(folder / "map")
        for name in ("a.ply", "a.obj", "a.stl", "a.glb", "a.ot", "a.bt"):
            rr.export_map(folder / "map", folder / name)
            support.command("map", "export", folder / "map", folder / ("of-command-" + name))
        for name in ("a.ply", "a.stl", "a.glb", "a.ot", "a.bt"):
            self.assertEqual((folder / name).read_bytes(), (folder / ("of-command-" + name)).read_bytes(), name)
        with self.assertRaisesRegex(rr.Error, "No such file|there is no"):
            rr.open_map(folder / "none")
        with self.assertRaisesRegex((rr.Error, ValueError), r"1234\.5"):
            rr.prescan("sim:table?frames=2&width=160", resolution_m=1234.5)


class Maps(unittest.TestCase):
    def test_info_is_that_of_the_command(self):
        text = json.loads(support.command("map", "info", support.table_folder(), "--json"))
        surfaces = text.pop("surfaces")
        self.assertEqual(rr.map_info(support.table_folder()), text)
        room = support.table_map()
        self.assertEqual(room.info, text)
        self.assertEqual(sorted(s.height_m for s in room.level_surfaces()), sorted(s["height_m"] for s in surfaces))
        self.assertEqual(room.resolution_m, 0.03)

    def test_a_sound_map_has_no_faults_and_a_damaged_one_has(self):
        self.assertEqual(rr.verify_map(support.table_folder()), [])
        folder = support.temporary_folder() / "damaged"
        support.table_map().save(folder)
        mesh = folder / "mesh.ply"
        mesh.write_bytes(mesh.read_bytes()[:-1])
        self.assertEqual(len(rr.verify_map(folder)), 1)
        with self.assertRaisesRegex(rr.Error, "mesh.ply"):
            rr.open_map(folder)
        with self.assertRaisesRegex(rr.Error, "nowhere"):
            rr.open_map("nowhere")

    def test_a_saved_map_is_the_same(self):
        folder = support.temporary_folder() / "again"
        support.table_map().save(folder)
        saved, first = support.files_of(folder), support.files_of(support.table_folder())
        for name in first.keys() - {"map.json", "mesh.ply", "trajectory.txt"}:  # texts are rounded again
            self.assertEqual(saved[name], first[name], name)
        self.assertEqual(rr.diff_maps(support.table_map(), rr.open_map(folder)), [])

    def test_exports_are_those_of_the_command(self):
        folder = support.temporary_folder()
        for extension in ("ply", "glb", "ot", "html"):
            rr.export_map(support.table_folder(), folder / f"python.{extension}")
            support.command("map", "export", support.table_folder(), folder / f"command.{extension}")
            self.assertEqual((folder / f"python.{extension}").read_bytes(),
                             (folder / f"command.{extension}").read_bytes(), extension)
        with self.assertRaisesRegex(rr.Error, "xyz"):
            rr.export_map(support.table_folder(), folder / "mesh.xyz")

    def test_occupancy_agrees_with_the_leaves(self):
        room = support.table_map()
        leaves = room.octree.leaves()
        centres = (leaves["lowest_voxel"] + leaves["edge_voxels"][:, None] / 2) * room.resolution_m
        occupied = leaves["log_odds"] > 0
        np.testing.assert_array_equal(room.occupancy(centres), np.where(occupied, 2, 1))
        self.assertEqual(room.occupancy(np.array([[100.0, 0, 0], [np.nan, 0, 0]])).tolist(), [0, 0])
        counts = room.octree.counts()
        self.assertEqual(counts["occupied_leaves"] + counts["free_leaves"], len(centres))

    def test_samples_lie_near_the_surface(self):
        samples = support.table_map().octree.samples()
        self.assertEqual(samples["voxel"].shape, (len(samples["distance_m"]), 3))
        self.assertLess(np.abs(samples["distance_m"]).max(), 0.2)
        self.assertEqual(samples["has_colour"].dtype, np.bool_)

    def test_keyframes_and_trajectory_are_arrays(self):
        room = support.table_map()
        stamps, poses = room.trajectory
        self.assertEqual((stamps.shape, poses.shape), ((60,), (60, 4, 4)))
        keyframe = room.keyframes[0]
        self.assertEqual(keyframe.preview_depth_mm.dtype, np.uint16)
        self.assertEqual(keyframe.preview_depth_mm.shape,
                         (keyframe.preview_camera.height_px, keyframe.preview_camera.width_px))
        self.assertGreater(keyframe.features, 0)
        self.assertTrue(room.coverage_png.startswith(b"\x89PNG"))
        self.assertGreater(len(room.unknown_surface().triangles), 0)

    def test_maps_of_one_room_are_merged_compared_and_extended(self):
        folder = support.temporary_folder()
        room = "sim:table?frames=60&width=160&seed=2"
        for name, spec in (("a", room), ("b", room + "&crate=1")):
            rr.prescan(spec, resolution_m=0.03, poses="recorded", texture=False).map.save(folder / name)
        a, b = rr.open_map(folder / "a"), rr.open_map(folder / "b")
        np.testing.assert_allclose(rr.register_maps(a, b), np.eye(4), atol=0.02)
        rr.merge_maps(a, b).save(folder / "python")
        support.command("map", "merge", folder / "a", folder / "b", "--map", folder / "command")
        self.assertEqual(support.files_of(folder / "python"), support.files_of(folder / "command"))

        support.command("map", "diff", folder / "a", folder / "b", "--report", folder / "diff.json")
        rows = json.loads((folder / "diff.json").read_text())["changes"]
        changes = rr.diff_maps(a, b)
        self.assertEqual([(c.kind, c.area_m2, c.volume_m3) for c in changes],
                         [(row["kind"], row["area_m2"], row["volume_m3"]) for row in rows])
        self.assertEqual([change.kind for change in changes], ["appeared"])
        self.assertTrue(np.all(changes[0].box_world[0] < changes[0].box_world[1]))
        self.assertEqual(changes[0].surface_world.shape[1], 3)

        extended = rr.prescan(room + "&crate=1", poses="recorded", texture=False, extend=a)
        shutil.copytree(folder / "a", folder / "extended")
        extended.map.save(folder / "extended")  # a revision of the same map, as the command's
        support.command("prescan", room + "&crate=1", "--poses", "recorded", "--texture", "off", "--map", folder / "a",
                        "--resume")
        self.assertEqual(support.files_of(folder / "extended"), support.files_of(folder / "a"))
        with self.assertRaisesRegex(rr.Error, "the maps are the same"):
            rr.merge_maps(b, b)
        with self.assertRaisesRegex(rr.Error, "extend: the map is not in a folder"):
            rr.prescan(room, extend=extended.map)


class Fusion(unittest.TestCase):
    def test_frames_are_fused_into_an_octree_of_ones_own(self):
        octree = rr.StaticMap(0.03)
        source = rr.open_source("sim:table?frames=10&width=160&noise=0")
        for frame in source:
            self.assertEqual(octree.fuse(frame), "fused")
        mesh = octree.surface(deviation_m=0.002)
        self.assertGreater(len(mesh.triangles), 500)
        depth = frame.depth_m[60, 80]
        x, y = (np.array([80, 60]) - [frame.depth_camera.cx_px, frame.depth_camera.cy_px]) / [
            frame.depth_camera.fx_px, frame.depth_camera.fy_px]
        ray = np.array([x, y, 1.0, 0.0])
        eye = frame.T_world_camera[:3, 3]
        towards = (frame.T_world_camera @ ray)[:3]
        points = np.ascontiguousarray([eye + 0.5 * depth * towards, eye + depth * towards])
        self.assertEqual(octree.occupancy(points).tolist(), [int(rr.Occupancy.FREE), int(rr.Occupancy.OCCUPIED)])

    def test_the_octree_is_that_of_a_prescan_with_recorded_poses(self):
        octree = rr.StaticMap(0.03)
        for frame in rr.open_source(support.SCAN):
            octree.fuse(frame)
        folder = support.temporary_folder()
        octree.write(folder / "octree.bin")
        self.assertEqual((folder / "octree.bin").read_bytes(), (support.table_folder() / "octree.bin").read_bytes())
        again = rr.StaticMap.read(folder / "octree.bin")
        np.testing.assert_array_equal(again.leaves()["log_odds"], octree.leaves()["log_odds"])

    def test_what_cannot_be_fused_is_said(self):
        octree = rr.StaticMap(0.03)
        nothing = rr.Frame(np.zeros((120, 160), np.float32), support.camera())
        self.assertNotEqual(octree.fuse(nothing, np.eye(4)), "fused")
        with self.assertRaisesRegex(ValueError, "T_world_camera: is missing"):
            octree.fuse(nothing)
        with self.assertRaisesRegex(rr.Error, "does not change"):
            support.table_map().octree.fuse(nothing, np.eye(4))
        with self.assertRaises(rr.Error):
            rr.StaticMap(0.0)
        with self.assertRaisesRegex(ValueError, "points_world: has the shape \\(3,\\)"):
            octree.occupancy(np.zeros(3))
        with self.assertRaisesRegex(rr.Error, "the extension must be"):
            octree.write("octree.xyz")


if __name__ == "__main__":
    unittest.main()
