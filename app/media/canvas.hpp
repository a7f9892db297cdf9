// canvas.hpp: draws lines, triangles and text on a picture.
#pragma once
#include <Eigen/Core>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Blends a colour into pixel (x, y) with alpha `part` (0..1). Does nothing outside the picture.
void blend(ColourImage& picture, int x, int y, Rgb colour, double part = 1.0);

/// Draws an antialiased line from pixel a to pixel b, clipped to the picture.
void draw_line(ColourImage& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Rgb colour,
               int width_px = 1);

/// Draws text with its lower left corner at (x, y). `size` 1 gives letters 22 pixels high.
void draw_text(ColourImage& picture, const std::string& text, int x, int y, double size, Rgb colour);

/// Sets the mask in the pixels whose centres the triangle covers.
void fill_triangle(MaskImage& mask, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                   const Eigen::Vector2d& c);

/// Blends a colour into the masked pixels with alpha `part` (0..1), and draws the outline of the mask.
void tint(ColourImage& picture, const MaskImage& mask, Rgb colour, double part);

/// Copies the picture `part` into `picture` with its upper left corner at (x, y), clipped to `picture`.
void paste(const ColourImage& part, int x, int y, ColourImage& picture);

}  // namespace roomradar
