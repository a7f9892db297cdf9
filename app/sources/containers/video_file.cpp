// video_file.cpp: cv::VideoCapture, which reads forwards and seeks.
#include "app/sources/containers/video_file.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {

struct VideoFile::Decoder {
  cv::VideoCapture capture;
  cv::Mat blue_first;
};

VideoFile::VideoFile(const std::filesystem::path& path) : path_(path), decoder_(std::make_unique<Decoder>()) {
  const std::string name = path.string();
  if (!std::filesystem::is_regular_file(path)) throw Error(name + ": there is no such video");
  try {
    decoder_->capture.open(name, cv::CAP_FFMPEG);
  } catch (const cv::Exception& fault) {
    throw Error(name + ": cannot be opened as a video: " + fault.err);
  }
  if (!decoder_->capture.isOpened()) throw Error(name + ": cannot be opened as a video; is it cut short?");
  decoder_->capture.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
  const double width = decoder_->capture.get(cv::CAP_PROP_FRAME_WIDTH);
  const double height = decoder_->capture.get(cv::CAP_PROP_FRAME_HEIGHT);
  if (!(width >= 1 && width <= 16384 && height >= 1 && height <= 16384))
    throw Error(name + ": its images' width or height is not in 1..16384 px");
  width_px_ = static_cast<int>(width);
  height_px_ = static_cast<int>(height);
}

VideoFile::~VideoFile() = default;

void VideoFile::read(std::size_t number, ColourImage& image) {
  constexpr std::size_t kForwards = 60;  // decoding that many takes about as long as seeking
  const std::string where = path_.string() + ": frame " + std::to_string(number);
  cv::VideoCapture& capture = decoder_->capture;
  try {
    if (number < next_ || number > next_ + kForwards) {
      next_ = 0;
      if (!capture.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(number)))
        throw Error(where + " cannot be reached");
      next_ = number;
    }
    for (; next_ < number; ++next_)
      if (!capture.grab()) throw Error(where + " is missing");
    if (!capture.read(decoder_->blue_first) || decoder_->blue_first.type() != CV_8UC3 ||
        decoder_->blue_first.cols != width_px_ || decoder_->blue_first.rows != height_px_)
      throw Error(where + " is missing or cannot be decoded");
    ++next_;
    image.resize(width_px_, height_px_);
    cv::Mat red_first(height_px_, width_px_, CV_8UC3, image.pixels.data());
    cv::cvtColor(decoder_->blue_first, red_first, cv::COLOR_BGR2RGB);
  } catch (const cv::Exception& fault) {
    throw Error(where + " cannot be decoded: " + fault.err);
  }
}

}  // namespace roomradar
