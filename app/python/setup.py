# setup.py: builds the wheel's compiled module with CMake, and installs only the module's files into it.
import pathlib
import re

from skbuild import setup

root = pathlib.Path(__file__).resolve().parents[2]
version = re.search(r"project\(roomradar VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text()).group(1)

setup(
    name="roomradar",
    version=version,
    description="Prescan a room with a depth camera, then run augmented reality in it",
    license="BSD-3-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["roomradar"],
    package_data={"roomradar": ["*.pyi", "py.typed"]},
    cmake_source_dir="../..",
    cmake_install_target="install_python",
    cmake_args=[
        "-DCMAKE_UNITY_BUILD=ON",
        "-DROOMRADAR_NATIVE=OFF",
        "-DROOMRADAR_TESTS=OFF",
        "-DROOMRADAR_WITH_PYTHON=ON",
        "-DROOMRADAR_WITH_WINDOW=OFF",
        "-DROOMRADAR_PYTHON_DIR=.",
    ],
)
