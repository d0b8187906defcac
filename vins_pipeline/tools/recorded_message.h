#pragma once

#include <cstdint>
#include <string>

#include <ros/serialization.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include "vins_core/input_error.h"

namespace vins::pipeline {

/// Deserializes the bytes at the end of a message, which are an array of bytes. Unlike ROS's own
/// reading it allocates nothing before the length is known to be there.
inline void readBytes(ros::serialization::IStream* in, std::vector<std::uint8_t>* bytes) {
  std::uint32_t size = 0;
  in->next(size);
  if (size > in->getLength()) throw InputError("a message is shorter than it says");
  const std::uint8_t* begin = in->advance(size);
  bytes->assign(begin, begin + size);
}

inline void deserialize(ros::serialization::IStream* in, sensor_msgs::Image* message) {
  in->next(message->header);
  in->next(message->height);
  in->next(message->width);
  in->next(message->encoding);
  in->next(message->is_bigendian);
  in->next(message->step);
  readBytes(in, &message->data);
}

inline void deserialize(ros::serialization::IStream* in, sensor_msgs::CompressedImage* message) {
  in->next(message->header);
  in->next(message->format);
  readBytes(in, &message->data);
}

/// Of types without arrays of a size that the message says.
template <typename Message>
void deserialize(ros::serialization::IStream* in, Message* message) {
  in->next(*message);
}

/// A message from the bytes of a recording. Throws InputError where they are too few.
template <typename Message>
Message readMessage(std::string bytes) {
  ros::serialization::IStream in(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                 static_cast<std::uint32_t>(bytes.size()));
  Message message;
  try {
    deserialize(&in, &message);
  } catch (const ros::Exception&) {
    throw InputError("a message is shorter than it says");
  }
  return message;
}

}  // namespace vins::pipeline
