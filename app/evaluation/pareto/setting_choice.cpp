// setting_choice.cpp: random settings, and greedy search by gain per cost.
#include "app/evaluation/pareto/setting_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "app/evaluation/pareto/choose_presets.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

std::vector<std::size_t> shuffled(std::size_t count, CounterRandom& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  return order;
}

std::vector<Setting> single_turns(const std::vector<Parameter>& parameters, CounterRandom& random) {
  std::vector<Setting> turns;
  const Setting defaults = default_setting(parameters);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    for (std::size_t word = 0; word < parameters[k].words.size(); ++word) {
      if (word == parameters[k].defaults) continue;
      turns.push_back(defaults);
      turns.back()[k] = word;
    }
  }
  std::vector<Setting> mixed;
  for (const std::size_t i : shuffled(turns.size(), random)) mixed.push_back(turns[i]);
  return mixed;
}

/// Returns combinations, of which number i of n is about as slow as i / n. Each parameter's values are
/// assigned in the order of i / n plus a random disturbance.
std::vector<Setting> mixtures(const std::vector<Parameter>& parameters, std::size_t count,
                              CounterRandom& random) {
  constexpr double kDisturbance = 0.35;  // max, as a fraction of the scale, in both directions
  std::vector<Setting> settings(count, default_setting(parameters));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].is_load) continue;
    std::vector<std::pair<double, std::size_t>> slowness;
    for (std::size_t i = 0; i < count; ++i)
      slowness.emplace_back(
          static_cast<double>(i) / static_cast<double>(count) + random.uniform(-kDisturbance, kDisturbance),
          i);
    std::sort(slowness.begin(), slowness.end());
    for (std::size_t rank = 0; rank < count; ++rank)
      settings[slowness[rank].second][k] = rank * parameters[k].words.size() / count;
  }
  return settings;
}

struct Turn {
  std::size_t parameter, word;
  double price;
};

/// Returns the parameter in which a setting differs from the default, if it is the only one and not a load.
std::optional<std::size_t> changed_parameter(const std::vector<Parameter>& parameters,
                                             const Setting& setting) {
  std::optional<std::size_t> turned;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (setting[k] == parameters[k].defaults) continue;
    if (turned || parameters[k].is_load) return std::nullopt;
    turned = k;
  }
  return turned;
}

/// Applies the changes cumulatively to the default; skips those that would move a parameter back.
std::vector<Setting> steps_of(std::vector<Turn> turns, const Setting& defaults) {
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Turn& a, const Turn& b) { return a.price < b.price; });
  std::vector<Setting> steps;
  Setting setting = defaults;
  for (const Turn& turn : turns) {
    const auto turned =
        static_cast<std::ptrdiff_t>(turn.word) - static_cast<std::ptrdiff_t>(defaults[turn.parameter]);
    const auto already = static_cast<std::ptrdiff_t>(setting[turn.parameter]) -
                         static_cast<std::ptrdiff_t>(defaults[turn.parameter]);
    if (std::abs(turned) <= std::abs(already)) continue;
    setting[turn.parameter] = turn.word;
    steps.push_back(setting);
  }
  return steps;
}

}  // namespace

std::vector<Setting> draw_settings(const std::vector<Parameter>& parameters, std::size_t count,
                                   std::uint64_t seed) {
  constexpr int kRounds = 20;  // attempts to draw enough new combinations
  CounterRandom random(seed, 0);
  std::vector<Setting> settings = single_turns(parameters, random);
  const Setting defaults = default_setting(parameters);
  const auto is_later = [&](const Setting& turn) {
    return !has_default_load(parameters, turn) || defaults < turn;
  };
  const auto words_away = [&](const Setting& turn) {
    std::size_t away = 0;
    for (std::size_t k = 0; k < turn.size(); ++k)
      away += turn[k] < defaults[k] ? defaults[k] - turn[k] : turn[k] - defaults[k];
    return away;
  };
  std::stable_sort(settings.begin(), settings.end(), [&](const Setting& a, const Setting& b) {
    return std::pair(is_later(a), words_away(a)) < std::pair(is_later(b), words_away(b));
  });
  settings.resize(std::min(settings.size(), 2 * count / 3));
  const std::size_t wanted = count - settings.size();
  for (int round = 0; round < kRounds && settings.size() < count; ++round) {
    for (Setting& mixture : mixtures(parameters, wanted, random)) {
      const bool is_new =
          mixture != defaults && std::find(settings.begin(), settings.end(), mixture) == settings.end();
      if (is_new && settings.size() < count) settings.push_back(std::move(mixture));
    }
  }
  std::vector<Setting> in_random_order;
  for (const std::size_t i : shuffled(settings.size(), random)) in_random_order.push_back(settings[i]);
  return in_random_order;
}

std::vector<Setting> greedy_settings(const MeasuredWork& work, const std::vector<SettingSummary>& summaries,
                                     std::size_t defaults, std::size_t count) {
  constexpr double kLeastSaved = 0.005, kLeastGained = 0.002;  // log ratios; less is noise
  std::vector<Turn> faster, better;
  for (const SettingSummary& summary : summaries) {
    const std::optional<std::size_t> parameter = changed_parameter(work.parameters, summary.setting);
    const double saved = -std::log(summary.time_ratio);
    const double lost = std::log(loss_of(work, summary, summaries[defaults]));
    if (!parameter || !summary.is_complete || !std::isfinite(saved) || !std::isfinite(lost)) continue;
    const std::size_t word = summary.setting[*parameter];
    if (saved > kLeastSaved && word < work.parameters[*parameter].defaults)
      faster.push_back({*parameter, word, std::max(lost, 0.0) / saved});
    if (lost < -kLeastGained && word > work.parameters[*parameter].defaults)
      better.push_back({*parameter, word, std::max(-saved, 0.0) / -lost});
  }
  std::vector<Setting> steps = steps_of(std::move(better), summaries[defaults].setting);
  std::reverse(steps.begin(), steps.end());
  for (Setting& step : steps_of(std::move(faster), summaries[defaults].setting))
    steps.push_back(std::move(step));
  std::erase_if(steps, [&](const Setting& step) {
    return std::any_of(summaries.begin(), summaries.end(),
                       [&](const SettingSummary& summary) { return summary.setting == step; });
  });
  if (steps.size() <= count) return steps;
  std::vector<Setting> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(steps[count == 1 ? steps.size() - 1 : i * (steps.size() - 1) / (count - 1)]);
  return chosen;
}

}  // namespace roomradar
