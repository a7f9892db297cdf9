// least_gap.hpp: computes the minimum gap over each query's pixels, on the GPU or the CPU.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Result of one query. A distance of at least kNothingMet means that nothing was found.
struct TileResult {
  /// Number of the begin() after which this result was written. Distinguishes it from results of earlier
  /// calls.
  std::uint32_t stamp = 0;
  float lower_m = 0.0F, upper_m = 0.0F, contact_distance_m = 0.0F;
  /// Nearest pixel, relative to the tile's corner; -1 if nothing was found.
  std::int32_t x_px = -1, y_px = -1;
  /// Key of the triangle touched in the nearest pixel, see SceneRun.
  std::uint32_t key = 0;
  /// Padding.
  std::uint32_t unused = 0;
};
inline constexpr float kNothingMet = 1e38F;
/// Value of pixels without a surface (kNothing in tile_shaders.hpp).
inline constexpr float kClearValue = 3e38F;

/// Computes the minimum over each query's tile (a region of the scene texture), for many queries at once.
/// Owns its shader programs and buffers. The buffers grow to the largest call. Not thread safe.
class LeastGap {
 public:
  /// @param on_renderer  true: a compute shader computes the minimum. false: the tiles are read back, and the
  ///                     CPU computes it. Reading back costs nothing if the renderer runs on this CPU. The
  ///                     results are the same.
  LeastGap(GlContext& context, bool on_renderer);
  ~LeastGap();
  LeastGap(const LeastGap&) = delete;
  LeastGap& operator=(const LeastGap&) = delete;

  /// Starts a call: makes room for the results of up to this many queries. Earlier results become invalid.
  void begin(std::size_t queries);
  /// Computes the minima over the scene tiles of a batch. The result of `queries[i]` has the index
  /// `queries[i].query`.
  void reduce(std::span<const TileQuery> queries, const TileAtlas& scene_tiles);
  /// Finds the touched triangle of every query. Runs the vertex and geometry stages of the scene's draws
  /// again, without rasterisation.
  void find_keys(const TileDraws& draws, const TileAtlas& object_tiles) const;
  /// Returns the first `count` results since begin(); empty if the renderer failed to return them.
  std::span<const TileResult> read(std::size_t count);
  /// Makes the next call reallocate the buffers. Call it after the renderer failed.
  void forget() { queries_capacity_ = results_capacity_ = 0; }

 private:
  bool on_renderer_;
  unsigned least_program_ = 0;
  unsigned which_program_ = 0;
  unsigned queries_buffer_ = 0, results_buffer_ = 0, host_buffer_ = 0;
  std::size_t queries_capacity_ = 0, results_capacity_ = 0;
  std::uint32_t stamp_ = 0;
  const TileResult* host_results_ = nullptr;
  std::vector<float> pixels_;

  [[nodiscard]] TileResult least_of(const TileQuery& query, const float* pixels,
                                    std::size_t row_pixels) const;
};

}  // namespace roomradar
