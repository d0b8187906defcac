#include "feature_tracker/tracker_options.h"

#include <sstream>

#include <gtest/gtest.h>

#include "feature_tracker/mask_file.h"
#include "vins_core/input_error.h"

namespace vins::feature_tracker {
namespace {

FeatureTrackerOptions optionsOf(const std::string& text) {
  const Parameters parameters = Parameters::parse(
      "%YAML:1.0\n---\nmodel_type: PINHOLE\nimage_width: 752\nimage_height: 480\n"
      "projection_parameters: {fx: 460.0, fy: 460.0, cx: 376.0, cy: 240.0}\n"
      "distortion_parameters: {k1: 0.0, k2: 0.0, p1: 0.0, p2: 0.0}\n"
      "acc_n: 0.08\ngyr_n: 0.004\nacc_w: 4.0e-5\ngyr_w: 2.0e-6\n"
      "body_T_cam0: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n" +
          text,
      "/rigs/rig.yaml");
  return readFeatureTrackerOptions(parameters, camera_model::readRig(parameters));
}

TEST(TrackerOptions, ReadsTheKeysOfVinsMono) {
  const auto options = optionsOf(
      "max_cnt: 200\nmin_dist: 25\nfreq: 10\nF_threshold: 1.5\nshow_track: 0\nequalize: 1\n"
      "fisheye: 1\nfisheye_mask: mask.png\n");
  EXPECT_EQ(options.max_features, 200);
  EXPECT_EQ(options.min_distance, 25.0);
  EXPECT_EQ(options.frequency, 10.0);
  EXPECT_EQ(options.rejection_threshold, 1.5);
  EXPECT_FALSE(options.draw_tracks);
  EXPECT_EQ(options.equalization, Equalization::kWhereDull);
  EXPECT_EQ(options.mask_file, "/rigs/mask.png");
}

TEST(TrackerOptions, HasDefaults) {
  const auto options = optionsOf("fisheye: 0\nfisheye_mask: mask.png\n");
  EXPECT_EQ(options.max_features, 150);
  EXPECT_EQ(options.frequency, 0.0);
  EXPECT_TRUE(options.mask_file.empty());
  EXPECT_NO_THROW(options.validate());
  std::ostringstream out;
  out << options;
  EXPECT_NE(out.str().find("max_cnt: 150"), std::string::npos);
}

TEST(TrackerOptions, TheGyroscopeIsOfNoUseWhereTheExtrinsicIsUnknown) {
  EXPECT_TRUE(optionsOf("estimate_extrinsic: 0\n").uses_gyroscope);
  EXPECT_TRUE(optionsOf("estimate_extrinsic: 1\n").uses_gyroscope);
  // Although the file has a matrix.
  EXPECT_FALSE(optionsOf("estimate_extrinsic: 2\n").uses_gyroscope);
}

TEST(TrackerOptions, RefuseWhatIsOutOfRange) {
  EXPECT_THROW(optionsOf("max_cnt: 0\n"), InputError);
  EXPECT_THROW(optionsOf("klt_window: 5\n"), InputError);
  FeatureTrackerOptions options;
  options.min_distance = std::nan("");
  try {
    options.validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("min_dist"), std::string::npos);
  }
}

TEST(MaskFile, NamesTheFileThatIsMissing) {
  EXPECT_TRUE(readMaskFile("", {752, 480}).empty());
  try {
    readMaskFile("/no/such/mask.png", {752, 480});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/mask.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace vins::feature_tracker
