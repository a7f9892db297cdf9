// script_line.hpp: reads the words and numbers of one line of a script.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// Keyword of a script, and its value.
template <typename Value>
struct Word {
  std::string_view word;
  Value value;
};

/// Returns the keywords as a list such as "add, place or drop".
template <typename Value, std::size_t kCount>
std::string listed(const std::array<Word<Value>, kCount>& words) {
  std::string list;
  for (std::size_t i = 0; i < kCount; ++i)
    list.append(i == 0 ? "" : i + 1 == kCount ? " or " : ", ").append(words[i].word);
  return list;
}

/// Returns the keyword of a value; empty if the value has none.
template <typename Value, std::size_t kCount>
std::string_view word_of(const std::array<Word<Value>, kCount>& words, Value value) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& word) { return word.value == value; });
  return found == words.end() ? std::string_view{} : found->word;
}

std::string in_quotes(std::string_view text);

/// Reads the words of one line, separated by spaces or tabs, in order. Error messages contain the file's name
/// and the line number.
class LineReader {
 public:
  /// @param where  name of the file, for error messages. `text` and `where` must outlive the reader
  LineReader(std::string_view text, std::string_view where, int line);
  [[nodiscard]] bool done() const { return next_ == words_.size(); }

  /// Throws Error "FILE:LINE: complaint".
  [[noreturn]] void fail(const std::string& complaint) const;
  /// Returns the next word. Throws Error if the line has ended; `wanted` describes the expected word in the
  /// message.
  std::string_view word(const char* wanted);
  /// Consumes the next word and returns true if it equals `expected`; else returns false.
  bool take_if(std::string_view expected);
  void expect(std::string_view expected);
  /// Reads a finite number in lowest..highest.
  double number(const char* wanted, double lowest, double highest);
  double whole_number(const char* wanted, double lowest, double highest);
  /// Returns the value of the next word. Throws Error if the word is not in `words`.
  template <typename Value, std::size_t kCount>
  Value choice(const char* wanted, const std::array<Word<Value>, kCount>& words) {
    const std::string list = listed(words);
    const std::string_view found = word((std::string(wanted) + ": " + list).c_str());
    for (const Word<Value>& candidate : words)
      if (candidate.word == found) return candidate.value;
    fail("unknown word " + in_quotes(found) + "; expected " + wanted + ": " + list);
  }
  /// Reads three numbers, each in -limit..limit.
  Eigen::Vector3d vector(const char* wanted, double limit);
  void expect_end() const;

 private:
  std::string_view where_;
  int line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

}  // namespace roomradar
