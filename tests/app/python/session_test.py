"""Sessions: the results of `roomradar run`, views of their images, and threads."""
import gc
import threading
import unittest

import numpy as np

import roomradar as rr
import support
from support import address


def frames(count=10):
    return rr.open_source(support.VIEW, frames=(0, count - 1))


def session(**settings):
    return rr.Session(support.table_map(), poses="recorded", **settings)


class Fingerprints(unittest.TestCase):
    def test_they_are_those_of_the_command(self):
        played = support.compare_session(self, support.VIEW, support.table_folder(), ["--poses", "recorded"],
                                         session={"poses": "recorded"})
        pot, = played.objects
        self.assertEqual((pot.name, pot.state, pot.rests_on), ("object", "at rest", rr.SurfaceKind.STATIC))
        self.assertGreaterEqual(len(pot.contacts), 3)
        self.assertRegex(repr(pot), r"^<roomradar.ObjectState object: at rest at \(.+, .+, .+\) m>$")
        self.assertTrue(all(touch.normal_world[2] > 0.9 and touch.gap_m <= 0.0015 for touch in pot.contacts))

    def test_they_are_those_of_the_command_with_other_quality(self):
        support.compare_session(
            self, support.VIEW, support.table_folder(),
            ["--poses", "recorded", "--depth-stride", "2", "--radar", "sampled", "--shadows", "off", "--unknown", "free"],
            session={"poses": "recorded", "unknown": "free",
                     "quality": {"depth_stride": 2, "radar": "sampled", "shadows": False}})


class Views(unittest.TestCase):
    def test_images_are_not_copied(self):
        played = session()
        self.assertIsNone(played.picture)
        places = set()
        for frame in frames():
            result = played.step(frame)
            self.assertRegex(repr(result), "^<roomradar.FrameResult done: [0-9]+ dynamic triangles, 0 contacts>$")
            places.add((address(played.picture), address(played.moved_mask), address(played.expected_depth_m)))
        self.assertEqual(len(places), 1)
        self.assertEqual((played.picture.shape, played.picture.dtype), (frame.colour.shape, np.uint8))
        self.assertEqual((played.moved_mask.shape, played.expected_depth_m.dtype), (frame.depth_m.shape, np.float32))
        self.assertFalse(played.picture.flags.writeable)

    def test_a_view_keeps_the_session_and_shows_its_newest_picture(self):
        played = session()
        source = frames()
        played.step(source.next_frame())
        picture = played.picture
        before = picture.copy()
        played.step(source.next_frame())
        self.assertFalse(np.array_equal(picture, before))
        del played
        gc.collect()
        self.assertEqual(picture.shape, before.shape)
        self.assertGreater(int(picture.max()), 0)

    def test_a_view_forbids_what_would_free_its_memory(self):
        played = session()
        played.step(frames().next_frame())
        mask = played.moved_mask
        larger = rr.open_source(support.VIEW.replace("width=160", "width=320")).next_frame()
        with self.assertRaisesRegex(rr.Error, "still in use"):
            played.step(larger)
        with self.assertRaisesRegex(rr.Error, "still in use"):
            played.set_quality({"depth_stride": 2})
        with self.assertRaisesRegex(rr.Error, "still in use"):
            played.close()
        del mask
        self.assertTrue(played.step(larger))
        played.close()
        for use in (lambda: played.step(larger), lambda: played.picture, lambda: played.objects, played.close,
                    lambda: played.add("pot"), played.fingerprint, lambda: played.stage_ms):
            with self.assertRaisesRegex(rr.Error, "the session is closed"):
                use()

    def test_a_session_in_a_with_block_is_closed(self):
        with session() as played:
            played.step(frames().next_frame())
        with self.assertRaisesRegex(rr.Error, "the session is closed"):
            played.objects

    def test_the_picture_is_read_into_an_array(self):
        played = session()
        played.step(frames().next_frame())
        out = np.zeros_like(played.picture)
        played.read_picture(out)
        np.testing.assert_array_equal(out, played.picture)
        out.flags.writeable = False
        for wrong, words in ((out, "out: is read-only"), (np.zeros((3, 3, 3), np.uint8), "out: has the shape"),
                             (np.zeros(out.shape, np.float32), "out: holds float32"),
                             (np.zeros((120, 320, 3), np.uint8)[:, ::2], "out: is not contiguous")):
            with self.assertRaisesRegex((ValueError, TypeError), words):
                played.read_picture(wrong)


class Objects(unittest.TestCase):
    def test_what_moved_has_a_mask_and_a_mesh(self):
        played = session(make_picture=False)
        moved = 0
        for frame in rr.open_source(support.VIEW):
            result = played.step(frame)
            moved = max(moved, result.foreground["moved"])
            self.assertEqual(np.count_nonzero(played.moved_mask), result.foreground["moved"])
            self.assertEqual(len(played.moved_mesh().triangles), result.dynamic_triangles)
        self.assertGreater(moved, 100)
        self.assertIsNone(played.picture)

    def test_objects_are_placed_thrown_carried_and_removed(self):
        played = session()
        played.add("pot", mass_kg=2.0)
        played.add("box", support.box_mesh(0.1))
        self.assertEqual([o.state for o in played.objects], ["outside", "outside"])
        pot, box = played.objects
        self.assertEqual(pot.mass_kg, 2.0)
        focus = max(support.table_map().level_surfaces(), key=lambda s: s.height_m).middle_world
        played.place("pot", focus + [0, 0, 0.3])
        played.throw("box", focus + [0.3, 0, 0.6], (0, 0, 1.0))
        source = rr.open_source(support.VIEW)
        played.step(source.next_frame())
        played.step(source.next_frame())
        self.assertGreater(played.objects[1].velocity_world_mps[2], 0.5)
        played.carry("box", focus + [0, 0, 0.8])
        played.step(source.next_frame())
        self.assertEqual(played.objects[1].state, "carried")
        played.release("box")
        played.turn("pot", (0, 0, 10))
        played.set_material("pot", friction=0.9)
        played.remove("box")
        self.assertEqual(played.objects[1].state, "outside")
        tree = rr.TriangleTree(support.box_mesh(0.05))
        contact = played.query(tree, support.pose(*(focus + [0, 0, 1.0])), (0, 0, -1), 2.0)
        self.assertTrue(contact)
        self.assertIn(contact.touched, (rr.SurfaceKind.STATIC, rr.SurfaceKind.OBJECT))

    def test_wrong_calls_change_nothing(self):
        played = session()
        played.add("pot")
        for call in (lambda: played.add("pot"), lambda: played.place("pan", (0, 0, 0)),
                     lambda: played.drop("pan"), lambda: played.add("big", "no.glb"),
                     lambda: played.add("pan", mass_kg=-1.0), lambda: played.set_material("pot", friction=99.0),
                     lambda: played.set_quality({"depth_stride": 3}), lambda: played.set_quality({"nonsense": 1}),
                     lambda: played.place("pot", (float("nan"), 0, 0)), lambda: played.add("pan", "teapot", up="w"),
                     lambda: played.set_unknown("maybe"), lambda: played.set_surfaces("walls")):
            with self.assertRaises((rr.Error, ValueError, TypeError)):
                call()
        self.assertEqual([o.name for o in played.objects], ["pot"])

    def test_a_bad_frame_says_why(self):
        played = rr.Session(support.table_map(), poses="recorded")
        lost = rr.Frame(np.ones((120, 160), np.float32), support.camera())
        result = played.step(lost)
        self.assertFalse(result)
        self.assertEqual((result.status, result.T_world_camera), ("not located", None))


class Threads(unittest.TestCase):
    def test_a_session_is_used_and_freed_by_any_thread(self):
        made = []
        worker = threading.Thread(target=lambda: made.append(session()))
        worker.start()
        worker.join()
        played = made.pop()
        own = frames(20)
        shared = list(own)
        threads = [threading.Thread(target=lambda part: [played.step(f) for f in part], args=(shared[i::2],))
                   for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(played.step(shared[-1]))

    def test_two_sessions_live_side_by_side(self):
        one, two = session(), session()
        for frame in frames(5):
            one.step(frame)
            two.step(frame)
            self.assertEqual(one.fingerprint(), two.fingerprint())


class Location(unittest.TestCase):
    def test_the_camera_is_found_and_followed(self):
        locator = rr.Locator(support.table_map())
        for frame in rr.open_source(support.SCAN, frames=(20, 29)):
            found = locator.locate(frame)
            self.assertTrue(found, found.status)
            self.assertLess(np.linalg.norm(found.T_world_camera[:3, 3] - frame.T_world_camera[:3, 3]), 0.03)
        locator.set_pose(None)
        self.assertTrue(locator.locate(frame))
        depth = locator.expected_depth(frame.depth_camera, frame.T_world_camera)
        both = (depth > 0) & (frame.depth_m > 0)
        self.assertGreater(np.count_nonzero(both), 5000)
        self.assertLess(np.median(np.abs(depth - frame.depth_m)[both]), 0.02)

    def test_another_room_is_not_found(self):
        locator = rr.Locator(support.table_map())
        black = rr.Frame(np.zeros((120, 160), np.float32), support.camera())
        found = locator.locate(black)
        self.assertFalse(found)
        self.assertIsNone(found.T_world_camera)
        with self.assertRaisesRegex(ValueError, "moved_mask: must have the size"):
            locator.locate(black, moved_mask=np.zeros((3, 3), np.uint8))


if __name__ == "__main__":
    unittest.main()
