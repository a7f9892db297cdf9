// session_runner.hpp: a session and the thread that makes all its calls.
#pragma once
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "app/python/long_calls.hpp"
#include "app/python/maps.hpp"
#include "app/session/session.hpp"
#include "app/session/session_fingerprint.hpp"
#include "radar/gl/gl_thread.hpp"

namespace roomradar::python {

/// Python values of quality fields, by field name.
using QualityValues = std::map<std::string, std::variant<bool, std::int64_t, double, std::string>>;

/// Returns a quality with the given fields, the others unchanged. Throws Error for an unknown field or value.
RunQuality quality_with(RunQuality quality, const QualityValues& values);

/// Settings of a session that cannot change after construction.
struct SessionSettings {
  PoseOrigin poses = PoseOrigin::kAuto;
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_is_solid = true;  ///< has no effect unless `surfaces` is kMap
  bool make_picture = true;
  bool measure_penetration = false;
  RunQuality quality{};
};

/// A session on a thread of its own. Call all members without the interpreter's lock. Calls from several
/// threads are serialised. Members throw Error once the session is closed.
class SessionRunner : public std::enable_shared_from_this<SessionRunner> {
 public:
  SessionRunner(std::shared_ptr<Map> map, const SessionSettings& settings);
  ~SessionRunner();
  SessionRunner(const SessionRunner&) = delete;
  SessionRunner& operator=(const SessionRunner&) = delete;

  /// Calls work(Session&) on the session's thread.
  template <typename Work>
  auto run(const Work& work) {
    using Result = std::invoke_result_t<Work, Session&>;
    if constexpr (std::is_void_v<Result>) {
      thread_.run([&] { work(opened()); });
    } else {
      std::optional<Result> result;
      thread_.run([&] { result.emplace(work(opened())); });
      return *std::move(result);
    }
  }

  FrameResult step(const Frame& frame);
  void set_quality(const QualityValues& values);
  /// Returns the contact of an object with everything in the room; see CyberRadar::query().
  Contact query(const TriangleTree& object, RadarQuery of);
  /// Returns the time of each stage in the last frame, ms.
  std::map<std::string, double> newest_ms();
  FrameFingerprint fingerprint();

  /// Frees the session. Throws Error while arrays share memory with its images.
  void close();
  /// Frees the session, unless it is closed or arrays share memory with its images.
  void leave();

  /// Number of arrays that share memory with the session's images. While it is > 0, calls that would change
  /// an image's size throw Error, as does close().
  std::atomic<int> views = 0;

 private:
  struct ImageSizes {
    int depth_width = 0, depth_height = 0, colour_width = 0, colour_height = 0;
    friend bool operator==(const ImageSizes&, const ImageSizes&) = default;
  };

  std::shared_ptr<Map> map_;
  RunQuality quality_;
  StageTimes times_;
  CyberRadar radar_;
  std::optional<ImageSizes> sizes_;   ///< image sizes of the last valid frame
  std::int64_t frames_ = 0;           ///< number of calls of step()
  std::unique_ptr<Session> session_;  ///< made, used and destroyed on thread_; null: closed
  GlThread thread_;

  Session& opened();
  void require_no_views() const;
  void require_sizes_kept(const Frame& frame) const;
  static ImageSizes sizes_of(const Frame& frame);
};

}  // namespace roomradar::python
