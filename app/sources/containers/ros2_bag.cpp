// ros2_bag.cpp: reads the tables of an SQLite bag, and merges the files of a bag.
#include "app/sources/containers/ros2_bag.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/mcap.hpp"
#include "app/sources/containers/sqlite_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

bool is_db3(const fs::path& path) { return path.extension() == ".db3" && is_sqlite(path); }

/// Decompresses a message that begins with zstd's magic number. CDR begins with a zero.
std::string unpacked(std::string bytes, const std::string& where) {
  if (!bytes.starts_with("\x28\xB5\x2F\xFD")) return bytes;
  return decompress_up_to(Compression::kZstd, bytes, kMaxBlock_bytes, where + ": a message");
}

MessageLog open_db3(const fs::path& path) {
  const auto database = std::make_shared<SqliteFile>(path);
  MessageLog log{.name = database->name(), .encoding = MessageEncoding::kCdr};
  if (!database->has_tables({"topics", "messages"}))
    throw Error(log.name + ": is not a ROS 2 bag: it lacks the tables topics and messages");
  std::map<std::int64_t, std::uint32_t> topic_of;
  database->query("SELECT id, name, type FROM topics", {}, [&](const SqliteRow& row) {
    topic_of[row.integer(0)] = static_cast<std::uint32_t>(log.topics.size());
    log.topics.push_back({std::string(row.bytes(1)), ros1_type_name(std::string(row.bytes(2)))});
  });
  database->query("SELECT rowid, topic_id, timestamp FROM messages", {}, [&](const SqliteRow& row) {
    const auto topic = topic_of.find(row.integer(1));
    if (topic == topic_of.end()) return;
    log.messages.push_back({1e-9 * static_cast<double>(row.integer(2)), topic->second, 0,
                            static_cast<std::uint64_t>(row.integer(0))});
  });
  log.reads_starts = true;
  log.read_up_to = [database](const MessageEntry& entry, std::uint64_t max_bytes) {
    const auto row = static_cast<std::int64_t>(entry.offset);
    constexpr std::uint64_t kMagic_bytes = 4;
    const bool is_packed =
        database->read_up_to("messages", "data", row, kMagic_bytes).starts_with("\x28\xB5\x2F\xFD");
    return unpacked(database->read_up_to("messages", "data", row, is_packed ? kMaxBlock_bytes : max_bytes),
                    database->name());
  };
  return log;
}

MessageLog open_part(const fs::path& path) { return is_mcap(path) ? open_mcap(path) : open_db3(path); }

/// Returns the files of a bag's folder. bag_10 comes after bag_9.
std::vector<fs::path> parts_of(const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const fs::path& file : entries_of(folder))
    if (is_db3(file) || is_mcap(file)) parts.push_back(file);
  std::sort(parts.begin(), parts.end(), [](const fs::path& a, const fs::path& b) {
    const std::string x = a.string(), y = b.string();
    return std::pair(x.size(), x) < std::pair(y.size(), y);
  });
  return parts;
}

/// Joins logs; topics of the same name become one.
MessageLog joined(std::vector<MessageLog> parts, const std::string& name) {
  const auto logs = std::make_shared<const std::vector<MessageLog>>(std::move(parts));
  MessageLog log{.name = name, .encoding = logs->front().encoding, .reads_starts = true};
  // An entry's block is the number of its part; its `offset` is the number of the message in that part.
  for (std::uint32_t part = 0; part < logs->size(); ++part) {
    const MessageLog& each = (*logs)[part];
    log.reads_starts = log.reads_starts && each.reads_starts;
    std::vector<std::uint32_t> topic_of;
    for (const MessageTopic& topic : each.topics) topic_of.push_back(number_of_topic(topic, log.topics));
    for (std::size_t i = 0; i < each.messages.size(); ++i)
      log.messages.push_back({each.messages[i].stamp_s, topic_of[each.messages[i].topic], part, i});
  }
  log.read_up_to = [logs](const MessageEntry& entry, std::uint64_t max_bytes) {
    const MessageLog& part = (*logs)[entry.block];
    return part.read_up_to(part.messages[entry.offset], max_bytes);
  };
  return log;
}

}  // namespace

bool is_ros2_bag(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return fs::is_regular_file(path / "metadata.yaml", ignored);
  return is_mcap(path) || is_db3(path);
}

MessageLog open_ros2_bag(const fs::path& path) {
  MessageLog log;
  if (fs::is_directory(path)) {
    std::vector<MessageLog> parts;
    for (const fs::path& part : parts_of(path)) parts.push_back(open_part(part));
    if (parts.empty())
      throw Error(
          path.string() +
          ": holds metadata.yaml, but neither .db3 nor .mcap; if it is compressed (.zstd), decompress it "
          "first");
    log = joined(std::move(parts), path.string());
  } else {
    log = open_part(path);
  }
  sort_by_stamp(log);
  return log;
}

}  // namespace roomradar
