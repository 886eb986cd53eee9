// lampyr merge: one picture from parts that were rendered separately.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/command_line.h"
#include "app/commands.h"
#include "film/mix.h"
#include "render/feature_layers.h"
#include "render/first_hit_layers.h"
#include "render/output_files.h"
#include "render/render_part.h"
#include "render/sample_image.h"

namespace lampyr {

namespace {

std::string Quoted(const std::filesystem::path& path) {
  return "\"" + path.string() + "\"";
}

struct Part {
  std::filesystem::path path;
  std::unique_ptr<PartReader> reader;
  const PartHeader& Header() const { return reader->Header(); }
  uint32_t First() const { return Header().shard.first; }
  uint32_t End() const { return First() + Header().samples; }
};

std::string DivisionOf(const Shard& shard) {
  return std::to_string(shard.whole) + " samples in " + std::to_string(shard.count) + " parts";
}

// Opens the parts, sorted by their samples. Throws if they are from different renders or contain the same samples.
std::vector<Part> OpenParts(const std::vector<std::filesystem::path>& paths) {
  std::vector<Part> parts;
  for (const std::filesystem::path& path : paths)
    parts.push_back({path, std::make_unique<PartReader>(path, PartKind::Picture)});
  const Part& first = parts.front();
  for (const Part& part : parts) {
    std::string difference = DifferenceOf(first.Header().identity, part.Header().identity);
    if (difference.empty() && part.Header().layers != first.Header().layers) difference = "their light groups differ";
    const Shard &there = first.Header().shard, &here = part.Header().shard;
    if (difference.empty() && (there.count != here.count || there.whole != here.whole)) {
      difference = "they are of " + DivisionOf(there) + " and of " + DivisionOf(here);
    }
    if (difference.empty()) continue;
    throw Error(Quoted(first.path) + " and " + Quoted(part.path) + " do not belong together: " + difference);
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.First() < b.First(); });
  for (size_t i = 1; i < parts.size(); ++i) {
    const Part &before = parts[i - 1], &part = parts[i];
    if (before.End() <= part.First() && before.First() < part.First()) continue;
    throw Error(Quoted(before.path) + " and " + Quoted(part.path) + " hold the same samples: each part counts once");
  }
  return parts;
}

// Readable list of missing parts and samples; "" if the picture is complete.
std::string MissingOf(const std::vector<Part>& parts) {
  std::string missing;
  const auto add = [&](const std::string& what) { missing += (missing.empty() ? "" : ", ") + what; };
  const int count = parts.front().Header().shard.count;
  for (int index = 1; index <= count; ++index) {
    const auto part =
        std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.Header().shard.index == index; });
    const std::string name = std::to_string(index) + "/" + std::to_string(count);
    if (part == parts.end()) {
      add("part " + name);
    } else if (!part->Header().isFinished) {
      const Shard& shard = part->Header().shard;
      add("the rest of part " + name + " (" + std::to_string(part->Header().samples) + " of " +
          std::to_string(shard.end - shard.first) + " samples are there)");
    }
  }
  return missing;
}

// Throws a UsageError if an output would overwrite one of the parts, which may have taken hours to render.
void CheckPartsStay(const MergeOptions& options) {
  std::vector<std::pair<std::filesystem::path, const char*>> written = {{options.output, "--output"}};
  if (options.png) written.emplace_back(std::filesystem::path(options.output).replace_extension(".png"), "--png");
  for (const auto& [file, option] : written) {
    for (const std::filesystem::path& part : options.parts) {
      if (!IsSameFile(file, part)) continue;
      throw UsageError(std::string(option) + ": " + Quoted(file) + " is one of the parts that are merged, " +
                       Quoted(part) + ": it would be lost; write to another file");
    }
  }
}

// Adds the layers `names`, which are the same in all parts that have them, to `layers`, unless no part had the time for
// them. `what`: the layers in words.
void AddLayersOf(const std::vector<Part>& parts, const PixelRect& crop, const std::vector<std::string>& names,
                 const char* what, bool quiet, Image& layers) {
  for (const Part& part : parts) {
    Image found = ChannelsOf(ReadImage(part.path), names);
    if (found.channels.empty()) continue;
    if (found.width != crop.Width() || found.height != crop.Height())
      throw UsageError(Quoted(part.path) + ": the picture and the state of the render in it have different sizes");
    if (layers.channels.empty()) {
      layers = std::move(found);
    } else {
      AppendChannels(layers, found);
    }
    return;
  }
  if (!quiet) std::fprintf(stderr, "warning: no part has %s: the picture is without them\n", what);
}

// The first-hit layers, and the features for denoising; without channels if the picture has none.
Image LayersOf(const std::vector<Part>& parts, const PartHeader& whole, bool quiet) {
  Image layers;
  if (whole.metadata.contains(kFirstHitChannelsMetadata))
    AddLayersOf(parts, whole.crop, Split(whole.metadata.at(kFirstHitChannelsMetadata), ','),
                "the layers of what is seen first", quiet, layers);
  if (whole.metadata.contains(kFeaturesMetadata))
    AddLayersOf(parts, whole.crop, FeatureChannels(), "the features for denoising", quiet, layers);
  if (whole.metadata.contains(kAutoLayersMetadata))
    AddLayersOf(parts, whole.crop, AutoChannels(), "the layers of what was decided", quiet, layers);
  return layers;
}

}  // namespace

int RunMerge(const MergeOptions& options) {
  CheckPartsStay(options);
  CheckImageOutput(options.output, "--output", options.png);
  const std::vector<Part> parts = OpenParts(options.parts);
  const std::string missing = MissingOf(parts);
  if (!missing.empty() && !options.partial) {
    throw Error("the picture is not whole: " + missing + (missing.find(',') == std::string::npos ? " is" : " are") +
                " missing; render it, or merge what there is with --partial");
  }
  if (std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.Header().samples == 0; }))
    throw Error("the parts hold no samples: there is nothing to merge");
  const OutputLock lock(options.output);
  PartHeader whole = parts.front().Header();
  whole.samples = 0;
  Film film = whole.MakeFilm();
  std::vector<PartHeader> headers;
  for (const Part& part : parts) {
    Film own = whole.MakeFilm();
    part.reader->Load([&own](ByteReader& bytes) { own.Load(bytes); });
    film.Add(own);
    whole.samples += part.Header().samples;
    headers.push_back(part.Header());
  }
  if (film.HasHalf() && !whole.isAdaptive) SetHalfShare(headers, whole.metadata);
  WriteSamples(options.output, whole, film, LayersOf(parts, whole, options.quiet));
  if (options.png) WritePngBeside(options.output, film.Develop(), options.exposure, options.clipPng);
  if (!missing.empty()) std::fprintf(stderr, "warning: the picture is not whole: without %s\n", missing.c_str());
  if (!options.quiet) {
    std::fprintf(stderr, "%s: %d×%d, %u spp of %zu parts\n", options.output.c_str(), whole.crop.Width(),
                 whole.crop.Height(), whole.samples, parts.size());
  }
  return kExitDone;
}

}  // namespace lampyr
