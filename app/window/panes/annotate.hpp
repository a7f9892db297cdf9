// annotate.hpp: draws lines and labels over the camera's picture or the 3D view.
#pragma once
#include <imgui.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Projects a world point to window coordinates. Returns nullopt for points behind the eye.
using ToWindow = std::function<std::optional<ImVec2>(const Eigen::Vector3d& p_world)>;

/// Draws corner marks around the chosen object, and its state as text.
void mark_chosen(ImDrawList& draw, const Snapshot& shown, const Area& image, double scale,
                 const look::Fonts& fonts);

/// Draws the target volume that the radar searched, with rear plane, far plane and direction, and the first
/// contact.
void draw_target_volume(ImDrawList& draw, const ShownRadar& radar, const ToWindow& to_window,
                        const look::Fonts& fonts);

/// Draws the camera's view frustum up to depth_m.
void draw_camera(ImDrawList& draw, const ShownView& view, double depth_m, const ToWindow& to_window);

/// Returns the object's state in words, such as "at rest on another object", "moves at 1.2 m/s" or "carried".
std::string what_it_does(const ShownObject& object);

}  // namespace roomradar
