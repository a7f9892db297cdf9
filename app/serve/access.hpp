// access.hpp: who may ask a server: its address, its token, and the names by which it is called.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace roomradar {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< IPv4 or IPv6 address, without brackets
  int port = 0;                    ///< 0: any free one
};
/// Parses "ADDRESS:PORT" or "[ADDRESS]:PORT". `localhost` becomes 127.0.0.1. Throws Error naming the fault.
ListenAddress parse_listen_address(const std::string& text);
/// Returns true if only programs on this machine can reach the address.
bool is_loopback(const ListenAddress& address);

/// Reads a token: the file's only line, 16 to 256 printable ASCII characters without blanks. Throws Error
/// naming the file and the fault, also if other users may read the file.
std::string read_token(const std::filesystem::path& path);

/// Returns true if the field Authorization is "Bearer TOKEN". Time does not depend on how much of it agrees.
bool has_token(std::string_view authorization, std::string_view token);

/// Returns true if the field Host names this machine: 127.0.0.1, [::1] or localhost, with or without a port.
/// A server on loopback refuses other names: a page in a browser could otherwise give itself a name that
/// leads to it (DNS rebinding).
bool is_local_name(std::string_view host);

}  // namespace roomradar
