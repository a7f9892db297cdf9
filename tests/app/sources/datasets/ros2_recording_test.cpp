// ros2_recording_test.cpp: bags of ROS 2 as databases and MCAP files, written by their published formats.
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::ros2_recording_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

/// A message in little-endian CDR: numbers are aligned to their size, after four bytes that say so.
struct Cdr {
  std::string bytes = std::string("\0\1\0\0", 4);

  template <typename Number>
  Cdr& add(Number number) {
    while ((bytes.size() - 4) % sizeof number != 0) bytes += '\0';
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  Cdr& text(std::string_view characters) {
    add(static_cast<std::uint32_t>(characters.size() + 1));
    bytes += characters;
    bytes += '\0';
    return *this;
  }
  Cdr& data(std::string_view content) {
    add(static_cast<std::uint32_t>(content.size()));
    bytes += content;
    return *this;
  }
  Cdr& header(double stamp_s, std::string_view frame_id) {
    add(static_cast<std::int32_t>(stamp_s))
        .add(static_cast<std::uint32_t>(std::llround((stamp_s - std::floor(stamp_s)) * 1e9)));
    return text(frame_id);
  }
  Cdr& doubles(const std::vector<double>& values) {
    for (const double value : values) add(value);
    return *this;
  }
};

struct Message {
  std::string topic, type;
  std::int64_t time_ns;
  std::string bytes;
};

constexpr int kWidth = 5, kHeight = 3, kFrames = 4;  // odd sizes shift the alignment

/// Depth of 16 bit and tf of a camera that moves along x by 1 m/s.
std::vector<Message> some_messages() {
  std::vector<Message> messages;
  Cdr info;
  info.header(10, "depth_optical").add(std::uint32_t{kHeight}).add(std::uint32_t{kWidth}).text("plumb_bob");
  info.add(std::uint32_t{5}).doubles(std::vector<double>(5)).doubles({6, 0, 2, 0, 7, 1, 0, 0, 1});
  info.doubles(std::vector<double>(9)).doubles(std::vector<double>(12));
  messages.push_back({"/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", 10'000'000'000, info.bytes});
  for (int i = 0; i < kFrames; ++i) {
    const double stamp_s = 10.0 + i / 32.0;
    const auto time_ns = static_cast<std::int64_t>(stamp_s * 1e9) + 20'000'000;
    std::string units;
    for (int p = 0; p < kWidth * kHeight; ++p)
      units += std::string{static_cast<char>(p), static_cast<char>(8 + i)};
    Cdr image;
    image.header(stamp_s, "depth_optical")
        .add(std::uint32_t{kHeight})
        .add(std::uint32_t{kWidth})
        .text("16UC1");
    image.add(std::uint8_t{0}).add(std::uint32_t{2 * kWidth}).data(units);
    Cdr tf;
    tf.add(std::uint32_t{1})
        .header(stamp_s, "map")
        .text("depth_optical")
        .doubles({stamp_s, 2, 3, 0, 0, 0, 1});
    messages.push_back({"/tf", "tf2_msgs/msg/TFMessage", time_ns, tf.bytes});
    messages.push_back({"/camera/depth/image_raw", "sensor_msgs/msg/Image", time_ns, image.bytes});
  }
  return messages;
}

void expect_some_frames(const fs::path& path) {
  const auto source = open_folder(path);
  EXPECT_EQ(source->frame_count(), kFrames);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames))
      << (all.faults.empty() ? "" : all.faults[0]);
  for (int i = 0; i < kFrames; ++i) {
    const Frame& frame = all.frames[static_cast<std::size_t>(i)];
    EXPECT_NEAR(frame.stamp_s, 10.0 + i / 32.0, 1e-6);
    EXPECT_EQ(frame.depth_m.at(2, 1), static_cast<float>((8 + i) * 256 + 7) / 1000.0F);
    EXPECT_EQ(frame.depth_camera, (Intrinsics{5, 3, 6, 7, 2, 1}));
    ASSERT_TRUE(frame.T_world_camera) << i;
    EXPECT_NEAR(frame.T_world_camera->translation().x(), 10.0 + i / 32.0, 1e-6);
  }
  Frame frame;
  ASSERT_TRUE(source->seek(2));
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 2);
}

/// The same messages, whose images have the header's stamps that `stamp_s` returns.
std::vector<Message> with_stamps(const std::function<double(int image, double stamp_s)>& stamp_s) {
  std::vector<Message> messages = some_messages();
  int image = 0;
  for (Message& message : messages) {
    if (message.type != "sensor_msgs/msg/Image") continue;
    const double stamp = stamp_s(image, 10.0 + image / 32.0);
    const auto s = static_cast<std::int32_t>(std::floor(stamp));
    const auto ns = static_cast<std::uint32_t>(std::llround((stamp - s) * 1e9));
    std::memcpy(message.bytes.data() + 4, &s, sizeof s);
    std::memcpy(message.bytes.data() + 8, &ns, sizeof ns);
    ++image;
  }
  return messages;
}

// ---- databases ----

std::string zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

std::string lz4(const std::string& bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

void write_db3(const fs::path& path, const std::vector<Message>& messages, bool is_packed = false) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(
      database,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
      "data BLOB NOT NULL)",
      nullptr, nullptr, nullptr);
  std::map<std::string, int> topics;
  for (const Message& message : messages) {
    const auto [topic, is_new] = topics.try_emplace(message.topic, static_cast<int>(topics.size()) + 1);
    if (is_new)
      sqlite3_exec(database,
                   ("INSERT INTO topics VALUES(" + std::to_string(topic->second) + ",'" + message.topic +
                    "','" + message.type + "','cdr','')")
                       .c_str(),
                   nullptr, nullptr, nullptr);
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1,
                       &insert, nullptr);
    const std::string bytes = is_packed ? zstd(message.bytes) : message.bytes;
    sqlite3_bind_int(insert, 1, topic->second);
    sqlite3_bind_int64(insert, 2, message.time_ns);
    sqlite3_bind_blob(insert, 3, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  sqlite3_close(database);
}

TEST(Ros2Bag, ReadsADatabase) {
  const TemporaryFolder folder;
  write_db3(folder.path() / "a.db3", some_messages());
  expect_some_frames(folder.path() / "a.db3");
  write_db3(folder.path() / "b.db3", some_messages(), /*is_packed=*/true);
  expect_some_frames(folder.path() / "b.db3");
}

TEST(Ros2Bag, HeadersWithoutAStampAreReplacedByTheTimeOfReception) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::function<double(int, double)>& stamp_s, const std::string& words) {
    const fs::path path = folder.path() / "a.db3";
    fs::remove(path);
    write_db3(path, with_stamps(stamp_s));
    test::ReadAll all;
    const std::string said =
        test::decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
    EXPECT_TRUE(contains(said, words)) << said;
    ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames)) << said;
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_EQ(all.frames[i].depth_m.at(2, 1), static_cast<float>((8 + i) * 256 + 7) / 1000.0F);
      EXPECT_NEAR(all.frames[i].stamp_s - all.frames[0].stamp_s, static_cast<double>(i) / 32.0, 0.021);
    }
  };
  expect([](int, double) { return 0.0; }, "the depth images have no time stamps");
  expect([](int i, double stamp_s) { return i == 2 ? 0.0 : stamp_s; }, "1 depth image has no usable time stamp");
  expect([](int i, double stamp_s) { return i == 0 ? 0.0 : stamp_s; }, "1 depth image has no usable time stamp");
}

TEST(Ros2Bag, JoinsThePartsInAFolder) {
  const TemporaryFolder folder;
  const std::vector<Message> all = some_messages();
  write_db3(folder.path() / "bag_9.db3", {all.begin(), all.begin() + 4});
  write_db3(folder.path() / "bag_10.db3", {all.begin() + 4, all.end()});
  write_text(folder.path() / "metadata.yaml", "rosbag2_bagfile_information:\n");
  test::add_litter(folder.path());
  expect_some_frames(folder.path());
  fs::remove(folder.path() / "bag_9.db3");
  fs::remove(folder.path() / "bag_10.db3");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "neither .db3 nor .mcap"));
}

TEST(Ros2Bag, RefusesADatabaseOfAnotherKind) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.db3";
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  // A view that never ends must not be asked.
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT);"
               "CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) "
               "SELECT x AS rowid, 1 AS topic_id, 1 AS timestamp, 1 AS data FROM n",
               nullptr, nullptr, nullptr);
  sqlite3_close(database);
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }), "lacks the tables topics and messages"));
  write_db3(folder.path() / "b.db3", some_messages());
  const std::string whole = read_bytes(folder.path() / "b.db3", "a bag");
  const Intrinsics camera = read_all(*open_folder(folder.path() / "b.db3")).frames.front().depth_camera;
  for (std::size_t size = 20; size < whole.size(); size += 1000) {
    write_text(path, whole.substr(0, size));
    EXPECT_GT(error_of([&] {
                const auto source = open_folder(path);
                const auto frames = read_all(*source).frames;
                if (frames.size() < kFrames) throw Error("fewer frames are left");
                if (!(frames.front().depth_camera == camera)) throw Error("the camera is an assumed one");
              }).size(),
              10U)
        << size;
  }
}

// ---- MCAP ----

template <typename Number>
std::string number(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
std::string prefixed(const std::string& text) {
  return number(static_cast<std::uint32_t>(text.size())) + text;
}
std::string record(std::uint8_t kind, const std::string& content) {
  return static_cast<char>(kind) + number(std::uint64_t{content.size()}) + content;
}

std::string mcap(const std::vector<Message>& messages, const std::string& compression, bool with_index,
                 bool with_chunks = true) {
  std::string file = "\x89MCAP0\r\n" + record(1, prefixed("ros2") + prefixed("test"));
  std::map<std::string, std::uint16_t> channels;
  std::string records;
  std::map<std::uint16_t, std::string> index;
  const auto flush = [&] {
    const std::string packed = compression == "zstd"  ? zstd(records)
                               : compression == "lz4" ? lz4(records)
                                                      : records;
    file += record(6, number(std::uint64_t{0}) + number(std::uint64_t{0}) +
                          number(std::uint64_t{records.size()}) + number(std::uint32_t{0}) +
                          prefixed(compression) + number(std::uint64_t{packed.size()}) + packed);
    if (with_index)
      for (const auto& [channel, entries] : index) file += record(7, number(channel) + prefixed(entries));
    records.clear();
    index.clear();
  };
  for (const Message& message : messages) {
    const auto [channel, is_new] =
        channels.try_emplace(message.topic, static_cast<std::uint16_t>(channels.size() + 1));
    std::string& to = with_chunks ? records : file;
    if (is_new) {
      to += record(3, number(channel->second) + prefixed(message.type) + prefixed("ros2msg") + prefixed(""));
      to += record(4, number(channel->second) + number(channel->second) + prefixed(message.topic) +
                          prefixed("cdr") + number(std::uint32_t{0}));
    }
    index[channel->second] +=
        number(static_cast<std::uint64_t>(message.time_ns)) + number(std::uint64_t{to.size()});
    const auto time = number(static_cast<std::uint64_t>(message.time_ns));
    to += record(5, number(channel->second) + number(std::uint32_t{0}) + time + time + message.bytes);
    if (with_chunks && records.size() > 400) flush();
  }
  if (with_chunks) flush();
  return file + record(15, number(std::uint32_t{0})) + record(2, std::string(20, '\0')) + "\x89MCAP0\r\n";
}

TEST(Mcap, ReadsChunksOfAllCompressions) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  for (const char* compression : {"", "lz4", "zstd"})
    for (const bool with_index : {true, false}) {
      write_text(path, mcap(some_messages(), compression, with_index));
      expect_some_frames(path);
    }
  write_text(path, mcap(some_messages(), "", false, /*with_chunks=*/false));
  expect_some_frames(path);
}

TEST(Mcap, ReadsWhatIsLeftAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  const std::string whole = mcap(some_messages(), "zstd", true);
  write_text(path, whole.substr(0, whole.size() - 50));
  expect_some_frames(path);
  for (std::size_t size = 8; size < 300; size += 7) {
    write_text(path, whole.substr(0, size));
    EXPECT_GT(error_of([&] { (void)open_folder(path); }).size(), 10U) << size;
  }
  write_text(path, mcap(some_messages(), "xz", true));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }), "compressed by 'xz'"));
}

}  // namespace
}  // namespace roomradar::ros2_recording_test
