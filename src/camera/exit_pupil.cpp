#include "camera/exit_pupil.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lampyr {

namespace {

constexpr int kRings = 64;
constexpr int kAcross = 32;  // cells of a grid over the bounds; half as many from y = 0 on
constexpr int kMostGrids = 40;
constexpr double kSettled = 0.6;    // the next grid would not cover much less than the last one
constexpr double kImproved = 1e-6;  // relative, by a finer grid; else no ray comes nearer
constexpr int kBisections = 20;

using Bounds = std::optional<PupilBounds>;

// What a grid of rays through `region` has met: the bounds of those that pass, with a cell around them; or else where
// a ray came nearest to passing.
struct Met {
  Bounds passed;
  double nearestX = 0, nearestY = 0;
  double least = std::numeric_limits<double>::infinity();  // clearance of the nearest
};

Met Look(const LensSystem& lens, double filmRadius, const PupilBounds& region) {
  const double cellX = (region.xMax - region.xMin) / kAcross, cellY = region.yMax / (kAcross / 2);
  Met met;
  for (int i = 0; i <= kAcross; ++i) {
    for (int k = 0; k <= kAcross / 2; ++k) {
      const double x = region.xMin + i * cellX, y = k * cellY;
      const Vector3d way(x - filmRadius, y, lens.RearZ());
      const double clearance = lens.Clearance({{filmRadius, 0, 0}, glm::normalize(way)});
      if (clearance <= 1) {
        PupilBounds& all = met.passed ? *met.passed : met.passed.emplace(PupilBounds{x, x, y});
        all = {std::min(all.xMin, x), std::max(all.xMax, x), std::max(all.yMax, y)};
      } else if (clearance < met.least) {
        met.least = clearance;
        met.nearestX = x;
        met.nearestY = y;
      }
    }
  }
  if (met.passed) {
    const PupilBounds& all = *met.passed;
    met.passed = PupilBounds{all.xMin - cellX, all.xMax + cellX, all.yMax + cellY};
  }
  return met;
}

// The bounds for a film point at `filmRadius`: a grid over all of the rear surface, then finer ones where rays pass, or
// nearly pass, which finds pupils of any size. The pupil is symmetric in y.
Bounds Find(const LensSystem& lens, double filmRadius) {
  const double reach = lens.RearReach(filmRadius);
  PupilBounds region{-reach, reach, reach};
  double least = std::numeric_limits<double>::infinity();
  for (int grid = 0; grid < kMostGrids; ++grid) {
    const Met met = Look(lens, filmRadius, region);
    if (met.passed) {
      const bool isSettled = met.passed->Area() > kSettled * region.Area();
      region = *met.passed;
      if (isSettled) return region;
      continue;
    }
    // The nearest of the grid before is one of this grid's points.
    if (!(met.least < (1 - kImproved) * least)) return std::nullopt;
    least = met.least;
    const double cellX = (region.xMax - region.xMin) / kAcross, cellY = region.yMax / (kAcross / 2);
    region = {met.nearestX - 3 * cellX, met.nearestX + 3 * cellX, met.nearestY + 3 * cellY};
  }
  return std::nullopt;
}

void Join(Bounds& all, const Bounds& more) {
  if (!more) return;
  all = all ? PupilBounds{std::min(all->xMin, more->xMin), std::max(all->xMax, more->xMax),
                          std::max(all->yMax, more->yMax)}
            : *more;
}

// The bounds at the last radius with light, between one with light and one without.
Bounds FindLast(const LensSystem& lens, double light, double dark) {
  Bounds last;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (light + dark);
    if (const Bounds found = Find(lens, middle)) {
      Join(last, found);
      light = middle;
    } else {
      dark = middle;
    }
  }
  return last;
}

PupilBounds Moved(const PupilBounds& bounds, double by) {
  return {bounds.xMin + by, bounds.xMax + by, bounds.yMax};
}

}  // namespace

// A small pupil moves over a ring by more than its size: the bounds move with it, and hold what is found at both ends
// of the ring and in its middle. A pupil that ends within a ring is followed to its end.
ExitPupil::ExitPupil(const LensSystem& lens, double filmRadius) : ringWidth_(filmRadius / kRings), rings_(kRings) {
  Bounds first = Find(lens, 0);
  for (size_t i = 0; i < rings_.size(); ++i) {
    const double inner = static_cast<double>(i) * ringWidth_, half = 0.5 * ringWidth_;
    const Bounds middle = Find(lens, inner + half), last = Find(lens, inner + ringWidth_);
    Ring& ring = rings_[i];
    ring.bounds = first;
    if (first && middle && last) {
      ring.shift = 0.5 * (last->xMin + last->xMax - first->xMin - first->xMax) / ringWidth_;
      Join(ring.bounds, Moved(*middle, -ring.shift * half));
      Join(ring.bounds, Moved(*last, -ring.shift * ringWidth_));
    } else {
      Join(ring.bounds, middle);
      Join(ring.bounds, last);
      if (first.has_value() != middle.has_value())
        Join(ring.bounds, first ? FindLast(lens, inner, inner + half) : FindLast(lens, inner + half, inner));
      if (middle.has_value() != last.has_value())
        Join(ring.bounds, middle ? FindLast(lens, inner + half, inner + ringWidth_)
                                 : FindLast(lens, inner + ringWidth_, inner + half));
    }
    first = last;
  }
}

std::optional<PupilBounds> ExitPupil::At(double radius) const {
  const size_t index = static_cast<size_t>(std::min(radius / ringWidth_, static_cast<double>(rings_.size() - 1)));
  const Ring& ring = rings_[index];
  if (!ring.bounds) return std::nullopt;
  return Moved(*ring.bounds, ring.shift * (radius - static_cast<double>(index) * ringWidth_));
}

}  // namespace lampyr
