// panes.hpp: the panes of the window of `roomradar run`: picture, radar, side panel, models, times, state,
// help.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/window/link/snapshot.hpp"
#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/gl_texture.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

// Shows the camera's picture with the virtual objects, and handles the mouse in it.

/// Returns a position as in a script: "X Y Z" in metres.
std::string position_words(const Eigen::Vector3d& p_world);

class PicturePane {
 public:
  explicit PicturePane(UiChannel& link) : link_(link) {}

  /// Call for each new snapshot.
  void upload(const Snapshot& shown) { texture_.upload(shown.picture); }
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts, double drop_height_m);
  /// Releases a grabbed object. Call when the pane is not drawn.
  void leave();

  /// Returns the mouse position in the picture, pixels; unset if the mouse is elsewhere.
  [[nodiscard]] const std::optional<Eigen::Vector2d>& pixel() const { return pixel_; }

 private:
  UiChannel& link_;
  GlTexture texture_{/*smooth=*/true};
  std::optional<Eigen::Vector2d> pixel_;
  bool is_down_ = false, was_dragged_ = false;
  /// Mouse position in the window when the button was pressed.
  Eigen::Vector2d pressed_at_ = Eigen::Vector2d::Zero();
  double nearer_m_ = 0.0;
  struct Sample {
    double time_s = 0.0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  };
  std::array<Sample, 8> lately_{};  ///< recent mouse positions, oldest first

  void press_and_drag(const Eigen::Vector2d& pixel, double drop_height_m);
  void turn(const Snapshot& shown);
  [[nodiscard]] Eigen::Vector2d velocity_px_s() const;
};

// Shows the radar's R, M and L images of the chosen object (see RadarPictures).

class RadarPane {
 public:
  void upload(const ShownRadar& radar);
  void draw(const Area& area, const ShownRadar& radar, const look::Fonts& fonts);

 private:
  /// Returns a text with the distance to contact, and with R, M and L at pixel (x, y) if the images contain
  /// it.
  [[nodiscard]] std::string numbers_at(const ShownRadar& radar, int x, int y) const;

  GlTexture range_{false}, mask_{false}, lookat_{false};
  ColourImage coloured_;
  int least_x_ = -1, least_y_ = -1;  ///< pixel with the smallest L; -1: none
  float least_m_ = 0.0F;
};

// Panel with controls for objects, policies and radar.

/// The user's settings for future commands. Not part of the session.
struct PlaySettings {
  float drop_height_m = 0.3F;
  float throw_speed_mps = 3.0F;
  float new_size_m = 0.0F;           ///< size of an added object; 0: that of its ObjectSource
  std::vector<ObjectSource> meshes;  ///< objects that can be added: `teapot` and files
  std::size_t mesh = 0;
  int radar_px = 64;  ///< value of the radar's resolution slider while it is dragged
  /// Values of the chosen object's material sliders while one is dragged: kg, coefficients.
  float mass_kg = 1.0F, friction = 0.5F, restitution = 0.0F;
};

void draw_side_panel(const Area& area, const Snapshot& shown, UiChannel& link, PlaySettings& settings,
                     const look::Fonts& fonts);

/// Returns the command that adds an object with the mesh and size in `settings`.
UserCommand new_object_command(const PlaySettings& settings);
/// Return commands that change a policy. Used by keys and panels.
UserCommand surfaces_command(SurfacePolicy surfaces);
UserCommand unknown_command(bool is_solid);
UserCommand radar_command(const RadarConfig& radar);
UserCommand camera_command(CameraPlay camera);
/// Returns the command that changes an object's material.
UserCommand material_command(const std::string& object, const BodyMaterial& change);

// 3D view of room, dynamic foreground, objects, camera, and the radar's target volume.

/// Renders the view into a texture. Renders only after its content has changed. Without a GPU, a room of half
/// a million triangles takes tens of milliseconds. The window's OpenGL context must be current for all calls.
class ModelView {
 public:
  ModelView();
  ~ModelView();
  ModelView(const ModelView&) = delete;
  ModelView& operator=(const ModelView&) = delete;

  void upload(const Snapshot& shown);
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts);
  /// Makes the chosen object the target of the view.
  void look_at_chosen(const Snapshot& shown);

 private:
  struct State;
  std::unique_ptr<State> state_;

  void render(int width_px, int height_px, const Snapshot& shown);
};

// Chart of the time of each stage over the last frames, with the budget.

inline constexpr double kGoal_ms = 16.6;  ///< period of frames at 60 Hz

class TimingPane {
 public:
  /// @param budget_ms  the run's time limit per frame; unset: 33.3, the period of a Kinect's frames
  explicit TimingPane(std::optional<double> budget_ms) : budget_ms_(budget_ms.value_or(33.3)) {}

  void add(const Snapshot& shown);
  void draw(const Area& area, const look::Fonts& fonts) const;

  [[nodiscard]] double budget_ms() const { return budget_ms_; }
  /// Time limit that the chart marks, ms.
  [[nodiscard]] double goal_ms() const { return std::min(kGoal_ms, budget_ms_); }
  /// Returns the processing time of the last frame, excluding the time to read it from the source.
  [[nodiscard]] float frame_ms() const { return frames_.empty() ? 0.0F : frames_.back().whole_ms; }

  /// Stages from bottom to top of the chart. "rest" is the time outside all other stages.
  static constexpr std::array<const char*, 10> kStages = {
      "locate", "expected", "foreground", "changes", "mesh", "physics", "radar", "light", "compose", "rest"};

 private:
  struct Times {
    std::array<float, kStages.size()> stages_ms{};
    float whole_ms = 0.0F;
    float read_ms = 0.0F;
  };
  /// Draws each stage's colour and median time.
  void draw_legend(const Area& area, float median_ms, const look::Fonts& fonts) const;

  static constexpr std::size_t kKept = 240;
  double budget_ms_;
  std::vector<Times> frames_;  ///< oldest first
};

// Draws the state of the run and its frame time at the right end of the top bar.

/// Draws a word for the state, such as loading, paused or tracked, at the right end of the bar. With two
/// rows, draws it at the left end of the second row.
/// @param silent_s  time since the newest frame
void draw_run_state(const Area& area, bool has_two_rows, const Snapshot& shown, const UiChannel& link,
                    double silent_s);

/// Draws the time of the last frame as a number and as a bar with marks at TimingPane::goal_ms() and
/// budget_ms().
/// @param speed  playback speed; 1: as recorded
void draw_frame_time(const Area& area, bool has_two_rows, const TimingPane& timing, double frames_per_s,
                     double speed, const look::Fonts& fonts);

// List of the mouse actions and keys, drawn over all other panes.

/// Draws the list over a window of this size. Returns true if the user has closed the list with a click.
bool draw_help(float width, float height, const look::Fonts& fonts);

}  // namespace roomradar
