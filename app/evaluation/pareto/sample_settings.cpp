// sample_settings.cpp: single changes, and combinations with correlated ranks.
#include "app/evaluation/pareto/sample_settings.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

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

}  // namespace roomradar
