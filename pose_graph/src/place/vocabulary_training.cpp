#include "pose_graph/place/vocabulary_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

using Descriptors = std::vector<BriefDescriptor>;

double uniform(std::mt19937_64* random) {
  return static_cast<double>((*random)() >> 11) * 0x1.0p-53;
}

/// Each bit as most of the descriptors have it; 0 where as many have either.
class Majority {
 public:
  void add(const BriefDescriptor& descriptor) {
    ++count_;
    for (int bit = 0; bit < kDescriptorBits; ++bit) {
      ones_[bit] += static_cast<std::uint32_t>((descriptor[bit / 64] >> (bit % 64)) & 1U);
    }
  }
  std::uint32_t count() const { return count_; }
  BriefDescriptor descriptor() const {
    BriefDescriptor result{};
    for (int bit = 0; bit < kDescriptorBits; ++bit) {
      const std::uint64_t is_one = 2 * ones_[bit] > count_ ? 1 : 0;
      result[bit / 64] |= is_one << (bit % 64);
    }
    return result;
  }

 private:
  std::uint32_t count_ = 0;
  std::array<std::uint32_t, kDescriptorBits> ones_{};
};

/// A node's share of the descriptors: a part of the list that the clustering sorts.
struct Range {
  std::size_t begin = 0, end = 0;
  int level = 0;
  std::size_t size() const { return end - begin; }
};

/// Grows the tree level by level.
class Trainer {
 public:
  Trainer(Descriptors descriptors, const VocabularyTrainingOptions& options)
      : options_(options), random_(options.seed), descriptors_(std::move(descriptors)) {}

  void grow(const std::function<void(double)>& progress) {
    std::vector<Range> ranges{{0, descriptors_.size(), 0}};
    nodes_.push_back({});
    std::size_t done = 0;
    for (std::size_t node = 0; node < ranges.size(); ++node) {
      const std::vector<Range> children = split(ranges[node]);
      child_counts_.push_back(static_cast<std::uint32_t>(children.size()));
      ranges.insert(ranges.end(), children.begin(), children.end());
      if (!children.empty()) continue;
      done += ranges[node].size();
      if (progress) progress(static_cast<double>(done) / static_cast<double>(descriptors_.size()));
    }
  }

  Vocabulary vocabulary(std::vector<float> weights) const {
    return {options_.branching, options_.levels, nodes_, child_counts_, std::move(weights)};
  }

  std::size_t wordCount() const {
    return static_cast<std::size_t>(std::count(child_counts_.begin(), child_counts_.end(), 0U));
  }

 private:
  std::vector<Range> split(const Range& range) {
    const auto fewest = static_cast<std::size_t>(options_.fewest_to_split);
    if (range.level == options_.levels || range.size() < fewest) return {};
    Descriptors centres = chooseSeeds(range);
    if (centres.size() < 2) return {};
    std::vector<std::size_t> labels(range.size(), 0);
    for (int i = 0; i < options_.iterations && assign(range, centres, &labels); ++i) {
      centres = medians(range, centres.size(), &labels);
    }
    assign(range, centres, &labels);
    return sortByLabel(range, centres, labels);
  }

  /// Descriptors far from each other: the next with a probability that rises as the squared
  /// distance to the nearest one before. Fewer where there are fewer different ones.
  Descriptors chooseSeeds(const Range& range) {
    const auto* from = &descriptors_[range.begin];
    Descriptors seeds{from[static_cast<std::size_t>(uniform(&random_) * range.size())]};
    std::vector<double> squares(range.size(), 1e9);
    while (seeds.size() < static_cast<std::size_t>(options_.branching)) {
      double sum = 0.0;
      for (std::size_t i = 0; i < range.size(); ++i) {
        const double distance = hammingDistance(from[i], seeds.back());
        squares[i] = std::min(squares[i], distance * distance);
        sum += squares[i];
      }
      if (sum == 0.0) break;
      double left = uniform(&random_) * sum;
      std::size_t chosen = 0;
      while (chosen + 1 < range.size() && (left -= squares[chosen]) >= 0.0) ++chosen;
      // Rounding may have led past the last one that differs.
      while (squares[chosen] == 0.0) chosen = (chosen + 1) % range.size();
      seeds.push_back(from[chosen]);
    }
    return seeds;
  }

  /// True where a descriptor has got another label.
  bool assign(const Range& range, const Descriptors& centres, std::vector<std::size_t>* labels) {
    bool changed = false;
    for (std::size_t i = 0; i < range.size(); ++i) {
      const std::size_t label =
          nearestDescriptor(descriptors_[range.begin + i], centres.data(), centres.size()).index;
      changed = changed || label != (*labels)[i];
      (*labels)[i] = label;
    }
    return changed;
  }

  /// Labels that nothing has are dropped.
  Descriptors medians(const Range& range, std::size_t count, std::vector<std::size_t>* labels) {
    std::vector<Majority> votes(count);
    for (std::size_t i = 0; i < range.size(); ++i) {
      votes[(*labels)[i]].add(descriptors_[range.begin + i]);
    }
    Descriptors centres;
    std::vector<std::size_t> new_labels(count);
    for (std::size_t label = 0; label < count; ++label) {
      new_labels[label] = centres.size();
      if (votes[label].count() > 0) centres.push_back(votes[label].descriptor());
    }
    for (std::size_t& label : *labels) label = new_labels[label];
    return centres;
  }

  std::vector<Range> sortByLabel(const Range& range, const Descriptors& centres,
                                 const std::vector<std::size_t>& labels) {
    std::vector<Range> children;
    Descriptors sorted;
    for (std::size_t label = 0; label < centres.size(); ++label) {
      const std::size_t begin = range.begin + sorted.size();
      for (std::size_t i = 0; i < range.size(); ++i) {
        if (labels[i] == label) sorted.push_back(descriptors_[range.begin + i]);
      }
      const std::size_t end = range.begin + sorted.size();
      if (end == begin) continue;
      children.push_back({begin, end, range.level + 1});
      nodes_.push_back(centres[label]);
    }
    std::copy(sorted.begin(), sorted.end(), descriptors_.begin() + range.begin);
    return children;
  }

  VocabularyTrainingOptions options_;
  std::mt19937_64 random_;
  Descriptors descriptors_;
  Descriptors nodes_;
  std::vector<std::uint32_t> child_counts_;
};

/// ln(images / images with the word), for each word.
std::vector<float> inverseDocumentFrequencies(
    const std::vector<std::vector<BriefDescriptor>>& images, std::size_t image_count,
    const Vocabulary& tree) {
  std::vector<std::uint32_t> counts(tree.wordCount(), 0), last_image(tree.wordCount(), 0);
  for (std::size_t image = 0; image < images.size(); ++image) {
    for (const BriefDescriptor& descriptor : images[image]) {
      const std::uint32_t word = tree.find(descriptor, 0).word;
      if (last_image[word] == image + 1) continue;
      last_image[word] = static_cast<std::uint32_t>(image + 1);
      ++counts[word];
    }
  }
  std::vector<float> weights;
  for (const std::uint32_t count : counts) {
    weights.push_back(static_cast<float>(
        std::log(static_cast<double>(image_count) / std::max<std::uint32_t>(1, count))));
  }
  return weights;
}

}  // namespace

void VocabularyTrainingOptions::validate() const {
  requireWithin("vocabulary training", "branching", branching, {2, 100});
  requireWithin("vocabulary training", "levels", levels, {1, 10});
  requireWithin("vocabulary training", "iterations", iterations, {1, 1000});
  requireWithin("vocabulary training", "fewest_to_split", fewest_to_split, {2, 1e6});
}

Vocabulary trainVocabulary(const std::vector<std::vector<BriefDescriptor>>& images,
                           const VocabularyTrainingOptions& options,
                           const std::function<void(double)>& progress) {
  options.validate();
  Descriptors descriptors;
  std::size_t image_count = 0;
  for (const auto& image : images) {
    descriptors.insert(descriptors.end(), image.begin(), image.end());
    image_count += image.empty() ? 0 : 1;
  }
  if (image_count < 2) {
    throw InputError("vocabulary training: found " + std::to_string(image_count) +
                     " images with descriptors; needed: 2 or more");
  }
  Trainer trainer(std::move(descriptors), options);
  trainer.grow(progress);
  if (trainer.wordCount() < 2) {
    throw InputError("vocabulary training: the descriptors are too few, or all alike");
  }
  const Vocabulary tree = trainer.vocabulary(std::vector<float>(trainer.wordCount(), 0.0F));
  return trainer.vocabulary(inverseDocumentFrequencies(images, image_count, tree));
}

}  // namespace vins::pose_graph
