// shell_line.cpp: single quotes, in which a shell takes every character but the quote as it is.
#include "app/cli/shell_line.hpp"

#include <algorithm>
#include <string_view>

namespace roomradar {
namespace {

std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
      "_-./:,=@%+";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted(word);
  return line;
}

std::vector<std::string> without_option(std::vector<std::string> words, const std::string& name) {
  for (auto word = words.begin(); word != words.end();) {
    if (*word == name)
      word = words.erase(word, std::min(word + 2, words.end()));
    else if (word->starts_with(name + "="))
      word = words.erase(word);
    else
      ++word;
  }
  return words;
}

}  // namespace roomradar
