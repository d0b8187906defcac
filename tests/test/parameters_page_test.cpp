// docs/parameters.md against the code: every key that the readers know is in the page and no other
// is, with the allowed values as error messages name them and with the defaults.

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "camera_model/rig.h"
#include "feature_tracker/tracker_options.h"
#include "pose_graph/pose_graph_options.h"
#include "vins_core/input_error.h"
#include "vins_core/rig_keys.h"
#include "vins_estimator/estimator_options.h"
#include "vins_pipeline/pipeline.h"

namespace vins::tests {
namespace {

namespace fs = std::filesystem;

/// A row of one of the page's tables.
struct Row {
  std::string key, fallback, allowed;
};

std::string contentOf(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<Row> rowsOfPage() {
  const std::string page = contentOf("../docs/parameters.md");
  const std::regex row(R"(\| `([A-Za-z0-9_]+)` \| ?([^|]*?) ?\| ([^|]*?) \| [^|]*\|)");
  std::vector<Row> rows;
  for (std::sregex_iterator it(page.begin(), page.end(), row), end; it != end; ++it) {
    rows.push_back({(*it)[1], (*it)[2], (*it)[3]});
  }
  return rows;
}

const char* const kPinhole =
    "model_type: PINHOLE\nimage_width: 752\nimage_height: 480\n"
    "projection_parameters: {fx: 460.0, fy: 460.0, cx: 376.0, cy: 240.0}\n"
    "distortion_parameters: {k1: 0.0, k2: 0.0, p1: 0.0, p2: 0.0}\n";
const char* const kMei =
    "model_type: MEI\nimage_width: 640\nimage_height: 480\nmirror_parameters: {xi: 1.2}\n"
    "projection_parameters: {gamma1: 380.0, gamma2: 382.0, u0: 318.0, v0: 244.0}\n"
    "distortion_parameters: {k1: -0.1, k2: 0.0, p1: 0.0, p2: 0.0}\n";
const char* const kScaramuzza =
    "model_type: SCARAMUZZA\nimage_width: 800\nimage_height: 800\n"
    "poly_parameters: {p0: -280.0, p1: 0.0, p2: 1.1e-03, p3: -4.0e-07, p4: 1.9e-09}\n"
    "affine_parameters: {ac: 1.0, ad: 0.0, ae: 0.0, cx: 400.0, cy: 400.0}\n"
    "inv_poly_parameters: {p0: 0.0}\n";
const char* const kKalibrCamera =
    "cam0: {camera_model: pinhole, distortion_model: radtan, resolution: [752, 480], "
    "intrinsics: [460.0, 460.0, 376.0, 240.0], distortion_coeffs: [0.0, 0.0, 0.0, 0.0], "
    "T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n";
const char* const kExtrinsic =
    "extrinsicRotation: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
    "extrinsicTranslation: [[0], [0], [0]]\n";
const char* const kNoise = "acc_n: 0.08\ngyr_n: 0.004\nacc_w: 4.0e-5\ngyr_w: 2.0e-6\n";
const char* const kKalibrNoise =
    "accelerometer_noise_density: 2.0e-3\ngyroscope_noise_density: 2.0e-4\n"
    "accelerometer_random_walk: 3.0e-3\ngyroscope_random_walk: 2.0e-5\n";
const char* const kKalibrSection =
    "imu0: {accelerometer_noise_density: 2.0e-3, gyroscope_noise_density: 2.0e-4, "
    "accelerometer_random_walk: 3.0e-3, gyroscope_random_walk: 2.0e-5}\n";

const char* const kSecondKalibrCamera =
    "cam1: {camera_model: pinhole, distortion_model: radtan, resolution: [752, 480], "
    "intrinsics: [460.0, 460.0, 376.0, 240.0], distortion_coeffs: [0.0, 0.0, 0.0, 0.0], "
    "T_cam_imu: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n";

/// Files that have what is needed and little else, one of each form.
std::vector<std::string> smallFiles() {
  const std::string head = "%YAML:1.0\n---\n";
  return {head + kPinhole + kExtrinsic + kNoise, head + kMei + kExtrinsic + kKalibrNoise,
          head + kScaramuzza + kExtrinsic + kKalibrSection, head + kKalibrCamera + kKalibrNoise,
          head + kKalibrCamera + kSecondKalibrCamera + kKalibrNoise};
}

/// `text` without the line of a key at its top.
std::string without(const std::string& text, const std::string& key) {
  std::istringstream in(text);
  std::string rest;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key + ":", 0) != 0) rest += line + "\n";
  }
  return rest;
}

class ParametersPage : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = (folder_ / "config.yaml").string();
    std::ofstream(path) << text;
    return path;
  }

  /// What the readers make of the text, as text.
  std::string describe(const std::string& text) const {
    const pipeline::PipelineOptions options = pipeline::readPipelineOptions(write(text), nullptr);
    const pose_graph::PoseGraphConfiguration& loops = options.loops;
    std::ostringstream out;
    out << options.cameras[0]->name() << options.tracker << options.estimator << loops.options
        << loops.is_on << loops.options.refines_in_window << loops.loads_map << loops.saves_images
        << loops.files.vocabulary << loops.files.pattern << options.estimator.imu.vibration_share;
    return out.str();
  }

  bool readsWithoutUnknownKey(const std::string& text) const {
    std::vector<std::string> warnings;
    pipeline::readPipelineOptions(write(text), &warnings);
    for (const std::string& warning : warnings) {
      if (warning.find("unknown key") != std::string::npos) return false;
    }
    return true;
  }

  bool isKnown(const std::string& key, const std::string& file) const {
    if (without(file, key) != file) return readsWithoutUnknownKey(file);
    try {
      return readsWithoutUnknownKey(file + key + ": 1\n");
    } catch (const InputError& error) {
      return true;  // of another key nobody would have said anything
    }
  }

  bool isKnown(const std::string& key) const {
    for (const std::string& file : smallFiles()) {
      if (isKnown(key, file)) return true;
    }
    return false;
  }

  fs::path folder_ =
      fs::temp_directory_path() / ("parameters_page_test_" + std::to_string(getpid()));
};

/// Words in the quotes of the sources that could be keys.
std::set<std::string> wordsOfSources() {
  std::set<std::string> words;
  const std::regex word("\"([A-Za-z][A-Za-z0-9_]*)\"");
  for (const char* file :
       {"../camera_model/src/camera_file.cpp", "../feature_tracker/src/tracker_options.cpp",
        "../camera_model/src/rig.cpp", "../camera_model/src/rig_extrinsic.cpp",
        "../camera_model/src/rig_imu.cpp", "../camera_model/src/rig_sources.cpp",
        "../vins_estimator/src/estimator_options.cpp", "../pose_graph/src/pose_graph_options.cpp",
        "../vins_pipeline/src/pipeline.cpp"}) {
    const std::string text = contentOf(file);
    EXPECT_FALSE(text.empty()) << file;
    for (std::sregex_iterator it(text.begin(), text.end(), word), end; it != end; ++it) {
      words.insert((*it)[1]);
    }
  }
  return words;
}

/// What the readers that know the key say is allowed, given something that cannot be.
std::set<std::string> allowedByCode(const std::string& key) {
  std::set<std::string> allowed;
  const auto rig = camera_model::readRig(Parameters::parse(smallFiles().front(), "rig"));
  const std::vector<std::function<void(const Parameters&)>> readers = {
      [](const Parameters& p) { camera_model::readRig(p); },
      [&](const Parameters& p) { feature_tracker::readFeatureTrackerOptions(p, rig); },
      [&](const Parameters& p) { estimator::readEstimatorOptions(p, rig); },
      [](const Parameters& p) { pose_graph::readPoseGraphConfiguration(p); }};
  for (const std::string& file : smallFiles()) {
    // A sequence of sequences is neither a number nor text, a section nor a matrix.
    const std::string text = without(file, key) + key + ": [[nonsense]]\n";
    for (const auto& read : readers) {
      try {
        read(Parameters::parse(text, "page"));
      } catch (const InputError& error) {
        const std::string message = error.what();
        const std::size_t at = message.find("; allowed: ");
        if (message.find("'" + key + "'") == std::string::npos || at == std::string::npos) continue;
        allowed.insert(message.substr(at + std::string("; allowed: ").size()));
      }
    }
  }
  return allowed;
}

TEST_F(ParametersPage, HasEveryKeyThatTheCodeKnows) {
  std::set<std::string> in_page;
  for (const Row& row : rowsOfPage()) {
    EXPECT_TRUE(in_page.insert(row.key).second) << row.key << " is there twice";
  }
  EXPECT_GT(in_page.size(), 60u);
  ASSERT_FALSE(isKnown("nobodys_key"));
  int known = 0;
  for (const std::string& word : wordsOfSources()) {
    if (!isKnown(word)) continue;
    ++known;
    EXPECT_EQ(in_page.count(word), 1u) << word << " is not in docs/parameters.md";
  }
  EXPECT_GT(known, 60);
}

TEST_F(ParametersPage, HasNoKeyThatTheCodeDoesNotKnow) {
  for (const Row& row : rowsOfPage()) EXPECT_TRUE(isKnown(row.key)) << row.key;
}

/// By this list a node knows the keys of the other stages; it must not warn of them.
TEST_F(ParametersPage, HasTheKeysThatTheNodesKnow) {
  std::set<std::string> in_page;
  for (const Row& row : rowsOfPage()) in_page.insert(row.key);
  const std::vector<std::string> keys = rigKeys();
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()), in_page)
      << "vins_core/src/rig_keys.cpp and docs/parameters.md differ";
}

TEST_F(ParametersPage, NamesTheAllowedValuesAsTheCodeDoes) {
  for (const Row& row : rowsOfPage()) {
    if (row.allowed == "text") continue;
    const std::set<std::string> allowed = allowedByCode(row.key);
    // A key of two readers is bound by the stricter one.
    EXPECT_EQ(allowed.count(row.allowed), 1u)
        << row.key << ": '" << row.allowed << "'; the code says '"
        << (allowed.empty() ? "nothing" : *allowed.begin()) << "'";
  }
}

TEST_F(ParametersPage, NamesTheDefaults) {
  const std::string file = smallFiles().front();
  const std::string expected = describe(file);
  int checked = 0;
  for (const Row& row : rowsOfPage()) {
    if (row.fallback.empty() || row.fallback.rfind("needed", 0) == 0) continue;
    EXPECT_EQ(describe(file + row.key + ": " + row.fallback + "\n"), expected) << row.key;
    ++checked;
  }
  EXPECT_GT(checked, 35);
}

TEST_F(ParametersPage, SaysNeededWhereTheCodeDoes) {
  const std::string file = smallFiles().front();
  for (const Row& row : rowsOfPage()) {
    // Nodes need the topics, run_bag has defaults for them.
    const bool is_topic = row.key.find("_topic") != std::string::npos;
    if (row.fallback != "needed" || is_topic) continue;
    EXPECT_THROW(describe(without(file, row.key)), InputError) << row.key;
  }
}

}  // namespace
}  // namespace vins::tests
