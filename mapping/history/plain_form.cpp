// plain_form.cpp: unpacks zstd frames and differences vertex indices, if that can be undone exactly.
#include "mapping/history/plain_form.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr const char* kAdvice = "; take the map from a backup";

/// First byte of a plain form.
enum class Form : std::uint8_t { kAsIs = 0, kFrames = 1, kPly = 2 };

constexpr std::uint8_t kBytes = 0, kFrame = 1;  // parts of Form::kFrames

void add_part(std::uint8_t kind, std::string_view bytes, ByteWriter& out) {
  if (bytes.empty()) return;
  out(kind, std::uint64_t{bytes.size()});
  out.bytes.append(bytes);
}

/// Returns the file with its zstd frames unpacked; nullopt if it has none.
std::optional<std::string> with_unpacked_frames(std::string_view file) {
  constexpr std::string_view kFrameMagic("\x28\xB5\x2F\xFD", 4);
  ByteWriter out;
  out(static_cast<std::uint8_t>(Form::kFrames));
  std::size_t written = 0;  // bytes of the file
  for (std::size_t at = file.find(kFrameMagic); at != std::string_view::npos; at = file.find(kFrameMagic, at)) {
    const std::optional<UnpackedFrame> frame = unpack_frame(file.substr(at));
    if (!frame || compress_frame(frame->bytes) != file.substr(at, frame->frame_bytes)) {
      at += kFrameMagic.size();
      continue;
    }
    add_part(kBytes, file.substr(written, at - written), out);
    add_part(kFrame, frame->bytes, out);
    written = at += frame->frame_bytes;
  }
  if (written == 0) return std::nullopt;
  add_part(kBytes, file.substr(written), out);
  return std::move(out.bytes);
}

std::string with_packed_frames(ByteReader& in) {
  std::string file;
  while (in.left() > 0) {
    const auto kind = in.number<std::uint8_t>();
    const std::string_view bytes = in.take(in.number<std::uint64_t>());
    if (kind > kFrame) in.fail("is damaged: a part of a file is of an unknown kind");
    file += kind == kFrame ? compress_frame(bytes) : std::string(bytes);
  }
  return file;
}

/// Parts of a binary PLY file whose faces are triangles with 32-bit indices, as write_mesh() writes it.
struct PlyParts {
  std::string_view header, vertices, faces;
};

constexpr std::size_t kFace_bytes = 13, kIndex_bytes = 4;  // of a face: 3, and three indices

std::optional<std::size_t> count_of(std::string_view header, std::string_view element) {
  const std::size_t at = header.find(element);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t count = 0;
  const char* const begin = header.data() + at + element.size();
  const auto parsed = std::from_chars(begin, header.data() + header.size(), count);
  return parsed.ec == std::errc() ? std::optional(count) : std::nullopt;
}

std::optional<PlyParts> ply_parts(std::string_view file) {
  constexpr std::string_view kEnd = "end_header\n";
  if (!file.starts_with("ply\nformat binary_little_endian")) return std::nullopt;
  const std::size_t end = file.substr(0, 4096).find(kEnd);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view header = file.substr(0, end + kEnd.size());
  const std::optional<std::size_t> faces = count_of(header, "element face ");
  const std::size_t left = file.size() - header.size();
  if (!faces || *faces > left / kFace_bytes) return std::nullopt;
  const std::size_t vertices = left - *faces * kFace_bytes;
  return PlyParts{header, file.substr(header.size(), vertices), file.substr(header.size() + vertices)};
}

std::uint32_t index_at(std::string_view bytes, std::size_t at) {
  std::uint32_t index = 0;
  std::memcpy(&index, bytes.data() + at, kIndex_bytes);
  return index;
}

std::optional<std::string> with_differences(std::string_view file) {
  const std::optional<PlyParts> ply = ply_parts(file);
  if (!ply) return std::nullopt;
  ByteWriter out;
  out(static_cast<std::uint8_t>(Form::kPly), std::uint64_t{ply->header.size()},
      std::uint64_t{ply->vertices.size()});
  out.bytes.append(ply->header).append(ply->vertices);
  std::uint32_t last = 0;
  for (std::size_t face = 0; face < ply->faces.size(); face += kFace_bytes) {
    if (ply->faces[face] != 3) return std::nullopt;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t index = index_at(ply->faces, face + 1 + corner * kIndex_bytes);
      out(std::uint32_t{index - last});
      last = index;
    }
  }
  return std::move(out.bytes);
}

std::string with_indices(ByteReader& in) {
  const auto header = in.number<std::uint64_t>(), vertices = in.number<std::uint64_t>();
  std::string file(in.take(header));
  file += in.take(vertices);
  std::uint32_t last = 0;
  while (in.left() > 0) {
    file += '\3';
    for (int corner = 0; corner < 3; ++corner) {
      last += in.number<std::uint32_t>();
      std::array<char, kIndex_bytes> bytes;
      std::memcpy(bytes.data(), &last, kIndex_bytes);
      file.append(bytes.data(), bytes.size());
    }
  }
  return file;
}

}  // namespace

std::string plain_form(std::string_view file) {
  std::optional<std::string> plain = with_differences(file);
  if (!plain) plain = with_unpacked_frames(file);
  if (plain) return std::move(*plain);
  return std::string(1, static_cast<char>(Form::kAsIs)).append(file);
}

std::string from_plain_form(std::string_view plain, std::string_view where) {
  ByteReader in(plain, std::string(where), kAdvice);
  switch (static_cast<Form>(in.number<std::uint8_t>())) {
    case Form::kAsIs:
      return std::string(in.take(in.left()));
    case Form::kFrames:
      return with_packed_frames(in);
    case Form::kPly:
      return with_indices(in);
  }
  in.fail("is damaged: a file is in an unknown form");
}

}  // namespace roomradar
