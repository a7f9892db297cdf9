// mesh_fuzz.cpp: meshes, and with a capital letter models with textures, in the format that the first byte
// selects.
#include "app/models/model_file.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const char* name = data[0] == 'o' || data[0] == 'O'   ? "mesh.obj"
                     : data[0] == 's' || data[0] == 'S' ? "mesh.stl"
                     : data[0] == 'g' || data[0] == 'G' ? "mesh.glb"
                     : data[0] == 'D'                   ? "mesh.dae"
                     : data[0] == 'T'                   ? "mesh.gltf"
                     : data[0] == 'M'                   ? "mesh.model"
                                                        : "mesh.ply";
  const std::filesystem::path path = test::file_with(test::as_text(data + 1, size - 1), name);
  const bool is_model = data[0] >= 'A' && data[0] <= 'Z';
  test::read_or_refuse([&] { is_model ? (void)read_model(path) : (void)read_mesh(path); });
  return 0;
}
