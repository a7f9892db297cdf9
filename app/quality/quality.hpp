// quality.hpp: what a user can trade for time, in a scan and in a run: one struct each, one list of their
// fields.
#pragma once
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Of a prescan.
struct ScanQuality {
  double resolution_m = 0.01;
  double deviation_m = 0.002;
  int tracking_px = 320;
  int fuse_every = 1;
  friend bool operator==(const ScanQuality&, const ScanQuality&) = default;
};

/// Of a run, and of each of its frames.
struct RunQuality {
  int depth_stride = 1;
  int tracking_px = 160;
  double mesh_tolerance_sigmas = 0.8;
  bool fine_mesh = false;
  RadarMode radar = RadarMode::kExact;
  int radar_px = 64;
  double physics_step_s = 1.0 / 60.0;
  int move_every_n_frames = 1;
  double object_error_px = 0.7;
  bool soft_edges = true;
  bool shadows = true;
  int shadow_every_n_frames = 1;
  int picture_every_n_frames = 1;
  friend bool operator==(const RunQuality&, const RunQuality&) = default;
};

/// What there is to know of a field of them.
struct QualityField {
  const char* name;
  const char* option;  ///< of the command line
  const char* unit;    ///< as its help has it; what is counted is "N"
  const char* help;
  double low = 0.0, high = 0.0;  ///< of numbers
};

/// Calls visit(QualityField, field) for each field, in the order in which files and help have them.
template <typename Quality, typename Visit>
requires std::is_same_v<std::remove_const_t<Quality>, ScanQuality>
void visit_fields(Quality& quality, Visit&& visit) {
  visit(QualityField{"resolution_m", "--resolution", "M", "edge of the smallest cells, metres (0.01)", 0.001,
                     1.0},
        quality.resolution_m);
  visit(
      QualityField{
          "deviation_m", "--deviation", "M",
          "how far the mesh with large triangles may lie from that with all, metres (0.002); 0 keeps all",
          0.0, 1.0},
      quality.deviation_m);
  visit(QualityField{"tracking_px", "--tracking-px", "N",
                     "most columns of the images by which frames are aligned (320)", 40, 640},
        quality.tracking_px);
  visit(QualityField{"fuse_every", "--fuse-every", "N",
                     "of the tracked frames every Nth goes into the map (1)", 1, 1000},
        quality.fuse_every);
}
template <typename Quality, typename Visit>
requires std::is_same_v<std::remove_const_t<Quality>, RunQuality>
void visit_fields(Quality& quality, Visit&& visit) {
  visit(QualityField{"depth_stride", "--depth-stride", "1|2|4",
                     "the depth image is used at this part of its width and height (1)", 1, 4},
        quality.depth_stride);
  visit(QualityField{"tracking_px", "--tracking-px", "N",
                     "most columns of the images that locate the camera (160)", 40, 640},
        quality.tracking_px);
  visit(
      QualityField{
          "mesh_sigmas", "--mesh-sigmas", "X",
          "how far the mesh of what moved may lie from what was seen, in standard deviations of the\n"
          "sensor's noise (0.8)",
          0.1, 100.0},
      quality.mesh_tolerance_sigmas);
  visit(
      QualityField{
          "fine_mesh", "--fine-mesh", "on|off",
          "about virtual objects every pixel that moved is a vertex, which helps where depth has less noise\n"
          "than a Kinect's (off)"},
      quality.fine_mesh);
  visit(QualityField{"radar", "--radar", "exact|sampled",
                     "how contacts are found: to the last digit, or between bounds a pixel apart (exact)"},
        quality.radar);
  visit(
      QualityField{"radar_px", "--radar-px", "N",
                   "pixels along the longer side of the object's outline (64); the exact radar's answers do\n"
                   "not depend on it",
                   1, 4096},
      quality.radar_px);
  visit(QualityField{"physics_step_s", "--physics-step", "S",
                     "about the longest piece of time that an object is moved by at once, seconds (0.0167)",
                     0.001, 0.5},
        quality.physics_step_s);
  visit(QualityField{"object_turns", "--object-turns", "N",
                     "an object is moved every Nth frame, then by all of the time since (1)", 1, 16},
        quality.move_every_n_frames);
  visit(QualityField{"object_error_px", "--object-error", "PX",
                     "how far the mesh that is drawn of an object may lie from its file's, pixels (0.7)",
                     0.01, 100.0},
        quality.object_error_px);
  visit(
      QualityField{
          "soft_edges", "--soft-edges", "on|off",
          "what hides an object does so along the edges that the colours show (on), or that the depth\n"
          "shows"},
      quality.soft_edges);
  visit(QualityField{"shadows", "--shadows", "on|off", "objects darken what is below them (on)"},
        quality.shadows);
  visit(QualityField{"shadow_turns", "--shadow-turns", "N",
                     "every Nth frame the shadow of one object that has come to rest is made in full (1)", 1,
                     1000},
        quality.shadow_every_n_frames);
  visit(QualityField{"picture_turns", "--picture-turns", "N",
                     "a picture is made of every Nth frame, and objects move in the others (1: both in all)",
                     1, 16},
        quality.picture_every_n_frames);
}

/// Throws Error "depth_stride = 3: must be 1, 2 or 4" and the like.
void require_valid(const ScanQuality& quality);
void require_valid(const RunQuality& quality);

/// Sets the field of that name from a word: "2", "0.5", "on", "sampled". Throws Error naming field, word and
/// rule, or the name that is none, and changes nothing.
void set_field(ScanQuality& quality, std::string_view name, std::string_view word);
void set_field(RunQuality& quality, std::string_view name, std::string_view word);

/// Names of fields, and words for them.
using FieldWords = std::vector<std::pair<std::string, std::string>>;

/// set_field() with each of them.
template <typename Quality>
void set_fields(Quality& quality, const FieldWords& words) {
  for (const auto& [name, word] : words) set_field(quality, name, word);
}

/// Names and words of the fields that are not as usual, in the order of visit_fields(). From the usual
/// quality set_field() makes the very same quality of them, to the last bit of its numbers.
FieldWords words_of(const ScanQuality& quality, const ScanQuality& defaults = {});
FieldWords words_of(const RunQuality& quality, const RunQuality& defaults = {});

}  // namespace roomradar
