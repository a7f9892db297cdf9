// quality.cpp: validates qualities, and converts their fields to and from words.
#include "app/quality/quality.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <system_error>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
std::string word_of(double value) { return format_number(value); }
std::string word_of(int value) { return format_number(value); }
std::string word_of(bool value) { return value ? "on" : "off"; }
std::string word_of(RadarMode value) { return std::string(to_string(value)); }

namespace {

template <typename Number>
bool read(std::string_view word, Number& value) {
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  return fault == std::errc{} && end == word.data() + word.size();
}
bool read(std::string_view word, bool& value) {
  value = word == "on";
  return value || word == "off";
}
bool read(std::string_view word, RadarMode& value) {
  const std::optional<RadarMode> mode = radar_mode_of(word);
  value = mode.value_or(value);
  return mode.has_value();
}

bool is_within(const QualityField& field, double value) { return value >= field.low && value <= field.high; }
bool is_within(const QualityField& /*field*/, bool /*value*/) { return true; }
bool is_within(const QualityField& /*field*/, RadarMode /*value*/) { return true; }
bool is_within(const QualityField& field, int value) {
  const bool is_stride = std::string_view(field.name) == "depth_stride";
  return is_within(field, static_cast<double>(value)) && !(is_stride && value == 3);
}

[[noreturn]] void fail(const QualityField& field, std::string_view word) {
  std::string rule = words_of_choice(field.unit);
  if (rule == field.unit) {
    std::array<char, 64> range{};
    format_classic(range.data(), range.size(), "between %.10g and %.10g%s", field.low, field.high,
                   std::string_view(field.unit) == "M" ? " m" : "");
    rule = range.data();
  }
  throw Error(std::string(field.name) + " = " + std::string(word) + ": must be " + rule);
}

template <typename Quality>
void require_valid_fields(const Quality& quality) {
  visit_fields(quality, [](const QualityField& field, const auto& value) {
    if (!is_within(field, value)) fail(field, word_of(value));
  });
}

template <typename Quality>
void set_field_of(Quality& quality, std::string_view name, std::string_view word) {
  std::string names;
  bool is_known = false;
  visit_fields(quality, [&](const QualityField& field, auto& value) {
    names.append(names.empty() ? "" : ", ").append(field.name);
    if (name != field.name && (name.empty() || name != field.old_name)) return;
    is_known = true;
    auto read_value = value;
    if (!read(word, read_value) || !is_within(field, read_value)) fail(field, word);
    value = read_value;
  });
  if (!is_known) throw Error("there is no setting \"" + std::string(name) + "\"; the settings are " + names);
}

template <typename Quality>
FieldWords words_of_fields(const Quality& quality, const Quality& defaults) {
  std::vector<std::string> default_words;
  visit_fields(defaults, [&](const QualityField& /*field*/, const auto& value) {
    default_words.push_back(word_of(value));
  });
  FieldWords words;
  std::size_t i = 0;
  visit_fields(quality, [&](const QualityField& field, const auto& value) {
    std::string word = word_of(value);
    if (word != default_words[i++]) words.emplace_back(field.name, std::move(word));
  });
  return words;
}

}  // namespace

std::string words_of_choice(std::string_view type) {
  std::string words;
  const std::size_t last = type.rfind('|');
  for (std::size_t i = 0; i < type.size(); ++i)
    words += type[i] != '|' ? std::string(1, type[i]) : i == last ? " or " : ", ";
  return words;
}

void require_valid(const ScanQuality& quality) { require_valid_fields(quality); }
void require_valid(const RunQuality& quality) { require_valid_fields(quality); }

void set_field(ScanQuality& quality, std::string_view name, std::string_view word) {
  set_field_of(quality, name, word);
}
void set_field(RunQuality& quality, std::string_view name, std::string_view word) {
  set_field_of(quality, name, word);
}

FieldWords words_of(const ScanQuality& quality, const ScanQuality& defaults) {
  return words_of_fields(quality, defaults);
}
FieldWords words_of(const RunQuality& quality, const RunQuality& defaults) {
  return words_of_fields(quality, defaults);
}

}  // namespace roomradar
