#include "camera_model/rig.h"

#include <algorithm>

#include "camera_model/camera_file.h"
#include "rig_extrinsic.h"
#include "rig_imu.h"
#include "rig_sources.h"
#include "vins_core/folder.h"
#include "vins_core/rig_keys.h"

namespace vins::camera_model {
namespace {

constexpr Range kTimeOffset{-1.0, 1.0};
constexpr Range kReadout{0.0, 0.2};
constexpr int kMostCameras = 8;

/// Keys of VINS-Fusion that choose between ways of its own.
const std::vector<std::string> kVinsFusionOnly = {"multiple_thread", "flow_back", "use_gpu",
                                                  "use_gpu_good_feature", "use_gpu_acc_flow"};

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : ", ") + word;
  return line;
}

std::string numbered(const char* prefix, std::size_t camera, const char* suffix = "") {
  return prefix + std::to_string(camera) + suffix;
}

/// Puts a rig together from its files, camera by camera.
class RigReader {
 public:
  RigReader(const Parameters& main, const CameraInfoReader& read_camera_info)
      : sources_(findRigSources(main)), main_(main), read_camera_info_(read_camera_info) {
    rig_.file = main.name();
  }

  Rig read() {
    requireInertialRig();
    rig_.extrinsic = readExtrinsicMode(main_);
    rig_.estimate_td = main_.flagOr("estimate_td", main_.flagOr("calib_cam_timeoffset", false));
    const std::size_t count = countCameras();
    for (std::size_t i = 0; i < count; ++i) rig_.cameras.push_back(readCameraOfRig(i));
    rig_.imu = readRigImu(sources_);
    normalizeTopic("imu_topic", &rig_.imu.topic);
    normalizeTopic("accel_topic", &rig_.imu.accel_topic);
    remarkUnused();
    collectWarnings();
    return std::move(rig_);
  }

 private:
  /// VINS-Fusion has stereo without an IMU, too.
  void requireInertialRig() const {
    if (main_.flagOr("imu", true)) return;
    main_.fail("imu", "0", "1: this is visual-inertial odometry, which needs an IMU");
  }

  std::size_t countCameras() const {
    std::size_t in_chain = 0;
    while (sources_.chainSection(in_chain)) ++in_chain;
    // Of a second camera that num_of_cam leaves out, its keys may be left over.
    main_.know({"image1_topic", "cam1_calib", "body_T_cam1", "td1"});
    const int fallback = main_.has("image1_topic") ? 2 : std::max<int>(1, in_chain);
    const int most = main_.integerOr("max_cameras", fallback, {1, kMostCameras});
    return static_cast<std::size_t>(main_.integerOr("num_of_cam", most, {1, kMostCameras}));
  }

  RigCamera readCameraOfRig(std::size_t i) {
    RigCamera camera;
    if (i == 0) {
      camera.camera_info_topic = main_.textOr("camera_info_topic", "");
      normalizeTopic("camera_info_topic", &camera.camera_info_topic);
      camera.is_from_topic = !camera.camera_info_topic.empty() && !hasIntrinsics();
    }
    camera.camera =
        camera.is_from_topic ? readCameraInfo(camera.camera_info_topic) : readIntrinsics(i);
    camera.T_bc = readPose(i);
    camera.image_topic = readImageTopic(i);
    camera.td = readTimeOffset(i);
    const bool is_rolling = main_.flagOr("rolling_shutter", false);
    const double readout = main_.numberOr("rolling_shutter_tr", 0.0, kReadout);
    camera.readout = is_rolling ? readout : 0.0;
    if (i == 0) camera.mask_file = readMaskFile();
    return camera;
  }

  /// Of the first camera.
  bool hasIntrinsics() const {
    return main_.has("cam0_calib") || main_.has("model_type") || sources_.chainSection(0);
  }

  std::shared_ptr<const Camera> readCameraInfo(const std::string& topic) const {
    if (read_camera_info_) return read_camera_info_(topic);
    main_.fail("camera_info_topic", "'" + topic + "' and no intrinsics in the file",
               "the intrinsics in the file (model_type, ...), for this program reads no topic");
  }

  std::shared_ptr<const Camera> readIntrinsics(std::size_t i) {
    const std::string key = numbered("cam", i, "_calib");
    if (main_.isSection(key)) return readCamera(main_.section(key));
    if (main_.has(key)) {
      const Parameters file = Parameters::load(fileOf(main_, key, "a camera's file"));
      std::shared_ptr<const Camera> camera = readCamera(file);
      sources_.files.push_back(file);
      if (i == 0) compareImageSize(camera->imageSize());
      return camera;
    }
    if (i == 0 && main_.has("model_type")) return readCamera(main_);
    if (sources_.chainSection(i)) return readCamera(sources_.chain, numbered("cam", i));
    if (i == 0) return readCamera(main_);  // fails, and says of what
    main_.fail(key, "nothing",
               "the file of camera " + std::to_string(i) + ", or a section " + numbered("cam", i) +
                   " as Kalibr's camchain has it");
  }

  /// VINS-Fusion's files repeat what stands in the camera's own.
  void compareImageSize(ImageSize size) const {
    const ImageSize repeated{main_.integerOr("image_width", size.width),
                             main_.integerOr("image_height", size.height)};
    if (repeated == size) return;
    main_.remark("image_width", "image_width and image_height are " +
                                    std::to_string(repeated.width) + " x " +
                                    std::to_string(repeated.height) + ", those of cam0_calib " +
                                    std::to_string(size.width) + " x " +
                                    std::to_string(size.height) + "; the latter count");
  }

  Pose readPose(std::size_t i) {
    const Pose T_bc_before = i == 0 ? Pose() : rig_.cameras.back().T_bc;
    const std::optional<Pose> T_bc = readCameraPose(sources_, i, T_bc_before, rig_.extrinsic);
    if (T_bc || rig_.extrinsic == ExtrinsicMode::kUnknown) return T_bc.value_or(Pose());
    if (i == 0 && sources_.is_incomplete_by_form && !main_.has("estimate_extrinsic")) {
      rig_.extrinsic = ExtrinsicMode::kUnknown;
      main_.remark("extrinsicRotation",
                   "the camera's pose in the body frame is not given: it is found by moving, as "
                   "with estimate_extrinsic: 2");
      return {};
    }
    if (i == 0) {
      main_.fail("extrinsicRotation", "nothing",
                 "a matrix of 3 x 3 numbers, camera to body; absent only where "
                 "estimate_extrinsic is 2");
    }
    main_.fail(numbered("body_T_cam", i), "nothing",
               "a matrix of 4 x 4 numbers, camera to body; or num_of_cam: " + std::to_string(i));
  }

  std::string readImageTopic(std::size_t i) const {
    const std::string key = numbered("image", i, "_topic");
    const std::optional<Parameters> section = sources_.chainSection(i);
    std::string topic = section ? section->textOr("rostopic", "") : "";
    if (i == 0) topic = main_.textOr("image_topic", topic);
    topic = main_.textOr(key, topic);
    normalizeTopic(i == 0 && !main_.has(key) ? "image_topic" : key, &topic);
    return topic;
  }

  /// "/imu0/" is no name in ROS; OpenCV's users write it nevertheless.
  void normalizeTopic(const std::string& key, std::string* topic) const {
    const std::string given = *topic;
    while (topic->size() > 1 && topic->back() == '/') topic->pop_back();
    if (*topic == given) return;
    main_.remark(key, "key '" + key + "': the topic '" + given + "' is taken as '" + *topic + "'");
  }

  double readTimeOffset(std::size_t i) const {
    const std::optional<Parameters> section = sources_.chainSection(i);
    double td = i == 0 ? 0.0 : rig_.cameras.front().td;
    if (section) td = section->numberOr("timeshift_cam_imu", td, kTimeOffset);
    return main_.numberOr(i == 0 ? "td" : numbered("td", i), td, kTimeOffset);
  }

  std::string readMaskFile() const {
    const std::string mask = main_.textOr("fisheye_mask", "");
    if (!main_.flagOr("fisheye", false)) return "";
    if (!mask.empty()) return pathSeenFrom(main_.name(), mask);
    main_.remark("fisheye",
                 "fisheye is 1, but fisheye_mask names no file (VINS-Mono takes one that "
                 "comes with it): features are taken from the whole image");
    return "";
  }

  /// What other programs read in such files, told by name.
  void remarkUnused() {
    remarkUnused(kVinsFusionOnly, "of VINS-Fusion, without effect here: ");
    if (main_.has("relative_config_imu") || main_.has("relative_config_imucam")) {
      main_.know(rigKeysOf(main_));
      remarkUnused(main_.unknownKeys(), "of OpenVINS, without effect here: ");
    }
    for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
      if (const auto section = sources_.chainSection(i)) remarkUnusedKeys(*section);
    }
    if (sources_.imu && sources_.imu->name() != main_.name()) remarkUnusedKeys(*sources_.imu);
    if (rig_.cameras.size() > 1) {
      main_.remark("", std::to_string(rig_.cameras.size()) +
                           " cameras: odometry goes by the first; the feature tracker's node also "
                           "follows the second");
    }
  }

  /// Those of the keys that stages read stay unknown to the rig's reader only.
  static std::vector<std::string> rigKeysOf(const Parameters& main) {
    std::vector<std::string> known = rigKeys();
    known.erase(std::remove_if(known.begin(), known.end(),
                               [&](const std::string& key) { return !main.has(key); }),
                known.end());
    return known;
  }

  void remarkUnused(const std::vector<std::string>& keys, const std::string& words) const {
    std::vector<std::string> present;
    for (const std::string& key : keys) {
      if (main_.has(key)) present.push_back(key);
    }
    main_.know(keys);
    if (!present.empty()) main_.remark("", words + joined(present));
  }

  static void remarkUnusedKeys(const Parameters& section) {
    const std::vector<std::string> keys = section.unknownKeys();
    if (keys.empty()) return;
    const std::string name = section.name();
    const std::size_t colon = name.rfind(": ");
    const std::string of = colon == std::string::npos ? "" : "of " + name.substr(colon + 2) + ", ";
    section.remark("", of + "without effect here: " + joined(keys));
  }

  void collectWarnings() {
    rig_.warnings = main_.remarks();
    for (const Parameters& file : sources_.files) {
      for (const std::string& remark : file.remarks()) rig_.warnings.push_back(remark);
      if (file.name() == sources_.chain.name()) continue;
      if (sources_.imu && sources_.imu->name().rfind(file.name(), 0) == 0) continue;
      for (const std::string& warning : file.warnings()) rig_.warnings.push_back(warning);
    }
  }

  RigSources sources_;
  Parameters main_;
  CameraInfoReader read_camera_info_;
  Rig rig_;
};

}  // namespace

Rig readRig(const Parameters& parameters, const CameraInfoReader& read_camera_info) {
  return RigReader(parameters, read_camera_info).read();
}

Rig readRigFile(const std::string& path) { return readRig(Parameters::load(path)); }

std::vector<std::string> configurationWarnings(const Parameters& parameters, const Rig& rig) {
  std::vector<std::string> warnings = rig.warnings;
  parameters.know(rigKeys());
  for (const std::string& warning : parameters.warnings()) warnings.push_back(warning);
  return warnings;
}

void requireImageTopic(const Parameters& parameters, const Rig& rig) {
  if (!rig.cameras.front().image_topic.empty()) return;
  parameters.fail("image_topic", "nothing",
                  "the name of a topic of sensor_msgs/Image (Kalibr: rostopic in cam0)");
}

void requireImuTopic(const Parameters& parameters, const Rig& rig) {
  if (!rig.imu.topic.empty()) return;
  parameters.fail("imu_topic", "nothing",
                  "the name of a topic of sensor_msgs/Imu (Kalibr: rostopic in imu0)");
}

}  // namespace vins::camera_model
