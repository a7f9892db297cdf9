// scan_advice.cpp: thresholds and sentences.
#include "app/scan/live/scan_advice.hpp"

#include <algorithm>

namespace roomradar {
namespace {

bool is_true(ScanFault fault, const ScanFacts& facts) {
  const bool is_lost = facts.status == TrackStatus::kDiverged || facts.status == TrackStatus::kTooFewPoints;
  const double missing = 1.0 - facts.depth_fraction;
  switch (fault) {
    case ScanFault::kSilent:
      return false;
    case ScanFault::kLost:
      return is_lost || facts.is_apart;
    case ScanFault::kTooNear:
      // Nearer than its range a Kinect measures nothing, so the view is partly near and partly without depth.
      return missing + facts.near_fraction > 0.7 && facts.near_fraction > 0.05 && facts.far_fraction < 0.05;
    case ScanFault::kTooFar:
      return missing + facts.far_fraction > 0.8 && facts.near_fraction < 0.02;
    case ScanFault::kOneWall:
      return facts.status == TrackStatus::kDegenerate;
    case ScanFault::kTooFast:
      return relative_speed(facts) > 1.0;
    case ScanFault::kMovement:
      return !is_lost && facts.moved_fraction > 0.01;
    case ScanFault::kTooDark:
      return facts.brightness >= 0.0 && facts.brightness < 25.0;
  }
  return false;
}

}  // namespace

std::string_view to_sentence(ScanFault fault) {
  switch (fault) {
    case ScanFault::kSilent:
      return "The camera delivers no pictures. Check its cable and power.";
    case ScanFault::kLost:
      return "Tracking is lost. Go back to what you saw last, and hold the camera still.";
    case ScanFault::kTooNear:
      return "Too near. Keep at least 60 cm away.";
    case ScanFault::kTooFar:
      return "Too far. Go closer than 4 m.";
    case ScanFault::kOneWall:
      return "Only a flat surface is in view. Turn until a corner or furniture is in view.";
    case ScanFault::kTooFast:
      return "Too fast. Move and turn slowly.";
    case ScanFault::kMovement:
      return "Something moves in view. Wait until it is gone, or turn away from it.";
    case ScanFault::kTooDark:
      return "The picture is dark. Depth is measured all the same; for colours, switch on the light.";
  }
  return "";
}

ScanFacts facts_of(const Frame& frame, const Tracking& tracking) {
  constexpr int kStep_px = 8;
  ScanFacts facts;
  std::size_t pixels = 0, with_depth = 0, near = 0, far = 0;
  for (int y = kStep_px / 2; y < frame.depth_m.height; y += kStep_px)
    for (int x = kStep_px / 2; x < frame.depth_m.width; x += kStep_px) {
      const float depth_m = frame.depth_m.at(x, y);
      ++pixels;
      with_depth += depth_m > 0.0F ? 1 : 0;
      near += depth_m > 0.0F && depth_m < 0.6F ? 1 : 0;
      far += depth_m > 4.0F ? 1 : 0;
    }
  const auto fraction = [&](std::size_t some) {
    return pixels > 0 ? static_cast<double>(some) / static_cast<double>(pixels) : 0.0;
  };
  facts.depth_fraction = fraction(with_depth);
  facts.near_fraction = fraction(near);
  facts.far_fraction = fraction(far);
  double sum = 0.0;
  std::size_t colours = 0;
  for (int y = kStep_px / 2; y < frame.colour.height; y += kStep_px)
    for (int x = kStep_px / 2; x < frame.colour.width; x += kStep_px, ++colours) {
      const Rgb& pixel = frame.colour.at(x, y);
      sum += (pixel.r + pixel.g + pixel.b) / 3.0;
    }
  if (colours > 0) facts.brightness = sum / static_cast<double>(colours);
  facts.status = tracking.status;
  return facts;
}

double relative_speed(const ScanFacts& facts) {
  return std::max(facts.speed_mps / kMostSpeed_mps, facts.speed_rad_s / kMostSpeed_rad_s);
}

void ScanAdvice::add(const ScanFacts& facts, double stamp_s) {
  std::optional<ScanFault> now;
  for (std::size_t i = 0; i < kScanFaults; ++i) {
    const auto fault = static_cast<ScanFault>(i);
    std::optional<double>& since_s = since_s_[i];
    if (!is_true(fault, facts))
      since_s.reset();
    else if (!since_s)
      since_s = stamp_s;
    if (!now && since_s && stamp_s - *since_s >= kLasts_s) now = fault;
  }
  if (now) {
    fault_ = now;
    stated_s_ = stamp_s;
  } else if (fault_ && stamp_s - stated_s_ >= kStated_s) {
    fault_.reset();
  }
}

}  // namespace roomradar
