// box_tree.hpp: 8-wide hierarchy of bounding boxes over a list of spatially ordered boxes.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// Finds the boxes that satisfy a predicate without testing every box. Building is not thread safe.
class BoxTree {
 public:
  /// Builds the hierarchy in O(n) over groups of consecutive boxes. Visits skip more if consecutive boxes are
  /// close together. Allocates nothing if an earlier build had at least as many boxes.
  void build(std::span<const Eigen::AlignedBox3d> boxes);

  [[nodiscard]] std::size_t size() const { return levels_.empty() ? 0 : levels_.front().count; }

  /// Calls work(index), in ascending order of index, for each box of build() for which `reaches(box)` is
  /// true. If `reaches` is true for a box, it must be true for every box that contains that box.
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
  std::vector<Eigen::AlignedBox3d> boxes_;  // boxes of all levels; level 0 (the given boxes) is first
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
