// objects_fuzz.cpp: the list of the objects that stay in a room, objects.json.
#include "app/objects/kept_objects.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  static const std::string model = std::string(64, '0') + ".model";
  test::read_or_refuse([&] {
    (void)test::file_with("", model.c_str());
    const std::filesystem::path list = test::file_with(test::as_text(data, size), "objects.json");
    for (const KeptObject& object : read_kept_objects(list.parent_path()))
      if (!object.T_world_object.matrix().allFinite()) std::abort();
  });
  return 0;
}
