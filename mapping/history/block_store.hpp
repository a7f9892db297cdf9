// block_store.hpp: blocks of bytes by their checksum, in one file that only grows.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace roomradar {

/// Cuts bytes into blocks of 1 to 64 kB, 5 kB on average, at places that the bytes around them determine: a
/// local change changes the blocks that it touches, and no others. Source: Xia et al., FastCDC, USENIX ATC
/// 2016.
std::vector<std::string_view> cut_into_blocks(std::string_view bytes);

/// Blocks by their SHA-256 (32 bytes). Blocks are appended, never changed; an end that was cut off while a
/// block was appended is passed over, and replaced by the next. Not thread safe, and one writer at a time.
class BlockStore {
 public:
  /// Opens the file, which may be missing: then the store is empty. Throws Error if it is no store.
  explicit BlockStore(std::filesystem::path file);

  [[nodiscard]] bool contains(const std::string& sha256) const { return at_.contains(sha256); }
  /// Returns a block after comparing its checksum. Throws Error if it is missing or damaged.
  [[nodiscard]] std::string read(const std::string& sha256) const;
  /// Adds a block, which append() writes, unless the store has it. Returns its SHA-256.
  std::string add(std::string_view bytes);
  /// Appends the blocks added since, and waits until they are on disk. Throws Error if the disk fails.
  void append();

 private:
  struct Place {
    std::uint64_t at = 0;  ///< of the packed bytes in the file; 0: still to be appended
    std::uint32_t packed_bytes = 0, bytes = 0;
  };
  std::filesystem::path file_;
  std::unordered_map<std::string, Place> at_;
  std::uint64_t end_ = 0;  ///< of the last whole block in the file
  std::string added_;      ///< blocks to be appended

  void read_index();
};

/// Checksums of a file's blocks. Lists of checksums are blocks, too, and `root` is the list of these lists:
/// a change of one block changes one list and the root.
struct BlockTree {
  std::vector<std::string> blocks;  ///< SHA-256 of each block, in order
  std::vector<std::string> lists;   ///< contents of the lists: 32 bytes for each of their blocks
  std::string root;                 ///< contents of the root: 32 bytes for each list
};
BlockTree block_tree_of(const std::vector<std::string_view>& blocks);

}  // namespace roomradar
