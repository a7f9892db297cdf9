// mutations_test.cpp: recordings whose units, stamps, poses, cameras and images are changed as other programs
// write them. Each change must be undone by decide(), or named. ROOMRADAR_LONG_TESTS=1: all recordings, else
// two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/decisions/decide.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::mutations_test {
namespace {

constexpr std::size_t kFrames = 160;

/// Reads each depth image once, in the unit that the recording states.
void keep_depth_in_memory(RecordingFacts& facts) {
  const auto images = std::make_shared<std::map<std::size_t, DepthImage>>();
  facts.read_depth = [read = facts.read_depth, images, unit = facts.depth_unit_m](
                         std::size_t frame, double unit_m, DepthImage& depth_m) {
    auto found = images->find(frame);
    if (found == images->end()) {
      read(frame, unit, depth_m);
      found = images->emplace(frame, depth_m).first;
    }
    depth_m = found->second;
    for (float& depth : depth_m.pixels) depth = static_cast<float>(depth * (unit_m / unit));
  };
}

RecordingFacts facts_of(const std::filesystem::path& folder) {
  RecordingFacts facts = read_facts(folder);
  if (facts.frames.size() > kFrames) facts.frames.resize(kFrames);
  keep_depth_in_memory(facts);
  return facts;
}

/// Facts of a simulated room, as a recording would state them.
RecordingFacts simulated_facts(const std::string& spec, bool has_poses, const DepthNoise& noise) {
  SimulatedSource source(parse_sim_spec(spec));
  const auto frames = std::make_shared<std::vector<Frame>>();
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame) frames->push_back(frame);
  RecordingFacts facts{.name = spec, .kind = "simulated"};
  facts.rig.depth_camera = frames->front().depth_camera;
  facts.rig.colour_camera = frames->front().colour_camera;
  facts.rig.T_colour_depth = frames->front().T_colour_depth;
  facts.rig.depth_noise = noise;
  facts.camera_source = "camera.json";
  facts.stamps_have_no_unit = true;
  for (std::size_t i = 0; i < frames->size(); ++i) {
    const Frame& each = (*frames)[i];
    facts.frames.push_back({.time = {100.0 + each.stamp_s}, .colour = i, .down_camera = each.down_camera});
    if (has_poses) facts.frames.back().T_world_camera = each.T_world_camera;
  }
  facts.read_depth = [frames](std::size_t i, double unit_m, DepthImage& depth_m) {
    depth_m = (*frames)[i].depth_m;
    for (float& depth : depth_m.pixels) depth = static_cast<float>(depth * (unit_m / 0.001));
  };
  facts.read_colour = [frames](std::size_t i, ColourImage& image) { image = (*frames)[i].colour; };
  return facts;
}

/// A change of a recording, and the topics of decisions that would name it.
struct Mutation {
  std::string name;
  std::vector<std::string> topics;
  std::function<void(RecordingFacts&)> change;
};

void scale_unit(RecordingFacts& facts, double factor) {
  facts.read_depth = [read = facts.read_depth, factor](std::size_t frame, double unit_m,
                                                       DepthImage& depth_m) {
    read(frame, unit_m * factor, depth_m);
  };
}

using ChangePose = std::function<std::optional<Eigen::Isometry3d>(std::optional<Eigen::Isometry3d>)>;

void change_poses(RecordingFacts& facts, const ChangePose& change) {
  if (facts.read_pose) {
    facts.read_pose = [read = facts.read_pose, change](std::size_t frame, double stamp_s) {
      StatedPose pose = read(frame, stamp_s);
      pose.T_world_camera = change(pose.T_world_camera);
      return pose;
    };
  }
  for (StatedFrame& frame : facts.frames) frame.T_world_camera = change(frame.T_world_camera);
}

/// Gives frame i the pose of frame from(i).
void take_poses_of(RecordingFacts& facts, const std::function<std::size_t(std::size_t)>& from) {
  const std::size_t last = facts.frames.size() - 1;
  if (facts.read_pose) {
    std::vector<double> stamps_s;
    for (const StatedFrame& frame : facts.frames) stamps_s.push_back(frame.time.stamp_s);
    facts.read_pose = [read = facts.read_pose, from, last, stamps_s](std::size_t frame, double) {
      const std::size_t at = std::min(from(frame), last);
      return read(at, stamps_s[at]);
    };
    return;
  }
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  for (const StatedFrame& frame : facts.frames) poses.push_back(frame.T_world_camera);
  for (std::size_t i = 0; i < facts.frames.size(); ++i)
    facts.frames[i].T_world_camera = poses[std::min(from(i), last)];
}

/// Changes all stamps: of images, of poses and of accelerations.
void change_stamps(RecordingFacts& facts, const std::function<double(double stamp_s, double part)>& change) {
  const double begin_s = facts.frames.front().time.stamp_s, end_s = facts.frames.back().time.stamp_s;
  const auto changed = [&](double stamp_s) {
    return change(stamp_s, (stamp_s - begin_s) / (end_s - begin_s));
  };
  for (StatedFrame& frame : facts.frames) frame.time.stamp_s = changed(frame.time.stamp_s);
  for (StatedTime& colour : facts.colours) colour.stamp_s = changed(colour.stamp_s);
  if (facts.pose_track)
    for (StampedPose& pose : *facts.pose_track) pose.stamp_s = changed(pose.stamp_s);
  if (facts.acceleration_track)
    for (StampedAcceleration& each : *facts.acceleration_track) each.stamp_s = changed(each.stamp_s);
}

/// Lists the frames in another order. Files of colour images keep theirs.
void reorder(RecordingFacts& facts, const std::vector<std::size_t>& order) {
  std::vector<StatedFrame> frames;
  for (const std::size_t i : order) frames.push_back(facts.frames[i]);
  facts.frames = std::move(frames);
  facts.read_depth = [read = facts.read_depth, order](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read(order[frame], unit_m, depth_m);
  };
  if (facts.read_pose)
    facts.read_pose = [read = facts.read_pose, order](std::size_t frame, double stamp_s) {
      return read(order[frame], stamp_s);
    };
}

std::vector<std::size_t> in_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

void scale_focal(RecordingFacts& facts, double factor) {
  facts.rig.depth_camera.fx_px *= factor;
  facts.rig.depth_camera.fy_px *= factor;
}

void lose_depth(RecordingFacts& facts, const std::function<bool(std::size_t)>& is_lost) {
  facts.read_depth = [read = facts.read_depth, is_lost](std::size_t frame, double unit_m,
                                                        DepthImage& depth_m) {
    if (is_lost(frame)) throw Error("image " + std::to_string(frame) + ": is empty");
    read(frame, unit_m, depth_m);
  };
}

/// Replaces the depth images of a fifth of the frames by one of `covered_m` everywhere; 0: nothing is
/// measured.
void cover_lens(RecordingFacts& facts, float covered_m) {
  facts.read_depth = [read = facts.read_depth, covered_m, count = facts.frames.size()](
                         std::size_t frame, double unit_m, DepthImage& depth_m) {
    read(frame, unit_m, depth_m);
    if (frame >= count * 2 / 5 && frame < count * 3 / 5)
      std::fill(depth_m.pixels.begin(), depth_m.pixels.end(), covered_m);
  };
}

std::vector<Mutation> mutations() {
  std::vector<Mutation> all;
  const auto add = [&](const std::string& name, std::vector<std::string> topics, auto change) {
    all.push_back({name, std::move(topics), std::move(change)});
  };
  for (const double factor : {0.1, 0.2, 0.25, 0.5, 2.0, 4.0, 5.0})
    add("unit x " + std::to_string(factor), {"unit"}, [factor](RecordingFacts& f) { scale_unit(f, factor); });
  for (const double factor : {0.7, 0.77, 1.3, 1.43})
    add("focal x " + std::to_string(factor), {"camera"},
        [factor](RecordingFacts& f) { scale_focal(f, factor); });

  add("focal length of y x 1.3", {"camera"}, [](RecordingFacts& f) { f.rig.depth_camera.fy_px *= 1.3; });
  add("principal point 0.09 widths right", {"camera"},
      [](RecordingFacts& f) { f.rig.depth_camera.cx_px += 0.09 * f.rig.depth_camera.width_px; });
  add("principal point 0.09 widths down", {"camera"},
      [](RecordingFacts& f) { f.rig.depth_camera.cy_px += 0.09 * f.rig.depth_camera.width_px; });

  const auto poses = [&](const std::string& name,
                         std::function<Eigen::Isometry3d(Eigen::Isometry3d)> change) {
    add("poses " + name, {"poses", "unit", "camera"}, [change](RecordingFacts& f) {
      change_poses(
          f, [change](std::optional<Eigen::Isometry3d> T) { return T ? std::optional(change(*T)) : T; });
    });
  };
  const Eigen::Isometry3d opengl(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  poses("inverse", [](const Eigen::Isometry3d& T) { return T.inverse(); });
  poses("opengl", [opengl](const Eigen::Isometry3d& T) { return T * opengl; });
  poses("inverse opengl", [opengl](const Eigen::Isometry3d& T) { return (T * opengl).inverse(); });
  poses("identity", [](const Eigen::Isometry3d&) { return Eigen::Isometry3d::Identity(); });
  poses("millimetres", [](Eigen::Isometry3d T) { return T.translation() *= 1000.0, T; });
  poses("centimetres", [](Eigen::Isometry3d T) { return T.translation() *= 100.0, T; });
  poses("half as far", [](Eigen::Isometry3d T) { return T.translation() *= 0.5, T; });
  poses("1.1 times as far", [](Eigen::Isometry3d T) { return T.translation() *= 1.1, T; });
  poses("0.9 times as far", [](Eigen::Isometry3d T) { return T.translation() *= 0.9, T; });
  for (const double angle_deg : {5.0, 10.0})
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitY().eval(),
                                        Eigen::Vector3d::UnitZ().eval()}) {
      const Eigen::Isometry3d tilt(Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, axis));
      poses("of axes turned by " + std::to_string(angle_deg) + " about " +
                "xyz"[axis.y() != 0.0   ? 1
                      : axis.z() != 0.0 ? 2
                                        : 0],
            [tilt](const Eigen::Isometry3d& T) { return T * tilt; });
    }
  poses("of a body 0.15 m behind",
        [](Eigen::Isometry3d T) { return T.translate(Eigen::Vector3d(0, 0, 0.15)); });
  poses("of a body 0.15 m beside",
        [](Eigen::Isometry3d T) { return T.translate(Eigen::Vector3d(0.15, 0, 0)); });
  poses("rotation transposed", [](Eigen::Isometry3d T) { return T.linear().transposeInPlace(), T; });
  poses("mirrored", [](Eigen::Isometry3d T) { return T.translation().y() *= -1.0, T; });
  add("frames shifted: poses by one", {"poses"},
      [](RecordingFacts& f) { take_poses_of(f, [](std::size_t i) { return i + 1; }); });
  add("frames shifted: poses by ten", {"poses"},
      [](RecordingFacts& f) { take_poses_of(f, [](std::size_t i) { return i + 10; }); });
  add("poses in reverse", {"poses"}, [](RecordingFacts& f) {
    take_poses_of(f, [last = f.frames.size() - 1](std::size_t i) { return last - std::min(i, last); });
  });

  for (const double factor : {1e3, 1e6, 1e9})
    add("stamps x " + std::to_string(static_cast<long long>(factor)), {"time"}, [factor](RecordingFacts& f) {
      change_stamps(f, [factor](double s, double) { return std::round(s * factor); });
    });
  for (const double step_s : {0.7, 3600.0})
    add("clock set back by " + std::to_string(step_s), {"time"}, [step_s](RecordingFacts& f) {
      change_stamps(f, [step_s](double s, double part) { return part > 0.5 ? s - step_s : s; });
    });
  add("pose clock 0.1 s late", {"poses"}, [](RecordingFacts& f) {
    if (f.pose_track)
      for (StampedPose& pose : *f.pose_track) pose.stamp_s += 0.1;
  });
  add("clock set forward", {"time"}, [](RecordingFacts& f) {
    change_stamps(f, [](double s, double part) { return part > 0.5 ? s + 3600.0 : s; });
  });
  add("no stamps", {"time"}, [](RecordingFacts& f) { change_stamps(f, [](double, double) { return 0.0; }); });
  add("stamps missing", {"time"}, [](RecordingFacts& f) {
    for (std::size_t i = 3; i < f.frames.size(); i += 7) f.frames[i].time.stamp_s = kNoStamp;
  });
  add("stamps zero", {"time"}, [](RecordingFacts& f) {
    for (std::size_t i = 3; i < f.frames.size(); i += 7) f.frames[i].time.stamp_s = 0.0;
  });
  add("one absurd stamp", {"time"},
      [](RecordingFacts& f) { f.frames[f.frames.size() / 2].time.stamp_s = 9e15; });
  add("stamps twice", {"time"}, [](RecordingFacts& f) {
    for (std::size_t i = 1; i < f.frames.size(); i += 2)
      f.frames[i].time.stamp_s = f.frames[i - 1].time.stamp_s;
  });
  add("shuffled", {"time"}, [](RecordingFacts& f) {
    std::vector<std::size_t> order = in_order(f.frames.size());
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    reorder(f, order);
  });
  add("reversed", {"time"}, [](RecordingFacts& f) {
    std::vector<std::size_t> order = in_order(f.frames.size());
    std::reverse(order.begin(), order.end());
    reorder(f, order);
  });
  add("listed by name", {"time"}, [](RecordingFacts& f) {
    std::vector<std::size_t> order = in_order(f.frames.size());
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(order.size() / 3), order.end());
    reorder(f, order);
  });

  add("every third depth image cut", {"images"},
      [](RecordingFacts& f) { lose_depth(f, [](std::size_t i) { return i % 3 == 1; }); });
  add("the last half cut", {"images"}, [](RecordingFacts& f) {
    lose_depth(f, [half = f.frames.size() / 2](std::size_t i) { return i > half; });
  });
  add("no colour image readable", {"images"}, [](RecordingFacts& f) {
    f.read_colour = [](std::size_t i, ColourImage&) {
      throw Error("image " + std::to_string(i) + ": is empty");
    };
  });
  add("lens covered", {"poses"}, [](RecordingFacts& f) { cover_lens(f, 0.0F); });
  add("hand before the lens", {"poses"}, [](RecordingFacts& f) { cover_lens(f, 0.3F); });
  add("depth images of half the size", {"images"}, [](RecordingFacts& f) {
    f.read_depth = [read = f.read_depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
      read(frame, unit_m, depth_m);
      depth_m.resize(depth_m.width / 2, depth_m.height / 2);
    };
  });
  return all;
}

/// Changes that nothing in the recording contradicts: the unit of depth of a camera without poses, the scale
/// of poses between which the camera only turns, and small errors of a camera without poses or without
/// colour.
bool is_indistinguishable(const std::string& recording, const std::string& mutation) {
  const bool has_no_poses = recording == "time of flight, no poses", only_turns = recording == "fr1_rpy",
             has_no_colour = recording == "stray", is_short = recording == "record3d";
  return (has_no_poses && (mutation.starts_with("unit") || mutation.ends_with("down"))) ||
         ((has_no_poses || has_no_colour || is_short) && mutation == "focal length of y x 1.3") ||
         (only_turns && (mutation == "unit x 0.500000" || mutation == "poses mirrored"));
}

SourceOptions asking() {
  SourceOptions options;
  options.questions = Questions::kDepth;
  options.input = std::make_shared<InputReport>();
  return options;
}

/// Returns why the decided recording is not the unchanged one; empty: it is, except for lost frames.
std::string difference(const DecidedRecording& got, const DecidedRecording& wanted, double unit_factor) {
  if (got.frames.size() != wanted.frames.size()) return "another number of frames";
  const double period_s = 1.0 / 30.0;
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    const double got_s = got.frames[i].stamp_s - got.frames.front().stamp_s,
                 wanted_s = wanted.frames[i].stamp_s - wanted.frames.front().stamp_s;
    if (std::abs(got_s - wanted_s) > 1.5 * period_s)
      return "other times, by " + std::to_string(got_s - wanted_s) + " s";
  }
  constexpr std::size_t kApart = 30;
  for (std::size_t i = 0; i + kApart < got.frames.size(); i += 10) {
    const auto relative = [i](const DecidedRecording& recording) -> std::optional<Eigen::Isometry3d> {
      const auto a = pose_of(recording, i), b = pose_of(recording, i + kApart);
      if (!a || !b) return std::nullopt;
      return a->inverse() * *b;
    };
    const auto T_got = relative(got), T_wanted = relative(wanted);
    if (!T_got) continue;  // a lost pose is no wrong one
    if (!T_wanted) return "poses where there were none";
    const Eigen::Isometry3d error = T_wanted->inverse() * *T_got;
    if (error.translation().norm() > 0.02 || Eigen::AngleAxisd(error.linear()).angle() > 0.02)
      return "other poses";
  }
  const double unit = got.depth_unit_m / wanted.depth_unit_m * unit_factor;
  if (std::abs(unit - 1.0) > 0.02) return "another unit";
  const Intrinsics &got_camera = got.facts.rig.depth_camera, &wanted_camera = wanted.facts.rig.depth_camera;
  if (std::abs(got_camera.fx_px / wanted_camera.fx_px - 1.0) > 0.02 ||
      std::abs(got_camera.fy_px / wanted_camera.fy_px - 1.0) > 0.02)
    return "another focal length";
  if (std::hypot(got_camera.cx_px - wanted_camera.cx_px, got_camera.cy_px - wanted_camera.cy_px) >
      0.02 * wanted_camera.width_px)
    return "another principal point";
  return {};
}

struct Recording {
  std::string name;
  std::function<std::optional<RecordingFacts>()> facts;
};

std::vector<Recording> recordings() {
  std::vector<Recording> all = {
      {"table",
       [] {
         return std::optional(simulated_facts("sim:table?frames=160&width=320&seed=4", true, DepthNoise{}));
       }},
      {"time of flight, no poses", [] {
         return std::optional(
             simulated_facts("sim:table?frames=160&width=320&seed=5", false, kTimeOfFlightNoise));
       }}};
  if (std::getenv("ROOMRADAR_LONG_TESTS") == nullptr) return all;
  for (const char* name : {"kitchen", "fr1_rpy", "record3d", "stray"})
    all.push_back({name, [name]() -> std::optional<RecordingFacts> {
                     const auto folder = test::recording(name);
                     return folder ? std::optional(facts_of(*folder)) : std::nullopt;
                   }});
  return all;
}

TEST(Mutations, AreUndoneOrNamed) {
  int tried = 0, undone = 0, named = 0, indistinguishable = 0;
  for (const Recording& recording : recordings()) {
    const auto facts = recording.facts();
    if (!facts) {
      std::printf("%s: is not here\n", recording.name.c_str());
      continue;
    }
    const DecidedRecording base = decide(*facts, {}, asking());
    for (const InputDecision& decision : base.report->decisions())
      EXPECT_FALSE(decision.is_advice && decision.topic != "images" && decision.topic != "time")
          << recording.name << ": false alarm: " << decision.sentence;
    const bool has_poses = pose_of(base, 40).has_value();
    if (has_poses)
      std::printf("%s: disagreement %.2f near, %.2f far\n", recording.name.c_str(),
                  *base.evidence->pose_disagreement, *base.evidence->far_pose_disagreement);
    for (const Mutation& mutation : mutations()) {
      const bool is_shift = mutation.name.starts_with("frames shifted");
      if ((mutation.name.starts_with("poses") || is_shift) && !has_poses) continue;
      if (is_shift && facts->pose_track) continue;  // poses with stamps of their own belong to no frame
      RecordingFacts changed = *facts;
      // Tracks are shared by pointer.
      if (changed.pose_track) {
        changed.pose_track = std::make_shared<std::vector<StampedPose>>(*facts->pose_track);
        changed.read_pose = [track = changed.pose_track](std::size_t, double stamp_s) {
          return StatedPose{pose_at(*track, stamp_s, 0.05)};
        };
      }
      if (changed.acceleration_track)
        changed.acceleration_track =
            std::make_shared<std::vector<StampedAcceleration>>(*facts->acceleration_track);
      mutation.change(changed);
      const bool is_unit = mutation.name.starts_with("unit");
      const double factor = is_unit ? std::stod(mutation.name.substr(7)) : 1.0;
      ++tried;

      std::string why, said;
      try {
        const DecidedRecording got = decide(changed, {}, asking());
        for (std::size_t i = 0; i < got.frames.size(); i += 9) {  // as reading would count
          DepthImage depth_m;
          ColourImage colour;
          try {
            read_depth(got, i, depth_m);
            if (got.frames[i].colour) got.facts.read_colour(*got.frames[i].colour, colour);
          } catch (const Error& fault) {
            got.report->count("images", "% images cannot be read", static_cast<std::int64_t>(i),
                              fault.what());
          }
        }
        why = difference(got, base, factor);
        const std::vector<InputDecision> decisions = got.report->decisions();
        for (const InputDecision& decision : decisions) said += "\n    " + line_of(decision);
        const bool is_named =
            std::any_of(decisions.begin(), decisions.end(), [&](const InputDecision& decision) {
              return std::find(mutation.topics.begin(), mutation.topics.end(), decision.topic) !=
                     mutation.topics.end();
            });
        if (why.empty())
          ++undone;
        else if (is_named)
          ++named;
        else if (is_indistinguishable(recording.name, mutation.name))
          ++indistinguishable;
        else
          ADD_FAILURE() << recording.name << ", " << mutation.name << ": silent: " << why << said
                        << "\n    disagreement " << got.evidence->pose_disagreement.value_or(-1.0) << " "
                        << got.evidence->far_pose_disagreement.value_or(-1.0);
      } catch (const Error& refusal) {
        EXPECT_TRUE(mutation.topics.front() == "images")
            << recording.name << ", " << mutation.name << ": " << refusal.what();
        ++named;
      }
    }
  }
  std::printf("%d mutations: %d undone, %d named, %d cannot be told\n", tried, undone, named,
              indistinguishable);
}

bool says(const DecidedRecording& recording, const std::string& text) {
  const auto decisions = recording.report->decisions();
  return std::any_of(decisions.begin(), decisions.end(), [&](const InputDecision& decision) {
    return decision.sentence.find(text) != std::string::npos;
  });
}

TEST(Mutations, PosesOfEverySecondFrameAreNotShifted) {
  RecordingFacts facts = simulated_facts("sim:table?frames=80&width=160&seed=4", true, DepthNoise{});
  for (std::size_t i = 1; i < facts.frames.size(); i += 2) facts.frames[i].T_world_camera.reset();
  const DecidedRecording recording = decide(facts, {}, asking());
  EXPECT_EQ(recording.pose_convention, PoseConvention{});
  EXPECT_TRUE(recording.poses_are_used);
}

TEST(Mutations, PosesOfTheFirstFramesAreNotShifted) {
  RecordingFacts facts = simulated_facts("sim:table?frames=80&width=160&seed=4", true, DepthNoise{});
  for (std::size_t i = 30; i < facts.frames.size(); ++i) facts.frames[i].T_world_camera.reset();
  EXPECT_EQ(decide(facts, {}, asking()).pose_convention, PoseConvention{});
}

// Each part agrees with its own depth: no convention explains the step between them.
TEST(Mutations, PosesWithAStepAreKept) {
  RecordingFacts facts = simulated_facts("sim:table?frames=100&width=160&seed=4", true, DepthNoise{});
  for (std::size_t i = 50; i < facts.frames.size(); ++i)
    facts.frames[i].T_world_camera->pretranslate(Eigen::Vector3d(0.5, 0.0, 0.3));
  const DecidedRecording recording = decide(facts, {}, asking());
  EXPECT_EQ(recording.pose_convention, PoseConvention{});
  EXPECT_TRUE(recording.poses_are_used);
}

TEST(Mutations, PosesOfWhichNoneCanBeUsedAreAdvisedOn) {
  RecordingFacts facts = simulated_facts("sim:table?frames=40&width=160&seed=4", true, DepthNoise{});
  for (StatedFrame& frame : facts.frames) {
    frame.T_world_camera.reset();
    frame.pose_fault = "is no rigid transform";
  }
  const auto is_advised = [](const RecordingFacts& stated) {
    const auto decisions = decide(stated, {}, asking()).report->decisions();
    return std::any_of(decisions.begin(), decisions.end(), [](const InputDecision& decision) {
      return decision.topic == "poses" && decision.is_advice;
    });
  };
  EXPECT_TRUE(is_advised(facts));
  facts.read_pose = [](std::size_t, double) { return StatedPose{.fault = "has 0 numbers"}; };
  EXPECT_TRUE(is_advised(facts));
  facts.read_pose = [](std::size_t frame, double) {
    return frame == 0 ? StatedPose{.T_world_camera = Eigen::Isometry3d::Identity()}
                      : StatedPose{.fault = "has 0 numbers"};
  };
  for (StatedFrame& frame : facts.frames) frame.pose_fault.clear();
  EXPECT_FALSE(is_advised(facts));
}

TEST(Mutations, AValueThatMeansNothingMeasuredIsNamed) {
  RecordingFacts facts = simulated_facts("sim:table?frames=40&width=160&seed=4", true, DepthNoise{});
  EXPECT_FALSE(says(decide(facts, {}, asking()), "many depths are exactly"));
  facts.read_depth = [read = facts.read_depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read(frame, unit_m, depth_m);
    for (std::size_t i = 0; i < depth_m.pixels.size(); i += 5) depth_m.pixels[i] = 10.0F;
  };
  EXPECT_TRUE(says(decide(facts, {}, asking()), "many depths are exactly 10 m"));
  facts.read_depth = [read = facts.read_depth](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read(frame, unit_m, depth_m);
    std::fill(depth_m.pixels.begin(), depth_m.pixels.end(), 0.0F);
  };
  EXPECT_TRUE(says(decide(facts, {}, asking()), "holds a depth"));
}

}  // namespace
}  // namespace roomradar::mutations_test
