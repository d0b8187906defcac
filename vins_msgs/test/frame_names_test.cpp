#include "vins_msgs/frame_names.h"

#include <gtest/gtest.h>

namespace vins_msgs {
namespace {

std::string refusalOf(const FrameNames& names) {
  try {
    names.validate("/vins_estimator");
  } catch (const vins::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FrameNames, DefaultsAreThoseOfRep105) {
  const FrameNames names;
  EXPECT_EQ(refusalOf(names), "");
  EXPECT_EQ(names.child(), "body");
  EXPECT_FALSE(names.hasBase());
}

TEST(FrameNames, ABaseTakesTheBodysPlace) {
  FrameNames names;
  names.base = "base_link";
  EXPECT_TRUE(names.hasBase());
  EXPECT_EQ(names.child(), "base_link");
  names.base = names.body;
  EXPECT_FALSE(names.hasBase());
  EXPECT_EQ(refusalOf(names), "");
}

TEST(FrameNames, WhatTfWouldRefuseIsNamed) {
  FrameNames names;
  names.camera = "";
  EXPECT_EQ(refusalOf(names), "") << "not published";
  names.odom = "";
  EXPECT_NE(refusalOf(names).find("parameter /vins_estimator/odom_frame is ''"), std::string::npos);
  names.odom = "/odom";
  EXPECT_NE(refusalOf(names).find("slash"), std::string::npos);
  names.odom = "map";
  EXPECT_NE(refusalOf(names).find("another name than that of map_frame"), std::string::npos);
}

}  // namespace
}  // namespace vins_msgs
