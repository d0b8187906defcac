#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "pose_graph/loop/loop_detector.h"
#include "pose_graph/loop/loop_verifier.h"
#include "pose_graph/place/keyframe_view.h"
#include "pose_graph/place/place_model.h"

namespace vins::pose_graph {

/// What LoopFinder goes by.
struct LoopFinderOptions {
  ViewOptions view;
  LoopDetectorOptions detector;
  LoopVerifierOptions verifier;
  /// After an accepted loop nothing is verified for so long: loops that follow each other closely
  /// say the same, and the verification is the dearest step [s].
  double min_interval = 0.5;

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A candidate that was verified.
struct CheckedCandidate {
  double score = 0.0;  ///< bagScore()
  LoopVerification verification;
};

/// What was found of one keyframe, and how long it took.
struct LoopSearch {
  std::vector<CheckedCandidate> checked;  ///< in turn; only the last one may be accepted
  double describe_seconds = 0.0;          ///< for statistics only
  double query_seconds = 0.0;             ///< likewise
  double verify_seconds = 0.0;            ///< likewise

  /// The accepted loop, or null.
  const LoopVerification* accepted() const;
};

/// Remembers what keyframes have seen, and tells whether a new one shows an old one's place:
/// description, place recognition and verification in a row. Not for use by several threads at
/// once.
class LoopFinder {
 public:
  /// Throws InputError for bad options.
  LoopFinder(std::shared_ptr<const camera_model::Camera> camera, const PlaceModel& places,
             const LoopFinderOptions& options);

  /// Says whether a verified loop can be, by what else is known.
  using Gate = std::function<bool(const LoopVerification&)>;

  /// Looks for the keyframe's place and remembers it. Ids must rise. What `gate` refuses is
  /// LoopStatus::kAgainstOdometry, and the next candidate gets its turn. Throws InputError where
  /// the image (CV_8UC1) is not the camera's.
  LoopSearch addKeyframe(const Keyframe& keyframe, const cv::Mat& image, const Gate& gate = {});

  /// The same with a view that has been made already, as ViewDescriber makes it.
  LoopSearch addDescribed(const Keyframe& keyframe, DescribedView described, const Gate& gate = {});

  /// Remembers a view of a stored map without asking. Its features' nodes and words are found
  /// anew, by this vocabulary. Throws InputError where the id is known.
  void addStored(KeyframeView view);

  /// Forgets a keyframe; false where it is not known.
  bool remove(std::int64_t id);

  /// What is remembered of a keyframe, or null.
  const KeyframeView* view(std::int64_t id) const;

  std::size_t size() const { return views_.size(); }

  const PlaceModel& places() const { return places_; }

  /// Bytes of views and index, about; the vocabulary not counted.
  std::size_t memory() const { return view_bytes_ + detector_.database().memory(); }

 private:
  void remember(KeyframeView view);
  bool isTooSoon(const Keyframe& keyframe) const;
  void verify(const KeyframeView& query, const std::vector<LoopCandidate>& candidates,
              const Gate& gate, LoopSearch* search) const;

  struct LastLoop {
    std::uint32_t sequence;
    Stamp stamp;
  };

  std::shared_ptr<const camera_model::Camera> camera_;
  PlaceModel places_;
  LoopFinderOptions options_;
  ViewDescriber describer_;
  LoopDetector detector_;
  LoopVerifier verifier_;
  std::map<std::int64_t, KeyframeView> views_;
  std::size_t view_bytes_ = 0;
  std::optional<LastLoop> last_loop_;
};

}  // namespace vins::pose_graph
