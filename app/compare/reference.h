// The reference image of a comparison.
//
// It is the mean of independent renders by the integrator that is most efficient in a short trial. The variance over
// these renders is its noise, which is subtracted from measured errors. It is cached beside the report and reused as
// long as scene, size and depth are the same.
#pragma once

#include <filesystem>
#include <functional>

#include "app/compare/compared_scene.h"
#include "app/compare/results.h"
#include "film/metrics.h"

namespace lampyr {

struct Reference {
  Image image;  // with its standard errors, if they are known and not only bounded
  ComparisonReference facts;
  ImageNoise noise;  // as far as known
};

// Loads an image given by the user. Throws a UsageError if its size or crop differs from the scene's.
Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings);

// Seed of a render: different for each use, and unlikely to be that of a user's reference.
enum class SeedUse { Pilot = 1, Reference = 2, Compared = 3, Key = 4 };
uint64_t SeedOf(SeedUse use, uint64_t index);

// `fraction`: of the reference done.
using ReferenceProgress = std::function<void(double fraction, const std::string& note)>;

// Trial renders by all integrators, about `seconds` each. Chooses the one with the lowest error among those that find
// all light: an integrator whose mean is significantly below another's is excluded.
std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, const ReferenceProgress& progress);

// Renders the mean of some renders of `integrator`, about `seconds` in all.
Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress);

// Key of a cached reference: everything that determines the image, as text.
// Includes a picture of one sample per pixel, in which meshes and textures show that the scene's text only names.
std::string ReferenceKey(const ComparedScene& scene, const std::string& sceneHash);

// `seconds`: requested rendering time.
void KeepReference(const Reference& reference, const std::string& key, double seconds,
                   const std::filesystem::path& file);
// Absent if there is none with this key and at least `seconds` of requested rendering time.
std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds);

}  // namespace lampyr
