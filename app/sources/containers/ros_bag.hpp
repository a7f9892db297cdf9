// ros_bag.hpp: ROS 1 bags, including recordings of RealSense cameras: reading and writing.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/containers/message_log.hpp"

namespace roomradar {

/// Returns true if the file begins with the signature of ROS 1 bags.
[[nodiscard]] bool is_ros_bag(const std::filesystem::path& path);

/// Opens a bag (format 2.0) and lists its messages from the index records that follow each chunk. A chunk is
/// read only when one of its messages is read. A compressed chunk (bz2, lz4) is then decompressed completely.
/// A truncated bag, as after a killed recorder, is read up to its last complete chunk.
/// @throws Error naming the file if it is not a bag of this version, or contains no complete chunk
/// Source: wiki.ros.org/Bags/Format/2.0.
MessageLog open_ros_bag(const std::filesystem::path& path);

/// A ROS message type.
struct RosType {
  std::string_view name;        ///< such as "sensor_msgs/Image"
  std::string_view md5;         ///< MD5 sum of the message definition, 32 hexadecimal digits
  std::string_view definition;  ///< message definition, including the definitions of nested types
};

/// Writes a bag (format 2.0) of uncompressed chunks of about 4 MiB, with an index after each chunk and one at
/// the end.
class RosBagWriter {
 public:
  /// Throws Error if the file cannot be written.
  explicit RosBagWriter(const std::filesystem::path& path);

  /// Adds a topic and returns its index, from 0.
  std::uint32_t add_topic(std::string_view name, const RosType& type);
  /// Appends a message, encoded for ROS 1. `time` has seconds in the lower 32 bits, nanoseconds above, see
  /// ros_time(). Throws Error if the file cannot be written.
  void write(std::uint32_t topic, std::uint64_t time, std::string_view message);
  /// Writes the last chunk and the index. A bag without close() can be read up to its last complete chunk.
  /// Throws Error if the file cannot be written.
  void close();

 private:
  struct Indexed {
    std::uint64_t time;
    std::uint32_t offset;
  };
  struct ChunkInfo {
    std::uint64_t position, first_time, last_time;
    std::map<std::uint32_t, std::uint32_t> counts;  // by topic
  };
  void write_chunk();
  void write_bag_header(std::uint64_t index_position);
  void put(std::string_view bytes);

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t position_ = 0;
  std::vector<std::string> connections_;  // records, by topic
  std::string chunk_;
  std::map<std::uint32_t, std::vector<Indexed>> index_;  // index of the current chunk, by topic
  std::vector<ChunkInfo> chunks_;
};

/// Returns a stamp as ROS stores it, to 1 ns. Throws Error if it is negative or beyond the year 2106.
std::uint64_t ros_time(double stamp_s);

}  // namespace roomradar
