// The stages' messages, and those of ROS that they read, through vins_msgs/conversions.h. The first
// byte chooses the type, the others are a serialized message.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include <ros/serialization.h>

#include "fuzz_input.h"
#include "vins_msgs/conversions.h"

namespace {

/// Input like ros::serialization::IStream, but a number that is more than the bytes left is made
/// less: as the length of an array it would have ROS allocate before it finds that nothing is
/// there.
class BoundedStream : public ros::serialization::Stream {
 public:
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;

  BoundedStream(std::uint8_t* data, std::uint32_t count) : Stream(data, count) {}

  template <typename T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }

  void next(std::uint32_t& value) {
    ros::serialization::deserialize(*this, value);
    if (value > getLength()) value %= getLength() + 1;
  }
};

template <typename Message>
void convert(std::vector<std::uint8_t>* bytes) {
  Message message;
  BoundedStream in(bytes->data(), static_cast<std::uint32_t>(bytes->size()));
  try {
    in.next(message);
  } catch (const ros::serialization::StreamOverrunException&) {
    return;
  }
  vins::fuzz::expectResultOrInputError([&] { vins_msgs::fromMsg(message); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Convert = void (*)(std::vector<std::uint8_t>*);
  const Convert types[] = {convert<vins_msgs::FeatureFrame>,
                           convert<vins_msgs::Keyframe>,
                           convert<vins_msgs::LoopMatch>,
                           convert<vins_msgs::LoopEdge>,
                           convert<vins_msgs::Event>,
                           convert<vins_msgs::ImuBias>,
                           convert<sensor_msgs::Imu>,
                           convert<geometry_msgs::Pose>,
                           convert<vins_msgs::KeyframePoseUpdate>};
  vins::fuzz::Bytes bytes(data, size);
  const Convert type = types[bytes.byte() % std::size(types)];
  std::vector<std::uint8_t> rest = bytes.rest();
  if (!rest.empty()) type(&rest);
  return 0;
}
