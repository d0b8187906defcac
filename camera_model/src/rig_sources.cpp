#include "rig_sources.h"

#include <filesystem>
#include <system_error>

#include "vins_core/folder.h"

namespace vins::camera_model {
namespace {

namespace fs = std::filesystem;

using Keys = std::vector<std::string>;

bool hasAny(const Parameters& parameters, const Keys& keys) {
  for (const std::string& key : keys) {
    if (parameters.has(key)) return true;
  }
  return false;
}

const Keys kVinsNoise = {"acc_n", "gyr_n", "acc_w", "gyr_w"};
const Keys kKalibrNoise = {"accelerometer_noise_density", "gyroscope_noise_density",
                           "accelerometer_random_walk", "gyroscope_random_walk"};

/// A camera's own file says nothing of these.
const Keys kOfRigs = {"imu_topic",
                      "image_topic",
                      "image0_topic",
                      "extrinsicRotation",
                      "extrinsicTranslation",
                      "estimate_extrinsic",
                      "body_T_cam0",
                      "cam0_calib",
                      "num_of_cam",
                      "td",
                      "imu"};

bool isCameraAlone(const Parameters& main) {
  return main.has("model_type") && !hasAny(main, kOfRigs) && !hasAny(main, kVinsNoise) &&
         !hasAny(main, kKalibrNoise) && !main.has("imu0");
}

/// Also where the name is none that the file system takes.
bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Where Kalibr's users have the IMU's file: imu.yaml, or named as the chain is.
std::string imuFileBeside(const std::string& chain) {
  const fs::path path(chain);
  Keys names = {"imu.yaml", "imu0.yaml"};
  for (const auto& [part, replacement] :
       {std::pair("camchain-imucam", "imu"), std::pair("imucam_chain", "imu_chain"),
        std::pair("camchain", "imu")}) {
    std::string name = path.filename().string();
    const std::size_t at = name.find(part);
    if (at == std::string::npos) continue;
    names.push_back(name.replace(at, std::string(part).size(), replacement));
  }
  for (const std::string& name : names) {
    const fs::path candidate = path.parent_path() / name;
    if (name != path.filename() && isFile(candidate)) return candidate.string();
  }
  return "";
}

/// The part of an IMU's document that has its keys.
Parameters imuPartOf(const Parameters& document) {
  return document.isSection("imu0") ? document.section("imu0") : document;
}

void findImu(RigSources* sources) {
  const Parameters& main = sources->main;
  if (hasAny(main, kVinsNoise) || hasAny(main, kKalibrNoise)) {
    sources->imu = main;
    return;
  }
  for (const Parameters& document : {main, sources->chain}) {
    if (!document.has("imu0")) continue;
    sources->imu = document.section("imu0");
    return;
  }
  std::string file;
  if (main.has("relative_config_imu")) {
    file = fileOf(main, "relative_config_imu", "the IMU's file");
  } else if (sources->chainSection(0)) {
    file = imuFileBeside(sources->chain.name());
    if (!file.empty()) main.remark("imu0", "no imu0: the IMU's noise is read from " + file);
  }
  if (file.empty()) return;
  sources->files.push_back(Parameters::load(file));
  sources->imu = imuPartOf(sources->files.back());
}

}  // namespace

std::optional<Parameters> RigSources::chainSection(std::size_t camera) const {
  const std::string key = "cam" + std::to_string(camera);
  if (!chain.has(key)) return std::nullopt;
  return chain.section(key);
}

RigSources findRigSources(const Parameters& main) {
  RigSources sources{main, main, std::nullopt, {}, false};
  if (main.has("relative_config_imucam")) {
    sources.files.push_back(
        Parameters::load(fileOf(main, "relative_config_imucam", "the file of the cameras' chain")));
    sources.chain = sources.files.back();
  }
  findImu(&sources);
  sources.is_incomplete_by_form = sources.chainSection(0) || isCameraAlone(main);
  return sources;
}

std::string fileOf(const Parameters& parameters, const std::string& key,
                   const std::string& what_it_is) {
  const std::string path = pathSeenFrom(parameters.name(), parameters.text(key));
  if (!isFile(path)) {
    parameters.fail(key, "'" + parameters.text(key) + "', but there is no " + path,
                    what_it_is + ", seen from this file's folder");
  }
  return path;
}

}  // namespace vins::camera_model
