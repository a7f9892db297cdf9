// fallthrough_test.cpp: with a map no object passes hidden surfaces, without a map objects do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "app/commands/commands.hpp"
#include "app/commands/grid_command.hpp"
#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/evaluation/fallthrough/page.hpp"
#include "app/evaluation/fallthrough/recording_grid.hpp"
#include "app/evaluation/fallthrough/totals.hpp"
#include "app/evaluation/fallthrough/trial.hpp"
#include "app/evaluation/fallthrough/trial_pictures.hpp"
#include "app/media/canvas.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::fallthrough_test {
namespace {

// Coarse voxels, small images: the map is worse than any that the command makes.
const RoomScan kCoarse{.resolution_m = 0.02, .every = 6, .width_px = 320, .maps = {}};

TEST(Fallthrough, NothingPassesTheMapOfACoarseScanAndObjectsPassWithoutOne) {
  GlContext context;
  int frames = 0;
  MappedRoom room(context, scan_room({"table", 1}, kCoarse, [&] { ++frames; }));
  EXPECT_EQ(frames, 120);
  CyberRadar radar;
  std::vector<ScenarioRow> rows;
  for (int number = 0; number < 12; ++number) {
    PreparedScenario prepared(room.scanned.simulated, 5, number);
    rows.push_back(row_of(prepared.scenario, number, 0, room.scanned.title));
    for (std::size_t i = 0; i < kPolicyCount; ++i) {
      double came_m = 0.0;
      bool is_over = false;
      rows.back().trials[i] = run_trial(prepared, room, i, radar, [&](const TrialStep& step) {
        EXPECT_FALSE(is_over);
        EXPECT_EQ(step.from_m, came_m);
        EXPECT_LE(step.to_m - step.from_m, step_m(prepared.scenario) + 1e-12);
        came_m = step.to_m;
        is_over = step.is_last;
      });
      EXPECT_TRUE(is_over);
      EXPECT_EQ(came_m, rows.back().trials[i].travelled_m);
      EXPECT_LE(came_m, prepared.scenario.limit_m);
    }
    if (number == 0) {
      const ColourImage picture = picture_of_trial(prepared, room, 0, radar);
      EXPECT_EQ(picture.width, 560);
      EXPECT_EQ(picture.height, 240);
    }
  }
  const auto totals = totals_of(rows);
  EXPECT_GE(totals[0].passed, 6) << "without a map what is hidden is open";
  EXPECT_EQ(totals[3].passed, 0);
  EXPECT_EQ(totals[4].passed, 0);
  EXPECT_LE(totals[4].false_stops, 1);
  EXPECT_LT(totals[3].contact_error_median_m, 0.01);

  const nlohmann::json json = to_json(totals);
  for (const char* key : {"passed", "false_stops", "contact_error_median_m", "frame_median_ms"})
    for (const FallthroughPolicy& policy : kFallthroughPolicies)
      EXPECT_TRUE(json.at(std::string(policy.name)).contains(key)) << policy.name << " " << key;
}

TEST(Fallthrough, EveryRoomMeetsEveryKindOfOccluderMotionAndShape) {
  constexpr std::int64_t kInTurn = 4 * 2 * 9;  // per room, until combinations of kinds repeat
  for (const std::size_t rooms : {1U, 3U, 4U, 6U, 8U}) {
    std::set<std::pair<std::size_t, std::int64_t>> met;
    for (std::int64_t number = 0; number < kInTurn * static_cast<std::int64_t>(rooms); ++number) {
      const ScenarioTurn turn = turn_of(number, rooms);
      EXPECT_LT(turn.room, rooms);
      EXPECT_LT(turn.number, kInTurn);
      met.emplace(turn.room, turn.number);
    }
    EXPECT_EQ(met.size(), kInTurn * rooms);
  }
}

ScenarioRow row_with(double error_m, SurfaceKind rested_on, double frame_ms) {
  ScenarioRow row;
  Scenario scenario;
  scenario.true_travel_m = 0.3;
  for (Trial& trial : row.trials)
    trial = {0.3 + error_m, judge(scenario, 0.3 + error_m), rested_on, frame_ms};
  return row;
}

/// A cell whose ball falls travelled_m onto a surface of this kind with every policy; the truth is 1 m.
GridCell cell_with(double travelled_m, SurfaceKind rested_on) {
  GridCell cell;
  cell.has_truth = true;
  cell.true_travel_m = 1.0;
  for (GridDrop& drop : cell.drops) drop = {travelled_m, rested_on};
  return cell;
}

TEST(RecordingGrid, StopsAtUnknownSpaceAreCountedByThemselvesToo) {
  Grid grid;
  grid.columns = 5;
  grid.rows = 1;
  grid.cells = {cell_with(1.0, SurfaceKind::kStatic), cell_with(0.5, SurfaceKind::kUnknownFrontier),
                cell_with(0.5, SurfaceKind::kStatic), cell_with(5.0, SurfaceKind::kNothing), GridCell{}};
  const GridTotals totals = totals_of(grid, 0, false);
  EXPECT_EQ(totals.cells, 4) << "a cell without truth does not count";
  EXPECT_EQ(totals.passed, 1);
  EXPECT_EQ(totals.false_stops, 2);
  EXPECT_EQ(totals.false_stops_at_unknown, 1);

  const ColourImage plan = draw_plan(grid);
  for (int y = plan.height - 45; y < plan.height; ++y) {
    const Rgb at_border = plan.at(plan.width - 1, y);
    EXPECT_EQ(at_border.r, 250) << "the legend's text reaches the right border in row " << y;
  }
}

TEST(FallthroughTotals, CountOutcomesAndLeaveErrorsOfWhatNothingStoppedOut) {
  std::vector<ScenarioRow> rows{
      row_with(0.001, SurfaceKind::kStatic, 2.0), row_with(-0.002, SurfaceKind::kStatic, 4.0),
      row_with(0.4, SurfaceKind::kNothing, 6.0), row_with(-0.1, SurfaceKind::kDynamic, 8.0)};
  for (ScenarioRow& row : rows) row.trials[1].frame_ms *= 3.0;
  const auto totals = totals_of(rows);
  EXPECT_EQ(totals[0].passed, 1);
  EXPECT_EQ(totals[0].false_stops, 1);
  EXPECT_NEAR(totals[0].contact_error_median_m, 0.002, 1e-12);
  EXPECT_NEAR(totals[0].contact_error_p95_m, 0.1, 1e-12);
  EXPECT_NEAR(totals[0].frame_median_ms, 4.0, 1e-12);
  EXPECT_NEAR(totals[1].cost_ratio, 3.0, 1e-12);
  EXPECT_EQ(failures_of(rows).size(), 2 * kPolicyCount);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
  EXPECT_EQ(millimetres(percentile({}, 0.5)), "-");
  EXPECT_EQ(millimetres(0.0123), "12.3 mm");
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 1.0), 3.0);
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(FallthroughFiles, CsvHasALineAScenarioAndPolicyAndThePageNeedsNothingElse) {
  const test::TemporaryFolder folder;
  const std::vector<ScenarioRow> rows{row_with(0.001, SurfaceKind::kStatic, 2.0),
                                      row_with(0.4, SurfaceKind::kNothing, 6.0)};
  write_csv(rows, folder.path() / "rows.csv");
  const std::string csv = text_of(folder.path() / "rows.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(1 + 2 * kPolicyCount));
  for (std::size_t at = 0, columns = 0; at < csv.size(); ++at) {
    columns += csv[at] == ',';
    if (csv[at] != '\n') continue;
    EXPECT_EQ(columns, 13U);
    columns = 0;
  }
  write_page(rows, "a <run>", {{"a \"failure\"", ColourImage(8, 6, Rgb{1, 2, 3})}},
             folder.path() / "page.html");
  const std::string page = text_of(folder.path() / "page.html");
  EXPECT_NE(page.find("a &lt;run&gt;"), std::string::npos);
  EXPECT_NE(page.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  EXPECT_EQ(page.find("://"), std::string::npos) << "no network";
  EXPECT_NE(page.find("1 of " + std::to_string(kPolicyCount) + " are shown"), std::string::npos);
  EXPECT_EQ(page.find("nan "), std::string::npos);
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (std::size_t at = page.find(part); at != std::string::npos; at = page.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<div class=\"wide"), count("<table")) << "on a narrow screen, tables scroll on their own";
  EXPECT_THROW(write_page(rows, "", {}, folder.path() / "none" / "page.html"), Error);
}

TEST(FallthroughFiles, AFolderForMapsThatCannotBeIsNamedBeforeTheWork) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "no folder";
  std::filesystem::create_directory(folder.path() / "map");
  std::ofstream(folder.path() / "map" / "map.json") << "{}";
  const auto fault_of = [](const std::filesystem::path& maps) {
    FallthroughOptions options;
    options.maps = maps.string();
    const std::string fault = test::error_of([&] { (void)run(options); });
    EXPECT_NE(fault.find(maps.string()), std::string::npos) << fault;
    return fault;
  };
  for (const char* maps : {"file", "file/maps"})
    EXPECT_NE(fault_of(folder.path() / maps).find("cannot be made"), std::string::npos) << maps;
  for (const char* maps : {"map", "map/maps"})
    EXPECT_NE(fault_of(folder.path() / maps).find("lies in the folder of a map"), std::string::npos) << maps;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "map" / "maps"));
}

TEST(FallthroughGrid, MapsOfDifferentFramesOfOneRecordingShareItsWorld) {
  const auto share = [](const std::string& a, const std::string& b, const char* poses_of_b = "recorded") {
    MapInfo info_a, info_b;
    info_a.source = a;
    info_a.settings[kPosesSetting] = "recorded";
    info_b.source = b;
    info_b.settings[kPosesSetting] = poses_of_b;
    return share_recorded_world(info_a, info_b);
  };
  EXPECT_TRUE(share("/r/kitchen", "/r/kitchen"));
  EXPECT_TRUE(share("/r/kitchen", "/r/kitchen, frames 400:499"));
  EXPECT_TRUE(share("/r/kitchen, frames 0:299", "/r/kitchen, frames 400:499"));
  EXPECT_FALSE(share("/r/kitchen, frames 0:299", "/r/office, frames 0:299"));
  EXPECT_FALSE(share("/r/kitchen", "/r/kitchen, frames of today"));
  EXPECT_FALSE(share("/r/kitchen", "/r/office; /r/kitchen, frames 0:299"));
  EXPECT_FALSE(share("/r/kitchen; /r/office, frames 0:9", "/r/kitchen; /r/office, frames 0:19"));
  EXPECT_FALSE(share("/r/kitchen", "/r/kitchen, frames 0:299", "tracked"));
}

TEST(FallthroughCanvas, TrianglesCoverTheirPixelsAndWhatIsOutsideIsLeftOut) {
  MaskImage mask(20, 10, 0);
  fill_triangle(mask, {2, 2}, {12, 2}, {2, 8});
  EXPECT_EQ(mask.at(2, 2), 255);
  EXPECT_EQ(mask.at(11, 2), 255);
  EXPECT_EQ(mask.at(12, 7), 0);
  fill_triangle(mask, {-1e9, 4}, {1e9, 4}, {0, std::nan("")});
  ColourImage picture(20, 10, Rgb{255, 255, 255});
  draw_line(picture, {-1e9, -1e9}, {1e9, 1e9}, {0, 0, 0});
  blend(picture, -1, 30, {0, 0, 0});
  paste(ColourImage(5, 5, Rgb{9, 9, 9}), 17, 8, picture);
  EXPECT_EQ(picture.at(19, 9), (Rgb{9, 9, 9}));
  tint(picture, mask, {200, 0, 0}, 0.5);
  EXPECT_EQ(picture.at(2, 2), (Rgb{200, 0, 0}));  // the outline is opaque
}

}  // namespace
}  // namespace roomradar::fallthrough_test
