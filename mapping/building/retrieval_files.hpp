// retrieval_files.hpp: writes and reads the features and similarities of submaps.
#pragma once
#include <filesystem>

#include "mapping/building/keyframe_retrieval.hpp"

namespace roomradar {

/// Writes a submap's features. Throws Error if the file cannot be written.
void save_features(const SubmapFeatures& features, const std::filesystem::path& path);
/// Reads the features. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version.
SubmapFeatures load_features(const std::filesystem::path& path);

/// Writes the similarities of two groups of submaps. Throws Error if the file cannot be written.
void save_similarity(const GroupSimilarity& similarity, const std::filesystem::path& path);
/// Reads the similarities. Throws Error naming the file and the fault if it is missing, damaged or of another
/// version, or if the groups have other numbers of submaps.
/// @param submaps_b  number of submaps of the second group; 0: one group, compared with itself
GroupSimilarity load_similarity(const std::filesystem::path& path, std::size_t submaps_a,
                                std::size_t submaps_b);

}  // namespace roomradar
