// recalibration_test.cpp: a sensor that distorts its depth from one frame to the next moves neither camera
// nor room.
#include <gtest/gtest.h>

#include <optional>

#include "app/session/session.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/prescan.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::recalibration_test {
namespace {

// Between frames 9 and 10 of this recording the raw depth jumps by up to 5 units in vertical bands, 22 cm on
// the walls, while the camera is stationary.
TEST(Recalibration, MovesNeitherCameraNorRoom) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "fakenect-planes/planes");
  StageTimes times;
  const SavedMap map = prescan(*limit_frames(open_folder(folder), 0, 8), {}, times).map;
  SessionConfig config;
  config.make_picture = false;
  Session session(map, config);
  const auto run = limit_frames(open_folder(folder), 8, 13);
  std::optional<Eigen::Isometry3d> T_world_first;
  Frame frame;
  for (ReadResult read = run->next(frame); read.status != ReadStatus::kEnd; read = run->next(frame)) {
    ASSERT_EQ(read.status, ReadStatus::kFrame);
    const FrameResult result = session.step(frame, times);
    ASSERT_EQ(result.status, FrameStatus::kDone) << frame.index;
    if (!T_world_first) T_world_first = result.T_world_camera;
    EXPECT_LT((T_world_first->inverse() * result.T_world_camera).translation().norm(), 0.02) << frame.index;
    EXPECT_LT(static_cast<double>(result.foreground.moved),
              0.001 * static_cast<double>(result.foreground.valid))
        << frame.index;
  }
}

}  // namespace
}  // namespace roomradar::recalibration_test
