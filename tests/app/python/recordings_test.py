"""Recordings of real devices, and a live device: maps and sessions are those of the command."""
import os
import shutil
import subprocess
import sys
import unittest

import roomradar as rr
import support


@unittest.skipUnless(support.KITCHEN.exists(), f"{support.KITCHEN} is absent")
class Kitchen(unittest.TestCase):
    def test_frames_have_poses(self):
        frames = list(rr.open_source(support.KITCHEN, frames=(0, 2)))
        self.assertEqual(len(frames), 3)
        self.assertEqual((frames[0].depth_m.shape, frames[0].colour.shape), ((480, 640), (480, 640, 3)))
        self.assertIsNotNone(frames[2].T_world_camera)

    def test_a_scan_is_that_of_the_command(self):
        support.compare_scan(self, rr.open_source(support.KITCHEN, frames=(0, 14)),
                             [support.KITCHEN, "--frames", "0:14"])

    def test_a_session_is_that_of_the_command(self):
        room = support.temporary_folder() / "kitchen"
        support.command("prescan", support.KITCHEN, "--frames", "0:19", "--map", room, "--resolution", "0.02")
        support.compare_session(self, support.KITCHEN, room, ["--frames", "0:19"], frames=(0, 19))


PLANES = support.DATA / "fakenect-planes" / "planes"


@unittest.skipUnless(PLANES.exists() and shutil.which("fakenect"), f"fakenect or {PLANES} is absent")
class Live(unittest.TestCase):
    def test_a_live_scan_ends_when_the_callback_says_so(self):
        script = """
import roomradar as rr
tracked = []
def progress(stage, note):
    if stage.startswith("track"):
        tracked.append(note)
        return len(tracked) < 8
scan = rr.prescan("kinect:0", resolution_m=0.05, texture=False, progress=progress)
print(scan.counts["frames_read"], len(scan.map.mesh.triangles) > 0)
"""
        done = subprocess.run(["fakenect", str(PLANES), sys.executable, "-c", script], capture_output=True, text=True,
                              env={**os.environ, "FAKENECT_LOOP": "0"}, cwd=support.temporary_folder(), timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)
        frames, has_mesh = done.stdout.split()[-2:]
        self.assertEqual(has_mesh, "True")
        self.assertIn(int(frames), range(8, 12))  # frames are read ahead


if __name__ == "__main__":
    if not support.DATA.exists():
        print(f"{support.DATA} is absent")
        sys.exit(77)
    unittest.main()
