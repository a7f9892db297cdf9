// mask_cache.hpp: cache of mask atlas tiles by object and direction.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radar/batch/radar_volume.hpp"

namespace roomradar {

/// Everything that a mask depends on: the mesh and the direction in its frame, not its pose in the world.
struct MaskKey {
  std::uint64_t revision = 0;  ///< GpuMesh::revision()
  /// Direction in steps of 2^-40. Directions in the same step are equal: an error of 0.1 nm after 100 m.
  std::array<std::int64_t, 3> direction{};
  friend bool operator==(const MaskKey&, const MaskKey&) = default;
};
MaskKey mask_key(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh);

/// A fixed number of tiles, each with the outline drawn there. Tiles used in the current round are never
/// evicted. Allocates in reset() only. Not thread safe.
class MaskCache {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Forgets everything and sets the number of tiles.
  void reset(std::size_t tiles);
  /// Starts a round: tiles used before may now be evicted.
  void begin_round() { ++round_; }
  /// Returns the tile with this key, kept for this round; kNone if there is none.
  std::size_t find(const MaskKey& key);
  /// Returns a tile for a key that find() did not have; kNone if this round uses all tiles.
  std::size_t claim(const MaskKey& key);
  struct Mask {
    RadarOutline outline;   ///< set by the caller of claim()
    bool is_drawn = false;  ///< set by the caller that draws it
  };
  Mask& mask(std::size_t tile) { return tiles_[tile].mask; }
  /// Forgets every key, as the contents of the tiles are no longer valid.
  void forget();

 private:
  struct Tile {
    MaskKey key;
    Mask mask;
    std::uint64_t used_round = 0;
    std::size_t next = kNone;  // next tile with the same hash
    bool is_held = false;
  };
  std::vector<Tile> tiles_;
  std::vector<std::size_t> heads_;  // first tile by hash
  std::uint64_t round_ = 0;
  std::size_t hand_ = 0;  // clock hand: where the search for a tile to evict continues

  std::size_t& head(const MaskKey& key);
  void unlink(std::size_t tile);
};

}  // namespace roomradar
