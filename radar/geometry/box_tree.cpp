// box_tree.cpp: builds each level as the boxes around eight of the level below.
#include "radar/geometry/box_tree.hpp"

namespace roomradar {

void BoxTree::build(std::span<const Eigen::AlignedBox3d> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  levels_.clear();
  if (boxes.empty()) return;
  levels_.push_back({0, boxes.size()});
  while (levels_.back().count > 1) {
    const Level below = levels_.back();
    const Level level{boxes_.size(), (below.count + kWidth - 1) / kWidth};
    for (std::size_t i = 0; i < level.count; ++i) {
      Eigen::AlignedBox3d around;
      for (std::size_t j = i * kWidth; j < std::min((i + 1) * kWidth, below.count); ++j) {
        around.extend(boxes_[below.first + j]);
      }
      boxes_.push_back(around);
    }
    levels_.push_back(level);
  }
}

}  // namespace roomradar
