// written_bag.hpp: messages of ROS 1 for tests, and bags of the kinds that devices record.
#pragma once
#include <bzlib.h>
#include <lz4frame.h>

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "app/sources/containers/ros_bag.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::test {

/// A message, encoded for ROS 1.
struct RosBytes {
  std::string bytes;

  template <typename Number>
  RosBytes& add(Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  RosBytes& text(std::string_view characters) {
    add(static_cast<std::uint32_t>(characters.size()));
    bytes += characters;
    return *this;
  }
  RosBytes& header(double stamp_s, std::string_view frame_id) {
    return add(std::uint32_t{0}).add(ros_time(stamp_s)).text(frame_id);
  }
  RosBytes& doubles(const std::vector<double>& values) {
    for (const double value : values) add(value);
    return *this;
  }
};

inline RosBytes ros_image(double stamp_s, std::string_view frame_id, int width_px, int height_px,
                          std::string_view encoding, int bytes_per_pixel, std::string_view data) {
  RosBytes message;
  message.header(stamp_s, frame_id)
      .add(static_cast<std::uint32_t>(height_px))
      .add(static_cast<std::uint32_t>(width_px));
  message.text(encoding)
      .add(std::uint8_t{0})
      .add(static_cast<std::uint32_t>(width_px * bytes_per_pixel))
      .text(data);
  return message;
}

inline RosBytes ros_camera_info(double stamp_s, int width_px, int height_px, double f_px,
                                const std::vector<double>& D = {0, 0, 0, 0, 0}) {
  RosBytes message;
  message.header(stamp_s, "")
      .add(static_cast<std::uint32_t>(height_px))
      .add(static_cast<std::uint32_t>(width_px));
  message.text("plumb_bob").add(static_cast<std::uint32_t>(D.size())).doubles(D);
  message.doubles({f_px, 0, width_px / 2.0, 0, f_px, height_px / 2.0, 0, 0, 1});
  return message.doubles(std::vector<double>(9)).doubles(std::vector<double>(12)).text("").text("");
}

inline RosBytes ros_tf(double stamp_s, std::string_view parent, std::string_view child,
                       const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  RosBytes message;
  message.add(std::uint32_t{1}).header(stamp_s, parent).text(child);
  return message.doubles(
      {T.translation().x(), T.translation().y(), T.translation().z(), q.x(), q.y(), q.z(), q.w()});
}

inline RosBytes ros_imu(double stamp_s, std::string_view frame_id, const Eigen::Vector3d& acceleration_m_s2) {
  RosBytes message;
  message.header(stamp_s, frame_id).doubles(std::vector<double>(25));
  return message.doubles({acceleration_m_s2.x(), acceleration_m_s2.y(), acceleration_m_s2.z()})
      .doubles(std::vector<double>(9));
}

/// A bag whose topics are added when they are first written to.
class WrittenBag {
 public:
  explicit WrittenBag(const std::filesystem::path& path) : writer_(path) {}
  void write(const std::string& topic, std::string_view type, double stamp_s, const RosBytes& message) {
    const auto [entry, is_new] = topics_.try_emplace(topic, 0);
    if (is_new) entry->second = writer_.add_topic(topic, {type, "0", ""});
    writer_.write(entry->second, ros_time(stamp_s), message.bytes);
  }
  void close() { writer_.close(); }

 private:
  RosBagWriter writer_;
  std::map<std::string, std::uint32_t> topics_;
};

/// Returns the bytes of a bag with its chunks compressed by "bz2" or "lz4".
inline std::string with_compressed_chunks(const std::string& bag, const std::string& compression) {
  const auto number = [](const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  const auto text = [](std::uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
  std::string result = bag.substr(0, 13);
  for (std::size_t at = 13; at < bag.size();) {
    const std::uint32_t header_bytes = number(bag, at);
    const std::string header = bag.substr(at + 4, header_bytes);
    const std::string data = bag.substr(at + 8 + header_bytes, number(bag, at + 4 + header_bytes));
    at += 8 + header_bytes + data.size();
    const std::size_t none = header.find("compression=none");
    if (none == std::string::npos) {
      result += text(header_bytes) + header + text(static_cast<std::uint32_t>(data.size())) + data;
      continue;
    }
    std::string packed;
    if (compression == "bz2") {
      packed.resize(data.size() + data.size() / 100 + 600);
      auto size = static_cast<unsigned>(packed.size());
      EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(data.data()),
                                         static_cast<unsigned>(data.size()), 9, 0, 0),
                BZ_OK);
      packed.resize(size);
    } else {
      packed.resize(LZ4F_compressFrameBound(data.size(), nullptr));
      packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), data.data(), data.size(), nullptr));
    }
    std::string changed = header;
    changed.replace(none, 16, "compression=" + compression);
    changed.replace(none - 4, 4, text(static_cast<std::uint32_t>(12 + compression.size())));
    result += text(static_cast<std::uint32_t>(changed.size())) + changed +
              text(static_cast<std::uint32_t>(packed.size())) + packed;
  }
  return result;
}

}  // namespace roomradar::test
