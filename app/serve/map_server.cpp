// map_server.cpp: serves with cpp-httplib, with limits; all requests except locate requests share one
// handler.
#include "app/serve/map_server.hpp"

#include <sys/socket.h>

#include <httplib.h>
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "app/serve/locate_request.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

constexpr int kSilence_s = 5;

/// A fixed number of threads, and a queue that makes its filler wait when it is full.
class BoundedThreads : public httplib::TaskQueue {
 public:
  explicit BoundedThreads(std::size_t count) : most_waiting_(count) {
    for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return waiting_.size() < most_waiting_; });
    waiting_.push_back(std::move(task));
    changed_.notify_all();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      is_ended_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !waiting_.empty() || is_ended_; });
      if (waiting_.empty()) return;
      const std::function<void()> task = std::move(waiting_.front());
      waiting_.pop_front();
      changed_.notify_all();
      lock.unlock();
      task();
    }
  }

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool is_ended_ = false;
  std::vector<std::thread> threads_;
};

/// Sends a file in pieces, so that memory does not grow with it.
void send_file(const Answer& answer, httplib::Response& response) {
  const auto file = std::make_shared<std::ifstream>(*answer.file, std::ios::binary);
  if (!*file) throw Error("the file was replaced; ask for the map's facts again");
  response.set_content_provider(static_cast<std::size_t>(answer.file_bytes), answer.content_type.c_str(),
                                [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  constexpr std::size_t kPiece = 65'536;
                                  std::vector<char> piece(std::min(length, kPiece));
                                  file->clear();
                                  file->seekg(static_cast<std::streamoff>(offset));
                                  file->read(piece.data(), static_cast<std::streamsize>(piece.size()));
                                  return file->gcount() == static_cast<std::streamsize>(piece.size()) &&
                                         sink.write(piece.data(), piece.size());
                                });
}

void send(const Answer& answer, httplib::Response& response) {
  if (!answer.etag.empty()) {
    response.set_header("ETag", "\"" + answer.etag + "\"");
    response.set_header("Cache-Control", "no-cache");  // ask each time; the answer is mostly 304
  }
  response.set_header("X-Content-Type-Options", "nosniff");
  if (answer.status != 200) response.status = answer.status;  // else 206 for a range
  if (answer.status == 503) response.set_header("Retry-After", "1");
  if (answer.file)
    send_file(answer, response);
  else if (answer.status != 304)
    response.set_content(answer.body, answer.content_type.c_str());
}

/// Makes the request's range one that the library can serve: it does not compare it with the content's size.
/// Returns false if it begins behind the content, or if there are several, which could repeat a file often.
bool make_range_valid(const httplib::Request& request, std::uintmax_t bytes) {
  if (request.ranges.empty()) return true;
  if (request.ranges.size() > 1 || bytes == 0) return false;
  auto& [first, last] = const_cast<httplib::Request&>(request).ranges.front();
  const auto size = static_cast<std::int64_t>(bytes);
  if (first == -1) {  // the last bytes, by number
    if (last <= 0) return false;
    last = std::min<std::int64_t>(last, size);
    return true;
  }
  if (first >= size) return false;
  if (last != -1) last = std::min<std::int64_t>(last, size - 1);
  return true;
}

}  // namespace

struct MapServer::State {
  /// Places for frames that are located at a time, and for those that wait.
  class LocatingPlaces {
   public:
    LocatingPlaces(int places, int waits) : free_(places), free_waits_(waits) {}

    /// Waits for a place. Returns false at once if too many wait.
    bool take() {
      std::unique_lock lock(mutex_);
      if (free_ == 0) {
        if (free_waits_ == 0) return false;
        --free_waits_;
        freed_.wait(lock, [&] { return free_ > 0; });
        ++free_waits_;
      }
      --free_;
      return true;
    }
    void give_back() {
      {
        const std::lock_guard lock(mutex_);
        ++free_;
      }
      freed_.notify_one();
    }

   private:
    std::mutex mutex_;
    std::condition_variable freed_;
    int free_, free_waits_;
  };

  MapServerConfig config;
  MapCatalogue catalogue;
  LocatingPlaces places;
  httplib::Server server;
  int port = 0;

  State(MapServerConfig with, MapCatalogue of)
      : config(std::move(with)), catalogue(std::move(of)), places(config.locating, config.locating_waits) {}

  /// Returns why the request is refused before anything else is looked at; status 200 if it is not.
  [[nodiscard]] Answer refusal(const httplib::Request& request) const {
    if (!config.token.empty()) {
      if (!has_token(request.get_header_value("Authorization"), config.token))
        return error_answer(401, "send the token: Authorization: Bearer TOKEN");
    } else if (!is_local_name(request.get_header_value("Host"))) {
      return error_answer(403, "without a token, this server answers to 127.0.0.1, [::1] and localhost only");
    }
    return {};
  }

  void answer_reading(const httplib::Request& request, httplib::Response& response) const {
    Answer answer = refusal(request);
    if (answer.status == 200)
      answer = answer_get(catalogue, request.path, request.get_header_value("If-None-Match"));
    if (answer.status == 401) response.set_header("WWW-Authenticate", "Bearer");
    const std::uintmax_t bytes = answer.file ? answer.file_bytes : answer.body.size();
    if (answer.status == 200 && !make_range_valid(request, bytes))
      answer =
          error_answer(416, "the range is outside the content, or several are requested; request one range");
    if (answer.status != 200) const_cast<httplib::Request&>(request).ranges.clear();  // for content only
    send(answer, response);
  }

  /// Reads the body, also of a refused request, so that the client reads the answer. Keeps it only if `keep`.
  static Answer read_body(const httplib::Request& request, const httplib::Response& response,
                          const httplib::ContentReader& read, bool keep, std::string& body) {
    const Answer too_large =
        error_answer(413, "a request has at most " + std::to_string(kMaxLocateBody_bytes) + " bytes");
    std::size_t bytes = 0;
    const auto take = [&](const char* data, std::size_t length) {
      bytes += length;  // after decompression
      if (bytes > kMaxLocateBody_bytes) return false;
      if (keep) body.append(data, length);
      return true;
    };
    if (request.is_multipart_form_data()) {
      keep = false;
      (void)read([](const httplib::MultipartFormData&) { return true; }, take);
      return error_answer(415, "send the body as application/octet-stream; see `roomradar help http`");
    }
    if (read(take)) return {};
    const bool is_too_large =
        bytes > kMaxLocateBody_bytes || response.status == too_large.status;  // as stated
    return is_too_large ? too_large : error_answer(400, "the request ended early");
  }

  void answer_locating(const httplib::Request& request, httplib::Response& response,
                       const httplib::ContentReader& read) {
    const Answer refused = refusal(request);
    std::string body;
    Answer answer = read_body(request, response, read, refused.status == 200, body);
    if (refused.status != 200) answer = refused;
    if (answer.status == 200) {
      if (places.take()) {
        answer = answer_locate(catalogue, request.path, body);
        places.give_back();
      } else {
        answer = error_answer(503, "too many frames are being located; try again in a second");
      }
    }
    send(answer, response);
  }

  void set_up() {
    server.new_task_queue = [this] {
      return new BoundedThreads(static_cast<std::size_t>(config.connections));
    };
    server.set_keep_alive_max_count(1);
    server.set_read_timeout(kSilence_s);
    server.set_write_timeout(kSilence_s);
    server.set_payload_max_length(kMaxLocateBody_bytes);
    server.set_tcp_nodelay(true);
    server.set_socket_options([](socket_t socket) {  // not SO_REUSEPORT: two servers must not share a port
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const bool is_reading = request.method == "GET" || request.method == "HEAD";
      if (!is_reading && request.method == "POST" && is_locate_path(request.path))
        return httplib::Server::HandlerResponse::Unhandled;
      if (is_reading)
        answer_reading(request, response);
      else
        send(error_answer(405, "maps are read with GET; /locate and /maps/NAME/locate take POST"), response);
      return httplib::Server::HandlerResponse::Handled;
    });
    server.Post("/locate|/maps/[A-Za-z0-9._-]{1,100}/locate",
                [this](const httplib::Request& request, httplib::Response& response,
                       const httplib::ContentReader& read) { answer_locating(request, response, read); });
    server.set_error_handler([](const httplib::Request& /*request*/, httplib::Response& response) {
      if (response.body.empty() && response.status != 304)
        response.set_content(error_answer(response.status, "the request cannot be answered").body,
                             "application/json");
    });
    server.set_exception_handler(
        [](const httplib::Request& /*request*/, httplib::Response& response, std::exception_ptr fault) {
          try {
            std::rethrow_exception(std::move(fault));
          } catch (const std::exception& known) {
            send(error_answer(503, known.what()), response);
          } catch (...) {
            send(error_answer(500, "an unknown fault"), response);
          }
        });
    if (config.verbose)
      server.set_logger([](const httplib::Request& request, const httplib::Response& response) {
        // Quoted, since a path may have line ends.
        const std::string path =
            nlohmann::json(request.path).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
        std::fprintf(stderr, "%s %s %s %d\n", request.remote_addr.c_str(), request.method.c_str(),
                     path.c_str(), response.status);
      });
  }
};

MapServer::MapServer(MapServerConfig config, MapCatalogue catalogue) {
  config.locating = given_or_processors(config.locating);
  state_ = std::make_unique<State>(std::move(config), std::move(catalogue));
  state_->set_up();
  const ListenAddress& address = state_->config.address;
  if (address.port == 0)
    state_->port = state_->server.bind_to_any_port(address.host);
  else
    state_->port = state_->server.bind_to_port(address.host, address.port) ? address.port : -1;
  if (state_->port <= 0)
    throw Error("--listen " + address.host + ":" + std::to_string(address.port) +
                ": cannot be used; is another program there, or is it no address of this machine?");
}

MapServer::~MapServer() = default;

int MapServer::port() const { return state_->port; }

void MapServer::run() {
  if (!state_->server.listen_after_bind()) throw Error("the server ended: the system closed its socket");
}

void MapServer::stop() { state_->server.stop(); }

}  // namespace roomradar
