// matroska.hpp: tracks, attachments and the index of a Matroska file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/sources/containers/random_access_file.hpp"

namespace roomradar {

struct MatroskaTrack {
  std::uint64_t number = 0;
  std::string name;           ///< such as "DEPTH"
  std::string codec;          ///< such as "V_MJPEG"
  std::string codec_private;  ///< initialisation data of the codec; at most 64 kB
  std::uint64_t width_px = 0, height_px = 0;
};

/// Location of a block's data in the file, with its track and time.
struct MatroskaBlock {
  std::uint64_t track = 0;
  double stamp_s = 0.0;
  std::uint64_t offset = 0, size = 0;
};
struct MatroskaAttachment {
  std::string file_name;
  std::uint64_t offset = 0, size = 0;
};

struct MatroskaIndex {
  std::vector<MatroskaTrack> tracks;
  std::vector<MatroskaAttachment> attachments;
  std::vector<MatroskaBlock> blocks;  ///< in the file's order, without laced and incomplete blocks
};

/// Returns true if the file begins with an EBML header.
[[nodiscard]] bool is_matroska(const std::filesystem::path& path);

/// Reads the headers of the file's elements; skips the data of blocks. A file truncated within a cluster, as
/// after a killed recorder, is read up to its last complete block.
/// @throws Error if the file is not Matroska, or an element before the first cluster is damaged
/// Source: IETF RFC 8794 (EBML), RFC 9559 (Matroska).
MatroskaIndex index_matroska(const RandomAccessFile& file);

}  // namespace roomradar
