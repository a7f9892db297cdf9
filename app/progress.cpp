// progress.cpp: draws the bar or the line.
#include "app/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace roomradar {
namespace {

constexpr int kBarWidth = 30;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(5);

}  // namespace

Progress::Progress(std::string what, std::optional<std::int64_t> total)
    : what_(std::move(what)),
      total_(total),
      is_terminal_(isatty(STDERR_FILENO) != 0),
      started_(std::chrono::steady_clock::now()),
      shown_(started_) {}

Progress::~Progress() {
  if (done_ > 0) show(/*last=*/true);
}

void Progress::step(const std::string& note) {
  ++done_;
  note_ = note;
  const auto now = std::chrono::steady_clock::now();
  if (now - shown_ < (is_terminal_ ? std::chrono::steady_clock::duration(kRedrawEvery) : kLineEvery)) return;
  shown_ = now;
  show(/*last=*/false);
}

void Progress::show(bool last) {
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  const double per_s = elapsed_s > 0 ? static_cast<double>(done_) / elapsed_s : 0.0;
  std::string bar;
  std::string count = std::to_string(done_);
  if (total_ && *total_ > 0) {
    const auto filled = static_cast<int>(std::min<std::int64_t>(kBarWidth, kBarWidth * done_ / *total_));
    if (is_terminal_) bar = " [" + std::string(filled, '#') + std::string(kBarWidth - filled, ' ') + "]";
    count += "/" + std::to_string(*total_);
  }
  std::fprintf(stderr, "%s%s%s %s, %.1f/s%s%s%s", is_terminal_ ? "\r" : "", what_.c_str(), bar.c_str(),
               count.c_str(), per_s, note_.empty() ? "" : ", ", note_.c_str(), is_terminal_ ? "\033[K" : "");
  if (last || !is_terminal_) std::fputc('\n', stderr);
  std::fflush(stderr);
}

}  // namespace roomradar
