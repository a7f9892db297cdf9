// help_topics.hpp: texts of `roomradar help TOPIC`, which are also sections of the manual page.
#pragma once
#include <span>
#include <string_view>

namespace roomradar {

struct HelpTopic {
  std::string_view name;     ///< word after `roomradar help`
  std::string_view summary;  ///< line in the list of topics
  std::string_view text;     ///< plain text with lines of at most 116 characters; ends with a newline
};

/// Returns all topics: script, models, sources, units, calibrate, http, files.
std::span<const HelpTopic> help_topics();

}  // namespace roomradar
