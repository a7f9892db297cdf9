// kinect_pairing.hpp: assigns timestamps to a Kinect's images and pairs depth with colour.
#pragma once
#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "app/sources/kinect/kinect_frame.hpp"

namespace roomradar {

/// Makes frames from the images of a device, in the order of the depth images. An unusable depth image
/// becomes a frame with an error message. Used by the device's thread only.
class KinectPairing {
 public:
  /// @param config  must outlive the pairing
  /// @param put     called with each frame
  KinectPairing(const KinectFeedConfig& config, std::function<void(KinectFrame)> put)
      : config_(config), put_(std::move(put)) {}

  /// Makes stamps advance by the elapsed host time across a gap. Call before the device is reopened, since
  /// the first images may arrive during the opening.
  void restart_clock();
  /// Adds a depth image. Returns false if its size is wrong.
  /// @param pixels          640 x 480 values
  /// @param ticks           stamp of the device's clock
  /// @param memory          returns a frame whose buffers can be reused
  /// @param acceleration_g  latest accelerometer reading, g, in the accelerometer's axes
  bool add_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks,
                 const std::function<KinectFrame()>& memory,
                 const std::optional<Eigen::Vector3d>& acceleration_g);
  /// Adds a colour image. Returns false and ignores the image if its size is wrong; its depth image then has
  /// no colour.
  /// @param bytes  640 x 480 x 3 values
  /// @param ticks  stamp of the device's clock
  bool add_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks);
  /// Passes all frames with decided pairs to `put`.
  void hand_over();
  /// Passes all remaining frames to `put`. Call after the device has been closed.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  struct Colour {
    std::int64_t number = 0;
    std::vector<std::uint8_t> pixels{};
  };

  double stamp_of(std::uint32_t ticks);
  void pass_over_broken();
  /// Adds an error to the queue of depth images that wait for colour, so that frames keep their order.
  void fail(std::int64_t number, const std::string& what);
  [[nodiscard]] KinectFrame broken_frame(std::int64_t number, const std::string& what) const;
  void put_broken();

  const KinectFeedConfig& config_;
  std::function<void(KinectFrame)> put_;
  KinectClock clock_;
  StampPairing pairing_{kDevicePairing};
  std::int64_t depth_count_ = 0;
  std::int64_t colour_count_ = 0;
  std::deque<KinectFrame> depths_;
  std::deque<Colour> colours_;
  bool is_finishing_ = false;
  int backwards_ = 0;
  double last_stamp_s_ = 0.0;
  Clock::time_point last_stamp_at_ = Clock::now();
};

}  // namespace roomradar
