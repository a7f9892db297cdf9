// conversions.cpp: checks the values that a program passes.
#include "app/c_api/conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::c_api {
namespace {

constexpr double kPoseTolerance = 1e-6;
constexpr std::size_t kMostVertices = 200'000'000;  // 2.4 GB

Eigen::Matrix3d rows(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d matrix;
  matrix << x.transpose(), y.transpose(), z.transpose();
  return matrix;
}

std::array<EngineAxes, 5> axes_of_engines() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d y_up = rows(x, z, -y), looks_back = rows(x, -y, -z);
  return {{
      {Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(), 1.0, false},
      {y_up, looks_back, 1.0, false},
      {y_up, looks_back, 1.0, true},
      {rows(x, z, y), rows(x, -y, z), 1.0, true},
      {rows(y, x, z), rows(z, x, -y), 100.0, false},
  }};
}

bool is_all_zero(const roomradar_pose& pose) {
  return std::all_of(std::begin(pose.m), std::end(pose.m), [](double value) { return value == 0.0; });
}

DepthNoise noise_of(const roomradar_depth_noise& given) {
  const DepthNoise noise{given.base_m, given.linear, given.quadratic_per_m, given.from_m, given.grazing};
  if (noise == DepthNoise{0.0F, 0.0F, 0.0F, 0.0F, 0.0F}) return {};
  if (!is_valid(noise))
    refuse(
        "frame.noise: must have base_m > 0 and no value that is negative, above 1 (from_m: 10) or not "
        "finite");
  return noise;
}

double readout_of(double readout_s, const char* name) {
  if (!(readout_s >= 0.0 && readout_s <= 1.0))
    refuse(std::string(name) + " = " + format_readable(readout_s, 6) + ": must be in 0..1 s");
  return readout_s;
}

/// Copies depth; pixels without a valid measurement become 0.
void copy_depth(const float* from, std::vector<float>& to) {
  constexpr float kMost = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] > 0.0F && from[i] <= kMost ? from[i] : 0.0F;
}

/// Sizes an image without setting pixels that keep their place.
template <typename Pixel>
void resize_only(Image<Pixel>& image, const Intrinsics& camera) {
  image.width = camera.width_px;
  image.height = camera.height_px;
  image.pixels.resize(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
}

}  // namespace

void refuse(const std::string& sentence) { throw Refusal(ROOMRADAR_INVALID_ARGUMENT, sentence); }

void require_given(const void* pointer, const char* name) {
  if (pointer == nullptr) refuse(std::string(name) + " is null");
}

void require_struct_size(std::size_t given, std::size_t wanted, const char* name) {
  if (given == wanted) return;
  throw Refusal(
      ROOMRADAR_WRONG_STRUCT_SIZE,
      std::string(name) + "->struct_size = " + std::to_string(given) + ": must be " + std::to_string(wanted) +
          ", the sizeof of the struct; if it is set, the program's roomradar.h is of another version");
}

std::string text_of(const char* text, const char* name, std::size_t most) {
  require_given(text, name);
  const std::size_t bytes = strnlen(text, most + 1);
  if (bytes == 0) refuse(std::string(name) + " is empty");
  if (bytes > most) refuse(std::string(name) + " has more than " + std::to_string(most) + " bytes");
  return {text, bytes};
}

std::string name_of(const char* name) { return text_of(name, "name", 255); }

double number_of(double value, const char* name) {
  if (!std::isfinite(value)) refuse(std::string(name) + " is not finite");
  return value;
}

Eigen::Vector3d vector_of(const double* xyz, const char* name) {
  require_given(xyz, name);
  const Eigen::Vector3d vector(xyz[0], xyz[1], xyz[2]);
  if (!vector.allFinite()) refuse(std::string(name) + " is not finite");
  return vector;
}

Eigen::Isometry3d unchecked_pose_of(const roomradar_pose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) T.matrix()(row, column) = pose.m[4 * row + column];
  return T;
}

bool is_pose(const roomradar_pose& pose) {
  return pose.m[12] == 0.0 && pose.m[13] == 0.0 && pose.m[14] == 0.0 && pose.m[15] == 1.0 &&
         is_rigid(unchecked_pose_of(pose), kPoseTolerance);
}

Eigen::Isometry3d pose_of(const roomradar_pose* pose, const char* name) {
  require_given(pose, name);
  if (!is_pose(*pose))
    refuse(std::string(name) +
           " is not a rigid motion: its rotation must be proper within 1e-6, its last row 0 0 0 1, and all "
           "entries finite");
  return unchecked_pose_of(*pose);
}

roomradar_pose pose_of(const Eigen::Isometry3d& T) {
  roomradar_pose pose{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) pose.m[4 * row + column] = T.matrix()(row, column);
  pose.m[15] = 1.0;
  return pose;
}

void write_vector(const Eigen::Vector3d& from, double* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

Intrinsics camera_of(const roomradar_camera* camera, const char* name) {
  require_given(camera, name);
  const Intrinsics of{camera->width_px, camera->height_px, camera->fx_px,
                      camera->fy_px,    camera->cx_px,     camera->cy_px};
  if (!is_valid(of))
    refuse(std::string(name) +
           ": sizes must be in 1..16384, focal lengths finite and > 0, and the principal point finite and "
           "within one image size of the image");
  return of;
}

roomradar_camera camera_of(const Intrinsics& camera) {
  return {camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
}

void read_frame(const roomradar_frame* from, Frame& to) {
  require_struct(from, "frame");
  require_given(from->depth_m, "frame.depth_m");
  const Intrinsics depth_camera = camera_of(&from->depth_camera, "frame.depth_camera");
  const bool has_colour = from->colour_rgb != nullptr;
  const Intrinsics colour_camera =
      has_colour ? camera_of(&from->colour_camera, "frame.colour_camera") : Intrinsics{};
  Frame head;  // checked whole before `to` changes
  head.index = from->index;
  head.stamp_s = number_of(from->stamp_s, "frame.stamp_s");
  head.depth_camera = depth_camera;
  head.depth_noise = noise_of(from->noise);
  head.colour_camera = colour_camera;
  head.colour_after_depth_s = number_of(from->colour_after_depth_s, "frame.colour_after_depth_s");
  if (!is_all_zero(from->T_colour_depth))
    head.T_colour_depth = pose_of(&from->T_colour_depth, "frame.T_colour_depth");
  head.timing = {readout_of(from->depth_readout_s, "frame.depth_readout_s"),
                 readout_of(from->colour_readout_s, "frame.colour_readout_s"),
                 number_of(from->colour_delay_s, "frame.colour_delay_s")};
  if (from->has_pose != 0) head.T_world_camera = pose_of(&from->T_world_camera, "frame.T_world_camera");
  if (from->has_gravity != 0) {
    const Eigen::Vector3d down = vector_of(from->down_camera, "frame.down_camera");
    if (!(down.norm() > 1e-9)) refuse("frame.down_camera: must not be 0");
    // A unit vector stays as it is, to the bit.
    head.down_camera = std::abs(down.norm() - 1.0) < 1e-9 ? down : down.normalized();
  }
  copy_all_but_images(head, to);
  resize_only(to.depth_m, depth_camera);
  copy_depth(from->depth_m, to.depth_m.pixels);
  if (has_colour) {
    resize_only(to.colour, colour_camera);
    std::memcpy(to.colour.pixels.data(), from->colour_rgb, to.colour.pixels.size() * sizeof(Rgb));
  } else {
    to.colour.resize(0, 0);
  }
}

void write_frame(const Frame& from, roomradar_frame& to) {
  to.index = from.index;
  to.stamp_s = from.stamp_s;
  to.depth_camera = camera_of(from.depth_camera);
  to.depth_m = from.depth_m.pixels.data();
  to.colour_camera = camera_of(from.colour_camera);
  to.colour_rgb = from.colour.empty() ? nullptr : &from.colour.pixels.front().r;
  to.colour_after_depth_s = from.colour_after_depth_s;
  to.T_colour_depth = pose_of(from.T_colour_depth);
  to.has_pose = from.T_world_camera ? 1 : 0;
  to.T_world_camera = pose_of(from.T_world_camera.value_or(Eigen::Isometry3d::Identity()));
  to.has_gravity = from.down_camera ? 1 : 0;
  write_vector(from.down_camera.value_or(Eigen::Vector3d::Zero()), to.down_camera);
  to.noise = {from.depth_noise.base_m, from.depth_noise.linear, from.depth_noise.quadratic_per_m,
              from.depth_noise.from_m, from.depth_noise.grazing};
  to.depth_readout_s = from.timing.depth_readout_s;
  to.colour_readout_s = from.timing.colour_readout_s;
  to.colour_delay_s = from.timing.colour_delay_s;
}

Mesh mesh_of(const roomradar_mesh* mesh) {
  require_struct(mesh, "mesh");
  require_given(mesh->vertices_m, "mesh.vertices_m");
  require_given(mesh->triangles, "mesh.triangles");
  const auto require_count = [](std::size_t count, const char* name) {
    if (count == 0 || count > kMostVertices)
      refuse(std::string(name) + " = " + std::to_string(count) + ": must be in 1..200000000");
  };
  require_count(mesh->vertex_count, "mesh.vertex_count");
  require_count(mesh->triangle_count, "mesh.triangle_count");
  Mesh made;
  made.origin = vector_of(mesh->origin_m, "mesh.origin_m");
  made.vertices.resize(mesh->vertex_count);
  for (std::size_t i = 0; i < mesh->vertex_count; ++i) {
    const float* xyz = mesh->vertices_m + 3 * i;
    made.vertices[i] = {xyz[0], xyz[1], xyz[2]};
    if (!made.vertices[i].allFinite()) refuse("mesh.vertices_m[" + std::to_string(i) + "] is not finite");
  }
  made.triangles.resize(mesh->triangle_count);
  for (std::size_t i = 0; i < mesh->triangle_count; ++i) {
    const std::uint32_t* abc = mesh->triangles + 3 * i;
    made.triangles[i] = {abc[0], abc[1], abc[2]};
    if (std::max({abc[0], abc[1], abc[2]}) >= mesh->vertex_count)
      refuse("mesh.triangles[" + std::to_string(i) + "] has a vertex that does not exist");
  }
  if (mesh->colours_rgb != nullptr) {
    made.colours.resize(mesh->vertex_count);
    std::memcpy(made.colours.data(), mesh->colours_rgb, mesh->vertex_count * sizeof(Rgb));
  }
  return made;
}

void write_mesh(const Mesh& from, std::uint64_t version, roomradar_mesh_buffers* to) {
  require_struct(to, "mesh");
  const EngineAxes& axes = engine_axes(to->axes);
  to->vertex_count = from.vertices.size();
  to->triangle_count = from.triangles.size();
  to->version = version;
  if (to->vertex_capacity < to->vertex_count || to->triangle_capacity < to->triangle_count)
    throw Refusal(ROOMRADAR_BUFFER_TOO_SMALL, "the mesh has " + std::to_string(to->vertex_count) +
                                                  " vertices and " + std::to_string(to->triangle_count) +
                                                  " triangles, which is more than its buffers hold");
  if (to->vertex_count > 0) require_given(to->vertices, "mesh.vertices");
  if (to->triangle_count > 0) require_given(to->triangles, "mesh.triangles");
  write_vector(axes.units_per_m * (axes.C_engine_world * from.origin), to->origin);
  const Eigen::Matrix3f C = axes.C_engine_world.cast<float>();
  const auto units_per_m = static_cast<float>(axes.units_per_m);
  for (std::size_t i = 0; i < from.vertices.size(); ++i) {
    const Eigen::Vector3f vertex = units_per_m * (C * from.vertices[i]);
    std::copy_n(vertex.data(), 3, to->vertices + 3 * i);
    if (to->normals != nullptr) {
      const Eigen::Vector3f normal =
          from.normals.empty() ? Eigen::Vector3f(0.0F, 0.0F, 0.0F) : Eigen::Vector3f(C * from.normals[i]);
      std::copy_n(normal.data(), 3, to->normals + 3 * i);
    }
    if (to->colours_rgb != nullptr) {
      const Rgb colour = from.colours.empty() ? Rgb{128, 128, 128} : from.colours[i];
      std::memcpy(to->colours_rgb + 3 * i, &colour, sizeof colour);
    }
  }
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    Triangle triangle = from.triangles[i];
    if (axes.has_clockwise_fronts) std::swap(triangle[1], triangle[2]);
    std::copy(triangle.begin(), triangle.end(), to->triangles + 3 * i);
  }
}

void require_capacity(const void* buffer, std::size_t capacity, std::size_t count, std::size_t* needed) {
  require_given(needed, "needed");
  *needed = count;
  if (capacity < count)
    throw Refusal(ROOMRADAR_BUFFER_TOO_SMALL, "capacity = " + std::to_string(capacity) + ": must be " +
                                                  std::to_string(count) + " or more");
  if (count > 0) require_given(buffer, "the buffer");
}

void write_text(const std::string& from, char* to, std::size_t capacity, std::size_t* needed) {
  write_array(std::span<const char>(from.c_str(), from.size() + 1), to, capacity, needed);
}

const EngineAxes& engine_axes(std::int32_t axes) {
  static const std::array<EngineAxes, 5> engines = axes_of_engines();
  if (axes < 0 || axes >= static_cast<std::int32_t>(engines.size()))
    refuse("axes = " + std::to_string(axes) + ": must be a roomradar_axes, 0..4");
  return engines[static_cast<std::size_t>(axes)];
}

}  // namespace roomradar::c_api
