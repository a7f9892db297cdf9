// model_view.hpp: 3D view of room, dynamic foreground, objects, camera, and the radar's target volume.
#pragma once
#include <memory>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

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

}  // namespace roomradar
