// scene_queue.hpp: priority queue of the scene items that are left to examine.
#pragma once
#include <algorithm>
#include <vector>

#include "radar/exact/scene_in_frame.hpp"

namespace roomradar {

/// A binary heap of scene items. The item with the least SceneItem::low_m is popped first. Keeps its memory
/// when cleared.
class SceneQueue {
 public:
  void clear() { items_.clear(); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// Returns the items, for appending many at once. A call of arrange() must follow.
  [[nodiscard]] std::vector<SceneItem>& items() { return items_; }
  /// Restores the heap order.
  void arrange() { std::make_heap(items_.begin(), items_.end(), is_farther); }

  /// Returns the item with the least bound. Requires at least one item.
  [[nodiscard]] const SceneItem& least() const { return items_.front(); }
  SceneItem pop() {
    std::pop_heap(items_.begin(), items_.end(), is_farther);
    const SceneItem item = items_.back();
    items_.pop_back();
    return item;
  }
  void push(const SceneItem& item) {
    items_.push_back(item);
    std::push_heap(items_.begin(), items_.end(), is_farther);
  }
  /// Removes all items with a negative bound, since these may be behind the object's leading surface.
  void drop_below_zero() {
    std::erase_if(items_, [](const SceneItem& item) { return item.low_m < 0.0F; });
    arrange();
  }

 private:
  static bool is_farther(const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; }
  std::vector<SceneItem> items_;
};

}  // namespace roomradar
