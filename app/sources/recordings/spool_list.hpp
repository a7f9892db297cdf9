// spool_list.hpp: files of a frame cache on disk (spool): a list of the frames, and their images.
//
// The list, list.bin, has a header: "RRSPOOL1" and the source's name. Then, for each frame: the size of its
// entry in bytes (u32), and the entry. A size of 0 marks the end of the source.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// A frame without its images, or the problem that replaced it.
struct SpoolEntry {
  Frame frame;
  /// Error message if the frame is unreadable; empty otherwise.
  std::string fault;
};

/// The list that an earlier process left in a folder.
struct SpoolList {
  /// Name of the source.
  std::string name;
  std::vector<SpoolEntry> entries;
  /// True if the source had ended.
  bool at_end = false;
  /// Length of the list's valid part; an incomplete entry may follow.
  std::uintmax_t sound_bytes = 0;
};

/// Returns the path of the folder's list.
std::filesystem::path spool_list_file(const std::filesystem::path& folder);

/// Returns true if the folder has a list with a complete header. The header is incomplete if the disk was
/// full or the process was killed before the first frame.
bool has_spool_list(const std::filesystem::path& folder);

/// Reads the list of a folder. A damaged entry becomes an unreadable frame. Throws Error if the file is
/// unreadable or not such a list.
SpoolList read_spool_list(const std::filesystem::path& folder);

/// Creates the list of a folder, without frames. Throws Error if it cannot be written.
/// @param name  the source's name
/// @param[out] list  stream, opened at the list's end
void begin_spool_list(const std::filesystem::path& folder, const std::string& name, std::ofstream& list);

/// Appends an entry to the list; null marks the end of the source. Throws Error if the list cannot be
/// written.
void append_to_spool_list(SpoolEntry* entry, const std::filesystem::path& folder, std::ofstream& list);

/// Writes the images of a frame to the folder, and returns its entry. Throws Error if they cannot be written.
/// @param position  index of the frame in the list, which names the image files
SpoolEntry write_spooled(const Frame& frame, const std::filesystem::path& folder, std::size_t position);

/// Reads the frame of an entry, bit-identical to the frame written. Throws Error if its images are missing or
/// damaged.
/// @param position  index of the frame in the list
ReadResult read_spooled(const SpoolEntry& entry, const std::filesystem::path& folder, std::size_t position,
                        Frame& frame);

}  // namespace roomradar
