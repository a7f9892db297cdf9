// trial_pictures.hpp: pictures and a video of a trial, with the camera's view and a section along the
// object's path.
#pragma once
#include <memory>
#include <span>

#include "app/evaluation/fallthrough/trial.hpp"
#include "app/media/video_writer.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr Rgb kStartColour{40, 110, 220}, kTruthColour{20, 150, 70}, kEndColour{214, 40, 40};

/// Drawing of a planar section of the scene. The plane contains the true contact, the object's path and the
/// camera. The true room is grey, the occluder orange.
class SideView {
 public:
  SideView(const Scenario& scenario, const Room& room, int width_px, int height_px);

  /// Draws the sections of room and occluder at a frame's time.
  [[nodiscard]] ColourImage room_at(int frame) const;
  /// Draws the lines in which surfaces intersect the plane. Static surfaces are black, dynamic ones blue, the
  /// inferred back sides of dynamic objects violet, and the frontier of unknown space red.
  void add_surfaces(std::span<const SceneTree> surfaces, ColourImage& picture) const;
  /// Draws the section of the object after travelling travelled_m, with the alpha value `part`.
  void add_object(double travelled_m, Rgb colour, double part, ColourImage& picture) const;

 private:
  [[nodiscard]] Eigen::Vector3d world_at(double x, double y) const;
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& p_world) const;

  const Scenario& scenario_;
  ColourImage room_;  ///< drawing of the room without the occluder
  Eigen::Vector3d middle_world_, right_world_, up_world_;
  double m_per_px_ = 0.01;
  MaskImage object_;  ///< the object's section at its start position
};

/// Returns the camera's depth image, shaded and scaled to width_px.
ColourImage camera_view(const Scenario& scenario, const Frame& frame, int width_px);
/// Draws the outline of the object after travelling travelled_m into the camera's view, with the alpha value
/// `part`.
void add_outline(const Scenario& scenario, double travelled_m, Rgb colour, double part, ColourImage& picture);

/// Returns camera view and section side by side, with the object at its start (blue), at the true contact
/// (green) and at its end (red).
ColourImage picture_of_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, Radar& radar);

/// Writes a slow-motion video and closes it. The video shows the camera's view and, per policy, a section
/// with the surfaces and the object's path. Throws Error as VideoWriter does.
/// @param video  must contain no pictures yet and have the rate kReplayPicturesPerS
void write_replay(PreparedScenario& prepared, MappedRoom& room, Radar& radar, VideoWriter& video);
inline constexpr double kReplayPicturesPerS = 30.0;

}  // namespace roomradar
