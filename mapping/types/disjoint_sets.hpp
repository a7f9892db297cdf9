// disjoint_sets.hpp: union-find over indices, e.g. for connected components.
#pragma once
#include <numeric>
#include <vector>

namespace roomradar {

/// Returns the root of node i in a union-find forest whose parents are part of the caller's data. Halves the
/// path to the root.
/// @param parent_of  parent_of(i) returns a reference to the parent of node i; a root is its own parent
/// Source: Tarjan, van Leeuwen, Worst-case analysis of set union algorithms, J. ACM 1984 (path halving).
template <typename Index, typename ParentOf>
Index find_root(Index i, const ParentOf& parent_of) {
  while (parent_of(i) != i) i = parent_of(i) = parent_of(parent_of(i));
  return i;
}

/// Disjoint sets of the indices 0 to count - 1; at first, each index is a set of its own.
template <typename Index>
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  /// Returns the representative of the index's set.
  Index find(Index i) {
    return find_root(i, [this](Index of) -> Index& { return parent_[of]; });
  }
  /// Joins the sets of a and b; the representative of b's set represents both.
  void join(Index a, Index b) { parent_[find(a)] = find(b); }

 private:
  std::vector<Index> parent_;
};

}  // namespace roomradar
