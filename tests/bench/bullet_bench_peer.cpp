// bullet_bench_peer.cpp: the same scenes in Bullet.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_bench_scenes.hpp"

namespace roomradar::bench {
namespace {

constexpr btScalar kMargin_m = 0.001;

btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::unique_ptr<btTriangleMesh> triangles_of(const Mesh& mesh, const Eigen::Vector3d& centre) {
  auto triangles = std::make_unique<btTriangleMesh>();
  const auto at = [&](std::uint32_t v) {
    return to_bullet(mesh.origin + mesh.vertices[v].cast<double>() - centre);
  };
  for (const Triangle& t : mesh.triangles) triangles->addTriangle(at(t[0]), at(t[1]), at(t[2]));
  return triangles;
}

/// A body, with what it refers to. Bullet's frame is at the centre of mass.
struct PeerBody {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btMotionState> state;
  std::unique_ptr<btRigidBody> body;
};

PeerBody body_of(const Entry& entry, BulletMotion motion) {
  const MassProperties& mass = entry.thing->mass;
  PeerBody peer;
  if (entry.is_convex) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Eigen::Vector3f& v : entry.thing->mesh.vertices)
      hull->addPoint(to_bullet(entry.thing->mesh.origin + v.cast<double>() - mass.centre_object), false);
    hull->recalcLocalAabb();
    hull->optimizeConvexHull();
    peer.shape = std::move(hull);
    peer.shape->setMargin(kMargin_m);
  } else {
    peer.triangles = triangles_of(entry.thing->mesh, mass.centre_object);
    auto shape = std::make_unique<btGImpactMeshShape>(peer.triangles.get());
    shape->setMargin(kMargin_m);
    shape->updateBound();
    peer.shape = std::move(shape);
  }
  Eigen::Isometry3d T = entry.T_world_object;
  T.translation() = entry.T_world_object * mass.centre_object;
  btTransform transform;
  const Eigen::Quaterniond q(T.linear());
  transform.setOrigin(to_bullet(T.translation()));
  transform.setRotation(btQuaternion(q.x(), q.y(), q.z(), q.w()));
  peer.state = std::make_unique<btDefaultMotionState>(transform);
  const Eigen::Vector3d inertia = mass.mass_kg * mass.inertia_m2.diagonal();
  btRigidBody::btRigidBodyConstructionInfo info(mass.mass_kg, peer.state.get(), peer.shape.get(),
                                                to_bullet(inertia));
  info.m_friction = std::sqrt(0.5);  // Bullet multiplies both coefficients: 0.5
  info.m_rollingFriction = 0.001;
  peer.body = std::make_unique<btRigidBody>(info);
  peer.body->setLinearVelocity(to_bullet(entry.velocity_world_mps));
  peer.body->setAngularVelocity(to_bullet(entry.angular_velocity_world_rad_s));
  if (motion == BulletMotion::kContinuous) {
    btVector3 low, high;
    peer.shape->getAabb(btTransform::getIdentity(), low, high);
    const btScalar thinnest = 0.5 * (high - low)[(high - low).minAxis()];
    peer.body->setCcdMotionThreshold(thinnest);
    peer.body->setCcdSweptSphereRadius(0.9 * thinnest);
  }
  return peer;
}

/// A surface at rest.
struct PeerSurface {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
  std::unique_ptr<btRigidBody> body;

  explicit PeerSurface(const Mesh& mesh) : triangles(triangles_of(mesh, Eigen::Vector3d::Zero())) {
    shape = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
    shape->setMargin(kMargin_m);
    body = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0.0, nullptr, shape.get()));
    body->setFriction(std::sqrt(0.5));
    body->setRollingFriction(1.0);
  }
};

Eigen::Isometry3d pose_of(const btRigidBody& body, const MassProperties& mass) {
  const btTransform& transform = body.getWorldTransform();
  const btQuaternion q = transform.getRotation();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  const btVector3& origin = transform.getOrigin();
  T.translation() = Eigen::Vector3d(origin.x(), origin.y(), origin.z()) - T.linear() * mass.centre_object;
  return T;
}

std::vector<Eigen::Isometry3d> poses_of(const std::vector<PeerBody>& bodies,
                                        const std::vector<Entry>& entries) {
  std::vector<Eigen::Isometry3d> T_world_object;
  for (std::size_t i = 0; i < entries.size(); ++i)
    T_world_object.push_back(pose_of(*bodies[i].body, entries[i].thing->mass));
  return T_world_object;
}

}  // namespace

Simulated simulate_with_bullet(const Surroundings& surroundings, const std::vector<Entry>& entries,
                               int frames, BulletMotion motion) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0.0, 0.0, -9.81});
  std::vector<PeerSurface> surfaces;
  for (const Mesh* mesh : {&surroundings.room, &surroundings.unknown})
    if (!mesh->triangles.empty()) surfaces.emplace_back(*mesh);
  for (const PeerSurface& surface : surfaces) world.addRigidBody(surface.body.get());
  std::vector<PeerBody> bodies;
  for (const Entry& entry : entries) bodies.push_back(body_of(entry, motion));
  Simulated result;
  std::vector<bool> is_present(entries.size());
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<Eigen::Isometry3d> T_world_object = poses_of(bodies, entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (is_present[i] || entries[i].frame > frame) continue;
      is_present[i] = is_place_free(entries[i], entries, T_world_object, is_present);
      if (is_present[i]) world.addRigidBody(bodies[i].body.get());
    }
    const double start_ms = test::wall_ms(), cpu_ms = test::process_ms();
    world.stepSimulation(kBenchFrame_s, 2, 0.5 * kBenchFrame_s);
    result.frames.samples_ms.push_back(test::wall_ms() - start_ms);
    result.cpu.samples_ms.push_back(test::process_ms() - cpu_ms);
  }
  result.T_world_object = poses_of(bodies, entries);
  for (const PeerBody& peer : bodies) result.asleep += !peer.body->isActive();
  result.entered = static_cast<int>(std::count(is_present.begin(), is_present.end(), true));
  for (PeerBody& peer : bodies)
    if (peer.body->getBroadphaseHandle() != nullptr) world.removeRigidBody(peer.body.get());
  for (const PeerSurface& surface : surfaces) world.removeRigidBody(surface.body.get());
  return result;
}

}  // namespace roomradar::bench
