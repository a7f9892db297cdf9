// trial_pictures.hpp: what the camera saw of a trial, and where the object went, cut open from the side.
#pragma once
#include <memory>
#include <span>

#include "app/evaluation/fallthrough/trial.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

inline constexpr Rgb kStartColour{40, 110, 220}, kTruthColour{20, 150, 70}, kEndColour{214, 40, 40};

/// A section through the true contact along the object's way and the line to the camera: the true room grey,
/// the occluder orange.
class SideView {
 public:
  SideView(const Scenario& scenario, const Room& room, int width_px, int height_px);

  /// The room and the occluder as they are in a frame.
  [[nodiscard]] ColourImage room_at(int frame) const;
  /// The surfaces' lines in the section: static black, moved blue, inferred back violet, unknown red.
  void add_surfaces(std::span<const SceneTree> surfaces, ColourImage& picture) const;
  /// The object's section when it has come so far.
  void add_object(double travelled_m, Rgb colour, double part, ColourImage& picture) const;

 private:
  [[nodiscard]] Eigen::Vector3d world_at(double x, double y) const;
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& p_world) const;

  const Scenario& scenario_;
  ColourImage room_;  ///< without the occluder
  Eigen::Vector3d middle_world_, right_world_, up_world_;
  double m_per_px_ = 0.01;
  MaskImage object_;  ///< its section at the start, and that far round it
};

/// The camera's depth, shaded, and over it the object's outline where it has come.
ColourImage camera_view(const Scenario& scenario, const Frame& frame, int width_px);
void add_outline(const Scenario& scenario, double travelled_m, Rgb colour, double part, ColourImage& picture);

/// Both side by side, with where the object started (blue), ought to have stopped (green) and ended (red).
ColourImage picture_of_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy,
                             CyberRadar& radar);

}  // namespace roomradar
