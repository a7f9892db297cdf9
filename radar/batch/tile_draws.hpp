// tile_draws.hpp: many meshes drawn into many tiles with few calls.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// What the tile shaders are told of a query.
struct TileQuery {
  std::array<std::int32_t, 4>
      corners_px{};  ///< of its tiles: x, y in the objects' atlas, x, y in the scene's
  std::int32_t width_px = 0, height_px = 0;
  std::int32_t query = 0;       ///< its number in the call
  std::uint32_t first_key = 0;  ///< of the draw: its triangles are first_key, first_key + 1, ...
  float far_m = 0.0F, touching_m = 0.0F, tolerance_m = 0.0F, length_m = 0.0F;
  float margin_px = 0.0F;  ///< twice the error of the object's vertices across the direction
  std::array<float, 3> unused{};
};

/// Triangles of one mesh for one tile.
struct TileDraw {
  const GpuMesh* mesh = nullptr;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> outline_from_local;
  TileQuery query;
};

/// Owns the buffers that the draws of a pass stand in; they grow to the largest pass. Not thread safe.
class TileDraws {
 public:
  explicit TileDraws(GlContext& context);
  ~TileDraws();
  TileDraws(const TileDraws&) = delete;
  TileDraws& operator=(const TileDraws&) = delete;

  /// Puts the draws in an order in which those of one mesh are one call, and hands them to the renderer.
  void upload(std::span<TileDraw> draws);
  /// With the program in use; attributes as in tile_shaders.hpp.
  void draw() const;
  /// Trusts nothing that was handed to the renderer before.
  void forget() { capacity_bytes_ = {}; }
  /// A rectangle of 4 vertices (a strip) for each draw.
  void draw_rectangles() const;

 private:
  /// As glMultiDrawElementsIndirect reads it.
  struct Command {
    std::uint32_t index_count = 0, instance_count = 0, first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
  };
  /// As the vertex shader reads it.
  struct Item {
    std::array<float, 12> outline_from_local{};
    TileQuery query;
  };
  struct Call {
    const GpuMesh* mesh = nullptr;
    std::size_t first_command = 0, command_count = 0;
  };
  unsigned vertex_array_ = 0;
  std::array<unsigned, 2> buffers_{};  // items, commands
  std::array<std::size_t, 2> capacity_bytes_{};
  std::vector<Item> items_;
  std::vector<Command> commands_;
  std::vector<Call> calls_;

  void fill_buffer(std::size_t which, const void* data, std::size_t size_bytes);
};

}  // namespace roomradar
