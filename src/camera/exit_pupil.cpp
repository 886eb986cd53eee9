#include "camera/exit_pupil.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lampyr {

namespace {

constexpr int kRings = 64;
constexpr int kAcross = 32;  // grid cells over the bounds in x; half as many in y, from 0 on
constexpr int kMostGrids = 40;
constexpr double kSettled = 0.6;    // stop when the bounds have at least this part of the area of the last grid
constexpr double kImproved = 1e-6;  // relative improvement required of a finer grid
constexpr int kBisections = 20;

using Bounds = std::optional<PupilBounds>;

// Result of tracing a grid of rays through a region: the bounds of the rays that pass, enlarged by one cell, or else
// the point of the ray that came nearest to passing.
struct Met {
  Bounds passed;
  double nearestX = 0, nearestY = 0;
  double least = std::numeric_limits<double>::infinity();  // clearance of the nearest ray
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

// The bounds for a film point at `filmRadius`: a grid over the whole rear surface, then finer ones over the part where
// rays pass or nearly pass. Finds pupils of any size. The pupil is symmetric in y.
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
    // The nearest point of the previous grid is one of the points of this grid.
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

// Bounds over the radii between `light`, a radius with light, and `dark`, one without, by bisection.
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

// A small pupil may move by more than its size across a ring: the bounds move with it, and enclose what is found at
// both ends and in the middle of the ring. A pupil that ends within a ring is followed to its end.
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
