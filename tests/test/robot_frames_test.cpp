// Two estimator nodes on a flight without images: one publishes the pose of a robot's frame, at the
// IMU's rate in tf, the other no tf at all.

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include "simulation/builtin_trajectories.h"
#include "simulation/feature_simulator.h"
#include "simulation/imu_simulator.h"
#include "vins_core/so3.h"
#include "vins_msgs/FeatureFrame.h"
#include "vins_msgs/odometry.h"

namespace vins::tests {
namespace {

constexpr double kFlight = 8.0;  // the estimator is initialised after three to four of them [s]
constexpr Stamp kEpoch = 1600000000000000000;

/// base_link <- imu_link, as a URDF has it: the IMU stands on the robot, its x axis up.
const Pose kBaseFromImu(Eigen::Quaterniond(std::sqrt(0.5), 0.0, -std::sqrt(0.5), 0.0),
                        {0.2, 0.1, 0.3});

bool waitFor(const std::function<bool()>& condition, double seconds = 60.0) {
  for (int i = 0; i < 100 * seconds && ros::ok(); ++i) {
    ros::spinOnce();
    if (condition()) return true;
    ros::WallDuration(0.01).sleep();
  }
  return false;
}

class RobotFrames : public ::testing::Test {
 protected:
  void SetUp() override {
    publishRobot();
    imu_ = handle_.advertise<sensor_msgs::Imu>("/imu0", 5000);
    features_ = handle_.advertise<vins_msgs::FeatureFrame>("/feature_tracker/feature", 500);
    hear<nav_msgs::Odometry>("/vins_estimator/odometry", &odometry_);
    hear<nav_msgs::Odometry>("/vins_estimator/imu_propagate", &propagated_);
    hear<nav_msgs::Odometry>("/vins_estimator/camera_pose", &camera_);
    hear<geometry_msgs::PoseWithCovarianceStamped>("/vins_estimator/pose", &pose_);
    hear<nav_msgs::Odometry>("/without_tf/odometry", &without_tf_);
    subscribers_.push_back(handle_.subscribe<tf2_msgs::TFMessage>(
        "/tf", 5000, [this](const tf2_msgs::TFMessageConstPtr& message) {
          for (const auto& transform : message->transforms) {
            ++transforms_[{transform.header.frame_id, transform.child_frame_id}];
          }
        }));
    ASSERT_TRUE(waitFor(
        [this] { return imu_.getNumSubscribers() == 2 && features_.getNumSubscribers() == 2; }));
    ros::WallDuration(1.0).sleep();  // the nodes are told of their subscribers, and of /tf_static
  }

  void publishRobot() {
    nav_msgs::Odometry imu_on_robot;
    imu_on_robot.header.frame_id = "base_link";
    imu_on_robot.child_frame_id = "imu_link";
    imu_on_robot.pose.pose = vins_msgs::toMsg(kBaseFromImu);
    tf2_msgs::TFMessage transforms;
    transforms.transforms.push_back(vins_msgs::toTransform(imu_on_robot));
    robot_ = handle_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    robot_.publish(transforms);
  }

  template <typename Message>
  void hear(const std::string& topic, std::vector<Message>* heard) {
    subscribers_.push_back(handle_.subscribe<Message>(
        topic, 5000,
        [heard](const boost::shared_ptr<const Message>& message) { heard->push_back(*message); }));
  }

  /// Twice as fast as in life.
  void fly() {
    const simulation::TrajectorySpline motion = simulation::makeBuiltinTrajectory(
        "hall_loop", 1, kFlight, simulation::eurocCameraInBody(0), kEpoch);
    simulation::FeatureSimulatorOptions options;
    options.duration = kFlight;
    options.max_features = 100;
    simulation::FeatureSimulator features(motion, simulation::eurocCamera(0),
                                          simulation::eurocCameraInBody(0), options);
    const auto imu =
        simulation::simulateImu(motion, kEpoch, kEpoch + toNanoseconds(kFlight), {}, 1);
    auto sample = imu.samples.begin();
    while (const auto frame = features.next()) {
      for (; sample != imu.samples.end() && sample->stamp <= frame->stamp; ++sample) {
        imu_.publish(vins_msgs::toMsg(*sample));
      }
      features_.publish(vins_msgs::toMsg(*frame));
      ros::spinOnce();
      ros::WallDuration(0.025).sleep();
    }
  }

  ros::NodeHandle handle_;
  ros::Publisher robot_, imu_, features_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<nav_msgs::Odometry> odometry_, propagated_, camera_, without_tf_;
  std::vector<geometry_msgs::PoseWithCovarianceStamped> pose_;
  std::map<std::pair<std::string, std::string>, std::size_t> transforms_;
};

TEST_F(RobotFrames, ThePoseOfTheRobotsFrameIsPublishedAndNoOtherNodesTfIsDisturbed) {
  fly();
  ASSERT_TRUE(waitFor([this] { return odometry_.size() > 40 && without_tf_.size() > 40; }));
  const std::pair<std::string, std::string> robot("odometry", "base_link");
  waitFor(
      [&] {
        return camera_.size() == odometry_.size() && pose_.size() == odometry_.size() &&
               transforms_[robot] == propagated_.size();  // each on a connection of its own
      },
      2.0);
  ASSERT_EQ(camera_.size(), odometry_.size());
  ASSERT_EQ(pose_.size(), odometry_.size());
  EXPECT_EQ(odometry_.back().header.frame_id, "odometry");
  EXPECT_EQ(odometry_.back().child_frame_id, "base_link");
  EXPECT_EQ(propagated_.back().child_frame_id, "base_link");
  // The camera's pose is published by way of the IMU: it stands on the robot where the URDF and the
  // extrinsic say.
  const Pose T_o_base = vins_msgs::fromMsg(odometry_.back().pose.pose);
  const Pose T_o_camera = vins_msgs::fromMsg(camera_.back().pose.pose);
  const Pose found = T_o_base.inverse() * T_o_camera;
  const Pose expected = kBaseFromImu * simulation::eurocCameraInBody(0);
  EXPECT_LT((found.position - expected.position).norm(), 1e-6);
  EXPECT_LT(found.rotation.angularDistance(expected.rotation), 1e-6);
  EXPECT_EQ(pose_.back().pose.covariance, odometry_.back().pose.covariance);

  ASSERT_EQ(transforms_.size(), 1u) << "neither body nor camera, nor the other node's";
  EXPECT_EQ(transforms_[robot], propagated_.size()) << "at the IMU's rate";
  EXPECT_GT(propagated_.size(), 5 * odometry_.size());
  EXPECT_EQ(without_tf_.back().header.frame_id, "unseen");
  EXPECT_EQ(without_tf_.back().child_frame_id, "body");
}

}  // namespace
}  // namespace vins::tests

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "robot_frames_test");
  return RUN_ALL_TESTS();
}
