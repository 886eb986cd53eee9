// Checks of a render before it begins: its options, the files that it writes, and the memory that it takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "app/commands.h"
#include "integrators/photon/photon_settings.h"
#include "integrators/walk/integrator.h"
#include "render/settings/render_settings.h"
#include "scene/scene_description.h"

namespace lampyr {

// out.2-of-8.exr for a part, unless the user names it.
std::filesystem::path OutputPath(const RenderOptions& options, const RenderSettings& settings);

// Throws a UsageError if two outputs would be one file, or an output file is one of the input files of the scene.
void CheckOutputs(const RenderOptions& options, const SceneDescription& scene, const RenderSettings& settings);

// Throws a UsageError if options contradict each other or the settings, or an output could not be written. Makes the
// folder of --strategy-images.
void CheckOptions(const RenderOptions& options, const RenderSettings& settings,
                  const std::filesystem::path& checkpoint);

// Throws a UsageError for an image that is too large for the machine, before the system ends the process. `layers`: of
// the film; `denoises`: the picture will be denoised.
void CheckRenderMemory(const RenderSettings& settings, const Integrator& integrator, size_t layers, bool denoises);

// Warns if a pass of photons may need more memory than this machine has: their limit is the same on all machines.
void WarnOfPhotonMemory(const RenderSettings& settings, const PhotonSettings& photons);

// Samples per pixel of the whole picture, over all parts; kOpenEnd for a render that ends by time or error alone.
inline constexpr uint32_t kOpenEnd = 1u << 30;
int SamplesWanted(const RenderOptions& options, const RenderSettings& settings);

}  // namespace lampyr
