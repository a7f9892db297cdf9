// stamp_pairing.hpp: pairs colour images with depth images by timestamp, for all sources.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace roomradar {

/// Default max number of unpaired colour images in a StampPairing. Callers store the pixels of this number of
/// colour images.
constexpr std::size_t kColoursKept = 8;

struct PairingConfig {
  /// Max time between the images of a pair. Half a period at 30 Hz is 0.017 s.
  double tolerance_s = 0.020;
  /// Half the min time between images of one kind; 0 if unknown. A colour image within this time of a depth
  /// image is paired with it immediately, since no other image can be closer. Immediate pairing reduces a
  /// live device's latency by up to one frame.
  double unbeatable_s = 0.0;
  /// Max number of unpaired colour images. Recordings use a larger number than devices.
  std::size_t colours_kept = kColoursKept;
};

/// Settings for devices with at most 30 images/s of each kind. Some images may be missing, so the nearest
/// colour image may be almost a period away.
constexpr PairingConfig kDevicePairing{.tolerance_s = 0.030, .unbeatable_s = 1.0 / 60.0};

/// A depth image and its colour image, if any, identified by the numbers passed to StampPairing.
struct DepthColourPair {
  std::int64_t depth = 0;
  std::optional<std::int64_t> colour{};
  /// Colour stamp minus depth stamp; 0 without colour.
  double colour_after_depth_s = 0.0;
  /// True if the depth image's stamp is not later than the previous depth image's. The image is then
  /// unusable.
  bool stamp_goes_back = false;
};

/// Pairs depth and colour images, which callers add in order of arrival. Pairs are returned in the order of
/// the depth images. A depth image is paired with the colour image nearest in time. Candidates are unpaired
/// colour images within the tolerance that are not nearer to the next depth image. A lost colour image thus
/// leaves only one depth image without colour. A pair is decided when no later colour image can be nearer, or
/// when the next depth image has arrived. The result depends only on stamps and order of arrival. A recording
/// in order of arrival thus gives the same pairs as the live device.
class StampPairing {
 public:
  explicit StampPairing(const PairingConfig& config) : config_(config) {}

  /// Adds a depth image.
  void add_depth(std::int64_t depth, double stamp_s);
  /// Adds a colour image.
  void add_colour(std::int64_t colour, double stamp_s);
  /// Ends the input. Pairs of all remaining depth images are then decided.
  void finish() { finished_ = true; }
  /// Returns the next decided pair, or nullopt if there is none.
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
