// corpus_main.cpp: runs a fuzz target over its corpus and over random mutations of it, without libFuzzer.
//
// usage: TARGET FOLDER|FILE... [-runs=N]      N mutated inputs, the same in each run
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_input.hpp"

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

Bytes read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Mutates an input: changes, removes, duplicates or inserts bytes, or inserts a piece of another input.
Bytes changed(Bytes bytes, const Bytes& other, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const std::size_t changes = 1 + below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const auto at = static_cast<std::ptrdiff_t>(below(bytes.size() + 1));
    const auto length = static_cast<std::ptrdiff_t>(below(std::min<std::size_t>(bytes.size() - at, 64) + 1));
    switch (random() % 6) {
      case 0:
        if (at < std::ssize(bytes))
          bytes[static_cast<std::size_t>(at)] ^= static_cast<std::uint8_t>(1U << (random() % 8));
        break;
      case 1:
        if (at < std::ssize(bytes)) {
          constexpr std::uint8_t kTelling[] = {0,   1,   127, 128,  255, '-', '0',
                                               '9', '.', ' ', '\n', '"', '{', '['};
          bytes[static_cast<std::size_t>(at)] = kTelling[below(std::size(kTelling))];
        }
        break;
      case 2:
        bytes.erase(bytes.begin() + at, bytes.begin() + at + length);
        break;
      case 3: {
        const Bytes piece(bytes.begin() + at, bytes.begin() + at + length);
        bytes.insert(bytes.begin() + at, piece.begin(), piece.end());
        break;
      }
      case 4:
        bytes.resize(static_cast<std::size_t>(at));
        break;
      default: {
        const std::size_t from = below(other.size());
        const std::size_t count = std::min<std::size_t>(other.size() - from, 1 + below(64));
        bytes.insert(bytes.begin() + at, other.begin() + static_cast<std::ptrdiff_t>(from),
                     other.begin() + static_cast<std::ptrdiff_t>(from + count));
      }
    }
  }
  return bytes;
}

Bytes input;  // global: the signal handler saves it

/// Saves the current input; calls only async-signal-safe functions.
void keep_input() {
  const int file = open("crash-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || write(file, input.data(), input.size()) < 0) return;
  close(file);
}

void on_signal(int number) {
  keep_input();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

void run_input() {
  constexpr unsigned kMost_s = 20;
  alarm(kMost_s);
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Bytes> corpus;
  std::vector<fs::path> files;
  long runs = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.starts_with("-runs=")) {
      runs = std::atol(argument.c_str() + 6);
    } else if (fs::is_directory(argument)) {
      for (const auto& entry : fs::recursive_directory_iterator(argument))
        if (entry.is_regular_file()) files.push_back(entry.path());
    } else {
      files.emplace_back(argument);
    }
  }
  std::sort(files.begin(), files.end());
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGALRM}) std::signal(number, on_signal);
  try {
    for (const fs::path& file : files) {
      input = read_bytes(file);
      run_input();
      corpus.push_back(input);
    }
    if (corpus.empty()) {
      std::fprintf(stderr, "there is no input in the corpus\n");
      return 2;
    }
    std::mt19937 random(1);
    for (long i = 0; i < runs; ++i) {
      input = changed(corpus[random() % corpus.size()], corpus[random() % corpus.size()], random);
      run_input();
    }
  } catch (const std::exception& error) {
    keep_input();
    std::fprintf(stderr, "not refused by roomradar::Error: %s; the input is in crash-input\n", error.what());
    return 1;
  }
  std::printf("%zu inputs of the corpus, %ld made of them\n", corpus.size(), runs);
  return 0;
}
