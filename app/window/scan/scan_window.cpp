// scan_window.cpp: shows the window with picture, model, advice and keys, and runs the scan on another
// thread.
#include "app/window/scan/scan_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "app/cli/options/prescan_options.hpp"
#include "app/scan/scan_channel.hpp"
#include "app/session/picture_composer.hpp"
#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/panes/gl_texture.hpp"
#include "app/window/panes/orbit_canvas.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/scan/scan_layout.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

/// Draws the live model. The window's OpenGL context must be current for all calls.
class LiveModelView {
 public:
  /// Uploads new meshes.
  void upload(const ShownScan& shown);
  void draw(const Area& area, const ShownScan& shown, const look::Fonts& fonts);
  /// Disables following, and moves the eye so that the whole mesh is in view.
  void look_at(const Mesh& mesh);

  /// While following, the eye stays behind the camera. A mouse drag disables following.
  void set_following(bool follows) { follows_ = follows; }
  [[nodiscard]] bool follows() const { return follows_; }

 private:
  OrbitCanvas canvas_;
  std::map<std::shared_ptr<const Mesh>, std::unique_ptr<DrawnMesh>> drawn_;
  bool follows_ = true;
  double followed_s_ = -1e3;  ///< time at which the eye last followed

  void follow(const ShownScan& shown);
};

constexpr ImU32 kPath = IM_COL32(64, 196, 172, 150);

void draw_path(ImDrawList& list, const ShownScan& shown, const ToWindow& to_window) {
  std::optional<ImVec2> last;
  for (const Eigen::Vector3f& position : shown.path_world) {
    const std::optional<ImVec2> at = to_window(position.cast<double>());
    if (at && last) list.AddLine(*last, *at, kPath, look::px(1.5F));
    last = at;
  }
}

/// Draws a disc with its number at each hole, the largest hole on top.
void draw_holes(ImDrawList& list, std::span<const NumberedHole> holes, const ToWindow& to_window,
                const look::Fonts& fonts) {
  for (auto hole = holes.rbegin(); hole != holes.rend(); ++hole) {
    const std::optional<ImVec2> at = to_window(hole->hole.position_world);
    if (!at) continue;
    const std::string number = std::to_string(hole->number);
    const ImVec2 size = fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e4F, 0.0F, number.c_str());
    const float radius = 0.5F * std::max(size.x, size.y) + look::px(3.0F);
    list.AddCircleFilled(*at, radius, IM_COL32(16, 19, 24, 220));
    list.AddCircle(*at, radius, look::kWarn, 0, look::px(1.5F));
    list.AddText(fonts.small, fonts.small->FontSize, {at->x - 0.5F * size.x, at->y - 0.5F * size.y},
                 look::kWarn, number.c_str());
  }
}

void LiveModelView::upload(const ShownScan& shown) {
  std::set<std::shared_ptr<const Mesh>> present;
  for (const ShownPart& part : shown.parts) {
    present.insert(part.mesh);
    auto& drawn = drawn_[part.mesh];
    if (drawn) continue;
    drawn = std::make_unique<DrawnMesh>();
    drawn->upload(*part.mesh, /*changes_often=*/false);
  }
  std::erase_if(drawn_, [&](const auto& drawn) { return !present.contains(drawn.first); });
  canvas_.content_changed();
}

/// Moves the eye smoothly to a place behind and above the camera.
void LiveModelView::follow(const ShownScan& shown) {
  constexpr double kAhead_m = 1.2, kDistance_m = 3.2, kElevation_rad = 0.6, kSmoothed_s = 0.2;
  const Eigen::Vector3d ahead = shown.T_world_camera.linear().col(2);
  const Eigen::Vector3d target = shown.T_world_camera.translation() + kAhead_m * ahead;
  const double azimuth_rad = std::atan2(-ahead.y(), -ahead.x());
  Orbit& orbit = canvas_.orbit;
  const double now_s = ImGui::GetTime();
  const double share = 1.0 - std::exp((std::exchange(followed_s_, now_s) - now_s) / kSmoothed_s);
  orbit.target_world += share * (target - orbit.target_world);
  orbit.azimuth_rad += share * std::remainder(azimuth_rad - orbit.azimuth_rad, 2.0 * std::numbers::pi);
  orbit.elevation_rad += share * (kElevation_rad - orbit.elevation_rad);
  orbit.distance_m += share * (kDistance_m - orbit.distance_m);
}

void LiveModelView::look_at(const Mesh& mesh) {
  const Eigen::AlignedBox3d box = bounds_of(mesh);
  if (box.isEmpty()) return;
  follows_ = false;
  canvas_.orbit.target_world = box.center();
  canvas_.orbit.elevation_rad = 0.8;
  canvas_.orbit.distance_m = std::clamp(1.1 * box.diagonal().norm(), 1.0, 30.0);
  canvas_.orbit_changed();
}

void LiveModelView::draw(const Area& area, const ShownScan& shown, const look::Fonts& fonts) {
  look::begin_pane("live model", area, look::kGround);
  ImGui::SetCursorScreenPos({area.x, area.y});
  ImGui::InvisibleButton("orbit", {area.width, area.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  if (canvas_.steer(area)) follows_ = follows_ && !ImGui::IsItemActive();
  if (canvas_.must_render(static_cast<int>(area.width), static_cast<int>(area.height))) {
    if (follows_) follow(shown);
    canvas_.begin();
    for (const ShownPart& part : shown.parts)
      canvas_.draw(*drawn_.at(part.mesh), part.T_world_mesh, {{0.62F, 0.66F, 0.72F}, 0.1F},
                   /*is_transparent_behind=*/true);
    canvas_.end();
  }
  canvas_.show(area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ToWindow to_window = canvas_.to_window(area);
  draw_path(list, shown, to_window);
  if (shown.next_view) {
    draw_camera(list, {shown.camera, shown.next_view->T_world_camera}, 0.25, to_window);
    const std::optional<ImVec2> from = to_window(shown.T_world_camera.translation()),
                                to = to_window(shown.next_view->T_world_camera * Eigen::Vector3d(0, 0, 0.25));
    if (from && to) list.AddLine(*from, *to, look::kWarn, look::px(2.0F));
  }
  draw_holes(list, shown.holes, to_window, fonts);
  if (shown.frame_index >= 0) draw_camera(list, {shown.camera, shown.T_world_camera}, 0.35, to_window);
  if (shown.parts.empty())
    list.AddText(fonts.text, fonts.text->FontSize, {area.x + look::px(16.0F), area.y + look::px(16.0F)},
                 look::kDim, "the model appears here");
  look::end_pane();
}

/// Draws the scan window and handles its keys. All calls must come from the window's thread.
class ScanUi final : public WindowContent {
 public:
  ScanUi(ScanChannel& channel, const look::Fonts& fonts, LostSignal lost_signal);

  void take_news() override;
  void press(const Key& key) override;
  void draw(float width, float height) override;
  [[nodiscard]] bool wants_to_quit() const override { return quits_; }

 private:
  ScanChannel& channel_;
  const look::Fonts& fonts_;
  const LostSignal lost_signal_;
  ShownScan shown_;
  ScanStage stage_;
  ScanOutcome outcome_;
  GlTexture picture_{/*smooth=*/true}, tint_{/*smooth=*/true};
  LiveModelView model_;
  double newest_s_ = -1.0;  ///< time at which the last frame arrived; < 0: none so far
  bool asks_to_discard_ = false, quits_ = false;

  [[nodiscard]] bool is_tracking() const { return stage_.name.empty() && outcome_.text.empty(); }
  void show_result();
  void signal_loss(std::optional<ScanFault> before) const;
  void press_key(int key, int modifiers);
  void draw_bar(const Area& area);
  void draw_picture(const Area& area);
  void draw_advice(const Area& area);
  void draw_next_view(const Area& area);
  void draw_speed(const Area& area);
  void draw_counts(const Area& area);
  void draw_work(const Area& area);
  void draw_question(float width, float height);
};

constexpr double kSilent_s = 1.5;
constexpr double kUndo_s = 5.0;
constexpr double kWorthSaying_s = 3600.0;  // the time left is shown if it is less than this

std::string text_of(const char* form, auto... values) {
  char text[160];
  format_classic(text, sizeof text, form, values...);
  return text;
}

/// Draws a sentence over the area, in its upper part, on a dark ground.
void draw_sentence(const Area& area, const std::string& sentence, ImU32 colour, ImFont* font) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float wrap = 0.85F * area.width;
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e4F, wrap, sentence.c_str());
  const ImVec2 at{area.x + 0.5F * (area.width - size.x), area.y + look::px(22.0F)};
  const float beside = look::px(14.0F), above = look::px(8.0F);
  list.AddRectFilled({at.x - beside, at.y - above}, {at.x + size.x + beside, at.y + size.y + above},
                     IM_COL32(16, 19, 24, 225), look::px(8.0F));
  list.AddText(font, font->FontSize, at, colour, sentence.c_str(), nullptr, wrap);
}

const char* words_of(const std::string& stage) {
  if (stage == "fuse") return "Making the map: fusing the frames";
  if (stage == "ghosts") return "Making the map: looking for what has moved";
  if (stage == "fuse again") return "Making the map: fusing again where something moved";
  if (stage == "texture") return "Making the map: colours of its surface";
  if (stage == "surface") return "Making the map: surface, and what the scan missed";
  return "Making the map";
}

ScanUi::ScanUi(ScanChannel& channel, const look::Fonts& fonts, LostSignal lost_signal)
    : channel_(channel), fonts_(fonts), lost_signal_(lost_signal) {}

void ScanUi::take_news() {
  stage_ = channel_.stage();
  if (outcome_.text.empty()) {
    outcome_ = channel_.outcome();
    if (outcome_.surface) show_result();
  }
  const std::optional<ScanFault> fault_before = shown_.fault;
  if (outcome_.surface || !channel_.take(shown_)) return;
  signal_loss(fault_before);
  newest_s_ = ImGui::GetTime();
  picture_.upload(shown_.picture);
  if (!shown_.tint.empty()) tint_.upload(shown_.tint);
  model_.upload(shown_);
}

/// Rings the bell if the camera was lost since the last news.
void ScanUi::signal_loss(std::optional<ScanFault> fault_before) const {
  if (lost_signal_.rings && shown_.fault == ScanFault::kLost && fault_before != ScanFault::kLost)
    std::fputs("\a", stderr);
}

/// Shows the map's surface in place of the live model.
void ScanUi::show_result() {
  shown_.parts = {{outcome_.surface, Eigen::Isometry3d::Identity()}};
  shown_.path_world.clear();
  shown_.next_view.reset();
  shown_.holes = outcome_.holes;
  shown_.frame_index = -1;  // the camera's pose is in another world
  model_.upload(shown_);
  model_.look_at(*outcome_.surface);
}

void ScanUi::press(const Key& key) {
  if (!key.is_repeat) press_key(key.key, key.modifiers);
}

void ScanUi::press_key(int key, int modifiers) {
  const bool is_enter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  if (asks_to_discard_) {
    if (is_enter) channel_.request(ScanRequest::kDiscard);
    if (is_enter || key == GLFW_KEY_ESCAPE) asks_to_discard_ = false;
    return;
  }
  if (!outcome_.text.empty()) {
    if (key == GLFW_KEY_P && outcome_.surface) {
      channel_.request(ScanRequest::kPlay);
      quits_ = true;
    }
    quits_ = quits_ || is_enter || key == GLFW_KEY_ESCAPE || key == GLFW_KEY_Q;
    return;
  }
  if (key == GLFW_KEY_SPACE && is_tracking()) channel_.set_paused(!channel_.is_paused());
  if (is_enter && is_tracking() && shown_.frame_index >= 0) channel_.request(ScanRequest::kFinish);
  if (key == GLFW_KEY_BACKSPACE && is_tracking() && shown_.frame_index >= 0) {
    channel_.undo(kUndo_s);
    channel_.set_paused(false);
  }
  if (key == GLFW_KEY_DELETE) asks_to_discard_ = true;
  if (key == GLFW_KEY_F) model_.set_following(!model_.follows());
  if (key == GLFW_KEY_Q && (modifiers & GLFW_MOD_CONTROL) != 0) quits_ = true;
}

void ScanUi::draw(float width, float height) {
  const ScanLayout layout = scan_layout(width, height, look::px(1.0F));
  draw_bar(layout.bar);
  draw_picture(layout.camera);
  model_.draw(layout.model, shown_, fonts_);
  if (is_tracking())
    draw_counts(layout.counts);
  else
    draw_work(layout.counts);
  if (asks_to_discard_) draw_question(width, height);
}

void ScanUi::draw_bar(const Area& area) {
  look::begin_pane("bar", area, look::kPanel);
  const bool is_narrow = area.width < look::px(900.0F);
  if (!is_narrow) look::title("roomradar scan", look::px(22.0F), fonts_);
  const auto button = [&](const char* label, const char* key_name, int key, bool is_lit, bool enabled) {
    if (look::button(label, is_narrow ? "" : key_name, is_lit, {0, 0}, enabled)) press_key(key, 0);
    ImGui::SameLine(0.0F, look::px(8.0F));
  };
  const bool is_paused = channel_.is_paused(), tracks = is_tracking();
  if (outcome_.text.empty()) {
    button(is_paused ? "Go on" : "Pause", "Space", GLFW_KEY_SPACE, is_paused, tracks);
    button("Finish", "Enter", GLFW_KEY_ENTER, false, tracks && shown_.frame_index >= 0);
    button("Undo 5 s", "Backspace", GLFW_KEY_BACKSPACE, false, tracks && shown_.frame_index >= 0);
    button("Discard", "Del", GLFW_KEY_DELETE, false, true);
    button("Follow", "F", GLFW_KEY_F, model_.follows(), true);
  } else {
    if (outcome_.surface) button("Play in this map", "P", GLFW_KEY_P, true, true);
    button("Close", "Enter", GLFW_KEY_ENTER, false, true);
  }
  ImGui::SameLine(0.0F, look::px(16.0F));
  ImGui::AlignTextToFramePadding();
  if (!outcome_.text.empty())
    look::pill(look::kGood, "over");
  else if (!tracks)
    look::pill(look::kAccent, "making the map");
  else if (is_paused)
    look::pill(look::kWarn, "paused");
  else if (shown_.frame_index < 0)
    look::pill(look::kDim, "waiting for the first frame");
  else
    look::pill(shown_.status == TrackStatus::kTracked ? look::kGood : look::kBad,
               std::string(to_string(shown_.status)));
  look::end_pane();
}

void ScanUi::draw_picture(const Area& area) {
  look::begin_pane("camera", area, look::kGround);
  if (picture_.width() > 0) {
    const Area image = fitted(area, picture_.width(), picture_.height());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low{image.x, image.y}, high{image.x + image.width, image.y + image.height};
    list.AddImage(picture_.id(), low, high);
    if (!shown_.tint.empty()) list.AddImage(tint_.id(), low, high);
    if (is_tracking()) {
      draw_next_view(image);
      draw_advice(image);
      draw_speed(image);
    }
  }
  look::end_pane();
}

void ScanUi::draw_advice(const Area& area) {
  std::optional<ScanFault> fault = shown_.fault;
  const bool is_bright = std::fmod(ImGui::GetTime(), 0.8) < 0.4;
  if (fault == ScanFault::kLost && lost_signal_.flashes && is_bright && !channel_.is_paused())
    ImGui::GetWindowDrawList()->AddRect({area.x, area.y}, {area.x + area.width, area.y + area.height},
                                        look::kBad, 0.0F, 0, look::px(8.0F));
  if (newest_s_ >= 0.0 && ImGui::GetTime() - newest_s_ > kSilent_s) fault = ScanFault::kSilent;
  if (channel_.is_paused())
    draw_sentence(area, "Paused. Frames are skipped until you continue.", look::kText, fonts_.large);
  else if (fault)
    draw_sentence(area, std::string(to_sentence(*fault)),
                  *fault == ScanFault::kLost ? look::kBad : look::kWarn, fonts_.large);
}

/// Draws an arrow from the picture's middle towards the next view, and the way there in words.
void ScanUi::draw_next_view(const Area& area) {
  if (!shown_.next_view) return;
  const ShownNextView& next = *shown_.next_view;
  const Eigen::Isometry3d T_camera_next = shown_.T_world_camera.inverse() * next.T_world_camera;
  // Direction to the point that the next view looks at. Its offset from the camera's axis is the way to turn.
  const Eigen::Vector3d towards = T_camera_next * Eigen::Vector3d(0.0, 0.0, 2.0);
  Eigen::Vector2f aside = towards.head<2>().cast<float>();
  if (towards.z() <= 0.0) aside = {towards.x() < 0.0 ? -1.0F : 1.0F, 0.0F};  // behind: turn round
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = area.y + area.height - look::px(46.0F);
  const ImVec2 size = ImGui::CalcTextSize(next.way.c_str());
  const float x = area.x + 0.5F * (area.width - size.x), pad = look::px(8.0F);
  list.AddRectFilled({x - pad, y - pad}, {x + size.x + pad, y + size.y + pad}, IM_COL32(16, 19, 24, 200),
                     look::px(6.0F));
  list.AddText({x, y}, look::kText, next.way.c_str());
  if (aside.norm() < 0.15F && towards.z() > 0.0) return;  // straight ahead
  const Eigen::Vector2f along = aside.normalized(), across(-along.y(), along.x());
  const Eigen::Vector2f middle(area.x + 0.5F * area.width, area.y + 0.5F * area.height);
  const Eigen::Vector2f from = middle + look::px(40.0F) * along, tip = from + look::px(110.0F) * along;
  const auto at = [](const Eigen::Vector2f& p) { return ImVec2(p.x(), p.y()); };
  constexpr ImU32 kArrow = IM_COL32(64, 196, 172, 230);
  list.AddLine(at(from), at(tip - look::px(24.0F) * along), kArrow, look::px(12.0F));
  list.AddTriangleFilled(at(tip), at(tip - look::px(34.0F) * along + look::px(24.0F) * across),
                         at(tip - look::px(34.0F) * along - look::px(24.0F) * across), kArrow);
}

/// Draws the camera's speed as a bar along the picture's lower edge. The right end is the highest speed for
/// tracking.
void ScanUi::draw_speed(const Area& area) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float high = look::px(8.0F), margin = look::px(14.0F),
              width = std::min(look::px(260.0F), 0.5F * area.width);
  const ImVec2 at{area.x + margin, area.y + area.height - margin - high};
  const float share = std::clamp(static_cast<float>(shown_.relative_speed), 0.0F, 1.0F);
  const ImU32 colour = share < 0.6F ? look::kGood : share < 1.0F ? look::kWarn : look::kBad;
  list.AddText(fonts_.small, fonts_.small->FontSize, {at.x, at.y - look::px(17.0F)}, look::kText, "speed");
  list.AddRectFilled(at, {at.x + width, at.y + high}, IM_COL32(16, 19, 24, 200), look::px(4.0F));
  list.AddRectFilled(at, {at.x + share * width, at.y + high}, colour, look::px(4.0F));
}

void ScanUi::draw_counts(const Area& area) {
  look::begin_pane("counts", area, look::kPanel);
  const ScanCounts& counts = shown_.counts;
  const bool is_narrow = area.width < look::px(1000.0F);
  int shown = 0;
  const auto fact = [&](const std::string& value, const char* what) {
    if (shown > 0 && !(is_narrow && shown == 4)) ImGui::SameLine(0.0F, look::px(26.0F));
    ++shown;
    ImGui::BeginGroup();
    ImGui::PushFont(fonts_.large);
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopFont();
    if (is_narrow) ImGui::SameLine(0.0F, look::px(5.0F));
    ImGui::PushFont(fonts_.small);
    ImGui::TextDisabled("%s", what);
    ImGui::PopFont();
    ImGui::EndGroup();
  };
  const std::string times = text_of("frames/s: read %.0f, track %.0f ms", counts.read_ms, counts.track_ms);
  fact(text_of("%.0f", counts.frames_per_s), is_narrow ? "frames/s" : times.c_str());
  fact(text_of("%.1f m\u00B2", counts.seen_m2), "surface seen");
  fact(text_of("%.0f %%", 100.0 * counts.well_known), "of it known well");
  if (counts.table_tops_known) fact(text_of("%.0f %%", 100.0 * *counts.table_tops_known), "table tops");
  fact(text_of("%zu", shown_.holes.size()), shown_.holes.size() == 1 ? "hole left" : "holes left");
  fact(text_of("%lld", static_cast<long long>(counts.loops)), "loops closed");
  fact(text_of("%.0f MB", static_cast<double>(counts.memory_bytes) / 1e6), "memory");
  if (counts.left_s && *counts.left_s < kWorthSaying_s)
    fact(text_of("%.0f min", std::floor(*counts.left_s / 60.0)), "left at this rate");
  look::end_pane();
}

/// Draws the progress of the work after the last frame, or its result.
void ScanUi::draw_work(const Area& area) {
  look::begin_pane("counts", area, look::kPanel);
  if (!outcome_.text.empty()) {
    ImGui::PushTextWrapPos(area.width - look::px(14.0F));
    ImGui::TextUnformatted(outcome_.text.c_str());
    ImGui::PopTextWrapPos();
  } else {
    ImGui::TextUnformatted(words_of(stage_.name));
    const bool is_known = stage_.total && *stage_.total > 0;
    const float share =
        is_known ? static_cast<float>(stage_.done) / static_cast<float>(*stage_.total) : -1.0F;
    const std::string frames =
        is_known
            ? text_of("%lld of %lld frames", static_cast<long long>(stage_.done),
                      static_cast<long long>(*stage_.total))
            : std::string(stage_.done > 0 ? text_of("%lld frames", static_cast<long long>(stage_.done)) : "");
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, look::kAccent);
    ImGui::ProgressBar(std::clamp(share, 0.0F, 1.0F),
                       {std::min(look::px(520.0F), area.width - look::px(28.0F)), 0.0F}, frames.c_str());
    ImGui::PopStyleColor();
  }
  look::end_pane();
}

void ScanUi::draw_question(float width, float height) {
  const float wide = std::min(look::px(420.0F), 0.9F * width), high = look::px(110.0F);
  ImGui::SetNextWindowPos({0.5F * (width - wide), 0.5F * (height - high)});
  ImGui::SetNextWindowSize({wide, high});
  ImGui::SetNextWindowFocus();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, look::kRaised);
  ImGui::Begin("question", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::TextWrapped("Discard the scan? Its frames are deleted, and no map is saved.");
  if (look::button("Discard", "Enter", true)) press_key(GLFW_KEY_ENTER, 0);
  ImGui::SameLine();
  if (look::button("Go on", "Esc", false)) press_key(GLFW_KEY_ESCAPE, 0);
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace

ScanWindowResult run_in_scan_window(const std::string& title, std::optional<double> ui_scale,
                                    LostSignal lost_signal, const std::function<int(ScanChannel&)>& work) {
  ScanWindowResult result;
  const std::shared_ptr<GlfwWindow> window = open_window(title);
  ScanChannel channel([] { glfwPostEmptyEvent(); });
  std::exception_ptr fault;
  std::thread scan([&] {
    try {
      result.status = work(channel);
    } catch (const std::exception& error) {
      fault = std::current_exception();
      channel.finish({error.what()});
    }
    if (channel.requested() == ScanRequest::kDiscard)
      glfwSetWindowShouldClose(window->get(), GLFW_TRUE);  // allowed on any thread
    glfwPostEmptyEvent();
  });
  show_until_closed(*window, ui_scale, [&](const look::Fonts& fonts) {
    return std::make_unique<ScanUi>(channel, fonts, lost_signal);
  });
  channel.set_paused(false);
  if (channel.outcome().text.empty() && channel.requested() == ScanRequest::kGoOn) std::raise(SIGINT);
  result.wants_to_play = channel.requested() == ScanRequest::kPlay;
  if (!result.wants_to_play) glfwHideWindow(window->get());  // the work may take a while to end
  scan.join();
  // The program closed the window after a discarded scan; the user did not.
  if (channel.requested() == ScanRequest::kDiscard) glfwSetWindowShouldClose(window->get(), GLFW_FALSE);
  if (fault) std::rethrow_exception(fault);
  if (result.wants_to_play) result.window = window;
  return result;
}

}  // namespace roomradar
