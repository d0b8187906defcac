#include "vins_msgs/odometry.h"

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins_msgs {
namespace {

using Eigen::Vector3d;
using vins::Pose;
using vins::se3::Matrix6d;

constexpr double kRounding = 1e-12;

/// EuRoC's body: x up, so that an error of the yaw is one about the body's x.
const Eigen::Quaterniond kXUp = vins::so3::exp({0.0, -M_PI / 2.0, 0.0});

nav_msgs::Odometry someOdometry() {
  Matrix6d pose = Matrix6d::Zero(), twist = Matrix6d::Zero();
  pose.diagonal() << 0.01, 0.02, 0.03, 0.09, 0.001, 0.002;
  pose(1, 3) = pose(3, 1) = 0.005;
  twist.diagonal() << 1.0, 2.0, 3.0, 0.1, 0.2, 0.3;
  twist(0, 5) = twist(5, 0) = 0.1;
  nav_msgs::Odometry odometry;
  odometry.header.frame_id = "odom";
  odometry.child_frame_id = "body";
  odometry.pose = toMsg(Pose(kXUp, {1.0, 2.0, 3.0}), pose);
  odometry.twist = toMsg(Vector3d(0.5, 0.0, -0.2), Vector3d(0.1, 0.2, 0.3), twist);
  return odometry;
}

TEST(Odometry, YawVarianceIsAboutTheVerticalWhateverTheBodysAxes) {
  const nav_msgs::Odometry odometry = someOdometry();
  EXPECT_NEAR(odometry.pose.covariance[35], 0.09, kRounding) << "about z";
  EXPECT_NEAR(odometry.pose.covariance[21], 0.002, kRounding) << "about x: the body's z";
  EXPECT_NEAR(odometry.pose.covariance[6 + 5], 0.005, kRounding) << "of y with the yaw";
}

TEST(Odometry, InTheMapItsCovarianceTurnsAndTheMapsOwnIsAdded) {
  Matrix6d of_map = Matrix6d::Zero();
  of_map(5, 5) = 0.04;  // yaw
  const Pose T_mo(vins::so3::exp({0.0, 0.0, M_PI / 2.0}), {10.0, 0.0, 0.0});
  const nav_msgs::Odometry odometry = inParentFrame(someOdometry(), "map", T_mo, of_map);
  EXPECT_EQ(odometry.header.frame_id, "map");
  EXPECT_EQ(odometry.child_frame_id, "body");
  EXPECT_NEAR(odometry.pose.pose.position.x, 8.0, kRounding);
  const Matrix6d covariance = covarianceOf(odometry.pose);
  EXPECT_NEAR(covariance(5, 5), 0.09 + 0.04, kRounding);
  // The body is 2 m to the left and 1 m ahead of odom's origin, seen in the map's axes (-2, 1, 3).
  EXPECT_NEAR(covariance(0, 0), 0.02 + 0.04 * 1.0 * 1.0, kRounding);
  EXPECT_NEAR(covariance(1, 1), 0.01 + 0.04 * 2.0 * 2.0, kRounding);
  EXPECT_NEAR(covariance(2, 2), 0.03, kRounding);
  EXPECT_EQ(odometry.twist.covariance, someOdometry().twist.covariance);
}

TEST(Odometry, OfAnotherFrameOfTheBodyItSwingsWithTheLever) {
  const Pose T_bd(vins::so3::exp({0.0, 0.0, M_PI / 2.0}), {0.0, 2.0, 0.0});
  const nav_msgs::Odometry odometry = ofChildFrame(someOdometry(), "base_link", T_bd);
  EXPECT_EQ(odometry.header.frame_id, "odom");
  EXPECT_EQ(odometry.child_frame_id, "base_link");
  // The body's y is the world's y.
  EXPECT_NEAR(odometry.pose.pose.position.y, 4.0, kRounding);
  // The lever of 2 m along y: a yaw error moves x.
  EXPECT_NEAR(covarianceOf(odometry.pose)(0, 0), 0.01 + 4.0 * 0.09, kRounding);
  // v + w x p = (0.5, 0, -0.2) + (0.1, 0.2, 0.3) x (0, 2, 0) = (-0.1, 0, 0), in the frame's axes.
  EXPECT_NEAR(odometry.twist.twist.linear.x, 0.0, kRounding);
  EXPECT_NEAR(odometry.twist.twist.linear.y, 0.1, kRounding);
  EXPECT_NEAR(odometry.twist.twist.linear.z, 0.0, kRounding);
  EXPECT_NEAR(odometry.twist.twist.angular.x, 0.2, kRounding);
  // Along the body's x, now -y: var(v_x - 2 w_z) = 1 + 4 * 0.3 - 4 * 0.1.
  EXPECT_NEAR(covarianceOf(odometry.twist)(1, 1), 1.0 + 1.2 - 0.4, kRounding);
  const nav_msgs::Odometry back = ofChildFrame(odometry, "body", T_bd.inverse());
  EXPECT_LT((covarianceOf(back.pose) - covarianceOf(someOdometry().pose)).norm(), kRounding);
  EXPECT_LT((covarianceOf(back.twist) - covarianceOf(someOdometry().twist)).norm(), kRounding);
}

TEST(Odometry, APoseThatIsNoneIsRefused) {
  nav_msgs::Odometry odometry = someOdometry();
  odometry.pose.pose.orientation = geometry_msgs::Quaternion();
  EXPECT_THROW(inParentFrame(odometry, "map", Pose(), Matrix6d::Zero()), vins::InputError);
  EXPECT_THROW(ofChildFrame(odometry, "base_link", Pose()), vins::InputError);
}

}  // namespace
}  // namespace vins_msgs
