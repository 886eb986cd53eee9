// Areas under maps from the distribution of normals, against closed forms.
#include "geometry/mapped_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

namespace lampyr {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

const glm::dmat3 kMaps[] = {glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, 1), glm::dmat3(3, 0, 0, 0, 1, 0, 0, 0, 1),
                            glm::dmat3(1, 0.2, -0.3, 0.6, 1, 0.1, 0, -0.4, 1), glm::dmat3(2, 0, 0, 0, -1, 0, 0, 0, 0.7),
                            1e6 * glm::dmat3(1, 0.5, 0, 0, 1, 0, 0, 0, 2)};

// |cof(m) n| by way of what m does to the plane across n.
double Stretch(const glm::dmat3& m, const glm::dvec3& n) {
  const glm::dvec3 other = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(n, other)), b = glm::cross(n, a);
  return glm::length(glm::cross(m * a, m * b));
}

TEST(MappedArea, FlatFacesAreExact) {
  MappedArea area;
  area.Add(2, {1, 0, 0});
  area.Add(3, {0, 0.6, 0.8});
  area.Add(1, {-1, 0, 0});  // the other side of the first
  area.Add(5, {0, 0, 0});   // nothing is known of it
  area.Finish();
  for (const glm::dmat3& m : kMaps) {
    const double expected = 3 * Stretch(m, {1, 0, 0}) + 3 * Stretch(m, {0, 0.6, 0.8});
    EXPECT_NEAR(area.Under(m), expected, 1e-6 * expected);
  }
}

TEST(MappedArea, SpheresWithinAThousandth) {
  MappedArea area;
  constexpr int n = 400;
  for (int i = 0; i < n * n; ++i) {
    const double z = 2 * (i % n + 0.5) / n - 1, phi = 2 * kPiDouble * (i / n + 0.5) / n, r = std::sqrt(1 - z * z);
    area.Add(4 * kPiDouble / (n * n), {r * std::cos(phi), r * std::sin(phi), z});
  }
  area.Finish();
  for (const glm::dmat3& m : kMaps) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const double expected = 4 * kPiDouble * MeanStretchOverSphere(cofactors);
    EXPECT_NEAR(area.Under(m), expected, 1e-3 * expected);
  }
}

TEST(MappedArea, NothingHasNoArea) {
  MappedArea area;
  area.Finish();
  EXPECT_EQ(area.Under(glm::dmat3(1.0)), 0);
}

}  // namespace
}  // namespace lampyr
