// scenario_jobs_test.cpp: scenarios split into jobs, and their results as files.
#include "app/evaluation/fallthrough/scenario_jobs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/farm/farm.hpp"
#include "app/farm/manifest.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::scenario_jobs_test {
namespace {

ScenarioRow row(std::int64_t number) {
  ScenarioRow row;
  row.number = number;
  row.room = 3;
  row.room_title = "random \"3\"";
  row.occluder = Occluder::kPerson;
  row.occluder_moves = true;
  row.shape = ObjectShape::kTable;
  row.is_drop = true;
  row.speed_m_s = 1.0 / 3.0;
  row.true_travel_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kPolicyCount; ++i)
    row.trials[i] = {.travelled_m = 0.1 * static_cast<double>(i),
                     .verdict = {Outcome::kStoppedFalse, -1e-17},
                     .rested_on = SurfaceKind::kInferredBack,
                     .frame_ms = std::nan("")};
  return row;
}

TEST(ScenarioRows, ComeBackAsWritten) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "rows.json";
  write_rows({row(7), row(8)}, path);
  const std::vector<ScenarioRow> read = read_rows(path);
  ASSERT_EQ(read.size(), 2U);
  const ScenarioRow want = row(8);
  EXPECT_EQ(read[1].number, 8);
  EXPECT_EQ(read[1].room, want.room);
  EXPECT_EQ(read[1].room_title, want.room_title);
  EXPECT_EQ(read[1].occluder, want.occluder);
  EXPECT_EQ(read[1].occluder_moves, want.occluder_moves);
  EXPECT_EQ(read[1].shape, want.shape);
  EXPECT_EQ(read[1].is_drop, want.is_drop);
  EXPECT_EQ(read[1].speed_m_s, want.speed_m_s);
  EXPECT_EQ(read[1].true_travel_m, want.true_travel_m);
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    EXPECT_EQ(read[1].trials[i].travelled_m, want.trials[i].travelled_m);
    EXPECT_EQ(read[1].trials[i].verdict.outcome, want.trials[i].verdict.outcome);
    EXPECT_EQ(read[1].trials[i].verdict.error_m, want.trials[i].verdict.error_m);
    EXPECT_EQ(read[1].trials[i].rested_on, want.trials[i].rested_on);
    EXPECT_TRUE(std::isnan(read[1].trials[i].frame_ms));
  }
  write_rows({}, path);
  EXPECT_TRUE(read_rows(path).empty());
}

TEST(ScenarioRows, DamagedFilesAreNamed) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "rows.json";
  write_rows({row(7)}, path);
  const std::string good = read_bytes(path, "rows");
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    write_bytes(path, text);
    return test::error_of([&] { (void)read_rows(path); });
  };
  for (const std::string& message :
       {fault("{", ""), fault("roomradar scenarios", "another"), fault("\"version\":1", "\"version\":2"),
        fault("\"shape\":8", "\"shape\":9"), fault("\"shape\":8", "\"shape\":\"ball\""),
        fault("\"rested_on\":5", "\"rested_on\":-1"), fault("\"is_drop\"", "\"was_drop\""),
        fault("\"trials\":[{", "\"trials\":[[],{"), fault("\"inf\"", "\"infinite\"")})
    EXPECT_NE(message.find("rows.json: is not a file with results of scenarios"), std::string::npos)
        << message;
}

TEST(ScenarioJobs, CoverTheScenariosOnce) {
  FallthroughOptions options;
  options.scenarios = 250;
  options.seed = 9;
  options.job_size = 100;
  const Manifest manifest = parse_manifest(scenario_manifest(options), "/jobs.txt");
  ASSERT_EQ(manifest.jobs.size(), 4U);
  EXPECT_TRUE(manifest.jobs[0].needs.empty());
  std::int64_t next = 0;
  for (std::size_t i = 1; i < manifest.jobs.size(); ++i) {
    EXPECT_EQ(manifest.jobs[i].needs, std::vector<std::size_t>{0});
    const auto& words = manifest.jobs[i].words;
    const auto part = std::find(words.begin(), words.end(), "--part");
    ASSERT_NE(part, words.end());
    const FrameRange range = parse_frame_range(*(part + 1));
    EXPECT_EQ(range.first, next);
    next = range.last + 1;
  }
  EXPECT_EQ(next, 250);
  // More scenarios leave the jobs of the first ones as they are, so they are not done again.
  options.scenarios = 400;
  const Manifest more = parse_manifest(scenario_manifest(options), "/jobs.txt");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(more.jobs[i].words, manifest.jobs[i].words);
}

/// Rows of the scenarios first and first + 1, in their rooms, as the file of a job.
void write_job(const std::filesystem::path& folder, const std::string& job, std::int64_t first) {
  constexpr std::size_t kRooms = 6;
  std::vector<ScenarioRow> rows{row(first), row(first + 1)};
  for (ScenarioRow& one : rows) one.room = turn_of(one.number, kRooms).room;
  std::filesystem::create_directories(folder / job);
  write_rows(rows, folder / job / "rows.json");
}

TEST(ScenarioJobs, AFailedJobIsLeftOutAlsoWhereAnOlderResultOfItIsThere) {
  const test::TemporaryFolder folder;
  FallthroughOptions options;
  options.jobs = folder.path();
  options.scenarios = 4;
  options.job_size = 2;
  write_job(folder.path(), "scenarios-000000", 0);
  write_job(folder.path(), "scenarios-000002", 2);
  ASSERT_EQ(joined_rows(options, {{"scenarios-000000", "was killed"}}).size(), 2U);
  EXPECT_EQ(joined_rows(options, {{"scenarios-000000", "was killed"}})[0].number, 2);
  ASSERT_EQ(joined_rows(options, {}).size(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(joined_rows(options, {})[static_cast<std::size_t>(i)].number, i);
}

/// A row whose results depend on its number.
ScenarioRow varied_row(std::int64_t number, std::size_t rooms) {
  ScenarioRow varied = row(number);
  varied.room = turn_of(number, rooms).room;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const auto turn = (number + static_cast<std::int64_t>(i)) % 7;
    varied.trials[i].verdict = {turn == 0   ? Outcome::kPassedThrough
                                : turn == 1 ? Outcome::kStoppedFalse
                                            : Outcome::kStoppedRight,
                                1e-4 * static_cast<double>(number % 97)};
    varied.trials[i].frame_ms = 1.0 + static_cast<double>(number % 13);
  }
  return varied;
}

TEST(ScenarioJobs, WhereOneJobInAHundredCrashesAllOthersCount) {
  const test::TemporaryFolder folder;
  FallthroughOptions options;
  options.jobs = folder.path() / "jobs";
  options.scenarios = 2000;
  options.job_size = 10;
  // Stands for the program: a job gets its rows from a file, and two of them are killed halfway.
  const std::filesystem::path program = folder.path() / "program", prepared = folder.path() / "prepared";
  std::filesystem::create_directory(prepared);
  write_bytes(program,
              "#!/bin/sh\n# fallthrough --seed N --random-rooms N --part FIRST:LAST ...\n"
              "case $7 in 0:0) mkdir maps && exit ;; esac\n"
              "head -c 300 '" +
                  prepared.string() +
                  "'/\"$7\" > rows.json\n"
                  "case $7 in 370:379|1010:1019) kill -9 $$ ;; esac\n"
                  "cp '" +
                  prepared.string() + "'/\"$7\" rows.json\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::size_t rooms = choose_rooms(options.random_rooms).size();
  std::vector<ScenarioRow> counted;
  for (std::int64_t first = 0; first < options.scenarios; first += 10) {
    std::vector<ScenarioRow> part;
    for (std::int64_t number = first; number < first + 10; ++number)
      part.push_back(varied_row(number, rooms));
    write_rows(part, prepared / (std::to_string(first) + ":" + std::to_string(first + 9)));
    if (first != 370 && first != 1010) counted.insert(counted.end(), part.begin(), part.end());
  }
  const FarmPlan plan =
      plan_farm(parse_manifest(scenario_manifest(options), folder.path() / "jobs.txt"), options.jobs);
  const FarmState state = run_farm(plan, 4, program, [] { return false; });
  std::map<std::string, std::string> faults;
  for (std::size_t job = 0; job < plan.jobs.size(); ++job)
    if (const std::string fault = fault_of(plan, state, job); !fault.empty())
      faults[plan.manifest.jobs[job].name] = fault;
  ASSERT_EQ(faults.size(), 2U) << faults.begin()->second;
  EXPECT_EQ(faults.at("scenarios-000370").rfind("was killed: Killed; see ", 0), 0U);
  EXPECT_EQ(faults.at("scenarios-001010").rfind("was killed: Killed; see ", 0), 0U);

  const std::vector<ScenarioRow> rows = joined_rows(options, faults);
  EXPECT_EQ(rows.size(), 1980U);
  EXPECT_EQ(table_of(totals_of(rows), 1980), table_of(totals_of(counted), 1980));
  write_csv(rows, folder.path() / "rows.csv");
  write_csv(counted, folder.path() / "counted.csv");
  EXPECT_EQ(read_bytes(folder.path() / "rows.csv", "rows"),
            read_bytes(folder.path() / "counted.csv", "rows"));
}

TEST(ScenarioJobs, AFileWithOtherScenariosThanItsJobsIsNamed) {
  const test::TemporaryFolder folder;
  FallthroughOptions options;
  options.jobs = folder.path();
  options.scenarios = 2;
  options.job_size = 2;
  write_job(folder.path(), "scenarios-000000", 2);
  const auto fault = [&] { return test::error_of([&] { (void)joined_rows(options, {}); }); };
  EXPECT_NE(fault().find("scenarios-000000/rows.json: contains scenarios other than 0 to 1"),
            std::string::npos);
  write_rows({row(0), row(1)}, folder.path() / "scenarios-000000" / "rows.json");  // room 3 for both
  EXPECT_NE(fault().find("scenarios other than"), std::string::npos);
  std::filesystem::remove_all(folder.path() / "scenarios-000000");
  EXPECT_NE(fault().find("rows.json"), std::string::npos);
}

}  // namespace
}  // namespace roomradar::scenario_jobs_test
