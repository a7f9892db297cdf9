// canvas.hpp: draws lines, triangles and text on a picture.
#pragma once
#include <Eigen/Core>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Blends a colour into a pixel with opacity `part`; does nothing outside the picture.
void blend(ColourImage& picture, int x, int y, Rgb colour, double part = 1.0);

/// Draws an antialiased line between pixel coordinates; clipped.
void draw_line(ColourImage& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Rgb colour,
               int width_px = 1);

/// Draws text with its lower left corner at (x, y); `size` 1 is 22 pixels high.
void draw_text(ColourImage& picture, const std::string& text, int x, int y, double size, Rgb colour);

/// Sets the mask where the triangle covers a pixel's centre.
void fill_triangle(MaskImage& mask, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c);

/// Tints the masked pixels with opacity `part`, and draws the mask's outline.
void tint(ColourImage& picture, const MaskImage& mask, Rgb colour, double part);

/// Copies `part` into the picture with its upper left corner at (x, y); clipped.
void paste(const ColourImage& part, int x, int y, ColourImage& picture);

}  // namespace roomradar
