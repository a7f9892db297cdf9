// locate_body.hpp: the body of a request to locate a frame.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test {

/// The parts of a body, which tests alter.
struct LocateBody {
  nlohmann::json header;
  std::string depth_png, colour_png;

  [[nodiscard]] std::string text() const { return header.dump() + "\n" + depth_png + colour_png; }
};

inline LocateBody locate_body_of(const Frame& frame) {
  const TemporaryFolder folder;
  write_depth_file(frame.depth_m, DepthEncoding::kMillimetres, folder.path() / "depth.png");
  write_colour_file(frame.colour, folder.path() / "colour.png");
  LocateBody body;
  body.depth_png = read_bytes(folder.path() / "depth.png", "depth");
  body.colour_png = read_bytes(folder.path() / "colour.png", "colour");
  CameraRig rig;
  rig.depth_camera = frame.depth_camera;
  rig.colour_camera = frame.colour_camera;
  rig.T_colour_depth = frame.T_colour_depth;
  body.header = {{"camera", json_of(rig)},
                 {"depth_bytes", body.depth_png.size()},
                 {"colour_bytes", body.colour_png.size()}};
  return body;
}

}  // namespace roomradar::test
