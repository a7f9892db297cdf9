// tile_draws.hpp: draws many meshes into many tiles with few GL calls.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/batch/radar_volume.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Query data for the tile shaders.
struct TileQuery {
  std::array<std::int32_t, 4> corners_px{};  ///< tile corners: x, y in the object atlas, x, y in the scene's
  std::int32_t width_px = 0, height_px = 0;
  std::int32_t query = 0;       ///< index of the query in the call
  std::uint32_t first_key = 0;  ///< the draw's triangles have keys first_key, first_key + 1, ...
  float far_m = 0.0F, touching_m = 0.0F, tolerance_m = 0.0F, length_m = 0.0F;
  float margin_px = 0.0F;  ///< twice the error of the object's vertices across the direction
  std::array<float, 3> unused{};
};

/// Returns the data of a query without query, first_key and margin_px.
/// @param tolerance_m  see GlRadarConfig::overlap_tolerance_m
TileQuery tile_query(const RadarOutline& outline, double distance_m, double tolerance_m,
                     std::array<int, 2> object_corner_px, std::array<int, 2> scene_corner_px);

/// Triangles of one mesh for one tile.
struct TileDraw {
  const GpuMesh* mesh = nullptr;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> outline_from_local;
  TileQuery query;
};

/// Owns the buffers of a pass's draws, which grow to the largest pass. Not thread safe.
class TileDraws {
 public:
  explicit TileDraws(GlContext& context);
  ~TileDraws();
  TileDraws(const TileDraws&) = delete;
  TileDraws& operator=(const TileDraws&) = delete;

  /// Sorts the draws so each mesh takes one GL call, and uploads them.
  void upload(std::span<TileDraw> draws);
  /// Draws with the current program; attributes as in tile_shaders.hpp.
  void draw() const;
  /// Makes the next call reallocate the buffers, after the renderer failed.
  void forget() { capacity_bytes_ = {}; }
  /// Draws a rectangle of 4 vertices (a strip) for each draw.
  void draw_rectangles() const;

 private:
  /// Layout read by glMultiDrawElementsIndirect.
  struct Command {
    std::uint32_t index_count = 0, instance_count = 0, first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
  };
  /// Layout read by the vertex shader.
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
