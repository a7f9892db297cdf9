// farm_test.cpp: jobs of a script that stands for the program: done once, failed, killed, and run once more.
#include "app/farm/farm.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "app/farm/batch_script.hpp"
#include "app/farm/job_folder.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::farm_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = R"(#!/bin/sh
# prescan ACTION ARGUMENT {}
echo "begins $2"
echo "$2 $3" >> "$TALLY"
case $2 in
  write) cp "$3" "$4/result" ;;
  join) cat "$3"/result "$3"/result > "$4/result" ;;
  fail) echo "no such room" >&2; exit 3 ;;
  crash) kill -SEGV $$ ;;
  tunables) echo "$GLIBC_TUNABLES" > "$4/result" ;;
  sleep) echo half > "$4/result"; sleep 30 ;;
esac
)";

class Farm : public testing::Test {
 protected:
  Farm() {
    write_bytes(program_, kProgram);
    chmod(program_.c_str(), 0755);
    setenv("TALLY", (folder_.path() / "tally").c_str(), 1);
    write_bytes(folder_.path() / "input", "one\n");
  }
  FarmPlan plan(const std::string& manifest, std::span<const std::size_t> wanted = {}) {
    return plan_farm(parse_manifest(manifest, folder_.path() / "jobs.txt"), out_, wanted);
  }
  FarmState run(const FarmPlan& plan, int processes = 2) {
    return run_farm(plan, processes, program_, [this] { return is_cancelled_.load(); });
  }
  /// Returns how many processes ran since the last call.
  std::size_t ran() {
    std::ifstream tally(folder_.path() / "tally");
    std::size_t lines = 0;
    for (std::string line; std::getline(tally, line);) ++lines;
    tally.close();
    fs::remove(folder_.path() / "tally");
    return lines;
  }
  std::string result(const std::string& job) { return read_bytes(out_ / job / "result", "a result"); }

  test::TemporaryFolder folder_;
  fs::path program_ = folder_.path() / "program", out_ = folder_.path() / "out";
  std::atomic<bool> is_cancelled_ = false;
};

TEST_F(Farm, JobsAskForLargePagesUnlessTheUserHasSetTunables) {
  unsetenv("GLIBC_TUNABLES");
  run(plan("a: prescan tunables - {}\n"));
  EXPECT_EQ(result("a"), "glibc.malloc.hugetlb=1\n");
  setenv("GLIBC_TUNABLES", "glibc.malloc.tcache_count=7", 1);
  run(plan("b: prescan tunables - {}\n"));
  unsetenv("GLIBC_TUNABLES");
  EXPECT_EQ(result("b"), "glibc.malloc.tcache_count=7\n");
}

TEST_F(Farm, DoesWhatIsNotDone) {
  const std::string jobs = "a: prescan write input {}\nb: prescan join {a} {}\nc: prescan join {b} {}\n";
  FarmState state = run(plan(jobs));
  EXPECT_EQ(state.schedule.count(JobState::kDone), 3U);
  EXPECT_EQ(result("c"), "one\none\none\none\n");
  EXPECT_EQ(ran(), 3U);
  EXPECT_FALSE(fs::exists(out_ / "a.running"));
  EXPECT_GT(state.results.at(0).wall_s, 0.0);

  state = run(plan(jobs));
  EXPECT_EQ(state.schedule.count(JobState::kPresent), 3U);
  EXPECT_EQ(ran(), 0U);

  write_bytes(folder_.path() / "input", "two\n");  // as large as before
  fs::last_write_time(folder_.path() / "input", fs::file_time_type::clock::now() + std::chrono::seconds(2));
  state = run(plan(jobs));
  EXPECT_EQ(state.schedule.count(JobState::kDone), 3U);
  EXPECT_EQ(result("c"), "two\ntwo\ntwo\ntwo\n");
  EXPECT_EQ(ran(), 3U);

  fs::remove_all(out_ / "b");  // those that need it are the same as before
  state = run(plan(jobs));
  EXPECT_EQ(state.schedule.count(JobState::kDone), 1U);
  EXPECT_EQ(ran(), 1U);
}

TEST_F(Farm, RunsOnlyTheJobsAskedForAndThoseTheyNeed) {
  const std::string jobs = "a: prescan write input {}\nb: prescan join {a} {}\nc: prescan join {b} {}\n";
  const std::vector<std::size_t> wanted = {1};
  const FarmState state = run(plan(jobs, wanted));
  EXPECT_EQ(state.schedule.count(JobState::kDone), 2U);
  EXPECT_EQ(state.schedule.state(2), JobState::kNotPlanned);
  EXPECT_FALSE(fs::exists(out_ / "c"));
}

TEST_F(Farm, CountsFailuresAndGoesOn) {
  const FarmState state = run(
      plan("a: prescan fail x {}\nb: prescan crash x {}\nc: prescan write input {}\nd: prescan join {a} {}\n"
           "e: prescan join {d} {}\n"));
  EXPECT_EQ(state.schedule.count(JobState::kFailed), 2U);
  EXPECT_EQ(state.schedule.count(JobState::kSkipped), 2U);
  EXPECT_EQ(state.schedule.count(JobState::kDone), 1U);
  EXPECT_EQ(state.results.at(0).fault, "exit status 3: no such room");
  EXPECT_NE(state.results.at(1).fault.find("Segmentation fault"), std::string::npos)
      << state.results.at(1).fault;
  EXPECT_TRUE(fs::exists(out_ / "a.failed"));
  EXPECT_FALSE(fs::exists(out_ / "a"));
  EXPECT_EQ(read_bytes(out_ / "a.log", "a log"), "begins fail\nno such room\n");
}

TEST_F(Farm, ANeededJobThatFailedIsNotRunAgainUnlessItIsAskedFor) {
  const std::string jobs =
      "a: prescan fail x {}\nb: prescan join {a} {}\nc: prescan join {b} {}\nd: prescan write input {}\n";
  (void)run(plan(jobs));
  EXPECT_EQ(ran(), 2U);  // a, d
  const std::vector<std::size_t> c = {2}, a_and_c = {0, 2};
  FarmPlan planned = plan(jobs, c);
  FarmState state = run(planned);
  EXPECT_EQ(ran(), 0U);
  EXPECT_EQ(state.schedule.state(0), JobState::kFailed);
  EXPECT_EQ(state.schedule.state(1), JobState::kSkipped);
  EXPECT_EQ(state.schedule.state(2), JobState::kSkipped);
  EXPECT_EQ(state.schedule.state(3), JobState::kNotPlanned);
  EXPECT_EQ(fault_of(planned, state, 2),
            "was not run, because the job a, which it needs, failed; to run that again: roomradar farm " +
                (folder_.path() / "jobs.txt").string() + " --out " + out_.string() + " --job a");
  EXPECT_EQ(fault_of(planned, state, 0), "exit status 3: no such room; see " + (out_ / "a.log").string());
  EXPECT_EQ(fault_of(planned, state, 3), "");

  (void)run(plan(jobs, a_and_c));
  EXPECT_EQ(ran(), 1U);
  (void)run(plan(jobs));
  EXPECT_EQ(ran(), 1U) << "all jobs: what failed is tried again";

  // A job with other words than the failed one was never run.
  const std::string mended = "a: prescan write input {}\n" + jobs.substr(jobs.find('b'));
  state = run(planned = plan(mended, c));
  EXPECT_EQ(ran(), 3U);
  EXPECT_EQ(fault_of(planned, state, 2), "");
  // A failure that is not known: damaged, or of a job that was cancelled.
  (void)run(plan(jobs));
  write_bytes(out_ / "a.failed" / "failure.json", "[\"key\"");
  (void)ran();
  (void)run(plan(jobs, c));
  EXPECT_EQ(ran(), 1U);
}

TEST_F(Farm, ACancelledNeedIsRunAgain) {
  const std::string jobs = "a: prescan sleep x {}\nb: prescan join {a} {}\n";
  std::thread cancel([this] {
    while (!fs::exists(out_ / "a.running" / "result"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    is_cancelled_ = true;
  });
  const std::vector<std::size_t> b = {1};
  (void)run(plan(jobs, b));
  cancel.join();
  EXPECT_TRUE(fs::exists(out_ / "a.failed"));
  EXPECT_EQ(Schedule(plan(jobs, b)).count(JobState::kWaiting), 2U);
}

TEST_F(Farm, AFailureKeepsTheOlderResult) {
  (void)run(plan("a: prescan write input {}\n"));
  (void)run(plan("a: prescan fail x {}\n"));
  EXPECT_EQ(result("a"), "one\n");
  EXPECT_EQ(run(plan("a: prescan write input {}\n")).schedule.count(JobState::kPresent), 1U);
}

TEST_F(Farm, ACancelledJobLeavesNoResultAndIsDoneLater) {
  std::thread cancel([this] {
    while (!fs::exists(out_ / "a.running" / "result"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    is_cancelled_ = true;
  });
  const FarmState state =
      run(plan("a (cost 9): prescan sleep x {}\nb: prescan sleep y {}\nc: prescan write input {}\n"), 1);
  cancel.join();
  EXPECT_EQ(state.results.at(0).fault, "was cancelled");
  EXPECT_EQ(state.results.size(), 1U);
  EXPECT_FALSE(fs::exists(out_ / "a"));
  is_cancelled_ = false;
  EXPECT_EQ(run(plan("c: prescan write input {}\n")).schedule.count(JobState::kDone), 1U);
}

TEST_F(Farm, AJobThatAnotherProcessRunsIsLeftToIt) {
  const FarmPlan planned = plan("a: prescan write input {}\n");
  const auto other = RunningFolder::create(out_ / "a");
  ASSERT_TRUE(other);
  const FarmState state = run(planned);
  EXPECT_EQ(state.results.at(0).fault, "another process runs it");
  EXPECT_TRUE(fs::exists(out_ / "a.running"));
}

TEST_F(Farm, WhatAKilledFarmLeftIsDoneAgain) {
  fs::create_directories(out_ / "a.running" / "part");
  write_bytes(out_ / "a.running" / "result", "half");
  fs::create_directories(out_ / "b");  // without job.json
  write_bytes(out_ / "b" / "job.json", "{\"key\": 3");
  const FarmState state = run(plan("a: prescan write input {}\nb: prescan write input {}\n"));
  EXPECT_EQ(state.schedule.count(JobState::kDone), 2U);
  EXPECT_EQ(result("a"), "one\n");
  EXPECT_FALSE(fs::exists(out_ / "a" / "part"));
}

TEST_F(Farm, ResultsAreTheSameForAnyNumberOfProcesses) {
  std::string jobs;
  for (int i = 0; i < 20; ++i)
    jobs += "j" + std::to_string(i) + ": prescan " +
            (i % 3 == 0 ? "write input {}\n" : "join {j" + std::to_string(i / 3 * 3) + "} {}\n");
  (void)run(plan(jobs), 1);
  std::string once;
  for (int i = 0; i < 20; ++i)
    once +=
        result("j" + std::to_string(i)) + read_bytes(out_ / ("j" + std::to_string(i)) / "job.json", "a job");
  fs::remove_all(out_);
  (void)run(plan(jobs), 7);
  std::string again;
  for (int i = 0; i < 20; ++i)
    again +=
        result("j" + std::to_string(i)) + read_bytes(out_ / ("j" + std::to_string(i)) / "job.json", "a job");
  EXPECT_EQ(once, again);
}

TEST_F(Farm, KeysDependOnWordsInputsAndNeeds) {
  const auto key = [&](const std::string& jobs, std::size_t job = 0) { return plan(jobs).jobs[job].key; };
  const std::string a = key("a: prescan write input {}\n");
  EXPECT_EQ(a, key("# other lines and names\nother: prescan write   'input' {}\n"));
  EXPECT_NE(a, key("a: prescan write inpux {}\n"));
  EXPECT_NE(key("a: prescan write 'x y' {}\n"), key("a: prescan write x y {}\n"));
  EXPECT_NE(key("a: prescan write input {}\nb: prescan join {a} {}\n", 1),
            key("a: prescan write other {}\nb: prescan join {a} {}\n", 1));
  fs::create_directories(folder_.path() / "set");
  write_bytes(folder_.path() / "set" / "x", "1");
  const std::string before = key("a: prescan write --in=set {}\n");
  test::add_litter(folder_.path() / "set");
  EXPECT_EQ(before, key("a: prescan write --in=set {}\n")) << "litter of desktops is no input";
  write_bytes(folder_.path() / "set" / "y", "1");
  EXPECT_NE(before, key("a: prescan write --in=set {}\n"));
}

TEST_F(Farm, PathsOfInputsAndNeedsAreAbsolute) {
  const FarmPlan planned = plan("a: prescan write input {}\nb: prescan join --from=input {a}/x {}/y {{z}}\n");
  const std::string input = (folder_.path() / "input").string();
  EXPECT_EQ(arguments_of(planned, 0), (std::vector<std::string>{"prescan", "write", input, "."}));
  EXPECT_EQ(arguments_of(planned, 1), (std::vector<std::string>{"prescan", "join", "--from=" + input,
                                                                (out_ / "a/x").string(), "./y", "{z}"}));
}

TEST_F(Farm, TheMostExpensiveReadyJobIsNext) {
  Schedule schedule(
      plan("a: prescan write x {}\nb (cost 5): prescan write x {}\nc (cost 9): prescan join {a} {}\n"
           "d (cost 5): prescan write x {}\n"));
  EXPECT_EQ(schedule.next(), 1U);
  EXPECT_EQ(schedule.next(), 3U);
  EXPECT_EQ(schedule.next(), 0U);
  EXPECT_EQ(schedule.next(), std::nullopt);
  schedule.finish(0, true);
  EXPECT_EQ(schedule.next(), 2U);
  EXPECT_FALSE(schedule.is_over());
  for (const std::size_t job : {1U, 2U, 3U}) schedule.finish(job, job != 2);
  EXPECT_TRUE(schedule.is_over());
}

/// Runs a script by a shell, with the script of this test in the program's place.
int run_script(const fs::path& script, const std::string& how) {
  return std::system((how + " " + script.string() + " > /dev/null 2>&1").c_str());
}

TEST_F(Farm, ScriptsRunTheJobsInOrder) {
  // Stands for `farm MANIFEST --out DIR --job NAME`.
  const fs::path farm = folder_.path() / "farm it";
  write_bytes(farm, "#!/bin/sh\necho \"$6\" >> \"$TALLY\"\n[ \"$6\" != bad ]\n");
  chmod(farm.c_str(), 0755);
  const FarmPlan planned = plan(
      "c: prescan join {a} {b} {}\na: prescan write input {}\nb (cost 9): prescan write input {}\n"
      "bad: prescan fail x {}\n");
  const auto tally = [&] {
    const std::string names = read_bytes(folder_.path() / "tally", "names");
    fs::remove(folder_.path() / "tally");
    return names;
  };
  write_bytes(folder_.path() / "script", batch_script(planned, BatchForm::kMake, farm));
  EXPECT_NE(run_script(folder_.path() / "script", "make --keep-going --file"), 0);
  const std::string made = tally();
  EXPECT_NE(made.find("b\n"), std::string::npos);
  EXPECT_LT(made.find("a\n"), made.find("c\n"));
  write_bytes(
      folder_.path() / "script",
      batch_script(plan("all: prescan write input {}\nd: prescan join {all} {}\n"), BatchForm::kMake, farm));
  EXPECT_EQ(run_script(folder_.path() / "script", "make --file"), 0);
  EXPECT_EQ(tally(), "all\nd\n");
  if (std::system("command -v parallel > /dev/null 2>&1") == 0) {
    write_bytes(folder_.path() / "script", batch_script(planned, BatchForm::kParallel, farm));
    EXPECT_NE(run_script(folder_.path() / "script", "bash"), 0);
    EXPECT_EQ(tally().find("c\n"), std::string("b\na\nbad\n").size());
  }
  // Slurm's sbatch, as a script that runs the array at once.
  const fs::path tools = folder_.path() / "tools";
  fs::create_directories(tools);
  write_bytes(tools / "sbatch",
              "#!/usr/bin/env bash\nscript=$(cat)\nfor word; do case $word in --array=0-*) "
              "last=${word#--array=0-} ;;\n"
              "  --dependency=*) echo \"$word\" >> \"$TALLY\" ;; esac; done\n"
              "for SLURM_ARRAY_TASK_ID in $(seq 0 \"$last\"); do export SLURM_ARRAY_TASK_ID\n"
              "  bash -c \"$script\" > /dev/null 2>&1 || true; done\necho 17\n");
  chmod((tools / "sbatch").c_str(), 0755);
  write_bytes(folder_.path() / "script", batch_script(planned, BatchForm::kSlurm, farm));
  EXPECT_EQ(run_script(folder_.path() / "script", "PATH=" + tools.string() + ":$PATH bash"), 0);
  EXPECT_EQ(tally(), "b\na\nbad\n--dependency=afterany:17\nc\n");
}

TEST_F(Farm, AFolderThatCannotBeReadIsNamed) {
  EXPECT_NE(test::error_of([&] { (void)read_manifest(folder_.path() / "none.txt"); }).find("none.txt"),
            std::string::npos);
  write_bytes(folder_.path() / "file", "");
  out_ = folder_.path() / "file" / "out";
  EXPECT_NE(test::error_of([&] { (void)plan("a: prescan write input {}\n"); }).find("file"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar::farm_test
