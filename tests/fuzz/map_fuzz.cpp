// map_fuzz.cpp: the files of a map folder, by the first byte, as they are read once their checksums match.
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

/// Replaces the last 8 bytes by the FNV-1a hash that ends binary files, so the reader accepts the rest.
std::string sealed(std::string_view bytes) {
  std::string file(bytes.substr(0, bytes.size() - std::min<std::size_t>(bytes.size(), 8)));
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : file) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  file.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  return file;
}

/// Returns a picture of 8 x 8 pixels.
std::string_view small_jpeg() {
  static const std::vector<std::uint8_t> jpeg = roomradar::jpeg_of(roomradar::ColourImage(8, 8), 90);
  return roomradar::test::as_text(jpeg.data(), jpeg.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const std::string_view bytes = test::as_text(data + 1, size - 1);
  test::read_or_refuse([&] {
    switch (data[0]) {
      case 'o':
        (void)StaticMap::read_ot(test::file_with(bytes, "octree.ot"));
        break;
      case 'b':
        (void)StaticMap::read(test::file_with(sealed(bytes), "octree.bin"));
        break;
      case 'p':
        (void)read_keyframe_database(test::file_with(sealed(bytes), "places.bin"));
        break;
      case 'u':
        (void)read_unknown_surface(test::file_with(sealed(bytes), "unknown.bin"));
        break;
      case 'x':
        (void)read_surface_texture(test::file_with(small_jpeg(), "texture.jpg"),
                                   test::file_with(sealed(bytes), "texture.bin"));
        break;
      case 'j':
        require_jpeg({data + 1, size - 1}, 8, 8, "texture.jpg");
        (void)picture_of_jpeg({data + 1, size - 1}, 8, 8, "texture.jpg");
        break;
      case 't':
        (void)read_trajectory(test::file_with(bytes, "trajectory.txt"));
        break;
      default:
        (void)read_mesh(test::file_with(bytes, "mesh.ply"));
    }
  });
  return 0;
}
