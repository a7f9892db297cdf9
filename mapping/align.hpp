// align.hpp: the pose of a depth (and intensity) image relative to views whose poses are known.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string_view>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

enum class TrackStatus {
  kTracked,       ///< all six directions of motion are fixed by what was seen
  kTooFewPoints,  ///< hardly anything of the image meets the reference; the pose is the guess
  kDegenerate,    ///< some directions are not fixed (one wall): these are the guess's, the others are aligned
  kDiverged,      ///< the image does not agree with the reference at the pose found
};
std::string_view to_string(TrackStatus status);

/// A pose found by alignment. Unset means failed.
struct [[nodiscard]] Tracking {
  TrackStatus status = TrackStatus::kDiverged;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< always finite
  double rms_m = -1.0;           ///< of the inliers' distances to the reference's planes; < 0: none
  double inlier_fraction = 0.0;  ///< of the points that met the reference, those within the noise
  double overlap = 0.0;          ///< of the image's points, those that met the reference
  int held_directions = 0;       ///< 0..6: how many directions of motion are the guess's
  /// Inverse covariance of the error of T_world_camera, as a twist (translation m, rotation rad) in the
  /// camera frame: T_true = T_world_camera * exp(twist). Residuals of neighbouring pixels are not
  /// independent; this is discounted.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  explicit operator bool() const { return status == TrackStatus::kTracked; }
};

struct AlignConfig {
  int finest_width_px = 320;  ///< images wider than this are halved until they are not
  int levels = 3;             ///< of the pyramid, each half the size of the one before
  int iterations = 6;         ///< at most, a level
  float min_depth_m = 0.3F;
  float max_depth_m = 6.0F;  ///< beyond this a Kinect v1 is off by more than 6 cm
  float gate_m = 0.10F;      ///< distance to the reference's plane past which a point says nothing; at the
                             ///< coarsest level, going down to the noise at the finest
  float intensity_sigma = 8.0F;  ///< grey levels of 255; 0 leaves the colour out
  int min_points = 150;          ///< that must meet the reference at the finest level
  float min_inlier_fraction = 0.3F;
  float min_constraint =
      0.003F;  ///< mean squared cosine between normals and a direction, below which the depth is
               ///< said not to fix it: at 0.003 the normals' own noise looks like information
};

/// One resolution of an image prepared for alignment: what a reference pixel says about a point near it.
/// 32 bytes, so that looking one up touches one cache line.
struct ReferencePixel {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, towards the camera; zero: none
  float offset_m = 0.0F;                               ///< normal . p for the points p of the surface; < 0
  float intensity = -1.0F;                             ///< 0..255, or -1
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();  ///< of the intensity, per pixel
  float sigma_m = 0.0F;  ///< standard deviation of the distance along the normal
};

struct ReferenceLevel {
  Intrinsics camera;
  Image<ReferencePixel> pixels;
};

/// A view whose pose is known. Levels from fine to coarse.
struct ReferenceView {
  std::vector<ReferenceLevel> levels;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

struct LivePoint {
  Eigen::Vector3f p_camera;  ///< m
  float sigma_m;             ///< standard deviation of its depth
  float intensity;           ///< 0..255, or -1
};

/// The image to be aligned: its points, thinned. Levels from fine to coarse.
struct LiveView {
  std::vector<std::vector<LivePoint>> levels;
};

/// An image's depth and intensity at several resolutions, from fine to coarse.
/// Inverse depth is what is averaged: of a plane it is linear over the image, and its noise is the same
/// everywhere.
struct ViewPyramid {
  struct Level {
    Intrinsics camera;
    Image<float> inverse_depth_per_m;  ///< 0: none
    Image<float> intensity;            ///< 0..255, -1: none; empty: no colour at all
  };
  std::vector<Level> levels;
  Image<float> grey;  ///< scratch: the colour image, smoothed and of the finest level's size
};

/// Depth halved until it is at most finest_width_px wide, and colour seen from the depth camera, then
/// `levels` sizes. Pixels are taken as valid between min_depth_m and max_depth_m. Reuses what `pyramid` has
/// allocated.
void make_pyramid(const Frame& frame, const AlignConfig& config, ViewPyramid& pyramid);
/// The same without colour, for rendered depth. Throws nothing; depth_m must have the camera's size.
void make_pyramid(const DepthImage& depth_m, const Intrinsics& camera, const AlignConfig& config,
                  ViewPyramid& pyramid);

/// Planes fitted to each pixel's surroundings, with holes where there is no surface or it bends too much.
void make_reference(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                    ReferenceView& reference);

/// The points of an image. `ignore`, if not empty, is of the depth image's size; its pixels at 255 are left
/// out.
void make_live(const ViewPyramid& pyramid, LiveView& live, const MaskImage& ignore = {});

/// Finds T_world_camera such that the image's points lie on the planes that the references show at the pixels
/// where these points project (and show the same intensity, up to one gain and offset an image). Gauss-Newton
/// from coarse to fine; weights by the depths' standard deviations, robust to parts of the image that have
/// moved. A reference counts with what it overlaps; null pointers are not allowed. Never throws; a guess that
/// is not finite answers kDiverged. Directions that nothing fixes keep the guess's value and are counted in
/// held_directions. Source: Chen and Medioni 1992 (point to plane); Newcombe et al., KinectFusion, ISMAR 2011
/// (projective association); Zhang, Kaess, Singh, On Degeneracy of Optimization-based State Estimation
/// Problems, ICRA 2016.
Tracking align(const LiveView& live, std::span<const ReferenceView* const> references,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// The same with one reference.
Tracking align(const LiveView& live, const ReferenceView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

}  // namespace roomradar
