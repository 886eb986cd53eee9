#include "suite/direction_quadrature.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "suite/statistics.h"

namespace lampyr::suite {

namespace {

constexpr double kTwoPi = 2 * 3.14159265358979323846;

// Two unit vectors that complete the axis to an orthonormal frame.
struct Around {
  Vector3d x, y;
  explicit Around(const Vector3d& axis) {
    const Vector3d helper = std::abs(axis.x) < 0.7 ? Vector3d(1, 0, 0) : Vector3d(0, 1, 0);
    x = glm::normalize(glm::cross(helper, axis));
    y = glm::cross(axis, x);
  }
};

}  // namespace

double Cap::SolidAngle() const {
  return kTwoPi * wMax;
}

Vector3d Cap::Direction(double w, double turns) const {
  const Around frame(axis);
  const double r = std::sqrt(std::max(w * (2 - w), 0.0)), phi = kTwoPi * turns;
  return frame.x * (r * std::cos(phi)) + frame.y * (r * std::sin(phi)) + axis * (1 - w);
}

Point2d Cap::Invert(const Vector3d& direction) const {
  const Around frame(axis);
  const Vector3d chord = direction - axis;
  const double turns = std::atan2(glm::dot(direction, frame.y), glm::dot(direction, frame.x)) / kTwoPi;
  return {0.5 * glm::dot(chord, chord) / wMax, turns < 0 ? turns + 1 : turns};
}

Cap CapAround(std::span<const Vector3d> directions) {
  Vector3d sum(0.0);
  for (const Vector3d& d : directions) sum += d;
  Cap cap;
  if (!(glm::length(sum) > 0)) return cap;
  cap.axis = glm::normalize(sum);
  double widest = 0;
  for (const Vector3d& d : directions) {
    const Vector3d chord = d - cap.axis;
    widest = std::max(widest, 0.5 * glm::dot(chord, chord));
  }
  // The widest of a few hundred directions excludes some thousandths of a soft edge, so the cap is twice as wide. The
  // remainder is smaller than the tests can detect.
  cap.wMax = widest < 0.5 ? std::max(2 * widest, 1e-14) : 2.0;
  // Bright directions are kept away from the poles, around which small features map to slivers of the square.
  if (cap.IsSphere()) cap.axis = Around(cap.axis).x;
  return cap;
}

DirectionQuadrature::DirectionQuadrature(const Cap& cap, std::span<const Vector3d> hints, const Function& function,
                                         Rng& rng, int budget) {
  const auto add = [&](const Cap& part) {
    std::vector<Point2d> inside;
    for (const Vector3d& hint : hints) {
      const Point2d p = part.Invert(hint);
      if (p.x < 1) inside.push_back(p);
    }
    parts_.push_back(
        {part, AdaptiveSquare(
                   part.SolidAngle(), inside,
                   [&](double x, double y) { return function(part.Direction(part.wMax * x, y)); }, rng, budget)});
  };
  add(cap);
  if (!cap.IsSphere()) add({-cap.axis, 2 - cap.wMax});
}

Estimate DirectionQuadrature::Density() const {
  Estimate sum;
  for (const Part& part : parts_) sum = sum + part.square.Density();
  return sum;
}

Estimate DirectionQuadrature::Radiance() const {
  Estimate sum;
  for (const Part& part : parts_) sum = sum + part.square.Radiance();
  return sum;
}

// Fraction of the draws that rounding may carry over the edge of the lit region, into a cell where none are expected.
static constexpr double kRoundings = 5e-5;

double DirectionQuadrature::Test(std::span<const Vector3d> directions, double draws, int cells, std::string* worst) {
  std::vector<double> observed, expected, errors;
  std::vector<size_t> first;
  for (Part& part : parts_) {
    first.push_back(expected.size());
    part.square.MakeCells(cells);
    for (const Estimate& cell : part.square.Cells()) {
      expected.push_back(draws * cell.value);
      errors.push_back(draws * (cell.error + kRoundings));
    }
  }
  observed.resize(expected.size(), 0.0);
  std::vector<Vector3d> middles(expected.size(), Vector3d(0.0));
  for (const Vector3d& direction : directions) {
    const size_t which = PartOf(direction);
    const Point2d p = parts_[which].cap.Invert(direction);
    const size_t cell = first[which] + parts_[which].square.CellOf(p.x, p.y);
    ++observed[cell];
    middles[cell] += direction;
  }
  if (worst) {
    size_t at = 0;
    double most = -1;
    for (size_t i = 0; i < observed.size(); ++i) {
      const double excess = std::abs(observed[i] - expected[i]) / std::sqrt(expected[i] + errors[i] * errors[i] + 1);
      if (excess > most) {
        most = excess;
        at = i;
      }
    }
    const auto which = static_cast<size_t>(std::upper_bound(first.begin(), first.end(), at) - first.begin()) - 1;
    const Part& part = parts_[which];
    const Point2d ofCell = part.square.MiddleOf(at - first[which]);
    const Vector3d middle =
        observed[at] > 0 ? middles[at] / observed[at] : part.cap.Direction(part.cap.wMax * ofCell.x, ofCell.y);
    char text[200];
    std::snprintf(text, sizeof(text), "of %.0f draws %.0f went around the direction %.3f %.3f %.3f; expected %.1f",
                  draws, observed[at], middle.x, middle.y, middle.z, expected[at]);
    *worst = text;
  }
  const Estimate total = Density();
  observed.push_back(draws - static_cast<double>(directions.size()));
  expected.push_back(draws * std::max(1 - total.value, 0.0));
  errors.push_back(draws * (total.error + 1e-3));
  return ChiSquaredTest(observed, expected, errors);
}

std::vector<Estimate> DirectionQuadrature::Integrate(size_t count, const Functions& f, Rng& rng) const {
  std::vector<Estimate> sums(count);
  for (const Part& part : parts_) {
    const std::vector<Estimate> of = part.square.Integrate(
        count,
        [&](double x, double y, std::span<double> values) { f(part.cap.Direction(part.cap.wMax * x, y), values); },
        rng);
    for (size_t i = 0; i < count; ++i) sums[i] = sums[i] + of[i];
  }
  return sums;
}

}  // namespace lampyr::suite
