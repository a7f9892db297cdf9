// theme.cpp: sets the style and draws the widgets.
#include "app/window/panes/theme.hpp"

#include <filesystem>

namespace roomradar::look {
namespace {

float scale_of_screen = 1.0F;

ImVec4 part(ImU32 colour) { return ImGui::ColorConvertU32ToFloat4(colour); }

}  // namespace

float px(float length) { return scale_of_screen * length; }

Fonts apply(float scale) {
  scale_of_screen = scale;
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();  // ScaleAllSizes() scales the present sizes
  ImGui::StyleColorsDark();
  style.WindowRounding = 0.0F;
  style.WindowBorderSize = 0.0F;
  style.WindowPadding = {14.0F, 10.0F};
  style.FrameRounding = 5.0F;
  style.GrabRounding = 5.0F;
  style.FramePadding = {10.0F, 5.0F};
  style.ItemSpacing = {8.0F, 7.0F};
  style.ItemInnerSpacing = {6.0F, 4.0F};
  style.PopupRounding = 6.0F;
  style.ScrollbarSize = 10.0F;
  style.GrabMinSize = 12.0F;
  ImVec4* colours = style.Colors;
  colours[ImGuiCol_Text] = part(kText);
  colours[ImGuiCol_TextDisabled] = part(kDim);
  colours[ImGuiCol_WindowBg] = part(kPanel);
  colours[ImGuiCol_PopupBg] = part(kRaised);
  colours[ImGuiCol_Border] = part(kLine);
  colours[ImGuiCol_Separator] = part(kLine);
  colours[ImGuiCol_FrameBg] = colours[ImGuiCol_Button] = part(kRaised);
  colours[ImGuiCol_FrameBgHovered] = colours[ImGuiCol_ButtonHovered] = part(IM_COL32(52, 60, 73, 255));
  colours[ImGuiCol_FrameBgActive] = colours[ImGuiCol_ButtonActive] = part(IM_COL32(62, 72, 88, 255));
  colours[ImGuiCol_Header] = part(IM_COL32(64, 196, 172, 60));
  colours[ImGuiCol_HeaderHovered] = part(IM_COL32(64, 196, 172, 40));
  colours[ImGuiCol_HeaderActive] = part(IM_COL32(64, 196, 172, 80));
  // dark enough for the slider's text, which is drawn over it
  colours[ImGuiCol_SliderGrab] = part(IM_COL32(38, 112, 99, 255));
  colours[ImGuiCol_SliderGrabActive] = part(IM_COL32(46, 134, 118, 255));
  colours[ImGuiCol_CheckMark] = part(kAccent);
  style.ScaleAllSizes(scale);

  ImGuiIO& io = ImGui::GetIO();
  Fonts fonts;
  const char* const plain = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  const char* const bold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
  std::error_code ignored;
  if (std::filesystem::exists(plain, ignored) && std::filesystem::exists(bold, ignored)) {
    static const ImWchar kLetters[] = {0x20, 0xFF, 0x2010, 0x2026, 0x00B5, 0x00B5, 0x2190, 0x2193, 0};
    fonts.text = io.Fonts->AddFontFromFileTTF(plain, px(14.0F), nullptr, kLetters);
    fonts.small = io.Fonts->AddFontFromFileTTF(plain, px(11.5F), nullptr, kLetters);
    fonts.large = io.Fonts->AddFontFromFileTTF(bold, px(16.0F), nullptr, kLetters);
  } else {
    ImFontConfig config;  // as in AddFontDefault(), except the size
    config.SizePixels = px(13.0F);
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    fonts.text = fonts.small = fonts.large = io.Fonts->AddFontDefault(&config);
  }
  return fonts;
}

bool begin_pane(const char* name, const Area& area, ImU32 ground, bool scrolls) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ground);
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                           ImGuiWindowFlags_NoNav;
  if (scrolls) flags &= ~ImGuiWindowFlags_NoScrollbar;
  if (ground == kGround) flags |= ImGuiWindowFlags_NoBackground;
  return ImGui::Begin(name, nullptr, flags);
}

void end_pane() {
  ImGui::End();
  ImGui::PopStyleColor();
}

void begin_cover(const char* name, float width, float height) {
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowFocus();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(8, 10, 13, 150));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::PopStyleColor();
}

void title(const char* text, float gap, const Fonts& fonts) {
  ImGui::PushFont(fonts.large);
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, kAccent);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::SameLine(0.0F, gap);
}

void heading(const char* text, const Fonts& fonts) {
  ImGui::Dummy({0.0F, px(3.0F)});
  ImGui::PushFont(fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void note(ImDrawList& draw, ImVec2 at, const std::string& text, ImU32 colour, const Fonts& fonts) {
  const ImVec2 size = fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e4F, 0.0F, text.c_str());
  const float beside = px(4.0F), above = px(1.0F);
  draw.AddRectFilled({at.x - beside, at.y - above}, {at.x + size.x + beside, at.y + size.y + above},
                     IM_COL32(16, 19, 24, 190), px(4.0F));
  draw.AddText(fonts.small, fonts.small->FontSize, at, colour, text.c_str());
}

bool button(const char* label, const char* key, bool is_lit, ImVec2 size, bool enabled) {
  const std::string text = *key == '\0' ? std::string(label) : std::string(label) + "  " + key;
  const std::string id = "##" + std::string(label);
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 wanted = ImGui::CalcTextSize(text.c_str());
  if (size.x == 0.0F) size.x = wanted.x + 2.0F * style.FramePadding.x;
  if (size.y == 0.0F) size.y = wanted.y + 2.0F * style.FramePadding.y;
  ImGui::BeginDisabled(!enabled);
  if (is_lit) {
    ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(64, 196, 172, 70));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, IM_COL32(64, 196, 172, 95));
  }
  const bool clicked = ImGui::Button(id.c_str(), size);
  if (is_lit) ImGui::PopStyleColor(2);
  ImGui::EndDisabled();
  const ImVec2 from = ImGui::GetItemRectMin();
  ImVec2 at{from.x + 0.5F * (size.x - wanted.x), from.y + 0.5F * (size.y - wanted.y)};
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddText(at, !enabled ? kLine : is_lit ? kAccent : kText, label);
  if (*key != '\0') {
    at.x += ImGui::CalcTextSize((std::string(label) + "  ").c_str()).x;
    draw->AddText(at, enabled ? kDim : kLine, key);
  }
  return clicked && enabled;
}

int segments(const char* id, const char* const* words, int count, int lit) {
  ImGui::PushID(id);
  const float width = (ImGui::GetContentRegionAvail().x - px(2.0F) * static_cast<float>(count - 1)) /
                      static_cast<float>(count);
  int clicked = -1;
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine(0.0F, px(2.0F));
    if (button(words[i], "", i == lit, {width, 0.0F})) clicked = i;
  }
  ImGui::PopID();
  return clicked;
}

std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  while (!cut.empty()) {
    const auto is_continued = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    while (is_continued(cut.back()) && cut.size() > 1) cut.pop_back();
    cut.pop_back();
    if (ImGui::CalcTextSize((cut + "\u2026").c_str()).x <= width) break;
  }
  return cut + "\u2026";
}

void pill(ImU32 colour, const std::string& text) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddCircleFilled(
      {at.x + px(5.0F), at.y + 0.5F * height + ImGui::GetStyle().FramePadding.y}, px(4.0F), colour);
  ImGui::Dummy({px(14.0F), height});
  ImGui::SameLine(0.0F, 0.0F);
  ImGui::TextUnformatted(text.c_str());
}

}  // namespace roomradar::look
