// numbered_files.hpp: images in a folder whose names are numbers, and their size.
#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Returns the files in `folder` whose name is a number >= 0, with one of the extensions, by number. Of
/// several files with one number, returns the one whose extension is first in the list. Empty if there is no
/// such folder.
std::map<std::int64_t, std::filesystem::path> numbered_files(
    const std::filesystem::path& folder, std::initializer_list<std::string_view> extensions);

/// Returns the size of the first image, among the first ten files, whose header can be read. Throws Error
/// naming `where` if there is none.
ImageSize size_of_first_png(const std::vector<std::filesystem::path>& files,
                            const std::filesystem::path& where);

/// Returns the depth camera of a device whose depth is registered to colour: the colour camera, scaled to
/// depth images of this size. Throws Error naming `where` if the shapes of the images differ.
Intrinsics scaled_to_depth(const Intrinsics& colour, ImageSize depth, const std::string& where);

}  // namespace roomradar
