"""What the tests of the Python module share: the program, recordings, a small map."""
import atexit
import functools
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

import roomradar as rr

os.environ["SOURCE_DATE_EPOCH"] = "1700000000"  # maps saved twice have the same bytes

PROGRAM = os.environ["ROOMRADAR_PROGRAM"]
RADAR_REFERENCE = os.environ.get("ROOMRADAR_RADAR_REFERENCE", "")
DATA = pathlib.Path(os.environ.get("ROOMRADAR_DATA") or os.environ["ROOMRADAR_DATA_DEFAULT"])
KITCHEN = DATA / "kitchen"
SCAN = "sim:table?frames=60&width=160&seed=2"
VIEW = "sim:table?frames=40&width=160&path=view&seed=2&moving=hand"


def temporary_folder():
    folder = pathlib.Path(tempfile.mkdtemp(prefix="roomradar-python-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def command(*arguments):
    """Runs the program and returns its standard output."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: exit status {done.returncode}: {done.stderr}")
    return done.stdout


@functools.lru_cache(maxsize=None)
def table_folder():
    """Folder of a map of the simulated table, made by the command."""
    folder = temporary_folder() / "table"
    command("prescan", SCAN, "--map", folder, "--resolution", "0.03", "--poses", "recorded")
    return folder


@functools.lru_cache(maxsize=None)
def table_map():
    return rr.open_map(table_folder())


def files_of(folder):
    """The files of a map, without the log of its revisions, which names the program that saved it."""
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.name != "visits.jsonl"}


def compare_scan(test, source, by_command, **settings):
    """Scans with the module and with the command, and compares the maps byte for byte. Returns the scan and its stages."""
    folder = temporary_folder()
    stages = {}

    def count(stage, note):
        stages[stage] = stages.get(stage, 0) + 1

    scan = rr.prescan(source, progress=count, **settings)
    scan.map.save(folder / "python")
    command("prescan", *by_command, "--map", folder / "command")
    own, expected = files_of(folder / "python"), files_of(folder / "command")
    test.assertEqual(sorted(own), sorted(expected))
    for name in expected:
        test.assertEqual(own[name], expected[name], name)
    return scan, stages


def fingerprints(folder):
    lines = (folder / "results.txt").read_text().splitlines()
    return [tuple(int(word, 16) for word in line.split()[1:]) for line in lines if not line.startswith("#")]


def compare_session(test, source, room, by_command, **settings):
    """Compares each frame with a recorded run. Returns the session after its last frame."""
    folder = temporary_folder()
    command("run", source, "--map", room, "--objects", "none", "--record-session", folder / "run", "--pictures",
            folder / "pictures", *by_command)
    recorded = fingerprints(folder / "run")
    played = rr.Session(rr.open_map(room), **settings.pop("session", {}))
    played.add("object", "teapot")
    played.drop("object")
    own = []
    for frame in rr.open_source(source, **settings):
        played.step(frame)
        own.append(played.fingerprint())
    test.assertEqual(own, recorded)
    test.assertNotEqual(own[-1][1], 0)
    return played


def box_mesh(size_m=0.2, origin=(0.0, 0.0, 0.0)):
    """A closed box around its origin."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32) * size_m / 2
    triangles = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                          [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], np.uint32)
    return rr.Mesh(corners, triangles, origin=origin)


def floor_mesh(size_m=4.0, height_m=0.0):
    half = size_m / 2
    vertices = np.array([[-half, -half, height_m], [half, -half, height_m], [half, half, height_m],
                         [-half, half, height_m]], np.float32)
    return rr.Mesh(vertices, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))


def pose(x=0.0, y=0.0, z=0.0):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def random_poses(count, seed, low, high):
    """Poses (N, 4, 4) with random rotations, positions within a box."""
    random = np.random.default_rng(seed)
    q = random.normal(size=(count, 4))
    x, y, z, w = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    T = np.zeros((count, 4, 4))
    T[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], axis=1)
    T[:, 1, :3] = np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], axis=1)
    T[:, 2, :3] = np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], axis=1)
    T[:, :3, 3] = random.uniform(low, high, (count, 3))
    T[:, 3, 3] = 1.0
    return T


def camera(width_px=160, height_px=120):
    return rr.Intrinsics(width_px, height_px, 146.0, 146.0, (width_px - 1) / 2, (height_px - 1) / 2)


def address(array):
    return array.__array_interface__["data"][0]
