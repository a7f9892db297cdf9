// video_file.cpp: decodes consecutive frames, and seeks to others.
#include "app/sources/video/video_file.hpp"

#include <exception>
#include <string>

#include "app/sources/video/video_codecs.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

VideoFile::VideoFile(const std::filesystem::path& path) : path_(path) {
  const std::string name = path.string();
  if (!std::filesystem::is_regular_file(path)) throw Error(name + ": there is no such video");
  try {
    decoder_ = video_codecs().open(name);
  } catch (const std::exception& fault) {
    throw Error(name + ": cannot be opened as a video: " + fault.what());
  }
  if (decoder_ == nullptr) throw Error(name + ": cannot be opened as a video; is it cut short?");
  const double width = decoder_->width_px(), height = decoder_->height_px();
  if (!(width >= 1 && width <= 16384 && height >= 1 && height <= 16384))
    throw Error(name + ": its images' width or height is not in 1..16384 px");
  width_px_ = static_cast<int>(width);
  height_px_ = static_cast<int>(height);
}

VideoFile::~VideoFile() = default;

void VideoFile::read(std::size_t number, ColourImage& image) {
  constexpr std::size_t kForwards = 60;  // decoding that many takes about as long as seeking
  const std::string where = path_.string() + ": frame " + std::to_string(number);
  image.resize(width_px_, height_px_);
  try {
    if (number < next_ || number > next_ + kForwards) {
      next_ = 0;
      if (!decoder_->seek(number)) throw Error(where + " cannot be reached");
      next_ = number;
    }
    for (; next_ < number; ++next_)
      if (!decoder_->skip()) throw Error(where + " is missing");
    if (!decoder_->read(image)) throw Error(where + " is missing or cannot be decoded");
    ++next_;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& fault) {
    throw Error(where + " cannot be decoded: " + fault.what());
  }
}

}  // namespace roomradar
