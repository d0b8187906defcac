// The node or the nodelet, seen from outside: images in, feature frames out.
#include <functional>
#include <map>

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Bool.h>

#include "camera_model/testing/example_cameras.h"
#include "plane_world.h"
#include "vins_msgs/conversions.h"

namespace vins::feature_tracker {
namespace {

/// Publishes images of a swaying camera, and hears what the node says.
class NodeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    images_ = handle_.advertise<sensor_msgs::Image>("/cam0/image_raw", 10);
    imu_ = handle_.advertise<sensor_msgs::Imu>("/imu0", 1000);
    features_ = handle_.subscribe("/feature_tracker/feature", 100, &NodeTest::hearFrame, this);
    restarts_ = handle_.subscribe<std_msgs::Bool>(
        "/feature_tracker/restart", 10,
        [this](const std_msgs::BoolConstPtr&) { ++restart_count_; });
    diagnostics_ = handle_.subscribe("/diagnostics", 10, &NodeTest::hearDiagnostics, this);
    ASSERT_TRUE(waitFor([this] {
      return images_.getNumSubscribers() > 0 && imu_.getNumSubscribers() > 0 &&
             features_.getNumPublishers() > 0 && restarts_.getNumPublishers() > 0;
    }));
  }

  void hearFrame(const vins_msgs::FeatureFrameConstPtr& message) {
    frames_.push_back(vins_msgs::fromMsg(*message));
  }

  void hearDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
    for (const auto& status : message->status) {
      for (const auto& value : status.values) told_[value.key] = value.value;
    }
  }

  static bool waitFor(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000 && ros::ok(); ++i) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.01).sleep();
    }
    return false;
  }

  sensor_msgs::ImagePtr imageAt(double t_s) const {
    const Pose T_wc(Eigen::Quaterniond::Identity(), {0.3 * t_s, 0.0, 0.0});
    std_msgs::Header header;
    header.stamp = ros::Time(100.0 + t_s);
    header.frame_id = "cam0";
    return cv_bridge::CvImage(header, "mono8", world_.render(T_wc)).toImageMsg();
  }

  /// Publishes an image with the IMU samples up to it, and waits for the frame.
  bool send(double t_s) {
    for (int k = 9; k >= 0; --k) {
      ImuSample sample;
      sample.stamp = toNanoseconds(100.0 + t_s - 0.005 * k);
      imu_.publish(vins_msgs::toMsg(sample));
    }
    const std::size_t before = frames_.size();
    images_.publish(imageAt(t_s));
    return waitFor([&] { return frames_.size() > before; });
  }

  ros::NodeHandle handle_;
  ros::Publisher images_, imu_;
  ros::Subscriber features_, restarts_, diagnostics_;
  std::vector<FeatureFrame> frames_;
  std::map<std::string, std::string> told_;
  int restart_count_ = 0;
  testing::PlaneWorld world_{vins::camera_model::testing::exampleCameras().front()};
};

TEST_F(NodeTest, DoesWhatItsTopicsPromise) {
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(send(0.05 * i)) << i;
  int old_tracks = 0;
  for (const auto& observation : frames_.back().observations) {
    if (observation.track_length == 8) ++old_tracks;
  }
  EXPECT_GT(old_tracks, 60);
  EXPECT_EQ(frames_.back().stamp, toNanoseconds(100.35));

  // A picture only for those who ask.
  sensor_msgs::ImageConstPtr picture;
  const auto pictures = handle_.subscribe<sensor_msgs::Image>(
      "/feature_tracker/feature_img", 2,
      [&picture](const sensor_msgs::ImageConstPtr& message) { picture = message; });
  ASSERT_TRUE(waitFor([&pictures] { return pictures.getNumPublishers() > 0; }));
  ros::WallDuration(0.3).sleep();
  ASSERT_TRUE(send(0.40));
  ASSERT_TRUE(waitFor([&picture] { return picture != nullptr; }));
  EXPECT_EQ(picture->encoding, "bgr8");
  EXPECT_EQ(picture->width, 752U);

  // An encoding that nobody knows is refused, and the rest goes on.
  sensor_msgs::Image strange = *imageAt(0.45);
  strange.encoding = "yuv_of_mars";
  images_.publish(strange);
  ASSERT_TRUE(send(0.50));
  EXPECT_TRUE(waitFor([this] { return told_["images refused"] == "1"; }));
  EXPECT_EQ(told_["images dropped"], "0");

  // Time goes back: the bag was started again.
  EXPECT_EQ(restart_count_, 0);
  ASSERT_TRUE(send(-50.0));
  EXPECT_TRUE(waitFor([this] { return restart_count_ == 1; }));
  for (const auto& observation : frames_.back().observations) {
    EXPECT_EQ(observation.track_length, 1);
  }
}

}  // namespace
}  // namespace vins::feature_tracker

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "feature_tracker_node_test");
  return RUN_ALL_TESTS();
}
