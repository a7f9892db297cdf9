// ros_messages.cpp: parses both encodings with one cursor. ROS 1 packs fields; CDR aligns fields to their
// size.
#include "app/sources/containers/ros_messages.hpp"

#include <cstring>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

class Cursor {
 public:
  explicit Cursor(const MessageBytes& message) : bytes_(message.bytes), message_(message) {
    if (message.encoding != MessageEncoding::kCdr) return;
    constexpr std::size_t kEncapsulation_bytes = 4;
    if (bytes_.size() < kEncapsulation_bytes) fail();
    if (bytes_[1] != 1) throw Error(message.where + ": is not encoded as little-endian CDR");
    bytes_.remove_prefix(kEncapsulation_bytes);
  }

  template <typename Number>
  Number number() {
    if (is_cdr()) at_ = (at_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
    Number value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  template <std::size_t kCount>
  std::array<double, kCount> numbers() {
    std::array<double, kCount> values{};
    for (double& value : values) value = number<double>();
    return values;
  }

  std::vector<double> sequence() {
    const auto count = number<std::uint32_t>();
    if (count > left() / sizeof(double)) fail();
    std::vector<double> values(count);
    for (double& value : values) value = number<double>();
    return values;
  }

  std::string_view byte_sequence() { return take(number<std::uint32_t>()); }

  std::string text() {
    std::string_view characters = byte_sequence();
    if (is_cdr() && characters.ends_with('\0')) characters.remove_suffix(1);
    return std::string(characters);
  }

  RosHeader header() {
    if (!is_cdr()) (void)number<std::uint32_t>();  // sequence number
    const auto seconds = number<std::uint32_t>();
    const auto nanoseconds = number<std::uint32_t>();
    RosHeader header{static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds)};
    header.frame_id = frame();
    return header;
  }

  /// Returns the name of a frame. Old programs begin it with a slash.
  std::string frame() {
    std::string name = text();
    if (name.starts_with('/')) name.erase(0, 1);
    return name;
  }

  [[nodiscard]] bool is_cdr() const { return message_.encoding == MessageEncoding::kCdr; }
  [[nodiscard]] std::size_t left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }
  [[noreturn]] void fail() const { throw Error(message_.where + ": is cut short or damaged"); }

 private:
  std::string_view take(std::size_t count) {
    if (count > left()) fail();
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }

  std::string_view bytes_;
  const MessageBytes& message_;
  std::size_t at_ = 0;
};

RosTransform transform_of(Cursor& cursor) {
  RosTransform transform;
  for (double& value : transform.t_m) value = cursor.number<double>();
  for (double& value : transform.q_xyzw) value = cursor.number<double>();
  return transform;
}

}  // namespace

RosHeader read_header(const MessageBytes& message) { return Cursor(message).header(); }

RosImage read_image(const MessageBytes& message) {
  Cursor cursor(message);
  RosImage image;
  image.header = cursor.header();
  image.height = cursor.number<std::uint32_t>();
  image.width = cursor.number<std::uint32_t>();
  image.encoding = cursor.text();
  image.is_big_endian = cursor.number<std::uint8_t>() != 0;
  image.step = cursor.number<std::uint32_t>();
  image.data = cursor.byte_sequence();
  return image;
}

RosCompressedImage read_compressed_image(const MessageBytes& message) {
  Cursor cursor(message);
  RosCompressedImage image;
  image.header = cursor.header();
  image.format = cursor.text();
  image.data = cursor.byte_sequence();
  return image;
}

RosCameraInfo read_camera_info(const MessageBytes& message) {
  Cursor cursor(message);
  RosCameraInfo info;
  info.header = cursor.header();
  info.height = cursor.number<std::uint32_t>();
  info.width = cursor.number<std::uint32_t>();
  info.distortion_model = cursor.text();
  info.D = cursor.sequence();
  info.K = cursor.numbers<9>();
  (void)cursor.numbers<9>();  // rotation of the rectification
  info.P = cursor.numbers<12>();
  return info;
}

RosAcceleration read_acceleration(const MessageBytes& message) {
  Cursor cursor(message);
  RosAcceleration acceleration;
  acceleration.header = cursor.header();
  (void)cursor.numbers<4 + 9 + 3 + 9>();  // orientation and rotation rate, with covariances
  for (double& value : acceleration.acceleration_m_s2) value = cursor.number<double>();
  return acceleration;
}

std::vector<RosTransform> read_transforms(const MessageBytes& message) {
  constexpr std::size_t kLeast_bytes = 64;  // of a transform
  Cursor cursor(message);
  const auto count = cursor.number<std::uint32_t>();
  if (count > cursor.left() / kLeast_bytes) cursor.fail();
  std::vector<RosTransform> transforms;
  for (std::uint32_t i = 0; i < count; ++i) {
    RosHeader header = cursor.header();
    std::string child = cursor.frame();
    RosTransform transform = transform_of(cursor);
    transform.header = std::move(header);
    transform.child = std::move(child);
    transforms.push_back(std::move(transform));
  }
  return transforms;
}

RosTransform read_transform(const MessageBytes& message) {
  Cursor cursor(message);
  return transform_of(cursor);
}

float read_float(const MessageBytes& message) { return Cursor(message).number<float>(); }

std::vector<double> read_numbers(const MessageBytes& message) {
  Cursor cursor(message);
  const auto dimensions = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < dimensions; ++i) {
    (void)cursor.text();
    (void)cursor.number<std::uint32_t>();  // size
    (void)cursor.number<std::uint32_t>();  // stride
  }
  (void)cursor.number<std::uint32_t>();  // offset of the data
  return cursor.sequence();
}

}  // namespace roomradar
