// tile_draws.hpp: draws many meshes into many tiles (regions of a texture) with few GL calls.
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

/// Input of the tile shaders for one query. Coordinates are outline coordinates, see RadarOutline.
struct TileQuery {
  /// Corners of the query's tiles: x and y in the object texture, then x and y in the scene texture.
  std::array<std::int32_t, 4> corners_px{};
  /// Size of the outline.
  std::int32_t width_px = 0, height_px = 0;
  /// Index of the query in the call.
  std::int32_t query = 0;
  /// Key of the draw's first triangle (see SceneRun). Triangle k of the draw has the key first_key + k.
  std::uint32_t first_key = 0;
  /// far_m: max z to draw. touching_m: gap that counts as touching. tolerance_m: see
  /// GlRadarConfig::overlap_tolerance_m. length_m: the object's length along the motion.
  float far_m = 0.0F, touching_m = 0.0F, tolerance_m = 0.0F, length_m = 0.0F;
  /// Twice vertex_error_px(), the max rounding error of the object's vertices perpendicular to the motion.
  float margin_px = 0.0F;
  /// Padding.
  std::array<float, 3> unused{};
};

/// Returns a query's shader input, except `query`, first_key and margin_px.
/// @param tolerance_m  see GlRadarConfig::overlap_tolerance_m
/// @param object_corner_px, scene_corner_px  corners of the query's tiles in the two textures
TileQuery tile_query(const RadarOutline& outline, double distance_m, double tolerance_m,
                     std::array<int, 2> object_corner_px, std::array<int, 2> scene_corner_px);

/// A contiguous range of triangles of one mesh, to be drawn into one tile.
struct TileDraw {
  const GpuMesh* mesh = nullptr;
  std::uint32_t first_triangle = 0, triangle_count = 0;
  /// Matrix from the mesh's local points to outline coordinates.
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> outline_from_local;
  TileQuery query;
};

/// Owns the buffers with the draws of one pass. The buffers grow to the largest pass. Not thread safe.
class TileDraws {
 public:
  explicit TileDraws(GlContext& context);
  ~TileDraws();
  TileDraws(const TileDraws&) = delete;
  TileDraws& operator=(const TileDraws&) = delete;

  /// Sorts the draws by mesh and uploads them. Each mesh then takes one GL call.
  void upload(std::span<TileDraw> draws);
  /// Draws the triangles with the current program. Vertex attributes are those of kTileVertexShader.
  void draw() const;
  /// Makes the next call reallocate the buffers. Call it after the renderer failed.
  void forget() { capacity_bytes_ = {}; }
  /// Draws a rectangle (a strip of 4 vertices) for each draw.
  void draw_rectangles() const;

 private:
  /// Layout that glMultiDrawElementsIndirect reads.
  struct Command {
    std::uint32_t index_count = 0, instance_count = 0, first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
  };
  /// Layout that the vertex shader reads.
  struct Item {
    std::array<float, 12> outline_from_local{};
    TileQuery query;
  };
  /// One GL call: all draws of a mesh.
  struct Call {
    const GpuMesh* mesh = nullptr;
    std::size_t first_command = 0, command_count = 0;
  };
  unsigned vertex_array_ = 0;
  // GL buffers: items, commands.
  std::array<unsigned, 2> buffers_{};
  std::array<std::size_t, 2> capacity_bytes_{};
  std::vector<Item> items_;
  std::vector<Command> commands_;
  std::vector<Call> calls_;

  void fill_buffer(std::size_t which, const void* data, std::size_t size_bytes);
};

}  // namespace roomradar
