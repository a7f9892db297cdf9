// input_report.cpp: collects decisions and counts.
#include "app/sources/formats/input_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace roomradar {

void InputReport::add(InputDecision decision) {
  const std::scoped_lock lock(mutex_);
  added_.push_back(std::move(decision));
}

void InputReport::count(const std::string& topic, const std::string& what, std::int64_t frame,
                        const std::string& fault) {
  const std::scoped_lock lock(mutex_);
  auto counted = std::find_if(counted_.begin(), counted_.end(),
                              [&](const Counted& each) { return each.topic == topic && each.what == what; });
  if (counted == counted_.end()) counted = counted_.insert(counted_.end(), {topic, what, fault, {}});
  const auto place = std::lower_bound(counted->frames.begin(), counted->frames.end(), frame);
  if (place == counted->frames.end() || *place != frame) counted->frames.insert(place, frame);
}

std::vector<InputDecision> InputReport::decisions() const {
  const std::scoped_lock lock(mutex_);
  std::vector<InputDecision> all = added_;
  for (const Counted& counted : counted_) {
    std::string sentence = counted.what;
    const std::size_t place = sentence.find('%');
    if (place != std::string::npos) sentence.replace(place, 1, std::to_string(counted.frames.size()));
    const std::string which = counted.frames.size() == 1 ? "frame " : "the first: frame ";
    sentence += " (" + which + std::to_string(counted.frames.front()) +
                (counted.first_fault.empty() ? "" : ", " + counted.first_fault) + ")";
    all.push_back({counted.topic, sentence, static_cast<std::int64_t>(counted.frames.size())});
  }
  return all;
}

std::string line_of(const InputDecision& decision) {
  return decision.sentence + (decision.option.empty() ? "" : " [" + decision.option + "]");
}

nlohmann::json to_json(const std::vector<InputDecision>& decisions) {
  nlohmann::json array = nlohmann::json::array();
  for (const InputDecision& decision : decisions)
    array.push_back({{"topic", decision.topic},
                     {"sentence", decision.sentence},
                     {"count", decision.count},
                     {"option", decision.option},
                     {"advice", decision.is_advice}});
  return array;
}

}  // namespace roomradar
