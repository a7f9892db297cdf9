// bag_frame_writer.cpp: ROS 1's encoding of messages, and their definitions.
#include "app/sources/recordings/bag_frame_writer.hpp"

#include <array>
#include <cstring>

#include "app/sources/datasets/dataset_readers.hpp"
#include "app/sources/formats/kinect_units.hpp"

namespace roomradar {
namespace {

// Fields of the types, without comments, as ROS computes the MD5 sums from them.
#define ROOMRADAR_RULE "================================================================================\n"
#define ROOMRADAR_HEADER ROOMRADAR_RULE "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
constexpr RosType kImage = {
    "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743",
    "Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
    "uint32 step\nuint8[] data\n" ROOMRADAR_HEADER};
constexpr RosType kCameraInfo = {
    "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214",
    "Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] D\nfloat64[9] K\n"
    "float64[9] R\nfloat64[12] P\nuint32 binning_x\nuint32 binning_y\nRegionOfInterest roi\n" ROOMRADAR_HEADER
        ROOMRADAR_RULE
    "MSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\n"
    "bool do_rectify\n"};
constexpr RosType kTf = {
    "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec",
    "geometry_msgs/TransformStamped[] transforms\n" ROOMRADAR_RULE
    "MSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform "
    "transform\n" ROOMRADAR_HEADER ROOMRADAR_RULE
    "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n" ROOMRADAR_RULE
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" ROOMRADAR_RULE
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"};
constexpr RosType kImu = {
    "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
    "Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
    "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
    "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n" ROOMRADAR_HEADER
        ROOMRADAR_RULE
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" ROOMRADAR_RULE
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"};
constexpr RosType kNumbers = {
    "std_msgs/Float64MultiArray", "4b7d974086d4060e7db4613a7e6c3ba4",
    "MultiArrayLayout layout\nfloat64[] data\n" ROOMRADAR_RULE
    "MSG: std_msgs/MultiArrayLayout\nMultiArrayDimension[] dim\nuint32 data_offset\n" ROOMRADAR_RULE
    "MSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride\n"};
#undef ROOMRADAR_HEADER
#undef ROOMRADAR_RULE

constexpr std::string_view kDepthFrame = "camera_depth_optical_frame",
                           kColourFrame = "camera_color_optical_frame", kWorldFrame = "world";

/// Appends fields in ROS 1's encoding.
class Message {
 public:
  template <typename Number>
  Message& add(Number number) {
    return raw(&number, sizeof number);
  }
  Message& add(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size()));
    return raw(text.data(), text.size());
  }
  Message& header(std::uint32_t sequence, std::uint64_t time, std::string_view frame_id) {
    return add(sequence).add(time).add(frame_id);
  }
  template <typename Vector>
  Message& numbers(const Vector& values) {
    for (const double value : values) add(value);
    return *this;
  }
  Message& zeros(int count) {
    for (int i = 0; i < count; ++i) add(0.0);
    return *this;
  }
  Message& raw(const void* from, std::size_t count) {
    bytes_.append(static_cast<const char*>(from), count);
    return *this;
  }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

template <typename Pixel>
Message image_message(const Image<Pixel>& image, std::string_view encoding, std::uint32_t sequence,
                      std::uint64_t time, std::string_view frame_id) {
  Message message;
  const std::size_t bytes = image.pixels.size() * sizeof(Pixel);
  message.header(sequence, time, frame_id)
      .add(static_cast<std::uint32_t>(image.height))
      .add(static_cast<std::uint32_t>(image.width))
      .add(encoding)
      .add(std::uint8_t{0})
      .add(static_cast<std::uint32_t>(static_cast<std::size_t>(image.width) * sizeof(Pixel)))
      .add(static_cast<std::uint32_t>(bytes))
      .raw(image.pixels.data(), bytes);
  return message;
}

Message info_message(const Intrinsics& camera, std::uint32_t sequence, std::uint64_t time,
                     std::string_view frame_id) {
  const double fx = camera.fx_px, fy = camera.fy_px, cx = camera.cx_px, cy = camera.cy_px;
  Message message;
  message.header(sequence, time, frame_id)
      .add(static_cast<std::uint32_t>(camera.height_px))
      .add(static_cast<std::uint32_t>(camera.width_px))
      .add(std::string_view("plumb_bob"))
      .add(std::uint32_t{5})
      .zeros(5)
      .numbers(std::array{fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0})
      .numbers(std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0})
      .numbers(std::array{fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0});
  for (int i = 0; i < 6; ++i) message.add(std::uint32_t{0});  // binning and region of interest
  message.add(std::uint8_t{0});
  return message;
}

Message transform_message(const Eigen::Isometry3d& T_parent_child, std::uint32_t sequence, std::uint64_t time,
                          std::string_view parent, std::string_view child) {
  const Eigen::Quaterniond q(T_parent_child.linear());
  Message message;
  message.add(std::uint32_t{1})
      .header(sequence, time, parent)
      .add(child)
      .numbers(T_parent_child.translation());
  message.numbers(std::array{q.x(), q.y(), q.z(), q.w()});
  return message;
}

}  // namespace

BagFrameWriter::BagFrameWriter(const std::filesystem::path& path)
    : bag_(path),
      depth_(bag_.add_topic("/camera/depth/image", kImage)),
      depth_info_(bag_.add_topic("/camera/depth/camera_info", kCameraInfo)),
      colour_(bag_.add_topic("/camera/color/image", kImage)),
      colour_info_(bag_.add_topic("/camera/color/camera_info", kCameraInfo)),
      tf_(bag_.add_topic("/tf", kTf)),
      tf_static_(bag_.add_topic("/tf_static", kTf)),
      imu_(bag_.add_topic("/imu", kImu)),
      pose_(bag_.add_topic(kPoseTopic, kNumbers)) {}

void BagFrameWriter::write(const Frame& frame) {
  const std::uint64_t time = ros_time(frame.stamp_s);
  const std::uint32_t n = sequence_++;
  if (n == 0 && frame.colour_camera.width_px > 0)
    bag_.write(tf_static_, time,
               transform_message(frame.T_colour_depth.inverse(), n, time, kDepthFrame, kColourFrame).bytes());
  bag_.write(depth_info_, time, info_message(frame.depth_camera, n, time, kDepthFrame).bytes());
  if (frame.T_world_camera) {
    bag_.write(tf_, time,
               transform_message(*frame.T_world_camera, n, time, kWorldFrame, kDepthFrame).bytes());
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = frame.T_world_camera->matrix();
    Message pose;
    pose.add(std::uint32_t{0})
        .add(std::uint32_t{0})
        .add(std::uint32_t{16})
        .raw(matrix.data(), 16 * sizeof(double));
    bag_.write(pose_, time, pose.bytes());
  }
  if (frame.down_camera) {
    const Eigen::Vector3d acceleration_m_s2 = -kStandardGravity_m_s2 * *frame.down_camera;
    Message imu;
    imu.header(n, time, kDepthFrame)
        .numbers(std::array{0.0, 0.0, 0.0, 1.0})
        .numbers(std::array{-1.0})
        .zeros(8);
    imu.zeros(3).numbers(std::array{-1.0}).zeros(8).numbers(acceleration_m_s2).zeros(9);
    bag_.write(imu_, time, imu.bytes());
  }
  bag_.write(depth_, time, image_message(frame.depth_m, "32FC1", n, time, kDepthFrame).bytes());
  if (frame.colour.empty()) return;
  const std::uint64_t colour_time = ros_time(frame.stamp_s + frame.colour_after_depth_s);
  bag_.write(colour_info_, colour_time,
             info_message(frame.colour_camera, n, colour_time, kColourFrame).bytes());
  bag_.write(colour_, colour_time, image_message(frame.colour, "rgb8", n, colour_time, kColourFrame).bytes());
}

}  // namespace roomradar
