// conversions.hpp: converts C structs and buffers to checked C++ values, and back. All functions throw
// Refusal naming the argument, its value and the rule.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "app/c_api/boundary.hpp"
#include "app/c_api/roomradar_types.h"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar::c_api {

[[noreturn]] void refuse(const std::string& sentence);  ///< throws Refusal with INVALID_ARGUMENT
/// Throws Refusal for a null pointer.
void require_given(const void* pointer, const char* name);
/// Throws Refusal unless the size is that of the struct in this version. Another size means that the caller
/// was compiled with another version of roomradar.h.
void require_struct_size(std::size_t given, std::size_t wanted, const char* name);

/// Checks pointer and struct_size of a struct that begins with struct_size.
template <typename Struct>
void require_struct(const Struct* given, const char* name) {
  require_given(given, name);
  require_struct_size(given->struct_size, sizeof(Struct), name);
}

/// Returns the struct; all fields are zero if `given` is null.
template <typename Struct>
Struct options_of(const Struct* given, const char* name) {
  if (given == nullptr) return {};
  require_struct(given, name);
  return *given;
}

/// Returns the text, whose length must be 1..most bytes. Throws Refusal for null, empty and longer texts.
std::string text_of(const char* text, const char* name, std::size_t most = 4096);
/// Returns an object's name.
std::string name_of(const char* name);

/// Return the argument. Throw Refusal if it is not finite.
double number_of(double value, const char* name);
Eigen::Vector3d vector_of(const double* xyz, const char* name);
/// Returns the pose. Throws Refusal unless its rotation is proper within 1e-6 and its last row is 0 0 0 1.
Eigen::Isometry3d pose_of(const roomradar_pose* pose, const char* name);
roomradar_pose pose_of(const Eigen::Isometry3d& T);
/// Returns the pose without checking it.
Eigen::Isometry3d unchecked_pose_of(const roomradar_pose& pose);
/// Returns true if the pose is rigid within 1e-6.
bool is_pose(const roomradar_pose& pose);
void write_vector(const Eigen::Vector3d& from, double* to);

Intrinsics camera_of(const roomradar_camera* camera, const char* name);
roomradar_camera camera_of(const Intrinsics& camera);

/// Reads a frame into `to`, whose buffers are reused. Depth that is negative or not finite becomes 0.
void read_frame(const roomradar_frame* from, Frame& to);
/// Writes a frame's fields to `to`, with pointers to the images of `from`.
void write_frame(const Frame& from, roomradar_frame& to);

/// Returns the mesh. Throws Refusal if a vertex is not finite or an index is out of range.
Mesh mesh_of(const roomradar_mesh* mesh);
/// Writes a mesh to the caller's buffers, converted to the axes of to->axes.
void write_mesh(const Mesh& from, std::uint64_t version, roomradar_mesh_buffers* to);

/// Sets *needed to `count`. Then throws Refusal with BUFFER_TOO_SMALL if the capacity is less than `count`.
void require_capacity(const void* buffer, std::size_t capacity, std::size_t count, std::size_t* needed);
/// Copies an array to the caller's buffer.
template <typename Element>
void write_array(std::span<const Element> from, void* to, std::size_t capacity, std::size_t* needed,
                 std::size_t units_per_element = 1) {
  require_capacity(to, capacity, from.size() * units_per_element, needed);
  if (!from.empty()) std::memcpy(to, from.data(), from.size_bytes());
}
/// Copies a text and its terminating zero.
void write_text(const std::string& from, char* to, std::size_t capacity, std::size_t* needed);

/// Conversion from world coordinates to an engine's.
struct EngineAxes {
  Eigen::Matrix3d C_engine_world;  ///< exchanges and negates axes; determinant -1 for left-handed axes
  /// Converts the axes of this library's cameras (x right, y down, z forward) to those of the engine's
  /// cameras.
  Eigen::Matrix3d C_engine_camera;
  double units_per_m;
  bool has_clockwise_fronts;
};
/// Returns the conversion for a value of roomradar_axes.
const EngineAxes& engine_axes(std::int32_t axes);

}  // namespace roomradar::c_api
