// stamp_pairing.hpp: which colour image goes with which depth image: one rule for all sources.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace roomradar {

/// How many colour images a StampPairing remembers while no depth image takes them; who keeps the images
/// keeps as many.
constexpr std::size_t kColoursKept = 8;

struct PairingConfig {
  double tolerance_s = 0.020;  ///< farther apart is no pair; half a period at 30 Hz is 0.017
  /// Half of the shortest time between images of a kind; 0 where that is not known. A colour image as near to
  /// its depth image is taken at once, since no other of either can be nearer: saves a live device up to a
  /// frame of waiting.
  double unbeatable_s = 0.0;
  /// Colour images that are remembered while no depth image takes them: of a list, more than a device's.
  std::size_t colours_kept = kColoursKept;
};

/// For devices that deliver at 30 Hz at most. Their recordings drop images, so a whole period apart may be
/// all there is.
constexpr PairingConfig kDevicePairing{.tolerance_s = 0.030, .unbeatable_s = 1.0 / 60.0};

/// A depth image with the colour image that goes with it, if one does.
struct DepthColourPair {
  std::int64_t depth = 0;
  std::optional<std::int64_t> colour{};
  double colour_after_depth_s = 0.0;  ///< by their stamps; 0 without colour
  bool stamp_goes_back = false;       ///< not later than the depth image before it: not to be used
};

/// Depth and colour images, known by numbers, come in as they arrive; pairs go out in the order of the depth
/// images. Each depth image takes the colour image nearest to it in time, within the tolerance, not taken
/// before, and not nearer to the depth image after it: where one colour image is lost, one depth image goes
/// without. It waits for it until none that arrives can be nearer, or the depth image after it has arrived.
/// The answer depends on the order of arrivals only, not on the time of day, so a recording of
/// arrivals gives the same pairs as the device did.
class StampPairing {
 public:
  explicit StampPairing(const PairingConfig& config) : config_(config) {}

  void add_depth(std::int64_t depth, double stamp_s);
  void add_colour(std::int64_t colour, double stamp_s);
  /// Nothing more will arrive: who waits need not.
  void finish() { finished_ = true; }
  /// The next pair that is decided.
  std::optional<DepthColourPair> take();

 private:
  struct Stamped {
    std::int64_t number;
    double stamp_s;
  };
  PairingConfig config_;
  std::deque<Stamped> waiting_;  // depth images, in the order of arrival
  std::deque<Stamped> colours_;  // not taken, at most colours_kept
  std::optional<double> last_depth_s_;
  bool finished_ = false;
};

}  // namespace roomradar
