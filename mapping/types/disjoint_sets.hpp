// disjoint_sets.hpp: union-find over indices, e.g. for connected components.
#pragma once
#include <numeric>
#include <vector>

namespace roomradar {

/// Disjoint sets of the indices 0 to count - 1; at first, each index is a set of its own.
/// Source: Tarjan, van Leeuwen, Worst-case analysis of set union algorithms, J. ACM 1984 (path halving).
template <typename Index>
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  /// Returns the representative of the index's set.
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins the sets of a and b; the representative of b's set represents both.
  void join(Index a, Index b) { parent_[find(a)] = find(b); }

 private:
  std::vector<Index> parent_;
};

}  // namespace roomradar
