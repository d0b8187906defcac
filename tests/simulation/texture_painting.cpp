#include "simulation/texture_painting.h"

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "simulation/plain_textures.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

/// Fractional bits of the drawn coordinates.
constexpr int kShift = 4;

using Outline = std::vector<cv::Point2d>;

/// A periodic 8-bit canvas: what leaves on one side comes back on the other.
class Canvas {
 public:
  Canvas(const TextureOptions& options, int grey)
      : texels_per_m_(options.texels_per_m),
        image_(options.height, options.width, CV_8UC1, cv::Scalar(grey)) {}

  const cv::Mat& image() const { return image_; }
  int width() const { return image_.cols; }
  int height() const { return image_.rows; }
  double texels(double metres) const { return metres * texels_per_m_; }
  double area_m2() const { return image_.total() / (texels_per_m_ * texels_per_m_); }

  /// A filled convex outline.
  void fill(const Outline& outline, int grey) {
    wrapped(outline, [&](const std::vector<cv::Point>& points) {
      cv::fillConvexPoly(image_, points, cv::Scalar(grey), cv::LINE_AA, kShift);
    });
  }

  void line(const Outline& outline, int grey, int thickness) {
    wrapped(outline, [&](const std::vector<cv::Point>& points) {
      cv::polylines(image_, points, false, cv::Scalar(grey), thickness, cv::LINE_AA, kShift);
    });
  }

 private:
  /// Calls draw for each periodic copy of the outline that touches the canvas.
  void wrapped(const Outline& outline,
               const std::function<void(const std::vector<cv::Point>&)>& draw) {
    const double margin = 8.0;  // thick lines reach beyond their outline
    cv::Point2d low = outline.front(), high = outline.front();
    for (const cv::Point2d& p : outline) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    for (int x = -2 * width(); x <= width(); x += width()) {
      if (high.x + x < -margin || low.x + x > width() + margin) continue;
      for (int y = -2 * height(); y <= height(); y += height()) {
        if (high.y + y < -margin || low.y + y > height() + margin) continue;
        draw(shifted(outline, x, y));
      }
    }
  }

  static std::vector<cv::Point> shifted(const Outline& outline, int x, int y) {
    std::vector<cv::Point> points;
    points.reserve(outline.size());
    for (const cv::Point2d& p : outline) {
      points.emplace_back(static_cast<int>(std::lround((p.x + x) * (1 << kShift))),
                          static_cast<int>(std::lround((p.y + y) * (1 << kShift))));
    }
    return points;
  }

  double texels_per_m_;
  cv::Mat image_;
};

int greyBetween(Random& random, int from, int to) {
  return static_cast<int>(random.uniform(from, to + 1.0));
}

Outline rotatedRectangle(const cv::Point2d& centre, double half_width, double half_height,
                         double angle) {
  const cv::Point2d x(half_width * std::cos(angle), half_width * std::sin(angle));
  const cv::Point2d y(-half_height * std::sin(angle), half_height * std::cos(angle));
  return {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
}

/// A convex polygon on an ellipse: a triangle, a quadrangle or (24 corners) something round.
Outline ellipsePolygon(Random& random, const cv::Point2d& centre, double radius) {
  const int choices[] = {3, 4, 5, 24};
  const int corners = choices[static_cast<int>(random.uniform(0.0, 4.0))];
  const double squeeze = random.uniform(0.4, 1.0), turn = random.uniform(0.0, 2.0 * M_PI);
  Outline outline;
  for (int i = 0; i < corners; ++i) {
    const double jitter = corners < 24 ? random.uniform(-0.3, 0.3) : 0.0;
    const double angle = 2.0 * M_PI * (i + jitter) / corners;
    const double x = radius * std::cos(angle), y = squeeze * radius * std::sin(angle);
    outline.emplace_back(centre.x + x * std::cos(turn) - y * std::sin(turn),
                         centre.y + x * std::sin(turn) + y * std::cos(turn));
  }
  return outline;
}

cv::Point2d anywhere(const Canvas& canvas, Random& random) {
  const double x = random.uniform(0.0, canvas.width());
  return {x, random.uniform(0.0, canvas.height())};
}

/// Shapes from `smallest_m` to `largest_m` in radius, as many as cover the canvas `coverage` times.
void scatterLeaves(Canvas& canvas, Random& random, double coverage, double smallest_m,
                   double largest_m, int darkest, int brightest) {
  const double smallest = std::max(canvas.texels(smallest_m), 2.0);
  const double largest = std::min(canvas.texels(largest_m), 0.3 * canvas.width());
  double area = coverage * canvas.width() * canvas.height();
  while (area > 0.0) {
    // Inverse of the distribution function of p(r) ~ r^-3.
    const double u = random.uniform();
    const double radius =
        1.0 / std::sqrt((1.0 - u) / (smallest * smallest) + u / (largest * largest));
    const cv::Point2d centre = anywhere(canvas, random);
    const bool straight = random.uniform() < 0.4;
    const double squeeze = random.uniform(0.3, 1.0), turn = random.uniform(-0.2, 0.2);
    const Outline outline = straight ? rotatedRectangle(centre, radius, squeeze * radius, turn)
                                     : ellipsePolygon(random, centre, radius);
    canvas.fill(outline, greyBetween(random, darkest, brightest));
    area -= 2.0 * radius * radius;
  }
}

/// Wandering thin lines: scratches, cracks, cables.
void scribble(Canvas& canvas, Random& random, double lines_per_m2) {
  const int lines = static_cast<int>(std::ceil(lines_per_m2 * canvas.area_m2()));
  for (int i = 0; i < lines; ++i) {
    Outline outline = {anywhere(canvas, random)};
    double heading = random.uniform(0.0, 2.0 * M_PI);
    for (int leg = 0; leg < 6; ++leg) {
      heading += random.uniform(-0.9, 0.9);
      const double length = canvas.texels(random.uniform(0.02, 0.10));
      outline.push_back(outline.back() +
                        length * cv::Point2d(std::cos(heading), std::sin(heading)));
    }
    canvas.line(outline, greyBetween(random, 20, 230), random.uniform() < 0.5 ? 1 : 2);
  }
}

/// A sheet with a frame and lines of words.
void drawSheet(Canvas& canvas, Random& random, const cv::Point2d& centre, double half_width,
               double half_height) {
  const int paper = greyBetween(random, 150, 245), ink = greyBetween(random, 10, 90);
  canvas.fill(rotatedRectangle(centre, half_width, half_height, 0.0), paper);
  const double pitch = canvas.texels(random.uniform(0.015, 0.05));
  for (double y = -0.85 * half_height; y < 0.85 * half_height; y += pitch) {
    double x = -0.85 * half_width;
    while (x < 0.8 * half_width) {
      const double word = std::min(pitch * random.uniform(0.4, 3.0), 0.85 * half_width - x);
      const cv::Point2d middle(x + 0.5 * word, y);
      if (random.uniform() < 0.85) {
        canvas.fill(rotatedRectangle(centre + middle, 0.5 * word, 0.28 * pitch, 0.0), ink);
      }
      x += word + 0.4 * pitch;
    }
  }
}

void scatterSheets(Canvas& canvas, Random& random, double sheets_per_m2) {
  const int sheets = static_cast<int>(std::ceil(sheets_per_m2 * canvas.area_m2()));
  for (int i = 0; i < sheets; ++i) {
    const cv::Point2d centre = anywhere(canvas, random);
    const double half_width = canvas.texels(random.uniform(0.06, 0.2));
    drawSheet(canvas, random, centre, half_width, half_width * random.uniform(0.6, 1.5));
  }
}

/// Rows of rectangles with joints, each a grey of its own; every second row shifted by `stagger`.
/// The sizes are rounded so that whole rectangles fit the period.
void layRows(Canvas& canvas, Random& random, double width_m, double height_m, double stagger,
             int darkest, int brightest) {
  const int rows =
      2 * std::max(1, static_cast<int>(0.5 * canvas.height() / canvas.texels(height_m)));
  const int columns = std::max(1, static_cast<int>(canvas.width() / canvas.texels(width_m)));
  const double width = static_cast<double>(canvas.width()) / columns;
  const double height = static_cast<double>(canvas.height()) / rows;
  const double joint = std::max(1.0, canvas.texels(0.004));
  const cv::Point2d corner = anywhere(canvas, random);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = (column + 0.5 + (row % 2) * stagger) * width;
      canvas.fill(rotatedRectangle(corner + cv::Point2d(x, (row + 0.5) * height),
                                   0.5 * width - joint, 0.5 * height - joint, 0.0),
                  greyBetween(random, darkest, brightest));
    }
  }
}

void paintPlaster(Canvas& canvas, Random& random) {
  scatterLeaves(canvas, random, 0.35, 0.012, 0.5, 90, 200);
  scatterSheets(canvas, random, 0.6);
  scribble(canvas, random, 4.0);
}

void paintTiles(Canvas& canvas, Random& random) {
  layRows(canvas, random, 0.4, 0.4, 0.0, 105, 165);
  scatterLeaves(canvas, random, 0.3, 0.012, 0.3, 50, 210);
  scribble(canvas, random, 3.0);
}

void paintBricks(Canvas& canvas, Random& random) {
  layRows(canvas, random, 0.25, 0.08, 0.5, 80, 170);
  scatterLeaves(canvas, random, 0.12, 0.015, 0.3, 40, 220);
  scatterSheets(canvas, random, 0.4);
}

void paintPrint(Canvas& canvas, Random& random) {
  scatterLeaves(canvas, random, 0.8, 0.01, 0.3, 20, 235);
  scatterSheets(canvas, random, 6.0);
}

void paintBoards(Canvas& canvas, Random& random) {
  layRows(canvas, random, 0.9, 0.12, 0.37, 90, 180);
  scatterLeaves(canvas, random, 0.15, 0.01, 0.15, 30, 220);
  scribble(canvas, random, 6.0);
}

void paintGround(Canvas& canvas, Random& random) {
  scatterLeaves(canvas, random, 1.5, 0.04, 2.0, 70, 190);
  scribble(canvas, random, 0.2);
}

/// Draws a style's shapes; returns how strongly the noise modulates them (standard deviation).
double paint(Canvas& canvas, Random& random, TextureStyle style) {
  switch (style) {
    case TextureStyle::kPlaster:
      return paintPlaster(canvas, random), 0.10;
    case TextureStyle::kBricks:
      return paintBricks(canvas, random), 0.13;
    case TextureStyle::kTiles:
      return paintTiles(canvas, random), 0.10;
    case TextureStyle::kPrint:
      return paintPrint(canvas, random), 0.06;
    case TextureStyle::kClutter:
      return scatterLeaves(canvas, random, 2.0, 0.012, 0.4, 25, 230), 0.12;
    case TextureStyle::kBoards:
      return paintBoards(canvas, random), 0.13;
    case TextureStyle::kGround:
      return paintGround(canvas, random), 0.15;
    case TextureStyle::kClouds:
      return 0.12;
    default:
      break;
  }
  return 0.0;
}

bool isTextureSide(int n) { return n >= 4 && (n & (n - 1)) == 0; }

/// Twice as wide, periodic, through [1 3 3 1] / 4.
cv::Mat doubledWidth(const cv::Mat& image) {
  const int n = image.cols;
  cv::Mat wide(image.rows, 2 * n, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const float* const in = image.ptr<float>(y);
    float* const out = wide.ptr<float>(y);
    out[0] = 0.75F * in[0] + 0.25F * in[n - 1];
    for (int x = 0; x + 1 < n; ++x) {
      out[2 * x + 1] = 0.75F * in[x] + 0.25F * in[x + 1];
      out[2 * x + 2] = 0.25F * in[x] + 0.75F * in[x + 1];
    }
    out[2 * n - 1] = 0.75F * in[n - 1] + 0.25F * in[0];
  }
  return wide;
}

/// Adds white noise of variance 1, uniformly distributed: each octave has the same power. Four
/// numbers of 16 bits from each draw; all widths are multiples of four.
void addOctave(Random& random, cv::Mat& noise) {
  const float scale = 3.4641016F / 65536.0F;  // sqrt(12)
  for (int y = 0; y < noise.rows; ++y) {
    float* const row = noise.ptr<float>(y);
    for (int x = 0; x < noise.cols; x += 4) {
      const std::uint64_t bits = random.bits();
      for (int i = 0; i < 4; ++i) {
        row[x + i] += scale * (static_cast<float>(bits >> (16 * i) & 0xffff) - 32767.5F);
      }
    }
  }
}

}  // namespace

cv::Mat fractalNoise(Random& random, int width, int height, int finest) {
  const int coarsest = 4;
  cv::Mat noise = cv::Mat::zeros(coarsest, coarsest, CV_32FC1);
  while (true) {
    const int octave = std::max(width / noise.cols, height / noise.rows);
    if (noise.cols == coarsest || octave >= finest) addOctave(random, noise);
    if (noise.cols >= width && noise.rows >= height) break;
    if (noise.cols < width) noise = doubledWidth(noise);
    if (noise.rows < height) noise = doubledWidth(noise.t()).t();
  }
  double sum = 0.0, sum_of_squares = 0.0;
  for (int y = 0; y < noise.rows; ++y) {
    const float* const row = noise.ptr<float>(y);
    for (int x = 0; x < noise.cols; ++x) {
      sum += row[x];
      sum_of_squares += static_cast<double>(row[x]) * row[x];
    }
  }
  const double count = static_cast<double>(noise.total()), mean = sum / count;
  return (noise - mean) / std::sqrt(sum_of_squares / count - mean * mean);
}

Texture makeNaturalTexture(std::uint64_t seed, const std::string& stream,
                           const TextureOptions& options) {
  if (!isTextureSide(options.width) || !isTextureSide(options.height) ||
      !(options.texels_per_m > 0.0)) {
    throw InputError(
        "texture '" + stream + "': found " + std::to_string(options.width) + " x " +
        std::to_string(options.height) + " texels, " + std::to_string(options.texels_per_m) +
        " per metre; allowed: sides that are powers of two from 4 on, a positive density");
  }
  Random random(seed, "texture " + stream);
  if (isPlainStyle(options.style)) return Texture(paintPlainSurface(random, options));
  const int grey = greyBetween(random, 110, 165);
  // The sky is as bright on all sides.
  Canvas canvas(options, options.style == TextureStyle::kClouds ? 190 : grey);
  const double contrast = paint(canvas, random, options.style);
  const cv::Mat noise = fractalNoise(random, options.width, options.height);
  cv::Mat luminance;
  canvas.image().convertTo(luminance, CV_32FC1, 1.0 / 255.0);
  luminance = luminance.mul(1.0 + contrast * noise);
  return Texture(luminance);
}

}  // namespace vins::simulation
