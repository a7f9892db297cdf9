// collapse_queue.hpp: priority queue of edges to collapse, cheapest first.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar {

/// An edge to collapse, with the versions of its vertices at the time the cost was computed.
struct Candidate {
  float cost = 0.0F;
  std::uint32_t kept = 0;
  std::uint32_t gone = 0;
  std::uint32_t kept_version = 0;
  std::uint32_t gone_version = 0;
};

/// Bucket queue. Pops candidates in order of cost, rounded to four steps per factor of two. Candidates of
/// equal rounded cost are popped first in, first out, so flat areas thin out evenly. A heap would take longer
/// than all other work of the simplification.
class CandidateQueue {
 public:
  void push(const Candidate& candidate) {
    const std::size_t bucket = std::bit_cast<std::uint32_t>(candidate.cost) >> 21U;  // cost >= 0
    buckets_[bucket].waiting.push_back(candidate);
    cheapest_ = std::min(cheapest_, bucket);
  }
  bool pop(Candidate& candidate) {
    for (; cheapest_ < buckets_.size(); ++cheapest_) {
      Bucket& bucket = buckets_[cheapest_];
      if (bucket.taken < bucket.waiting.size()) {
        candidate = bucket.waiting[bucket.taken++];
        return true;
      }
      bucket = Bucket{};
    }
    return false;
  }

 private:
  struct Bucket {
    std::vector<Candidate> waiting;
    std::size_t taken = 0;
  };
  std::array<Bucket, 1024> buckets_;
  std::size_t cheapest_ = 0;
};

}  // namespace roomradar
