"""Long calls: the interpreter's lock, progress, Ctrl-C, live devices."""
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np

import roomradar as rr
import support


class Lock(unittest.TestCase):
    def ticks_during(self, call):
        """Returns how often another thread ran while the call did."""
        ticks, ended = [0], threading.Event()

        def tick():
            while not ended.wait(0.001):
                ticks[0] += 1

        ticker = threading.Thread(target=tick)
        ticker.start()
        try:
            call()
        finally:
            ended.set()
            ticker.join()
        return ticks[0]

    def test_long_calls_let_other_threads_run(self):
        folder = support.temporary_folder()
        room = support.table_map()
        tree = rr.TriangleTree(support.box_mesh(0.1))
        scene = rr.RadarScene()
        scene.add(rr.TriangleTree(room.mesh))
        poses = support.random_poses(5000, 1, [-1, -1, 0.2], [1, 1, 1.5])
        directions = np.random.default_rng(1).normal(size=(5000, 3))
        session = rr.Session(room, poses="recorded")
        frames = list(rr.open_source(support.VIEW))
        calls = {
            "prescan": lambda: rr.prescan("sim:table?frames=5&width=160", resolution_m=0.03, texture=False),
            "save": lambda: room.save(folder / "map"),
            "query_many": lambda: rr.CyberRadar().query_many(tree, poses, directions, 2.0, scene),
            "step": lambda: [session.step(frame) for frame in frames],
            "surface": lambda: room.octree.surface(),
            "frames": lambda: list(rr.open_source("sim:table?frames=5&width=320")),
            "verify": lambda: [rr.verify_map(support.table_folder()) for _ in range(5)],
        }
        for name, call in calls.items():
            with self.subTest(name):
                self.assertGreater(self.ticks_during(call), 3)


class Progress(unittest.TestCase):
    def test_an_exception_of_the_callback_ends_the_scan(self):
        class Enough(Exception):
            pass

        def stop(stage, note):
            raise Enough(stage)

        with self.assertRaisesRegex(Enough, "track"):
            rr.prescan("sim:table?frames=5&width=160", progress=stop)
        with self.assertRaises(Enough):
            rr.simulate(support.temporary_folder() / "x", "sim:table?frames=3&width=160", progress=stop)

    def test_the_source_can_be_used_after_a_scan_that_failed(self):
        source = rr.open_source("sim:table?frames=3&width=160")
        with self.assertRaises(ZeroDivisionError):
            rr.prescan(source, progress=lambda stage, note: 1 / 0)
        self.assertEqual(len(list(source)), 3)


class Interrupted(unittest.TestCase):
    def interrupt(self, lines):
        """Runs a script, presses Ctrl-C after its first line of output, and returns its remaining output."""
        script = "import roomradar as rr\ndef say(*_): print('at work', flush=True)\n" + lines
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler)) as process:
            self.assertEqual(process.stdout.readline(), "at work\n")
            process.send_signal(signal.SIGINT)
            _, fault = process.communicate(timeout=300)
        self.assertIn("KeyboardInterrupt", fault)
        self.assertNotEqual(process.returncode, 0)

    def test_ctrl_c_ends_a_scan(self):
        self.interrupt("rr.prescan('sim:table?frames=100000&width=160', progress=say)")

    def test_ctrl_c_ends_a_simulation(self):
        folder = support.temporary_folder() / "sim"
        self.interrupt(f"rr.simulate({str(folder)!r}, 'sim:table?frames=100000&width=160', progress=say)")

    def test_ctrl_c_ends_a_loop_over_frames(self):
        self.interrupt("for frame in rr.open_source('sim:table?frames=100000&width=160'): say()")


if __name__ == "__main__":
    unittest.main()
