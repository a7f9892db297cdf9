// stamp_repair.cpp: rules for absent, unsorted, repeated and shifted stamps, and for stamps in other units.
#include "app/sources/decisions/stamp_repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "app/sources/formats/median.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr double kLeastRate_hz = 0.9;  // of images in a recording
constexpr double kMostRate_hz = 240.0;
constexpr const char* kStampsOption = "--stamps";

bool is_stated(double stamp_s) { return std::isfinite(stamp_s); }

/// Returns the median difference of neighbours in the sorted stamps, without differences of 0; nullopt if all
/// are equal.
std::optional<double> period_of(std::span<const double> stamps) {
  std::vector<double> sorted;
  std::copy_if(stamps.begin(), stamps.end(), std::back_inserter(sorted), is_stated);
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] > sorted[i - 1]) steps.push_back(sorted[i] - sorted[i - 1]);
  if (steps.empty()) return std::nullopt;
  return median_of(std::move(steps));
}

/// Returns "1 depth image has" or "3 depth images have".
std::string images_have(std::size_t count, const std::string& what) {
  return count == 1 ? "1 " + what.substr(0, what.size() - 1) + " has"
                    : std::to_string(count) + " " + what + " have";
}

/// The list while it is being repaired.
struct Stamps {
  const std::vector<StatedTime>& times;
  const StampRules& rules;
  InputReport& report;
  RepairedStamps result{};
  std::vector<double>& s = result.stamps_s;

  [[nodiscard]] std::size_t size() const { return s.size(); }
  void say(std::size_t count, const std::string& sentence, bool is_advice = false) {
    report.add({"time", sentence, static_cast<std::int64_t>(count), kStampsOption, is_advice});
  }
};

bool has_reception(const std::vector<StatedTime>& times) {
  return !times.empty() &&
         std::all_of(times.begin(), times.end(), [](const auto& each) { return is_stated(each.received_s); });
}

/// Marks stamps of 0 as not stated, unless one image may really have been taken at time 0.
void remove_zeros(Stamps& stamps, bool received) {
  std::size_t zeros = 0;
  std::vector<double> others;
  for (const double stamp : stamps.s) {
    zeros += stamp == 0.0 ? 1U : 0U;
    if (is_stated(stamp) && stamp != 0.0) others.push_back(stamp);
  }
  if (zeros == 0 || stamps.size() < 2) return;
  if (zeros == 1 && !others.empty()) {
    const double least = *std::min_element(others.begin(), others.end());
    const double most = *std::max_element(others.begin(), others.end());
    const bool is_beginning = stamps.s.front() == 0.0 && least > 0.0 && least <= (most - least) + 5.0;
    if (is_beginning || (!received && least < 0.0)) return;
  }
  for (double& stamp : stamps.s)
    if (stamp == 0.0) stamp = kNoStamp;
}

/// Finds the unit of the stamps by their rate.
void find_unit(Stamps& stamps, bool received) {
  const std::optional<double> period = period_of(stamps.s);
  if (stamps.rules.choice == StampChoice::kSeconds) return;
  double unit_s = 1.0;
  for (const auto& [choice, length_s] : {std::pair(StampChoice::kMilliseconds, 1e-3),
                                         {StampChoice::kMicroseconds, 1e-6},
                                         {StampChoice::kNanoseconds, 1e-9}})
    if (stamps.rules.choice == choice) unit_s = length_s;
  if (unit_s == 1.0 && period) {
    std::vector<double> received_s;
    for (const StatedTime& time : stamps.times) received_s.push_back(time.received_s);
    const std::optional<double> received_period = received ? period_of(received_s) : std::nullopt;
    const auto is_plausible = [&](double length_s) {
      const double rate_hz = 1.0 / (*period * length_s);
      const double ratio = received_period ? *period * length_s / *received_period : 1.0;
      return rate_hz >= kLeastRate_hz && rate_hz <= kMostRate_hz && ratio > 0.3 && ratio < 3.0;
    };
    if (stamps.rules.like && stamps.rules.like->unit_s != 1.0) {
      unit_s = stamps.rules.like->unit_s;
    } else if (!is_plausible(1.0)) {
      const bool all_whole = std::all_of(stamps.s.begin(), stamps.s.end(), [](double stamp) {
        return !is_stated(stamp) || stamp == std::floor(stamp);
      });
      // As seconds since 1970, such stamps are of the year 5000 and later.
      constexpr double kLatest_s = 1e11;
      const auto late = std::count_if(stamps.s.begin(), stamps.s.end(),
                                      [](double stamp) { return is_stated(stamp) && stamp > kLatest_s; });
      const bool is_too_late = 2 * static_cast<std::size_t>(late) > stamps.size();
      // Keyframes may be several seconds apart. Other formats fix the unit, but some writers ignore that.
      const bool may_be_seconds = received_period             ? false
                                  : stamps.rules.have_no_unit ? !all_whole && !is_too_late && *period < 60.0
                                                              : *period > 1e-3 && *period < 100.0;
      if (!may_be_seconds)
        for (const double length_s : {1e-3, 1e-6, 1e-9, 1e3, 1e6})
          if (unit_s == 1.0 && is_plausible(length_s)) unit_s = length_s;
    }
    if (unit_s != 1.0 && (!stamps.rules.like || stamps.rules.like->unit_s != unit_s)) {
      const std::string name = unit_s == 1e-3   ? "milliseconds"
                               : unit_s == 1e-6 ? "microseconds"
                               : unit_s == 1e-9 ? "nanoseconds"
                                                : "other units than the format's";
      stamps.say(stamps.size(), "the stamps of the " + stamps.rules.what + " are in " + name +
                                    ", since that gives " + format_readable(1.0 / (*period * unit_s), 3) +
                                    " images per second");
    }
  }
  stamps.result.unit_s = unit_s;
  if (unit_s == 1.0) return;
  const double divisor = std::round(1.0 / unit_s);
  for (double& stamp : stamps.s) stamp = unit_s < 1.0 ? stamp / divisor : stamp * unit_s;
}

// ---- with times of reception ----

/// The stamps that are stated, as stated, with their times of reception.
struct ReceivedStamps {
  std::vector<std::size_t> images{};  ///< indices in the list
  std::vector<double> stamps_s{}, received_s{};

  /// Returns the median of stamp - reception of the images k, k + 1, ...
  [[nodiscard]] double level_from(std::size_t k) const {
    constexpr std::size_t kWindow = 15;
    std::vector<double> offsets;
    for (std::size_t j = k; j < std::min(k + kWindow, images.size()); ++j)
      offsets.push_back(stamps_s[j] - received_s[j]);
    return median_of(std::move(offsets));
  }

  /// Returns whether stamp k neither follows the one before it nor is at the level. A recorder that stalls
  /// receives late, but then the stamps go on as before.
  [[nodiscard]] bool is_off(std::size_t k, double level_s, double period_s, double limit_s) const {
    if (k == 0) return false;
    const double step_s = stamps_s[k] - stamps_s[k - 1];
    const double received_step_s = received_s[k] - received_s[k - 1];
    const bool goes_back = step_s<-1.5 * period_s, jumps = step_s> received_step_s + 0.5 + 3.0 * period_s;
    return (goes_back || jumps) && std::abs(stamps_s[k] - received_s[k] - level_s) > limit_s;
  }
};

ReceivedStamps received_stamps_of(const Stamps& stamps) {
  ReceivedStamps stated;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    if (is_stated(stamps.s[i])) {
      stated.images.push_back(i);
      stated.stamps_s.push_back(stamps.s[i]);
      stated.received_s.push_back(stamps.times[i].received_s);
    }
  return stated;
}

/// What became of the header's clock.
struct ClockChanges {
  double first_level_s = 0.0;   ///< stamp - reception by the clock at the beginning
  double largest_step_s = 0.0;  ///< by which it was set
  std::size_t moved = 0;        ///< number of stamps that were moved back to the first clock
};

/// Moves stamps after a change of the clock back to the first clock, and marks those far from the time of
/// reception as not stated. One or more stamps are stated.
ClockChanges follow_clock(Stamps& stamps, const ReceivedStamps& stated) {
  ClockChanges changes;
  const double period_s = period_of(stamps.s).value_or(1.0 / kNominalRate_hz);
  const double limit_s = std::max(1.5 * period_s, 0.05);
  double level_s = changes.first_level_s = stated.level_from(0);
  double shift_s = 0.0;
  for (std::size_t k = 0; k < stated.images.size(); ++k) {
    const std::size_t i = stated.images[k];
    const double stamp_s = stated.stamps_s[k];
    if (stated.is_off(k, level_s, period_s, limit_s)) {
      const double next_level_s = stated.level_from(k);
      if (std::abs(next_level_s - level_s) > limit_s) {
        if (std::abs(next_level_s - level_s) > std::abs(changes.largest_step_s))
          changes.largest_step_s = next_level_s - level_s;
        level_s = next_level_s;
        shift_s = changes.first_level_s - level_s;
        stamps.result.stretches.push_back({i, shift_s});
      }
    }
    if (std::abs(stamp_s - stated.received_s[k] - level_s) > std::max(2.0, 30.0 * period_s)) {
      stamps.s[i] = kNoStamp;
    } else if (shift_s != 0.0) {
      stamps.s[i] = stamp_s + shift_s;
      ++changes.moved;
    }
  }
  return changes;
}

/// Finds places where the header's clock was set, by comparison with the time of reception. Moves later
/// stamps back to the first clock. Replaces stamps that are not stated, or far from the time of reception for
/// a moment.
void repair_by_reception(Stamps& stamps) {
  const ReceivedStamps stated = received_stamps_of(stamps);
  ClockChanges changes{.first_level_s = stamps.rules.like ? stamps.rules.like->header_offset_s : 0.0};
  if (!stated.images.empty()) changes = follow_clock(stamps, stated);
  std::size_t replaced = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (is_stated(stamps.s[i])) continue;
    stamps.s[i] = stamps.times[i].received_s + changes.first_level_s;
    ++replaced;
  }
  stamps.result.header_offset_s = changes.first_level_s;
  if (replaced == stamps.size())
    stamps.say(replaced,
               "the " + stamps.rules.what + " have no time stamps; their times of reception are used");
  else if (replaced > 0)
    stamps.say(replaced, images_have(replaced, stamps.rules.what) +
                             " no usable time stamp; their times of reception are used");
  if (changes.moved > 0)
    stamps.say(changes.moved, "the clock of the " + stamps.rules.what + " was set " +
                                  (changes.largest_step_s < 0 ? "back" : "forward") + " by " +
                                  format_readable(std::abs(changes.largest_step_s), 3) + " s at image " +
                                  std::to_string(stamps.result.stretches.front().first) +
                                  "; later stamps follow the time of reception");
}

// ---- without times of reception ----

/// Marks isolated stamps that are far from all others as not stated.
void remove_absurd(Stamps& stamps) {
  std::vector<double> sorted;
  std::copy_if(stamps.s.begin(), stamps.s.end(), std::back_inserter(sorted), is_stated);
  if (sorted.size() < 4) return;
  std::sort(sorted.begin(), sorted.end());
  const double period_s = period_of(stamps.s).value_or(1.0 / kNominalRate_hz);
  const double gap_s = std::max(1000.0 * period_s, 60.0);
  // The longest part of the sorted stamps without a gap.
  std::size_t begin = 0, best_begin = 0, best_end = 0;
  for (std::size_t i = 1; i <= sorted.size(); ++i)
    if (i == sorted.size() || sorted[i] - sorted[i - 1] > gap_s) {
      if (i - begin > best_end - best_begin) best_begin = begin, best_end = i;
      begin = i;
    }
  if (best_end - best_begin < sorted.size() * 9 / 10) return;
  const double least_s = sorted[best_begin], most_s = sorted[best_end - 1];
  const auto is_far = [&](std::size_t i) {
    return is_stated(stamps.s[i]) && (stamps.s[i] < least_s || stamps.s[i] > most_s);
  };
  std::vector<std::size_t> absurd;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    if (is_far(i) && !((i > 0 && is_far(i - 1)) && (i + 1 < stamps.size() && is_far(i + 1))))
      absurd.push_back(i);
  for (const std::size_t i : absurd) stamps.s[i] = kNoStamp;
  if (!absurd.empty())
    stamps.say(absurd.size(), images_have(absurd.size(), stamps.rules.what) + " a stamp far from all others");
}

/// Returns the longest gap between neighbours in the sorted stamps.
double longest_gap_s(const std::vector<double>& stamps_s) {
  std::vector<double> sorted;
  std::copy_if(stamps_s.begin(), stamps_s.end(), std::back_inserter(sorted), is_stated);
  std::sort(sorted.begin(), sorted.end());
  double longest_s = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) longest_s = std::max(longest_s, sorted[i] - sorted[i - 1]);
  return longest_s;
}

/// Repairs a list in which stamps of two clocks alternate: those below the longest gap are moved by the
/// difference that most often makes a stamp follow the one before it.
void join_two_clocks(Stamps& stamps, double period_s) {
  const double gap_s = longest_gap_s(stamps.s);
  std::vector<double> sorted;
  std::copy_if(stamps.s.begin(), stamps.s.end(), std::back_inserter(sorted), is_stated);
  std::sort(sorted.begin(), sorted.end());
  double first_above_s = sorted.back();
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] == gap_s) first_above_s = sorted[i];
  // An error of the period is opposite in both directions.
  std::vector<double> down_s, up_s;
  const double* last = nullptr;
  for (const double& stamp_s : stamps.s) {
    if (!is_stated(stamp_s)) continue;
    if (last && *last >= first_above_s && stamp_s < first_above_s)
      down_s.push_back(*last + period_s - stamp_s);
    if (last && *last < first_above_s && stamp_s >= first_above_s) up_s.push_back(stamp_s - period_s - *last);
    last = &stamp_s;
  }
  if (down_s.empty() || up_s.empty()) return;
  const double shift_s = 0.5 * (median_of(std::move(down_s)) + median_of(std::move(up_s)));
  std::size_t moved = 0;
  for (double& stamp_s : stamps.s)
    if (is_stated(stamp_s) && stamp_s < first_above_s) stamp_s += shift_s, ++moved;
  stamps.say(moved,
             "the stamps of the " + stamps.rules.what + " are of two clocks that differ by " +
                 format_readable(shift_s, 3) + " s; those of one are moved",
             true);
}

/// Runs of increasing stamps, in the order of the list.
struct Runs {
  std::vector<std::size_t> stated{};      ///< indices of the stamps that are stated
  std::vector<std::size_t> begins = {0};  ///< of runs, in `stated`
  std::size_t swapped = 0;                ///< stamps before an earlier one within a run

  /// The first and the last image of a run, and the end in `stated`.
  [[nodiscard]] std::size_t first(std::size_t run) const { return stated[begins[run]]; }
  [[nodiscard]] std::size_t last(std::size_t run) const { return stated[end(run) - 1]; }
  [[nodiscard]] std::size_t end(std::size_t run) const {
    return run + 1 < begins.size() ? begins[run + 1] : stated.size();
  }
};

/// Splits the list where its stamps decrease. Two or three images that were listed in the wrong order are not
/// a change of the clock.
Runs runs_of(const Stamps& stamps, double period_s) {
  Runs runs;
  std::vector<std::size_t>& stated = runs.stated;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    if (is_stated(stamps.s[i])) stated.push_back(i);
  if (stated.empty()) return runs;
  double largest_s = stamps.s[stated[0]];
  for (std::size_t k = 1; k < stated.size(); ++k) {
    const double stamp_s = stamps.s[stated[k]];
    if (stamp_s < stamps.s[stated[k - 1]]) {
      std::size_t behind = 0;
      for (std::size_t j = k; j < std::min(k + 4, stated.size()); ++j)
        behind += stamps.s[stated[j]] < largest_s ? 1U : 0U;
      const bool is_swap = behind <= 2 && largest_s - stamp_s < 4.0 * period_s;
      if (is_swap)
        ++runs.swapped;
      else {
        runs.begins.push_back(k);
        largest_s = stamp_s;
      }
    }
    largest_s = std::max(largest_s, stamp_s);
  }
  return runs;
}

/// Returns whether the runs, sorted by time, follow one another without a gap.
bool are_in_line(const Runs& runs, const Stamps& stamps, double period_s) {
  std::vector<std::size_t> by_time(runs.begins.size());
  std::iota(by_time.begin(), by_time.end(), 0U);
  std::sort(by_time.begin(), by_time.end(),
            [&](std::size_t a, std::size_t b) { return stamps.s[runs.first(a)] < stamps.s[runs.first(b)]; });
  bool are = true;
  for (std::size_t i = 1; i < by_time.size(); ++i) {
    const double last_s = stamps.s[runs.last(by_time[i - 1])], first_s = stamps.s[runs.first(by_time[i])];
    are &= first_s >= last_s && first_s - last_s <= std::max(10.0 * period_s, 2.0);
  }
  return are;
}

/// Moves each run but the first one, so that it continues after the one before it.
void continue_runs(const Runs& runs, Stamps& stamps, double period_s) {
  double shift_s = 0.0, largest_step_s = 0.0;
  const RepairedStamps* like = stamps.rules.like;
  const bool has_same_changes = like && like->stretches.size() == runs.begins.size() - 1;
  std::size_t moved = 0;
  for (std::size_t run = 1; run < runs.begins.size(); ++run) {
    const double last_s = stamps.s[runs.last(run - 1)];  // already moved
    const double first_s = stamps.s[runs.first(run)];
    shift_s = last_s + period_s - first_s;
    // Images of one recording are moved together, so that pairs stay pairs.
    if (has_same_changes &&
        std::abs(like->stretches[run - 1].shift_s - shift_s) < std::max(1.0, 10.0 * period_s))
      shift_s = like->stretches[run - 1].shift_s;
    largest_step_s = std::max(largest_step_s, shift_s);
    stamps.result.stretches.push_back({runs.first(run), shift_s});
    for (std::size_t k = runs.begins[run]; k < runs.end(run); ++k, ++moved)
      stamps.s[runs.stated[k]] += shift_s;
  }
  stamps.say(moved,
             "the clock was set back by " + format_readable(largest_step_s, 3) + " s at image " +
                 std::to_string(stamps.result.stretches.front().first) + " of the " + stamps.rules.what +
                 "; later stamps continue after the ones before",
             true);
}

/// Splits the list where its stamps decrease. Moves later parts if the clock was set back there, which is
/// assumed if the list has few such places and the stamps do not simply belong into another order.
void undo_clock_changes(Stamps& stamps) {
  const double period_s = period_of(stamps.s).value_or(1.0 / kNominalRate_hz);
  const Runs runs = runs_of(stamps, period_s);
  if (runs.stated.size() < 2) return;
  if (runs.begins.size() == 1) {
    if (runs.swapped > 0)
      stamps.say(runs.swapped,
                 images_have(runs.swapped, stamps.rules.what) + " been listed before an earlier one; sorted");
    return;
  }
  const bool is_shuffled = runs.begins.size() > 3 && runs.stated.size() < 8 * runs.begins.size();
  const bool is_contiguous = longest_gap_s(stamps.s) <= std::max(100.0 * period_s, 10.0);
  if (is_shuffled && !is_contiguous) return join_two_clocks(stamps, period_s);
  if (is_shuffled || are_in_line(runs, stamps, period_s))
    stamps.say(stamps.size(),
               "the " + stamps.rules.what + " are not listed in the order of their stamps; sorted");
  else
    continue_runs(runs, stamps, period_s);
}

/// Interpolates stamps that are not stated between their neighbours in the list, where these are near.
void interpolate(Stamps& stamps) {
  const double period_s = period_of(stamps.s).value_or(1.0 / kNominalRate_hz);
  std::size_t found = 0, lost = 0;
  for (std::size_t begin = 0; begin < stamps.size();) {
    if (is_stated(stamps.s[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < stamps.size() && !is_stated(stamps.s[end])) ++end;
    const std::size_t count = end - begin;
    const bool has_before = begin > 0, has_after = end < stamps.size();
    const double before_s = has_before ? stamps.s[begin - 1] : 0.0, after_s = has_after ? stamps.s[end] : 0.0;
    const double parts = static_cast<double>(count + 1);
    const bool is_near =
        has_before && has_after && after_s > before_s && after_s - before_s < 3.0 * parts * period_s;
    for (std::size_t i = begin; i < end; ++i) {
      const double part = static_cast<double>(i - begin + 1);
      if (is_near)
        stamps.s[i] = before_s + part * (after_s - before_s) / parts;
      else if (has_before && !has_after)
        stamps.s[i] = before_s + part * period_s;
      else if (!has_before && has_after)
        stamps.s[i] = after_s - (parts - part) * period_s;
      (is_stated(stamps.s[i]) ? found : lost) += 1;
    }
    begin = end;
  }
  if (found > 0)
    stamps.say(found, images_have(found, stamps.rules.what) +
                          " no usable time stamp; their times are interpolated between their neighbours");
  if (lost > 0)
    stamps.say(lost, images_have(lost, stamps.rules.what) + " no usable time stamp and are left out", true);
}

/// Spreads equal stamps evenly up to the next stamp.
void spread_equal(Stamps& stamps) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stamps.size(); ++i)
    if (is_stated(stamps.s[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps.s[a] < stamps.s[b]; });
  const double period_s = period_of(stamps.s).value_or(1.0 / kNominalRate_hz);
  std::size_t spread = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    const double stamp_s = stamps.s[order[begin]];
    while (end < order.size() && stamps.s[order[end]] == stamp_s) ++end;
    const double count = static_cast<double>(end - begin);
    const double next_s = end < order.size() ? stamps.s[order[end]] : stamp_s + period_s * count;
    const double step_s = std::min((next_s - stamp_s) / count, period_s);
    for (std::size_t k = begin + 1; k < end; ++k, ++spread)
      stamps.s[order[k]] = stamp_s + static_cast<double>(k - begin) * step_s;
    begin = end;
  }
  if (spread > 0)
    stamps.say(spread, images_have(spread, stamps.rules.what) +
                           " the stamp of another one; equal stamps are spread evenly up to the next");
}

template <typename Stamped>
double repair_any_track(std::vector<Stamped>& track, const RepairedStamps& images) {
  if (track.empty()) return 1.0;
  std::vector<double> image_s;
  std::copy_if(images.stamps_s.begin(), images.stamps_s.end(), std::back_inserter(image_s), is_stated);
  if (image_s.empty()) return 1.0;
  const auto range = std::minmax_element(image_s.begin(), image_s.end());
  const double least_s = *range.first, most_s = *range.second;
  const auto overlap = [&](double unit_s) {
    return std::count_if(track.begin(), track.end(), [&](const Stamped& each) {
      return each.stamp_s * unit_s >= least_s - 1.0 && each.stamp_s * unit_s <= most_s + 1.0;
    });
  };
  const auto by_stamp = [](const Stamped& a, const Stamped& b) { return a.stamp_s < b.stamp_s; };
  const auto ends = std::minmax_element(track.begin(), track.end(), by_stamp);
  const double track_length = ends.second->stamp_s - ends.first->stamp_s;
  double unit_s = 1.0;
  if (images.unit_s != 1.0 && overlap(images.unit_s) > overlap(1.0)) unit_s = images.unit_s;
  if (overlap(unit_s) == 0)
    for (const double other_s : {1e-3, 1e-6, 1e-9})
      if (overlap(other_s) > 0 && track_length * other_s > 0.2 * (most_s - least_s)) unit_s = other_s;
  if (unit_s != 1.0) {
    const double divisor = std::round(1.0 / unit_s);
    for (Stamped& each : track) each.stamp_s = unit_s < 1.0 ? each.stamp_s / divisor : each.stamp_s * unit_s;
  }
  if (!images.stretches.empty()) {
    // The track's clock is the images': its parts begin where its stamps decrease.
    std::vector<std::size_t> begins;
    for (std::size_t i = 1; i < track.size(); ++i)
      if (track[i].stamp_s < track[i - 1].stamp_s) begins.push_back(i);
    if (begins.size() == images.stretches.size())
      for (std::size_t run = 0; run < begins.size(); ++run) {
        const std::size_t end = run + 1 < begins.size() ? begins[run + 1] : track.size();
        for (std::size_t i = begins[run]; i < end; ++i) track[i].stamp_s += images.stretches[run].shift_s;
      }
  }
  sort_by_stamp(track);
  return unit_s;
}

}  // namespace

RepairedStamps repair_stamps(const std::vector<StatedTime>& times, const StampRules& rules,
                             InputReport& report) {
  Stamps stamps{times, rules, report};
  for (const StatedTime& each : times) stamps.s.push_back(each.stamp_s);
  const bool received = has_reception(times);
  const auto use_numbers = [&] {
    for (std::size_t i = 0; i < stamps.size(); ++i) stamps.s[i] = static_cast<double>(i) / kNominalRate_hz;
  };
  if (rules.choice == StampChoice::kIndex) {
    use_numbers();
    return std::move(stamps.result);
  }
  if (rules.choice == StampChoice::kReception && received) {
    for (std::size_t i = 0; i < stamps.size(); ++i) stamps.s[i] = times[i].received_s;
    spread_equal(stamps);
    return std::move(stamps.result);
  }
  remove_zeros(stamps, received);
  find_unit(stamps, received);
  if (received) {
    repair_by_reception(stamps);
  } else if (std::none_of(stamps.s.begin(), stamps.s.end(), is_stated)) {
    use_numbers();
    if (stamps.size() > 1)
      stamps.say(stamps.size(),
                 "the " + rules.what + " have no time stamps; 30 images per second are assumed");
    return std::move(stamps.result);
  } else {
    remove_absurd(stamps);
    undo_clock_changes(stamps);
    interpolate(stamps);
  }
  spread_equal(stamps);
  return std::move(stamps.result);
}

double repair_track(std::vector<StampedPose>& track, const RepairedStamps& images) {
  return repair_any_track(track, images);
}
double repair_track(std::vector<StampedAcceleration>& track, const RepairedStamps& images) {
  return repair_any_track(track, images);
}

}  // namespace roomradar
