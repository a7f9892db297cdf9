// serialize.hpp: the archive of binary state. A type lists its fields once, for writing and for reading:
//   template <typename Archive>
//   void serialize(Archive& archive, Ref<Archive, Room> room) { archive(room.name, room.width_m); }
// The archive finds serialize() in namespace roomradar; it must not be in an anonymous namespace.
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
#include <utility>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/trajectory.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {

static_assert(std::endian::native == std::endian::little, "bytes are written as memory has them");

/// Type of the object in serialize(): only an archive that reads may change it.
template <typename Archive, typename T>
using Ref = std::conditional_t<Archive::kReads, T&, const T&>;

/// Archive that writes.
struct ByteWriter {
  static constexpr bool kReads = false;
  std::string bytes;  ///< what was written so far

  void raw(const void* from, std::size_t count) { bytes.append(static_cast<const char*>(from), count); }
  template <typename... Fields>
  void operator()(const Fields&... fields) {
    (serialize(*this, fields), ...);
  }
};

/// Archive that reads. Sizes are checked before memory is allocated. Missing bytes and invalid values throw
/// Error naming the file and the fault. The bytes must outlive the reader.
class ByteReader {
 public:
  static constexpr bool kReads = true;
  /// @param where  the file, in messages
  /// @param advice  end of messages
  ByteReader(std::string_view bytes, std::string where, const char* advice = "")
      : bytes_(bytes), where_(std::move(where)), advice_(advice) {}
  template <typename... Fields>
  void operator()(Fields&... fields) {
    (serialize(*this, fields), ...);
  }
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
  /// Returns the bytes that are left, without moving past them.
  [[nodiscard]] std::string_view rest() const { return bytes_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[noreturn]] void fail(const std::string& fault) const { throw Error(where_ + ": " + fault + advice_); }

 private:
  std::string_view bytes_;
  std::string where_;
  const char* advice_;
};

template <typename Archive, typename Number>
requires std::is_arithmetic_v<Number>
void serialize(Archive& archive, Number& number) {
  if constexpr (std::is_same_v<std::remove_const_t<Number>, bool>) {
    auto byte = static_cast<std::uint8_t>(number);
    archive(byte);
    if constexpr (Archive::kReads) {
      if (byte > 1) archive.fail("is damaged: a truth value is neither 0 nor 1");
      number = byte == 1;
    }
  } else {
    archive.raw(&number, sizeof(Number));
  }
}

/// Serializes a value as another type of number: a bool that was written as 4 bytes, for example.
template <typename Number, typename Archive, typename Value>
void serialize_as(Archive& archive, Value& value) {
  auto number = static_cast<Number>(value);
  archive(number);
  if constexpr (Archive::kReads) value = static_cast<Value>(number);
}

/// Serializes an enumeration whose values run from 0 to `last`.
template <typename Archive, typename Enum>
requires std::is_enum_v<Enum>
void serialize(Archive& archive, Enum& value, std::remove_const_t<Enum> last) {
  auto number = static_cast<std::int32_t>(value);
  archive(number);
  if constexpr (Archive::kReads) {
    if (number < 0 || number > static_cast<std::int32_t>(last)) archive.fail("is damaged: no such case");
    value = static_cast<Enum>(number);
  }
}

/// Serializes the number of items (u64). A reader resizes to it, if so many items of at least `item_bytes`
/// each can follow.
template <typename Archive, typename Items>
void serialize_size(Archive& archive, Items& items, std::size_t item_bytes) {
  std::uint64_t size = items.size();
  archive(size);
  if constexpr (Archive::kReads) {
    archive.require(size, item_bytes);
    items.resize(size);
  }
}

/// Copies all items as one block, since copying a large mesh item by item would take seconds.
/// @param items  a vector or a string
template <typename Archive, typename Items>
void serialize_items(Archive& archive, Items& items) {
  using Item = typename Items::value_type;
  static_assert(std::is_standard_layout_v<Item>);
  serialize_size(archive, items, sizeof(Item));
  archive.raw(items.data(), items.size() * sizeof(Item));
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, std::string> text) {
  serialize_items(archive, text);
}

/// Serializes a fixed-size matrix as raw scalars in Eigen's storage order.
template <typename Archive, typename Matrix>
requires(Matrix::SizeAtCompileTime > 0) void serialize(Archive& archive, Matrix& matrix) {
  archive.raw(matrix.data(), sizeof(typename Matrix::Scalar) * Matrix::SizeAtCompileTime);
}

/// Serializes numbers and fixed-size matrices that must be finite.
/// @param what  their name in messages
template <typename Archive, typename... Fields>
void serialize_finite(Archive& archive, const char* what, Fields&... fields) {
  archive(fields...);
  if constexpr (Archive::kReads) {
    const auto is_finite = [](const auto& field) {
      if constexpr (requires { field.allFinite(); })
        return field.allFinite();
      else
        return std::isfinite(field);
    };
    if (!(is_finite(fields) && ...)) archive.fail(std::string(what) + " is not a number");
  }
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, Eigen::Isometry3d> T) {
  archive(T.matrix());
  if constexpr (Archive::kReads) {
    if (!is_rigid(T, 1e-3)) archive.fail("is damaged: a pose is not a rigid transform");
  }
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, Intrinsics> camera) {
  archive(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  if constexpr (Archive::kReads) require_valid(camera, archive.where().c_str());
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, DepthNoise> noise) {
  archive(noise.base_m, noise.linear, noise.quadratic_per_m, noise.from_m, noise.grazing);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, SensorTiming> timing) {
  archive(timing.depth_readout_s, timing.colour_readout_s, timing.colour_delay_s);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, TimedPose> pose) {
  archive(pose.frame_index, pose.stamp_s, pose.T_world_camera);
}

template <typename Value>
void serialize(ByteWriter& archive, const std::optional<Value>& value) {
  archive(value.has_value());
  if (value) archive(*value);
}
template <typename Value>
void serialize(ByteReader& archive, std::optional<Value>& value) {
  bool there = false;
  archive(there);
  value.reset();
  if (there) archive(value.emplace());
}

template <typename Item>
void serialize(ByteWriter& archive, const std::vector<Item>& items) {
  archive(std::uint64_t{items.size()});
  for (const Item& item : items) archive(item);
}
template <typename Item>
void serialize(ByteReader& archive, std::vector<Item>& items) {
  std::uint64_t size = 0;
  archive(size);
  archive.require(size, 1);  // every item has at least one byte
  items.clear();
  for (std::uint64_t i = 0; i < size; ++i) archive(items.emplace_back());
}

}  // namespace roomradar
