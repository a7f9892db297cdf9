// batch_script.cpp: jobs in levels, each of which needs only jobs of the levels before.
#include "app/farm/batch_script.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMostPerArray = 1000;  // Slurm's MaxArraySize is 1001 unless configured otherwise

std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Returns the jobs to run: by level, the most expensive first.
std::vector<std::vector<std::size_t>> levels_of(const FarmPlan& plan) {
  std::vector<int> level(plan.jobs.size(), -1);  // -1: not known, or not to run
  const auto is_wanted = [&](std::size_t i) { return !plan.jobs[i].key.empty() && !plan.jobs[i].is_present; };
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i)
    if (is_wanted(i)) open.push_back(i);
  std::vector<std::vector<std::size_t>> levels;
  while (!open.empty()) {  // a stack: a job comes after those that it needs
    const std::size_t job = open.back();
    int needed = -1;
    const std::size_t before = open.size();
    for (const std::size_t need : plan.manifest.jobs[job].needs) {
      if (!is_wanted(need)) continue;
      if (level[need] < 0) open.push_back(need);
      needed = std::max(needed, level[need]);
    }
    if (open.size() > before) continue;
    open.pop_back();
    if (level[job] >= 0) continue;
    level[job] = needed + 1;
    levels.resize(std::max(levels.size(), static_cast<std::size_t>(level[job]) + 1));
    levels[static_cast<std::size_t>(level[job])].push_back(job);
  }
  for (std::vector<std::size_t>& jobs : levels)
    std::sort(jobs.begin(), jobs.end(), [&](std::size_t a, std::size_t b) {
      return plan.jobs[a].cost != plan.jobs[b].cost ? plan.jobs[a].cost > plan.jobs[b].cost : a < b;
    });
  return levels;
}

/// Returns the command up to the job's name.
std::string farm_command(const FarmPlan& plan) {
  return "farm " + quoted(plan.manifest.path.string()) + " --out " + quoted(plan.out.string()) + " --job";
}

std::string program_line(const std::filesystem::path& program) {
  return "roomradar=${ROOMRADAR:-" + quoted(program.string()) + "}\n";
}

std::string makefile(const FarmPlan& plan, const std::filesystem::path& program) {
  const auto escaped = [](std::string text) {  // $ is make's
    for (std::size_t at = 0; (at = text.find('$', at)) != std::string::npos; at += 2) text.insert(at, "$");
    return text;
  };
  std::string all, rules, every = "all";
  for (const auto& jobs : levels_of(plan))
    for (const std::size_t job : jobs) {
      const std::string& name = plan.manifest.jobs[job].name;
      if (name == every) every = "jobs/all";  // no job's name: those have no /
      all += " " + name;
      rules += "\n" + name + ":";
      for (const std::size_t need : plan.manifest.jobs[job].needs)
        if (!plan.jobs[need].is_present) rules += " " + plan.manifest.jobs[need].name;
      rules += "\n\t@\"$(ROOMRADAR)\" " + escaped(farm_command(plan)) + " " + name + "\n";
    }
  return "# Jobs of roomradar: make --keep-going --jobs=2 --file THIS\nROOMRADAR ?= " +
         escaped(program.string()) + "\n.PHONY: " + every + all + "\n" + every + ":" + all + "\n" + rules;
}

std::string parallel_script(const FarmPlan& plan, const std::filesystem::path& program) {
  std::string script = "#!/usr/bin/env bash\n# Jobs of roomradar: bash THIS [OPTION OF parallel]...\n" +
                       program_line(program) + "failed=0\n";
  for (const auto& jobs : levels_of(plan)) {
    script += "parallel --quote --halt never \"$@\" \"$roomradar\" " + farm_command(plan) +
              " <<'END' || failed=1\n";
    for (const std::size_t job : jobs) script += plan.manifest.jobs[job].name + "\n";
    script += "END\n";
  }
  return script + "exit $failed\n";
}

std::string slurm_script(const FarmPlan& plan, const std::filesystem::path& program) {
  std::string script =
      "#!/usr/bin/env bash\n# Jobs of roomradar: bash THIS [OPTION OF sbatch]...\nset -eu\n" +
      program_line(program) +
      "options=(\"$@\")\nafter=\n"
      "# submit LIST...: an array of jobs for each list of names, after the arrays submitted by the last "
      "call\n"
      "submit() {\n"
      "  local list id ids=\n"
      "  for list; do\n"
      "    id=$(sbatch --parsable --job-name=roomradar --array=0-$(($(wc -l < \"$list\") - 1)) \\\n"
      "      ${after:+--dependency=afterany$after} --output=/dev/null \"${options[@]}\" <<END\n"
      "#!/usr/bin/env bash\n"
      "name=\\$(sed -n \"\\$((SLURM_ARRAY_TASK_ID + 1))p\" $(printf %q \"$list\"))\n"
      "exec $(printf %q \"$roomradar\") " +
      farm_command(plan) +
      " \"\\$name\"\n"
      "END\n"
      "    )\n"
      "    ids=$ids:${id%%;*}\n"
      "  done\n"
      "  after=$ids\n"
      "}\n";
  const auto levels = levels_of(plan);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    script += "submit";
    for (std::size_t first = 0; first < levels[level].size(); first += kMostPerArray) {
      const std::filesystem::path list = plan.out / ("slurm-" + std::to_string(level) + "-" +
                                                     std::to_string(first / kMostPerArray) + ".txt");
      std::string names;
      for (std::size_t i = first; i < std::min(first + kMostPerArray, levels[level].size()); ++i)
        names += plan.manifest.jobs[levels[level][i]].name + "\n";
      write_bytes(list, names);
      script += " " + quoted(list.string());
    }
    script += "\n";
  }
  return script;
}

}  // namespace

std::string batch_script(const FarmPlan& plan, BatchForm form, const std::filesystem::path& program) {
  switch (form) {
    case BatchForm::kMake:
      return makefile(plan, program);
    case BatchForm::kParallel:
      return parallel_script(plan, program);
    case BatchForm::kSlurm:
      break;
  }
  return slurm_script(plan, program);
}

}  // namespace roomradar
