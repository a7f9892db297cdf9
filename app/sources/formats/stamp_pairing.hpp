// stamp_pairing.hpp: assigns colour images to depth images by time stamp, by the same rule for all sources.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace roomradar {

/// Max number of unpaired colour images that a StampPairing remembers. Callers that store the images keep the
/// same number.
constexpr std::size_t kColoursKept = 8;

struct PairingConfig {
  /// Max time between the images of a pair; half a period at 30 Hz is 0.017 s.
  double tolerance_s = 0.020;
  /// Half the shortest time between images of one kind; 0 if unknown. A colour image this close to its depth
  /// image is paired immediately, since no other image of either kind can be closer. This saves a live device
  /// up to a frame of latency.
  double unbeatable_s = 0.0;
  /// Max number of unpaired colour images remembered. Larger for a recording's list than for a device.
  std::size_t colours_kept = kColoursKept;
};

/// Settings for devices that deliver at most 30 Hz. Images are missing in recordings of such devices, so the
/// nearest colour image may be almost a period away.
constexpr PairingConfig kDevicePairing{.tolerance_s = 0.030, .unbeatable_s = 1.0 / 60.0};

/// A depth image, and its colour image if there is one. Images are identified by the caller's numbers.
struct DepthColourPair {
  std::int64_t depth = 0;
  std::optional<std::int64_t> colour{};
  /// Colour stamp minus depth stamp; 0 without colour.
  double colour_after_depth_s = 0.0;
  /// True if the depth image's stamp is not after the previous one's; the image is then unusable.
  bool stamp_goes_back = false;
};

/// Pairs depth and colour images, which the caller identifies by numbers and adds in order of arrival. Pairs
/// are returned in the order of the depth images. Each depth image is paired with the nearest colour image in
/// time that is within the tolerance, not already paired, and not nearer to the next depth image. A lost
/// colour image thus leaves one depth image without colour. A pair is decided once no later colour image can
/// be nearer, or once the next depth image has arrived. The result depends only on stamps and order of
/// arrival, so a recording of arrivals gives the same pairs as the device did.
class StampPairing {
 public:
  explicit StampPairing(const PairingConfig& config) : config_(config) {}

  /// Adds a depth image.
  void add_depth(std::int64_t depth, double stamp_s);
  /// Adds a colour image.
  void add_colour(std::int64_t colour, double stamp_s);
  /// Ends the input: waiting depth images are decided without waiting for further images.
  void finish() { finished_ = true; }
  /// Returns the next decided pair, or nothing if none is decided.
  std::optional<DepthColourPair> take();

 private:
  struct Stamped {
    std::int64_t number;
    double stamp_s;
  };
  PairingConfig config_;
  // Depth images without a decision, in order of arrival.
  std::deque<Stamped> waiting_;
  // Unpaired colour images, at most colours_kept.
  std::deque<Stamped> colours_;
  std::optional<double> last_depth_s_;
  bool finished_ = false;
};

}  // namespace roomradar
