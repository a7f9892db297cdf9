// radar_bench_fcl.cpp: FCL as a peer: conservative advancement on its exact mesh distance.
//
// FCL 0.7's own continuousCollide would be no fair comparison. It lacks the bounds of moving boxes for
// translations; it was off by up to 212 mm on these poses, and slow (9 to 2,500 ms). The distance query is
// sound: advancing by it until the gap is below a tolerance finds the contact from below. RSS, OBBRSS and
// kIOS, float and double, and all split rules were tried on the same poses. RSS in float, split at the mean,
// is the fastest correct one. It receives the culled triangles in the volume's frame.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/narrowphase/distance.h>

#include "radar_bench_cull.hpp"
#include "radar_bench_peers.hpp"

namespace roomradar::bench {
namespace {

using Model = fcl::BVHModel<fcl::RSS<float>>;

class FclPeer final : public Peer {
 public:
  [[nodiscard]] std::string name() const override { return "FCL"; }

  void set_sensor(const Mesh& sensor) override {
    sensor_vertices_ = sensor.vertices;
    points_.assign(sensor.vertices.begin(), sensor.vertices.end());
    triangles_.clear();
    for (const Triangle& t : sensor.triangles) triangles_.emplace_back(t[0], t[1], t[2]);
    build(sensor_);
  }

  std::optional<double> contact_distance_m(const FrameScene& frame, const Pose& pose,
                                           double distance_m) override {
    const SweptVolume volume = swept_volume(sensor_vertices_, pose, distance_m);
    cull(frame, volume, culled_);
    if (culled_.triangles.empty()) return std::nullopt;
    gather();
    build(scene_);
    fcl::Transform3<float> T_volume_sensor = (volume.T_volume_world * pose.T_world_sensor).cast<float>();
    const fcl::Transform3<float> T_volume_scene = fcl::Transform3<float>::Identity();
    const fcl::DistanceRequest<float> request;
    constexpr float kTouching_m = 1e-4F;
    constexpr int kMaxSteps = 1000;
    double contact_distance_m = 0.0;
    for (int step = 0; step < kMaxSteps && contact_distance_m <= distance_m; ++step) {
      T_volume_sensor.translation().z() = static_cast<float>(contact_distance_m);
      fcl::DistanceResult<float> result;
      const float gap_m =
          fcl::distance(&*sensor_, T_volume_sensor, &*scene_, T_volume_scene, request, result);
      if (gap_m < kTouching_m) return contact_distance_m;
      contact_distance_m += gap_m;
    }
    return std::nullopt;
  }

 private:
  std::optional<Model> sensor_, scene_;
  std::vector<Eigen::Vector3f> sensor_vertices_;
  std::vector<fcl::Vector3<float>> points_;
  std::vector<fcl::Triangle> triangles_;
  std::vector<int> index_of_;
  CulledScene culled_;

  /// Collects the culled triangles with only the vertices that they use.
  void gather() {
    points_.clear();
    triangles_.clear();
    index_of_.assign(culled_.vertices.size(), -1);
    const auto index = [&](std::uint32_t vertex) {
      if (index_of_[vertex] < 0) {
        index_of_[vertex] = static_cast<int>(points_.size());
        const auto& p = culled_.vertices[vertex];
        points_.emplace_back(p[0], p[1], p[2]);
      }
      return static_cast<std::size_t>(index_of_[vertex]);
    };
    for (const Triangle& t : culled_.triangles)
      triangles_.emplace_back(index(t[0]), index(t[1]), index(t[2]));
  }

  /// Creates a new model: this FCL version cannot rebuild a model.
  void build(std::optional<Model>& model) const {
    model.emplace();
    model->beginModel(static_cast<int>(triangles_.size()), static_cast<int>(points_.size()));
    model->addSubModel(points_, triangles_);
    model->endModel();
  }
};

}  // namespace
}  // namespace roomradar::bench

extern "C" [[gnu::visibility("default")]] void make_peers(
    std::vector<std::unique_ptr<roomradar::bench::Peer>>& peers) {
  peers.push_back(std::make_unique<roomradar::bench::FclPeer>());
}
