// Rigs whose intrinsics come from a topic.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "camera_model/rig.h"
#include "rig_files.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

using namespace rig_files;  // NOLINT(google-build-using-namespace)

/// The file without its camera, and with a topic that gives it.
std::string withoutCamera(std::string text) {
  text.replace(text.find("model_type:"), std::string("model_type:").size(), "no_model_type:");
  return text + "camera_info_topic: /left/camera_info/\n";
}

TEST(RigCameraInfo, TakesTheIntrinsicsThatTheFileLacksFromCameraInfo) {
  std::string asked;
  const auto given = readRig(Parameters::parse(vinsMono(), "rig.yaml")).cameras[0].camera;
  const auto reader = [&](const std::string& topic) {
    asked = topic;
    return given;
  };
  const Rig rig = readRig(Parameters::parse(withoutCamera(vinsMono()), "rig.yaml"), reader);
  EXPECT_EQ(asked, "/left/camera_info");
  EXPECT_EQ(rig.cameras[0].camera, given);
  EXPECT_TRUE(rig.cameras[0].is_from_topic);
  EXPECT_LT((rig.cameras[0].T_bc.position - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
}

TEST(RigCameraInfo, IntrinsicsOfTheFileGoBeforeCameraInfo) {
  const auto reader = [](const std::string& /*topic*/) -> std::shared_ptr<const Camera> {
    throw InputError("asked in vain");
  };
  const std::string text = vinsMono() + "camera_info_topic: /left/camera_info\n";
  const Rig rig = readRig(Parameters::parse(text, "rig.yaml"), reader);
  EXPECT_FALSE(rig.cameras[0].is_from_topic);
  EXPECT_EQ(rig.cameras[0].camera_info_topic, "/left/camera_info");
}

TEST(RigCameraInfo, ProgramsThatReadNoTopicNeedIntrinsicsInTheFile) {
  try {
    readRig(Parameters::parse(withoutCamera(vinsMono()), "rig.yaml"));
    FAIL() << "read without a camera";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("'camera_info_topic': found '/left/camera_info' and no intrinsics in the "
                        "file; allowed: the intrinsics in the file (model_type, ...)"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace vins::camera_model
