// message_log.hpp: time-stamped messages on topics, as in ROS 1 and ROS 2 bags.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace roomradar {

struct MessageTopic {
  std::string name;  ///< such as "/camera/depth/image_raw"
  std::string type;  ///< such as "sensor_msgs/Image", without the "/msg" of ROS 2
};

/// Location of a message that has not been read. Each container format defines the meaning of `block` and
/// `offset`.
struct MessageEntry {
  double stamp_s = 0.0;  ///< time at which the recorder received the message
  std::uint32_t topic = 0;
  std::uint32_t block = 0;
  std::uint64_t offset = 0;
};

/// Encoding of the messages.
enum class MessageEncoding { kRos1, kCdr };

/// A recording's topics, the locations of its messages, and the function that reads a message from disk.
struct MessageLog {
  std::string name{};
  MessageEncoding encoding = MessageEncoding::kRos1;
  std::vector<MessageTopic> topics{};
  std::vector<MessageEntry> messages{};  ///< sorted by stamp
  /// True if the first bytes of a message can be read without reading, or decompressing, much more.
  bool reads_starts = false;
  /// Returns the bytes of a message, at most max_bytes of them. Throws Error if they cannot be read.
  std::function<std::string(const MessageEntry&, std::uint64_t max_bytes)> read_up_to{};

  [[nodiscard]] std::string read(const MessageEntry& entry) const {
    return read_up_to(entry, std::numeric_limits<std::uint64_t>::max());
  }
};

/// Returns a type's name as ROS 1 writes it: without the "/msg" of ROS 2.
[[nodiscard]] std::string ros1_type_name(std::string type);

/// Returns the index of the topic with this name in `topics`. Appends the topic if no topic has the name.
std::uint32_t number_of_topic(const MessageTopic& topic, std::vector<MessageTopic>& topics);

/// Returns the messages of a topic, in the log's order.
[[nodiscard]] std::vector<MessageEntry> messages_of(const MessageLog& log, std::uint32_t topic);

/// Sorts the messages by stamp. Messages with equal stamps keep their order.
void sort_by_stamp(MessageLog& log);

}  // namespace roomradar
