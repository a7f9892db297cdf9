// kinect_source.cpp: converts a feed's raw images to frames with metres, cameras and gravity.
#include "app/sources/kinect/kinect_source.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "app/sources/decisions/camera_choice.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/freenect_device.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr ImageSize kSize{640, 480};
// 200 MB: four seconds, enough for a tracker to catch up after relocalisation.
constexpr std::size_t kAllWaiting = 120;

/// Tabulates metres for each value of a depth pixel.
std::vector<float> metres_of(KinectDepth depth, const std::optional<KinectConstants>& constants) {
  constexpr int kMost_mm = 10'000;
  const bool is_raw = depth == KinectDepth::kRaw;
  std::vector<float> metres(is_raw ? kRawNoDepth : kMost_mm + 1, 0.0F);
  for (std::size_t i = 0; i < metres.size(); ++i) {
    const auto number = static_cast<std::uint16_t>(i);
    metres[i] = !is_raw     ? static_cast<float>(i) / 1000.0F
                : constants ? raw_depth_m(number, constants->zero_plane)
                            : raw_depth_m(number);
  }
  return metres;
}

CameraRig rig_of(KinectDepth depth, const std::optional<KinectConstants>& constants,
                 const std::filesystem::path& recording, const SourceOptions& options) {
  RecordingFacts facts{.name = recording.empty() ? "the Kinect" : recording.string()};
  facts.rig = nominal_rig(NominalRig::kKinect, kSize, kSize);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = constants ? "a Kinect v1, with the device's own constants for colour," : nominal_name(NominalRig::kKinect);
  InputReport ignored;
  choose_cameras(facts, recording, options, options.input ? *options.input : ignored);
  CameraRig rig = facts.rig;
  if (constants)
    if (const auto fitted = fit_kinect_rig(constants->seen_by_both, rig)) rig = *fitted;
  if (depth == KinectDepth::kRegistered) {
    rig.depth_camera = options.depth_camera.value_or(*rig.colour_camera);
    rig.colour_camera = rig.depth_camera;
    rig.T_colour_depth.setIdentity();
  }
  return rig;
}

class KinectSource final : public FrameSource {
 public:
  KinectSource(KinectOpener opener, KinectFeedConfig config, const SourceOptions& options,
               const std::filesystem::path& recording)
      : name_(config.name),
        is_replay_(config.is_replay),
        silence_s_(config.silence_s),
        timeout_s_(options.device_timeout_s),
        feed_(std::move(opener), std::move(config)),
        metres_(metres_of(options.kinect_depth, feed_.constants())),
        rig_(rig_of(options.kinect_depth, feed_.constants(), recording, options)) {}

  ReadResult next(Frame& frame) override {
    const Clock::time_point asked_at = Clock::now();
    const KinectFeed::Take taken = feed_.take(raw_, silence_s_);
    waited_s_ += std::chrono::duration<double>(Clock::now() - asked_at).count();
    switch (taken) {
      case KinectFeed::Take::kFrame:
        break;
      case KinectFeed::Take::kEnd:
        return {ReadStatus::kEnd, {}};
      case KinectFeed::Take::kNothing:
        return waited();
    }
    if (!raw_.fault.empty()) return passed_over();
    bad_in_a_row_ = 0;
    waited_s_ = 0.0;
    fill(frame);
    return {ReadStatus::kFrame, {}};
  }

  bool rewind() override { return false; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kBadFramesInARow = 10;

  ReadResult waited() {
    char text[64];
    format_classic(text, sizeof text, ": no depth image for %.1f s", waited_s_);
    if (is_replay_) return {ReadStatus::kWaiting, name_ + text + ": the recording has a gap"};
    if (waited_s_ > timeout_s_)
      throw Error(name_ + text +
                  "; check its cable and power supply, then begin again (a scan goes on by --resume)");
    return {ReadStatus::kWaiting, name_ + text + "; waiting for it"};
  }

  ReadResult passed_over() {
    // For a device, faults are limited by time instead: it is reopened if no good image arrives.
    if (is_replay_ && ++bad_in_a_row_ >= kBadFramesInARow)
      throw Error(
          raw_.fault + ", the " + std::to_string(bad_in_a_row_) +
          "th in a row that cannot be used; a replay must not begin again by itself: FAKENECT_LOOP=0");
    return {ReadStatus::kSkipped, raw_.fault};
  }

  void fill(Frame& frame) const {
    frame.index = raw_.number;
    frame.stamp_s = raw_.stamp_s;
    frame.colour_after_depth_s = raw_.colour_after_depth_s;
    frame.depth_camera = rig_.depth_camera;
    frame.colour_camera = *rig_.colour_camera;
    frame.T_colour_depth = rig_.T_colour_depth;
    frame.timing = rig_.timing;
    frame.depth_noise = rig_.depth_noise;
    frame.T_world_camera.reset();
    frame.down_camera = raw_.down_camera;
    frame.depth_m.resize(kSize.width_px, kSize.height_px);
    std::transform(raw_.depth.begin(), raw_.depth.end(), frame.depth_m.pixels.begin(),
                   [&](std::uint16_t number) { return number < metres_.size() ? metres_[number] : 0.0F; });
    const bool has_colour = !raw_.colour.empty();
    frame.colour.resize(has_colour ? kSize.width_px : 0, has_colour ? kSize.height_px : 0);
    static_assert(sizeof(Rgb) == 3);
    if (has_colour) std::memcpy(frame.colour.pixels.data(), raw_.colour.data(), raw_.colour.size());
  }

  const std::string name_;
  const bool is_replay_;
  const double silence_s_;
  const double timeout_s_;
  KinectFeed feed_;
  const std::vector<float> metres_;
  const CameraRig rig_;
  KinectFrame raw_;
  int bad_in_a_row_ = 0;
  double waited_s_ = 0.0;  // spent waiting in next() since the last frame; a reader's pauses do not count
};

}  // namespace

std::unique_ptr<FrameSource> open_kinect(KinectOpener opener, KinectFeedConfig config,
                                         const SourceOptions& options,
                                         const std::filesystem::path& recording) {
  config.depth = options.kinect_depth;
  config.most_waiting = options.keep_all ? kAllWaiting : 1;
  config.say = options.say;
  return std::make_unique<KinectSource>(std::move(opener), std::move(config), options, recording);
}

std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options) {
  KinectFeedConfig config{.name = "kinect:" + std::to_string(device), .number = device};
  const auto folder = replayed_folder();
  if (!folder) return open_kinect(open_freenect, std::move(config), options);
  // Owned by the opener, and thus by its thread, for as long as the replay may read from it.
  const auto replay = std::make_shared<FakenectReplay>(*folder);
  config.is_replay = true;
  config.broken = replay->broken();
  return open_kinect([replay](const KinectRequest& request) { return open_freenect(request); },
                     std::move(config), options, *folder);
}

}  // namespace roomradar
