// locate_request.cpp: checks lengths, header and cameras, then decodes the images.
#include "app/serve/locate_request.hpp"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/image_header.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using nlohmann::json;

constexpr const char* kHeader = "the request's first line";

json parsed_header(std::string_view line) {
  json header;
  try {
    header = json::parse(line);
  } catch (const json::exception&) {
    throw Error(std::string(kHeader) + " is not JSON");
  }
  if (!header.is_object()) throw Error(std::string(kHeader) + " is not a JSON object");
  return header;
}

std::size_t length_of(const json& header, const char* name) {
  const auto field = header.find(name);
  if (field == header.end()) throw Error(std::string(kHeader) + " has no " + name);
  if (!field->is_number_unsigned() || field->get<std::uint64_t>() > kMaxLocateBody_bytes)
    throw Error(std::string(name) + " must be a whole number from 0 to " +
                std::to_string(kMaxLocateBody_bytes));
  return field->get<std::size_t>();
}

double depth_units_per_m(const json& header) {
  if (!header.contains("depth_units_per_m")) return 1000.0;
  const double units = json_number(header, "depth_units_per_m", kHeader);
  if (!(units >= 1.0 && units <= 1e6)) throw Error("depth_units_per_m must be within 1..1000000");
  return units;
}

void require_size(std::string_view bytes, const Intrinsics& camera, const char* name) {
  const ImageHeader header = read_image_header(bytes, name);
  if (static_cast<long>(header.width_px) * header.height_px > kMaxLocatePixels)
    throw Error(std::string(name) + " has " + to_string(header) + ", more than " +
                std::to_string(kMaxLocatePixels) + " pixels");
  if (header.width_px != camera.width_px || header.height_px != camera.height_px)
    throw Error(std::string(name) + " is a " + to_string(header) + ", but its camera has " +
                std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px));
}

}  // namespace

Frame parse_locate_request(std::string_view body) {
  const std::size_t end = body.substr(0, kMaxLocateHeader_bytes).find('\n');
  if (end == std::string_view::npos)
    throw Error("the request has no line end in its first " + std::to_string(kMaxLocateHeader_bytes) +
                " bytes; send one line of JSON, then the depth image and the colour image");
  const json header = parsed_header(body.substr(0, end));
  const std::string_view images = body.substr(end + 1);
  const std::size_t depth_bytes = length_of(header, "depth_bytes"),
                    colour_bytes = length_of(header, "colour_bytes");
  if (depth_bytes + colour_bytes != images.size())
    throw Error("the images have " + std::to_string(images.size()) +
                " bytes, but depth_bytes and colour_bytes " + std::to_string(depth_bytes) + " and " +
                std::to_string(colour_bytes));
  const double units = depth_units_per_m(header);

  const CameraRig rig = rig_from_json(json_field(header, "camera", kHeader), "camera");
  Frame frame;
  frame.depth_camera = rig.depth_camera;
  frame.colour_camera = rig.colour_camera.value_or(rig.depth_camera);
  frame.T_colour_depth = rig.colour_camera ? rig.T_colour_depth : Eigen::Isometry3d::Identity();
  frame.depth_noise = rig.depth_noise;
  require_valid(frame.depth_camera, "camera.depth");
  require_valid(frame.colour_camera, "camera.colour");
  const std::string_view depth = images.substr(0, depth_bytes), colour = images.substr(depth_bytes);
  require_size(depth, frame.depth_camera, "the depth image");
  require_size(colour, frame.colour_camera, "the colour image");
  decode_depth_png(depth, static_cast<float>(units), "the depth image", frame.depth_m);
  decode_colour(colour, "the colour image", frame.colour);
  return frame;
}

}  // namespace roomradar
