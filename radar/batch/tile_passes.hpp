// tile_passes.hpp: the two depth passes of GlRadar. The first draws objects into mask tiles. The second
// compares the scene with the masks and draws the gaps into scene tiles.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "radar/batch/least_gap.hpp"
#include "radar/batch/tile_atlas.hpp"
#include "radar/batch/tile_draws.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Queries that are drawn together, and their draws.
struct TileBatch {
  std::vector<TileQuery> queries;
  /// Draws of the objects whose masks are not cached.
  std::vector<TileDraw> object_draws;
  /// Draws of the scene.
  std::vector<TileDraw> scene_draws;

  void clear();
};

/// Owns the shader programs, textures and buffers of both passes. Not thread safe.
class TilePasses {
 public:
  /// @throws Error if the renderer lacks a required feature
  explicit TilePasses(GlContext& context);
  ~TilePasses();
  TilePasses(const TilePasses&) = delete;
  TilePasses& operator=(const TilePasses&) = delete;

  /// Returns the tiles with the objects' masks (M), indexed as in MaskCache.
  TileAtlas& object_tiles() { return object_.tiles; }
  [[nodiscard]] const TileAtlas& object_tiles() const { return object_.tiles; }
  /// Returns the tiles of the scene, indexed by the query's index in its batch.
  TileAtlas& scene_tiles() { return scene_.tiles; }
  [[nodiscard]] const TileAtlas& scene_tiles() const { return scene_.tiles; }

  /// Draws both passes for the queries of the batch, and writes the minimum over each scene tile to `least`.
  /// Sorts the batch's draws. Requires at least one query.
  void draw(TileBatch& batch, LeastGap& least);
  /// Makes the next call reallocate the buffers. Call it after the renderer failed.
  void forget();

 private:
  struct Pass {
    explicit Pass(GlContext& context) : tiles(context), draws(context) {}
    TileAtlas tiles;
    TileDraws draws;
    unsigned program = 0;
  };
  Pass object_, scene_;
  unsigned clear_program_ = 0;
};

}  // namespace roomradar
