// Participating media whose light is known: scene text, renders by every integrator, and the verdict.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "support/replicas.h"

namespace lampyr::test {

using Radiance = std::array<double, 3>;

inline std::string Rgb(const std::string& name, const Radiance& value) {
  return " \"rgb " + name + "\" [" + std::to_string(value[0]) + " " + std::to_string(value[1]) + " " +
         std::to_string(value[2]) + "]";
}
inline Radiance Grey(double value) {
  return {value, value, value};
}

inline std::string Homogeneous(const std::string& name, const Radiance& scattering, const Radiance& absorption,
                               double g = 0, const std::string& more = "") {
  return "MakeNamedMedium \"" + name + "\" \"string type\" \"homogeneous\"" + Rgb("sigma_s", scattering) +
         Rgb("sigma_a", absorption) + " \"float g\" " + std::to_string(g) + " " + more + "\n";
}

// A parallel camera at the origin that looks along z.
inline std::string ParallelView(int depth, const std::string& window = "-.5 .5 -.5 .5",
                                const std::string& lookAt = "0 0 0  0 0 1") {
  return "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nPixelFilter \"box\"\nLookAt " + lookAt +
         "  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [" + window +
         "]\nIntegrator \"path\" \"integer maxdepth\" " + std::to_string(depth) + "\nWorldBegin\n";
}

// A box without a surface of its own, full of `medium`.
inline std::string BoxOf(const std::string& medium, const Vector3d& low, const Vector3d& high) {
  std::string points;
  for (const double z : {low.z, high.z}) {
    const double corners[4][2] = {{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}};
    for (const auto& corner : corners)
      points += std::to_string(corner[0]) + " " + std::to_string(corner[1]) + " " + std::to_string(z) + "  ";
  }
  return "AttributeBegin Material \"interface\" MediumInterface \"" + medium +
         "\" \"\" Shape \"trianglemesh\" \"point3 P\" [" + points +
         "] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  0 7 3 0 4 7  1 2 6 1 6 5] "
         "AttributeEnd\n";
}

// 6 × 6 × 6 voxels of a box [-1,1]³; those at the sides, where the interpolation falls off, are empty (`isRim`).
template <class Value>
std::string Voxels(const Value& value) {
  std::string text;
  for (int z = 0; z < 6; ++z) {
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 6; ++x) {
        const bool isRim = std::min({x, y, z}) == 0 || std::max({x, y, z}) == 5;
        text += value(x + 6 * y + 36 * z, isRim) + " ";
      }
    }
  }
  return text;
}
inline double VoxelDensity(int voxel) {
  return 0.3 * (voxel * 37 % 11);
}
inline const std::string kVoxelBox =
    " \"integer nx\" 6 \"integer ny\" 6 \"integer nz\" 6 \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] ";

// A grid "gas" of colours. `channel`: a grey grid of that channel's coefficients; -1: of all.
inline std::string RgbGrid(int channel, double g, const std::string& more = "") {
  const auto colours = [channel](int shift) {
    return Voxels([&](int voxel, bool isRim) {
      std::string text;
      for (int c = 0; c < 3; ++c) {
        const int shown = channel < 0 ? c : channel;
        text += std::to_string(isRim ? 0.0 : VoxelDensity(voxel + shift * (shown + 1))) + " ";
      }
      return text;
    });
  };
  return "MakeNamedMedium \"gas\" \"string type\" \"rgbgrid\"" + kVoxelBox + " \"float g\" " + std::to_string(g) +
         " \"rgb sigma_s\" [" + colours(1) + "] \"rgb sigma_a\" [" + colours(2) + "] " + more + "\n";
}

inline constexpr int kMediaReplicas = 32;
inline constexpr int kMostMediaComparisons = 1000;  // of all known answers in media, for the family-wise rate

// The image's mean by independent renders, per channel, is `expected` within its noise; one standard error is at most
// `precision` of it. `blur`: relative error that is allowed beside the noise, of what is merged.
inline void ExpectKnown(const std::string& what, const Replicas& replicas, const Radiance& expected,
                        double precision = 0.002, double blur = 0) {
  static const double student = StudentQuantileTwoSided(SidakRate(1e-3, kMostMediaComparisons), kMediaReplicas - 1);
  ASSERT_EQ(replicas.images.size(), static_cast<size_t>(kMediaReplicas));
  EXPECT_EQ(replicas.faults, 0u) << what;
  const Image& first = replicas.images[0];
  std::printf("%-40s", what.c_str());
  for (size_t c = 0; c < 3; ++c) {
    const auto moments =
        replicas_internal::MomentsOf(replicas_internal::Means(replicas, c, 0, 0, first.width, first.height));
    const double error = std::sqrt(moments.variance);
    std::printf("  %+.3f %% +- %.3f %%", 100 * (moments.mean / expected[c] - 1), 100 * error / expected[c]);
    EXPECT_LE(error, precision * expected[c]) << what << ": too noisy in channel " << c;
    EXPECT_NEAR(moments.mean, expected[c], student * error + (1e-5 + blur) * expected[c]) << what << ", channel " << c;
  }
  std::printf("  %.1f s\n", static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}

// Sample counts of the integrators, as multiples of that of path tracing.
struct Effort {
  double path = 1, light = 8, bdpt = 1, vcm = 1, sppm = 1;

  int Samples(const std::string& integrator, int ofPath) const {
    const double factor = integrator == "light"  ? light
                          : integrator == "bdpt" ? bdpt
                          : integrator == "vcm"  ? vcm
                          : integrator == "sppm" ? sppm
                                                 : path;
    return std::max(1, static_cast<int>(factor * ofPath));
  }
};

// `samples`: per pixel and replica, of path tracing.
inline Replicas RenderKnown(const std::string& text, const std::string& integrator, int samples,
                            const Effort& effort = {}) {
  RenderOverrides overrides;
  // Media are darker within a radius of their boundaries for what is merged there. sppm merges where the default radius
  // is small against mean free paths, and of 16 pixels that is next to nowhere (GlowingMedia in tests/agreement has a
  // furnace for its photons).
  if (integrator == "vcm" || integrator == "auto") overrides.values["radius"] = 0.01;
  return RenderReplicas(text, integrator, kMediaReplicas, effort.Samples(integrator, samples), overrides);
}

inline std::string NameOfIntegrator(const testing::TestParamInfo<const char*>& info) {
  return info.param;
}

}  // namespace lampyr::test
