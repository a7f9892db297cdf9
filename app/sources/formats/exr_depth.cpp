// exr_depth.cpp: reads EXR images from memory through the OpenEXR library.
#include "app/sources/formats/exr_depth.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <cmath>
#include <cstring>
#include <exception>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Lets the library read from memory. Its exceptions derive from std::exception.
class MemoryStream final : public Imf::IStream {
 public:
  MemoryStream(std::string_view bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int count) override {
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - at_)
      throw std::runtime_error("it is cut short");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("it is cut short");
    at_ = position;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace

void decode_exr_depth(std::string_view bytes, const std::string& where, DepthImage& depth_m) {
  constexpr int kMaxSide_px = 16384;
  constexpr std::int64_t kMostPacked = 1032;  // deflate compresses by no more
  try {
    MemoryStream stream(bytes, where);
    Imf::InputFile file(stream, 0);
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxSide_px || height > kMaxSide_px)
      throw Error(where + ": its size of " + std::to_string(width) + " x " + std::to_string(height) +
                  " is not in 1..16384");
    if (width * height * 2 / kMostPacked > static_cast<std::int64_t>(bytes.size()))
      throw Error(where + ": is cut short or damaged: " + std::to_string(bytes.size()) +
                  " bytes cannot hold an image of " + std::to_string(width) + " x " + std::to_string(height));
    const Imf::ChannelList& channels = file.header().channels();
    const auto channel = channels.begin();
    if (channel == channels.end() || ++channels.begin() != channels.end() ||
        channel.channel().xSampling != 1 || channel.channel().ySampling != 1 ||
        file.header().hasTileDescription())
      throw Error(where + ": must be a scan-line EXR with one channel, the depth in metres");
    depth_m.resize(static_cast<int>(width), static_cast<int>(height));
    const auto row_bytes = static_cast<std::size_t>(width) * sizeof(float);
    // The library counts pixels from the data window's corner, which need not be (0, 0).
    char* origin = reinterpret_cast<char*>(depth_m.pixels.data()) -
                   std::ptrdiff_t{window.min.x} * static_cast<std::ptrdiff_t>(sizeof(float)) -
                   std::ptrdiff_t{window.min.y} * static_cast<std::ptrdiff_t>(row_bytes);
    Imf::FrameBuffer frame_buffer;
    frame_buffer.insert(channel.name(), Imf::Slice(Imf::FLOAT, origin, sizeof(float), row_bytes));
    file.setFrameBuffer(frame_buffer);
    file.readPixels(window.min.y, window.max.y);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& fault) {
    throw Error(where + ": is no EXR image that can be read: " + fault.what());
  }
  for (float& depth : depth_m.pixels)
    if (!(std::isfinite(depth) && depth > 0.0F)) depth = 0.0F;
}

}  // namespace roomradar
