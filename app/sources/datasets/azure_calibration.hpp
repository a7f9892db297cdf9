// azure_calibration.hpp: the cameras of an Azure Kinect, from the calibration in its recordings.
#pragma once
#include <Eigen/Core>
#include <string>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/lens_correction.hpp"
#include "app/sources/formats/nominal_rig.hpp"

namespace roomradar {

struct AzureCalibration {
  CameraRig rig;  ///< with a colour camera if a colour size was given
  RationalLens depth_lens, colour_lens;
  /// Rotates directions from the accelerometer's frame to the depth camera's frame.
  Eigen::Matrix3d R_depth_accelerometer = Eigen::Matrix3d::Identity();
};

/// Reads a device's calibration, JSON as the Azure Kinect SDK stores it, for images of these sizes. The sizes
/// determine the mode, that is, which part of the sensor is read and whether its pixels are binned.
/// @throws Error naming `where` if the JSON is damaged or no mode has these sizes
/// Source: Azure Kinect Sensor SDK, modes and camera calibration.
AzureCalibration read_azure_calibration(const std::string& json, ImageSize depth, const ImageSize* colour,
                                        const std::string& where);

}  // namespace roomradar
