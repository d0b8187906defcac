#include "feature_tracker/track_drawing.h"

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"

namespace vins::feature_tracker {
namespace {

TEST(TrackDrawing, ColoursTracksByAge) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  FeatureFrame frame;
  for (const int length : {1, 100}) {
    FeatureObservation observation;
    observation.track_length = length;
    observation.pixel = {200.0 + length, 200.0};
    observation.bearing = *camera->unproject(observation.pixel);
    frame.observations.push_back(observation);
  }
  const cv::Mat image = cv::Mat::zeros(480, 752, CV_8U);
  const cv::Mat picture = drawTracks(image, frame, *camera);
  ASSERT_EQ(picture.type(), CV_8UC3);
  const auto sumAbout = [&](int x) { return cv::sum(picture(cv::Rect(x - 8, 192, 16, 16))); };
  EXPECT_GT(sumAbout(201)[2], 10.0 * sumAbout(201)[0]);                    // new: red
  EXPECT_GT(sumAbout(300)[0], 10.0 * sumAbout(300)[2]);                    // old: blue
  EXPECT_EQ(cv::sum(drawTracks(image, frame, *camera, 1)), cv::Scalar());  // of the other camera
}

}  // namespace
}  // namespace vins::feature_tracker
