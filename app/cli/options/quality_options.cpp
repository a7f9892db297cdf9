// quality_options.cpp: one option per field of a quality; presets.
#include "app/cli/options/quality_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"
#include "app/quality/presets.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

/// Returns the value's word, of numbers with a fraction three digits of it.
template <typename Value>
std::string word_in_help(const Value& value) {
  if constexpr (std::is_same_v<Value, double>)
    return format_readable(value, 3);
  else
    return word_of(value);
}

template <typename Quality>
void add_field_options(CLI::App& command, FieldWords& fixed) {
  const Quality defaults;
  visit_fields(defaults, [&](const QualityField& field, const auto& value) {
    command
        .add_option_function<std::string>(
            field.option,
            [&fixed, field](const std::string& word) {
              try {
                Quality scratch;
                set_field(scratch, field.name, word);
              } catch (const Error& error) {
                const std::string fault = error.what();  // "field = word: must be ...": the option says both
                throw CLI::ValidationError(std::string(field.option) + " " + word,
                                           fault.substr(std::min(fault.find("must be"), fault.size() - 1)));
              }
              fixed.emplace_back(field.name, word);
            },
            with_default(field.help, word_in_help(value)))
        ->type_name(field.unit);
  });
}

Preset read_preset(const std::string& name, const std::string& presets) {
  const std::filesystem::path path = presets_file(presets);
  return preset_named(read_presets(path), name, path.string());
}

}  // namespace

void add_scan_quality_options(CLI::App& command, FieldWords& fixed) {
  add_field_options<ScanQuality>(command, fixed);
}
void add_run_quality_options(CLI::App& command, FieldWords& fixed) {
  add_field_options<RunQuality>(command, fixed);
}

void add_preset_options(CLI::App& command, std::string& preset, std::string& presets) {
  command
      .add_option("--preset", preset,
                  "measured settings: fast, balanced or accurate; settings given by their own options take\n"
                  "precedence (default: none)")
      ->type_name("NAME");
  command
      .add_option("--presets", presets,
                  "presets file, as written by `roomradar trade` (default: the program's own)")
      ->type_name("FILE");
}

void complete_quality(ScanQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed) {
  if (!preset.empty()) quality = read_preset(preset, presets).scan;
  set_fields(quality, fixed);
}
void complete_quality(RunQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed) {
  if (!preset.empty()) quality = read_preset(preset, presets).run;
  set_fields(quality, fixed);
}

}  // namespace roomradar
