// numbered_files.cpp: lists a folder; reads headers of images.
#include "app/sources/datasets/numbered_files.hpp"

#include <algorithm>
#include <cmath>

#include "app/sources/datasets/indexed_source.hpp"
#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {

namespace fs = std::filesystem;

std::map<std::int64_t, fs::path> numbered_files(const fs::path& folder,
                                                std::initializer_list<std::string_view> extensions) {
  std::map<std::int64_t, fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const std::string_view extension : extensions)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const auto number = parse_whole_number(entry.path().stem().string());
      if (entry.path().extension() == extension && number && *number >= 0)
        files.try_emplace(*number, entry.path());
    }
  return files;
}

ImageSize size_of_first_png(const std::vector<fs::path>& files, const fs::path& where) {
  constexpr std::size_t kTried = 10;
  constexpr std::uintmax_t kMaxImage_bytes = 1U << 30U;
  std::string first_fault;
  for (std::size_t i = 0; i < std::min(files.size(), kTried); ++i) {
    try {
      const std::string bytes = read_bytes(files[i], "an image", kMaxImage_bytes);
      const ImageHeader header = read_image_header(bytes, files[i].string());
      return {header.width_px, header.height_px};
    } catch (const Error& fault) {
      if (first_fault.empty()) first_fault = fault.what();
    }
  }
  if (files.empty()) throw Error(where.string() + ": contains no depth images");
  throw Error(where.string() + ": none of its first frames can be read, the first because " + first_fault);
}

Intrinsics scaled_to_depth(const Intrinsics& colour, ImageSize depth, const std::string& where) {
  Intrinsics camera = scaled(colour, static_cast<double>(depth.width_px) / colour.width_px);
  if (std::abs(camera.height_px - depth.height_px) > 1)
    throw Error(where + ": depth is " + size_text(depth.width_px, depth.height_px) +
                ", which does not have the aspect ratio of the colour, " +
                size_text(colour.width_px, colour.height_px));
  camera.width_px = depth.width_px;
  camera.height_px = depth.height_px;
  return camera;
}

}  // namespace roomradar
