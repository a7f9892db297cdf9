// mask_cache.cpp: a hash table in arrays, with a clock hand for the next tile to evict.
#include "radar/batch/mask_cache.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/fibonacci_hash.hpp"

namespace roomradar {

MaskKey mask_key(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh) {
  MaskKey key{mesh.revision(), {}};
  for (std::size_t i = 0; i < 3; ++i) {
    key.direction[i] = std::llround(std::ldexp(u_mesh[static_cast<Eigen::Index>(i)], 40));
  }
  return key;
}

void MaskCache::reset(std::size_t tiles) {
  tiles_.assign(tiles, {});
  heads_.assign(2 * tiles + 1, kNone);
  hand_ = 0;
}

void MaskCache::forget() {
  for (Tile& tile : tiles_) tile.is_held = false;
  std::fill(heads_.begin(), heads_.end(), kNone);
}

std::size_t& MaskCache::head(const MaskKey& key) {
  std::uint64_t hash = key.revision;
  for (const std::int64_t part : key.direction) {
    hash = fibonacci_hash(hash ^ static_cast<std::uint64_t>(part));
    hash ^= hash >> 29U;
  }
  return heads_[hash % heads_.size()];
}

std::size_t MaskCache::find(const MaskKey& key) {
  if (tiles_.empty()) return kNone;
  for (std::size_t tile = head(key); tile != kNone; tile = tiles_[tile].next) {
    if (!(tiles_[tile].key == key)) continue;
    tiles_[tile].used_round = round_;
    return tile;
  }
  return kNone;
}

void MaskCache::unlink(std::size_t tile) {
  std::size_t* link = &head(tiles_[tile].key);
  while (*link != tile) link = &tiles_[*link].next;
  *link = tiles_[tile].next;
}

std::size_t MaskCache::claim(const MaskKey& key) {
  for (std::size_t tries = 0; tries < tiles_.size(); ++tries) {
    const std::size_t tile = hand_;
    hand_ = (hand_ + 1) % tiles_.size();
    if (tiles_[tile].is_held && tiles_[tile].used_round == round_) continue;
    if (tiles_[tile].is_held) unlink(tile);
    std::size_t& first = head(key);
    tiles_[tile].key = key;
    tiles_[tile].mask.is_drawn = false;
    tiles_[tile].used_round = round_;
    tiles_[tile].is_held = true;
    tiles_[tile].next = first;
    first = tile;
    return tile;
  }
  return kNone;
}

}  // namespace roomradar
