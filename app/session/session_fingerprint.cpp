// session_fingerprint.cpp: hashes names, poses and pixels into two numbers.
#include "app/session/session_fingerprint.hpp"

#include <algorithm>
#include <cstring>

#include "app/session/session.hpp"

namespace roomradar {
namespace {

/// Fowler, Noll and Vo's hash FNV-1a, over words of 8 bytes.
class Fingerprint {
 public:
  void add(const void* data, std::size_t size_bytes) {
    const char* bytes = static_cast<const char*>(data);
    for (std::size_t at = 0; at < size_bytes; at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + at, std::min(sizeof word, size_bytes - at));
      value_ = (value_ ^ word) * 1099511628211ULL;
      value_ ^= value_ >> 29U;  // the product alone never carries high bits down
    }
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037ULL;
};

}  // namespace

FrameFingerprint fingerprint_of(std::int64_t run_frame, const Session& session) {
  Fingerprint objects;
  for (const auto& object : session.objects()) {
    if (!object->in_room) continue;  // a replay loads all objects at its start
    objects.add(object->body.name.data(), object->body.name.size());
    const Eigen::Matrix<double, 3, 4> pose = object->body.T_world_object.matrix().topRows<3>();
    objects.add(pose.data(), sizeof(double) * 12);
  }
  FrameFingerprint result{run_frame, objects.value(), 0};
  if (!session.picture().empty()) {
    Fingerprint picture;
    picture.add(session.picture().pixels.data(), session.picture().pixels.size() * sizeof(Rgb));
    result.picture = picture.value();
  }
  return result;
}

}  // namespace roomradar
