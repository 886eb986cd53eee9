#include "lights/types/portal_tables.h"

#include "base/parallel.h"

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;
// Weight of a cell: 0.9 of its mean radiance plus a tenth of the largest radiance around it, but at least a hundredth
// of the sky's mean. The table is coarser than the image or divides its texels differently, and must be high wherever
// the image is.
constexpr float kLargestShare = 0.1f, kFloorShare = 0.01f;
// Smallest share of a window: below it, differences of sums in double lose their digits.
constexpr double kSmallestShare = 1e-9;

struct Cells {
  int size = 0;
  std::vector<float> mean, largest;
  std::vector<Color> color;
};

// Radiance sampled on a grid of `steps` × `steps` points in each cell.
Cells LookAround(const PortalPlace& place, const PortalTables::Radiance& radiance, int size, int steps) {
  Cells cells;
  cells.size = size;
  const size_t count = static_cast<size_t>(size) * static_cast<size_t>(size);
  cells.mean.resize(count);
  cells.largest.resize(count);
  cells.color.resize(count);
  std::vector<float> tangents(static_cast<size_t>(size * steps));
  for (size_t i = 0; i < tangents.size(); ++i) {
    tangents[i] = static_cast<float>(
        std::tan(kPiDouble * ((static_cast<double>(i) + 0.5) / static_cast<double>(tangents.size()) - 0.5)));
  }
  const Vector3 x(place.axisX), y(place.axisY), z(place.outward);
  ParallelFor(size, HardwareThreads(), [&](int row) {
    for (int column = 0; column < size; ++column) {
      Color sum;
      float largest = 0;
      for (int i = 0; i < steps * steps; ++i) {
        const float tx = tangents[static_cast<size_t>(column * steps + i % steps)];
        const float ty = tangents[static_cast<size_t>(row * steps + i / steps)];
        const Color seen = radiance(glm::normalize(tx * x + ty * y + z));
        sum += seen;
        largest = std::max(largest, seen.Average());
      }
      const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(size) + static_cast<size_t>(column);
      cells.color[cell] = sum * (1 / static_cast<float>(steps * steps));
      cells.mean[cell] = cells.color[cell].Average();
      cells.largest[cell] = largest;
    }
  });
  return cells;
}

float LargestAround(const Cells& cells, int column, int row) {
  float largest = 0;
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, cells.size - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, cells.size - 1); ++x) {
      largest = std::max(
          largest, cells.largest[static_cast<size_t>(y) * static_cast<size_t>(cells.size) + static_cast<size_t>(x)]);
    }
  }
  return largest;
}

}  // namespace

PortalTables::PortalTables(const PortalPlace& place, const Radiance& radiance, float mean, int height) {
  const int size = std::clamp(height, 64, 1024);
  const Cells cells = LookAround(place, radiance, size, size <= 256 ? 4 : std::max(2, height / size));
  std::vector<float> direct(cells.mean.size()), emission(cells.mean.size());
  double flux[3] = {0, 0, 0};
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(size) + static_cast<size_t>(column);
      const float seen =
          std::max((1 - kLargestShare) * cells.mean[cell] + kLargestShare * LargestAround(cells, column, row),
                   kFloorShare * mean);
      const Vector3d middle = FromSquare({(column + 0.5) / size, (row + 0.5) / size});
      const double solidAngle = SolidAngleFactor(middle.x, middle.y) / (static_cast<double>(size) * size);
      const double cosine = middle.z / glm::length(middle);
      direct[cell] = static_cast<float>(static_cast<double>(seen / mean) * solidAngle);
      emission[cell] = static_cast<float>(static_cast<double>(direct[cell]) * cosine);
      flux[0] += static_cast<double>(cells.color[cell].r) * solidAngle * cosine;
      flux[1] += static_cast<double>(cells.color[cell].g) * solidAngle * cosine;
      flux[2] += static_cast<double>(cells.color[cell].b) * solidAngle * cosine;
    }
  }
  direct_ = WindowedTable(direct, size, size);
  emission_ = Distribution2D(emission, size, size);
  flux_ = {static_cast<float>(flux[0]), static_cast<float>(flux[1]), static_cast<float>(flux[2])};
}

Vector3d PortalTables::FromSquare(const Point2d& uv) {
  // Clamped short of the square's edges, where the tangent is infinite.
  const auto tangent = [](double t) { return std::tan(kPiDouble * (std::clamp(t, 1e-12, 1 - 1e-12) - 0.5)); };
  return {tangent(uv.x), tangent(uv.y), 1};
}

Point2d PortalTables::ToSquare(const Vector3d& inAxes) {
  return {0.5 + std::atan2(inAxes.x, inAxes.z) / kPiDouble, 0.5 + std::atan2(inAxes.y, inAxes.z) / kPiDouble};
}

double PortalTables::SolidAngleFactor(double x, double y) {
  const double squared = 1 + x * x + y * y;
  return kPiDouble * kPiDouble * (1 + x * x) * (1 + y * y) / (squared * std::sqrt(squared));
}

PortalTables::Seen PortalTables::SeenFrom(const PortalView& view) const {
  const Vector3d low = ToAxes(view.place, view.toCorner);
  const Vector3d high = ToAxes(view.place, view.toCorner + view.place.shape.edgeX + view.place.shape.edgeY);
  const Point2d from = ToSquare(low), to = ToSquare(high);
  Seen seen;
  seen.window = {std::max(from.x, 0.0), std::min(to.x, 1.0), std::max(from.y, 0.0), std::min(to.y, 1.0)};
  seen.share = direct_.Integral(seen.window);
  if (!(seen.share >= kSmallestShare)) seen.share = 0;
  return seen;
}

PdfSolidAngle PortalTables::Density(const Seen& seen, const Vector3d& inAxes) const {
  const double factor = SolidAngleFactor(inAxes.x / inAxes.z, inAxes.y / inAxes.z);
  const double density = direct_.Density(ToSquare(inAxes)) / (seen.share * factor);
  return PdfSolidAngle(density < 3e38 ? static_cast<float>(density) : 0.0f);
}

PdfSolidAngle PortalTables::EmissionDensity(const Vector3d& inAxes) const {
  if (!(inAxes.z > 0)) return PdfSolidAngle(0);
  const double factor = SolidAngleFactor(inAxes.x / inAxes.z, inAxes.y / inAxes.z);
  const double density = static_cast<double>(emission_.Density(Point2(ToSquare(inAxes)))) / factor;
  return PdfSolidAngle(density < 3e38 ? static_cast<float>(density) : 0.0f);
}

}  // namespace lampyr
