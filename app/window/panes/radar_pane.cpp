// radar_pane.cpp: colours the pictures, and shows the values under the mouse.
#include "app/window/panes/panes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "mapping/types/image.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

/// Returns the colour of the Viridis colour map for t in 0..1, from dark violet to yellow. Computed by
/// polynomials of degree six, fitted by Matt Zucker.
Rgb viridis(float t) {
  constexpr std::array<std::array<double, 7>, 3> kFit = {
      {{0.27772733, 0.10509304, -0.33086183, -4.63423050, 6.22826994, 4.77638500, -5.43545586},
       {0.00540734, 1.40461353, 0.21484756, -5.79910097, 14.17993337, -13.74514538, 4.64585261},
       {0.33409981, 1.38459016, 0.09509516, -19.33244096, 56.69055260, -65.35303263, 26.31243525}}};
  const double x = std::clamp(static_cast<double>(t), 0.0, 1.0);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double value = 0.0;
    for (std::size_t power = 7; power-- > 0;) value = value * x + kFit[channel][power];
    rgb[channel] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
  }
  return {rgb[0], rgb[1], rgb[2]};
}

constexpr Rgb kNothing{30, 35, 43};

/// Colours an image: near is bright, pixels without a value are dark.
template <typename IsThere>
void colour(const Image<float>& image, float low_m, float high_m, const IsThere& is_there,
            ColourImage& coloured) {
  coloured.resize(image.width, image.height);
  const float span_m = std::max(high_m - low_m, 1e-6F);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    coloured.pixels[i] =
        is_there(image.pixels[i]) ? viridis(1.0F - (image.pixels[i] - low_m) / span_m) : kNothing;
}

std::string in_mm(float value_m, bool is_there) {
  std::array<char, 24> text{};
  format_classic(text.data(), text.size(), "%.1f mm", 1e3 * static_cast<double>(value_m));
  return is_there ? text.data() : "-";
}

}  // namespace

void RadarPane::upload(const ShownRadar& radar) {
  const RadarPictures& pictures = radar.pictures;
  least_x_ = least_y_ = -1;
  if (pictures.lookat_m.empty()) return;
  const float depth_m = static_cast<float>(pictures.volume.depth_m);
  const auto is_hit = [&](float value_m) { return value_m < depth_m; };
  colour(pictures.range_m, 0.0F, depth_m, is_hit, coloured_);
  range_.upload(coloured_);
  colour(pictures.mask_m, 0.0F, depth_m, is_hit, coloured_);
  mask_.upload(coloured_);
  float high_m = 0.0F;
  least_m_ = depth_m;
  for (int y = 0; y < pictures.lookat_m.height; ++y) {
    for (int x = 0; x < pictures.lookat_m.width; ++x) {
      const float l_m = pictures.lookat_m.at(x, y);
      if (std::isnan(l_m)) continue;
      high_m = std::max(high_m, l_m);
      if (l_m >= least_m_) continue;
      least_m_ = l_m;
      least_x_ = x;
      least_y_ = y;
    }
  }
  colour(
      pictures.lookat_m, least_x_ >= 0 ? least_m_ : 0.0F, high_m, [](float l_m) { return !std::isnan(l_m); },
      coloured_);
  lookat_.upload(coloured_);
}

void RadarPane::draw(const Area& area, const ShownRadar& radar, const look::Fonts& fonts) {
  look::begin_pane("radar", area);
  const RadarPictures& pictures = radar.pictures;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  ImGui::PushFont(fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, look::kDim);
  ImGui::TextUnformatted("CYBER RADAR");
  ImGui::PopStyleColor();
  if (pictures.lookat_m.empty()) {
    ImGui::PopFont();
    ImGui::TextDisabled("no object is chosen and in the room");
    look::end_pane();
    return;
  }
  const Eigen::Vector3d& u = radar.direction_world;
  ImGui::SameLine();
  std::array<char, 120> line{};
  format_classic(line.data(), line.size(), "  along %.2f %.2f %.2f   d = %.2f m   %d x %d px", u.x(), u.y(),
                 u.z(), pictures.volume.depth_m, pictures.volume.width_px, pictures.volume.height_px);
  ImGui::TextUnformatted(line.data());

  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = look::px(12.0F), above = look::px(18.0F), below = look::px(20.0F);  // two rows of text
  const Area cell{0.0F, 0.0F, (room.x - 2.0F * gap) / 3.0F, room.y - above - below};
  int x = -1, y = -1;
  const struct {
    const char* name;
    const GlTexture* texture;
  } scopes[] = {{"R  scene, from the rear", &range_},
                {"M  object, from the far end", &mask_},
                {"L = R + M - d", &lookat_}};
  for (int i = 0; i < 3; ++i) {
    const auto& scope = scopes[i];
    const float left = from.x + static_cast<float>(i) * (cell.width + gap);
    draw->AddText(fonts.small, fonts.small->FontSize, {left, from.y}, look::kText, scope.name);
    const Area image = fitted({left, from.y + above, cell.width, cell.height}, scope.texture->width(),
                              scope.texture->height());
    if (image.empty()) continue;
    draw->AddImage(scope.texture->id(), {image.x, image.y}, {image.x + image.width, image.y + image.height});
    const float pixel = image.width / static_cast<float>(scope.texture->width());
    if (i == 2 && least_x_ >= 0)
      draw->AddCircle({image.x + (static_cast<float>(least_x_) + 0.5F) * pixel,
                       image.y + (static_cast<float>(least_y_) + 0.5F) * pixel},
                      look::px(6.0F), look::kBad, 0, look::px(2.0F));
    const ImVec2 mouse = ImGui::GetMousePos();
    if (mouse.x >= image.x && mouse.y >= image.y && mouse.x < image.x + image.width &&
        mouse.y < image.y + image.height) {
      x = static_cast<int>((mouse.x - image.x) / pixel);
      y = static_cast<int>((mouse.y - image.y) / pixel);
    }
  }
  const std::string numbers = numbers_at(radar, x, y);
  draw->AddText(fonts.small, fonts.small->FontSize, {from.x, from.y + room.y - below + look::px(4.0F)},
                look::kText, numbers.c_str());
  ImGui::PopFont();
  look::end_pane();
}

std::string RadarPane::numbers_at(const ShownRadar& radar, int x, int y) const {
  const RadarPictures& pictures = radar.pictures;
  const float depth_m = static_cast<float>(pictures.volume.depth_m);
  std::string numbers;
  if (pictures.lookat_m.contains(x, y)) {
    const float r_m = pictures.range_m.at(x, y), m_m = pictures.mask_m.at(x, y),
                l_m = pictures.lookat_m.at(x, y);
    numbers = "pixel " + std::to_string(x) + ", " + std::to_string(y) + ":   R " + in_mm(r_m, r_m < depth_m) +
              "   M " + in_mm(m_m, m_m < depth_m) + "   L " + in_mm(l_m, !std::isnan(l_m)) + "   ";
  }
  numbers += "min L " + in_mm(least_m_, least_x_ >= 0);
  if (radar.contact)
    numbers += "   exact " + in_mm(static_cast<float>(radar.contact.contact_distance_m), true) + " to " +
               std::string(to_string(radar.contact.touched));
  return numbers;
}

}  // namespace roomradar
