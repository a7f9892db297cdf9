// least_gap.hpp: the least of each scene tile, found by the renderer or here, and a few bytes a query back.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// What comes back of a query. Numbers of at least kNothingMet: there was nothing.
struct TileResult {
  std::uint32_t stamp = 0;  ///< of the call that wrote it
  float lower_m = 0.0F, upper_m = 0.0F, travel_m = 0.0F;
  std::int32_t x_px = -1, y_px = -1;  ///< where in its tile; -1 where travel_m says that there was nothing
  std::uint32_t key = 0;              ///< of the triangle that is met there
  std::uint32_t unused = 0;
};
inline constexpr float kNothingMet = 1e38F;
/// What tiles are cleared to; as in tile_shaders.hpp.
inline constexpr float kNothing = 3e38F;

/// Owns the program and the buffers; they grow to the largest call. Not thread safe.
class LeastGap {
 public:
  /// @param on_renderer  whether the minimum is taken there; else the tiles are read back, which is free
  /// where
  ///                     the renderer is this processor. Both give the same results.
  LeastGap(GlContext& context, bool on_renderer);
  ~LeastGap();
  LeastGap(const LeastGap&) = delete;
  LeastGap& operator=(const LeastGap&) = delete;

  /// Room for the results of up to this many queries, none of them known yet.
  void begin(std::size_t queries);
  /// Reduces the scene's tiles of a batch. `queries[i].query` says which result each is.
  void reduce(std::span<const TileQuery> queries, const TileAtlas& scene_tiles);
  /// Finds the triangles that are met: the same draws as for the scene's tiles again, without a pixel.
  void find_keys(const TileDraws& draws, const TileAtlas& object_tiles) const;
  /// The first `count` results since begin(); empty where the renderer did not hand them out.
  std::span<const TileResult> read(std::size_t count);
  /// Trusts nothing that was handed to the renderer before.
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
