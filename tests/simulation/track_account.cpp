#include "simulation/track_account.h"

#include <algorithm>

namespace vins::simulation {

void TrackAccount::add(double time, const std::vector<std::int64_t>& ids) {
  Image image;
  image.time = time;
  for (const std::int64_t id : ids) {
    Track& track = tracks_.try_emplace(id, Track{time, 0}).first->second;
    ++track.images;
    image.tracks += 1.0;
    image.followed += track.images > 1 ? 1.0 : 0.0;
    image.ages += track.images;
  }
  images_.push_back(image);
}

TrackFigures TrackAccount::figures(double begin, double end) const {
  TrackFigures figures;
  const auto is_within = [&](double time) { return time >= begin && time < end; };
  double ages = 0.0;
  for (const Image& image : images_) {
    if (!is_within(image.time)) continue;
    ++figures.images;
    figures.tracks += image.tracks;
    figures.followed += image.followed;
    ages += image.ages;
  }
  double begun = 0.0;
  for (const auto& [id, track] : tracks_) {
    if (!is_within(track.begin)) continue;
    begun += 1.0;
    figures.life += track.images;
  }
  figures.life /= std::max(1.0, begun);
  figures.age = ages / std::max(1.0, figures.tracks);
  const double images = std::max(1.0, static_cast<double>(figures.images));
  figures.tracks /= images;
  figures.followed /= images;
  return figures;
}

}  // namespace vins::simulation
