// stamp_repair.hpp: makes usable times of the time stamps that a recording states.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/input_report.hpp"
#include "app/sources/formats/source_options.hpp"

namespace roomradar {

/// A part of a list whose clock differs from that of the list's first part.
struct ClockStretch {
  std::size_t first = 0;  ///< index of its first image
  double shift_s = 0.0;   ///< added to its stamps
};

/// Times of the images of one list.
struct RepairedStamps {
  std::vector<double> stamps_s{};  ///< per image, in the list's order; kNoStamp: unknown
  double unit_s = 1.0;             ///< length of a unit of the stated stamps
  /// Header clock minus reception clock, s; 0 if either is not recorded.
  double header_offset_s = 0.0;
  std::vector<ClockStretch> stretches{};  ///< empty: the clock was not set while recording
};

struct StampRules {
  StampChoice choice = StampChoice::kAuto;
  bool have_no_unit = false;  ///< see RecordingFacts::stamps_have_no_unit
  std::string what{};         ///< "depth images" or "colour images", for the decisions
  /// Result for another list of the same recording, such as its depth images: gives its unit, its clock's
  /// offset to the time of reception where no stamp is stated, and its clock's changes. Null: none.
  const RepairedStamps* like = nullptr;
};

/// Returns the time of each image.
/// - Stamps that are 0 or not finite are replaced by the time of reception, or interpolated.
/// - Stamps in ms, us or ns are recognised by their rate: 1 to 240 images per second.
/// - Where the clock was set while recording, later stamps are moved: by the time of reception, else so that
///   they continue after one period. A list that is merely not sorted has no such place.
/// - An isolated stamp far from all others is replaced as if it were 0.
/// - Equal stamps are spread evenly up to the next stamp.
/// Correct stamps are returned unchanged, to the bit.
/// @param times  of the images, in the recording's order, which is that of reception if that is recorded
/// @param report  receives one decision for each kind of change
RepairedStamps repair_stamps(const std::vector<StatedTime>& times, const StampRules& rules,
                             InputReport& report);

/// Brings the stamps of a track, such as poses, to the clock of the images: unit, clock changes, order. Returns
/// the length of a unit of its stamps, s: that of the images' stamps, or another if only that fits the images.
double repair_track(std::vector<StampedPose>& track, const RepairedStamps& images);
double repair_track(std::vector<StampedAcceleration>& track, const RepairedStamps& images);

}  // namespace roomradar
