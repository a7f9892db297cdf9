// written_matroska.hpp: writes small Matroska files.
#pragma once
#include <cstdint>
#include <string>

namespace roomradar::test {

inline std::string big_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = bytes; i-- > 0;) text += static_cast<char>(value >> (8 * i) & 0xFFU);
  return text;
}

/// An identifier, as written in the standard, with its size in 8 bytes and its data.
inline std::string element(std::uint64_t id, const std::string& data) {
  const std::size_t id_bytes = id > 0xFFFFFF ? 4 : id > 0xFFFF ? 3 : id > 0xFF ? 2 : 1;
  return big_endian(id, id_bytes) + big_endian(std::uint64_t{1} << 56U | data.size(), 8) + data;
}
inline std::string element(std::uint64_t id, std::uint64_t number) {
  return element(id, big_endian(number, 8));
}

/// Video track with a bitmap header of this four-character code; without video if `code` is empty.
inline std::string track(std::uint64_t number, const std::string& name, const std::string& code,
                         int width_px = 0, int height_px = 0) {
  std::string data = element(0xD7, number) + element(0x536E, name);
  if (!code.empty())
    data += element(0x86, "V_MS/VFW/FOURCC") +
            element(0x63A2, std::string(16, '\0') + code + std::string(20, '\0')) +
            element(0xE0, element(0xB0, static_cast<std::uint64_t>(width_px)) +
                              element(0xBA, static_cast<std::uint64_t>(height_px)));
  return element(0xAE, data);
}

inline std::string block_data(int track, int ticks, const std::string& data) {
  return static_cast<char>(0x80 | track) + big_endian(static_cast<std::uint16_t>(ticks), 2) + '\0' + data;
}

inline std::string attachment(const std::string& name, const std::string& data) {
  return element(0x1941A469, element(0x61A7, element(0x466E, name) + element(0x465C, data)));
}

/// File with ticks of 1 us.
inline std::string matroska_file(const std::string& tracks, const std::string& attachments,
                                 const std::string& clusters) {
  return element(0x1A45DFA3, element(0x4282, "matroska")) +
         element(0x18538067, element(0x1549A966, element(0x2AD7B1, 1000)) + element(0x1654AE6B, tracks) +
                                 attachments + clusters);
}

}  // namespace roomradar::test
