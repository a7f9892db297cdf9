// annotate.hpp: lines and letters over a picture of the room.
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

/// From a point of the world to the window; nothing for what is behind the eye.
using ToWindow = std::function<std::optional<ImVec2>(const Eigen::Vector3d& p_world)>;

/// Corners about the chosen object, and what it does.
void mark_chosen(ImDrawList& draw, const Snapshot& shown, const Area& image, double scale,
                 const look::Fonts& fonts);

/// The twelve edges of a box, of which `corner(i)` is the corner at x by bit 0, y by bit 1, z by bit 2 of i.
void draw_box(ImDrawList& draw, const std::function<Eigen::Vector3d(int)>& corner, const ToWindow& to_window,
              ImU32 colour, float thickness);

/// The radar's target volume: rear plane, far plane, direction, and where it touches first.
void draw_target_volume(ImDrawList& draw, const ShownRadar& radar, const ToWindow& to_window,
                        const look::Fonts& fonts);

/// The camera's pyramid of view down to a depth.
void draw_camera(ImDrawList& draw, const Session::ShownView& view, double depth_m, const ToWindow& to_window);

/// "at rest on seen static", "moves at 1.2 m/s", "carried".
std::string what_it_does(const ShownObject& object);

}  // namespace roomradar
