// numbered_files.cpp: lists a folder; reads headers of images.
#include "app/sources/datasets/numbered_files.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {

namespace fs = std::filesystem;

namespace {

/// Returns the number that a file's name begins with, as in 000012 or 0000012-000000400403, or else ends with,
/// as in depth_000012; nullopt if there is none.
std::optional<std::int64_t> number_in(const std::string& stem) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t begin_end = stem.find_first_not_of(kDigits);
  if (begin_end != 0) return parse_whole_number(std::string_view(stem).substr(0, begin_end));
  const std::size_t before = stem.find_last_not_of(kDigits);
  return parse_whole_number(std::string_view(stem).substr(before + 1));
}

/// Returns the first number anywhere in a file's name.
std::optional<std::int64_t> first_number_in(const std::string& stem) {
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t begin = std::min(stem.find_first_of(kDigits), stem.size());
  const std::size_t end = std::min(stem.find_first_not_of(kDigits, begin), stem.size());
  return parse_whole_number(std::string_view(stem).substr(begin, end - begin));
}

/// Returns the number that all digits of a file's name make.
std::optional<std::int64_t> all_digits_in(const std::string& stem) {
  std::string digits;
  std::copy_if(stem.begin(), stem.end(), std::back_inserter(digits), [](char c) { return c >= '0' && c <= '9'; });
  return parse_whole_number(digits);
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::map<std::int64_t, fs::path> numbered_files(const fs::path& folder,
                                                std::initializer_list<std::string_view> extensions) {
  std::map<std::int64_t, fs::path> files;
  if (!fs::is_directory(folder)) return files;
  const std::vector<fs::path> entries = entries_of(folder);
  const auto list = [&](const auto& number_of) {
    files.clear();
    std::size_t images = 0;
    for (const std::string_view extension : extensions)
      for (const fs::path& file : entries) {
        if (lower_case(file.extension().string()) != extension) continue;
        ++images;
        const auto number = number_of(file.stem().string());
        if (number && *number >= 0) files.try_emplace(*number, file);
      }
    return 2 * files.size() >= images;
  };
  // The first number of names such as 2024-03-05_12-00-07_033 is of no use, nor the last of img_0012_depth16.
  if (!list(number_in) && !list(first_number_in)) (void)list(all_digits_in);
  return files;
}

fs::path folder_named(const fs::path& folder, std::initializer_list<std::string_view> names) {
  std::error_code ignored;
  const std::vector<fs::path> entries = entries_of(folder, ignored);
  for (const std::string_view name : names)
    for (const fs::path& entry : entries)
      if (lower_case(entry.filename().string()) == name && fs::is_directory(entry, ignored)) return entry;
  return {};
}

fs::path depth_folder(const fs::path& folder) {
  return folder_named(folder, {"depth", "depths", "depth_images", "depth_image", "depth_raw", "depthimages"});
}

fs::path colour_folder(const fs::path& folder) {
  return folder_named(folder, {"color", "colour", "rgb", "image", "images", "colors", "colours",
                               "color_images", "colour_images", "rgb_images", "color_image", "rgb_image"});
}

ImageSize size_of_images(const std::vector<fs::path>& files, const fs::path& where) {
  constexpr std::size_t kSampled = 9;
  constexpr std::uintmax_t kMaxImage_bytes = 1U << 30U;
  std::string first_fault;
  std::map<std::pair<int, int>, int> votes;
  const auto read = [&](std::size_t i) {
    try {
      const std::string bytes = read_bytes(files[i], "an image", kMaxImage_bytes);
      const ImageHeader header = read_image_header(bytes, files[i].string());
      ++votes[{header.width_px, header.height_px}];
    } catch (const Error& fault) {
      if (first_fault.empty()) first_fault = fault.what();
    }
  };
  const std::size_t sampled = std::min(files.size(), kSampled);
  for (std::size_t k = 0; k < sampled; ++k) read(k * files.size() / sampled);
  for (std::size_t i = 0; votes.empty() && i < files.size(); ++i) read(i);
  if (files.empty()) throw Error(where.string() + ": contains no depth images");
  if (votes.empty())
    throw Error(where.string() + ": none of its " + std::to_string(files.size()) +
                " images can be read, the first because " + first_fault);
  const auto most = std::max_element(votes.begin(), votes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return {most->first.first, most->first.second};
}

std::optional<ImageSize> size_of_colours(const std::vector<fs::path>& files, const fs::path& where,
                                         RecordingFacts& facts) {
  if (files.empty()) return std::nullopt;
  try {
    return size_of_images(files, where);
  } catch (const Error& fault) {
    facts.notes.push_back({"images",
                           "no colour image can be read, so depth is used without colour: " + std::string(fault.what()),
                           static_cast<std::int64_t>(files.size()), "", true});
    return std::nullopt;
  }
}

InputDecision unused_colours(std::int64_t count) {
  return {"images",
          std::to_string(count) + (count == 1 ? " colour image has" : " colour images have") +
              " no depth image of the same number; not used",
          count};
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
