// Images as `lampyr render` and `lampyr merge` write them.
#pragma once

#include <filesystem>
#include <functional>

#include "render/render_part.h"

namespace lampyr {

// Names an EXR that can be written, and a PNG beside it if one is wanted, or throws UsageError; `option` names the
// culprit.
void CheckImageOutput(const std::filesystem::path& path, const char* option, bool withPng);

// The picture that the samples of the film make, with the metadata of the header and the number of samples. In halves
// if the header says so and they are enough. `append`: see WriteExr.
void WriteSamples(const std::filesystem::path& path, const PartHeader& header, const Film& film,
                  const std::function<void(AtomicFile&)>& append = {});

// Tone-mapped, with the extension .png.
void WritePngBeside(std::filesystem::path path, const Image& image, float exposureStops, bool clips);

}  // namespace lampyr
