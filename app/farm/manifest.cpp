// manifest.cpp: splits lines into words, and words into text and placeholders.
#include "app/farm/manifest.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kLargestManifest_bytes = 256U << 20U;
constexpr std::size_t kMostJobs = 1'000'000;
constexpr std::size_t kLongestName = 100;
constexpr std::string_view kBlanks = " \t\r";
constexpr std::array<std::string_view, 9> kCommands = {
    "building-step", "calibrate", "fallthrough", "map", "prescan", "record", "run", "simulate", "trade"};

[[noreturn]] void fail(const std::filesystem::path& path, int line, const std::string& fault) {
  throw Error(path.string() + ", line " + std::to_string(line) + ": " + fault);
}

/// Returns nullopt if a quote is not closed.
std::optional<std::vector<std::string>> words_of(std::string_view text) {
  std::vector<std::string> words;
  bool is_open = false;  // the last word goes on
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (kBlanks.find(c) != std::string_view::npos) {
      is_open = false;
      continue;
    }
    if (!is_open) words.emplace_back();
    is_open = true;
    if (c != '\'' && c != '"') {
      words.back() += c;
      continue;
    }
    const std::size_t end = text.find(c, at + 1);
    if (end == std::string_view::npos) return std::nullopt;
    words.back() += text.substr(at + 1, end - at - 1);
    at = end;
  }
  return words;
}

/// Splits "NAME (cost NUMBER)" into both.
void read_head(std::string_view head, Job& job, const std::filesystem::path& path) {
  const std::size_t bracket = head.find('(');
  job.name = trimmed(head.substr(0, bracket));
  if (!is_job_name(job.name))
    fail(path, job.line,
         "must begin with a name and a colon, such as `kitchen: prescan ...`; a name has letters, digits, - "
         "_ . and at most " +
             std::to_string(kLongestName) + " characters");
  if (bracket == std::string_view::npos) return;
  std::string_view cost = trimmed(head.substr(bracket + 1));
  const bool is_cost = cost.starts_with("cost ") && cost.ends_with(")");
  const auto value =
      is_cost ? parse_number(trimmed(cost.substr(5, cost.size() - 6))) : std::optional<double>();
  if (!value || !(*value > 0.0) || !(*value < 1e300))
    fail(path, job.line, "after the name, only (cost NUMBER) is allowed, with a number above 0");
  job.cost = *value;
}

/// Finds the jobs whose folders each job reads.
void find_needs(Manifest& manifest) {
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < manifest.jobs.size(); ++i)
    if (!index.emplace(manifest.jobs[i].name, i).second)
      fail(manifest.path, manifest.jobs[i].line,
           "the name '" + manifest.jobs[i].name + "' is that of an earlier job");
  for (std::size_t i = 0; i < manifest.jobs.size(); ++i) {
    Job& job = manifest.jobs[i];
    bool writes = false;
    std::set<std::size_t> needs;
    for (const std::string& word : job.words)
      for (const WordPart& part : parts_of(word)) {
        if (!part.is_folder) continue;
        if (part.text.empty()) {
          writes = true;
          continue;
        }
        const auto found = index.find(part.text);
        if (found == index.end())
          fail(manifest.path, job.line, "{" + part.text + "} is not the name of a job");
        if (found->second == i) fail(manifest.path, job.line, "the job's own folder is {}");
        needs.insert(found->second);
      }
    if (!writes)
      fail(manifest.path, job.line,
           "no word has {}, the job's folder, so nothing is kept; write for instance --map {}/map");
    job.needs.assign(needs.begin(), needs.end());
  }
}

/// Throws if jobs need each other in a circle: takes away jobs whose needs are all gone, until none is left.
void refuse_circles(const Manifest& manifest) {
  std::vector<std::size_t> open(manifest.jobs.size());
  std::vector<std::vector<std::size_t>> needed_by(manifest.jobs.size());
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < manifest.jobs.size(); ++i) {
    open[i] = manifest.jobs[i].needs.size();
    for (const std::size_t need : manifest.jobs[i].needs) needed_by[need].push_back(i);
    if (open[i] == 0) free.push_back(i);
  }
  std::size_t done = 0;
  for (; done < free.size(); ++done)
    for (const std::size_t next : needed_by[free[done]])
      if (--open[next] == 0) free.push_back(next);
  if (done == manifest.jobs.size()) return;
  const auto stuck = std::find_if(open.begin(), open.end(), [](std::size_t count) { return count > 0; });
  const Job& job = manifest.jobs[static_cast<std::size_t>(stuck - open.begin())];
  fail(manifest.path, job.line, "the job '" + job.name + "' and those that it needs wait for each other");
}

}  // namespace

std::string quoted_word(const std::string& word) {
  const char quote = word.find('\'') == std::string::npos ? '\'' : '"';
  if (word.find(quote) != std::string::npos || word.find('\n') != std::string::npos)
    throw Error("'" + word + "': a name with both kinds of quotes, or a line end, cannot be handed to a job");
  return quote + word + quote;
}

std::string quoted_literal(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
  return quoted_word(escaped);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

bool is_job_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' && name.front() != '-' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") ==
             std::string_view::npos;
}

std::vector<WordPart> parts_of(const std::string& word) {
  std::vector<WordPart> parts;
  const auto add = [&](char c) {
    if (parts.empty() || parts.back().is_folder) parts.push_back({false, {}});
    parts.back().text += c;
  };
  for (std::size_t at = 0; at < word.size(); ++at) {
    const char c = word[at];
    const bool is_doubled = at + 1 < word.size() && word[at + 1] == c;
    if ((c == '{' || c == '}') && is_doubled) {
      add(c);
      ++at;
      continue;
    }
    const std::size_t end = c == '{' ? word.find('}', at) : std::string::npos;
    if (end == std::string::npos) {
      add(c);
      continue;
    }
    parts.push_back({true, word.substr(at + 1, end - at - 1)});
    at = end;
  }
  return parts;
}

Manifest parse_manifest(const std::string& text, const std::filesystem::path& path) {
  Manifest manifest{path, {}};
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    Job job{.name = {}, .words = {}, .needs = {}, .line = ++number};
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    if (manifest.jobs.size() == kMostJobs) fail(path, number, "there are more than a million jobs");
    const std::size_t colon = content.find(':');
    read_head(content.substr(0, colon == std::string_view::npos ? 0 : colon), job, path);
    auto words = words_of(content.substr(colon + 1));
    if (!words) fail(path, number, "a quotation mark is not closed");
    job.words = std::move(*words);
    if (job.words.empty() ||
        std::find(kCommands.begin(), kCommands.end(), job.words.front()) == kCommands.end())
      fail(path, number,
           "'" + (job.words.empty() ? std::string() : job.words.front()) +
               "' is not a command that can be a job, such as prescan, run, map or fallthrough");
    manifest.jobs.push_back(std::move(job));
  }
  if (manifest.jobs.empty())
    throw Error(path.string() +
                ": contains no jobs; write lines such as `kitchen: prescan recordings/kitchen --map {}/map`");
  find_needs(manifest);
  refuse_circles(manifest);
  return manifest;
}

Manifest read_manifest(const std::filesystem::path& path) {
  const std::string text = read_bytes(path, "a list of jobs", kLargestManifest_bytes);
  return parse_manifest(text, std::filesystem::absolute(path));
}

}  // namespace roomradar
