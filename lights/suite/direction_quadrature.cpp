#include "lights/suite/direction_quadrature.h"

#include <algorithm>
#include <cmath>

#include "lights/suite/statistics.h"

namespace lampyr::suite {

namespace {

constexpr double kTwoPi = 2 * 3.14159265358979323846;

// A frame around the axis.
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
  cap.wMax = widest < 0.5 ? std::max(1.02 * widest, 1e-14) : 2.0;
  // What is bright is kept away from the poles: around them, small things are slivers of the square.
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

double DirectionQuadrature::Test(std::span<const Vector3d> directions, double draws) {
  std::vector<double> observed, expected, errors;
  std::vector<size_t> first;
  for (Part& part : parts_) {
    first.push_back(expected.size());
    part.square.MakeCells(48);
    for (const Estimate& cell : part.square.Cells()) {
      expected.push_back(draws * cell.value);
      errors.push_back(draws * cell.error);
    }
  }
  observed.resize(expected.size(), 0.0);
  for (const Vector3d& direction : directions) {
    const size_t which = parts_.size() > 1 && parts_[0].cap.Invert(direction).x >= 1 ? 1 : 0;
    const Point2d p = parts_[which].cap.Invert(direction);
    ++observed[first[which] + parts_[which].square.CellOf(p.x, p.y)];
  }
  const Estimate total = Density();
  observed.push_back(draws - static_cast<double>(directions.size()));
  expected.push_back(draws * std::max(1 - total.value, 0.0));
  errors.push_back(draws * (total.error + 1e-3));
  return ChiSquaredTest(observed, expected, errors);
}

}  // namespace lampyr::suite
