// binary_file.cpp: writes numbers to binary files and reads them without trusting the file.
#include "mapping/storage/binary_file.hpp"

#include <cmath>
#include <utility>

#include "mapping/types/system/error.hpp"
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

void BinaryReader::fail(const std::string& fault) const {
  throw Error(path_.string() + ": " + fault + kFileAdvice);
}

double BinaryReader::take_finite(const char* what) {
  const auto number = take<double>(what);
  if (!std::isfinite(number)) fail(std::string(what) + " is not a number");
  return number;
}

void write_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                  std::string_view body) {
  std::string beginning(magic), checksum;
  put(beginning, version);
  put(checksum, fnv1a(body, fnv1a(beginning)));
  write_parts(path, {beginning, body, checksum});
}

BinaryBody read_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t oldest,
                       std::uint32_t newest, FileChecksum checksum) {
  std::string bytes = read_bytes(path, "a file that begins with " + std::string(magic));
  BinaryReader in(bytes, path);
  if (!bytes.starts_with(magic)) in.fail("not a file of this kind, which begins with " + std::string(magic));
  std::string beginning(magic.size(), '\0');
  in.take(beginning.data(), beginning.size(), "beginning");
  const auto found = in.take<std::uint32_t>("version");
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
