"""Radar queries: known answers, and those of C++ to the bit."""
import subprocess
import threading
import unittest

import numpy as np

import roomradar as rr
import support

DOWN = np.array([0.0, 0.0, -1.0])


class KnownAnswers(unittest.TestCase):
    def setUp(self):
        self.scene = rr.RadarScene()
        self.scene.add(rr.TriangleTree(support.floor_mesh()))
        self.box = rr.TriangleTree(support.box_mesh(0.2))
        self.radar = rr.CyberRadar()

    def test_a_box_above_the_floor_travels_its_clearance(self):
        contact = self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene)
        self.assertTrue(contact)
        self.assertEqual(contact.status, rr.ContactStatus.CONTACT)
        self.assertAlmostEqual(contact.contact_distance_m, 0.9, delta=1e-7)
        self.assertEqual(contact.lower_m, contact.upper_m)
        self.assertEqual(contact.touched, rr.SurfaceKind.STATIC)
        self.assertEqual(repr(contact), "<roomradar.Contact CONTACT after 0.9 m, with STATIC>")
        np.testing.assert_allclose(contact.normal_world, [0, 0, 1], atol=1e-12)
        self.assertAlmostEqual(contact.point_world[2], 0.0, delta=1e-7)

    def test_directions_are_arrays_or_sequences(self):
        by_array = self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene)
        by_tuple = self.radar.query(self.box, support.pose(z=1.0), (0, 0, -1), 2.0, self.scene)
        self.assertEqual(by_array.contact_distance_m, by_tuple.contact_distance_m)

    def test_nothing_within_the_distance_is_no_contact(self):
        contact = self.radar.query(self.box, support.pose(z=1.0), DOWN, 0.5, self.scene)
        self.assertFalse(contact)
        self.assertEqual(contact.status, rr.ContactStatus.NO_TARGET)
        self.assertEqual(contact.lower_m, 0.5)

    def test_the_kind_says_what_an_object_rests_on(self):
        index = self.scene.add(self.box, support.pose(z=0.1), kind=rr.SurfaceKind.OBJECT)
        contact = self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene)
        self.assertEqual(contact.touched, rr.SurfaceKind.OBJECT)
        self.assertAlmostEqual(contact.contact_distance_m, 0.7, delta=1e-6)
        self.scene.set_pose(index, support.pose(x=1.0, z=0.1))
        self.assertEqual(self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene).touched,
                         rr.SurfaceKind.STATIC)
        own = self.radar.query(self.box, support.pose(x=1.0, z=0.1), (0, 0, 1), 1.0, self.scene, own_tree=index)
        self.assertEqual(own.status, rr.ContactStatus.NO_TARGET)

    def test_a_depth_image_is_a_surface(self):
        depth = np.full((120, 160), 1.5, np.float32)
        frame = rr.Frame(depth, support.camera(), T_world_camera=np.eye(4))
        scene = rr.RadarScene()
        scene.add_frame(frame, stride_px=2)
        del frame, depth  # the scene keeps them
        contact = self.radar.query(self.box, np.eye(4), (0, 0, 1), 3.0, scene)
        self.assertEqual(contact.touched, rr.SurfaceKind.DYNAMIC)
        self.assertAlmostEqual(contact.contact_distance_m, 1.4, delta=1e-6)

    def test_a_margin_shortens_the_free_way(self):
        contact = self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene, margin_m=0.05)
        self.assertLessEqual(contact.lower_m, 0.85 + 1e-6)

    def test_one_radar_is_not_used_by_two_threads_at_once(self):
        poses = support.random_poses(20000, 1, [-1, -1, 0.5], [1, 1, 1.5])
        directions = np.tile(DOWN, (len(poses), 1))
        worker = threading.Thread(
            target=lambda: self.radar.query_many(self.box, poses, directions, 2.0, self.scene))
        worker.start()
        faults = set()
        while worker.is_alive():
            try:
                self.radar.query(self.box, support.pose(z=1.0), DOWN, 2.0, self.scene)
            except rr.Error as fault:
                faults.add(str(fault))
            try:
                self.scene.set_pose(0, support.pose())
            except rr.Error as fault:
                faults.add(str(fault))
        worker.join()
        self.assertEqual(faults, {"the radar is in use by another thread; wait for that call, or use two",
                                  "the scene is in use by another thread; wait for that call, or use two"})


class Reference(unittest.TestCase):
    def test_answers_are_those_of_cpp_to_the_bit(self):
        folder = support.temporary_folder()
        room = support.table_map().mesh
        room.write(folder / "room.ply")
        pot = support.box_mesh(0.15)
        pot.write(folder / "pot.ply")
        poses = support.random_poses(2000, 7, [-1.5, -1.5, 0.2], [1.5, 1.5, 1.5])
        directions = np.random.default_rng(8).normal(size=(2000, 3))
        np.concatenate([poses[:, :3].reshape(-1, 12), directions], axis=1).tofile(folder / "queries")
        subprocess.run([support.RADAR_REFERENCE, folder / "room.ply", folder / "pot.ply", folder / "queries",
                        folder / "answers"], check=True, capture_output=True)
        answers = np.fromfile(folder / "answers").reshape(-1, 11)

        scene = rr.RadarScene()
        scene.add(rr.TriangleTree(rr.Mesh.read(folder / "room.ply")))
        tree = rr.TriangleTree(rr.Mesh.read(folder / "pot.ply"))
        many = rr.CyberRadar().query_many(tree, poses, directions, 2.0, scene)
        self.assertEqual(len(many), 2000)
        self.assertGreater(np.count_nonzero(many.status == int(rr.ContactStatus.CONTACT)), 500)
        rows = np.column_stack([many.status, many.touched, many.contact_distance_m, many.lower_m, many.upper_m,
                                many.point_world, many.normal_world])
        np.testing.assert_array_equal(rows.view(np.uint64), answers.view(np.uint64))
        radar = rr.CyberRadar()
        for i in range(0, 2000, 10):
            one = radar.query(tree, poses[i], directions[i], 2.0, scene)
            self.assertEqual((int(one.status), int(one.touched), one.contact_distance_m, one.lower_m, one.upper_m,
                              *one.point_world, *one.normal_world), tuple(answers[i]))


if __name__ == "__main__":
    unittest.main()
