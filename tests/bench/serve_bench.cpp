// serve_bench.cpp: how long a running server takes to answer, with many clients at a fixed rate.
//
//   roomradar serve BUILDING --listen 127.0.0.1:8080
//   serve_bench SOURCE --port 8080 [--clients 8] [--rate 10] [--seconds 600] [--locates 0.1]
//
// Each client asks for the next file of the building's tiles, or locates a frame of SOURCE. The time of an
// answer counts from when it was due, so a server that falls behind is seen to. The reference is a locate on
// its own, before the others begin.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/open_source.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/support/http_exchange.hpp"
#include "tests/support/locate_body.hpp"

namespace roomradar {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

struct BenchOptions {
  std::string source;
  int port = 8080;
  int clients = 8;
  double rate_hz = 10.0;  // of each client
  double seconds = 600.0;
  double locates = 0.1;  // fraction of the requests
  int frames = 40;
};

/// Answers of one kind.
struct Answers {
  std::vector<double> ms;  // of those with status 200
  int found = 0, turned_away = 0, errors = 0;
};

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::vector<std::string> bodies_of(const BenchOptions& options) {
  const auto source = open_source(options.source, FrameRange{0, options.frames - 1});
  std::vector<std::string> bodies;
  Frame frame;
  for (ReadResult read = source->next(frame); read.status != ReadStatus::kEnd; read = source->next(frame))
    if (read.status == ReadStatus::kFrame) bodies.push_back(test::locate_body_of(frame).text());
  if (bodies.empty()) throw Error(options.source + ": has no frames");
  return bodies;
}

/// Returns the paths of all tiles' glb files of the first map.
std::vector<std::string> tile_paths(int port) {
  const auto maps = test::http_request(port, "GET", "/maps");
  if (maps.status != 200)
    throw Error("port " + std::to_string(port) + ": no server answers; start `roomradar serve` first");
  const std::string name = json::parse(maps.body).at("maps").at(0).at("name");
  const json facts = json::parse(test::http_request(port, "GET", "/maps/" + name).body);
  std::vector<std::string> paths;
  for (const json& tile : facts.at("tiles"))
    paths.push_back("/maps/" + name + "/" + tile.at("glb").get<std::string>());
  if (paths.empty()) throw Error(name + ": has no tiles; serve a building");
  return paths;
}

void count(const test::HttpAnswer& answer, double ms, Answers& answers) {
  if (answer.status == 503)
    ++answers.turned_away;
  else if (answer.status != 200)
    ++answers.errors;
  else
    answers.ms.push_back(ms);
}

void locate(int port, const std::string& body, Clock::time_point due, Answers& answers) {
  const auto answer = test::http_request(port, "POST", "/locate", "", body);
  count(answer, ms_since(due), answers);
  if (answer.status == 200 && json::parse(answer.body).at("found")) ++answers.found;
}

void print(const char* what, const Answers& answers) {
  std::printf(
      "%-7s %6zu answered, %d turned away, %d errors; median %.1f ms, 95 %% within %.1f, at most %.1f\n",
      what, answers.ms.size(), answers.turned_away, answers.errors, test::quantile(answers.ms, 0.5),
      test::quantile(answers.ms, 0.95), test::quantile(answers.ms, 1.0));
}

int run(const BenchOptions& options) {
  const std::vector<std::string> bodies = bodies_of(options), tiles = tile_paths(options.port);
  Answers alone;
  for (const std::string& body : bodies) locate(options.port, body, Clock::now(), alone);
  print("alone", alone);

  std::mutex mutex;
  Answers locates, files;
  std::vector<std::thread> clients;
  const auto start = Clock::now();
  const auto requests = static_cast<int>(options.seconds * options.rate_hz);
  for (int client = 0; client < options.clients; ++client)
    clients.emplace_back([&, client] {
      Answers own_locates, own_files;
      for (int i = 0; i < requests; ++i) {
        const double due_s = (i + static_cast<double>(client) / options.clients) / options.rate_hz;
        const auto due =
            start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due_s));
        std::this_thread::sleep_until(due);
        const auto at = static_cast<std::size_t>(i * options.clients + client);
        // Clients do not know of each other: at fixed intervals, all would locate in the same moment.
        if (CounterRandom(hash_of(0x6c6f6361, at), 0).uniform() < options.locates) {
          locate(options.port, bodies[at % bodies.size()], due, own_locates);
        } else {
          const auto answer = test::http_request(options.port, "GET", tiles[at % tiles.size()]);
          count(answer, ms_since(due), own_files);
        }
      }
      const std::lock_guard lock(mutex);
      for (auto [from, to] : {std::pair(&own_locates, &locates), std::pair(&own_files, &files)}) {
        to->ms.insert(to->ms.end(), from->ms.begin(), from->ms.end());
        to->found += from->found;
        to->turned_away += from->turned_away;
        to->errors += from->errors;
      }
    });
  for (std::thread& client : clients) client.join();
  print("locate", locates);
  print("tile", files);
  std::printf("located %d of %zu; 95 %% of the locates within %.2f times the median of one alone\n",
              locates.found, locates.ms.size(),
              test::quantile(locates.ms, 0.95) / test::quantile(alone.ms, 0.5));
  return locates.errors + files.errors == 0 ? 0 : 1;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  roomradar::BenchOptions options;
  CLI::App app("Answers of a running roomradar serve, with many clients at a fixed rate");
  app.add_option("SOURCE", options.source, "recording or sim:ROOM whose frames are located (required)")
      ->required();
  app.add_option("--port", options.port, "port on this machine (default: 8080)");
  app.add_option("--clients", options.clients, "number of clients (default: 8)");
  app.add_option("--rate", options.rate_hz, "requests of each client per second (default: 10)");
  app.add_option("--seconds", options.seconds, "duration (default: 600)");
  app.add_option("--locates", options.locates, "fraction of the requests that locate a frame (default: 0.1)");
  app.add_option("--frames", options.frames, "number of frames of SOURCE (default: 40)");
  CLI11_PARSE(app, argc, argv);
  return roomradar::test::run_or_say("serve_bench", [&] { return roomradar::run(options); });
}
