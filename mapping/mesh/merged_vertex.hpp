// merged_vertex.hpp: accumulated data of merged vertices in edge collapses, and linked lists of indices.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/mesh/quadric.hpp"

namespace roomradar {

/// Index that stands for "no vertex", "no triangle" or "no corner of a triangle".
inline constexpr std::uint32_t kNoIndex = ~std::uint32_t{0};

struct MergedVertex {
  Quadric quadric;
  Eigen::Vector3f normal_sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f colour_sum = Eigen::Vector3f::Zero();
  std::uint32_t count = 0;
  std::uint32_t version = 0;  ///< incremented by every collapse; kNoIndex: vertex removed
  float tolerance_m = 0.0F;   ///< minimum over the merged vertices; 0: constrained
  bool on_border = false;

  /// Merges another vertex into this one.
  /// @param both  sum of both quadrics
  void absorb(MergedVertex& from, const Quadric& both) {
    quadric = both;
    normal_sum += from.normal_sum;
    colour_sum += from.colour_sum;
    count += from.count;
    on_border |= from.on_border;
    ++version;
    from.version = kNoIndex;
    tolerance_m = std::min(tolerance_m, from.tolerance_m);
  }
};

/// Singly linked lists of indices. An index is in at most one list.
struct IndexLists {
  IndexLists(std::size_t lists, std::size_t indices) : first(lists, kNoIndex), next(indices, kNoIndex) {}
  void push_front(std::uint32_t list, std::uint32_t index) {
    next[index] = first[list];
    first[list] = index;
  }
  std::vector<std::uint32_t> first;  ///< per list; kNoIndex: empty
  std::vector<std::uint32_t> next;   ///< per index; kNoIndex: last of its list
};

}  // namespace roomradar
