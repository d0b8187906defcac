#include "feature_tracker/corner_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vins {
namespace {

constexpr int kRadius = 3;  // of the window of the structure tensor
constexpr int kWindow = 2 * kRadius + 1;
constexpr double kScharrUnit = 32.0;  // of a gradient of one grey value per pixel
constexpr std::size_t kChoices = 4;   // corners of a cell that compete
constexpr int kFewestCells = 4;       // that are searched where corners are missing at all
constexpr int kRest = 3;              // images in which a cell that gave nothing is not searched
constexpr int kCellsPerCorner = 1;    // that are searched for each missing corner

/// The smaller eigenvalue of [xx xy; xy yy].
inline float smallerEigenvalue(float xx, float xy, float yy) {
  const float half_trace = 0.5F * (xx + yy);
  const float half_difference = 0.5F * (xx - yy);
  const float root = std::sqrt(half_difference * half_difference + xy * xy);
  const float smaller = half_trace - root;
  return smaller > 0.0F ? smaller : 0.0F;
}

/// Products xx, xy, yy of gradients x, y that lie in turn.
void multiplyGradients(const short* gradients, int count, float* xx, float* xy, float* yy) {
  for (int i = 0; i < count; ++i) {
    const float x = gradients[2 * i], y = gradients[2 * i + 1];
    xx[i] = x * x, xy[i] = x * y, yy[i] = y * y;
  }
}

/// Adds a row to sums of columns and takes an old one away, which may be null.
void carryOn(const float* row, const float* old, int count, float* sums) {
  if (old == nullptr) {
    for (int i = 0; i < count; ++i) sums[i] += row[i];
  } else {
    for (int i = 0; i < count; ++i) sums[i] += row[i] - old[i];
  }
}

/// Sum of seven neighbours from `a` on.
inline float sumOfSeven(const float* a) {
  static_assert(kWindow == 7, "written out, so that the compiler can do several at once");
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + a[6]);
}

/// Squares of the scores of a row of pixels from the column sums of the structure tensor.
void scoreRow(const float* xx, const float* xy, const float* yy, int count, float* squares) {
  constexpr float kUnit = static_cast<float>(1.0 / (kScharrUnit * kWindow));
  for (int i = 0; i < count; ++i) {
    squares[i] = kUnit * kUnit *
                 smallerEigenvalue(sumOfSeven(xx + i), sumOfSeven(xy + i), sumOfSeven(yy + i));
  }
}

/// Where a parabola through three values, one pixel apart, has its top.
float parabolaTop(float before, float at, float after) {
  const float curvature = before - 2.0F * at + after;
  if (curvature >= 0.0F) return 0.0F;
  return std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
}

bool byScore(const Corner& a, const Corner& b) { return a.score > b.score; }

}  // namespace

CornerGrid::Neighbourhood::Neighbourhood(ImageSize size, double min_distance)
    : min_distance_(std::max(1.0, min_distance)),
      columns_(static_cast<int>(size.width / min_distance_) + 1),
      rows_(static_cast<int>(size.height / min_distance_) + 1),
      buckets_(static_cast<std::size_t>(columns_) * rows_) {}

void CornerGrid::Neighbourhood::clear() {
  for (auto& bucket : buckets_) bucket.clear();
}

cv::Point CornerGrid::Neighbourhood::bucketOf(const cv::Point2f& pixel) const {
  return {std::clamp(static_cast<int>(pixel.x / min_distance_), 0, columns_ - 1),
          std::clamp(static_cast<int>(pixel.y / min_distance_), 0, rows_ - 1)};
}

void CornerGrid::Neighbourhood::add(const cv::Point2f& pixel) {
  const cv::Point bucket = bucketOf(pixel);
  buckets_[static_cast<std::size_t>(bucket.y) * columns_ + bucket.x].push_back(pixel);
}

bool CornerGrid::Neighbourhood::isFree(const cv::Point2f& pixel) const {
  const cv::Point centre = bucketOf(pixel);
  const double limit = min_distance_ * min_distance_;
  for (int y = std::max(0, centre.y - 1); y <= std::min(rows_ - 1, centre.y + 1); ++y) {
    for (int x = std::max(0, centre.x - 1); x <= std::min(columns_ - 1, centre.x + 1); ++x) {
      for (const cv::Point2f& other : buckets_[static_cast<std::size_t>(y) * columns_ + x]) {
        const cv::Point2f d = other - pixel;
        if (d.dot(d) < limit) return false;
      }
    }
  }
  return true;
}

CornerGrid::CornerGrid(ImageSize size, const CornerGridOptions& options, cv::Mat mask)
    : size_(size),
      options_(options),
      mask_(std::move(mask)),
      neighbourhood_(size, options.min_distance) {
  // The outermost pixels have no gradient to be trusted, whatever the border.
  options_.border = std::max(options_.border, kRadius + 2);
  const double pixels = static_cast<double>(size.width) * size.height;
  const double side =
      std::max({std::sqrt(pixels / options.max_corners), options.min_distance, 2.0 * kWindow});
  columns_ = std::max(1, static_cast<int>(std::lround(size.width / side)));
  const int rows = std::max(1, static_cast<int>(std::lround(size.height / side)));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const cv::Point from(column * size.width / columns_, row * size.height / rows);
      const cv::Point to((column + 1) * size.width / columns_, (row + 1) * size.height / rows);
      cells_.push_back({cv::Rect(from, to), 0});
    }
  }
}

bool CornerGrid::allows(const cv::Point2f& pixel) const {
  const float border = static_cast<float>(options_.border);
  // Written so that NaN is not allowed.
  const bool inside = pixel.x >= border && pixel.y >= border &&
                      pixel.x <= static_cast<float>(size_.width - 1) - border &&
                      pixel.y <= static_cast<float>(size_.height - 1) - border;
  if (!inside) return false;
  return mask_.empty() || mask_.at<std::uint8_t>(cvRound(pixel.y), cvRound(pixel.x)) != 0;
}

void CornerGrid::countCorners(const std::vector<cv::Point2f>& occupied) {
  neighbourhood_.clear();
  for (Cell& cell : cells_) cell.corners = 0;
  const int rows = static_cast<int>(cells_.size()) / columns_;
  for (const cv::Point2f& pixel : occupied) {
    neighbourhood_.add(pixel);
    const int column =
        std::clamp(static_cast<int>(pixel.x * columns_ / size_.width), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(pixel.y * rows / size_.height), 0, rows - 1);
    ++cells_[static_cast<std::size_t>(row) * columns_ + column].corners;
  }
}

std::vector<int> CornerGrid::cellsToSearch(int missing) {
  // After a blackout no cell may wait.
  const bool in_need = 2 * missing > options_.max_corners;
  std::vector<int> empty, others;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    // Counted from a place that moves on, so that no part of the image is always last.
    const int cell = static_cast<int>((next_cell_ + i) % cells_.size());
    const bool rests = cells_[cell].rest > 0;
    if (rests) --cells_[cell].rest;
    if (rests && !in_need) continue;
    (cells_[cell].corners == 0 ? empty : others).push_back(cell);
  }
  std::vector<int> cells = std::move(empty);
  cells.insert(cells.end(), others.begin(), others.end());
  const std::size_t most = static_cast<std::size_t>(kFewestCells + kCellsPerCorner * missing);
  if (cells.size() > most) {
    cells.resize(most);
    next_cell_ = static_cast<std::size_t>(cells.back() + 1) % cells_.size();
  }
  return cells;
}

void CornerGrid::computeScores(const cv::Mat& gradients, const cv::Rect& area) {
  const int width = area.width + 2 * kRadius;
  const int rows = area.height + 2 * kRadius;
  products_.create(3 * std::max(rows, products_.rows / 3), std::max(width, products_.cols));
  columns_sums_.create(3, std::max(width, columns_sums_.cols));
  squared_scores_.create(std::max(area.height, squared_scores_.rows),
                         std::max(area.width, squared_scores_.cols));
  for (int row = 0; row < rows; ++row) {
    multiplyGradients(gradients.ptr<short>(area.y + row - kRadius) + 2 * (area.x - kRadius), width,
                      products_[3 * row], products_[3 * row + 1], products_[3 * row + 2]);
  }
  // Column sums over the window's rows are carried on from row to row.
  columns_sums_.setTo(0.0F);
  for (int row = 0; row < rows; ++row) {
    for (int k = 0; k < 3; ++k) {
      const float* const old = row < kWindow ? nullptr : products_[3 * (row - kWindow) + k];
      carryOn(products_[3 * row + k], old, width, columns_sums_[k]);
    }
    if (row + 1 < kWindow) continue;
    scoreRow(columns_sums_[0], columns_sums_[1], columns_sums_[2], area.width,
             squared_scores_[row + 1 - kWindow]);
  }
}

Corner CornerGrid::cornerAt(const cv::Rect& area, int row, int column) const {
  const auto score = [&](int dy, int dx) {
    return std::sqrt(squared_scores_(row + dy, column + dx));
  };
  const float top = score(0, 0);
  const float dx = parabolaTop(score(0, -1), top, score(0, 1));
  const float dy = parabolaTop(score(-1, 0), top, score(1, 0));
  return {
      cv::Point2f(static_cast<float>(area.x + column) + dx, static_cast<float>(area.y + row) + dy),
      top};
}

void CornerGrid::searchCell(const cv::Mat& gradients, const cv::Rect& area,
                            std::vector<Corner>* corners) {
  computeScores(gradients, area);
  found_in_cell_.clear();
  const float least = static_cast<float>(options_.quality * options_.quality);
  for (int row = 1; row + 1 < area.height; ++row) {
    const float* above = squared_scores_[row - 1];
    const float* here = squared_scores_[row];
    const float* below = squared_scores_[row + 1];
    for (int i = 1; i + 1 < area.width; ++i) {
      const float score = here[i];
      if (score < least || score <= here[i - 1] || score < here[i + 1]) continue;
      const bool is_top = score > above[i - 1] && score > above[i] && score > above[i + 1] &&
                          score >= below[i - 1] && score >= below[i] && score >= below[i + 1];
      if (is_top) found_in_cell_.push_back(cornerAt(area, row, i));
    }
  }
  std::sort(found_in_cell_.begin(), found_in_cell_.end(), byScore);
  std::size_t chosen = 0;
  for (const Corner& corner : found_in_cell_) {
    if (!allows(corner.pixel) || !neighbourhood_.isFree(corner.pixel)) continue;
    corners->push_back(corner);
    if (++chosen == kChoices) break;
  }
}

std::vector<Corner> CornerGrid::detect(const cv::Mat& gradients,
                                       const std::vector<cv::Point2f>& occupied,
                                       const std::vector<cv::Point2f>& shunned) {
  std::vector<Corner> accepted;
  const int missing = options_.max_corners - static_cast<int>(occupied.size());
  if (missing <= 0) return accepted;
  countCorners(occupied);
  for (const cv::Point2f& pixel : shunned) neighbourhood_.add(pixel);
  const int margin = options_.border - 1;
  const cv::Rect searchable(margin, margin, size_.width - 2 * margin, size_.height - 2 * margin);
  std::vector<Corner> candidates;
  for (const int cell : cellsToSearch(missing)) {
    // A pixel more on each side, so that the cell's own edge pixels can be tops.
    const cv::Rect& own = cells_[cell].area;
    const cv::Rect area =
        cv::Rect(own.x - 1, own.y - 1, own.width + 2, own.height + 2) & searchable;
    const std::size_t before = candidates.size();
    if (area.width > 2 && area.height > 2) searchCell(gradients, area, &candidates);
    if (candidates.size() == before) cells_[cell].rest = kRest;
  }
  std::stable_sort(candidates.begin(), candidates.end(), byScore);
  for (const Corner& corner : candidates) {
    if (static_cast<int>(accepted.size()) == missing) break;
    if (!neighbourhood_.isFree(corner.pixel)) continue;
    neighbourhood_.add(corner.pixel);
    accepted.push_back(corner);
  }
  return accepted;
}

}  // namespace vins
