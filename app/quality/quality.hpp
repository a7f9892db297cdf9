// quality.hpp: quality settings of scans and runs. They trade accuracy for time.
#pragma once
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Quality settings of a prescan. visit_fields() describes each field.
struct ScanQuality {
  double resolution_m = 0.01;
  double deviation_m = 0.002;
  int tracking_px = 320;
  int fuse_every = 1;
  friend bool operator==(const ScanQuality&, const ScanQuality&) = default;
};

/// Quality settings of a run, which can change from frame to frame. visit_fields() describes each field.
struct RunQuality {
  int depth_stride = 1;
  int tracking_px = 160;
  int verify_every_n_frames = 1;
  double mesh_tolerance_sigmas = 0.8;
  bool fine_mesh = false;
  RadarMode radar = RadarMode::kExact;
  int radar_px = 64;
  double physics_step_s = 1.0 / 60.0;
  int move_every_n_frames = 1;
  double object_error_px = 0.7;
  bool soft_edges = true;
  bool bridge_gaps = true;
  bool shadows = true;
  int shadow_every_n_frames = 1;
  int picture_every_n_frames = 1;
  friend bool operator==(const RunQuality&, const RunQuality&) = default;
};

/// Description of one field of ScanQuality or RunQuality.
struct QualityField {
  const char* name;
  const char* option;  ///< name on the command line
  const char* unit;    ///< name of the value in help; "N" for counts
  const char* help;    ///< without the default, which the help gets from the struct
  double low = 0.0, high = 0.0;  ///< range of numbers, inclusive
  const char* old_name = "";     ///< former name, which files may still have; empty: none
};

/// Return the word of a field's value, from which set_field() restores it exactly.
std::string word_of(double value);
std::string word_of(int value);
std::string word_of(bool value);
std::string word_of(RadarMode value);

/// Returns the words of a type such as "a|b|c" for a sentence: "a, b or c". Other text is unchanged.
std::string words_of_choice(std::string_view type);

inline constexpr const char* kRadarHelp =
    "distance to contact: exact; between bounds about a pixel apart (sampled); or, between such\n"
    "bounds, from Cyber Radar's two rendered depth passes (passes)";

/// Calls visit(QualityField, field) for each field, in the order of files and help.
template <typename Quality, typename Visit>
requires std::is_same_v<std::remove_const_t<Quality>, ScanQuality>
void visit_fields(Quality& quality, Visit&& visit) {
  visit(QualityField{"resolution_m", "--resolution", "M", "edge of the smallest voxels, metres", 0.001, 1.0},
        quality.resolution_m);
  visit(QualityField{"deviation_m", "--deviation", "M",
                     "max distance of the simplified mesh from the full mesh, metres; 0 keeps all triangles",
                     0.0, 1.0},
        quality.deviation_m);
  visit(QualityField{"tracking_px", "--tracking-px", "N", "max width of the images that are aligned, pixels",
                     40, 640},
        quality.tracking_px);
  visit(QualityField{"fuse_every", "--fuse-every", "N", "fuse only every Nth tracked frame", 1, 1000},
        quality.fuse_every);
}
/// Not split: one call per field.
template <typename Quality, typename Visit>
requires std::is_same_v<std::remove_const_t<Quality>, RunQuality>
void visit_fields(Quality& quality, Visit&& visit) {
  visit(QualityField{"depth_stride", "--depth-stride", "1|2|4",
                     "factor by which depth images are reduced in width and height", 1, 4},
        quality.depth_stride);
  visit(QualityField{"tracking_px", "--tracking-px", "N", "max width of the images for localisation, pixels",
                     40, 640},
        quality.tracking_px);
  visit(
      QualityField{"verify_every_n_frames", "--verify-every", "N",
                   "compare the measured with the expected depth in every Nth frame, to notice a wrong pose",
                   1, 1000},
      quality.verify_every_n_frames);
  visit(
      QualityField{
          "mesh_tolerance_sigmas", "--mesh-tolerance-sigmas", "X",
          "max deviation of the dynamic mesh from the measured depth, in standard deviations of the\n"
          "sensor's noise",
          0.1, 100.0, "mesh_sigmas"},
      quality.mesh_tolerance_sigmas);
  visit(
      QualityField{
          "fine_mesh", "--fine-mesh", "on|off",
          "make every dynamic pixel near virtual objects a vertex, which helps if depth has less noise\n"
          "than a Kinect's"},
      quality.fine_mesh);
  visit(QualityField{"radar", "--radar", "exact|sampled|passes", kRadarHelp}, quality.radar);
  visit(
      QualityField{"radar_px", "--radar-px", "N",
                   "pixels along the longer side of the object's outline; the exact radar's results do not\n"
                   "depend on it",
                   1, 4096},
      quality.radar_px);
  visit(QualityField{"physics_step_s", "--physics-step", "S",
                     "max substep of the physics, seconds; exceeded by up to 5 %", 0.001, 0.5},
        quality.physics_step_s);
  visit(QualityField{"move_every_n_frames", "--move-every", "N",
                     "move each object every Nth frame, by all of the time since its last move", 1, 16,
                     "object_turns"},
        quality.move_every_n_frames);
  visit(QualityField{"object_error_px", "--object-error", "PX",
                     "max deviation of an object's drawn mesh from its file's, pixels", 0.01, 100.0},
        quality.object_error_px);
  visit(QualityField{"soft_edges", "--soft-edges", "on|off",
                     "occlude objects along edges of the colour image (on) or of the depth image (off)"},
        quality.soft_edges);
  visit(QualityField{"bridge_gaps", "--bridge-gaps", "on|off",
                     "let what moved hide objects also where its depth has gaps, up to edges of the colour\n"
                     "image"},
        quality.bridge_gaps);
  visit(QualityField{"shadows", "--shadows", "on|off", "draw shadows of objects on the surface below them"},
        quality.shadows);
  visit(QualityField{"shadow_every_n_frames", "--shadow-every", "N",
                     "compute the full-resolution shadow of one resting object every Nth frame", 1, 1000,
                     "shadow_turns"},
        quality.shadow_every_n_frames);
  visit(QualityField{"picture_every_n_frames", "--picture-every", "N",
                     "make a picture every Nth frame, and move objects in the others; 1: both in every frame",
                     1, 16, "picture_turns"},
        quality.picture_every_n_frames);
}

/// Throws Error such as "depth_stride = 3: must be 1, 2 or 4".
void require_valid(const ScanQuality& quality);
void require_valid(const RunQuality& quality);

/// Sets the field `name` from a word such as "2", "0.5", "on" or "sampled". Accepts former names of fields.
/// Throws Error for an unknown name or an invalid word, and then changes nothing.
void set_field(ScanQuality& quality, std::string_view name, std::string_view word);
void set_field(RunQuality& quality, std::string_view name, std::string_view word);

/// Pairs of a field's name and its value as a word.
using FieldWords = std::vector<std::pair<std::string, std::string>>;

/// Calls set_field() for each pair.
template <typename Quality>
void set_fields(Quality& quality, const FieldWords& words) {
  for (const auto& [name, word] : words) set_field(quality, name, word);
}

/// Returns the fields that differ from `defaults`, in the order of visit_fields(). Calling set_fields() with
/// them on a copy of `defaults` restores `quality` exactly.
FieldWords words_of(const ScanQuality& quality, const ScanQuality& defaults = {});
FieldWords words_of(const RunQuality& quality, const RunQuality& defaults = {});

}  // namespace roomradar
