// Renders of the baselines.
#pragma once

#include <atomic>
#include <cmath>

#include "detection/baselines.h"
#include "support/render_scene.h"

namespace lampyr::test {

inline BuiltScene BuildFor(const BaselineScene& scene, const std::string& integrator) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  RenderOverrides overrides;
  overrides.integrator = integrator;
  if (integrator == "vcm" || integrator == "sppm") {
    // So small that the blur is below the noise.
    overrides.values["radius"] = 0.005;
    overrides.values["photons"] = 6000;
  }
  return BuildScene(ParseScene(scene.text, scene.folder / "detection.pbrt", diagnostics), overrides, true, diagnostics,
                    scene.types);
}

// The normal deviate that is as improbable as t with `nu` degrees of freedom ([Wallace59 eq. 4.2]).
inline double NormalDeviate(double t, double nu) {
  return std::copysign((8 * nu + 1) / (8 * nu + 3) * std::sqrt(nu * std::log1p(t * t / nu)), t);
}

// Samples of pixels, so far.
inline std::atomic<uint64_t>& RenderedPaths() {
  static std::atomic<uint64_t> paths{0};
  return paths;
}
inline Rendered RenderCounted(BuiltScene& built, int samplesPerPixel, uint64_t seed) {
  built.settings.seed = seed;
  RenderedPaths() += static_cast<uint64_t>(built.settings.width) * static_cast<uint64_t>(built.settings.height) *
                     static_cast<uint64_t>(samplesPerPixel);
  return RenderBuilt(built, samplesPerPixel, 1);
}

inline constexpr int kReplicas = 16;  // the same picture by other seeds: their spread is its error

}  // namespace lampyr::test
