// kinect_source_test.cpp: a scripted Kinect that stalls, disconnects, returns, hangs or sends invalid data.
#include "app/sources/kinect/kinect_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/kinect/kinect_rig.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::kinect_source_test {
namespace {

using test::contains;
using test::error_of;

constexpr std::size_t kPixels = 640 * 480;
constexpr std::uint32_t kFrameTicks = 2'000'000;

/// An action of the scripted device in one call of serve().
struct Act {
  enum class Kind { kDepth, kColour, kShortDepth, kShortColour, kSilence, kGone, kHang } kind = Kind::kDepth;
  std::uint32_t ticks = 0;
  std::uint16_t raw = 700;
};

/// A device that performs a list of acts, then is silent. Each opening performs the next list.
struct Script {
  std::vector<std::vector<Act>> openings;
  std::string serial = "A123";
  std::optional<KinectConstants> constants;
  /// Error messages of openings that fail, by their number.
  std::map<std::size_t, std::string> refusals;

  std::atomic<std::size_t> opened = 0;
  std::atomic<bool> release = false;  // ends a hanging call
  std::atomic<int> alive = 0;         // number of devices
  std::mutex mutex;
  std::vector<std::string> requested_serials;
  std::vector<std::string> said;

  [[nodiscard]] bool has_said(const std::string& part) {
    const std::lock_guard lock(mutex);
    for (const std::string& sentence : said)
      if (contains(sentence, part)) return true;
    return false;
  }
};

class ScriptedDevice final : public KinectDevice {
 public:
  ScriptedDevice(std::shared_ptr<Script> script, KinectListener listener, std::vector<Act> acts)
      : script_(std::move(script)), listener_(std::move(listener)), acts_(std::move(acts)) {
    ++script_->alive;
  }
  ~ScriptedDevice() override { --script_->alive; }

  bool serve(double /*patience_s*/) override {
    const auto pause = std::chrono::milliseconds(1);
    if (at_ == acts_.size()) {
      std::this_thread::sleep_for(pause);
      return true;
    }
    const Act act = acts_[at_++];
    switch (act.kind) {
      case Act::Kind::kDepth:
      case Act::Kind::kShortDepth:
        depth_.assign(act.kind == Act::Kind::kDepth ? kPixels : kPixels / 3, act.raw);
        listener_.on_depth(depth_, act.ticks);
        break;
      case Act::Kind::kColour:
      case Act::Kind::kShortColour:
        colour_.assign(act.kind == Act::Kind::kColour ? 3 * kPixels : 77, static_cast<std::uint8_t>(act.raw));
        listener_.on_colour(colour_, act.ticks);
        break;
      case Act::Kind::kSilence:
        std::this_thread::sleep_for(pause);
        break;
      case Act::Kind::kGone:
        return false;
      case Act::Kind::kHang:
        while (!script_->release) std::this_thread::sleep_for(pause);
        break;
    }
    return true;
  }
  void ask_acceleration() override { asked_ = true; }
  [[nodiscard]] std::optional<Eigen::Vector3d> acceleration_g() const override {
    if (!asked_) return std::nullopt;
    return Eigen::Vector3d(0.0, 1.0, 0.0);
  }
  [[nodiscard]] std::string serial() const override { return script_->serial; }
  [[nodiscard]] std::optional<KinectConstants> constants() const override { return script_->constants; }

 private:
  std::shared_ptr<Script> script_;
  KinectListener listener_;
  std::vector<Act> acts_;
  std::size_t at_ = 0;
  bool asked_ = false;
  std::vector<std::uint16_t> depth_;
  std::vector<std::uint8_t> colour_;
};

std::vector<Act> images(int count, std::uint32_t first_ticks = 0, bool with_colour = true) {
  std::vector<Act> acts;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t ticks = first_ticks + static_cast<std::uint32_t>(i) * kFrameTicks;
    acts.push_back({Act::Kind::kDepth, ticks, static_cast<std::uint16_t>(600 + i)});
    if (with_colour) acts.push_back({Act::Kind::kColour, ticks + 1000, static_cast<std::uint16_t>(i)});
  }
  return acts;
}

/// Opens the scripted device with short timeouts: delays of seconds with a real device take no time here.
std::unique_ptr<FrameSource> open_scripted(const std::shared_ptr<Script>& script, SourceOptions options = {},
                                           std::size_t most_waiting = 0) {
  KinectFeedConfig config{.name = "kinect:0"};
  config.silence_s = 0.1;
  config.retry_s = 0.005;
  config.patience_s = 5.0;
  config.stop_s = 0.1;
  options.say = [script](const std::string& sentence) {
    const std::lock_guard lock(script->mutex);
    script->said.push_back(sentence);
  };
  options.keep_all = most_waiting == 0;
  return open_kinect(
      [script](const KinectRequest& wish) -> std::unique_ptr<KinectDevice> {
        const std::size_t opening = script->opened++;
        {
          const std::lock_guard lock(script->mutex);
          script->requested_serials.push_back(wish.serial);
        }
        const auto refusal = script->refusals.find(opening);
        if (refusal != script->refusals.end()) throw Error(refusal->second);
        const std::vector<Act> acts =
            opening < script->openings.size() ? script->openings[opening] : std::vector<Act>{};
        return std::make_unique<ScriptedDevice>(script, wish.listener, acts);
      },
      config, options);
}

/// Reads until `count` frames have arrived; collects skipped frames, except waiting, as faults.
test::ReadAll read_frames(FrameSource& source, std::size_t count) {
  test::ReadAll all;
  Frame frame;
  while (all.frames.size() < count) {
    const ReadResult result = source.next(frame);
    if (result.status == ReadStatus::kEnd) break;
    if (result.status == ReadStatus::kFrame)
      all.frames.push_back(frame);
    else if (result.status == ReadStatus::kSkipped)
      all.faults.push_back(result.fault);
  }
  return all;
}

TEST(KinectSource, FramesHaveDepthColourGravityAndTheDevicesTime) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(4, 5 * kFrameTicks)};
  const auto source = open_scripted(script);
  const auto frames = read_frames(*source, 4).frames;
  ASSERT_EQ(frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].index, static_cast<std::int64_t>(i));
    EXPECT_NEAR(frames[i].stamp_s, (5.0 + static_cast<double>(i)) / 30.0, 1e-9);
    EXPECT_EQ(frames[i].depth_m.at(0, 0), raw_depth_m(static_cast<std::uint16_t>(600 + i)));
    EXPECT_EQ(frames[i].colour.at(639, 479).g, i);
  }
  EXPECT_FALSE(frames[0].down_camera);  // unknown so far: absent, not an invented direction
  ASSERT_TRUE(frames[2].down_camera);
  EXPECT_NEAR(frames[2].down_camera->y(), 1.0, 1e-12);
}

TEST(KinectSource, TimeGoesOnWhereTheStampsWrap) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(6, 0U - 3 * kFrameTicks)};
  const auto frames = read_frames(*open_scripted(script), 6).frames;
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 1; i < 6; ++i)
    EXPECT_NEAR(frames[i].stamp_s - frames[i - 1].stamp_s, 1.0 / 30.0, 1e-9) << i;
}

TEST(KinectSource, OneThatFallsSilentIsSaidAndStartedAnewAndGoesOn) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(3), images(3)};  // its clock restarts, too
  const auto source = open_scripted(script);
  const auto frames = read_frames(*source, 6).frames;
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(frames[i].index, frames[i - 1].index + 1);
    EXPECT_GT(frames[i].stamp_s, frames[i - 1].stamp_s);
  }
  EXPECT_GT(frames[3].stamp_s - frames[2].stamp_s, 0.1);  // the time that passed here
  EXPECT_TRUE(script->has_said("no depth image"));
  EXPECT_TRUE(script->has_said("is back after"));
  EXPECT_EQ(script->requested_serials.at(0), "");
  EXPECT_EQ(script->requested_serials.at(1), "A123");  // the same device, whatever its index is now
}

TEST(KinectSource, OneThatIsUnpluggedIsWaitedForUntilItIsBack) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> goes = images(2);
  goes.push_back({Act::Kind::kGone});
  script->openings = {goes, {}, {}, images(2)};
  script->refusals = {{1, "kinect:0: there is no such Kinect"}, {2, "kinect:0: there is no such Kinect"}};
  const auto source = open_scripted(script);
  EXPECT_EQ(read_frames(*source, 4).frames.size(), 4U);
  EXPECT_TRUE(script->has_said("has gone"));
  const std::lock_guard lock(script->mutex);
  EXPECT_TRUE(contains(script->said.at(1), "is back"));  // not one message per attempt
}

TEST(KinectSource, WhileItIsAwayTheReaderIsNotHeld) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(1)};
  const auto source = open_scripted(script);
  read_frames(*source, 1);
  Frame frame;
  const ReadResult result = source->next(frame);
  EXPECT_EQ(result.status, ReadStatus::kWaiting);
  EXPECT_TRUE(contains(result.fault, "no depth image")) << result.fault;
}

TEST(KinectSource, OneThatStaysAwayIsGivenUp) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(1)};
  SourceOptions options;
  options.device_timeout_s = 0.4;
  const auto source = open_scripted(script, options);
  const std::string error = error_of([&] { read_frames(*source, 5); });
  EXPECT_TRUE(contains(error, "cable")) << error;
}

TEST(KinectSource, OneThatIsAwayIsNotGivenUpBecauseItsReaderPaused) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(1)};
  SourceOptions options;
  options.device_timeout_s = 0.4;
  const auto source = open_scripted(script, options);
  read_frames(*source, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(450));
  Frame frame;
  EXPECT_EQ(source->next(frame).status, ReadStatus::kWaiting);
}

TEST(KinectSource, OneThatSendsNoColourIsStartedAnewOnceThenGoesOnWithout) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> depth_only;
  for (std::uint32_t i = 0; i < 900; ++i) {  // about 0.9 s
    depth_only.push_back({Act::Kind::kDepth, i * kFrameTicks});
    depth_only.push_back({Act::Kind::kSilence});
  }
  script->openings = {depth_only, depth_only, depth_only, depth_only};
  const auto source = open_scripted(script);
  const auto frames = read_frames(*source, 800).frames;
  EXPECT_EQ(frames.size(), 800U);
  EXPECT_TRUE(frames.back().colour.empty());
  const std::lock_guard lock(script->mutex);
  EXPECT_EQ(std::count_if(script->said.begin(), script->said.end(),
                          [](const std::string& sentence) { return contains(sentence, "no colour"); }),
            1);
}

TEST(KinectSource, BrokenImagesArePassedOverAndCounted) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> acts = images(6);
  acts[4].kind = Act::Kind::kShortDepth;   // depth of frame 2
  acts[7].kind = Act::Kind::kShortColour;  // colour of frame 3
  script->openings = {acts};
  const auto all = read_frames(*open_scripted(script), 5);
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_TRUE(contains(all.faults[0], "depth image 2 has 102400 pixels")) << all.faults[0];
  std::vector<std::int64_t> indices;
  for (const Frame& frame : all.frames) indices.push_back(frame.index);
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 1, 3, 4, 5}));
  EXPECT_TRUE(all.frames[2].colour.empty());
}

TEST(KinectSource, ABrokenImageDoesNotOvertakeTheFrameThatWaitsForItsColour) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> acts = images(4);
  acts[1].kind = Act::Kind::kSilence;  // frame 0 has no colour
  acts[2].kind = Act::Kind::kShortDepth;
  script->openings = {acts};
  const auto source = open_scripted(script);
  std::vector<std::int64_t> order;  // -1: a fault
  for (Frame frame; order.size() < 4;) {
    const ReadResult result = source->next(frame);
    ASSERT_NE(result.status, ReadStatus::kEnd);
    if (result.status != ReadStatus::kWaiting)
      order.push_back(result.status == ReadStatus::kFrame ? frame.index : -1);
  }
  EXPECT_EQ(order, (std::vector<std::int64_t>{0, -1, 2, 3}));
}

TEST(KinectSource, AClockThatIsSetBackStopsNothing) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> acts = images(3, 100 * kFrameTicks);
  for (const Act& act : images(8, 0)) acts.push_back(act);  // the clock jumps back by 3.3 s for good
  script->openings = {acts};
  const auto all = read_frames(*open_scripted(script), 3 + 8 - 3);
  EXPECT_EQ(all.faults.size(), 3U);
  ASSERT_EQ(all.frames.size(), 8U);
  for (std::size_t i = 1; i < all.frames.size(); ++i)
    EXPECT_GT(all.frames[i].stamp_s, all.frames[i - 1].stamp_s);
}

TEST(KinectSource, APictureIsOfTheNewestFrame) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(20)};
  const auto source = open_scripted(script, {}, /*most_waiting=*/1);
  // until all 20 are sent
  while (script->opened == 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(read_frames(*source, 1).frames.at(0).index, 19);
}

TEST(KinectSource, AScanGetsFramesThatCameWhileItWasBusy) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(100)};
  const auto source = open_scripted(script);
  while (script->opened == 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(read_frames(*source, 100).frames.back().index, 99);
}

TEST(KinectSource, ItStopsAtOnceWhileTheDeviceIsSilent) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(1)};
  { const auto source = open_scripted(script); }
  EXPECT_EQ(script->alive, 0);  // closed, not abandoned
}

TEST(KinectSource, ItStopsWhileTheDeviceHangs) {
  const auto script = std::make_shared<Script>();
  std::vector<Act> acts = images(2);
  acts.push_back({Act::Kind::kHang});
  script->openings = {acts};
  {
    const auto source = open_scripted(script);
    EXPECT_EQ(read_frames(*source, 2).frames.size(), 2U);
    Frame frame;
    EXPECT_EQ(source->next(frame).status, ReadStatus::kWaiting);
  }
  EXPECT_EQ(script->alive, 1);  // abandoned, with everything it uses
  script->release = true;
  for (int i = 0; i < 2000 && script->alive > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(script->alive, 0);
}

TEST(KinectSource, WhatIsInTheWayOfTheFirstOpeningIsThrown) {
  const auto script = std::make_shared<Script>();
  script->refusals = {{0, "kinect:0: cannot be opened: another program uses it; end that program"}};
  const std::string error = error_of([&] { open_scripted(script); });
  EXPECT_TRUE(contains(error, "another program")) << error;
  EXPECT_EQ(script->opened, 1U);
}

/// Registration constants of a device whose colour camera differs from the nominal one.
KinectConstants constants_of(const CameraRig& rig) {
  KinectConstants constants;
  for (const double depth_m : {0.6, 0.8, 1.2, 2.0, 3.5, 6.0})
    for (int y = 20; y < 480; y += 40)
      for (int x = 20; x < 640; x += 40)
        constants.seen_by_both.push_back(
            {{x, y},
             depth_m,
             project(*rig.colour_camera,
                     rig.T_colour_depth * back_project(rig.depth_camera, x, y, depth_m))});
  return constants;
}

CameraRig unusual_rig() {
  CameraRig rig = nominal_rig(NominalRig::kKinect, {640, 480}, ImageSize{640, 480});
  rig.colour_camera->fx_px = rig.colour_camera->fy_px = 529.0;
  rig.colour_camera->cx_px += 6.0;
  rig.colour_camera->cy_px -= 4.0;
  rig.T_colour_depth.linear() =
      Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix();
  rig.T_colour_depth.translation().x() = -0.0235;
  return rig;
}

TEST(KinectRig, TheColourCameraStandsWhereTheRegistrationSaysItDoes) {
  const CameraRig truth = unusual_rig();
  const CameraRig nominal = nominal_rig(NominalRig::kKinect, {640, 480}, ImageSize{640, 480});
  const auto rig = fit_kinect_rig(constants_of(truth).seen_by_both, nominal);
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->depth_camera, nominal.depth_camera);
  double worst_px = 0.0;
  for (const double depth_m : {0.5, 1.0, 8.0})
    for (int y = 0; y < 480; y += 37)
      for (int x = 0; x < 640; x += 37) {
        const Eigen::Vector3d p = back_project(truth.depth_camera, x, y, depth_m);
        worst_px = std::max(worst_px, (project(*rig->colour_camera, rig->T_colour_depth * p) -
                                       project(*truth.colour_camera, truth.T_colour_depth * p))
                                          .norm());
      }
  EXPECT_LT(worst_px, 0.1);  // the nominal camera is off by 20
}

TEST(KinectRig, ConstantsThatMakeNoSenseAreNotTaken) {
  const CameraRig nominal = nominal_rig(NominalRig::kKinect, {640, 480}, ImageSize{640, 480});
  std::vector<SeenByBoth> seen = constants_of(nominal).seen_by_both;
  EXPECT_FALSE(fit_kinect_rig({}, nominal));
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i].colour_px.x() += i % 2 == 0 ? 30.0 : -30.0;
  EXPECT_FALSE(fit_kinect_rig(seen, nominal));
  seen[0].colour_px.x() = std::nan("");
  EXPECT_FALSE(fit_kinect_rig(seen, nominal));
}

TEST(KinectSource, TheDevicesOwnConstantsGoBeforePublishedFigures) {
  const auto script = std::make_shared<Script>();
  script->openings = {images(1)};
  script->constants = constants_of(unusual_rig());
  script->constants->zero_plane.const_shift_px = 204.0;
  const Frame frame = read_frames(*open_scripted(script), 1).frames.at(0);
  EXPECT_NEAR(frame.colour_camera.fx_px, 529.0, 1.0);
  EXPECT_EQ(frame.depth_m.at(5, 5), raw_depth_m(600, script->constants->zero_plane));
}

TEST(KinectSource, MillimetresAreTakenAsTheyAre) {
  const auto script = std::make_shared<Script>();
  script->openings = {{{Act::Kind::kDepth, 0, 1234}, {Act::Kind::kColour, 0}}};
  SourceOptions options;
  options.kinect_depth = KinectDepth::kMillimetres;
  const Frame frame = read_frames(*open_scripted(script, options), 1).frames.at(0);
  EXPECT_FLOAT_EQ(frame.depth_m.at(0, 0), 1.234F);
  EXPECT_NE(frame.colour_camera, frame.depth_camera);
}

TEST(KinectSource, RegisteredDepthIsSeenFromTheColourCamera) {
  const auto script = std::make_shared<Script>();
  script->openings = {{{Act::Kind::kDepth, 0, 2000}, {Act::Kind::kColour, 0}}};
  script->constants = constants_of(unusual_rig());
  SourceOptions options;
  options.kinect_depth = KinectDepth::kRegistered;
  const Frame frame = read_frames(*open_scripted(script, options), 1).frames.at(0);
  EXPECT_EQ(frame.colour_camera, frame.depth_camera);
  EXPECT_NEAR(frame.depth_camera.fx_px, 529.0, 1.0);
  EXPECT_TRUE(frame.T_colour_depth.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(KinectUnits, ZeroPlanesDepthGrowsAndIsLikeThePublishedFit) {
  const KinectZeroPlane plane;
  float before_m = 0.0F;
  for (std::uint16_t raw = 400; raw <= 1000; ++raw) {
    const float depth_m = raw_depth_m(raw, plane);
    EXPECT_GT(depth_m, before_m);
    EXPECT_NEAR(depth_m, raw_depth_m(raw), 0.03F * depth_m) << raw;
    before_m = depth_m;
  }
  EXPECT_EQ(raw_depth_m(kRawNoDepth, plane), 0.0F);
  EXPECT_EQ(raw_depth_m(1100, plane), 0.0F);  // beyond the depth at which a raw step is half a metre
  EXPECT_EQ(raw_depth_m(700, {.distance_cm = std::nan("")}), 0.0F);
}

}  // namespace
}  // namespace roomradar::kinect_source_test
