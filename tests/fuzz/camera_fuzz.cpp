// camera_fuzz.cpp: camera.json, camera-intrinsics.txt, calibration.json and map.json, by the first byte.
#include "app/calibration/calibration.hpp"
#include "app/sources/datasets/dataset_readers.hpp"
#include "app/sources/decisions/camera_choice.hpp"
#include "app/sources/formats/camera_rig.hpp"
#include "mapping/map/map_info.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const std::string_view text = test::as_text(data + 1, size - 1);
  test::read_or_refuse([&] {
    switch (data[0]) {
      case 'c':
        (void)read_camera_file(test::file_with(text, "camera.json"));
        (void)read_stated_input(test::fuzz_folder(), {});
        break;
      case 'i':
        (void)read_intrinsics_matrix(test::file_with(text, "camera-intrinsics.txt"), 640, 480);
        break;
      case 'p':
        (void)read_pose_file(test::file_with(text, "pose.txt"));
        break;
      case 'm':
        (void)parse_map_info(std::string(text), "map.json");
        break;
      default:
        (void)read_calibration(test::file_with(text, "calibration.json"));
    }
  });
  return 0;
}
