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

namespace lampyr {

struct Reference {
  Image image;  // with variance layers, unless it was given without
  ComparisonReference facts;
  double meanError = 0;  // standard error of the relative mean of the image
};

// A picture of the user's. Throws UsageError when it is not of the scene's size.
Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings);

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

void KeepReference(const Reference& reference, const std::string& key, const std::filesystem::path& file);
// Absent when there is none, or none of this picture that took at least `seconds`.
std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds);

}  // namespace lampyr
