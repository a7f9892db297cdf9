"""The examples run, and their results are those expected."""
import base64
import importlib.util
import json
import os
import pathlib
import socket
import subprocess
import sys
import threading
import unittest

import numpy as np

import support

EXAMPLES = pathlib.Path(os.environ["ROOMRADAR_PACKAGE"]) / "examples"


def run(example, *arguments, **pipes):
    done = subprocess.run([sys.executable, EXAMPLES / example, *map(str, arguments)], capture_output=True, text=True,
                          **pipes)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


def has(module):
    return importlib.util.find_spec(module) is not None


def stream(*options):
    return support.command("run", support.VIEW, "--map", support.table_folder(), "--objects", "none", "--poses",
                           "recorded", "--stream", "-", *options)


class Help(unittest.TestCase):
    def test_it_is_printed_on_demand(self):
        for example, needed in (("bridge_stream.py", "json"), ("clearance.py", "matplotlib"),
                                ("open3d_mesh.py", "open3d"), ("plot_map.py", "matplotlib")):
            if has(needed):
                self.assertIn(f"usage: {'roomradar run' if needed == 'json' else example}", run(example, "--help"))


class Pictures(unittest.TestCase):
    def picture(self, example):
        path = support.temporary_folder() / "picture.png"
        out = run(example, support.table_folder(), path)
        self.assertGreater(path.stat().st_size, 2000)
        return out

    @unittest.skipUnless(has("matplotlib"), "python3-matplotlib is absent")
    def test_a_map_is_drawn_from_above(self):
        self.picture("plot_map.py")

    @unittest.skipUnless(has("matplotlib"), "python3-matplotlib is absent")
    def test_boxes_fall_everywhere(self):
        stopped = int(self.picture("clearance.py").split()[0])
        self.assertIn(stopped, range(2000, 10000))

    @unittest.skipUnless(has("open3d"), "python3-open3d is absent")
    def test_a_mesh_goes_to_open3d_and_back(self):
        words = self.picture("open3d_mesh.py").split()
        points, apart_mm, fall_m = int(words[1]), float(words[3]), float(words[words.index("falls") + 1])
        self.assertGreater(points, 10000)
        self.assertLess(apart_mm, 1.0)  # the renderer's depth step, and Open3D's floats
        self.assertAlmostEqual(fall_m, 0.45, delta=0.05)


class Bridge(unittest.TestCase):
    def check(self, messages, lines):
        frames = [line for line in map(json.loads, lines.splitlines()) if line["type"] == "frame"]
        topics = [message["topic"] for message in messages]
        self.assertEqual(topics.count("camera/pose"), len(frames))
        masks = [message["msg"] for message in messages if message["topic"] == "camera/moved_mask"]
        moved = 0
        for mask, frame in zip(masks, frames):
            pixels = np.frombuffer(base64.b64decode(mask["data"]), np.uint8).reshape(mask["height"], mask["width"])
            self.assertEqual(np.count_nonzero(pixels), sum(frame["moved_mask"]["runs"][1::2]))
            moved = max(moved, np.count_nonzero(pixels))
        self.assertGreater(moved, 100)
        contacts = [message["msg"]["contacts"] for message in messages if message["topic"] == "objects/object/contacts"]
        self.assertEqual(contacts[-1], frames[-1]["objects"][0]["contacts"])
        self.assertGreaterEqual(len(contacts[-1]), 3)
        stamp = messages[-1]["msg"]["header"]["stamp"]
        self.assertAlmostEqual(stamp["sec"] + stamp["nanosec"] * 1e-9, frames[-1]["stamp_s"], delta=2e-9)

    def test_lines_become_messages(self):
        lines = stream()
        self.check([json.loads(text) for text in run("bridge_stream.py", input=lines).splitlines()], lines)

    def test_messages_go_to_a_server(self):
        lines = stream()
        with socket.create_server(("127.0.0.1", 0)) as server:
            received = []

            def serve():
                connection, _ = server.accept()
                with connection, connection.makefile() as file:
                    received.extend(map(json.loads, file))

            thread = threading.Thread(target=serve)
            thread.start()
            run("bridge_stream.py", f"127.0.0.1:{server.getsockname()[1]}", input=lines)
            thread.join()
        self.check(received, lines)

    def test_masks_are_those_of_the_session(self):
        import roomradar as rr

        session = rr.Session(support.table_map(), poses="recorded")
        frames = [line for line in map(json.loads, stream().splitlines()) if line["type"] == "frame"]
        for frame, line in zip(rr.open_source(support.VIEW), frames):
            session.step(frame)
            pixels = np.zeros(frame.depth_m.size, np.uint8)
            runs = line["moved_mask"]["runs"]
            for first, length in zip(runs[::2], runs[1::2]):
                pixels[first:first + length] = 255
            np.testing.assert_array_equal(pixels.reshape(frame.depth_m.shape), session.moved_mask)


if __name__ == "__main__":
    unittest.main()
