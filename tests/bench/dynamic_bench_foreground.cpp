// dynamic_bench_foreground.cpp: accuracy of the foreground on simulated movers, and in recordings without
// motion.
#include "tests/bench/dynamic_bench.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "app/session/session.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/prescan.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "radar/depth/depth_pass.hpp"
#include "tests/dynamic/foreground/foreground_judge.hpp"
#include "tests/dynamic/foreground/foreground_views.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::test {
namespace {

// Mesh of the room from 100 noisy frames of a walk around it, 1 cm voxels.
Mesh prescanned(const std::string& room) {
  SimOptions options;
  options.room = room;
  options.frames = 1200;
  SimulatedSource source(options);
  StaticMap map(0.01);
  Frame frame;
  for (std::int64_t i = 0; i < options.frames; i += 12) {
    source.seek(i);
    if (source.next(frame).status == ReadStatus::kFrame) map.fuse(frame, source.truth().T_world_camera);
  }
  return extract_surface(map);
}

// A static model, the error of its pose, and the score of the masks computed with it.
struct Opponent {
  const char* model;
  double shift_m, turn_deg;
  ForegroundState state = {};
  MaskScore score = {};
};

// Eight bursts of four consecutive frames; each burst starts without foreground history.
void judge_mover(const std::string& room, MoverKind mover, GlContext& context, const GpuMesh& mesh,
                 Rows& rows) {
  constexpr int kBursts = 8, kInARow = 4;
  SimOptions options;
  options.room = room;
  options.frames = 160;
  options.path = CameraPathKind::kView;
  options.movers = {mover};
  if (mover == MoverKind::kBall) {  // it is on the floor, which may be out of view
    options.path = CameraPathKind::kScan;
    options.frames = 1200;
  }
  SimulatedSource source(options);
  ViewCaster caster;
  DepthPass depth_pass(context);
  const MeshInstance instance{&mesh, Eigen::Isometry3d::Identity()};
  std::array<Opponent, 4> opponents{Opponent{"exact", 0.0, 0.0}, Opponent{"exact", 0.005, 0.1},
                                    Opponent{"prescanned", 0.0, 0.0}, Opponent{"prescanned", 0.005, 0.1}};
  Frame frame;
  DepthImage expected_m;
  LabelImage labels;
  MaskImage dynamic_mask;
  for (int burst = 0; burst < kBursts; ++burst) {
    for (Opponent& opponent : opponents) opponent.state = {};
    for (int i = 0; i < kInARow; ++i) {
      source.seek(burst * options.frames / kBursts + i);
      if (source.next(frame).status != ReadStatus::kFrame) continue;
      for (Opponent& opponent : opponents) {
        const Eigen::Isometry3d T_world_camera =
            source.truth().T_world_camera * pose_error(opponent.shift_m, opponent.turn_deg, burst);
        if (opponent.model == std::string("exact"))
          cast_room(source.room(), frame.depth_camera, T_world_camera, caster, expected_m);
        else
          depth_pass.render({&instance, 1}, frame.depth_camera, T_world_camera, expected_m);
        mark_foreground({frame.depth_m, frame.depth_camera, T_world_camera}, expected_m, {}, opponent.state,
                        labels, dynamic_mask);
        add_frame(frame.depth_m, dynamic_mask, source.truth().moved, opponent.score);
      }
    }
  }
  for (const Opponent& opponent : opponents) {
    rows.push_back({{"work", "masks"},
                    {"room", room},
                    {"mover", std::string(to_string(mover))},
                    {"model", opponent.model},
                    {"pose_error_m", opponent.shift_m},
                    {"frames", opponent.score.frames},
                    {"iou", opponent.score.iou()},
                    {"false_fraction", opponent.score.false_fraction()}});
  }
}

void measure_masks(Rows& rows) {
  GlContext context;
  const std::size_t first = rows.size();
  for (const std::string& room : room_names()) {
    GpuMesh mesh(context);
    mesh.upload(prescanned(room), MeshUsage::kStatic);
    for (const MoverKind mover : {MoverKind::kHand, MoverKind::kBall, MoverKind::kPerson})
      judge_mover(room, mover, context, mesh, rows);
  }
  for (const char* model : {"exact", "prescanned"}) {
    double sum = 0.0, worst = 1.0;
    int count = 0;
    for (std::size_t i = first; i < rows.size(); ++i) {
      if (rows[i]["work"] != "masks" || rows[i]["model"] != model) continue;
      const double iou = rows[i]["iou"];
      sum += iou;
      worst = std::min(worst, iou);
      ++count;
    }
    rows.push_back({{"work", "masks, all"}, {"model", model}, {"iou", sum / count}, {"iou_worst", worst}});
  }
}

// A hand above a table, seen from above the table and from the side.
void measure_hand_over_table(Rows& rows) {
  for (const double below_deg : {35.0, 60.0, 89.0}) {
    MaskImage truth;
    const DepthImage expected_m = hand_over_table(below_deg, 0.0, truth);
    for (const double above_m : {0.01, 0.02, 0.03, 0.05, 0.1, 0.2}) {
      DepthImage live_m = hand_over_table(below_deg, above_m, truth);
      add_noise(live_m, 1);
      const Marked marked = mark(live_m, expected_m, {}, kKinect, 2);
      MaskScore score;
      add_frame(live_m, marked.dynamic_mask, truth, score);
      rows.push_back({{"work", "hand over a table"},
                      {"camera_below_horizon_deg", below_deg},
                      {"above_m", above_m},
                      {"iou", score.iou()}});
    }
  }
}

// A recording without motion: the frames that make the map, and the frames that are run in it.
struct StillPart {
  const char* recording;
  FrameRange mapped, run;
  std::int64_t hold_out = 0;  ///< N > 0: held-out frames among the mapped ones; only these are scored
};

void measure_still(const StillPart& part, Rows& rows) {
  const auto folder = recording(part.recording);
  if (!folder) {
    std::cout << part.recording
              << ": SKIPPED, the recording is not here (set ROOMRADAR_DATA to its folder)\n";
    return;
  }
  PrescanConfig config;
  config.hold_out = part.hold_out;
  StageTimes times;
  const auto mapped = limit_frames(open_folder(*folder), part.mapped.first, part.mapped.last);
  const SavedMap map = prescan(*mapped, config, times).map;
  SessionConfig session_config;
  session_config.make_picture = false;
  Session session(map, session_config);
  const auto run = limit_frames(open_folder(*folder), part.run.first, part.run.last);
  Frame frame;
  ForegroundCounts all;
  double most = 0.0;
  int frames = 0, located = 0;
  for (ReadResult read = run->next(frame); read.status != ReadStatus::kEnd; read = run->next(frame)) {
    if (read.status != ReadStatus::kFrame) continue;
    const FrameResult result = session.step(frame, times);
    if (part.hold_out > 0 && !is_held_out(frame.index, part.hold_out)) continue;
    ++frames;
    if (result.status != FrameStatus::kDone) continue;
    ++located;
    const ForegroundCounts& counts = result.foreground;
    all.valid += counts.valid;
    all.moved += counts.moved;
    all.revealed += counts.revealed;
    all.not_known += counts.not_known;
    most = std::max(most, static_cast<double>(counts.moved) /
                              static_cast<double>(std::max<std::size_t>(counts.valid, 1)));
  }
  const auto range = [](const FrameRange& frames_of) {
    return std::to_string(frames_of.first) + ":" + std::to_string(frames_of.last);
  };
  const auto fraction = [&](std::size_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(std::max<std::size_t>(all.valid, 1));
  };
  rows.push_back({{"work", "nothing moves"},
                  {"recording", part.recording},
                  {"mapped", range(part.mapped)},
                  {"run", range(part.run)},
                  {"hold_out", part.hold_out},
                  {"frames", frames},
                  {"located", located},
                  {"moved_fraction", fraction(all.moved)},
                  {"moved_fraction_max", most},
                  {"revealed_fraction", fraction(all.revealed)},
                  {"not_known_fraction", fraction(all.not_known)}});
}

}  // namespace

void measure_foreground(Rows& rows) {
  measure_hand_over_table(rows);
  measure_masks(rows);
  measure_still({"fakenect-planes/planes", {0, 8}, {0, 8}}, rows);
  measure_still({"fakenect-planes/planes", {0, 8}, {9, 35}}, rows);  // the sensor recalibrates at frame 10
  measure_still({"kitchen", {0, 399}, {400, 499}}, rows);
  measure_still({"kitchen", {0, 299}, {0, 299}, 10}, rows);
}

}  // namespace roomradar::test
