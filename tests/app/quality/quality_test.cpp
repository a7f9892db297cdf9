// quality_test.cpp: quality settings: validation, command-line form, JSON, and the configs they set.
#include "app/quality/quality.hpp"
#include "app/cli/apply_scan_quality.hpp"

#include <gtest/gtest.h>

#include "app/quality/quality_json.hpp"
#include "app/session/apply_quality.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"

namespace roomradar::quality_test {
namespace {

RunQuality coarse() {
  return {.depth_stride = 4,
          .tracking_px = 80,
          .verify_every_n_frames = 5,
          .mesh_tolerance_sigmas = 1.0 / 3.0,
          .fine_mesh = true,
          .radar = RadarMode::kSampled,
          .radar_px = 24,
          .physics_step_s = 0.1,
          .move_every_n_frames = 3,
          .object_error_px = 2.0,
          .soft_edges = false,
          .bridge_gaps = false,
          .shadows = false,
          .shadow_every_n_frames = 8,
          .picture_every_n_frames = 2};
}

TEST(Quality, EveryFieldIsInTheListOnce) {
  // A field missing from visit_fields() would be neither read nor written, and have its default value here.
  RunQuality made;
  set_fields(made, words_of(coarse()));
  EXPECT_EQ(made, coarse());
  EXPECT_EQ(words_of(coarse()).size(), 15U);
  const ScanQuality scan{.resolution_m = 0.05, .deviation_m = 0.1, .tracking_px = 160, .fuse_every = 3};
  ScanQuality made_scan;
  set_fields(made_scan, words_of(scan));
  EXPECT_EQ(made_scan, scan);
  EXPECT_TRUE(words_of(RunQuality{}).empty());
}

TEST(Quality, JsonAndBackIsTheSame) {
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(to_json(coarse()).dump());
  EXPECT_EQ(run_quality_of(json, "file"), coarse());
  EXPECT_EQ(run_quality_of(nlohmann::ordered_json::object(), "file"), RunQuality{});
  EXPECT_EQ(scan_quality_of({{"resolution_m", 0.02}}, "file").resolution_m, 0.02);
}

TEST(Quality, JsonThatIsWrongIsRefusedByName) {
  const auto fault = [](const char* text) {
    return test::error_of([&] { run_quality_of(nlohmann::ordered_json::parse(text), "presets.json: fast"); });
  };
  EXPECT_EQ(fault("[]"), "presets.json: fast: is not a JSON object of settings");
  EXPECT_EQ(fault(R"({"depth_stride": 3})"), "presets.json: fast: depth_stride = 3: must be 1, 2 or 4");
  EXPECT_EQ(fault(R"({"depth_stride": 2.5})"), "presets.json: fast: depth_stride = 2.5: must be 1, 2 or 4");
  EXPECT_EQ(fault(R"({"radar": "guessed"})"),
            "presets.json: fast: radar = guessed: must be exact, sampled or passes");
  EXPECT_EQ(fault(R"({"shadows": 1})"), "presets.json: fast: shadows = 1: must be on or off");
  EXPECT_EQ(fault(R"({"tracking_px": 1e99})"),
            "presets.json: fast: tracking_px = 1e+99: must be between 40 and 640");
  EXPECT_EQ(fault(R"({"mesh_tolerance_sigmas": null})"),
            "presets.json: fast: mesh_tolerance_sigmas = null: must be between 0.1 and 100");
  EXPECT_EQ(fault(R"({"mesh_tolerance_sigmas": {"a": 1}})"),
            "presets.json: fast: mesh_tolerance_sigmas: is not a single value");
  EXPECT_NE(fault(R"({"depth_strid": 2})").find("there is no setting \"depth_strid\""), std::string::npos);
}

TEST(Quality, FormerNamesOfFieldsAreReadAndNewOnesWritten) {
  const char* const kOld =
      R"({"mesh_sigmas": 1.5, "object_turns": 2, "shadow_turns": 3, "picture_turns": 4})";
  const RunQuality made = run_quality_of(nlohmann::ordered_json::parse(kOld), "file");
  const RunQuality wanted{.mesh_tolerance_sigmas = 1.5,
                          .move_every_n_frames = 2,
                          .shadow_every_n_frames = 3,
                          .picture_every_n_frames = 4};
  EXPECT_EQ(made, wanted);
  const FieldWords words = words_of(made);
  const FieldWords new_words{{"mesh_tolerance_sigmas", "1.5"},
                             {"move_every_n_frames", "2"},
                             {"shadow_every_n_frames", "3"},
                             {"picture_every_n_frames", "4"}};
  EXPECT_EQ(words, new_words);
  const nlohmann::ordered_json written = to_json(made);
  for (const char* name : {"mesh_sigmas", "object_turns", "shadow_turns", "picture_turns"})
    EXPECT_FALSE(written.contains(name)) << name;
  RunQuality quality;
  EXPECT_EQ(test::error_of([&] { set_field(quality, "object_turns", "0"); }),
            "move_every_n_frames = 0: must be between 1 and 16");
  EXPECT_THROW(set_field(quality, "", "1"), Error) << "most fields have no former name";
}

TEST(Quality, NumbersThatAreNoneAreRefused) {
  RunQuality quality;
  for (const char* word : {"nan", "inf", "-1", "", "1e400", "0.5 "})
    EXPECT_THROW(set_field(quality, "mesh_tolerance_sigmas", word), Error) << word;
  EXPECT_EQ(quality, RunQuality{});
  quality.mesh_tolerance_sigmas = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(require_valid(quality), Error);
  EXPECT_THROW(require_valid(ScanQuality{.fuse_every = 0}), Error);
}

TEST(Quality, LengthsInPixelsAreOfWholeDepthImages) {
  for (const int stride : {2, 4}) {
    SessionConfig config;
    apply(RunQuality{.depth_stride = stride}, config);
    const SessionConfig defaults;
    EXPECT_EQ(config.scene.mesh.skirt_gap_px * stride, defaults.scene.mesh.skirt_gap_px);
    EXPECT_EQ(config.scene.mesh.stride_px, 1);  // 2 pixels of the full image; 1 is the minimum
    EXPECT_EQ(config.scene.foreground.hole_reach_px * stride, defaults.scene.foreground.hole_reach_px);
  }
}

TEST(Quality, DefaultsChangeNothing) {
  // Each field's default must equal that of the config it sets; otherwise applying defaults would change a
  // run.
  SessionConfig config;
  apply(RunQuality{}, config);
  const SessionConfig defaults;
  EXPECT_EQ(config.depth_stride, defaults.depth_stride);
  EXPECT_EQ(config.tracking_px, defaults.tracking_px);
  EXPECT_EQ(config.verify_every_n_frames, defaults.verify_every_n_frames);
  EXPECT_EQ(config.picture.bridge_gaps, defaults.picture.bridge_gaps);
  EXPECT_EQ(config.scene.moved.deviation_sigmas, defaults.scene.moved.deviation_sigmas);
  EXPECT_EQ(config.scene.foreground.min_region_px, defaults.scene.foreground.min_region_px);
  EXPECT_EQ(config.scene.foreground.hole_reach_px, defaults.scene.foreground.hole_reach_px);
  EXPECT_EQ(config.scene.foreground.weak_reach_px, defaults.scene.foreground.weak_reach_px);
  EXPECT_EQ(config.scene.mesh.stride_px, defaults.scene.mesh.stride_px);
  EXPECT_EQ(config.scene.mesh.skirt_gap_px, defaults.scene.mesh.skirt_gap_px);
  EXPECT_EQ(config.fine_mesh, defaults.fine_mesh);
  EXPECT_EQ(config.radar, defaults.radar);
  EXPECT_EQ(config.physics.max_step_s, defaults.physics.max_step_s);
  EXPECT_EQ(config.move_every_n_frames, defaults.move_every_n_frames);
  EXPECT_EQ(config.object_error_px, defaults.object_error_px);
  EXPECT_EQ(config.picture.occlusion.edge_reach_px, defaults.picture.occlusion.edge_reach_px);
  EXPECT_EQ(config.picture.shadow_strength, defaults.picture.shadow_strength);
  EXPECT_EQ(config.shadow_every_n_frames, defaults.shadow_every_n_frames);
  EXPECT_EQ(config.picture_every_n_frames, defaults.picture_every_n_frames);
  PrescanConfig scan;
  apply(ScanQuality{}, scan);
  const PrescanConfig default_scan;
  EXPECT_EQ(scan.resolution_m, default_scan.resolution_m);
  EXPECT_EQ(scan.surface.max_deviation_m, default_scan.surface.max_deviation_m);
  EXPECT_EQ(scan.odometry.view.finest_width_px, default_scan.odometry.view.finest_width_px);
  EXPECT_EQ(scan.fuse_every, default_scan.fuse_every);
}

}  // namespace
}  // namespace roomradar::quality_test
