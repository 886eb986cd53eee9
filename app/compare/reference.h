// The reference image of a comparison.
//
// It is the mean of independent renders by the integrator that the first look chooses. The variance over these renders
// is its noise, which is subtracted from measured errors. If the integrator merges photons, the renders have radii so
// small that the bias is below the noise, as far as the time allows; both are reported. The reference is cached beside
// the report and reused as long as scene, size and depth are the same.
#pragma once

#include <filesystem>
#include <functional>

#include "app/compare/blur.h"
#include "app/compare/compared_scene.h"
#include "app/compare/results.h"
#include "film/metrics.h"

namespace lampyr {

struct Reference {
  Image image;  // with its standard errors, if they are known and not only bounded
  ComparisonReference facts;
  ImageNoise noise;  // as far as known
  int parts = 2;     // independent renders that the noise is estimated from
  Blur blur;         // 0 if it is unknown
  // relMSE of the noise relative to neighbourhoods, as that of trial renders (Pilot); of a given reference whose noise
  // is known.
  std::optional<double> noiseOfNeighbourhoods;
};

// Sets settings without bias: those of an integrator that converges to the picture, whatever the scene or the command
// line specifies, with its default merging radii, which shrink.
void MakeConsistent(Settings& values);

// Loads an image given by the user. Throws a UsageError if its size or crop differs from the scene's; warns if its
// metadata name another scene than `sceneHash` (empty: not checked).
Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings,
                        const std::string& sceneHash = "");

// Seed of a render: different for each use, and unlikely to be that of a user's reference.
enum class SeedUse { Pilot = 1, Reference = 2, Compared = 3, Key = 4 };
uint64_t SeedOf(SeedUse use, uint64_t index);

// `fraction`: of the reference done.
using ReferenceProgress = std::function<void(double fraction, const std::string& note)>;

// Renders the mean of several renders of `integrator`, about `seconds` in all. For an integrator that merges photons,
// the renders are at two radii, one half of the other, whose difference gives the bias (Blur); as long as that is above
// the noise, renders at half the radius are added.
Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress);

// Key of a cached reference: everything that determines the image, as text. Includes a picture of one sample per pixel,
// which depends on the meshes and textures to which the scene's text only refers.
std::string ReferenceKey(const ComparedScene& scene, const std::string& sceneHash);

// `seconds`: requested rendering time.
void KeepReference(const Reference& reference, const std::string& key, double seconds,
                   const std::filesystem::path& file);
// The kept reference; absent if there is none with this key and at least `seconds` of requested rendering time.
std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds);

}  // namespace lampyr
