// gltf_fuzz.cpp: glTF models, read without the sandbox. After the first byte: with 'g' a whole file,
// otherwise the JSON of a .glb, a line "%%", and its buffer, so that changed lengths do not spoil the
// container.
#include "app/models/gltf_model.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace {

std::string glb_of(std::string_view text) {
  constexpr std::string_view kMark = "\n%%\n";
  const std::size_t mark = text.find(kMark);
  std::string json(text.substr(0, mark));
  std::string binary(mark == std::string_view::npos ? std::string_view{} : text.substr(mark + kMark.size()));
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  const auto word = [&](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  word(2), word(28 + json.size() + binary.size());
  word(json.size()), bytes += "JSON" + json;
  word(binary.size()), bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roomradar;
  if (size == 0) return 0;
  const std::string_view rest = test::as_text(data + 1, size - 1);
  const std::filesystem::path path =
      data[0] == 'g' ? test::file_with(rest, "model.gltf") : test::file_with(glb_of(rest), "model.glb");
  test::read_or_refuse([&] { (void)read_gltf_model(path); });
  return 0;
}
