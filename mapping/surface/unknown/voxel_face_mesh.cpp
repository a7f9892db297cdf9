// voxel_face_mesh.cpp: merges faces into rectangles, one plane at a time.
#include "mapping/surface/unknown/voxel_face_mesh.hpp"

#include <algorithm>
#include <vector>

namespace roomradar {
namespace {

using Eigen::Vector3i;

// Coordinates of a cell have this many bits in a code.
constexpr unsigned kBits = 21;

std::uint64_t code_of(int high, int middle, int low) {
  return static_cast<std::uint64_t>(high) << 2 * kBits | static_cast<std::uint64_t>(middle) << kBits |
         static_cast<std::uint64_t>(low);
}

// A face in its plane: u and v are the next two axes after the face's own.
struct Face {
  int plane, v, u;
};

Face face_of(std::uint64_t code) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  return {static_cast<int>(code >> 2 * kBits), static_cast<int>(code >> kBits & kMask),
          static_cast<int>(code & kMask)};
}

// The faces of a plane that are not in a rectangle so far.
class OpenFaces {
 public:
  OpenFaces(int width, int height)
      : width_(width),
        height_(height),
        open_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  void open(int u, int v) { open_[index(u, v)] = 1; }
  [[nodiscard]] bool is_open(int u, int v) const { return open_[index(u, v)] != 0; }
  /// Returns the end of the run of open faces that starts at from_u.
  [[nodiscard]] int row_end(int from_u, int v) const {
    int u = from_u;
    while (u < width_ && is_open(u, v)) ++u;
    return u;
  }
  /// Returns the end of the run of rows, from from_v on, in which all faces in [from_u, to_u) are open.
  [[nodiscard]] int column_end(int from_u, int to_u, int from_v) const {
    int v = from_v;
    while (v < height_ && row_end(from_u, v) >= to_u) ++v;
    return v;
  }
  void close(int from_u, int to_u, int from_v, int to_v) {
    for (int v = from_v; v < to_v; ++v)
      for (int u = from_u; u < to_u; ++u) open_[index(u, v)] = 0;
  }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }
  int width_, height_;
  std::vector<std::uint8_t> open_;
};

}  // namespace

VoxelFaceMesher::VoxelFaceMesher(const CellGrid& grid) : grid_(grid) {
  mesh_.origin = (grid.first_cell + grid.size / 2).cast<double>() * grid.cell_m;
}

void VoxelFaces::add(const Vector3i& cell) {
  codes_.push_back(code_of(cell[axis_], cell[(axis_ + 2) % 3], cell[(axis_ + 1) % 3]));
}

void VoxelFaceMesher::add(VoxelFaces faces) {
  std::vector<std::uint64_t>& sorted = faces.codes_;
  std::sort(sorted.begin(), sorted.end());
  OpenFaces plane(grid_.size[(faces.axis_ + 1) % 3], grid_.size[(faces.axis_ + 2) % 3]);
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const int at = face_of(*begin).plane;
    auto end = begin;
    for (; end != sorted.end() && face_of(*end).plane == at; ++end)
      plane.open(face_of(*end).u, face_of(*end).v);
    for (; begin != end; ++begin) {
      const Face face = face_of(*begin);
      if (!plane.is_open(face.u, face.v)) continue;
      const int to_u = plane.row_end(face.u, face.v);
      const int to_v = plane.column_end(face.u, to_u, face.v);
      plane.close(face.u, to_u, face.v, to_v);
      add_rectangle(faces, at, face.u, to_u, face.v, to_v);
    }
  }
}

void VoxelFaceMesher::add_rectangle(const VoxelFaces& faces, int plane, int from_u, int to_u, int from_v,
                                    int to_v) {
  const auto corner = [&](int u, int v) {
    Vector3i cell;
    cell[faces.axis_] = faces.step_ > 0 ? plane + 1 : plane;
    cell[(faces.axis_ + 1) % 3] = u;
    cell[(faces.axis_ + 2) % 3] = v;
    return vertex(cell);
  };
  const std::uint32_t a = corner(from_u, from_v), c = corner(to_u, to_v);
  std::uint32_t b = corner(to_u, from_v), d = corner(from_u, to_v);
  if (faces.step_ < 0) std::swap(b, d);
  mesh_.triangles.push_back({a, b, c});
  mesh_.triangles.push_back({a, c, d});
}

std::uint32_t VoxelFaceMesher::vertex(const Vector3i& cell) {
  const auto number = static_cast<std::uint32_t>(mesh_.vertices.size());
  const auto [found, is_new] = vertex_at_.try_emplace(code_of(cell.z(), cell.y(), cell.x()), number);
  if (is_new) mesh_.vertices.push_back(((cell - grid_.size / 2).cast<double>() * grid_.cell_m).cast<float>());
  return found->second;
}

}  // namespace roomradar
