// pose_convention.cpp: converts poses between conventions, and conventions to and from text.
#include "app/sources/formats/pose_convention.hpp"

#include <cstdlib>
#include <vector>

namespace roomradar {

Eigen::Isometry3d converted(const Eigen::Isometry3d& stated, const PoseConvention& convention) {
  if (convention == PoseConvention{}) return stated;
  Eigen::Isometry3d T = stated;
  if (convention.is_wxyz) {
    const Eigen::Quaterniond q(stated.linear());  // its coefficients are x y z w, in truth w x y z
    T.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
  }
  T.translation() *= convention.unit_m;
  if (convention.is_inverse) T = T.inverse();
  if (convention.is_opengl) {
    T.linear().col(1) *= -1.0;
    T.linear().col(2) *= -1.0;
  }
  return T;
}

std::optional<PoseConvention> parse_pose_convention(std::string_view text) {
  PoseConvention convention;
  if (text == "stated") return convention;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    if (word == "inverse")
      convention.is_inverse = true;
    else if (word == "opengl")
      convention.is_opengl = true;
    else if (word == "wxyz")
      convention.is_wxyz = true;
    else if (word == "mm" || word == "cm")
      convention.unit_m = word == "mm" ? 0.001 : 0.01;
    else
      return std::nullopt;
    if (comma == std::string_view::npos) return convention;
    text.remove_prefix(comma + 1);
  }
  return std::nullopt;
}

namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace

std::string to_string(const PoseConvention& convention) {
  std::vector<std::string> words;
  if (convention.is_inverse) words.emplace_back("inverse");
  if (convention.is_opengl) words.emplace_back("opengl");
  if (convention.is_wxyz) words.emplace_back("wxyz");
  if (convention.unit_m == 0.001) words.emplace_back("mm");
  if (convention.unit_m == 0.01) words.emplace_back("cm");
  return words.empty() ? "stated" : joined(words, ",");
}

std::string describe(const PoseConvention& convention) {
  std::vector<std::string> words;
  if (convention.is_inverse) words.emplace_back("world to camera");
  if (convention.is_opengl) words.emplace_back("with OpenGL's camera axes (y up, z backwards)");
  if (convention.is_wxyz) words.emplace_back("with quaternions in the order w x y z");
  if (convention.unit_m == 0.001) words.emplace_back("in millimetres");
  if (convention.unit_m == 0.01) words.emplace_back("in centimetres");
  if (convention.later_by != 0)
    words.push_back(std::to_string(std::abs(convention.later_by)) +
                    (std::abs(convention.later_by) == 1 ? " frame" : " frames") +
                    (convention.later_by > 0 ? " too late" : " too early"));
  return words.empty() ? "as the format defines them" : joined(words, ", ");
}

}  // namespace roomradar
