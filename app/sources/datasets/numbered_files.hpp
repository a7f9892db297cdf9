// numbered_files.hpp: lists the image files in a folder whose names are numbers, and reads their image size.
#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Returns the files in `folder` whose name begins or ends with a number, with one of the extensions (lower
/// case, which stand for upper case too), by number: 12.png, 0000012-000000400403.PNG, depth_12.png. If that
/// number is the same for most names, it is the first number in them, as in img_0012_depth16.png, or all their
/// digits, as in 2024-03-05_12-00-07_033.png. Of
/// several files with the same number, returns the file whose extension is first in the list. Returns an empty
/// map if the folder does not exist.
std::map<std::int64_t, std::filesystem::path> numbered_files(
    const std::filesystem::path& folder, std::initializer_list<std::string_view> extensions);

/// Returns the first folder in `folder` with one of these names (lower case, which stand for upper case too),
/// in the order of the names; empty if there is none.
std::filesystem::path folder_named(const std::filesystem::path& folder,
                                   std::initializer_list<std::string_view> names);
/// Returns the folder of depth images: depth, Depth, depth_images and so on; empty if there is none.
std::filesystem::path depth_folder(const std::filesystem::path& folder);
/// Returns the folder of colour images: color, rgb, image and so on; empty if there is none.
std::filesystem::path colour_folder(const std::filesystem::path& folder);

/// Returns the size that most of nine images have, which are spread over the list. If none of these can be
/// read, that of the first that can. Throws Error naming `where` if there is none.
ImageSize size_of_images(const std::vector<std::filesystem::path>& files, const std::filesystem::path& where);

/// Returns size_of_images() of colour images. If none of them can be read, notes it, and returns nullopt: depth
/// is then used without colour.
std::optional<ImageSize> size_of_colours(const std::vector<std::filesystem::path>& files,
                                         const std::filesystem::path& where, RecordingFacts& facts);

/// Returns the decision about `count` colour images whose number no depth image has.
InputDecision unused_colours(std::int64_t count);

/// Returns the intrinsics of depth that is registered to colour: those of the colour camera, scaled to the
/// size `depth`. Throws Error naming `where` if the aspect ratios of depth and colour differ.
Intrinsics scaled_to_depth(const Intrinsics& colour, ImageSize depth, const std::string& where);

}  // namespace roomradar
