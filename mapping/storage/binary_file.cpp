// binary_file.cpp: writes binary files and reads them without trusting the file.
#include "mapping/storage/binary_file.hpp"

#include <cstring>
#include <utility>

#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kHash_bytes = sizeof(std::uint64_t);

constexpr std::uint64_t kHashOfNothing = 14695981039346656037ULL;

/// @param hash  of the bytes before these
std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = kHashOfNothing) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  return hash;
}

}  // namespace

void write_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                  std::string_view body) {
  ByteWriter beginning, checksum;
  beginning.raw(magic.data(), magic.size());
  beginning(version);
  checksum(fnv1a(body, fnv1a(beginning.bytes)));
  write_parts(path, {beginning.bytes, body, checksum.bytes});
}

BinaryBody read_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t oldest,
                       std::uint32_t newest, FileChecksum checksum) {
  std::string bytes = read_bytes(path, "a file that begins with " + std::string(magic));
  ByteReader in(bytes, path.string(), kFileAdvice);
  if (!bytes.starts_with(magic)) in.fail("not a file of this kind, which begins with " + std::string(magic));
  (void)in.take(magic.size());
  const auto found = in.number<std::uint32_t>();
  if (found < oldest || found > newest) {
    in.fail("version " + std::to_string(found) + ", this program reads version " +
            (oldest == newest ? "" : std::to_string(oldest) + " to ") + std::to_string(newest));
  }
  if (in.left() < kHash_bytes) in.fail("cut short: checksum missing");
  std::uint64_t hash = 0;
  std::memcpy(&hash, bytes.data() + bytes.size() - kHash_bytes, kHash_bytes);
  bytes.resize(bytes.size() - kHash_bytes);
  if (checksum == FileChecksum::kCompared && hash != fnv1a(bytes))
    in.fail("cut short or altered: the checksum is wrong");
  bytes.erase(0, magic.size() + sizeof(found));
  return {found, std::move(bytes)};
}

}  // namespace roomradar
