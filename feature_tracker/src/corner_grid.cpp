#include "feature_tracker/corner_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/core/hal/intrin.hpp>

namespace vins::feature_tracker {
namespace {

constexpr int kBlock = 2;   // pixels between scores: finer, they say little more
constexpr int kBlocks = 4;  // side of the window of the structure tensor
constexpr int kWindow = kBlock * kBlocks;
constexpr int kReach = kWindow / 2 - 1;  // of the window before a score's place, and after it
constexpr double kScharrUnit = 32.0;     // of a gradient of one grey value per pixel
constexpr std::size_t kChoices = 4;      // corners of a cell that compete
constexpr int kFewestCells = 4;          // that are searched where corners are missing at all
constexpr int kRest = 3;                 // images in which a cell that gave nothing is not searched
constexpr int kCellsPerCorner = 2;       // that are searched for each missing corner
/// Share of the corners wanted, below which places where tracks were lost lately are taken, too.
constexpr double kFew = 2.0 / 3.0;
/// Score of a corner by the deviation of the noise, from which on noise seldom makes one. White
/// noise has a score of 0.45 of its deviation in the mean, and tops of 0.7 in a cell.
constexpr double kAboveNoise = 1.5;

/// The smaller eigenvalue of [xx xy; xy yy].
inline float smallerEigenvalue(float xx, float xy, float yy) {
  const float half_trace = 0.5F * (xx + yy);
  const float half_difference = 0.5F * (xx - yy);
  const float root = std::sqrt(half_difference * half_difference + xy * xy);
  const float smaller = half_trace - root;
  return smaller > 0.0F ? smaller : 0.0F;
}

/// Sums of the products xx, xy, yy of gradients x, y, which lie in turn, over blocks of 2x2 pixels.
void multiplyGradients(const short* upper, const short* lower, int blocks, int* xx, int* xy,
                       int* yy) {
  constexpr int kTogether = 4;
  int i = 0;
  for (; i + kTogether <= blocks; i += kTogether) {
    cv::v_int16x8 x, y, x_below, y_below;
    cv::v_load_deinterleave(upper + 4 * i, x, y);
    cv::v_load_deinterleave(lower + 4 * i, x_below, y_below);
    cv::v_store(xx + i, cv::v_dotprod(x, x) + cv::v_dotprod(x_below, x_below));
    cv::v_store(xy + i, cv::v_dotprod(x, y) + cv::v_dotprod(x_below, y_below));
    cv::v_store(yy + i, cv::v_dotprod(y, y) + cv::v_dotprod(y_below, y_below));
  }
  for (; i < blocks; ++i) {
    const short* a = upper + 4 * i;
    const short* b = lower + 4 * i;
    xx[i] = a[0] * a[0] + a[2] * a[2] + b[0] * b[0] + b[2] * b[2];
    xy[i] = a[0] * a[1] + a[2] * a[3] + b[0] * b[1] + b[2] * b[3];
    yy[i] = a[1] * a[1] + a[3] * a[3] + b[1] * b[1] + b[3] * b[3];
  }
}

/// Adds a row to sums of columns and takes an old one away, which may be null.
void carryOn(const int* row, const int* old, int count, int* sums) {
  if (old == nullptr) {
    for (int i = 0; i < count; ++i) sums[i] += row[i];
  } else {
    for (int i = 0; i < count; ++i) sums[i] += row[i] - old[i];
  }
}

/// Sum of four neighbours from `a` on.
inline float sumOfFour(const int* a) {
  static_assert(kBlocks == 4, "written out, so that the compiler can do several at once");
  return static_cast<float>((a[0] + a[1]) + (a[2] + a[3]));
}

/// Squares of a row of scores from the column sums of the structure tensor.
void scoreRow(const int* xx, const int* xy, const int* yy, int count, float* squares) {
  constexpr float kUnit = static_cast<float>(1.0 / (kScharrUnit * kWindow));
  for (int i = 0; i < count; ++i) {
    squares[i] =
        kUnit * kUnit * smallerEigenvalue(sumOfFour(xx + i), sumOfFour(xy + i), sumOfFour(yy + i));
  }
}

/// Where a parabola through three values, one pixel apart, has its top.
float parabolaTop(float before, float at, float after) {
  const float curvature = before - 2.0F * at + after;
  if (curvature >= 0.0F) return 0.0F;
  return std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
}

bool byScore(const Corner& a, const Corner& b) {
  return a.is_shunned == b.is_shunned ? a.score > b.score : b.is_shunned;
}

}  // namespace

CornerGrid::Neighbourhood::Neighbourhood(camera_model::ImageSize size, double min_distance)
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

CornerGrid::CornerGrid(camera_model::ImageSize size, const CornerGridOptions& options, cv::Mat mask)
    : size_(size),
      options_(options),
      mask_(std::move(mask)),
      neighbourhood_(size, options.min_distance),
      shunned_(size, options.min_distance) {
  // The outermost pixels have no gradient to be trusted, whatever the border.
  options_.border = std::max(options_.border, kReach + 2);
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

cv::Size CornerGrid::computeScores(const cv::Mat& gradients, const cv::Rect& area) {
  const cv::Size scores(area.width / kBlock, area.height / kBlock);
  const int columns = scores.width + kBlocks - 1;
  const int rows = scores.height + kBlocks - 1;
  products_.create(3 * std::max(rows, products_.rows / 3), std::max(columns, products_.cols));
  columns_sums_.create(3, std::max(columns, columns_sums_.cols));
  squared_scores_.create(std::max(scores.height, squared_scores_.rows),
                         std::max(scores.width, squared_scores_.cols));
  // Column sums over the window's rows are carried on from row to row.
  columns_sums_.setTo(0);
  for (int row = 0; row < rows; ++row) {
    const int y = area.y - kReach + kBlock * row;
    const int x = area.x - kReach;
    multiplyGradients(gradients.ptr<short>(y) + 2 * x, gradients.ptr<short>(y + 1) + 2 * x, columns,
                      products_[3 * row], products_[3 * row + 1], products_[3 * row + 2]);
    for (int k = 0; k < 3; ++k) {
      const int* const old = row < kBlocks ? nullptr : products_[3 * (row - kBlocks) + k];
      carryOn(products_[3 * row + k], old, columns, columns_sums_[k]);
    }
    if (row + 1 < kBlocks) continue;
    scoreRow(columns_sums_[0], columns_sums_[1], columns_sums_[2], scores.width,
             squared_scores_[row + 1 - kBlocks]);
  }
  return scores;
}

Corner CornerGrid::cornerAt(const cv::Rect& area, int row, int column) const {
  const auto score = [&](int dy, int dx) {
    return std::sqrt(squared_scores_(row + dy, column + dx));
  };
  const float top = score(0, 0);
  const float dx = parabolaTop(score(0, -1), top, score(0, 1));
  const float dy = parabolaTop(score(-1, 0), top, score(1, 0));
  const auto place = [](int start, float index) {
    // A window has as many pixels before its middle as after it.
    return static_cast<float>(start) + static_cast<float>(kBlock) * index + 0.5F;
  };
  return {cv::Point2f(place(area.x, static_cast<float>(column) + dx),
                      place(area.y, static_cast<float>(row) + dy)),
          top};
}

void CornerGrid::searchCell(const cv::Mat& gradients, const cv::Rect& area, float least_score,
                            std::vector<Corner>* corners) {
  const cv::Size scores = computeScores(gradients, area);
  found_in_cell_.clear();
  const float least = least_score * least_score;
  for (int row = 1; row + 1 < scores.height; ++row) {
    const float* above = squared_scores_[row - 1];
    const float* here = squared_scores_[row];
    const float* below = squared_scores_[row + 1];
    for (int i = 1; i + 1 < scores.width; ++i) {
      const float score = here[i];
      if (score < least || score <= here[i - 1] || score < here[i + 1]) continue;
      const bool is_top = score > above[i - 1] && score > above[i] && score > above[i + 1] &&
                          score >= below[i - 1] && score >= below[i] && score >= below[i + 1];
      if (is_top) found_in_cell_.push_back(cornerAt(area, row, i));
    }
  }
  chooseInCell(corners);
}

void CornerGrid::chooseInCell(std::vector<Corner>* corners) {
  for (Corner& corner : found_in_cell_) corner.is_shunned = !shunned_.isFree(corner.pixel);
  std::sort(found_in_cell_.begin(), found_in_cell_.end(), byScore);
  std::size_t chosen = 0;
  for (const Corner& corner : found_in_cell_) {
    if (!allows(corner.pixel) || !neighbourhood_.isFree(corner.pixel)) continue;
    corners->push_back(corner);
    if (++chosen == kChoices) break;
  }
}

/// The best of all cells, as many as are missing; shunned ones only in an image that has few.
std::vector<Corner> CornerGrid::accept(std::vector<Corner> candidates, int occupied) {
  std::stable_sort(candidates.begin(), candidates.end(), byScore);
  std::vector<Corner> accepted;
  for (const Corner& corner : candidates) {
    const int corners = occupied + static_cast<int>(accepted.size());
    if (corners >= options_.max_corners) break;
    if (corner.is_shunned && corners >= kFew * options_.max_corners) break;
    if (!neighbourhood_.isFree(corner.pixel)) continue;
    neighbourhood_.add(corner.pixel);
    accepted.push_back(corner);
  }
  return accepted;
}

std::vector<Corner> CornerGrid::detect(const cv::Mat& gradients,
                                       const std::vector<cv::Point2f>& occupied,
                                       const std::vector<cv::Point2f>& shunned, double noise) {
  const int missing = options_.max_corners - static_cast<int>(occupied.size());
  if (missing <= 0) return {};
  countCorners(occupied);
  shunned_.clear();
  for (const cv::Point2f& pixel : shunned) shunned_.add(pixel);
  const int margin = options_.border - 1;
  const cv::Rect searchable(margin, margin, size_.width - 2 * margin, size_.height - 2 * margin);
  const auto least_score = static_cast<float>(std::min(options_.quality, kAboveNoise * noise));
  std::vector<Corner> candidates;
  for (const int cell : cellsToSearch(missing)) {
    // A score more on each side, so that those at the cell's own edges can be tops.
    const cv::Rect& own = cells_[cell].area;
    const cv::Rect area =
        cv::Rect(own.x - kBlock, own.y - kBlock, own.width + 2 * kBlock, own.height + 2 * kBlock) &
        searchable;
    const std::size_t before = candidates.size();
    if (area.width >= 3 * kBlock && area.height >= 3 * kBlock) {
      searchCell(gradients, area, least_score, &candidates);
    }
    if (candidates.size() == before) cells_[cell].rest = kRest;
  }
  return accept(std::move(candidates), static_cast<int>(occupied.size()));
}

}  // namespace vins::feature_tracker
