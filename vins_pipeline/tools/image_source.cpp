#include "image_source.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <variant>

#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"
#include "vins_pipeline/bag_recording.h"

namespace vins::pipeline {
namespace {

namespace fs = std::filesystem;

bool isImageFile(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* known : {".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"}) {
    if (ending == known) return true;
  }
  return false;
}

ImageLoader loaderOf(const std::string& path) {
  return [path] {
    cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (image.empty()) throw InputError(path + ": is no image that can be read");
    return image;
  };
}

std::vector<ImageLoader> imagesOfFolder(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && isImageFile(entry.path())) {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<ImageLoader> images;
  for (const std::string& path : paths) images.push_back(loaderOf(path));
  return images;
}

std::vector<ImageLoader> imagesOfRecording(const std::string& path,
                                           const ImageSourceOptions& options) {
  RecordingSelection selection;
  selection.imu_topic = options.imu_topic;
  selection.image_topics = {options.image_topic};
  const std::shared_ptr<Recording> recording = openRecording({path}, selection);
  std::vector<ImageLoader> images;
  std::optional<Stamp> last;
  while (const auto record = recording->next()) {
    const auto* image = std::get_if<RecordedImage>(&record->data);
    if (image == nullptr || (last && toSeconds(image->stamp - *last) < options.every)) continue;
    last = image->stamp;
    // The recording must live as long as its images are asked for.
    images.push_back([recording, load = image->load] { return load(); });
  }
  return images;
}

}  // namespace

std::vector<ImageLoader> findImages(const std::string& path, const ImageSourceOptions& options) {
  if (isImageFile(path)) return {loaderOf(path)};
  std::vector<ImageLoader> images;
  if (fs::is_directory(path)) images = imagesOfFolder(path);
  if (images.empty()) images = imagesOfRecording(path, options);
  if (images.empty()) throw InputError(path + ": holds no images");
  return images;
}

}  // namespace vins::pipeline
