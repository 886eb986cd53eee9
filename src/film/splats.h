// Splats: contributions of light paths to the pixels that see them ([Veach97 §10.3.4.1]).
//
// A splat of value v (radiance times pixels², see camera/camera.h) at film point p adds f(p - centre)·v to every pixel
// within the radius of the filter; a pixel is the mean of that over all light paths. Paths are traced in chunks, each
// into a list of its own. The lists are added to the film in the order of their paths, so that the order of summation
// in a pixel does not depend on the threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "film/sensor_response.h"
#include "math/compensated_sum.h"
#include "math/vec.h"

namespace lampyr {

struct Splat {
  Point2 film;  // pixels of the full image; may be beyond it by the filter radius
  Color value;
  uint32_t path = 0;  // index within the list
};

// The part of a splat in a layer.
struct SplatPart {
  Point2 film;
  Color value;
  uint32_t layer = 0;
};

// The splats of consecutive light paths. Clear keeps the memory.
class SplatList {
 public:
  // `reachMin`, `reachMax`: bounds of the film points that contribute to a pixel of the crop; other splats are not
  // stored. `sensor` is applied to every value.
  SplatList(const Point2& reachMin, const Point2& reachMax, const SensorResponse& sensor)
      : reachMin_(reachMin), reachMax_(reachMax), sensor_(sensor) {}

  // Splats added after this call are also added to the bands of their lanes: lane i to channel channels[i] of layer
  // layers[i], scaled by factors[i]; factor 0: none.
  struct Lanes {
    uint32_t layers[3] = {0, 0, 0};
    int channels[3] = {0, 0, 0};
    float factors[3] = {0, 0, 0};
  };
  void SetLanes(const Lanes& lanes) { lanes_ = lanes; }

  void Clear() {
    splats_.clear();
    parts_.clear();
    paths_ = 0;
  }
  // Splats added from now on belong to the next path.
  void StartPath() { ++paths_; }

  bool Reaches(const Point2& film) const {
    return film.x >= reachMin_.x && film.x < reachMax_.x && film.y >= reachMin_.y && film.y < reachMax_.y;
  }
  // False if the value is negative or not finite; it is then not added.
  bool Add(const Point2& film, const Color& value) {
    if (!Reaches(film)) return true;
    const Color scaled = value * sensor_.Scale(value);
    if (!scaled.IsValid()) return false;
    splats_.push_back({film, sensor_.Balance(scaled), paths_ - 1});
    if (lanes_) [[unlikely]]
      AddToBands(film, scaled);
    return true;
  }
  // Adds the part of a valid splat that is in a layer.
  void AddToLayer(const Point2& film, const Color& value, const Color& share, uint32_t layer) {
    if (Reaches(film)) parts_.push_back({film, sensor_.Balance(value * sensor_.Scale(value) * share), layer});
  }

  const std::vector<Splat>& Splats() const { return splats_; }
  // Parts of the splats in layers.
  const std::vector<SplatPart>& Parts() const { return parts_; }
  uint32_t Paths() const { return paths_; }

 private:
  void AddToBands(const Point2& film, const Color& value) {
    const float lanes[3] = {value.r, value.g, value.b};
    for (int i = 0; i < 3; ++i) {
      if (lanes_->factors[i] == 0 || lanes[i] == 0) continue;
      float channels[3] = {0, 0, 0};
      channels[lanes_->channels[i]] = lanes_->factors[i] * lanes[i];
      parts_.push_back({film, Color(channels[0], channels[1], channels[2]), lanes_->layers[i]});
    }
  }

  Point2 reachMin_, reachMax_;
  SensorResponse sensor_;
  std::optional<Lanes> lanes_;
  uint32_t paths_ = 0;
  std::vector<Splat> splats_;
  std::vector<SplatPart> parts_;
};

// Sums of one pixel over light paths. The contributions of one path are added before they are squared: together they
// are one sample of the pixel.
class SplatSums {
 public:
  void Add(uint64_t path, double weight, const Color& value) {
    if (path != path_) EndPath(path);
    latest_[0] += weight * static_cast<double>(value.r);
    latest_[1] += weight * static_cast<double>(value.g);
    latest_[2] += weight * static_cast<double>(value.b);
  }
  // Adds all paths of `other`; the two have no path in common.
  void Add(const SplatSums& other) {
    EndPath(0);
    SplatSums ended = other;
    ended.EndPath(0);
    sumOfFourths_ += ended.sumOfFourths_;
    for (int c = 0; c < 3; ++c) {
      sum_[c].Add(ended.sum_[c]);
      sumOfSquares_[c].Add(ended.sumOfSquares_[c]);
    }
  }
  bool IsFinite() const {
    bool isFinite = std::isfinite(sumOfFourths_);
    for (int c = 0; c < 3; ++c) {
      isFinite = isFinite && sum_[c].IsFinite() && sumOfSquares_[c].IsFinite() && std::isfinite(latest_[c]);
    }
    return isFinite;
  }
  double Sum(int channel) const { return sum_[channel].ValueWith(latest_[channel]); }
  double SumOfSquares(int channel) const {
    return sumOfSquares_[channel].ValueWith(latest_[channel] * latest_[channel]);
  }
  // Sum of the fourth powers of the luminances of the paths.
  double SumOfFourths() const {
    double luminance = 0;
    for (int c = 0; c < 3; ++c) luminance += Color::kLuminance[c] * latest_[c];
    return sumOfFourths_ + luminance * luminance * luminance * luminance;
  }

 private:
  void EndPath(uint64_t next) {
    sumOfFourths_ = SumOfFourths();
    for (int c = 0; c < 3; ++c) {
      sum_[c].Add(latest_[c]);
      sumOfSquares_[c].Add(latest_[c] * latest_[c]);
      latest_[c] = 0;
    }
    path_ = next;
  }

  CompensatedSum sum_[3];
  CompensatedSum sumOfSquares_[3];
  double sumOfFourths_ = 0;
  double latest_[3] = {0, 0, 0};  // of path_, not yet in the sums
  uint64_t path_ = 0;
};

}  // namespace lampyr
