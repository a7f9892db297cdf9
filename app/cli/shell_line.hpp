// shell_line.hpp: command lines as a shell takes them.
#pragma once
#include <string>
#include <vector>

namespace roomradar {

/// Returns the words as one line that a shell splits into these words again: words with blanks, quotes and
/// other special characters are quoted.
[[nodiscard]] std::string shell_line(const std::vector<std::string>& words);

/// Returns the words without an option that takes a value ("--name VALUE", "--name=VALUE").
[[nodiscard]] std::vector<std::string> without_option(std::vector<std::string> words,
                                                      const std::string& name);

}  // namespace roomradar
