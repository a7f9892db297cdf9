// progress.cpp: draws the bar or prints the line.
#include "app/cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBarWidth = 30;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
constexpr auto kLineEvery = std::chrono::seconds(5);
constexpr double kRateOver_s = 15.0;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

std::string progress_line(const ProgressState& state, bool with_bar) {
  std::string line = state.what;
  const bool has_total = state.total && *state.total > 0;
  if (with_bar && has_total) {
    const auto filled = static_cast<std::size_t>(
        std::clamp<std::int64_t>(kBarWidth * state.done / *state.total, 0, kBarWidth));
    line += " [" + std::string(filled, '#') + std::string(kBarWidth - filled, ' ') + "]";
  }
  line += " " + std::to_string(state.done);
  if (has_total) line += "/" + std::to_string(*state.total);
  if (state.per_s > 0.0) {
    char text[48];
    format_classic(text, sizeof(text), ", %.1f/s", state.per_s);
    line += text;
  }
  if (state.left_s >= 0.0) {
    const auto whole_s = static_cast<long long>(std::min(std::ceil(state.left_s), 3.6e6));
    char text[48];
    format_classic(text, sizeof(text), ", %lld:%02lld left", whole_s / 60, whole_s % 60);
    line += text;
  }
  return state.note.empty() ? line : line + ", " + state.note;
}

void SmoothRate::add(double steps, double seconds) {
  if (!(seconds > 0.0)) return;
  total_s_ += seconds;
  const double kept = std::exp(-seconds / std::max(kRateOver_s, 0.25 * total_s_));
  steps_ = kept * steps_ + steps;
  seconds_ = kept * seconds_ + seconds;
}

double SmoothRemaining::add(double estimate_s, double passed_s) {
  constexpr double kLeast_s = 0.5;  // keeps the ratio finite
  const double estimated_s = std::max(estimate_s, kLeast_s);
  if (left_s_ < 0.0) return left_s_ = estimated_s;
  const double counted_s = std::max(left_s_ - passed_s, kLeast_s);
  // Near the end, and where less is shown than remains, it must be right soon.
  const double constant_s = std::min(kRateOver_s, std::max(std::min(estimated_s, counted_s), 1.0));
  return left_s_ = counted_s * std::pow(estimated_s / counted_s, 1.0 - std::exp(-passed_s / constant_s));
}

Progress::Progress(std::string what, std::optional<std::int64_t> total)
    : state_{std::move(what), 0, total, 0.0, {}, -1.0},
      is_terminal_(isatty(STDERR_FILENO) != 0),
      started_(Clock::now()),
      shown_(started_) {}

Progress::~Progress() {
  if (state_.done > 0) show(/*last=*/true);
}

void Progress::step(const std::string& note) {
  ++state_.done;
  state_.note = note;
  const Time now = Clock::now();
  if (now - shown_ < (is_terminal_ ? Clock::duration(kRedrawEvery) : kLineEvery)) return;
  rate_.add(static_cast<double>(state_.done - shown_done_), seconds(now - shown_));
  state_.per_s = rate_.per_s();
  if (is_foreseeable())
    state_.left_s =
        remaining_.add(std::max(0.0, static_cast<double>(*state_.total - state_.done) / state_.per_s),
                       seconds(now - shown_));
  shown_ = now;
  shown_done_ = state_.done;
  show(/*last=*/false);
}

bool Progress::is_foreseeable() const {
  constexpr std::int64_t kMostAwaited = 10;  // the first steps are slower
  return state_.total && state_.per_s > 0.0 && state_.done >= std::min(kMostAwaited, *state_.total / 8 + 1);
}

void Progress::show(bool last) {
  // The last line shows the mean rate of the whole work.
  if (last) {
    state_.left_s = -1.0;
    state_.per_s = static_cast<double>(state_.done) / std::max(seconds(Clock::now() - started_), 1e-6);
  }
  std::fprintf(stderr, "%s%s%s", is_terminal_ ? "\r" : "", progress_line(state_, is_terminal_).c_str(),
               is_terminal_ ? "\033[K" : "");
  if (last || !is_terminal_) std::fputc('\n', stderr);
  std::fflush(stderr);
}

}  // namespace roomradar
