// trade_test.cpp: plots, comparisons, choices and files of the trade command, on known numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <sstream>

#include "app/evaluation/pareto/choose_presets.hpp"
#include "app/evaluation/pareto/pareto_front.hpp"
#include "app/evaluation/pareto/setting_choice.hpp"
#include "app/evaluation/pareto/sweep.hpp"
#include "app/evaluation/pareto/sweep_jobs.hpp"
#include "app/evaluation/trade/picture_judge.hpp"
#include "app/evaluation/trade/prescan_work.hpp"
#include "app/evaluation/trade/run_work.hpp"
#include "app/evaluation/trade/trade_csv.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/evaluation/trade/trade_page.hpp"
#include "app/evaluation/trade/trade_presets.hpp"
#include "app/farm/manifest.hpp"
#include "app/sim/simulate.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::trade_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

const std::vector<Parameter> kParameters{
    {"fine", {"4", "2", "1"}, 2}, {"how", {"fast", "slow"}, 1}, {"many", {"1", "9"}, 0, true}};

TEST(Front, HoldsWhatNothingBeatsInBothAndOnlyThat) {
  CounterRandom random(7, 0);
  std::vector<CostAndError> points;
  for (int i = 0; i < 200; ++i)  // coarse numbers, thus with ties
    points.push_back({std::floor(10.0 * random.uniform()), std::floor(10.0 * random.uniform())});
  const std::vector<std::size_t> front = pareto_front_of(points);
  std::set<std::size_t> on(front.begin(), front.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CostAndError& q = points[i];
    const bool is_beaten = std::any_of(points.begin(), points.end(), [&](const auto& p) {
      return p.cost <= q.cost && p.error <= q.error && (p.cost < q.cost || p.error < q.error);
    });
    const bool has_twin_on = std::any_of(front.begin(), front.end(), [&](std::size_t j) {
      return points[j].cost == points[i].cost && points[j].error == points[i].error;
    });
    EXPECT_EQ(has_twin_on, !is_beaten) << i;
    if (on.count(i) > 0) {
      EXPECT_FALSE(is_beaten) << i;
    }
  }
  for (std::size_t k = 1; k < front.size(); ++k) {
    EXPECT_LT(points[front[k - 1]].cost, points[front[k]].cost);
    EXPECT_GT(points[front[k - 1]].error, points[front[k]].error);
  }
}

TEST(Front, LeavesOutWhatIsNotFiniteAndOfNothingIsEmpty) {
  EXPECT_TRUE(pareto_front_of({}).empty());
  EXPECT_TRUE(
      pareto_front_of({{kNone, 0.0}, {0.0, kNone}, {1.0, std::numeric_limits<double>::infinity()}}).empty());
  EXPECT_EQ(pareto_front_of({{kNone, 0.0}, {2.0, 2.0}, {2.0, 2.0}}), std::vector<std::size_t>{1});
}

TEST(DrawSettings, GivesEachWordAndNoSettingTwiceAndTheSameForTheSameSeed) {
  for (const std::vector<Parameter>& parameters : {scan_parameters(), run_parameters()}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const std::vector<Setting> settings = draw_settings(parameters, 24, seed);
      ASSERT_EQ(settings.size(), 24U);
      EXPECT_EQ(draw_settings(parameters, 24, seed), settings);
      EXPECT_NE(draw_settings(parameters, 24, seed + 10), settings);
      EXPECT_EQ(std::set<Setting>(settings.begin(), settings.end()).size(), settings.size());
      EXPECT_EQ(std::count(settings.begin(), settings.end(), default_setting(parameters)), 0);
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (parameters[k].is_load) continue;
        for (std::size_t word = 0; word < parameters[k].words.size(); ++word)
          EXPECT_TRUE(
              std::any_of(settings.begin(), settings.end(), [&](const Setting& s) { return s[k] == word; }))
              << parameters[k].name << " " << parameters[k].words[word];
      }
    }
  }
}

TEST(DrawSettings, TurnsOneKnobAloneInUpToTwoThirdsAndALoadNeverWithOthers) {
  const std::vector<Setting> settings = draw_settings(kParameters, 8, 1);
  const Setting defaults = default_setting(kParameters);
  int single = 0;
  for (const Setting& setting : settings) {
    int turned = 0;
    for (std::size_t k = 0; k < defaults.size(); ++k) turned += setting[k] != defaults[k] ? 1 : 0;
    single += turned == 1 ? 1 : 0;
    if (!has_default_load(kParameters, setting)) {
      EXPECT_EQ(turned, 1);
    }
  }
  EXPECT_GE(single, 4);
}

TEST(DrawSettings, SingleTurnsTowardsWhatIsFasterComeFirst) {
  const std::vector<Parameter> parameters = run_parameters(20);
  const Setting defaults = default_setting(parameters);
  std::size_t faster = 0, faster_drawn = 0;
  for (const Parameter& parameter : parameters)
    if (!parameter.is_load) faster += parameter.defaults;
  for (const Setting& setting : draw_settings(parameters, (3 * faster + 1) / 2, 1)) {
    int turned = 0, towards_faster = 0;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      turned += setting[k] != defaults[k] ? 1 : 0;
      towards_faster += setting[k] < defaults[k] && !parameters[k].is_load ? 1 : 0;
    }
    faster_drawn += turned == 1 && towards_faster == 1 ? 1 : 0;
  }
  EXPECT_GE(faster_drawn, faster);
}

TEST(DrawSettings, TheNextFasterWordOfEveryKnobComesBeforeAnyFartherOne) {
  const std::vector<Parameter> parameters = run_parameters(5);
  std::size_t next_words = 0;
  for (const Parameter& parameter : parameters)
    next_words += !parameter.is_load && parameter.defaults > 0 ? 1 : 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const std::vector<Setting> settings = draw_settings(parameters, 3 * next_words / 2, seed);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k].is_load || parameters[k].defaults == 0) continue;
      Setting turn = default_setting(parameters);
      --turn[k];
      EXPECT_EQ(std::count(settings.begin(), settings.end(), turn), 1)
          << parameters[k].name << ", seed " << seed;
    }
  }
}

TEST(DrawSettings, GivesFewerWhereThereAreNotSoManyToBeFound) {
  const std::vector<Setting> settings = draw_settings(kParameters, 1000, 1);
  EXPECT_EQ(settings.size(), 6U);  // 3 x 2, minus the default, plus the load
  EXPECT_TRUE(draw_settings({}, 5, 1).empty());
}

TEST(Knobs, WordsMakeAQualityAndTheUsualOnesTheDefault) {
  EXPECT_EQ(scan_quality_of(default_setting(scan_parameters())), ScanQuality{});
  EXPECT_EQ(run_setting_of(default_setting(run_parameters())).quality, RunQuality{});
  EXPECT_EQ(run_setting_of(default_setting(run_parameters())).objects, 1);
  EXPECT_EQ(run_setting_of(default_setting(run_parameters(20))).objects, 20);
  EXPECT_THROW((void)run_parameters(2), Error);
  for (const std::vector<Parameter>& parameters : {scan_parameters(), run_parameters()}) {
    const bool is_scan = parameters.front().name == scan_parameters().front().name;
    for (std::size_t k = 0; k < parameters.size(); ++k)
      for (std::size_t word = 0; word < parameters[k].words.size(); ++word) {
        Setting setting = default_setting(parameters);
        setting[k] = word;
        if (is_scan)
          require_valid(scan_quality_of(setting));
        else
          require_valid(run_setting_of(setting).quality);
      }
  }
  EXPECT_EQ(describe(kParameters, {2, 1, 0}), "default");
  EXPECT_EQ(describe(kParameters, {0, 1, 1}), "fine 4, many 9");
}

/// A simulated machine that becomes slower with each measurement. Time: 10 ms for the default setting, halved
/// for each step of `fine`. The error grows as the time falls.
struct Machine {
  double slower = 1.0;  // factor per measurement
  int asked = 0;
  std::vector<std::string> order;

  MeasuredWork work(std::vector<std::string> scenes = {"a", "b"}) {
    MeasuredWork work{.name = "work", .parameters = kParameters, .scenes = std::move(scenes)};
    work.figures = {{"time_ms", "time, ms", 1.0, FigureKind::kTime},
                    {"error_m", "error, mm", 1e3, FigureKind::kError, 0.0001},
                    {"cells", "cells"}};
    work.open = [this](std::size_t scene) -> Measure {
      return [this, scene](const Setting& setting) -> Readings {
        order.push_back(describe(kParameters, setting));
        const double busy = std::pow(slower, asked++);
        const double steps = 2.0 - static_cast<double>(setting[0]);
        if (setting[1] == 0) throw Error("cannot be done");
        return {10.0 * busy * std::pow(0.5, steps),
                0.001 * (1.0 + steps) * (1.0 + static_cast<double>(scene)), scene == 0 ? 5.0 : kNone};
      };
    };
    return work;
  }
};

TEST(Sweep, RatiosAreFlatThoughTheMachineSlowsDownTwofold) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const std::vector<Setting> settings{{2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
  machine.slower = std::pow(2.0, 1.0 / (2.0 * 2.0 * 7.0));  // twofold over all of the sweep's measurements
  const std::vector<SweepRow> rows = sweep(work, {settings, 2, 1}).rows;
  ASSERT_EQ(rows.size(), 12U);
  EXPECT_GT(rows.back().default_after.front(), 1.9 * rows.front().default_before.front())
      << "it did slow down";
  const std::vector<SettingSummary> summaries = summarise(work, settings, rows);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(summaries[i].time_ratio, std::pow(0.5, static_cast<double>(i)), 0.001);
    EXPECT_NEAR(summaries[i].most_ratio / summaries[i].least_ratio, 1.0, 0.002);
    EXPECT_EQ(summaries[i].rows, 4);
    EXPECT_TRUE(summaries[i].is_complete);
    EXPECT_NEAR(summaries[i].figures[1], 0.0015 * (1.0 + static_cast<double>(i)), 1e-9);
    EXPECT_EQ(summaries[i].figures[2], 5.0) << "of the scenes that know it";
  }
}

TEST(Sweep, MeasuresTheDefaultBetweenAnyTwoAndEachRepeatInAnOrderOfItsOwn) {
  Machine machine;
  const MeasuredWork work = machine.work({"a"});
  const std::vector<Setting> settings{{1, 1, 0}, {0, 1, 0}, {2, 1, 1}, {1, 1, 1}, {0, 1, 1}};
  (void)sweep(work, {settings, 2, 3});
  ASSERT_EQ(machine.order.size(), 22U);
  std::vector<std::string> first, second;
  for (std::size_t i = 0; i < 22; ++i) {
    if (i % 11 % 2 == 0) {
      EXPECT_EQ(machine.order[i], "default");
    } else {
      (i < 11 ? first : second).push_back(machine.order[i]);
    }
  }
  EXPECT_NE(first, second);
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  EXPECT_EQ(first, second);
}

TEST(Sweep, TheDefaultsOwnRowIsTheFirstSoThatACutOffSweepCanBeCompared) {
  Machine machine;
  const MeasuredWork work = machine.work({"a"});
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<SweepRow> rows = sweep(work, {{{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, 2, seed}).rows;
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[0].setting, 2U);
    EXPECT_EQ(rows[3].setting, 2U);
  }
}

TEST(Sweep, GoesOnWhereASettingCannotBeDoneAndKeepsWhatWasDoneWhereItIsStopped) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const std::vector<Setting> settings{{2, 1, 0}, {2, 0, 0}, {1, 1, 0}};
  const std::vector<SweepRow> rows = sweep(work, {settings, 1, 1}).rows;
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(),
                          [](const SweepRow& row) { return row.fault == "cannot be done"; }),
            2);
  const std::vector<SettingSummary> summaries = summarise(work, settings, rows);
  EXPECT_EQ(summaries[1].rows, 0);
  EXPECT_FALSE(summaries[1].is_complete);
  EXPECT_TRUE(std::isnan(summaries[1].time_ratio));

  std::size_t told = 0;
  const std::vector<SweepRow> some =
      sweep(work, {settings, 1, 1}, {[&](const SweepRow&) { ++told; }, [&] { return told == 2; }}).rows;
  EXPECT_EQ(some.size(), 2U);
  // An unfinished scene does not reduce the finished ones to a few settings.
  told = 0;
  const std::vector<SweepRow> whole =
      sweep(work, {settings, 1, 1}, {[&](const SweepRow&) { ++told; }, [&] { return told == 4; }}).rows;
  EXPECT_EQ(told, 4U);
  EXPECT_EQ(whole.size(), 3U);
  EXPECT_TRUE(summarise(work, settings, whole)[2].is_complete);
}

TEST(Sweep, KeepsWhatWasMeasuredBeforeSomethingFailed) {
  const std::vector<Setting> settings{{2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
  // The second scene, or its default, fails: results of the first are kept.
  for (const bool is_opened : {true, false}) {
    Machine machine;
    MeasuredWork work = machine.work({"a", "b"});
    const auto sound = work.open;
    work.open = [&, sound](std::size_t scene) -> Measure {
      if (scene == 0) return sound(scene);
      if (!is_opened) throw Error("no such folder");
      return [](const Setting&) -> Readings { throw Error("no memory"); };
    };
    const SweptRows result = sweep(work, {settings, 1, 1});
    EXPECT_EQ(result.fault, is_opened ? "no memory" : "no such folder");
    EXPECT_EQ(result.rows.size(), 3U);
  }
  // The same if the rows' file is full; the row that could not be written is kept, too.
  Machine machine;
  int written = 0;
  const auto write = [&](const SweepRow&) {
    if (++written == 2) throw Error("the disk is full");
  };
  const SweptRows full = sweep(machine.work({"a"}), {settings, 1, 1}, {write, {}});
  EXPECT_EQ(full.fault, "the disk is full");
  EXPECT_EQ(full.rows.size(), 2U);
  // A default that fails in its own row invalidates all comparisons: reported immediately.
  MeasuredWork once = machine.work({"a"});
  int asked = 0;
  once.open = [&](std::size_t) -> Measure {
    return [&](const Setting&) -> Readings {
      if (++asked == 2) throw Error("no memory");
      return {1.0, 1.0, 1.0};
    };
  };
  EXPECT_EQ(sweep(once, {settings, 1, 1}).fault, "no memory");
  EXPECT_EQ(asked, 2);
  MeasuredWork impossible = machine.work();
  impossible.parameters[1].defaults = 0;
  EXPECT_EQ(sweep(impossible, {settings, 1, 1}).fault, "cannot be done");
  EXPECT_TRUE(sweep(impossible, {settings, 1, 1}).rows.empty());
  // Ctrl-C also ends the current measurement, and is not an error.
  asked = 0;
  const SweptRows stopped = sweep(once, {settings, 1, 1}, {{}, [&] { return asked == 2; }});
  EXPECT_EQ(stopped.fault, "");
  EXPECT_TRUE(stopped.rows.empty());
}

TEST(TradeFrames, AreAsManyAsTheRecordingHas) {
  const test::TemporaryFolder folder;
  SimOptions options = parse_sim_spec("sim:table?frames=40&width=64");
  simulate(folder.path() / "r", options, RecordingFormat::kTum, [](std::int64_t, std::int64_t) {});
  const std::string recording = (folder.path() / "r").string();
  EXPECT_EQ(frames_of_recording(recording, 35).size(), 35U);
  EXPECT_EQ(frames_of_recording(recording, 360).size(), 40U);
  EXPECT_NE(test::error_of([&] { (void)frames_of_recording(recording, 29); }).find("at least 30"),
            std::string::npos);
}

TEST(Summaries, OfASceneThatOthersWereMeasuredInTooAreNotComplete) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const std::vector<Setting> settings{{2, 1, 0}, {1, 1, 0}};
  std::vector<SweepRow> rows = sweep(work, {settings, 1, 1}).rows;
  std::erase_if(rows, [](const SweepRow& row) { return row.scene == 1 && row.setting == 1; });
  const std::vector<SettingSummary> summaries = summarise(work, settings, rows);
  EXPECT_TRUE(summaries[0].is_complete);
  EXPECT_FALSE(summaries[1].is_complete);
  EXPECT_EQ(loss_of(work, summaries[0], summaries[0]), 1.0);
  EXPECT_TRUE(std::isnan(loss_of(work, summaries[1], summaries[0])))
      << "its errors are of another scene than the default's";
}

SettingSummary summary_of(const Setting& setting, double time_ratio, double error_m) {
  return {setting, 1, time_ratio, time_ratio, time_ratio, {}, {time_ratio, error_m, 0.0}, true};
}

TEST(Presets, AreTheFastestTheFastestOfLittleLossAndTheBestWithinReason) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const std::vector<SettingSummary> summaries{
      summary_of({2, 1, 0}, 1.0, 0.0019),   // the default
      summary_of({1, 1, 0}, 0.5, 0.00209),  // balanced: a loss of nearly 1.1
      summary_of({0, 1, 0}, 0.45, 0.0028),  // fast, 1.45
      summary_of({0, 1, 0}, 0.3, 0.0058),   // nearly 3 times the default's error: on the front, but no preset
      summary_of({0, 1, 0}, 0.1, 0.0299),   // too inaccurate for the front
      summary_of({2, 1, 0}, 2.9, 0.0009),   // accurate
      summary_of({2, 1, 0}, 5.0, 0.0004),   // too slow
      summary_of({2, 1, 0}, 3.0, 0.0010),   // dominated
      summary_of({2, 1, 1}, 0.1, 0.0001)};  // another load
  const PresetChoice choice = choose_presets(work, summaries, 0);
  EXPECT_EQ(choice.front, (std::vector<std::size_t>{3, 2, 1, 0, 5, 6}));
  EXPECT_EQ(choice.fast, 2U);
  EXPECT_EQ(choice.balanced, 1U);
  EXPECT_EQ(choice.accurate, 5U);
  EXPECT_EQ(loss_of(work, summaries[0], summaries[0]), 1.0);
  EXPECT_NEAR(loss_of(work, summaries[1], summaries[0]), 1.095, 1e-12);
  EXPECT_EQ(names_of(0, 0, choice, " "), "default");
  EXPECT_EQ(names_of(2, 2, choice, " "), "default fast");
}

TEST(Presets, WhatIsTooBadForOneInASingleErrorDoesNotPushAsideWhatIsNot) {
  Machine machine;
  MeasuredWork work = machine.work();
  work.figures.push_back({"other_m", "another error, mm", 1e3, FigureKind::kError, 0.0001});
  const auto of = [&](double time_ratio, double error_m, double other_m) {
    SettingSummary summary = summary_of({1, 1, 0}, time_ratio, error_m);
    summary.figures.push_back(other_m);
    return summary;
  };
  std::vector<SettingSummary> summaries{of(1.0, 0.0009, 0.0009),    // the default
                                        of(0.50, 0.0014, 0.0014),   // 1.5 times both
                                        of(0.49, 0.0003, 0.0041)};  // 0.4 and 4.2 times: a loss of 1.3
  summaries[0].setting = {2, 1, 0};
  const PresetChoice choice = choose_presets(work, summaries, 0);
  EXPECT_EQ(choice.front, (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(choice.fast, 1U);
  EXPECT_EQ(choice.balanced, 0U);
}

TEST(Presets, WhatIsBetterByChanceAloneIsNotCalledAccurate) {
  Machine machine;
  const MeasuredWork work = machine.work();
  std::vector<SettingSummary> summaries{summary_of({2, 1, 0}, 1.0, 0.0019),
                                        summary_of({1, 1, 0}, 0.95, 0.00189)};
  EXPECT_EQ(choose_presets(work, summaries, 0).accurate, 0U);
  summaries[1].figures[1] = 0.0018;
  EXPECT_EQ(choose_presets(work, summaries, 0).accurate, 1U);
  summaries[1].figures[1] = 0.00189;
  summaries[0].is_complete = false;
  EXPECT_EQ(choose_presets(work, summaries, 0).accurate, std::nullopt);
}

TEST(GreedySearch, TurnsFirstWhatGivesMostForLeastAndKeepsItTurned) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const std::vector<SettingSummary> summaries{
      summary_of({2, 1, 0}, 1.0, 0.0019),                                       // the default
      summary_of({1, 1, 0}, 0.8, 0.0020),  summary_of({0, 1, 0}, 0.5, 0.0030),  // one parameter
      summary_of({2, 0, 0}, 0.6, 0.00191), summary_of({2, 1, 1}, 0.1, 0.0001),  // another one, and a load
      summary_of({0, 0, 0}, 0.2, 0.0001)};                                      // both parameters: ignored
  EXPECT_EQ(greedy_settings(work, summaries, 0, 9), (std::vector<Setting>{{1, 0, 0}}));
  std::vector<SettingSummary> without = summaries;
  without.pop_back();
  EXPECT_EQ(greedy_settings(work, without, 0, 9), (std::vector<Setting>{{1, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(greedy_settings(work, without, 0, 1), (std::vector<Setting>{{0, 0, 0}}));
  EXPECT_TRUE(greedy_settings(work, without, 0, 0).empty());
  EXPECT_TRUE(greedy_settings(work, {summary_of({2, 1, 0}, 1.0, kNone)}, 0, 9).empty());
}

TEST(GreedySearch, GoesTheOtherWayToWhatIsBetter) {
  Machine machine;
  MeasuredWork work = machine.work();
  work.parameters[0].defaults = 0;
  work.parameters[1].defaults = 0;
  const std::vector<SettingSummary> summaries{
      summary_of({0, 0, 0}, 1.0, 0.0019), summary_of({1, 0, 0}, 1.1, 0.0015),
      summary_of({2, 0, 0}, 3.0, 0.0014), summary_of({0, 1, 0}, 1.2, 0.0016)};
  EXPECT_EQ(greedy_settings(work, summaries, 0, 9), (std::vector<Setting>{{2, 1, 0}, {1, 1, 0}}));
}

TEST(Presets, OfAnErrorThatNobodyKnowsAreNone) {
  Machine machine;
  const MeasuredWork work = machine.work();
  const PresetChoice choice = choose_presets(work, {summary_of({2, 1, 0}, 1.0, kNone)}, 0);
  EXPECT_TRUE(choice.front.empty());
  EXPECT_FALSE(choice.fast || choice.balanced || choice.accurate);
}

/// Results of run in which the second setting halves the time of all stages. It also moves objects in only
/// half of the frames; time per frame with motion is unchanged.
TradeResult run_result() {
  TradeResult result{.work = run_work({"table"}, {}, TradeScale{})};
  result.settings = {default_setting(result.work.parameters), default_setting(result.work.parameters)};
  const auto parameter = std::find_if(result.work.parameters.begin(), result.work.parameters.end(),
                                      [](const Parameter& k) { return k.name == "move_every_n_frames"; });
  result.settings[1][static_cast<std::size_t>(parameter - result.work.parameters.begin())] = 2;
  for (const double part : {1.0, 0.5}) {
    SettingSummary summary{.setting = result.settings[part < 1.0 ? 1 : 0], .rows = 1, .time_ratio = part};
    for (const FigureName& figure : result.work.figures) {
      const bool is_time = figure.kind == FigureKind::kTime;
      summary.figures.push_back(is_time ? 4.0 * part : 0.001 / part);
      summary.ratios.push_back(is_time ? part : 1.0);
    }
    // median over frames with and without motion
    summary.figures[place_of(result.work, "physics_ms")] = part < 1.0 ? 0.0 : 4.0;
    summary.ratios[place_of(result.work, "physics_ms")] = part < 1.0 ? 0.0 : 1.0;
    summary.figures[place_of(result.work, "moved_ms")] = 4.0;
    summary.ratios[place_of(result.work, "moved_ms")] = 1.0;
    summary.is_complete = true;
    result.summaries.push_back(std::move(summary));
  }
  result.choice = choose_presets(result.work, result.summaries, 0);
  return result;
}

TEST(Presets, AFrontSaysWhatAPartTakesInTheFramesThatHaveIt) {
  const Presets presets = chosen_presets({run_result()}, {{"seed", "1"}});
  ASSERT_EQ(presets.front.size(), 2U);
  EXPECT_EQ(presets.front[0].run, RunQuality{});
  EXPECT_EQ(presets.front[1].run.move_every_n_frames, 2);
  const auto& ratios = presets.front[1].part_ratios;
  EXPECT_EQ(ratios[index_of(FramePart::kLocate)], 0.5);
  EXPECT_EQ(ratios[index_of(FramePart::kMesh)], 0.5);
  EXPECT_EQ(ratios[index_of(FramePart::kCompose)], 0.5);
  EXPECT_EQ(ratios[index_of(FramePart::kPhysics)], 1.0);
  EXPECT_EQ(presets.front[1].objects, 1);
  EXPECT_EQ(presets.front[1].figures.at("time_ratio"), 0.5);
  // A preset that another setting removed from the front is still a step.
  TradeResult pushed = run_result();
  pushed.choice.front = {0};
  pushed.choice.fast = 1;
  EXPECT_EQ(chosen_presets({pushed}, {}).front.size(), 2U);
  // --preset reads the file that trade writes.
  const test::TemporaryFolder folder;
  write_presets(presets, folder.path() / "p.json");
  EXPECT_EQ(read_presets(folder.path() / "p.json").front[1].run, presets.front[1].run);
}

TEST(SettingWords, MakeTheSameSettingAndWrongOnesAreNamed) {
  for (const std::vector<Parameter>& parameters : {scan_parameters(), run_parameters(5)})
    for (const Setting& setting : draw_settings(parameters, 30, 1))
      EXPECT_EQ(setting_from(parameters, setting_words(parameters, setting)), setting);
  EXPECT_EQ(setting_words(kParameters, {2, 1, 0}), "default");
  EXPECT_EQ(setting_from(kParameters, "default"), default_setting(kParameters));
  EXPECT_EQ(setting_words(kParameters, {0, 0, 0}), "fine=4,how=fast");
  const auto fault = [](const std::string& words) {
    return test::error_of([&] { (void)setting_from(kParameters, words); });
  };
  for (const char* wrong : {"", "fine", "fine=", "fine=3", "finer=4", "fine=4,", "fine=4,fine=2", "=", ","})
    EXPECT_NE(fault(wrong).find("setting " + std::string(wrong) + ": "), std::string::npos) << wrong;
  EXPECT_NE(fault("fine=3").find("4, 2, 1"), std::string::npos);
}

/// A simulated machine that measures the settings as jobs of a folder.
struct JobFolder {
  test::TemporaryFolder folder;
  Machine machine;
  MeasuredWork work = machine.work();
  std::vector<Setting> settings{{2, 1, 0}, {1, 1, 0}, {2, 0, 0}};

  std::filesystem::path file(std::size_t scene, std::size_t setting) const {
    return folder.path() / sweep_job_name(work, scene, settings[setting]) / "rows.json";
  }
  /// As the job's process does.
  void run_job(std::size_t scene, std::size_t setting) {
    MeasuredWork of_job = work;
    of_job.scenes = {work.scenes[scene]};
    of_job.open = [&, scene](std::size_t) { return work.open(scene); };
    std::filesystem::create_directories(file(scene, setting).parent_path());
    write_sweep_rows(of_job, sweep(of_job, {{settings[setting]}, 2, 1}).rows, file(scene, setting));
  }
  void run_all() {
    for (std::size_t scene = 0; scene < 2; ++scene)
      for (std::size_t setting = 0; setting < settings.size(); ++setting) run_job(scene, setting);
  }
  std::vector<SweepRow> joined(const std::map<std::string, std::string>& faults = {}) const {
    return joined_sweep_rows(work, settings, 2, folder.path(), faults);
  }
};

TEST(SweepJobs, AreOnePerSettingAndSceneAndMeasureWhatTheSweepDoes) {
  JobFolder jobs;
  jobs.run_all();
  const auto by_jobs = summarise(jobs.work, jobs.settings, jobs.joined());
  const auto alone = summarise(jobs.work, jobs.settings, sweep(jobs.work, {jobs.settings, 2, 1}).rows);
  ASSERT_EQ(by_jobs.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(by_jobs[i].rows, alone[i].rows);
    EXPECT_EQ(by_jobs[i].is_complete, alone[i].is_complete);
    for (std::size_t f = 0; f < alone[i].figures.size(); ++f)
      EXPECT_TRUE(by_jobs[i].figures[f] == alone[i].figures[f] || std::isnan(alone[i].figures[f])) << i << f;
  }
  // Settings that cannot be done are results, too.
  EXPECT_EQ(jobs.joined()[4].fault, "cannot be done");

  const std::string text =
      sweep_manifest(jobs.work, jobs.settings, [](std::size_t scene) { return scene == 0 ? " A" : " B"; });
  const Manifest manifest = parse_manifest(text, "/jobs.txt");
  const std::vector<std::string> names = sweep_job_names(jobs.work, jobs.settings);
  ASSERT_EQ(manifest.jobs.size(), 6U);
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(manifest.jobs[i].name, names[i]);
  EXPECT_EQ(manifest.jobs[4].name, "work-1-110");
  EXPECT_EQ(manifest.jobs[4].words, (std::vector<std::string>{"trade", "--only", "work", "--setting",
                                                              "fine=2", "B", "--rows", "{}/rows.json"}));
}

TEST(SweepJobs, AFailedJobLeavesRowsWithItsFaultAndTheOthersCount) {
  JobFolder jobs;
  jobs.run_all();
  TradeResult result{.work = jobs.work, .settings = jobs.settings, .is_by_jobs = true};
  result.rows = jobs.joined({{"work-1-110", "was killed: Killed"}});
  ASSERT_EQ(result.rows.size(), 12U);
  result.summaries = summarise(result.work, result.settings, result.rows);
  result.choice = choose_presets(result.work, result.summaries, 0);
  EXPECT_EQ(result.summaries[0].rows, 4);
  EXPECT_EQ(result.summaries[1].rows, 2);
  EXPECT_FALSE(result.summaries[1].is_complete) << "its errors are of another scene than the default's";
  EXPECT_EQ(faults_of(result),
            (std::vector<std::string>{"how fast, in a: cannot be done",
                                      "fine 2, in b: job work-1-110: was killed: Killed"}));
  write_trade_page({result}, {}, jobs.folder.path() / "page.html");
  const std::string page = text_of(jobs.folder.path() / "page.html");
  EXPECT_NE(page.find("<b>Not measured:</b> fine 2, in b: job work-1-110: was killed"), std::string::npos);
  EXPECT_NE(page.find("Times are not comparable"), std::string::npos);
  TradeCsv csv(jobs.folder.path() / "rows.csv", {result.work});
  for (const SweepRow& row : result.rows) csv.write(result.work, result.settings, row);
  EXPECT_NE(text_of(jobs.folder.path() / "rows.csv").find("job work-1-110: was killed: Killed,2,slow,1,,,\n"),
            std::string::npos);
}

TEST(SweepJobs, ADamagedFileIsNamed) {
  JobFolder jobs;
  jobs.run_all();
  const std::string good = text_of(jobs.file(0, 1));
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(jobs.file(0, 1)) << text;
    return test::error_of([&] { (void)jobs.joined(); });
  };
  for (const std::string& message :
       {fault("{", ""), fault("roomradar measurements", "roomradar scenarios"),
        fault("\"version\":1", "\"version\":2"), fault("error_m", "other_m"),
        fault("\"repeat\":1", "\"repeat\":2"), fault("\"fault\":\"\"", "\"fault\":0"),
        fault("\"measurements\":[", "\"measurements\":3,\"x\":[")})
    EXPECT_NE(message.find("work-0-110/rows.json: "), std::string::npos) << message;
  std::filesystem::remove(jobs.file(0, 1));
  EXPECT_NE(test::error_of([&] { (void)jobs.joined(); }).find("work-0-110/rows.json"), std::string::npos);
}

TEST(TradeFiles, CsvFieldsAreQuotedWhereTheyMustBe) {
  EXPECT_EQ(csv_field("plain"), "plain");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
}

TEST(TradeFiles, CsvHasAllColumnsInEachLineAndThePageNeedsNothingElse) {
  const test::TemporaryFolder folder;
  Machine machine;
  TradeResult result{.work = machine.work({"a <scene>, \"b\""}),
                     .settings = {{2, 1, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 1}}};
  result.rows = sweep(result.work, {result.settings, 2, 1}).rows;
  result.summaries = summarise(result.work, result.settings, result.rows);
  result.choice = choose_presets(result.work, result.summaries, 0);
  std::ofstream(folder.path() / "rows.csv") << "yesterday's";
  {
    TradeCsv csv(folder.path() / "rows.csv", {result.work});
    EXPECT_EQ(text_of(folder.path() / "rows.csv"), "yesterday's") << "nothing is measured yet";
    for (const SweepRow& row : result.rows) csv.write(result.work, result.settings, row);
    csv.write(result.work, result.summaries, 0, result.choice);
  }
  const std::string csv = text_of(folder.path() / "rows.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8 + 4);
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    bool is_quoted = false;
    int columns = 1;
    for (const char letter : line) {
      is_quoted = is_quoted != (letter == '"');
      columns += letter == ',' && !is_quoted ? 1 : 0;
    }
    EXPECT_EQ(columns, 13 + 3 + 3) << line;
  }
  EXPECT_NE(csv.find("\"a <scene>, \"\"b\"\"\""), std::string::npos);
  EXPECT_EQ(csv.find("nan"), std::string::npos);

  write_trade_page({result}, {"a <machine>"}, folder.path() / "page.html");
  const std::string page = text_of(folder.path() / "page.html");
  EXPECT_NE(page.find("a &lt;machine&gt;"), std::string::npos);
  EXPECT_NE(page.find("a &lt;scene&gt;, &quot;b&quot;"), std::string::npos);
  EXPECT_EQ(page.find("<scene>"), std::string::npos);
  EXPECT_NE(page.find("Time compared: " + result.work.figures[result.work.time].title), std::string::npos);
  EXPECT_EQ(page.find("://"), std::string::npos) << "no network";
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_NE(page.find("prefers-color-scheme"), std::string::npos);
  std::size_t dots = 0;  // two plots of the two settings measured at the default load
  for (std::size_t at = 0; (at = page.find("<g><title>", at)) != std::string::npos; ++at) ++dots;
  EXPECT_EQ(dots, 4U);
  EXPECT_THROW(write_trade_page({result}, {}, folder.path() / "none" / "page.html"), Error);
  TradeCsv nowhere(folder.path() / "none" / "rows.csv", {result.work});
  EXPECT_THROW(nowhere.write(result.work, result.settings, result.rows.front()), Error);
}

// Small images and few frames: checks that figures exist and have plausible sizes, not their values.
constexpr TradeScale kTiny{.scan_px = 160,
                           .scan_frames = 20,
                           .scan_rate_hz = 15.0,
                           .map_frames = 40,
                           .run_px = 160,
                           .run_frames = 22,
                           .scenarios = 4};

/// Returns a work's figures by name; expects them to be finite.
std::map<std::string, double> figures_of(const MeasuredWork& work, const Readings& readings) {
  std::map<std::string, double> figures;
  for (std::size_t i = 0; i < work.figures.size(); ++i) {
    EXPECT_TRUE(std::isfinite(readings[i])) << work.figures[i].name;
    figures[work.figures[i].name] = readings[i];
  }
  return figures;
}

TEST(TradeWorks, AScanIsMeasuredAgainstTheRoomAndACoarserOneIsSmaller) {
  const MeasuredWork work = prescan_work({"table"}, {}, kTiny);
  Setting setting = default_setting(work.parameters);
  const Measure measure = work.open(0);
  setting[0] = 2;  // 2 cm
  auto fine = figures_of(work, measure(setting));
  setting[0] = 0;  // 4 cm
  auto coarse = figures_of(work, measure(setting));
  EXPECT_GT(fine["surface_error_median_m"], 0.0003);
  EXPECT_LT(fine["surface_error_median_m"], 0.05);
  EXPECT_LT(fine["trajectory_error_m"], 0.05);
  EXPECT_EQ(fine["frames_lost"], 0.0);
  EXPECT_GT(fine["octree_mb"], 2.0 * coarse["octree_mb"]);
  EXPECT_GT(fine["triangles"], 2.0 * coarse["triangles"]);
  EXPECT_GT(fine["memory_mb"], fine["octree_mb"]);
}

TEST(TradeWorks, ARunIsMeasuredAgainstTheRoomWhatMovesInItAndTheRightPicture) {
  const MeasuredWork work = run_work({"table"}, {}, kTiny);
  auto figures = figures_of(work, work.open(0)(default_setting(work.parameters)));
  EXPECT_LT(figures["pose_error_m"], 0.03);
  EXPECT_EQ(figures["not_located"], 0.0);
  EXPECT_EQ(figures["passed_through"], 0.0);
  EXPECT_LT(figures["contact_error_median_m"], 0.03);
  EXPECT_GT(figures["moved_error_median_m"], 0.0);
  EXPECT_LT(figures["moved_error_median_m"], 0.03);
  EXPECT_GT(figures["picture_error"], 0.0);
  EXPECT_LT(figures["picture_error"], 0.2);
  EXPECT_LT(figures["picture_edge_error"], 0.5);
  EXPECT_EQ(figures["object_age_ms"], 0.0);
  EXPECT_LE(figures["radar_ms"], figures["frame_ms"]);
}

/// A picture that is red on the left and green on the right, and the depth of each side. Composes it with a
/// teapot in the middle, with the depth's edge at `edge_px`.
struct TwoSides {
  Frame frame;
  DepthImage true_depth_m;
  Mesh teapot = object_mesh("teapot");
  Eigen::Isometry3d T_world_teapot{Eigen::Translation3d(0.0, 0.0, 1.0)};

  TwoSides() {
    frame.depth_camera = frame.colour_camera = kinect_of_width(160);
    frame.colour.resize(160, 120, Rgb{0, 160, 0});
    for (int y = 0; y < 120; ++y) std::fill_n(frame.colour.row(y), 80, Rgb{160, 0, 0});
    true_depth_m = depth_with_edge(80);
  }

  [[nodiscard]] DepthImage depth_with_edge(int edge_px, float left_m = 0.5F) const {
    DepthImage depth_m(160, 120, 3.0F);
    for (int y = 0; y < 120; ++y) std::fill_n(depth_m.row(y), edge_px, left_m);
    return depth_m;
  }

  [[nodiscard]] JudgedPicture shown(const DepthImage& depth_m) const {
    GlContext context;
    ObjectDrawer drawer(context);
    const auto object = object_of(context, "teapot", teapot, {});
    make_contact_shadow(object->model->surface, T_world_teapot.linear(), object->shadow);
    ObjectLayer layer;
    const DrawnObject drawn{.instance = {&object->model->shape.drawn, T_world_teapot},
                            .is_closed = object->model->shape.touched.is_closed()};
    drawer.draw(std::span(&drawn, 1), frame.colour_camera, Eigen::Isometry3d::Identity(), {}, layer);
    ComposeConfig config;
    config.occlusion.edge_reach_px = 0;
    Occlusion occlusion;
    JudgedPicture judged{{}, {{0, T_world_teapot}}};
    cast_shadows(frame.colour, {depth_m, frame.colour_camera, Eigen::Isometry3d::Identity()},
                 std::array{ShadowCaster{&object->shadow, T_world_teapot}}, config, judged.picture);
    lay_objects({layer, {}}, depth_m, config.occlusion, occlusion, judged.picture);
    return judged;
  }
};

TEST(PictureJudge, SaysHowFarAnEdgeThatHidesAnObjectIsFromItsPlace) {
  const TwoSides scene;
  const JudgedPicture right = scene.shown(scene.true_depth_m);
  const JudgedPicture off_by_one = scene.shown(scene.depth_with_edge(81));
  const JudgedPicture off_by_three = scene.shown(scene.depth_with_edge(77));
  PictureJudge judge({scene.teapot});  // created last: its context must be the current one
  const auto errors_of = [&](const JudgedPicture& judged, const DepthImage& true_depth_m) {
    return judge.errors_of(judged, scene.frame, true_depth_m, Eigen::Isometry3d::Identity());
  };
  const PictureErrors none = errors_of(right, scene.true_depth_m);
  EXPECT_EQ(none.whole(), 0.0);
  EXPECT_EQ(none.at_edges(), 0.0);
  const PictureErrors one = errors_of(off_by_one, scene.true_depth_m);
  const PictureErrors three = errors_of(off_by_three, scene.true_depth_m);
  EXPECT_GT(one.at_edges(), 0.02);
  EXPECT_NEAR(three.at_edges() / one.at_edges(), 3.0, 1.0);
  // Objects that are wholly visible or wholly hidden have no occlusion edges.
  EXPECT_TRUE(std::isnan(errors_of(right, DepthImage(160, 120, 3.0F)).at_edges()));
  EXPECT_TRUE(std::isnan(errors_of(right, DepthImage(160, 120, 0.5F)).at_edges()));
  // Errors elsewhere do not count as errors at edges.
  JudgedPicture spoilt = right;
  spoilt.picture.at(3, 3) = {255, 255, 255};
  const PictureErrors elsewhere = errors_of(spoilt, scene.true_depth_m);
  EXPECT_GT(elsewhere.whole(), 0.0);
  EXPECT_EQ(elsewhere.at_edges(), 0.0);
}

TEST(PictureJudge, WhatIsDrawnOverWhatHidesItCounts) {
  const TwoSides scene;
  const DepthImage before_it(160, 120, 0.5F), behind_it(160, 120, 3.0F);
  const JudgedPicture shown = scene.shown(behind_it);
  PictureJudge judge({scene.teapot});
  const auto errors_of = [&](const DepthImage& true_depth_m) {
    return judge.errors_of(shown, scene.frame, true_depth_m, Eigen::Isometry3d::Identity());
  };
  const PictureErrors over = errors_of(before_it);
  EXPECT_GT(over.difference, 0.0);
  EXPECT_EQ(over.object_pixels, 0U);
  EXPECT_FALSE(std::isfinite(over.whole())) << "by itself it has no object's pixel to be divided by";
  PictureErrors both = errors_of(behind_it);
  ASSERT_GT(both.object_pixels, 100U);
  EXPECT_EQ(both.difference, 0.0);
  both += over;
  EXPECT_EQ(both.whole(), over.difference / static_cast<double>(both.object_pixels));
  EXPECT_FALSE(std::isfinite(PictureErrors{}.whole()));
  EXPECT_FALSE(std::isfinite(PictureErrors{}.at_edges()));
}

TEST(TradeWorks, ASourceWithoutPosesIsRefusedBeforeAnythingIsMeasured) {
  const test::TemporaryFolder folder;
  const MeasuredWork work = prescan_work({}, {folder.path().string()}, kTiny);
  EXPECT_THROW((void)work.open(0), Error);
  EXPECT_THROW((void)prescan_work({"attic"}, {}, kTiny).open(0), Error);
}

}  // namespace
}  // namespace roomradar::trade_test
