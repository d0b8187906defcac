// How well places are recognised in a recording whose true path is known: precision and recall of
// vocabularies, and what the verification makes of their candidates.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "place_study.h"
#include "pose_graph/loop/match_drawing.h"
#include "pose_graph/place/vocabulary_file.h"
#include "vins_core/input_error.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

constexpr double kDegree = M_PI / 180.0;

vins::pipeline::PlaceStudyOptions studyOptions(const po::variables_map& values) {
  vins::pipeline::PlaceStudyOptions options;
  options.view.direct_index_level = values["direct-index-level"].as<int>();
  options.detector.excluded_keyframes = values["exclude-keyframes"].as<int>();
  options.detector.excluded_seconds = values["exclude-seconds"].as<double>();
  options.detector.min_normalized_score = values["min-normalized-score"].as<double>();
  options.detector.consistent_keyframes = values["consistent"].as<int>();
  options.verifier.min_inliers = values["min-inliers"].as<int>();
  return options;
}

std::string curveCsv(const std::vector<vins::pipeline::CurvePoint>& curve) {
  std::ostringstream out;
  out << "normalized_score,answers,right,precision,recall\n";
  for (const vins::pipeline::CurvePoint& point : curve) {
    out << point.threshold << "," << point.answers << "," << point.right << "," << point.precision
        << "," << point.recall << "\n";
  }
  return out.str();
}

std::string loopsCsv(const vins::pipeline::PlaceStudy& study) {
  std::ostringstream out;
  out << "query,old,score,overlap,matches,epipolar_inliers,pose_inliers,tilt_deg,position_error_m,"
         "rotation_error_deg,status\n";
  for (const vins::pipeline::StudiedLoop& loop : study.loops) {
    const vins::pose_graph::LoopVerification& found = loop.verification;
    out << loop.query << "," << loop.old << "," << loop.score << "," << loop.overlap << ","
        << found.matches.size() << "," << found.epipolar_inliers << "," << found.pose_inliers << ","
        << found.tilt / kDegree << "," << loop.position_error << ","
        << loop.rotation_error / kDegree << "," << toString(found.status) << "\n";
  }
  return out.str();
}

void printCurve(const std::vector<vins::pipeline::CurvePoint>& curve) {
  std::cout << "  threshold  answers  precision  recall\n";
  for (std::size_t i = 1; i <= 10; ++i) {
    if (curve.empty()) break;
    const vins::pipeline::CurvePoint& point =
        curve[std::max<std::size_t>(1, curve.size() * i / 10) - 1];
    std::cout << std::fixed << std::setprecision(3) << std::setw(11) << point.threshold
              << std::setw(9) << point.answers << std::setw(11) << point.precision << std::setw(8)
              << point.recall << "\n";
  }
}

void printLoops(const vins::pipeline::PlaceStudy& study,
                const vins::pipeline::PlaceStudyOptions& options) {
  int accepted = 0, wrong = 0, overlapping = 0;
  std::vector<double> positions, rotations;
  for (const vins::pipeline::StudiedLoop& loop : study.loops) {
    overlapping += loop.overlap >= options.needed_overlap ? 1 : 0;
    if (!loop.verification.isAccepted()) continue;
    ++accepted;
    wrong += loop.overlap < options.found_overlap ? 1 : 0;
    positions.push_back(loop.position_error);
    rotations.push_back(loop.rotation_error / kDegree);
  }
  std::cout << "  verified: " << study.loops.size() << " candidates (" << overlapping
            << " overlap well), " << accepted << " accepted, " << wrong << " of them wrong\n";
  if (accepted == 0) return;
  std::sort(positions.begin(), positions.end());
  std::sort(rotations.begin(), rotations.end());
  std::cout << std::setprecision(3) << "  error of accepted poses: median "
            << positions[accepted / 2] << " m, " << rotations[accepted / 2] << " deg; worst "
            << positions.back() << " m, " << rotations.back() << " deg\n";
}

/// The first accepted loops, and every one that is wrong.
void drawLoops(const std::vector<vins::pipeline::StudiedKeyframe>& keyframes,
               const vins::pipeline::PlaceStudy& study,
               const vins::pipeline::PlaceStudyOptions& options, std::size_t most,
               const fs::path& folder) {
  std::size_t drawn = 0;
  for (const vins::pipeline::StudiedLoop& loop : study.loops) {
    if (!loop.verification.isAccepted()) continue;
    const bool is_wrong = loop.overlap < options.found_overlap;
    if (!is_wrong && drawn >= most) continue;
    drawn += is_wrong ? 0 : 1;
    const std::string name = (is_wrong ? "wrong_" : "loop_") + std::to_string(loop.query) + "_" +
                             std::to_string(loop.old) + ".png";
    const cv::Mat picture = vins::pose_graph::drawMatches(
        keyframes[loop.query].image, keyframes[loop.old].image, study.views[loop.query],
        study.views[loop.old], loop.verification, loop.score);
    if (!cv::imwrite((folder / name).string(), picture)) {
      throw vins::InputError((folder / name).string() + ": cannot be written");
    }
  }
}

vins::ToolExit evaluate(const po::variables_map& values) {
  cv::setNumThreads(1);
  vins::pipeline::PipelineOptions pipeline =
      vins::pipeline::readPipelineOptions(values["config"].as<std::string>(), nullptr);
  pipeline.estimator.max_solver_time = 0.0;
  const auto keyframes = vins::pipeline::collectKeyframes(
      pipeline, values["recording"].as<std::string>(), 0.0, std::nullopt);
  const auto options = studyOptions(values);
  const auto pattern = vins::pose_graph::BriefPattern::load(values["pattern"].as<std::string>());
  const fs::path folder = values["out"].as<std::string>();
  fs::create_directories(folder);
  for (const auto& path : values["vocabulary"].as<std::vector<std::string>>()) {
    const vins::pose_graph::Vocabulary vocabulary = vins::pose_graph::readVocabulary(path);
    const auto study = vins::pipeline::studyPlaces(keyframes, *pipeline.cameras.front(), vocabulary,
                                                   pattern, options);
    const auto curve = vins::pipeline::precisionRecall(study, options);
    const std::string name = fs::path(path).stem().string();
    vins::writeTextFile((folder / (name + "_curve.csv")).string(), curveCsv(curve));
    vins::writeTextFile((folder / (name + "_loops.csv")).string(), loopsCsv(study));
    const auto to_find = std::count_if(study.queries.begin(), study.queries.end(),
                                       [](const auto& query) { return query.can_be_found; });
    std::cout << path << ": " << vocabulary.wordCount() << " words; " << keyframes.size()
              << " keyframes, " << to_find << " at places seen before\n";
    printCurve(curve);
    std::cout << "  recall without a wrong answer: " << std::setprecision(3)
              << vins::pipeline::recallWithoutError(curve) << "\n";
    printLoops(study, options);
    std::cout << "  cost: describe " << std::setprecision(2) << study.describe_ms << " ms, detect "
              << study.detect_ms << " ms, verify " << study.verify_ms << " ms (worst "
              << study.verify_worst_ms << " ms); largest view " << study.largest_view << " bytes\n";
    drawLoops(keyframes, study, options, values["pictures"].as<std::size_t>(), folder);
  }
  return vins::ToolExit::kDone;
}

po::options_description describeOptions() {
  const vins::pose_graph::LoopDetectorOptions detector;
  po::options_description options;
  auto add = options.add_options();
  add("config", po::value<std::string>()->required(), "configuration file of the rig");
  add("recording", po::value<std::string>()->required(),
      "ROS bag or folder in the ASL layout, with ground truth");
  add("vocabulary", po::value<std::vector<std::string>>()->required(),
      "vocabulary; may be given several times");
  add("pattern", po::value<std::string>()->required(), "BRIEF's pattern: brief_pattern.yml");
  add("out", po::value<std::string>()->default_value("places"),
      "folder for curves, loops and pictures");
  add("pictures", po::value<std::size_t>()->default_value(5),
      "of accepted loops; wrong ones are always drawn");
  add("exclude-keyframes", po::value<int>()->default_value(detector.excluded_keyframes),
      "the last ones are no loop");
  add("exclude-seconds", po::value<double>()->default_value(detector.excluded_seconds),
      "nor are those of this time [s]");
  add("min-normalized-score", po::value<double>()->default_value(detector.min_normalized_score),
      "of candidates");
  add("consistent", po::value<int>()->default_value(detector.consistent_keyframes),
      "keyframes before that must agree");
  add("min-inliers",
      po::value<int>()->default_value(vins::pose_graph::LoopVerifierOptions().min_inliers),
      "of an accepted loop");
  add("direct-index-level",
      po::value<int>()->default_value(vins::pose_graph::ViewOptions().direct_index_level),
      "of the vocabulary; 0: compare all features");
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "evaluate_places",
      "Measures how well places are recognised, where the true path is known.\n"
      "Usage: evaluate_places --config RIG.yaml --recording BAG "
      "--vocabulary V.bin --pattern brief_pattern.yml\n",
      describeOptions()};
  return vins::runTool(argc, argv, tool, evaluate);
}
