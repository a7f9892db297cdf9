// edge_counts.hpp: number of triangles on each edge of a mesh, per direction.
#pragma once
#include <algorithm>
#include <map>
#include <utility>

#include "mapping/types/mesh.hpp"

namespace roomradar::test {

struct EdgeUse {
  int forward = 0;  // from the lower vertex index to the higher
  int backward = 0;
};

using EdgeUses = std::map<std::pair<std::uint32_t, std::uint32_t>, EdgeUse>;

inline EdgeUses edge_uses(const Mesh& mesh) {
  EdgeUses uses;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      EdgeUse& use = uses[std::minmax(a, b)];
      ++(a < b ? use.forward : use.backward);
    }
  return uses;
}

}  // namespace roomradar::test
