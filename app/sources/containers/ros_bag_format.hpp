// ros_bag_format.hpp: constants of ROS 1's bags, format 2.0. Source: wiki.ros.org/Bags/Format/2.0.
#pragma once
#include <cstdint>
#include <string_view>

namespace roomradar {

inline constexpr std::string_view kRosBagMagic = "#ROSBAG V2.0\n";

/// Record types, the values of a record's field "op".
enum class RosBagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

}  // namespace roomradar
