// mcap.cpp: parses the records of a file: type, length, content.
#include "app/sources/containers/mcap.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "app/sources/containers/block_cache.hpp"
#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/random_access_file.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::uint8_t kSchemaRecord = 3, kChannelRecord = 4, kMessageRecord = 5, kChunkRecord = 6,
                       kMessageIndexRecord = 7;
constexpr std::uint64_t kRecordHead_bytes = 9;    // kind and length
constexpr std::uint64_t kMessageHead_bytes = 22;  // channel, sequence, two times
constexpr std::uint64_t kMaxRecord_bytes = 1U << 26U;
constexpr std::uint32_t kNoChunk = 0xFFFFFFFF;

std::string next_text(ByteReader& reader) { return std::string(reader.take(reader.number<std::uint32_t>())); }

struct McapChannel {
  std::uint16_t schema = 0;
  std::string topic, encoding;
};

class Mcap {
 public:
  explicit Mcap(const std::filesystem::path& path) : file_(path) {
    if (file_.read_up_to(0, kMcapMagic.size()) != kMcapMagic)
      throw Error(file_.name() + ": is not an MCAP file");
    walk();
  }

  /// Moves topics and messages to a log.
  MessageLog take_log() {
    MessageLog log{.name = file_.name()};
    const bool has_cdr = std::any_of(channels_.begin(), channels_.end(),
                                     [](const auto& channel) { return channel.second.encoding == "cdr"; });
    log.encoding = has_cdr ? MessageEncoding::kCdr : MessageEncoding::kRos1;
    const std::string_view wanted = has_cdr ? "cdr" : "ros1";
    std::map<std::uint16_t, std::uint32_t> topic_of;
    for (const auto& [id, channel] : channels_) {
      if (channel.encoding != wanted || !schemas_.contains(channel.schema)) continue;
      topic_of[id] = static_cast<std::uint32_t>(log.topics.size());
      log.topics.push_back({channel.topic, ros1_type_name(schemas_[channel.schema])});
    }
    for (MessageEntry& entry : messages_) {
      const auto topic = topic_of.find(static_cast<std::uint16_t>(entry.topic));
      if (topic == topic_of.end()) continue;
      entry.topic = topic->second;
      log.messages.push_back(entry);
    }
    log.reads_starts = std::all_of(chunks_.begin(), chunks_.end(), [](const PackedBlock& chunk) {
      return chunk.compression == Compression::kNone;
    });
    return log;
  }

  std::string read_up_to(const MessageEntry& entry, std::uint64_t max_bytes) {
    const bool in_file = entry.block == kNoChunk || chunks_[entry.block].compression == Compression::kNone;
    const std::uint64_t begin = entry.block == kNoChunk ? 0 : chunks_[entry.block].offset;
    const std::uint64_t end = entry.block == kNoChunk ? file_.size() : begin + chunks_[entry.block].bytes;
    const std::string* bytes = in_file ? nullptr : &decompressed(entry.block);
    const auto read = [&](std::uint64_t offset, std::uint64_t count) {
      if (in_file) {
        if (begin + offset > end || count > end - begin - offset) damaged_index();
        return file_.read(begin + offset, count);
      }
      if (offset > bytes->size() || count > bytes->size() - offset) damaged_index();
      return bytes->substr(offset, count);
    };
    if (entry.offset > end) damaged_index();
    const std::string head = read(entry.offset, kRecordHead_bytes);
    ByteReader reader(head, file_.name());
    if (reader.number<std::uint8_t>() != kMessageRecord) damaged_index();
    const auto length = reader.number<std::uint64_t>();
    if (length < kMessageHead_bytes || length > kMaxBlock_bytes) damaged_index();
    return read(entry.offset + kRecordHead_bytes + kMessageHead_bytes,
                std::min(max_bytes, length - kMessageHead_bytes));
  }

 private:
  [[noreturn]] void damaged_index() const {
    throw Error(file_.name() + ": is damaged: no message is at a place where its index says so");
  }

  const std::string& decompressed(std::uint32_t number) { return cache_.get(number, file_, chunks_[number]); }

  void walk() {
    std::set<std::uint32_t> indexed;  // chunks with a message index
    for (std::uint64_t at = kMcapMagic.size(); file_.has(at, kRecordHead_bytes);) {
      const std::string head = file_.read(at, kRecordHead_bytes);
      ByteReader reader(head, file_.name());
      const auto kind = reader.number<std::uint8_t>();
      const auto length = reader.number<std::uint64_t>();
      const std::uint64_t content = at + kRecordHead_bytes;
      if (!file_.has(content, length)) break;  // the recorder was stopped
      if (kind == kMessageRecord && length >= kMessageHead_bytes) {
        add_message(file_.read(content, kMessageHead_bytes), kNoChunk, at);
      } else if (kind == kChunkRecord) {
        add_chunk(content, length);
      } else if ((kind == kSchemaRecord || kind == kChannelRecord || kind == kMessageIndexRecord) &&
                 length <= kMaxRecord_bytes) {
        const std::string bytes = file_.read(content, length);
        if (kind == kMessageIndexRecord) {
          if (chunks_.empty()) throw Error(file_.name() + ": is damaged: an index is not after a chunk");
          const auto chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
          add_index(bytes, chunk);
          indexed.insert(chunk);
        } else {
          add_description(kind, bytes);
        }
      }
      at = content + length;
    }
    for (std::uint32_t chunk = 0; chunk < chunks_.size(); ++chunk)
      if (!indexed.contains(chunk)) scan_chunk(chunk, /*messages_too=*/true);
    // A file without its summary describes its channels only in its chunks.
    std::optional<std::uint32_t> scanned;
    for (std::size_t i = 0; i < messages_.size(); ++i) {
      const MessageEntry entry = messages_[i];
      if (entry.block == kNoChunk || scanned == entry.block ||
          channels_.contains(static_cast<std::uint16_t>(entry.topic)))
        continue;
      scanned = entry.block;
      scan_chunk(entry.block, /*messages_too=*/false);
    }
  }

  void add_chunk(std::uint64_t content, std::uint64_t length) {
    constexpr std::uint64_t kMaxHead_bytes = 128;
    const std::string bytes = file_.read(content, std::min(length, kMaxHead_bytes));
    ByteReader reader(bytes, file_.name());
    (void)reader.take(16);  // first and last time
    PackedBlock chunk;
    chunk.bytes = reader.number<std::uint64_t>();
    (void)reader.number<std::uint32_t>();  // check sum
    const std::string compression = next_text(reader);
    chunk.packed_bytes = reader.number<std::uint64_t>();
    const std::uint64_t head_bytes = bytes.size() - reader.left();
    chunk.offset = content + head_bytes;
    if (compression == "lz4")
      chunk.compression = Compression::kLz4;
    else if (compression == "zstd")
      chunk.compression = Compression::kZstd;
    else if (!compression.empty())
      throw Error(file_.name() + ": is compressed by '" + compression.substr(0, 40) +
                  "'; must be none, lz4 or zstd");
    if (chunk.packed_bytes > length - head_bytes ||
        (chunk.compression == Compression::kNone && chunk.bytes != chunk.packed_bytes))
      throw Error(file_.name() + ": is damaged: a chunk's sizes disagree");
    chunks_.push_back(chunk);
  }

  void add_index(const std::string& bytes, std::uint32_t chunk) {
    ByteReader reader(bytes, file_.name());
    const auto channel = reader.number<std::uint16_t>();
    const auto array_bytes = reader.number<std::uint32_t>();
    constexpr std::uint32_t kEntry_bytes = 16;
    for (std::uint32_t i = 0; i + kEntry_bytes <= array_bytes; i += kEntry_bytes) {
      const auto time_ns = reader.number<std::uint64_t>();
      messages_.push_back(
          {1e-9 * static_cast<double>(time_ns), channel, chunk, reader.number<std::uint64_t>()});
    }
  }

  void add_message(const std::string& head, std::uint32_t chunk, std::uint64_t offset) {
    ByteReader reader(head, file_.name());
    const auto channel = reader.number<std::uint16_t>();
    (void)reader.number<std::uint32_t>();  // sequence number
    messages_.push_back({1e-9 * static_cast<double>(reader.number<std::uint64_t>()), channel, chunk, offset});
  }

  void add_description(std::uint8_t kind, std::string_view bytes) {
    ByteReader reader(bytes, file_.name());
    const auto id = reader.number<std::uint16_t>();
    if (kind == kSchemaRecord) {
      schemas_.try_emplace(id, next_text(reader));
      return;
    }
    McapChannel channel;
    channel.schema = reader.number<std::uint16_t>();
    channel.topic = next_text(reader);
    channel.encoding = next_text(reader);
    channels_.try_emplace(id, channel);
  }

  /// Reads the channels in a chunk, and its messages if it has no index.
  void scan_chunk(std::uint32_t number, bool messages_too) {
    const std::string bytes = decompressed(number);
    ByteReader reader(bytes, file_.name());
    while (reader.left() >= kRecordHead_bytes) {
      const std::uint64_t offset = bytes.size() - reader.left();
      const auto kind = reader.number<std::uint8_t>();
      const auto length = reader.number<std::uint64_t>();
      const std::string_view content = reader.take(length);
      if (kind == kSchemaRecord || kind == kChannelRecord) add_description(kind, content);
      if (kind == kMessageRecord && messages_too && length >= kMessageHead_bytes)
        add_message(std::string(content.substr(0, kMessageHead_bytes)), number, offset);
    }
  }

  RandomAccessFile file_;
  std::vector<PackedBlock> chunks_;
  std::map<std::uint16_t, std::string> schemas_;  // names of types
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<MessageEntry> messages_;  // `topic` is the channel
  BlockCache cache_;
};

}  // namespace

bool is_mcap(const std::filesystem::path& path) { return begins_with(path, kMcapMagic); }

MessageLog open_mcap(const std::filesystem::path& path) {
  const auto mcap = std::make_shared<Mcap>(path);
  MessageLog log = mcap->take_log();
  log.read_up_to = [mcap](const MessageEntry& entry, std::uint64_t max_bytes) {
    return mcap->read_up_to(entry, max_bytes);
  };
  sort_by_stamp(log);
  return log;
}

}  // namespace roomradar
