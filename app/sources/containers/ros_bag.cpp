// ros_bag.cpp: records of a bag, each a header of named fields, then data.
#include "app/sources/containers/ros_bag.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "app/sources/containers/block_cache.hpp"
#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/random_access_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kRosBagMagic = "#ROSBAG V2.0\n";

/// Record types, the values of a record's field "op".
enum class RosBagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

constexpr std::uint32_t kMaxHeader_bytes = 1U << 20U;
constexpr std::uint32_t kMaxIndex_bytes = 1U << 28U;

template <typename Number>
std::optional<Number> number_at(std::string_view bytes, std::size_t at) {
  if (bytes.size() < sizeof(Number) || at > bytes.size() - sizeof(Number)) return std::nullopt;
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

/// Returns the named fields of a header: a length, then name=value. A damaged header has fewer.
std::map<std::string_view, std::string_view> fields_of(std::string_view header) {
  std::map<std::string_view, std::string_view> fields;
  while (const auto length = number_at<std::uint32_t>(header, 0)) {
    header.remove_prefix(sizeof *length);
    if (*length > header.size()) break;
    const std::string_view field = header.substr(0, *length);
    header.remove_prefix(*length);
    const std::size_t equals = field.find('=');
    if (equals != std::string_view::npos) fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

template <typename Number>
std::optional<Number> field_number(const std::map<std::string_view, std::string_view>& fields,
                                   std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end() || field->second.size() != sizeof(Number)) return std::nullopt;
  return number_at<Number>(field->second, 0);
}

/// A record: its header, and the position of its data.
struct Record {
  std::string header;
  std::map<std::string_view, std::string_view> fields{};  // refer to `header`
  RosBagOp op{};                                          ///< 0: damaged
  std::uint64_t data_offset = 0;
  std::uint32_t data_bytes = 0;
};

/// Reads the header of the record at `offset`; null if it is incomplete. read(offset, count) returns at most
/// `count` bytes.
template <typename Read>
std::unique_ptr<Record> record_at(std::uint64_t offset, const Read& read) {
  const std::string length = read(offset, 4);
  const auto header_bytes = number_at<std::uint32_t>(length, 0);
  if (!header_bytes || *header_bytes > kMaxHeader_bytes) return nullptr;
  auto record = std::make_unique<Record>();
  record->header = read(offset + 4, std::uint64_t{*header_bytes} + 4);
  const auto data_bytes = number_at<std::uint32_t>(record->header, *header_bytes);
  if (!data_bytes) return nullptr;
  record->fields = fields_of(std::string_view(record->header).substr(0, *header_bytes));
  record->op = field_number<RosBagOp>(record->fields, "op").value_or(RosBagOp{});
  record->data_offset = offset + 8 + *header_bytes;
  record->data_bytes = *data_bytes;
  return record;
}

double seconds_of(std::uint64_t time) {
  return static_cast<double>(time & 0xFFFFFFFFU) + 1e-9 * static_cast<double>(time >> 32U);
}

/// Returns a chunk's description; nullopt for a compression that is not known.
std::optional<PackedBlock> chunk_of(const Record& record) {
  const auto named = record.fields.find("compression");
  const auto bytes = field_number<std::uint32_t>(record.fields, "size");
  if (named == record.fields.end() || !bytes) return std::nullopt;
  PackedBlock chunk{record.data_offset, record.data_bytes, *bytes, Compression::kNone};
  if (named->second == "bz2")
    chunk.compression = Compression::kBz2;
  else if (named->second == "lz4")
    chunk.compression = Compression::kLz4;
  else if (named->second != "none" || chunk.bytes != chunk.packed_bytes)
    return std::nullopt;
  return chunk;
}

class Bag {
 public:
  explicit Bag(const std::filesystem::path& path) : file_(path) {
    const std::string magic = file_.read_up_to(0, kRosBagMagic.size());
    if (magic != kRosBagMagic)
      throw Error(
          file_.name() +
          (magic.starts_with("#ROSBAG V")
               ? ": is a bag of a version other than 2.0; `rosbag migrate` or `rosbag fix` converts it"
               : ": is not a bag of ROS 1"));
    walk();
  }

  [[nodiscard]] const std::string& name() const { return file_.name(); }
  std::vector<MessageTopic> topics;
  std::vector<MessageEntry> messages;

  [[nodiscard]] bool is_uncompressed() const {
    for (const PackedBlock& chunk : chunks_)
      if (chunk.compression != Compression::kNone) return false;
    return true;
  }

  std::string read_up_to(const MessageEntry& entry, std::uint64_t max_bytes) {
    const PackedBlock& chunk = chunks_[entry.block];
    if (chunk.compression == Compression::kNone) {
      const std::uint64_t end = chunk.offset + chunk.bytes;
      const auto read = [&](std::uint64_t offset, std::uint64_t count) {
        return file_.read_up_to(offset, offset < end ? std::min(count, end - offset) : 0);
      };
      const auto record = message_at(chunk.offset + entry.offset, read, end);
      return file_.read(record->data_offset, std::min<std::uint64_t>(max_bytes, record->data_bytes));
    }
    const std::string& bytes = decompressed(entry.block);
    const auto read = [&](std::uint64_t offset, std::uint64_t count) {
      return offset < bytes.size() ? bytes.substr(offset, count) : std::string{};
    };
    const auto record = message_at(entry.offset, read, bytes.size());
    return bytes.substr(record->data_offset, std::min<std::uint64_t>(max_bytes, record->data_bytes));
  }

 private:
  /// Returns the message record at an offset, or throws Error if there is none that ends before `end`.
  template <typename Read>
  std::unique_ptr<Record> message_at(std::uint64_t offset, const Read& read, std::uint64_t end) const {
    auto record = record_at(offset, read);
    if (!record || record->op != RosBagOp::kMessage || record->data_offset > end ||
        record->data_bytes > end - record->data_offset)
      throw Error(file_.name() + ": is damaged: no message is at a place where its index says so");
    return record;
  }

  const std::string& decompressed(std::uint32_t number) { return cache_.get(number, file_, chunks_[number]); }

  void walk() {
    const auto read = [this](std::uint64_t offset, std::uint64_t count) {
      return file_.read_up_to(offset, count);
    };
    std::map<std::uint32_t, std::uint32_t> topic_of;  // by connection
    struct Unnamed {
      std::uint32_t connection;
      MessageEntry entry;
    };
    std::vector<Unnamed> entries;
    for (std::uint64_t at = kRosBagMagic.size(); at < file_.size();) {
      const auto record = record_at(at, read);
      if (!record || !file_.has(record->data_offset, record->data_bytes)) break;  // the recorder was stopped
      at = record->data_offset + record->data_bytes;
      if (record->op == RosBagOp::kConnection) {
        add_connection(*record,
                       file_.read(record->data_offset, std::min(record->data_bytes, kMaxHeader_bytes)),
                       topic_of);
      } else if (record->op == RosBagOp::kChunk) {
        const auto chunk = chunk_of(*record);
        if (!chunk)
          throw Error(file_.name() + ": the chunk at byte " + std::to_string(record->data_offset) +
                      " is damaged, or its compression is not none, bz2 or lz4");
        chunks_.push_back(*chunk);
      } else if (record->op == RosBagOp::kIndex && !chunks_.empty()) {
        const auto connection = field_number<std::uint32_t>(record->fields, "conn");
        const auto version = field_number<std::uint32_t>(record->fields, "ver");
        if (!connection || version != 1 || record->data_bytes > kMaxIndex_bytes) continue;
        const std::string data = file_.read(record->data_offset, record->data_bytes);
        constexpr std::size_t kEntry_bytes = 12;
        for (std::size_t i = 0; i + kEntry_bytes <= data.size(); i += kEntry_bytes)
          entries.push_back(
              {*connection,
               {seconds_of(*number_at<std::uint64_t>(data, i)), 0,
                static_cast<std::uint32_t>(chunks_.size() - 1), *number_at<std::uint32_t>(data, i + 8)}});
      }
    }
    if (chunks_.empty()) throw Error(file_.name() + ": contains no complete chunk; is it cut short?");
    // A bag without its last part names connections in its chunks only.
    std::optional<std::uint32_t> searched;
    for (const Unnamed& each : entries) {
      if (topic_of.contains(each.connection) || searched == each.entry.block) continue;
      searched = each.entry.block;
      find_connections(each.entry.block, topic_of);
    }
    for (Unnamed& each : entries) {
      const auto topic = topic_of.find(each.connection);
      if (topic == topic_of.end()) continue;
      each.entry.topic = topic->second;
      messages.push_back(each.entry);
    }
  }

  /// Adds the connections in a chunk.
  void find_connections(std::uint32_t number, std::map<std::uint32_t, std::uint32_t>& topic_of) {
    const PackedBlock& chunk = chunks_[number];
    const std::string stored =
        chunk.compression == Compression::kNone ? file_.read(chunk.offset, chunk.bytes) : std::string{};
    const std::string& bytes = chunk.compression == Compression::kNone ? stored : decompressed(number);
    const auto read = [&](std::uint64_t offset, std::uint64_t count) {
      return offset < bytes.size() ? bytes.substr(offset, count) : std::string{};
    };
    for (std::uint64_t at = 0; at < bytes.size();) {
      const auto record = record_at(at, read);
      if (!record || record->data_offset + record->data_bytes > bytes.size()) return;
      at = record->data_offset + record->data_bytes;
      if (record->op == RosBagOp::kConnection)
        add_connection(*record, bytes.substr(record->data_offset, record->data_bytes), topic_of);
    }
  }

  void add_connection(const Record& record, const std::string& data,
                      std::map<std::uint32_t, std::uint32_t>& topic_of) {
    const auto connection = field_number<std::uint32_t>(record.fields, "conn");
    const auto topic = record.fields.find("topic");
    const auto described = fields_of(data);
    const auto type = described.find("type");
    if (!connection || topic == record.fields.end() || type == described.end() ||
        topic_of.contains(*connection))
      return;
    // Several programs may publish on one topic, each through its own connection.
    topic_of[*connection] = number_of_topic({std::string(topic->second), std::string(type->second)}, topics);
  }

  RandomAccessFile file_;
  std::vector<PackedBlock> chunks_;
  BlockCache cache_;
};

static_assert(std::endian::native == std::endian::little, "bags are little-endian");
constexpr std::size_t kChunk_bytes = 4U << 20U;
constexpr std::size_t kBagHeader_bytes = 4096;

template <typename Number>
std::string bytes_of(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string field(std::string_view name, std::string_view value) {
  const std::string text = std::string(name) + '=' + std::string(value);
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}
std::string op_field(RosBagOp op) { return field("op", bytes_of(op)); }

std::string record(const std::string& fields, std::string_view data) {
  std::string bytes = bytes_of(static_cast<std::uint32_t>(fields.size())) + fields +
                      bytes_of(static_cast<std::uint32_t>(data.size()));
  return bytes.append(data);
}

std::uint64_t sortable(std::uint64_t time) { return time << 32U | time >> 32U; }

}  // namespace

bool is_ros_bag(const std::filesystem::path& path) { return begins_with(path, "#ROSBAG V"); }

MessageLog open_ros_bag(const std::filesystem::path& path) {
  const auto bag = std::make_shared<Bag>(path);
  MessageLog log{.name = bag->name(), .encoding = MessageEncoding::kRos1, .topics = bag->topics};
  log.messages = std::move(bag->messages);
  log.reads_starts = bag->is_uncompressed();
  log.read_up_to = [bag](const MessageEntry& entry, std::uint64_t max_bytes) {
    return bag->read_up_to(entry, max_bytes);
  };
  sort_by_stamp(log);
  return log;
}

std::uint64_t ros_time(double stamp_s) {
  if (!(stamp_s >= 0.0 && stamp_s < 4294967295.0))
    throw Error("the stamp " + format_fixed(stamp_s, 6) +
                " s cannot be stored in a bag: must be 0 to 4294967295 s");
  auto seconds = static_cast<std::uint64_t>(stamp_s);
  auto nanoseconds = static_cast<std::uint64_t>(std::llround((stamp_s - static_cast<double>(seconds)) * 1e9));
  if (nanoseconds >= 1'000'000'000) {
    ++seconds;
    nanoseconds = 0;
  }
  return nanoseconds << 32U | seconds;
}

RosBagWriter::RosBagWriter(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  put(kRosBagMagic);
  write_bag_header(0);
}

void RosBagWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require_written(file_, path_);
  position_ += bytes.size();
}

void RosBagWriter::write_bag_header(std::uint64_t index_position) {
  const std::string fields = op_field(RosBagOp::kBagHeader) + field("index_pos", bytes_of(index_position)) +
                             field("conn_count", bytes_of(static_cast<std::uint32_t>(connections_.size()))) +
                             field("chunk_count", bytes_of(static_cast<std::uint32_t>(chunks_.size())));
  put(record(fields, std::string(kBagHeader_bytes - fields.size() - 8, ' ')));
}

std::uint32_t RosBagWriter::add_topic(std::string_view name, const RosType& type) {
  const auto number = static_cast<std::uint32_t>(connections_.size());
  connections_.push_back(
      record(op_field(RosBagOp::kConnection) + field("conn", bytes_of(number)) + field("topic", name),
             field("topic", name) + field("type", type.name) + field("md5sum", type.md5) +
                 field("message_definition", type.definition)));
  return number;
}

void RosBagWriter::write(std::uint32_t topic, std::uint64_t time, std::string_view message) {
  if (chunk_.size() >= kChunk_bytes) write_chunk();
  if (!index_.contains(topic)) chunk_ += connections_[topic];
  index_[topic].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  chunk_ += record(
      op_field(RosBagOp::kMessage) + field("conn", bytes_of(topic)) + field("time", bytes_of(time)), message);
}

void RosBagWriter::write_chunk() {
  if (chunk_.empty()) return;
  ChunkInfo info{position_, ~std::uint64_t{0}, 0, {}};
  put(record(op_field(RosBagOp::kChunk) + field("compression", "none") +
                 field("size", bytes_of(static_cast<std::uint32_t>(chunk_.size()))),
             chunk_));
  for (const auto& [topic, messages] : index_) {
    std::string data;
    for (const Indexed& message : messages) {
      data += bytes_of(message.time) + bytes_of(message.offset);
      info.first_time = std::min(info.first_time, sortable(message.time));
      info.last_time = std::max(info.last_time, sortable(message.time));
    }
    const auto count = static_cast<std::uint32_t>(messages.size());
    info.counts[topic] = count;
    put(record(op_field(RosBagOp::kIndex) + field("ver", bytes_of(std::uint32_t{1})) +
                   field("conn", bytes_of(topic)) + field("count", bytes_of(count)),
               data));
  }
  file_.flush();
  chunks_.push_back(std::move(info));
  chunk_.clear();
  index_.clear();
}

void RosBagWriter::close() {
  write_chunk();
  const std::uint64_t index_position = position_;
  for (const std::string& connection : connections_) put(connection);
  for (const ChunkInfo& chunk : chunks_) {
    std::string data;
    for (const auto& [topic, count] : chunk.counts) data += bytes_of(topic) + bytes_of(count);
    put(record(op_field(RosBagOp::kChunkInfo) + field("ver", bytes_of(std::uint32_t{1})) +
                   field("chunk_pos", bytes_of(chunk.position)) +
                   field("start_time", bytes_of(sortable(chunk.first_time))) +
                   field("end_time", bytes_of(sortable(chunk.last_time))) +
                   field("count", bytes_of(static_cast<std::uint32_t>(chunk.counts.size()))),
               data));
  }
  file_.seekp(static_cast<std::streamoff>(kRosBagMagic.size()));
  write_bag_header(index_position);
  file_.close();
  require_written(file_, path_);
}

}  // namespace roomradar
