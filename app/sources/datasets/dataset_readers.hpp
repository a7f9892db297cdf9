// dataset_readers.hpp: the kinds of recordings of other programs and devices: for each, whether a file or
// folder is of the kind, and a reader of what it states.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

// The detection of kinds that are a container (is_matroska(), is_oni(), is_ros_bag(), is_ros2_bag()) is in
// app/sources/containers. The order is that of detection.

// Recordings of an iPhone or iPad with LiDAR, exported by Record3D.

/// Returns true if `folder` contains the file metadata or metadata.json, and the folder `depth`, as an export
/// by Record3D does. Also for Record3D's own form, a file .r3d or a folder `rgbd`, which index_record3d()
/// refuses.
[[nodiscard]] bool is_record3d(const std::filesystem::path& folder);

/// Lists the frames of an export by Record3D ("EXR + RGB"):
///   metadata      or metadata.json: w, h: colour size; dw, dh: depth size, px; K: intrinsics at w x h,
///                 column-major; poses: qx qy qz qw x y z (m) per frame; frameTimestamps (s) per frame
///   depth/N.exr   depth of frame N, m;  rgb/N.jpg: its colour image
/// Also reads exports that scripts have changed: depth/N.png in mm, and numbers in quotes.
/// N has no leading zeros. Without frameTimestamps, stamps are N / fps, with 30 as the default of fps.
/// Without dw and dh, depth has the size of its images; without K, an iPhone's camera is assumed. `poses` may
/// be longer or shorter than the number of frames, absent, or null where tracking was lost. The recorded
/// camera frame has y up and z backwards, and the recorded world frame has y up. Both are converted to
/// roomradar's axes. Depth is registered to the colour camera. Gravity follows from the poses, since ARKit
/// aligns its world frame with gravity.
/// @throws Error naming the file if the metadata are damaged or do not fit the images
RecordingFacts index_record3d(const std::filesystem::path& folder);

// Recordings of Azure Kinect and Femto cameras, Matroska files of the k4arecorder.

/// Lists the frames of a Matroska file with the tracks DEPTH (16 bit big-endian, mm), COLOR (MJPG, NV12, YUY2
/// or BGRA; optional) and IMU (optional), and the attachment calibration.json. Depth and colour images each
/// have their own intrinsics and lens distortion. Gravity comes from the accelerometer.
/// @throws Error naming the file if it is damaged, has no depth track, or has an unusable calibration
RecordingFacts index_azure_recording(const std::filesystem::path& path);

// Recordings of ROS as frames.

/// Topic on which roomradar writes T_world_camera as a row-major 4 x 4 matrix of doubles, without rounding.
inline constexpr const char* kPoseTopic = "/roomradar/T_world_camera";

/// Lists the frames of a recording of ROS: depth and colour images with their camera_info, each with its own
/// intrinsics. Poses come from kPoseTopic, else from tf if the depth camera's frame moves in tf. Gravity
/// comes from an IMU with known extrinsics to the depth camera (from tf or a RealSense's topics). Stamps are
/// those of the message headers, except in compressed files, where reading all headers takes too long. There,
/// a stamp is the message's time of reception plus the median of (header stamp - time of reception) over the
/// first five messages. Times of reception are stated beside the stamps.
/// @param depth_topic  name of the topic with depth images; empty: see find_streams()
/// @throws Error naming the file and its topics if it contains no depth images (on that topic)
RecordingFacts index_ros_recording(const std::shared_ptr<const MessageLog>& log,
                                   const std::string& depth_topic);

/// Opens a bag of ROS 1.
RecordingFacts index_ros1_bag(const std::filesystem::path& path, const std::string& depth_topic);
/// Opens a bag of ROS 2.
RecordingFacts index_ros2_bag(const std::filesystem::path& path, const std::string& depth_topic);

// Recordings of OpenNI and OpenNI2 as frames.

/// Lists the frames of a .oni file: depth (16zT, 16zP or raw; mm, or 0.1 mm), colour (JPEG or raw RGB, YUV,
/// grey). Intrinsics follow from the recorded horizontal field of view, or from a PrimeSense's (58.6 degrees)
/// if the file has none. If depth is not registered to colour, a baseline of 2.5 cm is assumed. Mirrored
/// images are mirrored back.
/// @throws Error naming the file if it is damaged, contains no depth, or its depth has another codec
RecordingFacts index_oni_recording(const std::filesystem::path& path);

// Databases of RTAB-Map and of its phone apps.

/// Returns true for an SQLite database named *.db with RTAB-Map's tables Node, Data and Link.
[[nodiscard]] bool is_rtabmap(const std::filesystem::path& path);

/// Lists the nodes with depth: colour (JPEG or PNG), depth (PNG of 16 bit, mm, or of four bytes per pixel, a
/// float in m), the pose of the robot or phone (12 floats), and the camera's intrinsics and pose on the
/// robot. Poses are those of the optimised graph (Admin.opt_poses) if it is there, else odometry. Sessions
/// (map_id) that no optimised graph joins have world frames of their own: only the longest then has poses.
/// Depth may have fewer pixels than colour, but is registered to it. Stamps are Node.stamp. Nodes are
/// keyframes, often a second apart.
/// @throws Error naming the file if it is damaged, older than version 0.18, or contains no camera or several
///         cameras
/// Source: RTAB-Map, DBDriverSqlite3, CameraModel.
RecordingFacts index_rtabmap(const std::filesystem::path& path);

// Recordings of ScanNet, .sens files.

/// Returns true if the file's name ends in .sens and it begins with version 4.
[[nodiscard]] bool is_scannet_sens(const std::filesystem::path& path);

/// Lists the frames of a .sens file, version 4: cameras and extrinsics of depth and colour (4 x 4, float),
/// then per frame the pose (camera to world; not finite where tracking was lost), stamps (us), a JPEG, PNG or
/// raw image, and depth (16 bit, zlib or raw; the file states the units per m). A truncated file is read up
/// to its last complete frame.
/// @throws Error naming the file if its header is damaged, or its depth has another compression
/// Source: Dai et al., ScanNet, CVPR 2017; SensReader.
RecordingFacts index_scannet_sens(const std::filesystem::path& path);

// Recordings of ElasticFusion's and Kintinuous' Logger, .klg files.

/// Returns true if the file's name ends in .klg.
[[nodiscard]] bool is_klg(const std::filesystem::path& path);

/// Lists the frames of a .klg file. The file contains the number of frames, then per frame a stamp (us), the
/// sizes of both images, depth (16 bit, mm, zlib or raw) and colour (JPEG, raw RGB or none). Depth is
/// registered to colour. The file contains no intrinsics. Like ElasticFusion, this reader assumes a focal
/// length of 528 px at a width of 640 px. A truncated file is read up to its last complete frame.
/// @throws Error naming the file if it is damaged
RecordingFacts index_klg(const std::filesystem::path& path);

// Recordings of a Kinect made by libfreenect's `fakenect-record`.

/// Returns true if the folder contains INDEX.txt.
[[nodiscard]] bool is_fakenect_dump(const std::filesystem::path& folder);

/// A line of INDEX.txt, such as d-1313283822.781270-3018607296.pgm.
struct FakenectLine {
  char kind = 0;            ///< d: depth, r: colour, a: accelerometer
  std::uint32_t ticks = 0;  ///< the device's stamp
};

/// Returns nullopt for a line that is not of the form d-TIME-STAMP.pgm, r-TIME-STAMP.ppm or
/// a-TIME-STAMP.dump, with the recorder's time of day in s.
std::optional<FakenectLine> parse_fakenect_line(std::string_view line);

/// States the frames of a folder that libfreenect recorded: INDEX.txt lists d-*.pgm (raw 11 bit depth),
/// r-*.ppm (colour) and a-*.dump (accelerometer) in the order of arrival. Colour images are paired with depth
/// images in this order, so the pairs are those of the live device. Lines of another form are left out, and
/// counted.
/// @throws Error if INDEX.txt cannot be read
RecordingFacts index_fakenect_dump(const std::filesystem::path& folder);

// Recordings in the TUM RGB-D format, roomradar's own among them.

/// Returns true if the folder contains depth.txt or rgb.txt.
[[nodiscard]] bool is_tum_rgbd(const std::filesystem::path& folder);

/// States the frames of a recording in the TUM RGB-D format:
///   depth.txt          stamp and file of each depth image (16 bit, 1/5000 m), registered to colour
///   rgb.txt            stamp and file of each colour image; optional
///   groundtruth.txt    stamp tx ty tz qx qy qz qw; optional
///   accelerometer.txt  stamp ax ay az (m/s^2); optional
///
/// File names may contain blanks. Lines that are not a stamp and a file of this folder are left out, and
/// counted. Cameras are those of a Kinect v1, or of the Xtion of BONN's dataset for folders rgbd_bonn_*.
/// @throws Error if depth.txt is missing, or rgb.txt is although there is a folder rgb
RecordingFacts index_tum_rgbd(const std::filesystem::path& folder);

// Recordings of an iPhone or iPad with LiDAR by Stray Scanner.

/// Returns true if `folder` contains a recording by Stray Scanner: odometry.csv or camera_matrix.csv, and
/// depth.
[[nodiscard]] bool is_stray_scanner(const std::filesystem::path& folder);

/// Lists the frames of a recording by Stray Scanner:
///   depth/000000.png       depth, mm
///   confidence/000000.png  0, 1 or 2; depth of confidence 0 is set to 0 (invalid)
///   rgb.mp4                colour; frame N is the video's frame N. Without it, frames have no colour
///   camera_matrix.csv      3 x 3 intrinsics for the video's size; depth has the same camera, scaled
///   odometry.csv           timestamp (s), frame, x, y, z (m), qx, qy, qz, qw: camera to world
///
/// The recorded camera's axes are roomradar's. The recorded world frame has y up and is converted to z up.
/// Gravity follows from the poses, since ARKit aligns its world frame with gravity. imu.csv is not read.
/// Lines of odometry.csv that are cut short are left out. Depth images without a line have no pose. Without
/// camera_matrix.csv, an iPhone's camera is assumed.
/// @throws Error naming the file if camera_matrix.csv is not a 3 x 3 matrix, or no depth image can be read
RecordingFacts index_stray_scanner(const std::filesystem::path& folder);

// Recordings of Redwood and Open3D, and of ICL-NUIM.

/// Returns true if `folder` contains a recording of Redwood or Open3D: depth, color (or colour, image, rgb),
/// and a trajectory (*.log, recognised by its content) or Open3D's intrinsic.json or camera_intrinsic.json.
[[nodiscard]] bool is_redwood(const std::filesystem::path& folder);

/// Lists the frames of a recording of Redwood or Open3D:
///   depth/N.png     mm, or units of 1 / depth_scale m
///   color/N.jpg     or .png; depth is registered to colour
///   *.log           per frame a line of three integers, the first the frame's number, then the 4 x 4 pose,
///                   camera to world (m); a matrix that is no rigid transform means that tracking was lost
///   intrinsic.json  or camera_intrinsic.json: width, height, intrinsic_matrix, and optional depth_scale
///
/// Without a JSON file, the intrinsics are a PrimeSense's, with a focal length of 525 px at a width of 640
/// px. Stamps are N / 30 s.
/// @throws Error naming the file and line if the trajectory or the intrinsics are damaged
RecordingFacts index_redwood(const std::filesystem::path& folder);

/// Returns true if `folder` contains a recording of ICL-NUIM in TUM format: depth, rgb and a trajectory
/// *.gt.freiburg.
[[nodiscard]] bool is_icl_nuim(const std::filesystem::path& folder);

/// Lists the frames of a recording of ICL-NUIM: depth/N.png (1/5000 m), rgb/N.png, and per frame a line
/// `N x y z qx qy qz qw` in *.gt.freiburg. Intrinsics are fx = 481.2 px and fy = -480 px, that is, y points
/// up and the camera frame is left-handed. The reader mirrors camera and world frame in y. Stamps are N / 30
/// s.
/// @throws Error naming the file and line if the trajectory is damaged
RecordingFacts index_icl_nuim(const std::filesystem::path& folder);

// Recordings in the form of the 7-Scenes dataset.

/// Returns true if a file in the folder is named like those of 7-Scenes.
[[nodiscard]] bool is_seven_scenes(const std::filesystem::path& folder);

/// States the frames of a folder in the form of 7-Scenes, also of ScanNet's SensReader, 3RScan, BundleFusion:
///   frame-XXXXXX.depth.png  or .pgm (16 bit, big-endian), mm
///   frame-XXXXXX.color.jpg  or .png; .none: the frame was recorded without colour
///   frame-XXXXXX.pose.txt   4 x 4 matrix, camera to world (m); optional
///   _info.txt               or info.txt: m_depthShift (units per metre), sizes and 4 x 4 matrices of the
///   cameras
///                           and of their places on the device; optional
///
/// Stamps are XXXXXX / 30 s. Without _info.txt, cameras are those of the dataset's Kinect v1.
/// Source: ScanNet, SensReader/c++/src/sensorData.h, saveToImages().
RecordingFacts index_seven_scenes(const std::filesystem::path& folder);

/// Reads a pose, a 4 x 4 or 3 x 4 matrix. Its rotation is replaced by the nearest exact one; rotations in
/// recordings deviate by about 1e-4. A matrix with its translation in the last row is transposed. A file that
/// is missing, empty or no rigid transform gives a StatedPose with a fault.
StatedPose read_pose_file(const std::filesystem::path& path);

// Folders of numbered images, and ScanNet's exports.

/// Returns true if the folder contains a folder depth.
[[nodiscard]] bool is_numbered_images(const std::filesystem::path& folder);

/// States the frames of a folder of numbered images:
///   depth/N.png    mm
///   color/N.jpg    or .png, also in the folder colour or rgb
///   pose/N.txt     4 x 4 matrix, camera to world (m), not finite where tracking was lost; optional
///   intrinsic/intrinsic_depth.txt, intrinsic_color.txt, extrinsic_depth.txt, extrinsic_color.txt
///                  4 x 4 matrices of the cameras and of their places on the device; optional
///
/// pose and intrinsic are those of an export by ScanNet's SensReader. Stamps are N / 30 s. Without intrinsic,
/// the cameras are those of one particular device.
/// Source: ScanNet, SensReader/python/SensorData.py, export_poses() and export_intrinsics().
RecordingFacts index_numbered_images(const std::filesystem::path& folder);

}  // namespace roomradar
