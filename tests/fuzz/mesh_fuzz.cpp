// mesh_fuzz.cpp: meshes of virtual objects, in the format that the first byte selects.
#include "mapping/mesh/mesh_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const char* name = data[0] == 'o'   ? "mesh.obj"
                     : data[0] == 's' ? "mesh.stl"
                     : data[0] == 'g' ? "mesh.glb"
                                      : "mesh.ply";
  const std::filesystem::path path = test::file_with(test::as_text(data + 1, size - 1), name);
  test::read_or_refuse([&] { (void)read_mesh(path); });
  return 0;
}
