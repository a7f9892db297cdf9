// presets_test.cpp: the presets file: round trip, and every kind of error in it.
#include "app/quality/presets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::presets_test {
namespace {

constexpr const char* kBegin = R"({"format": "roomradar presets", "format_version": 1)";

std::string fault_of_text(const std::string& text) {
  return test::error_of([&] { presets_of(text, "p.json"); });
}

TEST(Presets, WrittenAndReadTheyAreTheSame) {
  const test::TemporaryFolder folder;
  Presets presets;
  presets.made_by = {{"machine", "two cores"}};
  presets.presets["fast"] = {{.resolution_m = 0.02}, {.depth_stride = 2}, {{"frame_ratio", 1.0 / 3.0}}};
  presets.front.resize(2);
  presets.front[1] = {{.radar = RadarMode::kSampled}, {0.5, 0.25, 1.5, 1.0}, 5, {{"contact_error_m", 0.001}}};
  const auto path = folder.path() / "presets.json";
  write_presets(presets, path);
  const Presets again = read_presets(path);
  EXPECT_EQ(again.made_by, presets.made_by);
  EXPECT_EQ(again.presets.at("fast").scan, presets.presets.at("fast").scan);
  EXPECT_EQ(again.presets.at("fast").run, presets.presets.at("fast").run);
  EXPECT_EQ(again.presets.at("fast").figures, presets.presets.at("fast").figures);
  ASSERT_EQ(again.front.size(), 2U);
  EXPECT_EQ(again.front[1].run, presets.front[1].run);
  EXPECT_EQ(again.front[1].part_ratios, presets.front[1].part_ratios);
  EXPECT_EQ(again.front[1].objects, 5);
  EXPECT_EQ(again.front[1].figures, presets.front[1].figures);
}

TEST(Presets, TheProgramsOwnHasThreeAndAFrontThatBeginsWithTheDefault) {
  const Presets presets = read_presets(ROOMRADAR_PRESETS);
  ASSERT_GE(presets.front.size(), 3U);
  for (const char* name : {"fast", "balanced", "accurate"}) {
    const RunQuality run = preset_named(presets, name, "own").run;
    EXPECT_TRUE(std::any_of(presets.front.begin(), presets.front.end(),
                            [&](const FrontStep& step) { return step.run == run; }))
        << name << ": a budget goes on from it";
  }
  EXPECT_EQ(presets.front.front().run, RunQuality{});
}

TEST(Presets, WhatIsWrongIsNamed) {
  const std::string begin = kBegin;
  EXPECT_EQ(fault_of_text("{"), "p.json: is not a file of presets, or is damaged");
  EXPECT_EQ(fault_of_text("[]"), "p.json: is not a file of presets, or is damaged");
  EXPECT_EQ(fault_of_text(R"({"format": "roomradar presets", "format_version": 2})"),
            "p.json: has another format version than 1, which this program reads");
  EXPECT_EQ(fault_of_text(begin + R"(, "presents": {}})"),
            "p.json: \"presents\" is not known; allowed are format, format_version, made_by, presets, front");
  EXPECT_EQ(fault_of_text(begin + R"(, "presets": {"fast": {"run": {"depth_stride": 3}}}})"),
            "p.json: fast: run: depth_stride = 3: must be 1, 2 or 4");
  EXPECT_EQ(fault_of_text(begin + R"(, "presets": {"fast": {"figures": {"a": "b"}}}})"),
            "p.json: fast: figures: a: is not a number");
  EXPECT_EQ(fault_of_text(begin + R"(, "front": [{}, {"part_ratios": {"mesh": 0}}]})"),
            "p.json: front[1]: part_ratios: mesh = 0: must be > 0, at most 1000");
  EXPECT_EQ(fault_of_text(begin + R"(, "front": [{"objects": 1.5}]})"),
            "p.json: front[0]: objects = 1.5: must be a whole number, at most 1000000");
  EXPECT_EQ(fault_of_text(begin + R"(, "front": {}})"), "p.json: front: is not a list, or longer than 1000");
  EXPECT_EQ(fault_of_text(begin + R"(, "made_by": {"machine": 2}})"),
            "p.json: made_by: machine: is not text");
  const std::string deep =
      std::string(400'000, '[') + std::string(400'000, ']');  // must be neither copied nor printed
  EXPECT_EQ(fault_of_text(begin + R"(, "made_by": {"machine": )" + deep + "}}"),
            "p.json: made_by: machine: is not text");
  EXPECT_EQ(fault_of_text(begin + R"(, "presets": {"fast": {"figures": {"a": )" + deep + "}}}}"),
            "p.json: fast: figures: a: is not a number");
  EXPECT_NE(fault_of_text(begin + R"(, "presets": {"fast": {"run": {"shadows": )" + deep + "}}}}"), "");
  EXPECT_TRUE(presets_of(begin + "}", "p.json").front.empty());
}

TEST(Presets, UnknownNameListsThoseThatThereAre) {
  const Presets presets = presets_of(std::string(kBegin) + R"(, "presets": {"a": {}, "b": {}}})", "p.json");
  EXPECT_EQ(test::error_of([&] { preset_named(presets, "c", "p.json"); }),
            "p.json: has no preset \"c\"; it has a, b");
  EXPECT_EQ(preset_named(presets, "a", "p.json").run, RunQuality{});
}

TEST(Presets, HugeOrMissingFilesAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_NE(test::error_of([&] {
              read_presets(folder.path() / "none");
            }).find("is missing; expected a file of presets"),
            std::string::npos);
  std::ofstream(folder.path() / "huge") << std::string((1U << 20U) + 1U, ' ');
  EXPECT_NE(test::error_of([&] { read_presets(folder.path() / "huge"); }).find("too many"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar::presets_test
