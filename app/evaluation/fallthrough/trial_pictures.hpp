// trial_pictures.hpp: pictures of a trial: the camera's view, and a section along the object's path.
#pragma once
#include <memory>
#include <span>

#include "app/evaluation/fallthrough/trial.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr Rgb kStartColour{40, 110, 220}, kTruthColour{20, 150, 70}, kEndColour{214, 40, 40};

/// Section through the true contact, spanned by the object's path and the line to the camera. The true room
/// is grey, the occluder orange.
class SideView {
 public:
  SideView(const Scenario& scenario, const Room& room, int width_px, int height_px);

  /// Draws room and occluder in a frame.
  [[nodiscard]] ColourImage room_at(int frame) const;
  /// Adds the surfaces' intersection lines: static black, dynamic blue, inferred back violet, unknown red.
  void add_surfaces(std::span<const SceneTree> surfaces, ColourImage& picture) const;
  /// Adds the object's section after it has travelled travelled_m, with opacity `part`.
  void add_object(double travelled_m, Rgb colour, double part, ColourImage& picture) const;

 private:
  [[nodiscard]] Eigen::Vector3d world_at(double x, double y) const;
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& p_world) const;

  const Scenario& scenario_;
  ColourImage room_;  ///< without the occluder
  Eigen::Vector3d middle_world_, right_world_, up_world_;
  double m_per_px_ = 0.01;
  MaskImage object_;  ///< the object's section at its start position
};

/// Returns the camera's depth image, shaded. add_outline() draws the object's outline after it has travelled
/// travelled_m.
ColourImage camera_view(const Scenario& scenario, const Frame& frame, int width_px);
void add_outline(const Scenario& scenario, double travelled_m, Rgb colour, double part, ColourImage& picture);

/// Returns both views side by side, with the object's start (blue), true contact (green) and end (red).
ColourImage picture_of_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy,
                             CyberRadar& radar);

}  // namespace roomradar
