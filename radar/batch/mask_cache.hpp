// mask_cache.hpp: which tile of the mask atlas holds which object as seen along which direction.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radar/batch/radar_volume.hpp"

namespace roomradar {

/// What a mask depends on: the mesh and the direction in its frame, nothing of the world.
struct MaskKey {
  std::uint64_t revision = 0;  ///< GpuMesh::revision()
  /// The direction in steps of 2^-40: closer ones are one, which is 0.1 nm off after 100 m.
  std::array<std::int64_t, 3> direction{};
  friend bool operator==(const MaskKey&, const MaskKey&) = default;
};
MaskKey mask_key(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh);

/// A fixed number of tiles, each with the outline that was drawn there. Tiles that the current round uses are
/// never given away. Allocates only in reset. Not thread safe.
class MaskCache {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Forgets everything and has `tiles` tiles.
  void reset(std::size_t tiles);
  /// From here on tiles used before may be given away.
  void begin_round() { ++round_; }
  /// The tile that holds the key, kept for this round; kNone if none does.
  std::size_t find(const MaskKey& key);
  /// A tile for a key that find did not know, or kNone where this round uses them all.
  std::size_t claim(const MaskKey& key);
  struct Mask {
    RadarOutline outline;   ///< filled in by who claimed the tile
    bool is_drawn = false;  ///< set by who draws it
  };
  Mask& mask(std::size_t tile) { return tiles_[tile].mask; }
  /// Forgets every key: what the tiles hold is not to be trusted.
  void forget();

 private:
  struct Tile {
    MaskKey key;
    Mask mask;
    std::uint64_t used_round = 0;
    std::size_t next = kNone;  // with the same hash
    bool is_held = false;
  };
  std::vector<Tile> tiles_;
  std::vector<std::size_t> heads_;  // by hash
  std::uint64_t round_ = 0;
  std::size_t hand_ = 0;  // where the search for a tile to give away goes on

  std::size_t& head(const MaskKey& key);
  void unlink(std::size_t tile);
};

}  // namespace roomradar
