// least_gap.hpp: minimum of each scene tile, found on the GPU or the CPU.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Result of one query. Distances of at least kNothingMet mean that nothing was found.
struct TileResult {
  std::uint32_t stamp = 0;  ///< number of the call that wrote it
  float lower_m = 0.0F, upper_m = 0.0F, contact_distance_m = 0.0F;
  std::int32_t x_px = -1, y_px = -1;  ///< nearest pixel in its tile; -1 if nothing was found
  std::uint32_t key = 0;              ///< key of the triangle touched there
  std::uint32_t unused = 0;
};
inline constexpr float kNothingMet = 1e38F;
/// Clear value of tiles, as in tile_shaders.hpp.
inline constexpr float kClearValue = 3e38F;

/// Owns the program and the buffers, which grow to the largest call. Not thread safe.
class LeastGap {
 public:
  /// @param on_renderer  true: the renderer takes the minimum. false: the tiles are read back, at no cost
  ///                     if the renderer is this CPU. Both give the same results.
  LeastGap(GlContext& context, bool on_renderer);
  ~LeastGap();
  LeastGap(const LeastGap&) = delete;
  LeastGap& operator=(const LeastGap&) = delete;

  /// Makes room for the results of up to this many queries; earlier results become invalid.
  void begin(std::size_t queries);
  /// Computes the minima of a batch's scene tiles. `queries[i].query` is the index of the result.
  void reduce(std::span<const TileQuery> queries, const TileAtlas& scene_tiles);
  /// Finds the triangles touched, by repeating the draws of the scene tiles without rasterisation.
  void find_keys(const TileDraws& draws, const TileAtlas& object_tiles) const;
  /// Returns the first `count` results since begin(); empty if the renderer failed to return them.
  std::span<const TileResult> read(std::size_t count);
  /// Makes the next call reallocate the buffers, after the renderer failed.
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
