// openni_recorder.cpp: records OpenNI2's dummy device by OpenNI2's own recorder.
//
// usage: openni_recorder RECORDING.oni DEPTH
// Writes the depth images that it read meanwhile to DEPTH: per image, its stamp in microseconds (uint64) and
// its pixels in millimetres (320 x 240 uint16). A program of its own, because OpenNI2's recorder sometimes
// deadlocks.
#include <OpenNI.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  openni::OpenNI::initialize();
  openni::Device device;
  openni::VideoStream depth, colour;
  if (device.open("Dummy") != openni::STATUS_OK) return 1;
  depth.create(device, openni::SENSOR_DEPTH);
  colour.create(device, openni::SENSOR_COLOR);
  openni::Recorder recorder;
  if (recorder.create(argv[1]) != openni::STATUS_OK) return 1;
  recorder.attach(depth);
  recorder.attach(colour, /*allowLossyCompression=*/true);
  depth.start();
  colour.start();
  recorder.start();
  std::FILE* const file = std::fopen(argv[2], "wb");
  if (file == nullptr) return 1;
  for (int i = 0; i < 6; ++i) {
    openni::VideoFrameRef image;
    if (depth.readFrame(&image) != openni::STATUS_OK) return 1;
    const std::uint64_t stamp_us = image.getTimestamp();
    std::fwrite(&stamp_us, sizeof stamp_us, 1, file);
    std::fwrite(image.getData(), 1, static_cast<std::size_t>(image.getDataSize()), file);
  }
  recorder.stop();
  recorder.destroy();
  std::fclose(file);
  _exit(0);  // the driver's threads use their streams after they were destroyed
}
