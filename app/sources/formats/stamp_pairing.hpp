// stamp_pairing.hpp: assigns colour images to depth images by time stamp, by the same rule for all sources.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace roomradar {

/// Max colour images that a StampPairing remembers while no depth image takes them. Callers that store the
/// images keep the same number.
constexpr std::size_t kColoursKept = 8;

struct PairingConfig {
  double tolerance_s = 0.020;  ///< max time between the images of a pair; half a period at 30 Hz is 0.017 s
  /// Half the shortest time between images of one kind; 0 if unknown. A colour image this close to its depth
  /// image is paired at once, since no other image of either kind can be closer. Saves a live device up to a
  /// frame of latency.
  double unbeatable_s = 0.0;
  /// Max unpaired colour images remembered; larger for a list than for a device.
  std::size_t colours_kept = kColoursKept;
};

/// For devices that deliver at 30 Hz at most. Recordings made from them lack images, so the best available
/// colour image may be almost a period away.
constexpr PairingConfig kDevicePairing{.tolerance_s = 0.030, .unbeatable_s = 1.0 / 60.0};

/// A depth image with its colour image, if it has one.
struct DepthColourPair {
  std::int64_t depth = 0;
  std::optional<std::int64_t> colour{};
  double colour_after_depth_s = 0.0;  ///< difference of their stamps; 0 without colour
  bool stamp_goes_back = false;       ///< not after the previous depth image's stamp: unusable
};

/// Pairs depth and colour images, identified by numbers and added in order of arrival; pairs come out in the
/// order of the depth images. Each depth image takes the nearest colour image in time that is within the
/// tolerance, not yet taken, and not nearer to the next depth image. A lost colour image thus leaves one
/// depth image without colour. A pair is decided once no later colour image can be nearer, or once the next
/// depth image has arrived. The result depends only on stamps and order of arrival, so a recording of
/// arrivals gives the same pairs as the device did.
class StampPairing {
 public:
  explicit StampPairing(const PairingConfig& config) : config_(config) {}

  void add_depth(std::int64_t depth, double stamp_s);
  void add_colour(std::int64_t colour, double stamp_s);
  /// Declares the input complete: waiting depth images are decided without further arrivals.
  void finish() { finished_ = true; }
  /// Returns the next decided pair, or nothing if none is decided yet.
  std::optional<DepthColourPair> take();

 private:
  struct Stamped {
    std::int64_t number;
    double stamp_s;
  };
  PairingConfig config_;
  std::deque<Stamped> waiting_;  // depth images, in order of arrival
  std::deque<Stamped> colours_;  // not yet taken, max colours_kept
  std::optional<double> last_depth_s_;
  bool finished_ = false;
};

}  // namespace roomradar
