// access.hpp: access control of a server: its address, its token, and the host names it accepts.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace roomradar {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< IPv4 or IPv6 address, without brackets
  int port = 0;                    ///< 0: any free port
};
/// Parses "ADDRESS:PORT" or "[ADDRESS]:PORT". `localhost` becomes 127.0.0.1. Throws Error naming the fault.
ListenAddress parse_listen_address(const std::string& text);
/// Returns true if only programs on this machine can reach the address.
bool is_loopback(const ListenAddress& address);

/// Reads a token: the file's only line, 16 to 256 printable ASCII characters without spaces. Throws Error
/// naming the file and the fault, also if other users may read the file.
std::string read_token(const std::filesystem::path& path);

/// Returns true if the field Authorization is "Bearer TOKEN". Compares in constant time, so that the duration
/// does not reveal how many characters match.
bool has_token(std::string_view authorization, std::string_view token);

/// Returns true if the field Host names this machine: 127.0.0.1, [::1] or localhost, with or without a port.
/// A server without a token refuses other names. Otherwise, a web page could reach the server by a host name
/// that resolves to this machine (DNS rebinding).
bool is_local_name(std::string_view host);

}  // namespace roomradar
