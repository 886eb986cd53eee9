// The files of a render: the header of its picture, and how the picture is written.
#pragma once

#include <filesystem>

#include "app/commands.h"
#include "film/film.h"
#include "film/image.h"
#include "render/load_scene.h"
#include "render/progressive_render.h"
#include "render/render_part.h"
#include "render/settings/render_settings.h"

namespace lampyr {

// Header of the picture with all samples of the part; the number of samples is not set.
PartHeader MakeHeader(const RenderOptions& options, const LoadedScene& loaded, const Shard& shard);

// Writes the picture so far. The file of one part (--shard) also carries its sums. `ofAll`: MakeHeader. `layers`: those
// that are not in the film. Throws an Error if the file cannot be written.
void WriteImage(const std::filesystem::path& path, const RenderOptions& options, const PartHeader& ofAll,
                const Film& film, const Image& layers, const RenderOutcome& outcome);

// Writes the picture; if its folder is full or gone, writes it to the folder of temporary files and throws an Error
// that names that file, so that a long render is not lost.
void WriteImageOrKeepIt(const std::filesystem::path& path, const RenderOptions& options, const PartHeader& header,
                        const Film& film, const Image& layers, const RenderOutcome& outcome);

// Writes the layers of strategies as pictures weighted-s2-t3.exr, unweighted-s2-t3.exr, … to the folder of
// --strategy-images.
void WriteStrategies(const RenderOptions& options, const RenderSettings& settings, const Image& image);

// Layers of the decisions of auto over the crop: those of UsedCounts. Requires settings.counts.
Image AutoLayers(const RenderSettings& settings);

}  // namespace lampyr
