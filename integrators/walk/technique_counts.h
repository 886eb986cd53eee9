// Sample counts of the techniques of a bidirectional integrator: light paths, connections, merging ([Grittmann22]). A
// technique that is used n times for each camera path counts n times in all weights, and each use contributes 1/n.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr {

// A probability by place on the film, interpolated between the centres of the cells of a grid.
class FilmMask {
 public:
  // 1 everywhere.
  FilmMask() = default;
  // `film`: size of the film, pixels; `values`: width · height of them, row by row, in [0,1].
  FilmMask(int width, int height, const Point2& film, std::vector<float> values);

  float At(const Point2& film) const { return values_.empty() ? 1.0f : Interpolate(film); }
  // 1: everywhere.
  double Mean() const;
  // The values of all cells; none if it is 1 everywhere.
  const std::vector<float>& Values() const { return values_; }

 private:
  float Interpolate(const Point2& film) const;

  int width_ = 0, height_ = 0;
  Vector2 cellsPerPixel_{0.0f};
  std::vector<float> values_;
};

// The techniques of an integrator that have counts (IntegratorType::counted).
struct CountedTechniques {
  bool lightPaths = false, connections = false, merging = false;
};

// Counts of an integrator's techniques, at a place on the film or on average; 0 for techniques that it does not have.
struct UsedCounts {
  double lightPaths = 0;  // for each camera path
  double connecting = 0;  // probability that a camera path is connected to the light path of its sample
  double merging = 0;     // probability that a camera path is merged with photons
  // Probability that a camera path continues beyond its first vertex where photons can be merged.
  double continuing = 1;
  int lightSamples = 1;  // the most lights that are chosen at a vertex
};

struct TechniqueCounts {
  // Light paths for each camera path, as a power of two: -3 … 2. Of fewer than one, every pixel has one in
  // 1/LightPaths() of its samples.
  int log2LightPaths = 0;
  // Probabilities with which the vertices of a camera path are connected to a light path, if the sample has one, and
  // merged with photons.
  FilmMask connecting, merging;
  // Probabilities with which a camera path continues beyond the first vertex at which photons can be merged; above 0.
  // Light paths find most of what lies beyond, and a shorter camera path costs less.
  FilmMask continuing{};
  // Merging starts with discs of twice the radius, four times the area, which shrink to the usual ones
  // (photon/photon_pass.h): as many more merges as of that many more light paths, and a wider blur, for a time.
  bool startsWide = false;
  // The most lights that are chosen at a vertex for next-event estimation.
  int lightSamples = 1;

  bool HasMasks() const {
    return !connecting.Values().empty() || !merging.Values().empty() || !continuing.Values().empty();
  }
  bool IsDefault() const { return log2LightPaths == 0 && !HasMasks() && !startsWide && lightSamples == 1; }
  // "vcm, a light path for 4 camera paths, merging in 30 % of the picture".
  std::string Describe(const std::string& integrator) const;
  UsedCounts At(const Point2& film, const CountedTechniques& techniques) const;
  // On average over the film.
  UsedCounts Mean(const CountedTechniques& techniques) const;
  // Hash of all counts, the same on all machines.
  std::string Fingerprint() const;
  double LightPaths() const { return log2LightPaths < 0 ? 1.0 / (1 << -log2LightPaths) : 1 << log2LightPaths; }
  // Connections of a camera path to each light path, on average: of several light paths one is connected.
  double ConnectionsPerLightPath(const Point2& film) const {
    return static_cast<double>(connecting.At(film)) / std::max(1.0, LightPaths());
  }
};

}  // namespace lampyr
