// farm.cpp: the next job of a plan, its process, and the threads that wait for processes.
#include "app/farm/farm.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/farm/job_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kCannotBegin = 126;
// Lets glibc ask for pages of 2 MB. A job lives for seconds, and a tenth to a fifth of its time went into the
// page faults of its memory.
constexpr const char* kTunables = "GLIBC_TUNABLES";
constexpr const char* kLargePages = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";

/// The program that a job runs.
struct JobProgram {
  const char* path;
  char* const* arguments;
  char* const* environment;
  const char* folder;  ///< working directory
};

/// Becomes the program. Runs between fork and exec, where only few functions may be called.
[[noreturn]] void become(const JobProgram& program, int nothing, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);  // Ctrl-C reaches the farm, which then ends its jobs
  const bool is_ready = getppid() == parent && chdir(program.folder) == 0 &&
                        dup2(nothing, STDIN_FILENO) >= 0 && dup2(log, STDOUT_FILENO) >= 0 &&
                        dup2(log, STDERR_FILENO) >= 0;
  if (is_ready) execve(program.path, program.arguments, program.environment);
  _exit(kCannotBegin);
}

/// Returns this process's environment, with large pages unless the user has set tunables.
std::vector<char*> job_environment() {
  std::vector<char*> environment;
  for (char** variable = environ; *variable != nullptr; ++variable) environment.push_back(*variable);
  if (std::getenv(kTunables) == nullptr) environment.push_back(const_cast<char*>(kLargePages));
  environment.push_back(nullptr);
  return environment;
}

/// Starts the program. Throws Error if that fails.
pid_t start(const fs::path& program, std::vector<std::string> words, const fs::path& folder,
            const fs::path& log_file) {
  words.insert(words.begin(), "roomradar");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::vector<char*> environment = job_environment();
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int log = open(log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const pid_t parent = getpid();
  const pid_t child = nothing >= 0 && log >= 0 ? fork() : -1;
  if (child == 0)
    become({.path = program.c_str(),
            .arguments = arguments.data(),
            .environment = environment.data(),
            .folder = folder.c_str()},
           nothing, log, parent);
  const std::string reason = system_reason(errno);
  if (nothing >= 0) close(nothing);
  if (log >= 0) close(log);
  if (child < 0) throw Error(log_file.string() + ": the job cannot be started: " + reason);
  return child;
}

std::string last_line(const fs::path& log_file) {
  std::string tail;
  const int log = open(log_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (log < 0) return tail;
  constexpr off_t kTail_bytes = 400;
  const off_t size = lseek(log, 0, SEEK_END);
  lseek(log, size > kTail_bytes ? size - kTail_bytes : 0, SEEK_SET);
  tail.resize(static_cast<std::size_t>(kTail_bytes));
  const ssize_t count = read(log, tail.data(), tail.size());
  close(log);
  tail.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  tail.erase(tail.find_last_not_of(" \r\n") + 1);
  return tail.substr(tail.find_last_of("\r\n") + 1);
}

/// Returns the reason why a process failed, with its last output; empty if it succeeded.
std::string fault_of(int status, const fs::path& log_file) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFSIGNALED(status)) return std::string("was killed: ") + strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) == kCannotBegin) return "the program could not be started";
  const std::string said = last_line(log_file);
  return "exit status " + std::to_string(WEXITSTATUS(status)) + (said.empty() ? "" : ": " + said);
}

/// Waits for the process; kills it if it is cancelled.
std::string wait_for(pid_t child, const fs::path& log_file, const IsCancelled& is_cancelled,
                     JobResult& result) {
  const auto began = Clock::now();
  bool is_killed = false;
  int status = 0;
  rusage use{};
  for (pid_t ended = 0; ended == 0;) {
    ended = wait4(child, &status, WNOHANG, &use);
    if (ended < 0 && errno != EINTR) return system_reason(errno);
    if (ended < 0) ended = 0;
    if (ended == 0 && !is_killed && is_cancelled()) {
      kill(-child, SIGKILL);
      kill(child, SIGKILL);
      is_killed = true;
    }
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  result.wall_s = std::chrono::duration<double>(Clock::now() - began).count();
  result.cpu_s = seconds(use.ru_utime) + seconds(use.ru_stime);
  result.peak_mb = 1024e-6 * static_cast<double>(use.ru_maxrss);
  return is_killed ? "was cancelled" : fault_of(status, log_file);
}

/// Returns the failed job because of which a job was skipped.
std::size_t failed_need(const FarmPlan& plan, const Schedule& schedule, std::size_t job) {
  while (schedule.state(job) == JobState::kSkipped) {
    const std::vector<std::size_t>& needs = plan.manifest.jobs[job].needs;
    job = *std::find_if(needs.begin(), needs.end(), [&](std::size_t need) {
      return schedule.state(need) == JobState::kFailed || schedule.state(need) == JobState::kSkipped;
    });
  }
  return job;
}

}  // namespace

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

JobResult run_job(const FarmPlan& plan, std::size_t job, const fs::path& program,
                  const IsCancelled& is_cancelled) {
  const Job& stated = plan.manifest.jobs[job];
  JobResult result;
  try {
    const fs::path folder = plan.out / stated.name;
    std::optional<RunningFolder> running = RunningFolder::create(folder);
    if (!running) {
      result.fault = "another process runs it";
      return result;
    }
    const fs::path log_file = folder.string() + ".log";
    const pid_t child = start(program, arguments_of(plan, job), running->path(), log_file);
    result.fault = wait_for(child, log_file, is_cancelled, result);
    if (result.fault.empty())
      running->commit(plan.jobs[job].key, stated.words);
    else if (!is_cancelled())
      running->note_failure(plan.jobs[job].key, result.fault);
    result.is_done = result.fault.empty();
  } catch (const std::exception& error) {
    result.fault = error.what();
  }
  return result;
}

std::string fault_of(const FarmPlan& plan, const FarmState& state, std::size_t job) {
  switch (state.schedule.state(job)) {
    case JobState::kFailed:
      break;
    case JobState::kSkipped: {
      const std::string& need = plan.manifest.jobs[failed_need(plan, state.schedule, job)].name;
      return "was not run, because the job " + need +
             ", which it needs, failed; to run that again: " + "roomradar farm " +
             plan.manifest.path.string() + " --out " + plan.out.string() + " --job " + need;
    }
    case JobState::kWaiting:
    case JobState::kRunning:
      return "was not run";
    default:
      return {};
  }
  const auto found = state.results.find(job);
  return (found == state.results.end() ? plan.jobs[job].earlier_fault : found->second.fault) + "; see " +
         (plan.out / (plan.manifest.jobs[job].name + ".log")).string();
}

FarmState run_farm(const FarmPlan& plan, int processes, const std::filesystem::path& program,
                   const IsCancelled& is_cancelled, const WatchFarm& watch) {
  FarmState state{Schedule(plan), {}};
  std::mutex mutex;  // guards `state`
  std::condition_variable changed;
  const auto work = [&] {
    for (std::unique_lock lock(mutex);;) {
      if (state.schedule.is_over() || is_cancelled()) return;
      const std::optional<std::size_t> job = state.schedule.next();
      if (!job) {
        changed.wait(lock);  // a running job may make others ready
        continue;
      }
      lock.unlock();
      JobResult result = run_job(plan, *job, program, is_cancelled);
      lock.lock();
      state.schedule.finish(*job, result.is_done);
      state.results[*job] = std::move(result);
      if (watch) watch(state, *job);
      changed.notify_all();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < processes; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return state;
}

}  // namespace roomradar
