// knob.cpp: settings in words.
#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

Setting usual_setting(const std::vector<Knob>& knobs) {
  Setting setting;
  for (const Knob& knob : knobs) setting.push_back(knob.usual);
  return setting;
}

bool has_usual_load(const std::vector<Knob>& knobs, const Setting& setting) {
  for (std::size_t i = 0; i < knobs.size(); ++i)
    if (knobs[i].is_load && setting[i] != knobs[i].usual) return false;
  return true;
}

std::string describe(const std::vector<Knob>& knobs, const Setting& setting) {
  std::string text;
  for (std::size_t i = 0; i < knobs.size(); ++i)
    if (setting[i] != knobs[i].usual)
      text += (text.empty() ? "" : ", ") + knobs[i].name + " " + knobs[i].words[setting[i]];
  return text.empty() ? "default" : text;
}

}  // namespace roomradar
