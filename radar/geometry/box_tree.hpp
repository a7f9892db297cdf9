// box_tree.hpp: boxes in an order that keeps neighbours together, under boxes of eight, and so on up.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// Finds those of many boxes that something reaches without asking each. Not thread safe while built.
class BoxTree {
 public:
  /// O(n); allocates nothing once as many boxes were held. The better neighbours in the order lie together,
  /// the more is left out.
  void build(std::span<const Eigen::AlignedBox3d> boxes);

  [[nodiscard]] std::size_t size() const { return levels_.empty() ? 0 : levels_.front().count; }

  /// Calls work(index) for each box that `reaches(box)` says yes to, in ascending order. Whatever holds for a
  /// box must hold for every box around it.
  template <typename Reaches, typename Work>
  void visit(const Reaches& reaches, const Work& work) const {
    if (!levels_.empty()) visit_range(levels_.size() - 1, 0, levels_.back().count, reaches, work);
  }

 private:
  static constexpr std::size_t kWidth = 8;
  struct Level {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  std::vector<Eigen::AlignedBox3d> boxes_;  // level by level, the given ones first
  std::vector<Level> levels_;

  template <typename Reaches, typename Work>
  void visit_range(std::size_t level, std::size_t begin, std::size_t end, const Reaches& reaches,
                   const Work& work) const {
    for (std::size_t i = begin; i < end; ++i) {
      if (!reaches(boxes_[levels_[level].first + i])) continue;
      if (level == 0) {
        work(i);
      } else {
        visit_range(level - 1, i * kWidth, std::min((i + 1) * kWidth, levels_[level - 1].count), reaches,
                    work);
      }
    }
  }
};

}  // namespace roomradar
