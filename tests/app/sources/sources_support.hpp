// sources_support.hpp: tiny frames, damaged files, and reading of a whole source.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// Returns a number as memory has it.
template <typename Number>
std::string bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

inline void cut_to(const std::filesystem::path& path, double part) {
  std::filesystem::resize_file(
      path, static_cast<std::uintmax_t>(static_cast<double>(std::filesystem::file_size(path)) * part));
}

inline Eigen::Isometry3d some_pose(int i) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.1 * i, -0.2, 1.5);
  return T;
}

/// Frame `i` of a synthetic recording: a depth ramp with invalid pixels, a colour pattern, a pose, gravity.
inline Frame some_frame(int i, int width_px = 16, int height_px = 12) {
  Frame frame;
  frame.index = i;
  frame.stamp_s = 100.0 + i / 30.0;
  frame.colour_after_depth_s = 0.005 * (i % 3 - 1);
  frame.depth_camera = {width_px,        height_px,      0.9 * width_px,
                        0.91 * width_px, width_px / 2.0, height_px / 2.0};
  frame.colour_camera = {width_px,       height_px,      0.8 * width_px,
                         0.8 * width_px, width_px / 2.0, height_px / 2.0};
  frame.T_colour_depth.translation().x() = -0.025;
  frame.depth_m.resize(width_px, height_px);
  frame.colour.resize(width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      frame.depth_m.at(x, y) =
          (x + y) % 7 == 0 ? 0.0F
                           : 0.8F + 0.013F * static_cast<float>(x) + 0.1F * static_cast<float>(y % 20 + i);
      frame.colour.at(x, y) = {static_cast<std::uint8_t>(x * 7), static_cast<std::uint8_t>(y * 5),
                               static_cast<std::uint8_t>(i * 9)};
    }
  frame.T_world_camera = some_pose(i);
  frame.down_camera = Eigen::Vector3d(0.1, 0.9, -0.2 + 0.01 * i).normalized();
  return frame;
}

struct ReadAll {
  std::vector<Frame> frames;
  std::vector<std::string> faults;
};

inline ReadAll read_all(FrameSource& source) {
  ReadAll all;
  Frame frame;
  for (;;) {
    const ReadResult result = source.next(frame);
    if (result.status == ReadStatus::kEnd) return all;
    if (result.status == ReadStatus::kFrame)
      all.frames.push_back(frame);
    else
      all.faults.push_back(result.fault);
  }
}

/// Reads a whole recording, and returns all decisions about it as lines.
template <typename Open>
std::string decisions_about(const Open& open, ReadAll* all = nullptr) {
  SourceOptions options;
  options.input = std::make_shared<InputReport>();
  ReadAll read = read_all(*open(options));
  if (all) *all = std::move(read);
  std::string lines;
  for (const InputDecision& decision : options.input->decisions()) lines += line_of(decision) + "\n";
  return lines;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A source of `count` frames; frames whose index is in `bad` are skipped.
class MadeSource final : public FrameSource {
 public:
  MadeSource(int count, bool knows_its_length, std::vector<int> bad = {})
      : count_(count), knows_(knows_its_length), bad_(std::move(bad)) {}
  ReadResult next(Frame& frame) override {
    if (at_ == count_) return {ReadStatus::kEnd, {}};
    const int i = at_++;
    for (const int b : bad_)
      if (b == i) return {ReadStatus::kSkipped, "frame " + std::to_string(i) + " is bad"};
    frame = some_frame(i);
    if (i % 3 == 2) frame.colour.resize(0, 0);
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    if (knows_) at_ = 0;
    return knows_;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return knows_ ? std::optional<std::int64_t>(count_) : std::nullopt;
  }
  [[nodiscard]] std::string name() const override { return "made"; }

 private:
  int count_;
  bool knows_;
  std::vector<int> bad_;
  int at_ = 0;
};

}  // namespace roomradar::test
