// measured_work.cpp: settings as words, and figures by name.
#include "app/evaluation/pareto/measured_work.hpp"

#include <algorithm>
#include <sstream>

#include "mapping/types/system/error.hpp"

namespace roomradar {

Setting default_setting(const std::vector<Parameter>& parameters) {
  Setting setting;
  for (const Parameter& parameter : parameters) setting.push_back(parameter.defaults);
  return setting;
}

bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].is_load && setting[i] != parameters[i].defaults) return false;
  return true;
}

std::string describe(const std::vector<Parameter>& parameters, const Setting& setting) {
  std::string text;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (setting[i] != parameters[i].defaults)
      text += (text.empty() ? "" : ", ") + parameters[i].name + " " + parameters[i].words[setting[i]];
  return text.empty() ? "default" : text;
}

std::string setting_words(const std::vector<Parameter>& parameters, const Setting& setting) {
  std::string words;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (setting[i] != parameters[i].defaults)
      words += (words.empty() ? "" : ",") + parameters[i].name + "=" + parameters[i].words[setting[i]];
  return words.empty() ? "default" : words;
}

Setting setting_from(const std::vector<Parameter>& parameters, const std::string& words) {
  Setting setting = default_setting(parameters);
  if (words == "default") return setting;
  std::vector<bool> is_given(parameters.size());
  std::istringstream parts(words + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    const std::string name = part.substr(0, part.find('='));
    const auto parameter = std::find_if(parameters.begin(), parameters.end(),
                                        [&](const Parameter& one) { return one.name == name; });
    if (parameter == parameters.end() || name.size() == part.size())
      throw Error("setting " + words + ": '" + part + "' is not a parameter and a value, such as " +
                  parameters.front().name + "=" + parameters.front().words.front());
    const auto at = static_cast<std::size_t>(parameter - parameters.begin());
    const std::vector<std::string>& values = parameter->words;
    const auto value = std::find(values.begin(), values.end(), part.substr(name.size() + 1));
    if (value == values.end()) {
      std::string known;
      for (const std::string& one : values) known += (known.empty() ? "" : ", ") + one;
      throw Error("setting " + words + ": " + part + ": the values that are measured are " + known);
    }
    if (is_given[at]) throw Error("setting " + words + ": " + name + " is given twice");
    is_given[at] = true;
    setting[at] = static_cast<std::size_t>(value - values.begin());
  }
  return setting;
}

std::size_t place_of(const MeasuredWork& work, const std::string& figure) {
  for (std::size_t i = 0; i < work.figures.size(); ++i)
    if (work.figures[i].name == figure) return i;
  throw Error(work.name + ": nothing called " + figure + " is measured");
}

}  // namespace roomradar
