// Settings of integrators that gather photons.
#pragma once

#include "integrators/walk/integrator_type.h"

namespace lampyr {

// Least radius on surfaces, in radii of the scene. Below the rounding of positions photons are not where they seem to
// be.
constexpr double kLeastRadius = 1e-7;

namespace photon_settings {

inline const Setting kPhotons{.name = "photons",
                              .help = "Light paths of a pass, for their photons",
                              .fallback = int64_t{-1},
                              .least = 1,
                              .most = static_cast<double>(int64_t{1} << 31),
                              .range = "from 1 to 2147483648",
                              .fallbackText = "as many as the image has pixels",
                              .sceneName = "photonsperiteration"};
// Which light paths are left out at the memory limit affects the picture, so the limit is the same on all machines.
inline const Setting kPhotonMemory{.name = "photon-memory",
                                   .help =
                                       "Memory for the photons of a pass, e.g. 512M; fewer light paths if it is used "
                                       "up. The picture depends on it",
                                   .fallback = int64_t{4} << 30,
                                   .least = 1,
                                   .most = 1e15,
                                   .unit = "bytes",
                                   .isInScenes = false};
inline const Setting kRadius{.name = "radius",
                             .help = "Gather radius of the first pass",
                             .fallback = 0.0,
                             .least = std::numeric_limits<float>::min(),
                             .most = std::numeric_limits<float>::max(),
                             .range = "above 0, from 1.2e-38 to 3.4e38",
                             .unit = "scene units",
                             .fallbackText = "from the size of pixels"};
inline const Setting kAlpha{.name = "alpha",
                            .help = "How fast the gather radius shrinks, as pass^((alpha - 1) / 2)",
                            .fallback = 2. / 3,
                            .least = 0,
                            .most = 1};
inline const Setting kGuidePhotons{.name = "guide-photons",
                                   .help = "Guide photons to where they contribute, if that reduces the noise",
                                   .fallback = true};

inline const std::vector<const Setting*> kAll = {&kPhotons, &kPhotonMemory, &kRadius, &kAlpha, &kGuidePhotons};

}  // namespace photon_settings

// PhotonSettings with the radius clamped to the range that makes sense for the scene.
PhotonSettings PhotonSettingsOf(const IntegratorInput& input);
// Makes photons beams in homogeneous media whose mean free paths are long against the radius.
void UseBeams(const IntegratorInput& input, PhotonSettings& photons);

}  // namespace lampyr
