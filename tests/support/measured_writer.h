// Files of measured materials whose content is known: rough metals, tabulated as the RGL material database does it.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "materials/measured.h"
#include "materials/microfacet.h"

namespace lampyr::test {

struct MeasuredField {
  std::string name;
  std::vector<uint64_t> shape;
  std::vector<float> values;
};

inline std::string TensorFile(const std::vector<MeasuredField>& fields) {
  const auto put = [](std::string& text, const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  uint64_t offset = 18;
  for (const MeasuredField& field : fields) offset += 2 + field.name.size() + 11 + 8 * field.shape.size();
  std::string header("tensor_file\0\1\0", 14), data;
  put(header, static_cast<uint32_t>(fields.size()));
  for (const MeasuredField& field : fields) {
    put(header, static_cast<uint16_t>(field.name.size()));
    header += field.name;
    put(header, static_cast<uint16_t>(field.shape.size()));
    header += static_cast<char>(10);
    put(header, offset + data.size());
    for (const uint64_t extent : field.shape) put(header, extent);
    for (const float value : field.values) put(data, value);
  }
  return header + data;
}

struct MeasuredMetal {
  TrowbridgeReitz microfacets{0.4f, 0.4f};
  Color reflectance{0.9f, 0.7f, 0.5f};
  // Azimuths of incidence: one for isotropic metals; otherwise nodes over a turn, or over the part from `firstPhi` on.
  int phiCount = 1, symmetry = 1;
  double firstPhi = -3.14159265358979323846;
  int thetaCount = 16, side = 48;
  bool asSpectra = false;
};

// The fields of a file that tabulates single scattering at the microfacets, without Fresnel reflection.
inline std::vector<MeasuredField> MeasuredFieldsOf(const MeasuredMetal& metal) {
  constexpr double kPiExact = 3.14159265358979323846;
  const TrowbridgeReitz& microfacets = metal.microfacets;
  const auto sigma = [&](const Vector3& w) { return 0.5f * (w.z + microfacets.Stretch(w)); };
  const auto direction = [](double theta, double phi) {
    return Vector3(Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
  };
  const auto n = static_cast<uint64_t>(metal.side);
  // Direction of node (column, row) of a table over half vectors or directions.
  const auto nodeAt = [&](uint64_t column, uint64_t row, uint64_t columns, uint64_t rows, double turn) {
    const double u = static_cast<double>(column) / static_cast<double>(columns - 1);
    return direction(u * u * (0.5 * kPiExact),
                     (2 * static_cast<double>(row) / static_cast<double>(rows - 1) - 1) * kPiExact + turn);
  };

  MeasuredField theta{"theta_i", {static_cast<uint64_t>(metal.thetaCount)}, {}};
  for (int i = 0; i < metal.thetaCount; ++i)
    theta.values.push_back(static_cast<float>(0.4999 * kPiExact * i / (metal.thetaCount - 1)));
  MeasuredField phi{"phi_i", {static_cast<uint64_t>(metal.phiCount)}, {}};
  for (int i = 0; i < metal.phiCount; ++i) {
    const double part = metal.phiCount > 1 ? static_cast<double>(i) / (metal.phiCount - 1) : 0;
    phi.values.push_back(
        static_cast<float>(metal.phiCount > 1 ? metal.firstPhi + part * 2 * kPiExact / metal.symmetry : 0));
  }
  constexpr uint64_t kFine = 256;
  MeasuredField ndf{"ndf", {kFine, kFine}, {}}, projected{"sigma", {kFine, kFine}, {}};
  for (uint64_t row = 0; row < kFine; ++row) {
    for (uint64_t column = 0; column < kFine; ++column) {
      const Vector3 w = nodeAt(column, row, kFine, kFine, 0);
      ndf.values.push_back(microfacets.D(w));
      projected.values.push_back(sigma(w));
    }
  }
  const uint64_t tables = phi.shape[0] * theta.shape[0];
  MeasuredField vndf{"vndf", {phi.shape[0], theta.shape[0], n, n}, {}};
  MeasuredField luminance{"luminance", vndf.shape, std::vector<float>(tables * n * n, 1.0f)};
  const uint64_t channels = metal.asSpectra ? 6 : 3;
  MeasuredField color{metal.asSpectra ? "spectra" : "rgb", {phi.shape[0], theta.shape[0], channels, n, n}, {}};
  for (const float p : phi.values) {
    for (const float t : theta.values) {
      const Vector3 incident = direction(static_cast<double>(t), static_cast<double>(p));
      const double turn = metal.phiCount == 1 ? static_cast<double>(p) : 0;
      std::vector<float> table;
      for (uint64_t row = 0; row < n; ++row) {
        for (uint64_t column = 0; column < n; ++column) {
          const Vector3 m = nodeAt(column, row, n, n, turn);
          const double u = static_cast<double>(column) / static_cast<double>(n - 1);
          const double jacobian = 2 * kPiExact * kPiExact * u * std::sin(u * u * (0.5 * kPiExact));
          table.push_back(static_cast<float>(
              static_cast<double>(microfacets.D(m) * std::max(glm::dot(m, incident), 0.0f)) * jacobian));
        }
      }
      vndf.values.insert(vndf.values.end(), table.begin(), table.end());
      const MeasuredWarp warp(table, n, n);
      TableBlend blend;
      blend.count = 1;
      blend.weight[0] = 1;
      std::vector<float> shadowing;
      for (uint64_t row = 0; row < n; ++row) {
        for (uint64_t column = 0; column < n; ++column) {
          const Point2d node(static_cast<double>(column) / static_cast<double>(n - 1),
                             static_cast<double>(row) / static_cast<double>(n - 1));
          const Point2d place = warp.Sample(blend, node);
          const Vector3 m = direction(place.x * place.x * (0.5 * kPiExact), (2 * place.y - 1) * kPiExact + turn);
          const Vector3 out = Reflect(incident, m, glm::dot(incident, m));
          const float ratio = out.z > 0 ? TrowbridgeReitz::ShadowingRatio(incident.z, microfacets.Stretch(incident),
                                                                          out.z, microfacets.Stretch(out))
                                        : 0.0f;
          shadowing.push_back(std::max(ratio, 0.0f));
        }
      }
      for (uint64_t c = 0; c < channels; ++c) {
        const float scale = metal.asSpectra ? metal.reflectance.g
                            : c == 0        ? metal.reflectance.r
                            : c == 1        ? metal.reflectance.g
                                            : metal.reflectance.b;
        for (const float ratio : shadowing) color.values.push_back(scale * ratio);
      }
    }
  }
  std::vector<MeasuredField> fields = {theta, phi, ndf, projected, vndf, luminance, color};
  if (metal.asSpectra) fields.push_back({"wavelengths", {6}, {360, 450, 520, 600, 700, 1000}});
  return fields;
}

}  // namespace lampyr::test
