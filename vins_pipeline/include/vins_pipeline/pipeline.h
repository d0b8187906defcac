#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "camera_model/rig.h"
#include "feature_tracker/feature_tracker.h"
#include "feature_tracker/gyroscope_buffer.h"
#include "feature_tracker/tracker_options.h"
#include "pose_graph/place/recent_images.h"
#include "pose_graph/pose_graph.h"
#include "pose_graph/pose_graph_options.h"
#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/imu_joiner.h"
#include "vins_core/parameters.h"
#include "vins_core/pose.h"
#include "vins_core/time.h"
#include "vins_core/trajectory.h"
#include "vins_estimator/estimator.h"
#include "vins_estimator/estimator_options.h"
#include "vins_pipeline/run_record.h"

namespace vins::pipeline {

/// What the stages are made of.
struct PipelineOptions {
  std::vector<std::shared_ptr<const camera_model::Camera>> cameras;
  feature_tracker::FeatureTrackerOptions tracker;
  estimator::EstimatorOptions estimator;
  cv::Mat mask;  ///< CV_8UC1, 0 where no corner may be; or empty
  std::string imu_topic = "/imu0";
  std::string accel_topic;  ///< of an accelerometer with a topic of its own; "" for none
  std::vector<std::string> image_topics = {"/cam0/image_raw"};
  std::string camera_info_topic;  ///< to compare the file's camera with; "" for none
  pose_graph::PoseGraphConfiguration loops;
  pose_graph::PlaceModel places;  ///< empty: no loop closing, whatever `loops` says
  std::string map;                ///< a map file to relocalise in; "" for none
};

/// Reads a rig's configuration file: camera, tracker, estimator, topics. Throws InputError naming
/// file and key. `warnings`, which may be null, gets a line for each key that nothing asked for.
/// `read_camera_info` gives the camera where the file leaves it to camera_info_topic.
PipelineOptions readPipelineOptions(
    const std::string& path, std::vector<std::string>* warnings,
    const camera_model::CameraInfoReader& read_camera_info = nullptr);

/// What came of one image.
struct PipelineResult {
  Stamp stamp = 0;  ///< the image's [ns]
  cv::Mat image;    ///< as it was added
  feature_tracker::TrackerStatistics tracker;
  std::optional<FeatureFrame> frame;  ///< handed to the estimator; none where it was refused
  std::vector<estimator::EstimatorResult>
      estimates;  ///< of this frame, or of those before that had waited
  /// The odometries of `estimates` in the map, as known now; none without loop closing.
  std::vector<StampedPose> corrected;
  std::vector<Event> events;                                ///< of all stages, in their order
  std::vector<std::pair<std::string, Duration>> durations;  ///< stage by stage
};

/// All stages in one process: samples and images in, the state out. What comes out depends on what
/// goes in, not on when: an image waits for the IMU samples up to its time, and one thread does it
/// all (unless the pose graph's options want its optimization beside).
class Pipeline {
 public:
  /// Throws InputError for bad options, or a map that cannot be read.
  explicit Pipeline(const PipelineOptions& options);

  /// With an accel_topic the sample is the gyroscope's alone.
  void addImu(const ImuSample& sample);

  /// A reading of the accelerometer of accel_topic [ns], [m/s^2].
  void addAcceleration(Stamp stamp, const Eigen::Vector3d& acceleration);

  /// An image of the first camera, CV_8UC1. Beyond 200 that wait for samples the oldest is dropped.
  void addImage(Stamp stamp, const cv::Mat& image);

  /// Works on the oldest image whose samples have come; nothing where there is none. Call until it
  /// returns nothing.
  std::optional<PipelineResult> process();

  /// Findings about the inputs, which come without an image's result too: see
  /// Estimator::takeInputEvents() and ImuJoiner.
  std::vector<Event> takeInputEvents();

  /// The input has ended: images no longer wait for samples.
  void finish() { finished_ = true; }

  /// The third stage; null without loop closing.
  pose_graph::PoseGraph* poseGraph() { return pose_graph_.get(); }

  /// What `map` has brought; nothing without one.
  const std::optional<pose_graph::LoadedMap>& loadedMap() const { return loaded_map_; }

  /// Writes the map as it is, with small images where the configuration wants them; how many
  /// keyframes it has. Throws InputError as PoseGraph::save() does, or without loop closing.
  std::size_t saveMap(const std::string& path);

 private:
  struct WaitingImage {
    Stamp stamp;
    cv::Mat image;
  };

  void addJoinedSamples();
  bool isReady(const WaitingImage& image) const;
  void track(const WaitingImage& image, PipelineResult* result);
  void estimate(PipelineResult* result);
  void closeLoops(const estimator::EstimatorResult& estimate, PipelineResult* result);
  void addKeyframe(const Keyframe& keyframe, PipelineResult* result);

  feature_tracker::FeatureTracker tracker_;
  estimator::Estimator estimator_;
  std::optional<ImuJoiner> joiner_;  ///< where the accelerometer has a topic of its own
  std::unique_ptr<pose_graph::PoseGraph> pose_graph_;
  bool refines_loops_;
  pose_graph::RecentImages<cv::Mat> recent_images_;
  std::optional<pose_graph::PictureStore> pictures_;  ///< where save_image wants them
  std::optional<pose_graph::LoadedMap> loaded_map_;
  feature_tracker::GyroscopeBuffer gyroscope_;  ///< not yet handed to the tracker
  std::deque<WaitingImage> images_;
  bool finished_ = false;
};

}  // namespace vins::pipeline
