// scenario_jobs_test.cpp: scenarios split into jobs, and their results as files.
#include "app/evaluation/fallthrough/scenario_jobs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/evaluation/fallthrough/scenario_rows.hpp"
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
        fault("\"trials\":[{", "\"trials\":[[],{")})
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

TEST(ScenarioJobs, AFailedJobIsLeftOut) {
  const test::TemporaryFolder folder;
  FallthroughOptions options;
  options.jobs = folder.path();
  options.scenarios = 4;
  options.job_size = 2;
  std::filesystem::create_directories(folder.path() / "scenarios-000002");
  write_rows({row(2), row(3)}, folder.path() / "scenarios-000002" / "rows.json");
  ASSERT_EQ(joined_rows(options).size(), 2U);
  EXPECT_EQ(joined_rows(options)[0].number, 2);
  std::filesystem::create_directories(folder.path() / "scenarios-000000");
  write_rows({row(0), row(1)}, folder.path() / "scenarios-000000" / "rows.json");
  ASSERT_EQ(joined_rows(options).size(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(joined_rows(options)[static_cast<std::size_t>(i)].number, i);
}

}  // namespace
}  // namespace roomradar::scenario_jobs_test
