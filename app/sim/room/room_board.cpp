// room_board.cpp: a checkerboard on a stand in a bare room, for camera calibration.
#include "app/sim/room/room_board.hpp"

#include <numbers>

#include "app/sim/room/furniture.hpp"

namespace roomradar {

Room make_board_room() {
  Room room;
  room.name = "board";
  room.interior_min_world = {-3.5, -3.5, 0.0};
  room.interior_max_world = {3.5, 3.5, 3.0};
  add_shell(room, {Pattern::kPlanks, {196, 158, 112}, {140, 104, 66}, 301, 0.6F},
            {Pattern::kPlaster, {206, 204, 198}, {190, 186, 176}, 302, 0.7F},
            {Pattern::kPlaster, {236, 236, 234}, {226, 226, 222}, 303, 0.7F});
  // 9 by 7 squares, hence 8 by 6 inner corners, and a white margin of more than half a square.
  const Eigen::Vector3d board_m{10.2 * kCheckerSquare_m, 0.02, 8.2 * kCheckerSquare_m};
  constexpr double kMiddle_m = 1.4;
  add(room, Eigen::Isometry3d::Identity(), box({0, 0.01, kMiddle_m}, board_m),
      {Pattern::kChecker, {235, 235, 235}, {24, 24, 24}, 0, 0.6F});
  const Material metal{Pattern::kPortable, {90, 92, 96}, {70, 70, 74}, 304, 0.4F};
  add(room, Eigen::Isometry3d::Identity(), cylinder({0, 0.05, 0.02}, 0.02, kMiddle_m - 0.02), metal);
  add(room, Eigen::Isometry3d::Identity(), cylinder({0, 0.05, 0.0}, 0.2, 0.02), metal);

  room.lamps = {{{-1.5, -1.8, 2.8}, 2.8F, 0.3}, {{1.5, -1.8, 2.8}, 2.8F, 0.3}};
  room.focus_world = {0.0, 0.0, kMiddle_m};
  room.view_azimuth_rad = -0.5 * std::numbers::pi;
  room.walk_centre_world = {0.0, 0.0, 1.5};
  room.walk_half_m = {1.8, 1.8};
  room.ball_from_world = {-1.0, -1.0, 0.0};
  room.ball_to_world = {1.0, -1.0, 0.0};
  room.person_from_world = {-1.6, 1.5, 0.0};
  room.person_to_world = {1.6, 1.5, 0.0};
  return room;
}

}  // namespace roomradar
