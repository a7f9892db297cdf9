// hitting_set.cpp: branch and bound over the smallest conflict that is not broken yet.
#include "mapping/building/hitting_set.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace roomradar {
namespace {

class Search {
 public:
  Search(std::span<const Conflict> conflicts, std::span<const double> costs)
      : conflicts_(conflicts), costs_(costs), state_(costs.size(), State::kOpen) {}

  std::vector<std::size_t> best() {
    descend(0.0);
    std::sort(best_.begin(), best_.end());
    return best_;
  }

 private:
  enum class State : char { kOpen, kTaken, kForbidden };

  /// Returns the elements of a conflict that may still be taken; empty if one is taken already.
  [[nodiscard]] std::vector<std::size_t> open_of(const Conflict& conflict, bool& is_broken) const {
    is_broken = std::any_of(conflict.begin(), conflict.end(),
                            [&](std::size_t e) { return state_[e] == State::kTaken; });
    std::vector<std::size_t> open;
    if (!is_broken)
      std::copy_if(conflict.begin(), conflict.end(), std::back_inserter(open),
                   [&](std::size_t e) { return state_[e] == State::kOpen; });
    return open;
  }

  /// Extends the elements taken so far, of the given cost, in all ways that may be the cheapest.
  void descend(double cost) {
    constexpr std::size_t kMostSteps = 200'000;
    if (++steps_ > kMostSteps && !best_.empty()) return;
    // Conflicts without a common element cost at least their cheapest elements together.
    double bound = cost;
    std::vector<bool> is_counted(costs_.size(), false);
    std::vector<std::size_t> next;  // of the conflict with the fewest elements
    for (const Conflict& conflict : conflicts_) {
      bool is_broken = false;
      std::vector<std::size_t> open = open_of(conflict, is_broken);
      if (is_broken) continue;
      if (open.empty()) return;  // cannot be broken any more
      if (std::none_of(open.begin(), open.end(), [&](std::size_t e) { return is_counted[e]; })) {
        bound += costs_[*std::min_element(
            open.begin(), open.end(), [&](std::size_t x, std::size_t y) { return costs_[x] < costs_[y]; })];
        for (const std::size_t e : open) is_counted[e] = true;
      }
      if (next.empty() || open.size() < next.size()) next = std::move(open);
    }
    constexpr double kLess = 1.0 - 1e-9;  // of equals, the first found
    if (bound >= best_cost_ * kLess) return;
    if (next.empty()) {
      best_cost_ = cost;
      best_.clear();
      for (std::size_t e = 0; e < state_.size(); ++e)
        if (state_[e] == State::kTaken) best_.push_back(e);
      return;
    }
    // Those that break the most conflicts for their cost first.
    std::vector<double> gain(costs_.size(), 0.0);
    for (const Conflict& conflict : conflicts_) {
      bool is_broken = false;
      for (const std::size_t e : open_of(conflict, is_broken)) gain[e] += 1.0;
    }
    std::stable_sort(next.begin(), next.end(),
                     [&](std::size_t x, std::size_t y) { return gain[x] / costs_[x] > gain[y] / costs_[y]; });
    for (const std::size_t e : next) {
      state_[e] = State::kTaken;
      descend(cost + costs_[e]);
      state_[e] = State::kForbidden;  // sets with it have been tried
    }
    for (const std::size_t e : next) state_[e] = State::kOpen;
  }

  std::span<const Conflict> conflicts_;
  std::span<const double> costs_;
  std::vector<State> state_;
  std::vector<std::size_t> best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  std::size_t steps_ = 0;
};

}  // namespace

std::vector<std::size_t> cheapest_hitting_set(std::span<const Conflict> conflicts,
                                              std::span<const double> costs) {
  if (conflicts.empty()) return {};
  return Search(conflicts, costs).best();
}

}  // namespace roomradar
