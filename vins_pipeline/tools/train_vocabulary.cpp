// Trains the vocabulary by which places are recognised, on images.

#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/core/utility.hpp>

#include "image_source.h"
#include "pose_graph/place/brief.h"
#include "pose_graph/place/spread_corners.h"
#include "pose_graph/place/vocabulary_file.h"
#include "pose_graph/place/vocabulary_training.h"
#include "vins_core/input_error.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"

namespace po = boost::program_options;

namespace {

using ImageDescriptors = std::vector<std::vector<vins::pose_graph::BriefDescriptor>>;

std::vector<vins::pipeline::ImageLoader> listImages(const po::variables_map& values) {
  vins::pipeline::ImageSourceOptions options;
  options.imu_topic = values["imu-topic"].as<std::string>();
  options.image_topic = values["image-topic"].as<std::string>();
  options.every = values["every"].as<double>();
  std::vector<vins::pipeline::ImageLoader> images;
  for (const auto& path : values["input"].as<std::vector<std::string>>()) {
    const auto found = vins::pipeline::findImages(path, options);
    std::cout << path << ": " << found.size() << " images\n";
    images.insert(images.end(), found.begin(), found.end());
  }
  return images;
}

/// Where there are too many, each image gives its share.
void thinOut(std::size_t most, ImageDescriptors* images) {
  std::size_t all = 0;
  for (const auto& image : *images) all += image.size();
  if (all <= most) return;
  for (auto& image : *images) {
    const std::size_t count = image.size() * most / all;
    for (std::size_t i = 0; i < count; ++i) image[i] = image[i * image.size() / count];
    image.resize(count);
  }
}

/// Throws InputError with the first reason where no image could be read.
void tellRefused(const std::vector<std::string>& refused, std::size_t all) {
  if (refused.empty()) return;
  if (refused.size() == all) throw vins::InputError(refused.front());
  for (const std::string& reason : refused) std::cerr << "warning: " << reason << "\n";
  std::cout << "refused: " << refused.size() << " of " << all << " images\n";
}

/// Of all images that can be read; one that cannot costs itself only and is told.
ImageDescriptors describe(const std::vector<vins::pipeline::ImageLoader>& images,
                          const po::variables_map& values) {
  const vins::pose_graph::BriefExtractor brief(
      vins::pose_graph::BriefPattern::load(values["pattern"].as<std::string>()));
  vins::pose_graph::SpreadCornersOptions corners;
  corners.max_corners = values["descriptors-per-image"].as<int>();
  corners.border = brief.border();
  corners.validate();
  ImageDescriptors descriptors;
  auto bar = vins::ProgressBar::onStandardError("describing images", images.size());
  std::vector<std::string> refused;
  for (const auto& load : images) {
    try {
      const cv::Mat image = load();
      const auto found = vins::pose_graph::findSpreadCorners(image, {}, corners);
      descriptors.push_back(brief.describe(image, found).descriptors);
    } catch (const vins::InputError& error) {
      refused.push_back(error.what());
    }
    bar.update(descriptors.size() + refused.size());
  }
  bar.finish();
  tellRefused(refused, images.size());
  thinOut(values["max-descriptors"].as<std::size_t>(), &descriptors);
  return descriptors;
}

vins::ToolExit train(const po::variables_map& values) {
  cv::setNumThreads(1);
  vins::pose_graph::VocabularyTrainingOptions options;
  options.branching = values["k"].as<int>();
  options.levels = values["levels"].as<int>();
  options.seed = values["seed"].as<std::uint64_t>();
  options.fewest_to_split = values["fewest-to-split"].as<int>();
  options.validate();
  const ImageDescriptors images = describe(listImages(values), values);
  constexpr double kSteps = 1000.0;
  auto bar = vins::ProgressBar::onStandardError("training", static_cast<std::size_t>(kSteps));
  const vins::pose_graph::Vocabulary vocabulary = vins::pose_graph::trainVocabulary(
      images, options, [&](double share) { bar.update(static_cast<std::size_t>(kSteps * share)); });
  bar.finish();
  const std::string path = values["output"].as<std::string>();
  vins::pose_graph::writeVocabulary(path, vocabulary);
  std::cout << "written: " << path << ", " << vocabulary.wordCount() << " words of "
            << vocabulary.nodeCount() << " nodes\n";
  return vins::ToolExit::kDone;
}

po::options_description describeOptions() {
  const vins::pose_graph::VocabularyTrainingOptions defaults;
  po::options_description options;
  auto add = options.add_options();
  add("input", po::value<std::vector<std::string>>()->required(),
      "images, folders of images, folders in the ASL layout, ROS bags");
  add("output,o", po::value<std::string>()->required(), "vocabulary to write");
  add("pattern", po::value<std::string>()->required(), "BRIEF's pattern: brief_pattern.yml");
  add("k", po::value<int>()->default_value(defaults.branching), "children of a node");
  add("levels", po::value<int>()->default_value(defaults.levels), "from the root to the words");
  add("seed", po::value<std::uint64_t>()->default_value(defaults.seed),
      "same seed and images, same vocabulary");
  add("fewest-to-split", po::value<int>()->default_value(defaults.fewest_to_split),
      "descriptors of a node that gets children");
  add("max-descriptors", po::value<std::size_t>()->default_value(1'000'000),
      "to train on; each image gives its share");
  add("descriptors-per-image", po::value<int>()->default_value(500), "at most");
  add("every", po::value<double>()->default_value(0.5),
      "one image of a recording in this time [s]");
  add("image-topic", po::value<std::string>()->default_value("/cam0/image_raw"), "of recordings");
  add("imu-topic", po::value<std::string>()->default_value("/imu0"), "of recordings");
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "train_vocabulary",
      "Trains the vocabulary by which the pose graph recognises places.\n"
      "Usage: train_vocabulary INPUT ... -o OUT.bin --pattern brief_pattern.yml\n",
      describeOptions(),
      {{"input", -1}}};
  return vins::runTool(argc, argv, tool, train);
}
