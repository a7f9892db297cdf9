// spool_list.hpp: files of a spool (a frame cache on disk): a list of the frames, and their images.
//
// The list, list.bin, begins with "RRSPOOL3" and the source's name. For each frame follow the size of its
// entry in bytes (u32) and the entry. A size of 0 marks the end of the source. The images are in N.images,
// counted from 0 (frame_images.hpp); lists that begin with "RRSPOOL1" or "RRSPOOL2" may have
// N.depth.png and N.colour.png.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// A frame without its images, or the error message of an unreadable frame.
struct SpoolEntry {
  Frame frame;
  /// Error message if the frame is unreadable; empty otherwise.
  std::string fault;
};

/// Contents of a list.
struct SpoolList {
  /// Name of the source.
  std::string name;
  std::vector<SpoolEntry> entries;
  /// True if the source had ended.
  bool at_end = false;
  /// Size of the list's valid part. An incomplete entry may follow.
  std::uintmax_t sound_bytes = 0;
};

/// Returns the path of the folder's list.
std::filesystem::path spool_list_file(const std::filesystem::path& folder);

/// Returns true if the folder has a list with a complete header. A header is incomplete if the disk was full
/// or the writing process was killed before the first frame.
bool has_spool_list(const std::filesystem::path& folder);

/// Reads the list of a folder. A damaged entry becomes an entry with an error message. Throws Error if the
/// file is unreadable or not a spool's list.
SpoolList read_spool_list(const std::filesystem::path& folder);

/// Creates an empty list in a folder. Throws Error if it cannot be written.
/// @param name       name of the source, stored in the header
/// @param[out] list  stream, opened at the list's end
void begin_spool_list(const std::filesystem::path& folder, const std::string& name, std::ofstream& list);

/// Appends an entry to the list. If `entry` is null, appends the source's end. Throws Error if the list
/// cannot be written.
void append_to_spool_list(const SpoolEntry* entry, const std::filesystem::path& folder, std::ofstream& list);

/// Writes the images of a frame to the folder, and returns the frame's entry. Throws Error if an image cannot
/// be written.
/// @param position  index of the frame in the list. It determines the images' file names
SpoolEntry write_spooled(const Frame& frame, const std::filesystem::path& folder, std::size_t position);

/// Reads the frame of an entry, identical in all bits to the frame written. Throws Error if its images are
/// missing or damaged.
/// @param position  index of the frame in the list
ReadResult read_spooled(const SpoolEntry& entry, const std::filesystem::path& folder, std::size_t position,
                        Frame& frame);

}  // namespace roomradar
