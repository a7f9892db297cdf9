// arrays.hpp: checks and converts NumPy arrays and strings, and returns images and meshes as arrays without
// copying.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // here for all sources: conversions must be the same everywhere
#include <pybind11/stl/filesystem.h>

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar::python {

namespace py = pybind11;

/// Required shape of an array. A negative length allows any length.
struct ArrayShape {
  std::vector<py::ssize_t> lengths;
  const char* text;  ///< for messages, such as "(H, W)"
};

/// Returns the argument, without copying, if it is a C-contiguous array with the element type and shape.
/// Otherwise throws TypeError or ValueError with a message that names the argument and says how to convert
/// it.
template <typename Element>
py::array required_array(py::handle value, const char* name, const ArrayShape& shape);
/// Does the same, and also throws ValueError if the array is read-only.
template <typename Element>
py::array required_output(py::handle value, const char* name, const ArrayShape& shape);

/// Returns a float64 array (4, 4) as a pose. Any strides are allowed. Throws ValueError unless it is a finite
/// rigid transform, to 1e-6.
Eigen::Isometry3d pose_of(py::handle value, const char* name);
/// Returns pose_of(), or nullopt for None.
std::optional<Eigen::Isometry3d> optional_pose_of(py::handle value, const char* name);
/// Returns a float64 array (3,), or a tuple or list of three numbers, as a vector. Throws ValueError if a
/// number is not finite.
Eigen::Vector3d vector_of(py::handle value, const char* name);
std::optional<Eigen::Vector3d> optional_vector_of(py::handle value, const char* name);
/// Returns a float64 array (3, 3) as a rotation, or nullopt for None. Throws ValueError as pose_of() does.
std::optional<Eigen::Matrix3d> optional_rotation_of(py::handle value, const char* name);
/// Throws ValueError unless the number is finite.
double finite(double value, const char* name);

/// Returns a depth image, copied from a float32 array (H, W). Throws ValueError if a depth is negative or not
/// finite.
DepthImage depth_of(py::handle value, const char* name);
/// Returns a colour image, copied from a uint8 array (H, W, 3).
ColourImage colour_of(py::handle value, const char* name);
/// Returns a mask, copied from a uint8 array (H, W).
MaskImage mask_of(py::handle value, const char* name);

/// Return read-only arrays that share memory with the image or vector. The array keeps `owner` alive.
py::array view_of(const DepthImage& depth_m, py::handle owner);
py::array view_of(const ColourImage& colour, py::handle owner);
py::array view_of(const MaskImage& mask, py::handle owner);
py::array view_of(const Image<std::uint16_t>& image, py::handle owner);
py::array view_of(const std::vector<Eigen::Vector3f>& vectors, py::handle owner);
py::array view_of(const std::vector<Rgb>& colours, py::handle owner);
py::array view_of(const std::vector<Triangle>& triangles, py::handle owner);

/// Return new arrays: (4, 4), (3,) and (3, 3).
py::array_t<double> array_of(const Eigen::Isometry3d& T);
py::array_t<double> array_of(const Eigen::Vector3d& vector);
py::array_t<double> array_of(const Eigen::Matrix3d& matrix);
/// Returns the lower and upper corner of a box, (2, 3).
py::array_t<double> array_of(const Eigen::AlignedBox3d& box);

/// Returns a C++ string, such as a path, as a Python str. Bytes that are not UTF-8 become surrogates, as in
/// Python's paths.
py::str text_of(const std::string& text);

/// Returns a position as text, "(0.4, -0.1, 0.75) m".
std::string text_of_point(const Eigen::Vector3d& point_m);

/// Returns the text. Throws ValueError if the text contains a zero byte, which would truncate it in messages.
const std::string& required_text(const std::string& text, const char* name);

/// Returns None or a new array.
template <typename Value>
py::object array_or_none(const std::optional<Value>& value) {
  return value ? py::object(array_of(*value)) : py::none();
}

}  // namespace roomradar::python
