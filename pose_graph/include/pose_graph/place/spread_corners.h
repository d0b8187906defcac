#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace vins::pose_graph {

/// What findSpreadCorners() looks for.
struct SpreadCornersOptions {
  int max_corners = 500;      ///< in an image
  int fast_threshold = 5;     ///< grey values by which FAST's arc differs from its centre
  double min_distance = 6.0;  ///< from the given pixels [px]
  int border = 24;            ///< no corner is nearer to the image's edge [px]

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// FAST corners (E. Rosten, T. Drummond, "Machine learning for high-speed corner detection", ECCV
/// 2006) of an image (CV_8UC1), spread evenly: the image is divided into about as many square cells
/// as a tenth of the corners that are wanted, and each gives its strongest ones. `taken` are pixels
/// that are described already, tracked features: their neighbourhood is left free. Row by row of
/// cells, strongest first within a cell. Throws InputError where the image is of another type.
std::vector<cv::Point2f> findSpreadCorners(const cv::Mat& image,
                                           const std::vector<cv::Point2f>& taken,
                                           const SpreadCornersOptions& options);

}  // namespace vins::pose_graph
