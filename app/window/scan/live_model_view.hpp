// live_model_view.hpp: 3D view of a running scan: the model so far, the camera and its path.
#pragma once
#include <map>
#include <memory>

#include "app/scan/scan_channel.hpp"
#include "app/window/panes/orbit_canvas.hpp"
#include "app/window/panes/theme.hpp"

namespace roomradar {

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

}  // namespace roomradar
