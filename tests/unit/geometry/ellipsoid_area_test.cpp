// Carlson's R_G against the values that he printed, and the areas that are made from it against quadrature.
#include "geometry/mapped_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

namespace lampyr {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

TEST(EllipsoidArea, CarlsonsValues) {
  EXPECT_NEAR(CarlsonRG(0, 16, 16), kPiDouble, 1e-13);
  EXPECT_NEAR(CarlsonRG(2, 3, 4), 1.7255030280692, 1e-12);
  EXPECT_NEAR(CarlsonRG(0, 0.0796, 4), 1.0284758090288, 1e-12);
  EXPECT_NEAR(CarlsonRG(7, 7, 7), std::sqrt(7.0), 1e-13);
  EXPECT_NEAR(CarlsonRG(0, 0, 9), 1.5, 1e-13);  // the mean of 3 |cosθ|
  EXPECT_NEAR(CarlsonRG(1e-30, 1e-20, 1), 0.5, 1e-9);
}

TEST(EllipsoidArea, AgreesWithQuadrature) {
  for (const glm::dmat3& m :
       {glm::dmat3(2, 0, 0, 0, 0.5, 0, 0, 0, 1.3), glm::dmat3(1, 0.2, -0.3, 0.6, 1, 0.1, 0, -0.4, 1),
        glm::dmat3(10, 0, 0, 0, 0.1, 0, 0, 0, 1)}) {
    constexpr int n = 1000;
    double sphere = 0, circle = 0;
    for (int i = 0; i < n; ++i) {
      const double phi = 2 * kPiDouble * (i + 0.5) / n;
      circle += glm::length(m * glm::dvec3(std::cos(phi), std::sin(phi), 0)) / n;
      for (int j = 0; j < n; ++j) {
        const double z = 2 * (j + 0.5) / n - 1, r = std::sqrt(1 - z * z);
        sphere += glm::length(m * glm::dvec3(r * std::cos(phi), r * std::sin(phi), z)) / (n * n);
      }
    }
    EXPECT_NEAR(MeanStretchOverSphere(m), sphere, 1e-5 * sphere);
    EXPECT_NEAR(MeanStretchOverCircle(m), circle, 1e-9 * circle);
  }
}

}  // namespace
}  // namespace lampyr
