// foreground_sim_test.cpp: movers in the simulated rooms are marked, and nothing else is.
#include <gtest/gtest.h>

#include <iostream>
#include <string>

#include "tests/dynamic/foreground/foreground_judge.hpp"

namespace roomradar::test::foreground_sim_test {
namespace {

SimOptions options(const std::string& room) {
  SimOptions options;
  options.room = room;
  options.frames = 120;
  options.path = CameraPathKind::kView;
  return options;
}

TEST(ForegroundInSimulatedRooms, MoversAreFound) {
  for (const std::string& room : room_names()) {
    for (const MoverKind mover : {MoverKind::kHand, MoverKind::kBall, MoverKind::kPerson}) {
      SimOptions with_mover = options(room);
      with_mover.movers = {mover};
      std::int64_t step = 40;
      if (mover == MoverKind::kBall) {  // it is on the floor, which may be out of view
        with_mover.path = CameraPathKind::kScan;
        with_mover.frames = 1200;
        step = 200;
      }
      const MaskScore score = judge_foreground(with_mover, step, 0.0, 0.0);
      const std::string name = room + " " + std::string(to_string(mover));
      std::cout << "  " << name << ": IoU " << score.iou() << ", missed " << score.missed << ", false "
                << score.false_ << ", found " << score.both << "\n";
      EXPECT_GT(score.both + score.missed, 500U) << name << " is hardly in view: the test says nothing";
      EXPECT_GT(score.iou(), 0.92) << name;
    }
  }
}

TEST(ForegroundInSimulatedRooms, NothingMovesWherePosesAreOff) {
  for (const std::string& room : room_names()) {
    SimOptions scan = options(room);
    scan.path = CameraPathKind::kScan;
    const MaskScore score = judge_foreground(scan, 60, 0.005, 0.1);
    std::cout << "  " << room << ": marked " << 100.0 * score.false_fraction() << " %\n";
    EXPECT_LT(score.false_fraction(), 0.001) << room;
  }
}

}  // namespace
}  // namespace roomradar::test::foreground_sim_test
