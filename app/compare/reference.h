// The picture that the others are measured against.
//
// It is the mean of independent renders of the integrator that a first look finds best, and the spread of these renders
// is its error: what its noise adds to a measured error is known, and subtracted. It is kept beside the report and used
// again while scene, size and depth stay the same.
#pragma once

#include <filesystem>
#include <functional>

#include "app/compare/compared_scene.h"
#include "app/compare/results.h"
#include "film/metrics.h"

namespace lampyr {

struct Reference {
  Image image;  // with its standard errors, where these are known and not just bounded
  ComparisonReference facts;
  ImageNoise noise;  // as far as it is known
};

// A picture of the user's. Throws UsageError when it is not of the scene's size, or another part of it.
Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings);

// The seed of a render: other for each use, and none that a user is likely to have rendered a reference with.
enum class SeedUse { Pilot = 1, Reference = 2, Compared = 3, Key = 4 };
uint64_t SeedOf(SeedUse use, uint64_t index);

// `fraction` done of making it.
using ReferenceProgress = std::function<void(double fraction, const std::string& note)>;

// First looks at all integrators, some `seconds` each. The chosen one has the lowest error among those that see all of
// the light: one that finds significantly less than another misses something, however smooth its picture is.
std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, const ReferenceProgress& progress);

// Renders the mean of some renders of `integrator`, about `seconds` in all.
Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress);

// Everything that makes the picture what it is, as text: a kept reference with another key is of another picture.
// Includes a picture of one sample per pixel, in which meshes and textures show that the scene's text only names.
std::string ReferenceKey(const ComparedScene& scene, const std::string& sceneHash);

// `seconds` that it was asked to take.
void KeepReference(const Reference& reference, const std::string& key, double seconds,
                   const std::filesystem::path& file);
// Absent when there is none, or none of this picture that was asked to take at least `seconds`.
std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds);

}  // namespace lampyr
