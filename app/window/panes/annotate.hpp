// annotate.hpp: draws lines and labels over a picture of the room.
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

/// Projects a world point to the window; returns nothing for points behind the eye.
using ToWindow = std::function<std::optional<ImVec2>(const Eigen::Vector3d& p_world)>;

/// Marks the corners around the chosen object and writes its state.
void mark_chosen(ImDrawList& draw, const Snapshot& shown, const Area& image, double scale,
                 const look::Fonts& fonts);

/// Draws the twelve edges of a box; `corner(i)` is the corner with bits 0, 1, 2 of i selecting x, y, z.
void draw_box(ImDrawList& draw, const std::function<Eigen::Vector3d(int)>& corner, const ToWindow& to_window,
              ImU32 colour, float thickness);

/// Draws the box that the radar searched: rear plane, far plane, direction, and first contact.
void draw_target_volume(ImDrawList& draw, const ShownRadar& radar, const ToWindow& to_window,
                        const look::Fonts& fonts);

/// Draws the camera's view frustum up to a depth.
void draw_camera(ImDrawList& draw, const ShownView& view, double depth_m, const ToWindow& to_window);

/// Returns the object's state as text, such as "at rest on seen static", "moves at 1.2 m/s" or "carried".
std::string what_it_does(const ShownObject& object);

}  // namespace roomradar
