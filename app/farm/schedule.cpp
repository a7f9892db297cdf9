// schedule.cpp: counts of open needs, and a queue by cost.
#include "app/farm/schedule.hpp"

#include <algorithm>

namespace roomradar {

Schedule::Schedule(const FarmPlan& plan)
    : states_(plan.jobs.size(), JobState::kNotPlanned),
      costs_(plan.jobs.size()),
      open_needs_(plan.jobs.size()),
      needed_by_(plan.jobs.size()) {
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const PlannedJob& job = plan.jobs[i];
    if (job.key.empty()) continue;
    costs_[i] = job.cost;
    states_[i] = job.is_present              ? JobState::kPresent
                 : job.earlier_fault.empty() ? JobState::kWaiting
                                             : JobState::kFailed;
    left_ += states_[i] == JobState::kWaiting ? 1 : 0;
    for (const std::size_t need : plan.manifest.jobs[i].needs) {
      needed_by_[need].push_back(i);
      open_needs_[i] += plan.jobs[need].is_present ? 0 : 1;
    }
  }
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i] == JobState::kFailed) skip_those_that_need(i);
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i] == JobState::kWaiting && open_needs_[i] == 0) make_ready(i);
}

void Schedule::make_ready(std::size_t job) { ready_.emplace(costs_[job], -static_cast<std::ptrdiff_t>(job)); }

std::optional<std::size_t> Schedule::next() {
  if (ready_.empty()) return std::nullopt;
  const auto job = static_cast<std::size_t>(-ready_.top().second);
  ready_.pop();
  states_[job] = JobState::kRunning;
  return job;
}

void Schedule::skip_those_that_need(std::size_t job) {
  std::vector<std::size_t> failed{job};
  while (!failed.empty()) {
    const std::size_t one = failed.back();
    failed.pop_back();
    for (const std::size_t next : needed_by_[one]) {
      if (states_[next] != JobState::kWaiting) continue;
      states_[next] = JobState::kSkipped;
      --left_;
      failed.push_back(next);
    }
  }
}

void Schedule::finish(std::size_t job, bool is_done) {
  states_[job] = is_done ? JobState::kDone : JobState::kFailed;
  --left_;
  if (!is_done) return skip_those_that_need(job);
  for (const std::size_t next : needed_by_[job])
    if (states_[next] == JobState::kWaiting && --open_needs_[next] == 0) make_ready(next);
}

std::size_t Schedule::count(JobState state) const {
  return static_cast<std::size_t>(std::count(states_.begin(), states_.end(), state));
}

}  // namespace roomradar
