// The three stages as nodelets of one manager, which is this process: what a stage hands on arrives
// at the next one as the same object.

#include <mutex>
#include <set>
#include <string>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <xmlrpcpp/XmlRpc.h>

#include "simulation/recording_simulator.h"
#include "vins_msgs/FeatureFrame.h"
#include "vins_msgs/conversions.h"

namespace vins::simulation {
namespace {

constexpr double kFlight = 7.0;  // the estimator is initialised after three to four of them [s]

/// What has come to this process by a topic.
struct Received {
  int messages = 0;
  int bytes = 0;
};

/// By ROS's own account, the slave interface's getBusStats. A process has one subscription of a
/// topic, which calls all its callbacks with the same object. A message of the same process counts
/// without a byte where its pointer was handed on, and with its length where it was serialized,
/// from which another object is made.
Received receivedBy(const std::string& topic) {
  std::string host;
  std::uint32_t port = 0;
  ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port);
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller, answer;
  caller[0] = ros::this_node::getName();
  EXPECT_TRUE(client.execute("getBusStats", caller, answer));
  Received received;
  XmlRpc::XmlRpcValue& subscriptions = answer[1];  // [0]: what is published
  for (int i = 0; i < subscriptions.size(); ++i) {
    if (static_cast<std::string&>(subscriptions[i][0]) != topic) continue;
    XmlRpc::XmlRpcValue& publishers = subscriptions[i][1];
    for (int k = 0; k < publishers.size(); ++k) {
      received.bytes += static_cast<int&>(publishers[k][1]);
      received.messages += static_cast<int&>(publishers[k][2]);
    }
  }
  return received;
}

/// A camera and an IMU in the manager's process, and ears beside those of the stages.
class ZeroCopy : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const auto& [name, type] : {std::pair{"feature_tracker", "FeatureTrackerNodelet"},
                                     {"vins_estimator", "EstimatorNodelet"},
                                     {"pose_graph", "PoseGraphNodelet"}}) {
      const std::string stage = name;
      ASSERT_TRUE(stages_.load("/" + stage, stage + "/" + type, {}, {})) << stage;
    }
    images_ = handle_.advertise<sensor_msgs::Image>("/cam0/image_raw", 10);
    imu_ = handle_.advertise<sensor_msgs::Imu>("/imu0", 1000);
    ear_ = handle_.subscribe("/cam0/image_raw", 1000, &ZeroCopy::hear, this);
    spinner_.start();
    for (int i = 0; i < 1000 && !isConnected(); ++i) ros::WallDuration(0.01).sleep();
    ASSERT_TRUE(isConnected());
  }

  void TearDown() override { spinner_.stop(); }

  bool isConnected() const {
    return images_.getNumSubscribers() > 0 && imu_.getNumSubscribers() > 0;
  }

  void hear(const sensor_msgs::ImageConstPtr& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    heard_.insert(message);
  }

  /// At the pace of a camera: images shared, as a camera's nodelet publishes them; samples by
  /// value, which ROS serializes.
  void fly(const SimulatedRecording& flight) {
    std::size_t next = 0;
    const ros::WallTime start = ros::WallTime::now();
    for (std::size_t i = 0; i < flight.image_stamps.size(); ++i) {
      std_msgs::Header header;
      header.stamp = vins_msgs::toRosTime(flight.image_stamps[i]);
      const auto image = cv_bridge::CvImage(header, "mono8", flight.render(0, i)).toImageMsg();
      ros::WallTime::sleepUntil(start + ros::WallDuration(0.05 * static_cast<double>(i)));
      for (; next < flight.imu.size() &&
             flight.imu[next].sample.stamp <= flight.image_stamps[i] + 5'000'000;
           ++next) {
        imu_.publish(vins_msgs::toMsg(flight.imu[next].sample));
      }
      images_.publish(image);
      sent_.insert(image);
    }
    ros::WallDuration(1.0).sleep();  // for what is under way
  }

  nodelet::Loader stages_{false};
  ros::NodeHandle handle_;
  ros::Publisher images_, imu_;
  ros::Subscriber ear_;
  ros::AsyncSpinner spinner_{1};
  std::mutex mutex_;
  std::set<sensor_msgs::ImageConstPtr> sent_, heard_;  ///< kept, so that no address comes twice
};

TEST_F(ZeroCopy, StagesOfOneManagerHandOnTheMessagesThemselves) {
  RecordingOptions options;
  options.duration = kFlight;
  fly(simulateRecording(options));
  const std::lock_guard<std::mutex> lock(mutex_);
  EXPECT_GT(sent_.size(), 100u);
  EXPECT_TRUE(heard_ == sent_) << "images came as other objects, or not at all";
  for (const char* topic :
       {"/cam0/image_raw", "/feature_tracker/feature", "/vins_estimator/keyframe",
        "/vins_estimator/keyframe_pose_update", "/vins_estimator/odometry"}) {
    const Received received = receivedBy(topic);
    std::cout << topic << ": " << received.messages << " messages, " << received.bytes
              << " bytes\n";
    EXPECT_GT(received.messages, 5) << topic;
    EXPECT_EQ(received.bytes, 0) << topic << " is serialized on its way";
  }
  // That bytes are counted where there are any: an IMU sample has 300 and more.
  const Received samples = receivedBy("/imu0");
  EXPECT_GT(samples.messages, 1000);
  EXPECT_GT(samples.bytes, 300 * samples.messages);
}

}  // namespace
}  // namespace vins::simulation

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "zero_copy_test");
  const ros::NodeHandle handle;  // while it lives, ROS does
  return RUN_ALL_TESTS();
}
