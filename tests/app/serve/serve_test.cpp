// serve_test.cpp: the server as a process: HTTP, tokens, limits, many clients. ROOMRADAR_LONG_TESTS=1: ten
// minutes with eight clients, and 10^6 damaged requests.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "mapping/types/system/file_io.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/http_exchange.hpp"
#include "tests/support/locate_body.hpp"
#include "tests/support/saved_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::serve_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::chrono::milliseconds kNoPatience{0}, kPatience{500};
constexpr double kMaxGrowth_mb = 60.0;  // of the server's memory: its allocator, with 24 threads

bool is_long() { return std::getenv("ROOMRADAR_LONG_TESTS") != nullptr; }

/// A running `roomradar serve` on a free port.
class Server {
 public:
  explicit Server(std::vector<std::string> arguments) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    arguments.insert(arguments.begin(), "serve");
    child_ = test::start_program(arguments, ends[1]);
    close(ends[1]);
    output_ = fdopen(ends[0], "r");
    char line[512];
    while (std::fgets(line, sizeof(line), output_) != nullptr) {
      said_ += line;
      const std::size_t at = said_.find("listening on http://");
      if (at == std::string::npos) continue;
      port_ = std::stoi(said_.substr(said_.rfind(':') + 1));
      break;
    }
  }
  ~Server() {
    (void)end();
    std::fclose(output_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Ends the server by Ctrl-C. Returns its exit status.
  int end() {
    if (child_ < 0) return status_;
    if (port_ > 0) kill(child_, SIGINT);
    status_ = test::status_of(child_);
    child_ = -1;
    return status_;
  }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] const std::string& said() const { return said_; }
  /// Returns the resident memory, 10^6 bytes.
  [[nodiscard]] double rss_mb() const {
    std::ifstream file("/proc/" + std::to_string(child_) + "/status");
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("VmRSS:")) return 1.024e-3 * std::stod(line.substr(6));
    return 0.0;
  }

 private:
  pid_t child_ = -1;
  int status_ = -1;
  int port_ = 0;
  std::FILE* output_ = nullptr;
  std::string said_;
};

class Serve : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new test::TemporaryFolder;
    const std::vector<Frame> frames =
        test::write_small_building(house(), "sim:table?seed=1&frames=40&rate=5&width=320");
    for (std::size_t i = 2; i < frames.size(); i += 5)
      bodies_.push_back(test::locate_body_of(frames[i]).text());
    write_bytes(token(), "0123456789abcdef0123456789abcdef\n");
    fs::permissions(token(), fs::perms::owner_read | fs::perms::owner_write);
  }
  static void TearDownTestSuite() { delete made_; }
  static fs::path house() { return made_->path() / "house"; }
  static fs::path token() { return made_->path() / "token"; }
  static std::vector<std::string> on(const std::string& address) { return {house(), "--listen", address}; }

  inline static test::TemporaryFolder* made_ = nullptr;
  inline static std::vector<std::string> bodies_;
};

TEST_F(Serve, AnswersOverHttpAndEndsByCtrlC) {
  Server server(on("127.0.0.1:0"));
  ASSERT_GT(server.port(), 0) << server.said();
  const auto get = [&](const std::string& path, const std::string& lines = "") {
    return test::http_request(server.port(), "GET", path, lines);
  };
  EXPECT_EQ(get("/health").status, 200);
  const json facts = json::parse(get("/maps/house").body);
  const std::string path = "/maps/house/" + facts.at("tiles").at(0).at("glb").get<std::string>();
  const std::string glb = read_bytes(house() / facts.at("tiles").at(0).at("glb").get<std::string>(), "tile");
  const test::HttpAnswer tile = get(path);
  EXPECT_EQ(tile.status, 200);
  EXPECT_EQ(tile.body, glb);
  EXPECT_NE(tile.head.find("model/gltf-binary"), std::string::npos);
  const std::size_t at = tile.head.find("ETag: ");
  ASSERT_NE(at, std::string::npos);
  const std::string etag = tile.head.substr(at + 6, 66);
  const test::HttpAnswer known = get(path, "If-None-Match: " + etag + "\r\n");
  EXPECT_EQ(known.status, 304);
  EXPECT_TRUE(known.body.empty());
  const test::HttpAnswer head = test::http_request(server.port(), "HEAD", path);
  EXPECT_EQ(head.status, 200);
  EXPECT_TRUE(head.body.empty());

  const test::HttpAnswer part = get(path, "Range: bytes=4-11\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, glb.substr(4, 8));
  EXPECT_EQ(get(path, "Range: bytes=-8\r\n").body, glb.substr(glb.size() - 8));
  EXPECT_EQ(get(path, "Range: bytes=8-99999999999\r\n").body, glb.substr(8));
  EXPECT_EQ(get(path, "Range: bytes=99999999999-\r\n").status, 416);
  EXPECT_EQ(get(path, "Range: bytes=0-,0-,0-,0-\r\n").status, 416);

  const json located =
      json::parse(test::http_request(server.port(), "POST", "/maps/house/locate", "", bodies_[3]).body);
  EXPECT_EQ(located.at("found"), true);
  EXPECT_EQ(server.end(), 0);
}

TEST_F(Serve, RefusesWhatIsNotMeantForIt) {
  const Server server(on("127.0.0.1:0"));
  ASSERT_GT(server.port(), 0) << server.said();
  const int port = server.port();
  for (const char* path : {"/maps/house/../../../etc/passwd", "/maps/house/%2e%2e/%2e%2e/etc/passwd",
                           "/maps/house/tiles/..%2fbuilding.json", "/maps/house/building.json",
                           "//etc/passwd", "/maps/house/tiles/%00", "/maps/%ff%fe"})
    EXPECT_EQ(test::http_request(port, "GET", path).status, 404) << path;
  EXPECT_EQ(test::http_request(port, "GET", "/maps", "", "", "evil.org").status, 403);
  EXPECT_EQ(test::http_request(port, "POST", "/locate", "", bodies_[0], "evil.org:80").status, 403);
  for (const char* method : {"PUT", "DELETE", "POST", "PATCH"})
    EXPECT_EQ(test::http_request(port, method, "/maps/house", "", "x").status, 405) << method;
  EXPECT_EQ(test::http_request(port, "POST", "/locate", "", "no request").status, 400);
  EXPECT_EQ(test::http_request(port, "POST", "/locate", "", std::string(9'000'000, 'x')).status, 413);
  EXPECT_EQ(test::http_exchange(port,
                                "POST /locate HTTP/1.1\r\nHost: localhost\r\nContent-Length: "
                                "99999999999999\r\n\r\nx")
                .status,
            413);
  EXPECT_EQ(test::http_exchange(port,
                                "POST /locate HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                                "multipart/form-data; boundary=b\r\nContent-Length: 5\r\n\r\n--b--")
                .status,
            415);
  std::string chunked = "POST /locate HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 10; ++i) chunked += "f4240\r\n" + std::string(1'000'000, 'x') + "\r\n";
  EXPECT_EQ(test::http_exchange(port, chunked + "0\r\n\r\n").status, 413);
  (void)test::http_exchange(port, "no HTTP at all\r\n\r\n", kNoPatience);
  (void)test::http_exchange(port, std::string("\0\1\2\r\n", 5), kNoPatience);
  EXPECT_EQ(test::http_request(port, "GET", "/health").status, 200);
}

TEST_F(Serve, OtherMachinesNeedATokenAndTheUsersConsent) {
  std::vector<std::string> arguments = on("0.0.0.0:0");
  for (const char* missing : {"--allow-remote", "--token-file"}) {
    Server refused(arguments);
    EXPECT_EQ(refused.end(), 1);
    EXPECT_NE(refused.said().find(missing), std::string::npos) << refused.said();
    arguments.emplace_back("--allow-remote");
  }
  arguments.pop_back();
  arguments.insert(arguments.end(), {"--token-file", token()});
  const Server server(arguments);
  ASSERT_GT(server.port(), 0) << server.said();
  const auto status = [&](const std::string& lines) {
    return test::http_request(server.port(), "GET", "/maps", lines, "", "any.org").status;
  };
  EXPECT_EQ(status(""), 401);
  EXPECT_EQ(status("Authorization: Bearer 0123456789abcdef0123456789abcdee\r\n"), 401);
  EXPECT_EQ(status("Authorization: Bearer 0123456789abcdef0123456789abcdef\r\n"), 200);
  EXPECT_EQ(test::http_request(server.port(), "POST", "/locate", "", bodies_[0]).status, 401);
}

TEST_F(Serve, ManyClientsAreAnsweredInBoundedMemory) {
  Server server(on("127.0.0.1:0"));
  ASSERT_GT(server.port(), 0) << server.said();
  const auto ask_all = [&](std::chrono::seconds time) {
    std::atomic<int> answered = 0, turned_away = 0, wrong = 0;
    std::vector<std::thread> clients;
    const auto end = std::chrono::steady_clock::now() + time;
    for (std::size_t client = 0; client < 8; ++client)
      clients.emplace_back([&, client] {
        for (std::size_t i = client; std::chrono::steady_clock::now() < end; ++i) {
          const auto answer =
              test::http_request(server.port(), "POST", "/locate", "", bodies_[i % bodies_.size()]);
          ++(answer.status == 200 ? answered : answer.status == 503 ? turned_away : wrong);
          if (test::http_request(server.port(), "GET", "/maps/house/tileset.json").status != 200) ++wrong;
        }
      });
    for (std::thread& client : clients) client.join();
    EXPECT_EQ(wrong, 0);
    return answered.load();
  };
  EXPECT_GT(ask_all(std::chrono::seconds(3)), 8);
  const double before_mb = server.rss_mb();
  EXPECT_GT(ask_all(std::chrono::seconds(is_long() ? 600 : 4)), 8);
  EXPECT_LT(server.rss_mb(), before_mb + kMaxGrowth_mb) << "before: " << before_mb << " MB";
  std::printf("resident memory %.1f MB, later %.1f MB\n", before_mb, server.rss_mb());
  EXPECT_EQ(server.end(), 0);
}

/// Returns the request with up to four bytes changed, often in its head, and sometimes cut off.
std::string damaged(std::string request, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const std::size_t reach = below(2) == 0 ? 800 : request.size();
  for (std::size_t k = 0; k < 1 + below(4); ++k) request[below(reach)] = static_cast<char>(below(256));
  if (below(5) == 0) request.resize(below(request.size()));
  return request;
}

TEST_F(Serve, DamagedRequestsDoNotEndItInBoundedMemory) {
  Server server(on("127.0.0.1:0"));
  ASSERT_GT(server.port(), 0) << server.said();
  const std::string good = "POST /maps/house/locate HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
                           std::to_string(bodies_[0].size()) + "\r\n\r\n" + bodies_[0];
  std::atomic<int> sent = 0, answered = 0;
  const auto send_all = [&](int count, unsigned seed) {
    std::vector<std::thread> clients;
    for (unsigned client = 0; client < 4; ++client)
      clients.emplace_back([&, client] {
        std::mt19937 random(10 * seed + client);
        for (int i = 0; i < count / 4; ++i) {
          const std::string request = damaged(good, random);
          const bool is_cut = request.size() < good.size();
          const auto answer = test::http_exchange(server.port(), request, is_cut ? kNoPatience : kPatience);
          sent += answer.is_connected ? 1 : 0;
          answered += answer.status > 0 ? 1 : 0;
        }
      });
    for (std::thread& client : clients) client.join();
  };
  const int count = is_long() ? 1'000'000 : 200;
  send_all(count / 10, 1);
  const double before_mb = server.rss_mb();
  send_all(count - count / 10, 2);
  std::printf("%d requests sent, %d answered; resident memory %.1f MB, later %.1f MB\n", sent.load(),
              answered.load(), before_mb, server.rss_mb());
  EXPECT_EQ(sent, count);  // a machine may run out of ports
  EXPECT_GT(answered, count / 2);
  EXPECT_LT(server.rss_mb(), before_mb + kMaxGrowth_mb);
  EXPECT_EQ(test::http_request(server.port(), "GET", "/health").status, 200);
  EXPECT_EQ(server.end(), 0);
}

}  // namespace
}  // namespace roomradar::serve_test
