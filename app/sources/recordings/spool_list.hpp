// spool_list.hpp: the files of a spool: the list of its frames, and their images.
//
// list.bin: "RRSPOOL1", the source's name, then for each frame the size of its entry in bytes (u32) and the
// entry; a size of 0 marks the end of the source.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// A frame without its images, or the fault that replaced it.
struct SpoolEntry {
  Frame frame;
  std::string fault;
};

/// List left in a folder by an earlier process.
struct SpoolList {
  std::string name;
  std::vector<SpoolEntry> entries;
  bool at_end = false;
  std::uintmax_t sound_bytes = 0;  ///< length of the list's valid part; an incomplete entry may follow
};

std::filesystem::path spool_list_file(const std::filesystem::path& folder);

/// Returns false for a list without a complete header: a full disk or a kill cut it off before the first
/// frame.
bool has_spool_list(const std::filesystem::path& folder);

/// Reads the list of a folder. A damaged entry becomes an unreadable frame. Throws Error if the list is
/// unreadable or not a spool's.
SpoolList read_spool_list(const std::filesystem::path& folder);

/// Creates the list of a folder, without frames. Throws Error if it cannot be written.
/// @param name  of the source
/// @param list  opened at the list's end
void begin_spool_list(const std::filesystem::path& folder, const std::string& name, std::ofstream& list);

/// Appends an entry; null marks the end of the source. Throws Error if the list cannot be written.
void append_to_spool_list(SpoolEntry* entry, const std::filesystem::path& folder, std::ofstream& list);

/// Writes the images of a frame to the folder, and returns its entry. Throws Error if they cannot be written.
SpoolEntry write_spooled(const Frame& frame, const std::filesystem::path& folder, std::size_t position);

/// Reads the frame of an entry, bit-identical to the frame written. Throws Error if its images are missing or
/// damaged.
ReadResult read_spooled(const SpoolEntry& entry, const std::filesystem::path& folder, std::size_t position,
                        Frame& frame);

}  // namespace roomradar
