// opencv_video.cpp: the video codec module: FFmpeg through OpenCV.
#include "app/sources/video/video_codecs.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string_view>

#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

class OpenCvDecoder : public VideoDecoder {
 public:
  explicit OpenCvDecoder(const std::string& path) : capture_(path, cv::CAP_FFMPEG) {
    if (capture_.isOpened()) capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  }
  [[nodiscard]] bool is_open() const { return capture_.isOpened(); }
  [[nodiscard]] double width_px() const override { return capture_.get(cv::CAP_PROP_FRAME_WIDTH); }
  [[nodiscard]] double height_px() const override { return capture_.get(cv::CAP_PROP_FRAME_HEIGHT); }
  [[nodiscard]] double frame_count() const override { return capture_.get(cv::CAP_PROP_FRAME_COUNT); }
  bool seek(std::size_t number) override {
    return capture_.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(number));
  }
  bool skip() override { return capture_.grab(); }
  bool read(ColourImage& image) override {
    try {
      if (!capture_.read(blue_first_) || blue_first_.type() != CV_8UC3 || blue_first_.cols != image.width ||
          blue_first_.rows != image.height)
        return false;
      cv::Mat red_first(image.height, image.width, CV_8UC3, image.pixels.data());
      cv::cvtColor(blue_first_, red_first, cv::COLOR_BGR2RGB);
      return true;
    } catch (const cv::Exception& fault) {
      throw std::runtime_error(fault.err);
    }
  }

 private:
  cv::VideoCapture capture_;
  cv::Mat blue_first_;
};

class OpenCvEncoder : public VideoEncoder {
 public:
  OpenCvEncoder(const std::string& path, const std::string& codec, double frames_per_s, int width_px,
                int height_px)
      : width_px_(width_px), height_px_(height_px) {
    writer_.open(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]),
                 frames_per_s, even_size());
  }
  [[nodiscard]] bool is_open() const { return writer_.isOpened(); }
  void write(const ColourImage& picture) override {
    cv::Mat rgb(picture.height, picture.width, CV_8UC3, const_cast<Rgb*>(picture.pixels.data()));
    if (picture.width != width_px_ || picture.height != height_px_)
      cv::resize(rgb, rgb, cv::Size(width_px_, height_px_), 0.0, 0.0, cv::INTER_AREA);
    cv::cvtColor(rgb(cv::Rect(cv::Point(), even_size())), bgr_, cv::COLOR_RGB2BGR);
    writer_.write(bgr_);
  }

 private:
  [[nodiscard]] cv::Size even_size() const { return {width_px_ & ~1, height_px_ & ~1}; }

  int width_px_, height_px_;
  cv::VideoWriter writer_;
  cv::Mat bgr_;
};

class OpenCvCodecs : public VideoCodecs {
 public:
  [[nodiscard]] std::unique_ptr<VideoDecoder> open(const std::string& path) const override {
    auto decoder = std::make_unique<OpenCvDecoder>(path);
    if (!decoder->is_open()) return nullptr;
    return decoder;
  }
  [[nodiscard]] std::unique_ptr<VideoEncoder> create(const std::string& path, const std::string& codec,
                                                     double frames_per_s, int width_px,
                                                     int height_px) const override {
    auto encoder = std::make_unique<OpenCvEncoder>(path, codec, frames_per_s, width_px, height_px);
    if (!encoder->is_open()) return nullptr;
    return encoder;
  }
};

}  // namespace
}  // namespace roomradar

[[gnu::visibility("default")]] const roomradar::VideoCodecs* roomradar_video_codecs(const char* version) {
  static const roomradar::OpenCvCodecs codecs;
  return std::string_view(version) == roomradar::kVersion ? &codecs : nullptr;
}
