// ros_bag_writer.cpp: writes records: a header of named fields, then data.
#include "app/sources/containers/ros_bag_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "app/sources/containers/ros_bag_format.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

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
