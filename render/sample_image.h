// Images as `lampyr render` and `lampyr merge` write them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "render/render_part.h"

namespace lampyr {

// Throws a UsageError unless `path` is an EXR that can be written and, if `withPng`, so can a PNG beside it. `option`:
// the command-line option that the message names.
void CheckImageOutput(const std::filesystem::path& path, const char* option, bool withPng);

// Metadata of a picture that is to have a layer of its samples (IsOfSamples): this and the layer's name.
inline constexpr const char* kSampleLayerMetadata = "lampyr.sampleLayer.";

// Name of the metadata of a picture that is to have the layers of what `auto` decided, and their channels.
inline constexpr const char* kAutoLayersMetadata = "lampyr.autoLayers";
inline std::vector<std::string> AutoChannels() {
  return {"auto.lightPaths", "auto.connecting", "auto.merging", "auto.continuing"};
}

// Sets kHalfShareMetadata for a picture of the samples of these parts, in their order, if they are not the first ones;
// not if it is set.
void SetHalfShare(std::span<const PartHeader> parts, std::map<std::string, std::string>& metadata);

// Writes the developed film, then the channels of `layers`, with the metadata of the header and the number of samples.
// In half precision if the header asks for it (ExrPrecision). `append`: see WriteExr.
void WriteSamples(const std::filesystem::path& path, const PartHeader& header, const Film& film, const Image& layers,
                  const std::function<void(AtomicFile&)>& append = {});

// Writes the tone-mapped image with the extension .png.
void WritePngBeside(std::filesystem::path path, const Image& image, float exposureStops, bool clips);

}  // namespace lampyr
