// input_report.hpp: what was found in a recording, and what was decided about it.
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace roomradar {

/// A decision about a recording, as one sentence.
struct InputDecision {
  std::string topic;       ///< time, images, poses, unit, camera or gravity
  std::string sentence;    ///< what was found and what was decided, without the recording's name
  std::int64_t count = 0;  ///< number of frames, images, poses or lines that it concerns
  std::string option{};    ///< option that overrides the decision; empty: none
  /// True: the decision may be wrong, or something is missing that the user can supply.
  bool is_advice = false;
};

/// Decisions about one recording: those made when it was opened, and counts of images and poses that could
/// not be read since. Thread safe, since recordings are read ahead on another thread.
class InputReport {
 public:
  /// Adds a decision.
  void add(InputDecision decision);
  /// Counts one image or pose that could not be read. Counts of the same topic and `what` become one
  /// decision, with the first fault as an example.
  /// @param what  sentence with "%" in place of the count: "% colour images cannot be read"
  void count(const std::string& topic, const std::string& what, std::int64_t frame, const std::string& fault);

  /// Returns all decisions: those added, then one per count.
  [[nodiscard]] std::vector<InputDecision> decisions() const;

 private:
  struct Counted {
    std::string topic, what, first_fault;
    std::vector<std::int64_t> frames;  ///< each once, though a recording is read several times
  };
  mutable std::mutex mutex_;
  std::vector<InputDecision> added_;
  std::vector<Counted> counted_;
};

/// Returns the decision as a line: the sentence, and the option that overrides it.
std::string line_of(const InputDecision& decision);
/// Returns the decisions as an array of objects with topic, sentence, count, option and advice.
nlohmann::json to_json(const std::vector<InputDecision>& decisions);

}  // namespace roomradar
