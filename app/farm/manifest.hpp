// manifest.hpp: a list of jobs, each an ordinary command of roomradar.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// A command of roomradar that writes its results to its own folder.
struct Job {
  std::string name;                ///< also the name of the folder
  double cost = 0.0;               ///< as stated in the manifest; 0: not stated, see PlannedJob::cost
  std::vector<std::string> words;  ///< command and arguments; placeholders are not replaced
  std::vector<std::size_t> needs;  ///< indices of the jobs whose folders this job reads; ascending
  int line = 0;                    ///< 1-based line number in the manifest
};

struct Manifest {
  std::filesystem::path path;  ///< absolute if from read_manifest()
  std::vector<Job> jobs;
};

/// Reads a manifest with one job per line:
///
///     # two scans, and what changed between them
///     morning: prescan recordings/morning --map {}/map
///     evening (cost 2): prescan recordings/evening --map {}/map
///     change: map diff {morning}/map {evening}/map --html {}/change.html
///
/// {} stands for the job's own folder, and {NAME} for the folder of another job, which is run first. Words
/// are separated by spaces or tabs; words in '...' or "..." may contain them. A word without placeholders is
/// an input if it names an existing file or folder, relative to the manifest's folder. The same holds for the
/// VALUE in --option=VALUE. Empty lines and lines that begin with # are ignored.
///
/// @throws Error with file and fault if the file cannot be read or has no jobs; also with the line if a line
///         is malformed, a name is duplicate or unknown, dependencies are cyclic, or no word of a job
///         contains {}
Manifest read_manifest(const std::filesystem::path& path);

/// Parses the text of a manifest; see read_manifest().
/// @param path  for messages, and as Manifest::path
Manifest parse_manifest(const std::string& text, const std::filesystem::path& path);

/// Returns a word in quotation marks for a manifest. Placeholders remain placeholders. Throws Error if the
/// word contains both kinds of quotation marks, or a newline.
std::string quoted_word(const std::string& word);
/// Quotes text in which { and } are literal: doubles both, then quotes as quoted_word() does.
std::string quoted_literal(const std::string& text);

/// Returns true for a valid job name: 1 to 100 ASCII letters, digits, '-', '_' or '.', not starting with '.'
/// or '-'.
bool is_job_name(std::string_view name);

/// Returns the text without leading and trailing spaces, tabs and carriage returns.
std::string_view trimmed(std::string_view text);

/// A part of a word: text, or a placeholder.
struct WordPart {
  bool is_folder = false;  ///< true: a placeholder; `text` is a job's name, empty for the job itself
  std::string text;
};
/// Splits a word at its placeholders. {{ and }} stand for { and }.
std::vector<WordPart> parts_of(const std::string& word);

}  // namespace roomradar
