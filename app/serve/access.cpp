// access.cpp: parses addresses, and checks tokens and host names.
#include "app/serve/access.hpp"

#include <arpa/inet.h>
#include <sys/stat.h>
#include <algorithm>
#include <cmath>

#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMinToken = 16, kMaxToken = 256;

}  // namespace

ListenAddress parse_listen_address(const std::string& text) {
  const auto fail = [&](const char* why) {
    throw Error("--listen " + text + ": " + why + "; give ADDRESS:PORT such as 127.0.0.1:8080 or [::1]:8080");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) fail("has no port");
  ListenAddress address;
  address.host = text.substr(0, colon);
  const bool has_brackets =
      address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (has_brackets) address.host = address.host.substr(1, address.host.size() - 2);
  if (address.host == "localhost") address.host = "127.0.0.1";
  in6_addr ignored{};
  if (inet_pton(has_brackets ? AF_INET6 : AF_INET, address.host.c_str(), &ignored) != 1)
    fail("the address is neither IPv4 nor, in brackets, IPv6");
  const std::string digits = text.substr(colon + 1);
  const auto port = parse_number(digits);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos || !port ||
      *port > 65535.0)
    fail("the port must be a whole number from 0 to 65535");
  address.port = static_cast<int>(*port);
  return address;
}

bool is_loopback(const ListenAddress& address) {
  return address.host == "::1" || address.host.starts_with("127.");
}

std::string read_token(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 4096;
  std::string token = read_bytes(path, "a token", kMaxBytes);
  struct stat of {};
  if (::stat(path.c_str(), &of) == 0 && (of.st_mode & (S_IRGRP | S_IROTH)) != 0)
    throw Error(path.string() + ": other users may read the token; run chmod 600 on it");
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  const bool is_printable =
      std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < 127; });
  if (!is_printable || token.size() < kMinToken || token.size() > kMaxToken)
    throw Error(
        path.string() +
        ": must hold one line of 16 to 256 letters, digits and signs; `openssl rand -hex 32` makes one");
  return token;
}

bool has_token(std::string_view authorization, std::string_view token) {
  constexpr std::string_view kBearer = "Bearer ";
  if (!authorization.starts_with(kBearer)) return false;
  // Hashes differ at random places, so the time of comparing them tells nothing of the token.
  return sha256_of(authorization.substr(kBearer.size())) == sha256_of(token);
}

bool is_local_name(std::string_view host) {
  for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    const std::string_view rest = host.substr(name.size());
    if (rest.empty()) return true;
    return rest.front() == ':' && rest.find_first_not_of("0123456789", 1) == std::string_view::npos;
  }
  return false;
}

}  // namespace roomradar
