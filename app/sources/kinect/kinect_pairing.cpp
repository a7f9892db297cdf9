// kinect_pairing.cpp: waits with each depth image until its colour image is decided.
#include "app/sources/kinect/kinect_pairing.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

constexpr std::size_t kPixels = std::size_t{640} * 480;
constexpr double kFrame_s = 1.0 / 30.0;
constexpr int kBackwardsMost = 3;

}  // namespace

void KinectPairing::restart_clock() {
  const double gap_s = std::chrono::duration<double>(Clock::now() - last_stamp_at_).count();
  clock_.restart(last_stamp_s_ + std::max(kFrame_s, gap_s));
}

double KinectPairing::stamp_of(std::uint32_t ticks) {
  const double stamp_s = clock_.seconds(ticks);
  last_stamp_s_ = std::max(last_stamp_s_, stamp_s);
  last_stamp_at_ = Clock::now();
  return stamp_s;
}

bool KinectPairing::add_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks,
                              const std::function<KinectFrame()>& memory,
                              const std::optional<Eigen::Vector3d>& acceleration_g) {
  pass_over_broken();
  const double stamp_s = stamp_of(ticks);
  const std::int64_t number = depth_count_++;
  if (pixels.size() != kPixels) {
    fail(number, "has " + std::to_string(pixels.size()) + " pixels instead of " + std::to_string(kPixels));
    return false;
  }
  KinectFrame depth = memory();
  depth.number = number;
  depth.stamp_s = stamp_s;
  depth.depth.assign(pixels.begin(), pixels.end());
  if (acceleration_g) depth.down_camera = down_from_acceleration(*acceleration_g);
  pairing_.add_depth(depth.number, depth.stamp_s);
  depths_.push_back(std::move(depth));
  return true;
}

bool KinectPairing::add_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks) {
  const double stamp_s = stamp_of(ticks);
  const std::int64_t number = colour_count_++;
  if (bytes.size() != 3 * kPixels) return false;  // the depth image then has no colour
  Colour colour = colours_.size() < kColoursKept ? Colour{} : std::move(colours_.front());
  if (colours_.size() == kColoursKept) colours_.pop_front();
  colour.number = number;
  colour.pixels.assign(bytes.begin(), bytes.end());
  pairing_.add_colour(number, stamp_s);
  colours_.push_back(std::move(colour));
  return true;
}

void KinectPairing::hand_over() {
  while (true) {
    put_broken();
    const auto pair = pairing_.take();
    if (!pair) return;
    KinectFrame frame = std::move(depths_.front());
    depths_.pop_front();
    if (pair->stamp_goes_back) {
      put_(broken_frame(frame.number, "has a stamp that is not later than that of the one before it"));
      // If several stamps in a row go back, the device's clock was reset, so its stamps are valid again.
      if (++backwards_ < kBackwardsMost || config_.is_replay) continue;
      clock_.restart(last_stamp_s_ + kFrame_s);
      finish();
      continue;
    }
    backwards_ = 0;
    const auto colour = std::find_if(colours_.begin(), colours_.end(), [&](const Colour& candidate) {
      return pair->colour && candidate.number == *pair->colour;
    });
    if (colour != colours_.end()) {
      std::swap(frame.colour, colour->pixels);
      frame.colour_after_depth_s = pair->colour_after_depth_s;
    }
    put_(std::move(frame));
  }
}

void KinectPairing::finish() {
  if (std::exchange(is_finishing_, true)) return;
  if (config_.is_replay) pass_over_broken();
  pairing_.finish();
  hand_over();
  pairing_ = StampPairing(kDevicePairing);
  is_finishing_ = false;
}

void KinectPairing::pass_over_broken() {
  for (auto known = config_.broken.find(depth_count_); known != config_.broken.end();
       known = config_.broken.find(depth_count_))
    fail(depth_count_++, known->second);
}

void KinectPairing::fail(std::int64_t number, const std::string& what) {
  depths_.push_back(broken_frame(number, what));
}

KinectFrame KinectPairing::broken_frame(std::int64_t number, const std::string& what) const {
  KinectFrame frame;
  frame.number = number;
  frame.fault = config_.name + ": depth image " + std::to_string(number) + " " + what;
  return frame;
}

void KinectPairing::put_broken() {
  while (!depths_.empty() && !depths_.front().fault.empty()) {
    put_(std::move(depths_.front()));
    depths_.pop_front();
  }
}

}  // namespace roomradar
