// sha256.cpp: OpenSSL's SHA-256, over a file block by block.
#include "mapping/storage/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar {

namespace {

class Sha256 {
 public:
  explicit Sha256(std::string where) : where_(std::move(where)) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const char* bytes, std::size_t count) {
    require(EVP_DigestUpdate(context_.get(), bytes, count) == 1);
  }
  [[nodiscard]] std::string bytes() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest.data(), &length) == 1);
    return {digest.begin(), digest.begin() + length};
  }
  [[nodiscard]] std::string hex() {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string hex;
    for (const char c : bytes()) {
      hex += kDigits[static_cast<unsigned char>(c) >> 4U];
      hex += kDigits[static_cast<unsigned char>(c) & 15U];
    }
    return hex;
  }

 private:
  std::string where_;
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};

  void require(bool is_good) const {
    if (!is_good) throw Error(where_ + ": OpenSSL cannot compute its SHA-256");
  }
};

}  // namespace

std::string sha256_of(std::string_view bytes) {
  Sha256 sum("a text");
  sum.add(bytes.data(), bytes.size());
  return sum.hex();
}

std::string sha256_bytes_of(std::string_view bytes) {
  Sha256 sum("a text");
  sum.add(bytes.data(), bytes.size());
  return sum.bytes();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string() + ": cannot be opened; do you have permission to read it?");
  Sha256 sum(path.string());
  std::vector<char> block(1U << 20U);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    sum.add(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw Error(path.string() + ": cannot be read to its end");
  return sum.hex();
}

}  // namespace roomradar
