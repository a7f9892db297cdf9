// mask_cache.hpp: cache of the masks (objects' depth images) drawn by GlRadar.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radar/batch/radar_volume.hpp"

namespace roomradar {

/// Inputs of a mask: the mesh, and the direction of motion in the mesh's frame. A mask does not depend on the
/// object's pose in the world.
struct MaskKey {
  /// GpuMesh::revision() of the mesh.
  std::uint64_t revision = 0;
  /// Direction, rounded to multiples of 2^-40. Directions with equal rounded values share a mask. After 100 m
  /// of motion, the resulting error is at most 0.2 nm.
  std::array<std::int64_t, 3> direction{};
  friend bool operator==(const MaskKey&, const MaskKey&) = default;
};
MaskKey mask_key(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh);

/// Cache of a fixed number of tiles (regions of the mask texture), each with its key and outline. Tiles used
/// since begin_round() are never evicted. Allocates memory in reset() only. Not thread safe.
class MaskCache {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Empties the cache and sets the number of tiles.
  void reset(std::size_t tiles);
  /// Starts a round: tiles used in earlier rounds may now be evicted.
  void begin_round() { ++round_; }
  /// Returns the tile with this key and protects it from eviction in this round. Returns kNone if no tile has
  /// this key.
  std::size_t find(const MaskKey& key);
  /// Assigns a tile to a key that find() did not find. Returns kNone if this round uses all tiles.
  std::size_t claim(const MaskKey& key);
  struct Mask {
    /// Set by the caller of claim().
    RadarOutline outline;
    /// Set by the caller that draws the mask.
    bool is_drawn = false;
  };
  Mask& mask(std::size_t tile) { return tiles_[tile].mask; }
  /// Removes all keys. Call it when the tiles' contents are lost, for example because the renderer failed.
  void forget();

 private:
  struct Tile {
    MaskKey key;
    Mask mask;
    std::uint64_t used_round = 0;
    // Next tile with the same hash.
    std::size_t next = kNone;
    /// True if the tile has a key.
    bool is_held = false;
  };
  std::vector<Tile> tiles_;
  // First tile of each hash value.
  std::vector<std::size_t> heads_;
  std::uint64_t round_ = 0;
  // Clock hand: index at which the next search for a tile to evict begins.
  std::size_t hand_ = 0;

  std::size_t& head(const MaskKey& key);
  void unlink(std::size_t tile);
};

}  // namespace roomradar
