// spool_list.cpp: stores images in files, and all other data of frames in a list.
#include "app/sources/recordings/spool_list.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/frame_images.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "RRSPOOL3";
/// Of lists whose frames may have PNGs, and may lack the sensor's times and noise.
constexpr std::array<std::string_view, 2> kEarlierMagics{"RRSPOOL1", "RRSPOOL2"};

fs::path images_file(const fs::path& folder, std::size_t position) {
  return folder / (std::to_string(position) + ".images");
}

/// Reads the images of a frame, or the PNGs that an earlier version wrote instead. Returns the path of the
/// file that holds the depth.
fs::path read_images(const fs::path& folder, std::size_t position, Frame& frame) {
  const fs::path images = images_file(folder, position);
  const fs::path depth_png = folder / (std::to_string(position) + ".depth.png");
  if (fs::exists(images) || !fs::exists(depth_png)) {
    read_frame_images(images, frame);
    return images;
  }
  read_exact_depth_file(depth_png, frame.depth_m);
  const fs::path colour_png = folder / (std::to_string(position) + ".colour.png");
  if (fs::exists(colour_png))
    read_colour_file(colour_png, frame.colour);
  else
    frame.colour.resize(0, 0);
  return depth_png;
}

/// @param has_sensor  false: an entry of a list that was written before frames had a sensor's times and noise
template <typename Archive>
void serialize_entry(Archive& archive, Ref<Archive, SpoolEntry> entry, bool has_sensor = true) {
  auto& frame = entry.frame;
  archive(entry.fault);
  if (!entry.fault.empty()) return;
  archive(frame.index, frame.stamp_s, frame.colour_after_depth_s, frame.depth_camera);
  bool coloured = frame.colour_camera.width_px > 0;
  archive(coloured);
  if (coloured) archive(frame.colour_camera);
  archive(frame.T_colour_depth);
  if (has_sensor) archive(frame.timing, frame.depth_noise);
  archive(frame.T_world_camera, frame.down_camera);
}

/// Parses an entry, with or without the sensor's times and noise; a damaged entry becomes an unreadable
/// frame. A list that an earlier version began may hold both: an entry with a sensor is 44 bytes longer.
SpoolEntry entry_of(std::string_view bytes, const fs::path& list) {
  const auto parsed = [&](bool has_sensor) {
    SpoolEntry entry;
    ByteReader reader(bytes, list.string());
    serialize_entry(reader, entry, has_sensor);
    reader.require_end();
    if (!is_valid(entry.frame.depth_noise)) reader.fail("its noise model is not valid");
    return entry;
  };
  try {
    return parsed(/*has_sensor=*/true);
  } catch (const Error&) {
  }
  try {
    return parsed(/*has_sensor=*/false);
  } catch (const Error& damage) {
    return {{}, damage.what()};
  }
}

}  // namespace

fs::path spool_list_file(const fs::path& folder) { return folder / "list.bin"; }

bool has_spool_list(const fs::path& folder) {
  std::error_code fault;
  const std::uintmax_t bytes = fs::file_size(spool_list_file(folder), fault);
  return !fault && bytes > kMagic.size();
}

SpoolList read_spool_list(const fs::path& folder) {
  const fs::path path = spool_list_file(folder);
  const std::string bytes = read_bytes(path, "the list of a live scan's frames");
  ByteReader list(bytes, path.string());
  std::string magic(kMagic.size(), '\0');
  list.raw(magic.data(), magic.size());
  if (magic != kMagic &&
      std::find(kEarlierMagics.begin(), kEarlierMagics.end(), magic) == kEarlierMagics.end())
    list.fail("is not a list of spooled frames, or has another version");
  SpoolList left;
  list(left.name);
  left.sound_bytes = bytes.size() - list.left();
  while (!left.at_end) {
    // A truncated entry was being written when the process was killed; its frame was never used.
    std::uint32_t size = 0;
    if (list.left() < sizeof size) break;
    list(size);
    if (list.left() < size) break;
    left.at_end = size == 0;
    if (left.at_end && list.left() > 0) {  // zeros left by a power failure instead of entries
      left.at_end = false;
      break;
    }
    if (size > 0) left.entries.push_back(entry_of(list.take(size), path));
    left.sound_bytes = bytes.size() - list.left();
  }
  return left;
}

void begin_spool_list(const fs::path& folder, const std::string& name, std::ofstream& list) {
  const fs::path path = spool_list_file(folder);
  ByteWriter head;
  head.raw(kMagic.data(), kMagic.size());
  head(name);
  list.open(path, std::ios::binary);
  list << head.bytes << std::flush;
  std::error_code fault;
  if (!list) fs::remove(path, fault);  // holds no frame, and would block the folder
  require_written(list, path);
}

void append_to_spool_list(const SpoolEntry* entry, const fs::path& folder, std::ofstream& list) {
  ByteWriter bytes;
  if (entry) serialize_entry(bytes, *entry);
  const auto size = static_cast<std::uint32_t>(bytes.bytes.size());
  list.write(reinterpret_cast<const char*>(&size), sizeof size);
  list << bytes.bytes << std::flush;
  require_written(list, spool_list_file(folder));
}

SpoolEntry write_spooled(const Frame& frame, const fs::path& folder, std::size_t position) {
  write_frame_images(frame, images_file(folder, position));
  SpoolEntry entry;
  copy_all_but_images(frame, entry.frame);
  return entry;
}

ReadResult read_spooled(const SpoolEntry& entry, const fs::path& folder, std::size_t position, Frame& frame) {
  if (!entry.fault.empty()) return {ReadStatus::kSkipped, entry.fault};
  const fs::path images = read_images(folder, position, frame);
  copy_all_but_images(entry.frame, frame);
  if (const std::string_view fault = fault_of(frame); !fault.empty())
    throw Error(images.string() + ": is damaged: " + std::string(fault));
  return {ReadStatus::kFrame, {}};
}

}  // namespace roomradar
