// half_edges.cpp: matches half-edges by position, and sums the volumes of connected components.
#include "radar/geometry/half_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

/// Equal for equal positions.
std::uint64_t position_hash(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (const float coordinate : p) hash = hash_of(hash, std::bit_cast<std::uint32_t>(coordinate + 0.0F));
  return hash;
}

}  // namespace

std::vector<std::uint32_t> numbers_by_place(const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<std::uint32_t> by_key(vertices.size());
  std::iota(by_key.begin(), by_key.end(), 0U);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(vertices[a].data(), vertices[a].data() + 3, vertices[b].data(),
                                        vertices[b].data() + 3);
  };
  std::erase_if(by_key, [&](std::uint32_t v) { return !vertices[v].allFinite(); });
  std::sort(by_key.begin(), by_key.end(), before);
  std::vector<std::uint32_t> number(vertices.size(), 0);
  for (std::size_t i = 1; i < by_key.size(); ++i) {
    number[by_key[i]] = number[by_key[i - 1]] + (before(by_key[i - 1], by_key[i]) ? 1U : 0U);
  }
  return number;
}

std::vector<HalfEdge> half_edges_of(const std::vector<Triangle>& triangles,
                                    const std::vector<std::uint32_t>& number) {
  std::vector<HalfEdge> edges;
  edges.reserve(triangles.size() * 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint64_t a = number[triangles[t][i]], b = number[triangles[t][(i + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b) << 32U | std::max(a, b), 3 * t + i, a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.side < b.side;
  });
  return edges;
}

// Sums a hash of each side's positions, with the sign of its direction. Sides of opposite directions cancel.
bool may_be_closed(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<std::uint64_t> hash(vertices.size());
  std::transform(vertices.begin(), vertices.end(), hash.begin(), position_hash);
  std::uint64_t sum = 0;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t a = hash[t[i]], b = hash[t[(i + 1) % 3]];
      sum += hash_of(a, b) - hash_of(b, a);
    }
  return sum == 0;
}

bool encloses_a_volume(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
                       const std::vector<std::uint32_t>& number, const std::vector<HalfEdge>& edges) {
  int balance = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    balance += edges[i].sense;
    if (i + 1 < edges.size() && edges[i + 1].edge == edges[i].edge) continue;
    if (balance != 0) return false;
  }
  // Connected components are tested separately, so one that is inside out cannot hide behind a larger one.
  std::vector<std::uint32_t> part(vertices.size());
  std::iota(part.begin(), part.end(), 0U);
  const auto part_of = [&](std::uint32_t v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  for (const Triangle& t : triangles) {
    part[part_of(number[t[0]])] = part_of(number[t[1]]);
    part[part_of(number[t[1]])] = part_of(number[t[2]]);
  }
  std::vector<double> volume_m3(vertices.size(), 0.0);
  const Eigen::Vector3d about = vertices[triangles[0][0]].cast<double>();
  for (const Triangle& t : triangles) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = vertices[t[i]].cast<double>() - about;
    volume_m3[part_of(number[t[0]])] += p[0].dot(p[1].cross(p[2]));
  }
  bool encloses = false;
  for (const Triangle& t : triangles) {
    const std::uint32_t a = number[t[0]], b = number[t[1]], c = number[t[2]];
    if (a == b || b == c || c == a) continue;  // a point or a line encloses nothing
    if (!(volume_m3[part_of(number[t[0]])] > 0.0)) return false;
    encloses = true;
  }
  return encloses;
}

}  // namespace roomradar
