#include "geometry/mapped_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace lampyr {

namespace {

// Resolution of half a cube of directions: n and -n are the same.
constexpr int kSide = 12;
constexpr int kCells = 3 * kSide * kSide;

size_t CellOf(const Vector3d& n) {
  const Vector3d size = Abs(n);
  const int face = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  // Approximately equal angles.
  const auto along = [&](int axis) {
    const double turned = std::atan(n[axis] / n[face]) * (4 / 3.14159265358979323846);
    return std::clamp(static_cast<int>((turned + 1) * (0.5 * kSide)), 0, kSide - 1);
  };
  return static_cast<size_t>((face * kSide + along((face + 1) % 3)) * kSide + along((face + 2) % 3));
}

}  // namespace

void MappedArea::Add(double area, const Vector3d& normal) {
  if (!(area > 0) || !(glm::dot(normal, normal) > 0)) return;
  if (cells_.empty()) cells_.resize(kCells);
  Cell& cell = cells_[CellOf(normal)];
  cell.area += static_cast<float>(area);
  for (int i = 0; i < 3; ++i) {
    cell.squares[i] += static_cast<float>(area * normal[i] * normal[i]);
    cell.products[i] += static_cast<float>(area * normal[(i + 1) % 3] * normal[(i + 2) % 3]);
  }
}

void MappedArea::Finish() {
  std::erase_if(cells_, [](const Cell& cell) { return !(cell.area > 0); });
  cells_.shrink_to_fit();
}

double MappedArea::Under(const glm::dmat3& linear) const {
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const Vector3d squares(glm::dot(cofactors[0], cofactors[0]), glm::dot(cofactors[1], cofactors[1]),
                         glm::dot(cofactors[2], cofactors[2]));
  const Vector3d products = 2.0 * Vector3d(glm::dot(cofactors[1], cofactors[2]), glm::dot(cofactors[2], cofactors[0]),
                                           glm::dot(cofactors[0], cofactors[1]));
  double sum = 0;
  for (const Cell& cell : cells_) {
    double stretched = 0;
    for (int i = 0; i < 3; ++i) {
      stretched +=
          squares[i] * static_cast<double>(cell.squares[i]) + products[i] * static_cast<double>(cell.products[i]);
    }
    sum += std::sqrt(std::max(stretched * static_cast<double>(cell.area), 0.0));
  }
  return sum;
}

namespace {

// The series after the duplications is truncated where its terms fall below the sixth power of this.
constexpr double kNear = 2e-3;

// R_F and R_D together: both use the same duplications.
void CarlsonRFAndRD(double x, double y, double z, double& rf, double& rd) {
  double sum = 0, power = 1;
  for (int i = 0; i < 100; ++i) {
    const double mean = (x + y + z) / 3;
    if (std::max({std::abs(x - mean), std::abs(y - mean), std::abs(z - mean)}) < kNear * mean) break;
    const double a = std::sqrt(x), b = std::sqrt(y), c = std::sqrt(z), lambda = a * b + b * c + c * a;
    sum += power / (c * (z + lambda));
    power *= 0.25;
    x = 0.25 * (x + lambda), y = 0.25 * (y + lambda), z = 0.25 * (z + lambda);
  }
  const double mean = (x + y + z) / 3;
  const double X = 1 - x / mean, Y = 1 - y / mean, Z = -X - Y;
  const double e2 = X * Y - Z * Z, e3 = X * Y * Z;
  rf = (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
  const double five = (x + y + 3 * z) / 5;
  const double p = 1 - x / five, q = 1 - y / five, s = -(p + q) / 3, pq = p * q, ss = s * s;
  const double f2 = pq - 6 * ss, f3 = (3 * pq - 8 * ss) * s, f4 = 3 * (pq - ss) * ss, f5 = pq * ss * s;
  rd = power / (five * std::sqrt(five)) *
           (1 - 3 * f2 / 14 + f3 / 6 + 9 * f2 * f2 / 88 - 3 * f4 / 22 - 9 * f2 * f3 / 52 + 3 * f5 / 26) +
       3 * sum;
}

// Eigenvalues of a symmetric matrix, clamped to 0 ([Smith61]).
std::array<double, 3> Eigenvalues(const glm::dmat3& g) {
  const double mean = (g[0][0] + g[1][1] + g[2][2]) / 3;
  const double off = g[0][1] * g[0][1] + g[0][2] * g[0][2] + g[1][2] * g[1][2];
  const double dx = g[0][0] - mean, dy = g[1][1] - mean, dz = g[2][2] - mean;
  const double p = std::sqrt((dx * dx + dy * dy + dz * dz + 2 * off) / 6);
  if (!(p > 0)) return {mean, mean, mean};
  glm::dmat3 b = g;
  for (int i = 0; i < 3; ++i) b[i][i] -= mean;
  const double r = std::clamp(0.5 * glm::determinant(b / p), -1.0, 1.0);
  const double phi = std::acos(r) / 3, third = 2.0943951023931954923;
  const double high = mean + 2 * p * std::cos(phi), low = mean + 2 * p * std::cos(phi + third);
  return {std::max(high, 0.0), std::max(3 * mean - high - low, 0.0), std::max(low, 0.0)};
}

}  // namespace

double CarlsonRG(double x, double y, double z) {
  // With the middle one as z no term is negative.
  double v[3] = {x, y, z};
  std::sort(v, v + 3);
  if (!(v[1] > 0)) return 0.5 * std::sqrt(v[2]);
  const double scale = v[2];
  const double low = v[0] / scale, middle = v[1] / scale;
  double rf = 0, rd = 0;
  CarlsonRFAndRD(low, 1, middle, rf, rd);
  const double twice = middle * rf - (low - middle) * (1 - middle) * rd / 3 + std::sqrt(low / middle);
  return 0.5 * std::sqrt(scale) * twice;
}

double MeanStretchOverSphere(const glm::dmat3& m) {
  const auto lambda = Eigenvalues(glm::transpose(m) * m);
  return CarlsonRG(lambda[0], lambda[1], lambda[2]);
}

double MeanStretchOverCircle(const glm::dmat3& m) {
  const double a = glm::dot(m[0], m[0]), b = glm::dot(m[0], m[1]), c = glm::dot(m[1], m[1]);
  const double mean = 0.5 * (a + c), spread = std::hypot(0.5 * (a - c), b), high = mean + spread;
  // The product of both eigenvalues is the determinant, which avoids the cancellation of their difference.
  const double low = high > 0 ? std::max(a * c - b * b, 0.0) / high : 0.0;
  // R_G(0, x, y) is half the quarter circle's integral of sqrt(x cos² + y sin²).
  return 4 * 0.31830988618379067154 * CarlsonRG(0, high, low);
}

}  // namespace lampyr
