// arrays.cpp: checks of types, shapes, strides and values.
#include "app/python/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::python {
namespace {

constexpr double kRigid = 1e-6;  // tolerance of a rotation's entries

std::string type_name(py::handle value) {
  return py::cast<std::string>(py::type::of(value).attr("__name__"));
}

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

template <typename Element>
std::string wanted(const ArrayShape& shape) {
  return py::cast<std::string>(py::str(py::dtype::of<Element>())) + " of shape " + shape.text;
}

/// Returns the argument as an array of the element type and shape, with any strides.
template <typename Element>
py::array typed_array(py::handle value, const char* name, const ArrayShape& shape) {
  if (!py::isinstance<py::array>(value))
    throw py::type_error(std::string(name) + ": must be a NumPy array, " + wanted<Element>(shape) + ", not " +
                         type_name(value));
  if (!py::array_t<Element, 0>::check_(value))
    throw py::type_error(std::string(name) + ": holds " +
                         py::cast<std::string>(py::str(value.attr("dtype"))) + "; must be " +
                         wanted<Element>(shape) + "; convert it with astype()");
  auto array = py::reinterpret_borrow<py::array>(value);
  const auto& lengths = shape.lengths;
  bool fits = array.ndim() == static_cast<py::ssize_t>(lengths.size());
  for (std::size_t axis = 0; fits && axis < lengths.size(); ++axis)
    fits = lengths[axis] < 0 || lengths[axis] == array.shape(static_cast<py::ssize_t>(axis));
  if (!fits)
    throw py::value_error(std::string(name) + ": has the shape " + shape_text(array) + "; must be " +
                          shape.text);
  return array;
}

template <typename Element>
Element element(const py::array& array, py::ssize_t byte_offset) {
  Element value;
  std::memcpy(&value, static_cast<const char*>(array.data()) + byte_offset, sizeof value);
  return value;
}

template <int kRows, int kColumns>
Eigen::Matrix<double, kRows, kColumns> matrix_of(const py::array& array) {
  Eigen::Matrix<double, kRows, kColumns> matrix;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      matrix(row, column) = element<double>(array, row * array.strides(0) + column * array.strides(1));
  return matrix;
}

Eigen::Isometry3d rigid(const Eigen::Matrix4d& matrix, const char* name) {
  Eigen::Isometry3d T;
  T.matrix() = matrix;
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) || !is_rigid(T, kRigid))
    throw py::value_error(std::string(name) +
                          ": must be a finite rigid transform: a rotation, a translation in metres, and the "
                          "last row 0 0 0 1");
  return T;
}

template <typename Pixel>
Image<Pixel> image_of(const py::array& array) {
  if (array.shape(0) > 16384 || array.shape(1) > 16384)
    throw py::value_error("an image has " + shape_text(array) + "; at most 16384 pixels per side");
  Image<Pixel> image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  if (!image.empty()) std::memcpy(image.pixels.data(), array.data(), image.pixels.size() * sizeof(Pixel));
  return image;
}

/// Returns a read-only array of contiguous elements.
template <typename Element>
py::array view(std::vector<py::ssize_t> shape, const void* data, py::handle owner) {
  py::array array(py::dtype::of<Element>(), std::move(shape), static_cast<const Element*>(data), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <typename Element, typename Item>
py::array view_of_items(const std::vector<Item>& items, py::handle owner) {
  static_assert(sizeof(Item) == 3 * sizeof(Element));
  return view<Element>({static_cast<py::ssize_t>(items.size()), 3}, items.data(), owner);
}

}  // namespace

template <typename Element>
py::array required_array(py::handle value, const char* name, const ArrayShape& shape) {
  py::array array = typed_array<Element>(value, name, shape);
  constexpr int kPlain =
      static_cast<int>(py::array::c_style) | static_cast<int>(py::detail::npy_api::NPY_ARRAY_ALIGNED_);
  if ((array.flags() & kPlain) != kPlain)
    throw py::value_error(std::string(name) +
                          ": is not contiguous and aligned in memory; pass a copy made by its method copy()");
  return array;
}

template <typename Element>
py::array required_output(py::handle value, const char* name, const ArrayShape& shape) {
  py::array array = required_array<Element>(value, name, shape);
  if (!array.writeable())
    throw py::value_error(std::string(name) + ": is read-only; pass an array that can be written to");
  return array;
}

template py::array required_array<double>(py::handle, const char*, const ArrayShape&);
template py::array required_array<float>(py::handle, const char*, const ArrayShape&);
template py::array required_array<std::uint32_t>(py::handle, const char*, const ArrayShape&);
template py::array required_array<std::uint8_t>(py::handle, const char*, const ArrayShape&);
template py::array required_output<std::uint8_t>(py::handle, const char*, const ArrayShape&);

Eigen::Isometry3d pose_of(py::handle value, const char* name) {
  static const ArrayShape kShape{{4, 4}, "(4, 4)"};
  return rigid(matrix_of<4, 4>(typed_array<double>(value, name, kShape)), name);
}

std::optional<Eigen::Isometry3d> optional_pose_of(py::handle value, const char* name) {
  return value.is_none() ? std::nullopt : std::optional(pose_of(value, name));
}

Eigen::Vector3d vector_of(py::handle value, const char* name) {
  static const ArrayShape kShape{{3}, "(3,)"};
  Eigen::Vector3d vector;
  if (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) {
    const auto numbers = py::reinterpret_borrow<py::sequence>(value);
    if (numbers.size() != 3)
      throw py::value_error(std::string(name) + ": has " + std::to_string(numbers.size()) +
                            " numbers; must have 3");
    for (int axis = 0; axis < 3; ++axis) {
      vector[axis] = PyFloat_AsDouble(py::object(numbers[static_cast<std::size_t>(axis)]).ptr());
      if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw py::type_error(std::string(name) + ": must hold three numbers");
      }
    }
  } else {
    const py::array array = typed_array<double>(value, name, kShape);
    for (int axis = 0; axis < 3; ++axis) vector[axis] = element<double>(array, axis * array.strides(0));
  }
  if (!vector.allFinite()) throw py::value_error(std::string(name) + ": must hold three finite numbers");
  return vector;
}

std::optional<Eigen::Vector3d> optional_vector_of(py::handle value, const char* name) {
  return value.is_none() ? std::nullopt : std::optional(vector_of(value, name));
}

std::optional<Eigen::Matrix3d> optional_rotation_of(py::handle value, const char* name) {
  static const ArrayShape kShape{{3, 3}, "(3, 3)"};
  if (value.is_none()) return std::nullopt;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = matrix_of<3, 3>(typed_array<double>(value, name, kShape));
  return rigid(matrix, name).linear();
}

double finite(double value, const char* name) {
  if (!std::isfinite(value)) throw py::value_error(std::string(name) + ": must be a finite number");
  return value;
}

DepthImage depth_of(py::handle value, const char* name) {
  DepthImage depth_m = image_of<float>(required_array<float>(value, name, {{-1, -1}, "(H, W)"}));
  const bool is_valid = std::all_of(depth_m.pixels.begin(), depth_m.pixels.end(),
                                    [](float depth) { return std::isfinite(depth) && depth >= 0.0F; });
  if (!is_valid)
    throw py::value_error(std::string(name) +
                          ": holds a depth that is negative or not finite; use 0 where nothing was measured");
  return depth_m;
}

ColourImage colour_of(py::handle value, const char* name) {
  static_assert(sizeof(Rgb) == 3);
  return image_of<Rgb>(required_array<std::uint8_t>(value, name, {{-1, -1, 3}, "(H, W, 3)"}));
}

MaskImage mask_of(py::handle value, const char* name) {
  return image_of<std::uint8_t>(required_array<std::uint8_t>(value, name, {{-1, -1}, "(H, W)"}));
}

py::array view_of(const DepthImage& depth_m, py::handle owner) {
  return view<float>({depth_m.height, depth_m.width}, depth_m.pixels.data(), owner);
}

py::array view_of(const ColourImage& colour, py::handle owner) {
  return view<std::uint8_t>({colour.height, colour.width, 3}, colour.pixels.data(), owner);
}

py::array view_of(const MaskImage& mask, py::handle owner) {
  return view<std::uint8_t>({mask.height, mask.width}, mask.pixels.data(), owner);
}

py::array view_of(const Image<std::uint16_t>& image, py::handle owner) {
  return view<std::uint16_t>({image.height, image.width}, image.pixels.data(), owner);
}

py::array view_of(const std::vector<Eigen::Vector3f>& vectors, py::handle owner) {
  return view_of_items<float>(vectors, owner);
}

py::array view_of(const std::vector<Rgb>& colours, py::handle owner) {
  return view_of_items<std::uint8_t>(colours, owner);
}

py::array view_of(const std::vector<Triangle>& triangles, py::handle owner) {
  return view_of_items<std::uint32_t>(triangles, owner);
}

py::array_t<double> array_of(const Eigen::Isometry3d& T) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = T.matrix();
  return array;
}

py::array_t<double> array_of(const Eigen::Vector3d& vector) {
  py::array_t<double> array(3);
  Eigen::Map<Eigen::Vector3d>(array.mutable_data()) = vector;
  return array;
}

py::array_t<double> array_of(const Eigen::Matrix3d& matrix) {
  py::array_t<double> array({3, 3});
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.mutable_data()) = matrix;
  return array;
}

py::array_t<double> array_of(const Eigen::AlignedBox3d& box) {
  py::array_t<double> array({2, 3});
  Eigen::Map<Eigen::Vector3d>(array.mutable_data(0, 0)) = box.min();
  Eigen::Map<Eigen::Vector3d>(array.mutable_data(1, 0)) = box.max();
  return array;
}

const std::string& required_text(const std::string& text, const char* name) {
  if (text.find('\0') != std::string::npos) throw py::value_error(std::string(name) + ": holds a zero byte");
  return text;
}

std::string text_of_point(const Eigen::Vector3d& point_m) {
  return "(" + format_readable(point_m.x(), 3) + ", " + format_readable(point_m.y(), 3) + ", " +
         format_readable(point_m.z(), 3) + ") m";
}

py::str text_of(const std::string& text) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace roomradar::python
