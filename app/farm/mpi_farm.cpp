// mpi_farm.cpp: rank 0 answers each finished job with the next one.
#include "app/farm/mpi_farm.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

namespace roomradar {
namespace {

constexpr int kEndedTag = 1, kNextTag = 2;
constexpr std::int64_t kNone = -1;
constexpr std::size_t kKeyLength = 64;  // SHA-256 in hexadecimal digits

/// Message from a worker to rank 0: the outcome of its job, and a request for the next one.
struct EndedJob {
  std::int64_t job = kNone;  ///< kNone: it had none so far
  std::int64_t is_done = 0;
  double wall_s = 0.0, cpu_s = 0.0, peak_mb = 0.0;
  std::array<char, 512> fault{};
};
static_assert(std::is_trivially_copyable_v<EndedJob>);

int rank_of_this() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

/// Sends bytes from rank 0 to all. A rank that waits for them leaves its processor to others.
void broadcast(void* bytes, std::uint64_t count) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(bytes, static_cast<int>(count), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
  for (int is_done = 0;; rest()) {
    MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
    if (is_done != 0) return;
  }
}

/// Sends text of any length from rank 0 to all.
void broadcast(std::string& text) {
  std::uint64_t size = text.size();
  broadcast(&size, sizeof size);
  text.resize(size);
  constexpr std::uint64_t kMost = 1U << 30U;  // MPI counts in int
  for (std::uint64_t at = 0; at < size; at += kMost) broadcast(text.data() + at, std::min(kMost, size - at));
}

EndedJob ended(std::size_t job, const JobResult& result) {
  EndedJob ended{static_cast<std::int64_t>(job),
                 result.is_done ? 1 : 0,
                 result.wall_s,
                 result.cpu_s,
                 result.peak_mb,
                 {}};
  std::copy_n(result.fault.data(), std::min(result.fault.size(), ended.fault.size() - 1), ended.fault.data());
  return ended;
}

/// Runs the jobs that rank 0 hands out, until it says that there are no more.
void work_for_rank_0(const FarmPlan& plan, const std::filesystem::path& program) {
  for (EndedJob last;;) {
    MPI_Send(&last, sizeof last, MPI_BYTE, 0, kEndedTag, MPI_COMM_WORLD);
    for (int has_answer = 0; has_answer == 0; rest())
      MPI_Iprobe(0, kNextTag, MPI_COMM_WORLD, &has_answer, MPI_STATUS_IGNORE);
    std::int64_t job = kNone;
    MPI_Recv(&job, 1, MPI_INT64_T, 0, kNextTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (job == kNone) return;
    const auto index = static_cast<std::size_t>(job);
    last = ended(index, run_job(plan, index, program, [] { return false; }));
  }
}

void answer(int rank, std::int64_t job) { MPI_Send(&job, 1, MPI_INT64_T, rank, kNextTag, MPI_COMM_WORLD); }

/// Hands out the jobs, and runs some on this rank.
FarmState manage(const FarmPlan& plan, const std::filesystem::path& program, const WatchFarm& watch) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  FarmState state{Schedule(plan), {}};
  std::deque<int> waiting;  // ranks without a job
  std::size_t own_job = 0;
  std::future<JobResult> own;
  const auto finish = [&](std::size_t job, JobResult result) {
    state.schedule.finish(job, result.is_done);
    state.results[job] = std::move(result);
    if (watch) watch(state, job);
  };
  while (!state.schedule.is_over()) {
    rest();
    if (own.valid() && own.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
      finish(own_job, own.get());
    for (int is_there = 1; is_there != 0;) {
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, kEndedTag, MPI_COMM_WORLD, &is_there, &status);
      if (is_there == 0) break;
      EndedJob last;
      MPI_Recv(&last, sizeof last, MPI_BYTE, status.MPI_SOURCE, kEndedTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      waiting.push_back(status.MPI_SOURCE);
      if (last.job != kNone)
        finish(static_cast<std::size_t>(last.job),
               {last.is_done != 0, last.fault.data(), last.wall_s, last.cpu_s, last.peak_mb});
    }
    while (!own.valid() || !waiting.empty()) {
      const std::optional<std::size_t> job = state.schedule.next();
      if (!job) break;
      if (!own.valid()) {
        own_job = *job;
        own = std::async(std::launch::async, [&plan, &program, own_job] {
          return run_job(plan, own_job, program, [] { return false; });
        });
        continue;
      }
      answer(waiting.front(), static_cast<std::int64_t>(*job));
      waiting.pop_front();
    }
  }
  for (int told = 1; told < ranks; ++told) {
    if (waiting.empty()) {  // has not asked for its first job so far
      EndedJob first;
      MPI_Status status;
      MPI_Recv(&first, sizeof first, MPI_BYTE, MPI_ANY_SOURCE, kEndedTag, MPI_COMM_WORLD, &status);
      waiting.push_back(status.MPI_SOURCE);
    }
    answer(waiting.front(), kNone);
    waiting.pop_front();
  }
  return state;
}

}  // namespace

std::optional<FarmPlan> share_plan(const FarmPlan* plan) {
  const bool is_manager = rank_of_this() == 0;
  std::string manifest, out, keys;
  if (is_manager && plan != nullptr) {
    manifest = plan->manifest.path.string();
    out = plan->out.string();
    for (const PlannedJob& job : plan->jobs) keys += job.key.empty() ? std::string(kKeyLength, ' ') : job.key;
  }
  for (std::string* text : {&manifest, &out, &keys}) broadcast(*text);
  if (manifest.empty()) return std::nullopt;
  if (is_manager) return *plan;
  FarmPlan shared{read_manifest(manifest), out, {}};
  shared.jobs.resize(shared.manifest.jobs.size());
  for (std::size_t i = 0; i < shared.jobs.size() && (i + 1) * kKeyLength <= keys.size(); ++i)
    shared.jobs[i].key = keys.substr(i * kKeyLength, kKeyLength);
  return shared;
}

FarmState run_farm_on_ranks(const FarmPlan& plan, const std::filesystem::path& program,
                            const WatchFarm& watch) {
  if (rank_of_this() == 0) return manage(plan, program, watch);
  work_for_rank_0(plan, program);
  return {Schedule({}), {}};
}

}  // namespace roomradar
