// block_store.cpp: cuts, packs and finds blocks.
#include "mapping/history/block_store.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMagic = "RRBLOCK1";
constexpr std::size_t kChecksum_bytes = 32, kHead_bytes = kChecksum_bytes + 8;
constexpr std::size_t kLeast_bytes = 1024, kMost_bytes = 65536;
constexpr std::size_t kMostInOne_bytes = 1U << 26U;  // the root of a file of terabytes

/// Numbers without pattern, one per byte value (splitmix64).
std::array<std::uint64_t, 256> mixed_numbers() {
  std::array<std::uint64_t, 256> numbers{};
  std::uint64_t state = 0;
  for (std::uint64_t& number : numbers) {
    state += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    number = z ^ (z >> 31U);
  }
  return numbers;
}

}  // namespace

std::vector<std::string_view> cut_into_blocks(std::string_view bytes) {
  static const std::array<std::uint64_t, 256> kMixed = mixed_numbers();
  constexpr std::uint64_t kCut = 0xFFFULL << 52U;  // 12 of the highest bits: every 4 kB
  std::vector<std::string_view> blocks;
  while (!bytes.empty()) {
    std::size_t size = std::min(bytes.size(), kLeast_bytes);
    const std::size_t most = std::min(bytes.size(), kMost_bytes);
    for (std::uint64_t sum = 0; size < most; ++size) {
      sum = (sum << 1U) + kMixed[static_cast<std::uint8_t>(bytes[size])];
      if ((sum & kCut) == 0) break;
    }
    blocks.push_back(bytes.substr(0, size));
    bytes.remove_prefix(size);
  }
  return blocks;
}

BlockStore::BlockStore(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code fault;
  if (std::filesystem::exists(std::filesystem::symlink_status(file_, fault))) read_index();
}

void BlockStore::read_index() {
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file_)))
    throw Error(file_.string() + ": is not a plain file");
  std::ifstream in(file_, std::ios::binary);
  std::string head(kMagic.size(), '\0');
  if (!in.read(head.data(), static_cast<std::streamsize>(head.size())) || head != kMagic)
    throw Error(file_.string() + ": does not hold revisions of a map; move it away to go on without them");
  const std::uint64_t size = std::filesystem::file_size(file_);
  end_ = kMagic.size();
  head.resize(kHead_bytes);
  while (end_ + kHead_bytes <= size) {
    in.seekg(static_cast<std::streamoff>(end_));
    if (!in.read(head.data(), static_cast<std::streamsize>(head.size()))) break;
    ByteReader fields(std::string_view(head).substr(kChecksum_bytes), file_.string(), "");
    const auto packed_bytes = fields.number<std::uint32_t>(), bytes = fields.number<std::uint32_t>();
    if (bytes > kMostInOne_bytes || end_ + kHead_bytes + packed_bytes > size) break;
    at_[head.substr(0, kChecksum_bytes)] = {end_ + kHead_bytes, packed_bytes, bytes};
    end_ += kHead_bytes + packed_bytes;
  }
}

std::string BlockStore::read(const std::string& sha256) const {
  const auto fail = [&](const char* fault) {
    throw Error(file_.string() + ": " + fault + "; this revision is lost, the map itself is not");
  };
  const auto found = at_.find(sha256);
  if (found == at_.end() || found->second.at == 0) fail("a block of the revision is missing");
  std::string packed(found->second.packed_bytes, '\0');
  std::ifstream in(file_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(found->second.at));
  if (!in.read(packed.data(), static_cast<std::streamsize>(packed.size()))) fail("a block cannot be read");
  std::optional<UnpackedFrame> frame = unpack_frame(packed);
  if (!frame || frame->bytes.size() != found->second.bytes || sha256_bytes_of(frame->bytes) != sha256)
    fail("a block of the revision is damaged");
  return std::move(frame->bytes);
}

std::string BlockStore::add(std::string_view bytes) {
  std::string sha256 = sha256_bytes_of(bytes);
  if (contains(sha256)) return sha256;
  const std::string packed = compress_frame(bytes);
  const auto packed_bytes = static_cast<std::uint32_t>(packed.size());
  ByteWriter head;
  head(packed_bytes, static_cast<std::uint32_t>(bytes.size()));
  added_.append(sha256).append(head.bytes).append(packed);
  at_[sha256] = {0, packed_bytes, static_cast<std::uint32_t>(bytes.size())};
  return sha256;
}

void BlockStore::append() {
  if (added_.empty()) return;
  const bool is_new = end_ == 0;
  if (!is_new) std::filesystem::resize_file(file_, end_);  // removes a block that was cut off
  std::ofstream out(file_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  if (is_new) out << kMagic;
  out << added_;
  out.flush();
  if (!out) throw Error(file_.string() + ": cannot be written; is the disk full?");
  out.close();
  sync_to_disk(file_);
  added_.clear();
  at_.clear();
  read_index();
}

BlockTree block_tree_of(const std::vector<std::string_view>& blocks) {
  constexpr unsigned kListEnd = 0x3F;  // of the last byte of a checksum: every 64 blocks
  BlockTree tree;
  std::string list;
  for (const std::string_view block : blocks) {
    tree.blocks.push_back(sha256_bytes_of(block));
    list += tree.blocks.back();
    const bool ends = (static_cast<unsigned char>(tree.blocks.back().back()) & kListEnd) == 0;
    if (ends || list.size() + kChecksum_bytes > kMost_bytes) tree.lists.push_back(std::exchange(list, {}));
  }
  if (!list.empty()) tree.lists.push_back(std::move(list));
  for (const std::string& one : tree.lists) tree.root += sha256_bytes_of(one);
  return tree;
}

}  // namespace roomradar
