// http_exchange.hpp: sends bytes to a port of this machine and returns all that comes back.
#pragma once
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string>

namespace roomradar::test {

struct HttpAnswer {
  bool is_connected = false;  ///< the server accepted the connection
  int status = 0;             ///< 0: no answer
  std::string head, body;
};

/// Sends a request as it is, and reads until the server closes the connection.
/// @param patience  then says that nothing follows, so that the server does not wait for a rest; 0: at once.
///                  cpp-httplib takes this for a closed connection, and does not answer any more.
inline HttpAnswer http_exchange(int port, const std::string& request,
                                std::chrono::milliseconds patience = std::chrono::minutes(1)) {
  HttpAnswer answer;
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto wait_ms = patience.count() > 0 ? patience.count() : 60'000;
  const timeval timeout{wait_ms / 1000, wait_ms % 1000 * 1000};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  std::string all;
  answer.is_connected = ::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0;
  if (answer.is_connected) {
    std::size_t sent = 0;
    while (sent < request.size()) {
      const ssize_t n = ::send(socket, request.data() + sent, request.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) break;  // refused early; the answer may be there all the same
      sent += static_cast<std::size_t>(n);
    }
    char piece[16'384];
    for (bool may_follow = patience.count() > 0;;) {
      if (!may_follow) ::shutdown(socket, SHUT_WR);
      const ssize_t n = ::recv(socket, piece, sizeof(piece), 0);
      if (n > 0)
        all.append(piece, static_cast<std::size_t>(n));
      else if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK) && may_follow)
        may_follow = false;
      else
        break;
    }
  }
  ::close(socket);
  const std::size_t end = all.find("\r\n\r\n");
  if (end == std::string::npos || !all.starts_with("HTTP/1.1 ")) return answer;
  answer.status = std::stoi(all.substr(9, 3));
  answer.head = all.substr(0, end + 2);
  answer.body = all.substr(end + 4);
  return answer;
}

/// Sends a request with these lines in its head, such as "Range: bytes=0-3\r\n".
inline HttpAnswer http_request(int port, const std::string& method, const std::string& path,
                               const std::string& lines = "", const std::string& body = "",
                               const std::string& host = "127.0.0.1") {
  std::string request = method + " " + path + " HTTP/1.1\r\nHost: " + host + "\r\n" + lines;
  if (method != "GET" && method != "HEAD")
    request +=
        "Content-Type: application/octet-stream\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
  return http_exchange(port, request + "\r\n" + body);
}

}  // namespace roomradar::test
