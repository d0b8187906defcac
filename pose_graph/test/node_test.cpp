// The node, seen from outside: keyframes and images in, paths, matches and transforms out.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <spawn.h>
#include <sys/wait.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>
#include <visualization_msgs/MarkerArray.h>

#include "revisits.h"
#include "temp_folder.h"
#include "vins_msgs/Keyframe.h"
#include "vins_msgs/KeyframePoseUpdate.h"
#include "vins_msgs/LoopEdge.h"
#include "vins_msgs/LoopMatch.h"
#include "vins_msgs/MapFile.h"
#include "vins_msgs/odometry.h"

namespace vins::pose_graph {
namespace {

using testing::Revisits;

/// Another pose graph node, with private parameters of its own.
class SecondNode {
 public:
  SecondNode(const std::string& name, const std::string& parameter) {
    const auto tool = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "pose_graph";
    std::string config;
    ros::param::get("/pose_graph/config_file", config);
    std::vector<std::string> texts = {tool.string(), "__name:=" + name, "_config_file:=" + config,
                                      parameter};
    std::vector<char*> arguments;
    for (std::string& text : texts) arguments.push_back(text.data());
    arguments.push_back(nullptr);
    if (posix_spawn(&process_, tool.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
      throw std::runtime_error("cannot start " + tool.string());
    }
  }
  ~SecondNode() { stop(); }
  SecondNode(const SecondNode&) = delete;
  SecondNode& operator=(const SecondNode&) = delete;

  /// Ends it as Ctrl-C does; its exit code.
  int stop() {
    if (process_ == 0) return 0;
    kill(process_, SIGINT);
    return wait();
  }

  /// Waits until it ends; its exit code.
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t process_ = 0;
};

/// Plays the camera and the estimator, and hears what the node says.
class NodeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    images_ = handle_.advertise<sensor_msgs::Image>("/cam0/image_raw", 10);
    keyframes_ = handle_.advertise<vins_msgs::Keyframe>("/vins_estimator/keyframe", 10);
    updates_ = handle_.advertise<vins_msgs::KeyframePoseUpdate>(
        "/vins_estimator/keyframe_pose_update", 10);
    edges_ = handle_.advertise<vins_msgs::LoopEdge>("/vins_estimator/loop_edge", 10);
    odometry_ = handle_.advertise<nav_msgs::Odometry>("/vins_estimator/odometry", 10);
    hear<nav_msgs::Path>("/pose_graph/pose_graph_path", &path_);
    hear<nav_msgs::Path>("/pose_graph/path_1", &first_path_);
    hear<nav_msgs::Path>("/pose_graph/no_loop_path", &no_loop_path_);
    hear<visualization_msgs::MarkerArray>("/pose_graph/pose_graph", &markers_);
    hear<sensor_msgs::Image>("/pose_graph/match_image", &picture_);
    hear<nav_msgs::Odometry>("/pose_graph/odometry", &corrected_);
    hear<tf2_msgs::TFMessage>("/tf", &transform_);
    subscribers_.push_back(handle_.subscribe<vins_msgs::LoopMatch>(
        "/pose_graph/loop_match", 10, [this](const vins_msgs::LoopMatchConstPtr& message) {
          matches_.push_back(vins_msgs::fromMsg(*message));
        }));
    subscribers_.push_back(handle_.subscribe("/diagnostics", 10, &NodeTest::hearDiagnostics, this));
    ASSERT_TRUE(waitFor([this] {
      return images_.getNumSubscribers() > 0 && keyframes_.getNumSubscribers() > 0 &&
             updates_.getNumSubscribers() > 0 && edges_.getNumSubscribers() > 0 &&
             odometry_.getNumSubscribers() > 0 && subscribers_.front().getNumPublishers() > 0;
    }));
    // The node is told of its subscribers a moment after they are told of it.
    ros::WallDuration(0.5).sleep();
  }

  template <typename Message>
  void hear(const std::string& topic, boost::shared_ptr<const Message>* latest) {
    subscribers_.push_back(handle_.subscribe<Message>(
        topic, 10,
        [latest](const boost::shared_ptr<const Message>& message) { *latest = message; }));
  }

  void hearDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
    for (const auto& status : message->status) {
      for (const auto& value : status.values) told_[value.key] = value.value;
    }
  }

  static bool waitFor(const std::function<bool()>& condition) {
    for (int i = 0; i < 1500 && ros::ok(); ++i) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.01).sleep();
    }
    return false;
  }

  /// A visit, from image to odometry; waits until the node has answered.
  bool visit(int place, const Pose& T_wm = {}, std::uint32_t sequence = 0) {
    const Keyframe keyframe = revisits_.keyframe(next_id_++, place, T_wm, sequence);
    std_msgs::Header header;
    header.stamp = vins_msgs::toRosTime(keyframe.stamp);
    header.frame_id = "odom";
    images_.publish(cv_bridge::CvImage(header, "mono8", revisits_.image(place)).toImageMsg());
    // Topics of different connections may overtake each other; in life the estimator is between.
    ros::WallDuration(0.05).sleep();
    keyframes_.publish(vins_msgs::toMsg(keyframe));
    nav_msgs::Odometry odometry;
    odometry.header = header;
    odometry.pose.pose = vins_msgs::toMsg(keyframe.T_wb);
    ros::WallDuration(0.02).sleep();
    odometry_.publish(odometry);
    return waitFor([&] { return corrected_ && corrected_->header.stamp == header.stamp; });
  }

  /// What a map service answers.
  static vins_msgs::MapFile::Response ask(const std::string& service, const std::string& file) {
    vins_msgs::MapFile call;
    call.request.file = file;
    EXPECT_TRUE(ros::service::waitForService(service, ros::Duration(10.0))) << service;
    EXPECT_TRUE(ros::service::call(service, call)) << service;
    return call.response;
  }

  ros::NodeHandle handle_;
  ros::Publisher images_, keyframes_, updates_, edges_, odometry_;
  std::vector<ros::Subscriber> subscribers_;
  nav_msgs::Path::ConstPtr path_, first_path_, no_loop_path_;
  visualization_msgs::MarkerArray::ConstPtr markers_;
  sensor_msgs::Image::ConstPtr picture_;
  nav_msgs::Odometry::ConstPtr corrected_;
  tf2_msgs::TFMessage::ConstPtr transform_;
  std::vector<LoopMatch> matches_;
  std::map<std::string, std::string> told_;
  const Revisits revisits_;
  std::int64_t next_id_ = 0;
};

TEST_F(NodeTest, DoesWhatItsTopicsPromise) {
  for (int place = 0; place < 30; ++place) ASSERT_TRUE(visit(place)) << place;
  EXPECT_TRUE(matches_.empty()) << "no place was seen twice";
  ASSERT_TRUE(waitFor([this] { return transform_ != nullptr; }));
  EXPECT_EQ(transform_->transforms[0].header.frame_id, "map");
  EXPECT_EQ(transform_->transforms[0].child_frame_id, "odom");

  // Back at the start, with an odometry that has drifted.
  const Pose drift(yawRotation(0.02), {0.3, -0.2, 0.1});
  for (int place = 2; place < 6; ++place) ASSERT_TRUE(visit(place, drift)) << place;
  ASSERT_FALSE(matches_.empty());
  EXPECT_EQ(matches_[0].old_id, matches_[0].query_id - 28) << "the same place";
  EXPECT_TRUE(waitFor([this] { return picture_ != nullptr; })) << "of the match";
  EXPECT_EQ(picture_->encoding, "bgr8");

  // The refined loop, and the last word on a keyframe, are taken.
  LoopEdge edge;
  edge.query_id = matches_[0].query_id;
  edge.old_id = matches_[0].old_id;
  edge.query_stamp = matches_[0].query_stamp;
  edges_.publish(vins_msgs::toMsg(edge));
  KeyframePoseUpdate update;
  update.keyframe_id = 33;
  update.stamp = 34 * Revisits::kPeriod;
  update.T_wb = drift * Revisits::truth(5);
  updates_.publish(vins_msgs::toMsg(update));
  ros::WallDuration(1.0).sleep();

  // One more visit: its odometry is nearer to the truth than it came.
  ASSERT_TRUE(visit(6, drift));
  const Pose corrected = vins_msgs::fromMsg(corrected_->pose.pose);
  const Eigen::Vector3d truth = Revisits::truth(6).position;
  EXPECT_LT((corrected.position - truth).norm(),
            0.5 * ((drift * Revisits::truth(6)).position - truth).norm());
  EXPECT_EQ(corrected_->header.frame_id, "map");

  ros::WallDuration(0.6).sleep();
  ASSERT_TRUE(visit(7, drift));
  ASSERT_TRUE(waitFor([this] { return path_ && path_->poses.size() == 36u; }));
  EXPECT_EQ(path_->header.frame_id, "map");
  ASSERT_TRUE(waitFor([this] { return first_path_ && no_loop_path_ && markers_; }));
  EXPECT_EQ(no_loop_path_->header.frame_id, "odom");
  EXPECT_EQ(markers_->markers.back().ns, "loops");
  EXPECT_TRUE(waitFor([this] { return told_["keyframes"] == "36"; }));
  EXPECT_EQ(told_["messages dropped"], "0");
  EXPECT_EQ(told_["keyframes without image"], "0");
}

TEST_F(NodeTest, TheMapsPoseDoesNotJumpWhereTheEstimatorResets) {
  next_id_ = 500;  // after what the test before has flown, with the loops that it has closed
  const Pose drift(yawRotation(0.02), {0.3, -0.2, 0.1});
  ASSERT_TRUE(visit(60, drift));
  const Pose before = vins_msgs::fromMsg(corrected_->pose.pose);
  ASSERT_GT((before.position - (drift * Revisits::truth(60)).position).norm(), 0.05)
      << "loops have corrected something";
  // A new sequence in the same world, where the body has moved by one place.
  next_id_ += 10;
  ASSERT_TRUE(visit(61, drift, 1));
  const Pose after = vins_msgs::fromMsg(corrected_->pose.pose);
  const Pose moved = Revisits::truth(60).inverse() * Revisits::truth(61);
  EXPECT_LT(((before * moved).position - after.position).norm(), 1e-6);
  const geometry_msgs::TransformStamped T_map_odom = transform_->transforms[0];
  EXPECT_GT(vins_msgs::fromMsg(T_map_odom.transform.translation).norm(), 0.05) << "not identity";
}

TEST_F(NodeTest, SavesAndLoadsMaps) {
  const testing::TempFolder folder("pose_graph_node_test");
  next_id_ = 1000;  // the node knows the first ones already
  SecondNode second("second", "_save_map:=" + folder.file("new/end.map"));
  ASSERT_TRUE(waitFor([this] { return keyframes_.getNumSubscribers() > 1; }));
  ASSERT_TRUE(waitFor([this] { return images_.getNumSubscribers() > 1; }));
  for (int place = 40; place < 46; ++place) ASSERT_TRUE(visit(place)) << place;

  const auto saved = ask("/pose_graph/save_map", folder.file("a.map"));
  EXPECT_TRUE(saved.success) << saved.message;
  EXPECT_NE(saved.message.find("saved " + folder.file("a.map")), std::string::npos);
  const auto unnamed = ask("/pose_graph/save_map", "");
  EXPECT_FALSE(unnamed.success);
  EXPECT_NE(unnamed.message.find("pose_graph_save_path"), std::string::npos) << unnamed.message;
  const auto missing = ask("/pose_graph/load_map", folder.file("missing.map"));
  EXPECT_FALSE(missing.success);
  EXPECT_NE(missing.message.find(folder.file("missing.map")), std::string::npos);

  // The second node writes its map when it ends.
  EXPECT_TRUE(waitFor([&] { return ask("/second/save_map", folder.file("b.map")).success; }));
  EXPECT_EQ(second.stop(), 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("new/end.map")));

  nav_msgs::Path::ConstPtr base;
  hear<nav_msgs::Path>("/third/base_path", &base);
  {
    SecondNode third("third", "_load_map:=" + folder.file("new/end.map"));
    ASSERT_TRUE(waitFor([&] { return base != nullptr; })) << "before any keyframe";
    EXPECT_EQ(base->poses.size(), 6u);
    const auto loaded = ask("/third/load_map", folder.file("a.map"));
    EXPECT_TRUE(loaded.success) << loaded.message;
  }
  SecondNode fourth("fourth", "_load_map:=" + folder.file("missing.map"));
  EXPECT_EQ(fourth.wait(), 1) << "a map that is not there";
}

}  // namespace
}  // namespace vins::pose_graph

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pose_graph_node_test");
  return RUN_ALL_TESTS();
}
