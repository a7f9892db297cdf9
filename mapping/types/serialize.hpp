// serialize.hpp: binary serialization. One function serialize() per type lists the fields for writing and
// reading.
#pragma once
#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/trajectory.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {

static_assert(std::endian::native == std::endian::little, "bytes are written as memory has them");

class ByteWriter {
 public:
  static constexpr bool kReads = false;
  void raw(const void* from, std::size_t count) { bytes_.append(static_cast<const char*>(from), count); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads and validates bytes written by a ByteWriter. Sizes are checked before memory is allocated. Invalid
/// values throw Error naming the file.
class ByteReader {
 public:
  static constexpr bool kReads = true;
  ByteReader(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}
  void raw(void* to, std::size_t count) {
    require(count, 1);
    if (count > 0) std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }
  /// Returns the next number or array of numbers, in the machine's byte order.
  template <typename Number>
  Number number() {
    static_assert(std::is_trivially_copyable_v<Number>);
    Number value{};
    raw(&value, sizeof value);
    return value;
  }
  /// Throws Error if fewer than `count` * `item_bytes` bytes are left.
  void require(std::uint64_t count, std::size_t item_bytes) const {
    if (count > bytes_.size() / item_bytes) fail("is cut short");
  }
  /// Returns the next `count` bytes and moves past them.
  std::string_view take(std::size_t count) {
    require(count, 1);
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  void require_end() const {
    if (!bytes_.empty()) fail("has bytes after its end");
  }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[noreturn]] void fail(const char* fault) const { throw Error(where_ + ": " + fault); }

 private:
  std::string_view bytes_;
  std::string where_;
};

template <typename Archive, typename Number>
requires std::is_arithmetic_v<Number>
void serialize(Archive& archive, Number& number) {
  if constexpr (std::is_same_v<Number, bool>) {
    auto byte = static_cast<std::uint8_t>(number);
    serialize(archive, byte);
    if constexpr (Archive::kReads) {
      if (byte > 1) archive.fail("is damaged: a truth value is neither 0 nor 1");
      number = byte == 1;
    }
  } else {
    archive.raw(&number, sizeof(Number));
  }
}

/// Serializes an enumeration whose values run from 0 to `last`.
template <typename Archive, typename Enum>
requires std::is_enum_v<Enum>
void serialize(Archive& archive, Enum& value, Enum last) {
  auto number = static_cast<std::int32_t>(value);
  serialize(archive, number);
  if constexpr (Archive::kReads) {
    if (number < 0 || number > static_cast<std::int32_t>(last)) archive.fail("is damaged: no such case");
    value = static_cast<Enum>(number);
  }
}

template <typename Archive>
void serialize(Archive& archive, std::string& text) {
  std::uint64_t size = text.size();
  serialize(archive, size);
  if constexpr (Archive::kReads) {
    archive.require(size, 1);
    text.resize(size);
  }
  archive.raw(text.data(), size);
}

/// Serializes a fixed-size matrix as raw scalars in Eigen's storage order.
template <typename Archive, typename Scalar, int kRows, int kColumns>
void serialize(Archive& archive, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  static_assert(kRows > 0 && kColumns > 0);
  archive.raw(matrix.data(), sizeof(Scalar) * kRows * kColumns);
}

template <typename Archive>
void serialize(Archive& archive, Eigen::Isometry3d& T) {
  serialize(archive, T.matrix());
  if constexpr (Archive::kReads) {
    if (!is_rigid(T, 1e-3)) archive.fail("is damaged: a pose is not a rigid transform");
  }
}

template <typename Archive>
void serialize(Archive& archive, Intrinsics& camera) {
  serialize(archive, camera.width_px);
  serialize(archive, camera.height_px);
  for (double* number : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    serialize(archive, *number);
  if constexpr (Archive::kReads) require_valid(camera, archive.where().c_str());
}

template <typename Archive>
void serialize(Archive& archive, DepthNoise& noise) {
  for (float* value : {&noise.base_m, &noise.linear, &noise.quadratic_per_m, &noise.from_m, &noise.grazing})
    serialize(archive, *value);
}

template <typename Archive>
void serialize(Archive& archive, SensorTiming& timing) {
  for (double* time_s : {&timing.depth_readout_s, &timing.colour_readout_s, &timing.colour_delay_s})
    serialize(archive, *time_s);
}

template <typename Archive>
void serialize(Archive& archive, TimedPose& pose) {
  serialize(archive, pose.frame_index);
  serialize(archive, pose.stamp_s);
  serialize(archive, pose.T_world_camera);
}

template <typename Archive, typename Value>
void serialize(Archive& archive, std::optional<Value>& value) {
  bool there = value.has_value();
  serialize(archive, there);
  if constexpr (Archive::kReads) value = there ? std::optional<Value>(Value{}) : std::nullopt;
  if (there) serialize(archive, *value);
}

template <typename Archive, typename Item>
void serialize(Archive& archive, std::vector<Item>& items) {
  std::uint64_t size = items.size();
  serialize(archive, size);
  if constexpr (Archive::kReads) {
    archive.require(size, 1);  // every item has at least one byte
    items.clear();
    for (std::uint64_t i = 0; i < size; ++i) serialize(archive, items.emplace_back());
  } else {
    for (Item& item : items) serialize(archive, item);
  }
}

}  // namespace roomradar
