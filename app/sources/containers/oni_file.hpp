// oni_file.hpp: recordings of OpenNI and OpenNI2, .oni files.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/containers/random_access_file.hpp"

namespace roomradar {

/// Type of the data of a node, which is one stream of the device.
enum class OniNodeKind : std::uint32_t { kDevice = 1, kDepth = 2, kImage = 3, kIr = 4 };

struct OniFrame {
  std::uint64_t stamp_us = 0;
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0;
};

struct OniNode {
  OniNodeKind kind = OniNodeKind::kDevice;
  std::string codec;  ///< four characters, such as "16zT", "16zP", "JPEG" or "NONE"
  std::map<std::string, std::uint64_t> integers{};  ///< properties by name
  std::map<std::string, std::string> values{};      ///< properties of other types; at most 64 kB each
  std::vector<OniFrame> frames{};                   ///< in the file's order
};

/// Returns true if the file starts with the signature of .oni files.
[[nodiscard]] bool is_oni(const std::filesystem::path& path);

/// Reads the properties of all nodes and lists their frames; skips the data. A truncated file, as after a
/// killed recorder, is read up to its last complete record. A file with a damaged record header is read up to
/// that record.
/// @throws Error naming the file if it is not a .oni file of version 1.0, or a record's fields are damaged
std::map<std::uint32_t, OniNode> index_oni(const RandomAccessFile& file);

/// Decompresses 16 bit depth of the codecs 16zT (has_table: pixels are indices into a table of values) and
/// 16zP (pixels are the values).
/// @throws Error naming `where` if the data are damaged or do not contain exactly `pixels` pixels
std::vector<std::uint16_t> decompress_oni_depth(std::string_view packed, bool has_table, std::size_t pixels,
                                                const std::string& where);

}  // namespace roomradar
