// start_state_test.cpp: what is chosen stays chosen, and what cannot be done says why.
#include "app/start/start_state.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "app/start/map_tasks.hpp"
#include "tests/app/start/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::start_state_test {
namespace {

namespace fs = std::filesystem;

class StartStates : public ::testing::Test {
 protected:
  StartStates() {
    state_.folder = here_;
    save_small_map(here_ / "maps/a");
    refresh_sources(state_, {});
    refresh_maps(state_);
  }
  void add_map(const std::string& name, int hours_ago) const {
    save_small_map(here_ / name);
    fs::last_write_time(here_ / name / "map.json",
                        fs::file_time_type::clock::now() - std::chrono::hours(hours_ago));
  }

  TemporaryFolder folder_;
  fs::path here_ = folder_.path();
  StartState state_;
};

TEST_F(StartStates, TheChoiceFollowsItsEntry) {
  state_.active = StartList::kMaps;
  add_map("maps/b", 3);
  add_map("maps/c", 5);
  refresh_maps(state_);
  move_choice(state_, 1);
  ASSERT_EQ(chosen_map(state_)->folder, here_ / "maps/b");
  add_map("maps/d", 1);
  fs::last_write_time(here_ / "maps/c/map.json", fs::file_time_type::clock::now());
  refresh_maps(state_);
  EXPECT_EQ(chosen_map(state_)->folder, here_ / "maps/b");
  delete_map(here_ / "maps/b");
  refresh_maps(state_);
  EXPECT_EQ(state_.map, 0U);

  state_.active = StartList::kSources;
  move_choice(state_, 2);
  const std::string chosen = chosen_source(state_)->source;
  refresh_sources(state_, {{SourceKind::kRecording, "new", "", (here_ / "new").string(), "", ""}});
  EXPECT_EQ(chosen_source(state_)->source, chosen);
}

TEST_F(StartStates, MovingStopsAtTheEnds) {
  move_choice(state_, -5);
  EXPECT_EQ(state_.source, 0U);
  move_choice(state_, 1 << 20);
  EXPECT_EQ(state_.source, state_.sources.size() - 1);
  state_.active = StartList::kMaps;
  state_.maps.clear();
  move_choice(state_, 1);
  EXPECT_EQ(chosen_map(state_), nullptr);
}

TEST_F(StartStates, WhatWasLastUsedIsListedAndChosen) {
  const TemporaryFolder elsewhere;
  save_small_map(elsewhere.path() / "room");
  StartState state;
  state.folder = here_;
  state.settings.last_map = (elsewhere.path() / "room").string();
  state.settings.last_source = "sim:shelf?seed=9";
  refresh_sources(state, {});
  refresh_maps(state);
  EXPECT_EQ(state.maps.size(), 2U);
  EXPECT_EQ(chosen_map(state)->folder, elsewhere.path() / "room");
  EXPECT_EQ(chosen_source(state)->source, "sim:shelf?seed=9");
  state.settings.last_map = "/not/here";
  state.settings.last_source = "/not/here/either";
  state.sources.clear();
  state.maps.clear();
  refresh_sources(state, {});
  refresh_maps(state);
  EXPECT_EQ(state.maps.size(), 1U);
  EXPECT_EQ(state.source, 0U);
}

TEST_F(StartStates, NamesAreMapsSourcesOrASentence) {
  add_map("elsewhere/b", 2);
  choose(state_, (here_ / "elsewhere/b/").string());
  EXPECT_EQ(chosen_map(state_)->folder, here_ / "elsewhere/b");
  EXPECT_EQ(state_.active, StartList::kMaps);
  choose(state_, (here_ / "maps/a/map.json").string());
  EXPECT_EQ(chosen_map(state_)->folder, here_ / "maps/a");
  choose(state_, "sim:wall?seed=7");
  EXPECT_EQ(chosen_source(state_)->source, "sim:wall?seed=7");
  EXPECT_EQ(state_.active, StartList::kSources);
  refresh_sources(state_, {});
  EXPECT_EQ(chosen_source(state_)->source, "sim:wall?seed=7");
  EXPECT_FALSE(state_.message.is_fault);
  std::ofstream(here_ / "notes.txt") << "x";
  choose(state_, (here_ / "notes.txt").string());
  EXPECT_TRUE(state_.message.is_fault);
  EXPECT_NE(state_.message.text.find("notes.txt"), std::string::npos);
  EXPECT_EQ(chosen_source(state_)->source, "sim:wall?seed=7");
}

TEST_F(StartStates, WhatCannotBeDoneSaysWhy) {
  for (const StartAction action : {StartAction::kScan, StartAction::kPlay, StartAction::kScanMore,
                                   StartAction::kExport, StartAction::kRename, StartAction::kDelete})
    EXPECT_EQ(why_not(state_, action), "");
  EXPECT_NE(why_not(state_, StartAction::kCompare).find("needs two"), std::string::npos);
  std::ofstream(here_ / "maps/a/map.json") << "{}";
  refresh_maps(state_);
  for (const StartAction action :
       {StartAction::kPlay, StartAction::kScanMore, StartAction::kExport, StartAction::kRename})
    EXPECT_NE(why_not(state_, action).find("map.json"), std::string::npos);
  EXPECT_EQ(why_not(state_, StartAction::kDelete), "");
  EXPECT_EQ(why_not(state_, StartAction::kScan), "");
  state_.maps.clear();
  EXPECT_NE(why_not(state_, StartAction::kPlay).find("scan a room first"), std::string::npos);
  state_.sources[0].fault = "broken";
  EXPECT_EQ(why_not(state_, StartAction::kScan), "broken");
}

TEST(StartChoices, AreCommandLines) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(command_of({StartAction::kScan, "kinect:0", "maps/a"}, {}),
            (Words{"prescan", "kinect:0", "--map", "maps/a", "--window"}));
  EXPECT_EQ(command_of({StartAction::kScanMore, "rec", "maps/a"}, {{}, {}, 1.25}),
            (Words{"prescan", "rec", "--map", "maps/a", "--window", "--resume", "--ui-scale", "1.25"}));
  EXPECT_EQ(command_of({StartAction::kPlay, "-rec", "-map"}, {}),
            (Words{"run", "./-rec", "--map", "./-map", "--window"}));
}

}  // namespace
}  // namespace roomradar::test::start_state_test
