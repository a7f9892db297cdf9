// radar_bench_embree.cpp: Embree as a peer: casts rays from all vertices, forward from the object's and
// backward from the scene's.
//
// Rays miss contacts between two edges; this is the method's error. The scene's tree is rebuilt at low
// quality (Morton order, the fastest in total), the object's tree is built once at high quality.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "radar_bench_cull.hpp"
#include "radar_bench_peers.hpp"

namespace roomradar::bench {
namespace {

/// An Embree scene of one mesh, whose buffers the caller owns.
class RayMesh {
 public:
  RayMesh(RTCDevice device, RTCBuildQuality quality, RTCSceneFlags flags)
      : scene_(rtcNewScene(device)),
        geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE)),
        quality_(quality) {
    rtcSetSceneBuildQuality(scene_, quality);
    rtcSetSceneFlags(scene_, flags);
    rtcAttachGeometry(scene_, geometry_);
  }
  ~RayMesh() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }
  RayMesh(const RayMesh&) = delete;
  RayMesh& operator=(const RayMesh&) = delete;

  void build(const std::vector<std::array<float, 4>>& vertices, const std::vector<Triangle>& triangles) {
    rtcSetGeometryBuildQuality(geometry_, quality_);
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                               sizeof(vertices[0]), vertices.size());
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(Triangle), triangles.size());
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  RTCScene scene_;
  RTCGeometry geometry_;
  RTCBuildQuality quality_;
};

enum class Rays {
  kSingleFullLength,   ///< as in the published comparison
  kShortenedPackets16  ///< limited to the least distance so far, 16 at a time: the fastest found
};

class EmbreePeer final : public Peer {
 public:
  explicit EmbreePeer(Rays rays) : rays_(rays), device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device_ == nullptr) throw std::runtime_error("Embree: no device");
    scene_ = std::make_unique<RayMesh>(device_, RTC_BUILD_QUALITY_LOW, RTC_SCENE_FLAG_DYNAMIC);
  }
  ~EmbreePeer() override {
    scene_.reset();
    sensor_.reset();
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] std::string name() const override {
    return rays_ == Rays::kSingleFullLength ? "Embree, plain rays" : "Embree";
  }

  void set_sensor(const Mesh& sensor) override {
    sensor_vertices_ = sensor.vertices;
    padded_.clear();
    for (const Eigen::Vector3f& v : sensor.vertices) padded_.push_back({v.x(), v.y(), v.z(), 0.0F});
    sensor_triangles_ = sensor.triangles;
    sensor_ = std::make_unique<RayMesh>(device_, RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE);
    sensor_->build(padded_, sensor_triangles_);
  }

  std::optional<double> contact_distance_m(const FrameScene& frame, const Pose& pose,
                                           double distance_m) override {
    const SweptVolume volume = swept_volume(sensor_vertices_, pose, distance_m);
    cull(frame, volume, culled_);
    if (culled_.triangles.empty()) return std::nullopt;
    scene_->build(culled_.vertices, culled_.triangles);
    const Eigen::Isometry3f T_volume_sensor = (volume.T_volume_world * pose.T_world_sensor).cast<float>();
    const Eigen::Isometry3f T_sensor_volume = T_volume_sensor.inverse();
    const auto farthest = static_cast<float>(distance_m);
    float least_m = farthest;
    bool is_hit = false;
    shoot(scene_->scene(), T_volume_sensor, sensor_vertices_, Eigen::Vector3f::UnitZ(), least_m, is_hit);
    in_volume_.clear();
    for (std::size_t i = 0; i < culled_.vertices.size(); ++i) {
      if (culled_.is_outside[i] == 0) {
        in_volume_.emplace_back(culled_.vertices[i][0], culled_.vertices[i][1], culled_.vertices[i][2]);
      }
    }
    shoot(sensor_->scene(), T_sensor_volume, in_volume_, -T_sensor_volume.linear().col(2), least_m, is_hit);
    if (!is_hit) return std::nullopt;
    return least_m;
  }

 private:
  Rays rays_;
  RTCDevice device_;
  std::unique_ptr<RayMesh> scene_;
  std::unique_ptr<RayMesh> sensor_;
  std::vector<Eigen::Vector3f> sensor_vertices_, in_volume_;
  std::vector<std::array<float, 4>> padded_;
  std::vector<Triangle> sensor_triangles_;
  CulledScene culled_;

  void shoot(RTCScene scene, const Eigen::Isometry3f& T_scene_points,
             const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& direction, float& least_m,
             bool& is_hit) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if (rays_ == Rays::kSingleFullLength) {
      shoot_single(scene, context, T_scene_points, points, direction, least_m, is_hit);
    } else {
      shoot_packets(scene, context, T_scene_points, points, direction, least_m, is_hit);
    }
  }

  static void shoot_single(RTCScene scene, RTCIntersectContext& context,
                           const Eigen::Isometry3f& T_scene_points,
                           const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& direction,
                           float& least_m, bool& is_hit) {
    const float full_m = least_m;
    for (const Eigen::Vector3f& point : points) {
      const Eigen::Vector3f p = T_scene_points * point;
      RTCRayHit query;
      query.ray = {p.x(),  p.y(), p.z(), 0.0F, direction.x(), direction.y(), direction.z(), 0.0F,
                   full_m, ~0U,   0,     0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene, &context, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      least_m = std::min(least_m, query.ray.tfar);
      is_hit = true;
    }
  }

  static void shoot_packets(RTCScene scene, RTCIntersectContext& context,
                            const Eigen::Isometry3f& T_scene_points,
                            const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& direction,
                            float& least_m, bool& is_hit) {
    constexpr std::size_t kPacket = 16;
    alignas(64) std::array<int, kPacket> is_used;
    RTCRayHit16 query;
    for (std::size_t first = 0; first < points.size(); first += kPacket) {
      for (std::size_t i = 0; i < kPacket; ++i) {
        is_used[i] = first + i < points.size() ? -1 : 0;
        const Eigen::Vector3f p = T_scene_points * points[is_used[i] != 0 ? first + i : first];
        query.ray.org_x[i] = p.x();
        query.ray.org_y[i] = p.y();
        query.ray.org_z[i] = p.z();
        query.ray.tnear[i] = 0.0F;
        query.ray.dir_x[i] = direction.x();
        query.ray.dir_y[i] = direction.y();
        query.ray.dir_z[i] = direction.z();
        query.ray.time[i] = 0.0F;
        query.ray.tfar[i] = least_m;
        query.ray.mask[i] = ~0U;
        query.ray.id[i] = 0;
        query.ray.flags[i] = 0;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(is_used.data(), scene, &context, &query);
      for (std::size_t i = 0; i < kPacket; ++i) {
        if (is_used[i] == 0 || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        least_m = std::min(least_m, query.ray.tfar[i]);
        is_hit = true;
      }
    }
  }
};

}  // namespace
}  // namespace roomradar::bench

extern "C" [[gnu::visibility("default")]] void make_peers(
    std::vector<std::unique_ptr<roomradar::bench::Peer>>& peers) {
  using namespace roomradar::bench;
  peers.push_back(std::make_unique<EmbreePeer>(Rays::kShortenedPackets16));
  peers.push_back(std::make_unique<EmbreePeer>(Rays::kSingleFullLength));
}
