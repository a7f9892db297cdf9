// farm_plan.cpp: keys of jobs in the order in which they need each other.
#include "app/farm/farm_plan.hpp"

#include <algorithm>
#include <utility>

#include "app/farm/content_hashes.hpp"
#include "app/farm/job_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

bool has_placeholder(const std::string& word) {
  const std::vector<WordPart> parts = parts_of(word);
  return std::any_of(parts.begin(), parts.end(), [](const WordPart& part) { return part.is_folder; });
}

/// Splits "--option=value" after the equals sign, other words before their first letter.
std::size_t value_at(const std::string& word) {
  const std::size_t sign = word.find('=');
  return word.starts_with("--") && sign != std::string::npos ? sign + 1 : 0;
}

/// Returns the file or folder that a word names; nullopt if it names none.
std::optional<fs::path> input_of(const Manifest& manifest, const std::string& word) {
  if (has_placeholder(word)) return std::nullopt;
  const fs::path path = manifest.path.parent_path() / word.substr(value_at(word));
  std::error_code ignored;
  if (word.size() == value_at(word) || !fs::exists(path, ignored)) return std::nullopt;
  return path;
}

void add(std::string& text, const std::string& item) {
  text += std::to_string(item.size()) + ":" + item + "\n";
}

void plan_job(std::size_t job, ContentHashes& hashes, FarmPlan& plan) {
  const Job& stated = plan.manifest.jobs[job];
  PlannedJob& planned = plan.jobs[job];
  const std::uintmax_t before = hashes.bytes();
  std::string text = "roomradar job 2\n";  // to be increased when a command writes other files
  add(text, kVersion);
  for (const std::string& word : stated.words) {
    add(text, word);
    if (const auto input = input_of(plan.manifest, word)) add(text, hashes.of(*input));
  }
  for (const std::size_t need : stated.needs) add(text, plan.jobs[need].key);
  planned.key = sha256_of(text);
  planned.cost = stated.cost > 0.0 ? stated.cost : 1.0 + 1e-6 * static_cast<double>(hashes.bytes() - before);
  planned.is_present = is_done(plan.out / stated.name, planned.key);
}

}  // namespace

FarmPlan plan_farm(Manifest manifest, const fs::path& out, std::span<const std::size_t> wanted) {
  FarmPlan plan{std::move(manifest), fs::absolute(out).lexically_normal(), {}};
  make_folder(plan.out);
  plan.jobs.resize(plan.manifest.jobs.size());
  ContentHashes hashes(plan.out / "inputs.sha256");
  std::vector<std::size_t> open(wanted.begin(), wanted.end());
  if (wanted.empty())
    for (std::size_t i = plan.jobs.size(); i-- > 0;) open.push_back(i);
  while (!open.empty()) {  // a stack: a job comes after those that it needs
    const std::size_t job = open.back();
    const std::vector<std::size_t>& needs = plan.manifest.jobs[job].needs;
    const std::size_t before = open.size();
    if (plan.jobs[job].key.empty())
      std::copy_if(needs.begin(), needs.end(), std::back_inserter(open),
                   [&](std::size_t need) { return plan.jobs[need].key.empty(); });
    if (open.size() > before) continue;
    open.pop_back();
    if (plan.jobs[job].key.empty()) plan_job(job, hashes, plan);
  }
  for (std::size_t i = 0; i < plan.jobs.size() && !wanted.empty(); ++i) {
    PlannedJob& job = plan.jobs[i];
    if (job.key.empty() || job.is_present || std::find(wanted.begin(), wanted.end(), i) != wanted.end())
      continue;
    job.earlier_fault = failure_of(plan.out / plan.manifest.jobs[i].name, job.key).value_or("");
  }
  hashes.save();
  return plan;
}

std::size_t index_of(const Manifest& manifest, const std::string& name) {
  for (std::size_t i = 0; i < manifest.jobs.size(); ++i)
    if (manifest.jobs[i].name == name) return i;
  throw Error(manifest.path.string() + ": there is no job '" + name + "'");
}

std::vector<std::string> arguments_of(const FarmPlan& plan, std::size_t job) {
  std::vector<std::string> arguments;
  for (const std::string& word : plan.manifest.jobs[job].words) {
    if (const auto input = input_of(plan.manifest, word)) {
      arguments.push_back(word.substr(0, value_at(word)) + fs::absolute(*input).lexically_normal().string());
      continue;
    }
    std::string& argument = arguments.emplace_back();
    for (const WordPart& part : parts_of(word))
      argument += !part.is_folder ? part.text : part.text.empty() ? "." : (plan.out / part.text).string();
  }
  return arguments;
}

}  // namespace roomradar
