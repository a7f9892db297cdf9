// canvas.hpp: lines, triangles and words on a picture.
#pragma once
#include <Eigen/Core>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// `part` of the pixel's colour gives way to another; outside of the picture nothing happens.
void blend(ColourImage& picture, int x, int y, Rgb colour, double part = 1.0);

/// A smooth line, in pixels; clipped.
void draw_line(ColourImage& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Rgb colour,
               int width_px = 1);

/// Words whose lower left corner is at (x, y), `size` 1 is 22 pixels high.
void draw_text(ColourImage& picture, const std::string& text, int x, int y, double size, Rgb colour);

/// Sets the mask where the triangle covers a pixel's centre.
void fill_triangle(MaskImage& mask, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c);

/// Tints what the mask covers, and draws its outline.
void tint(ColourImage& picture, const MaskImage& mask, Rgb colour, double part);

/// Copies `part` to where its upper left corner is at (x, y); clipped.
void paste(const ColourImage& part, int x, int y, ColourImage& picture);

}  // namespace roomradar
