#include "app/compare/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "app/compare/estimate.h"
#include "base/progress.h"
#include "base/version.h"
#include "render/settings/integrator_choice.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr int kReferenceParts = 8;
constexpr int kPilotParts = 4;
// Standard errors have the range of the values; variances of very bright or dim pictures leave that of floats.
const std::vector<std::string> kLayers = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};

// Mean of pictures, with its standard error estimated from their spread.
class MeanOfImages {
 public:
  void Add(const Image& image) {
    if (images_ == 0) {
      first_ = image;
      sums_.assign(3 * Pixels(), 0.0);
      squares_.assign(3 * Pixels(), 0.0);
    }
    ++images_;
    for (size_t i = 0; i < Pixels(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        const double v = static_cast<double>(image.data[i * image.channels.size() + c]);
        const double shifted = v - First(i, c);  // squares of what is left cancel less
        sums_[3 * i + c] += shifted;
        squares_[3 * i + c] += shifted * shifted;
      }
    }
  }
  Image Mean() const {
    Image mean = first_;
    mean.channels = kLayers;
    mean.data.assign(6 * Pixels(), 0.0f);
    const double n = images_;
    for (size_t k = 0; k < 3 * Pixels(); ++k) {
      const double shift = sums_[k] / n;
      mean.data[k / 3 * 6 + k % 3] = static_cast<float>(First(k / 3, k % 3) + shift);
      if (images_ < 2) continue;
      mean.data[k / 3 * 6 + k % 3 + 3] =
          static_cast<float>(std::sqrt(std::max(0.0, squares_[k] / n - shift * shift) / (n - 1)));
    }
    return mean;
  }

 private:
  size_t Pixels() const { return static_cast<size_t>(first_.width) * static_cast<size_t>(first_.height); }
  double First(size_t pixel, size_t channel) const {
    return static_cast<double>(first_.data[pixel * first_.channels.size() + channel]);
  }

  Image first_;
  std::vector<double> sums_, squares_;
  int images_ = 0;
};

// Fills in the facts that follow from the image of the reference.
void Describe(Reference& reference) {
  ComparisonReference& facts = reference.facts;
  facts.mean = MeanValue(reference.image);
  if (const auto noise = NoiseOf(reference.image, kReferenceParts)) {
    reference.noise = *noise;
    facts.mse = noise->mse;
    facts.relMse = noise->relMse;
    facts.relativeError = noise->relativeError;
  }
}

std::string MetadataOf(const Image& image, const char* name) {
  const auto found = image.metadata.find(name);
  return found == image.metadata.end() ? std::string() : found->second;
}

// Means of the whole picture and of the blocks of a grid over it, for each part of a pilot.
struct PilotRun {
  Pilot pilot;
  std::vector<double> means;
  std::vector<std::vector<double>> blocks;
  bool isHinted = false;
  bool isBlurred = false;  // by photons: chosen only where the others miss light
};

constexpr int kGrid = 16;

std::vector<double> BlockMeans(const Image& image) {
  std::vector<double> sums(kGrid * kGrid, 0.0), counts(kGrid * kGrid, 0.0);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto block = static_cast<size_t>(y * kGrid / image.height * kGrid + x * kGrid / image.width);
      sums[block] += static_cast<double>(image.RgbAt(x, y).Average());
      ++counts[block];
    }
  }
  for (size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

// True if `a` is significantly brighter than `b`, with an error probability `byChance`. Differences below 1e-5 of
// `scale` count as rounding.
bool IsBrighter(std::span<const double> a, std::span<const double> b, double byChance, double scale) {
  const Moments first = MomentsOf(a), second = MomentsOf(b);
  constexpr double rounding = 1e-5;
  const double error = std::sqrt(first.varianceOfMean + second.varianceOfMean);
  const double t = StudentQuantileTwoSided(byChance, static_cast<double>(a.size()) - 1);
  return first.mean - second.mean > std::max(t * error, rounding * scale);
}

// True if `other` finds significantly more light than `run`, in the whole picture or in a block of it.
bool FindsMore(const PilotRun& other, const PilotRun& run) {
  constexpr double byChance = 0.01;
  const double scale = MomentsOf(other.means).mean;
  if (IsBrighter(other.means, run.means, byChance, scale)) return true;
  // A blurred picture is brighter next to bright areas; larger blocks average this out.
  const int side = other.isBlurred ? 4 : 1, across = kGrid / side;
  for (int block = 0; block < across * across; ++block) {
    const auto of = [=](const PilotRun& one) {
      std::vector<double> values;
      for (const std::vector<double>& part : one.blocks) {
        double sum = 0;
        for (int i = 0; i < side * side; ++i) {
          const int x = block % across * side + i % side, y = block / across * side + i / side;
          sum += part[static_cast<size_t>(y * kGrid + x)];
        }
        values.push_back(sum / (side * side));
      }
      return values;
    };
    if (IsBrighter(of(other), of(run), SidakRate(byChance, across * across), scale)) return true;
  }
  return false;
}

void Choose(std::vector<PilotRun>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const PilotRun& a, const PilotRun& b) { return a.pilot.relMse < b.pilot.relMse; });
  const bool allHinted =
      std::all_of(runs.begin(), runs.end(), [](const PilotRun& run) { return run.isHinted || run.isBlurred; });
  const bool allBlack = std::none_of(runs.begin(), runs.end(), [](const PilotRun& run) { return run.pilot.mean > 0; });
  PilotRun* chosen = nullptr;
  for (PilotRun& run : runs) {
    if (!(run.pilot.mean > 0) && !allBlack) {
      run.pilot.note = "finds no light";
      continue;
    }
    auto more = runs.end();  // the brightest of those that find more
    for (auto other = runs.begin(); other != runs.end(); ++other) {
      const bool isBrightest = more == runs.end() || other->pilot.mean > more->pilot.mean;
      if (isBrightest && FindsMore(*other, run)) more = other;
    }
    if (more != runs.end()) {
      const double share = MomentsOf(run.means).mean / MomentsOf(more->means).mean;
      run.pilot.note = "finds less light than " + more->pilot.integrator +
                       ", in some part of the picture or in all of it (" + FormatPercent(share) + ")";
    } else if (run.isHinted && !allHinted) {
      run.pilot.note = "cannot find all of the light";
    } else if (run.isBlurred) {
      run.pilot.note = "blurs, and finds no more light than others";
    } else if (!chosen) {
      chosen = &run;
    }
  }
  const auto brightest = std::max_element(
      runs.begin(), runs.end(), [](const PilotRun& a, const PilotRun& b) { return a.pilot.mean < b.pilot.mean; });
  if (!chosen) chosen = &*brightest;
  if (chosen->isBlurred)
    chosen->pilot.note = "finds light that the others miss; blurs it by a pixel at first, then less";
  chosen->pilot.chosen = true;
}

}  // namespace

Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings) {
  Reference reference;
  try {
    reference.image = ReadImage(file);
  } catch (const Error& error) {
    throw UsageError("--reference: " + error.Text());
  }
  const Image& image = reference.image;
  if (image.width != settings.crop.Width() || image.height != settings.crop.Height()) {
    throw UsageError("--reference: \"" + file.string() + "\" has " + std::to_string(image.width) + "×" +
                     std::to_string(image.height) + " pixels, and the scene is rendered with " +
                     std::to_string(settings.crop.Width()) + "×" + std::to_string(settings.crop.Height()));
  }
  // With the same full image, the crop must be the same. Programs differ only in how they store a crop alone.
  const bool isOfSameImage = image.fullWidth == settings.width && image.fullHeight == settings.height;
  if (isOfSameImage && (image.offsetX != settings.crop.x0 || image.offsetY != settings.crop.y0)) {
    throw UsageError("--reference: \"" + file.string() + "\" is another part of the image: its corner is at " +
                     std::to_string(image.offsetX) + "," + std::to_string(image.offsetY) + ", and that of --crop at " +
                     std::to_string(settings.crop.x0) + "," + std::to_string(settings.crop.y0));
  }
  reference.image.offsetX = settings.crop.x0;
  reference.image.offsetY = settings.crop.y0;
  reference.facts.origin = ComparisonReference::Origin::Given;
  reference.facts.file = file.string();
  reference.facts.integrator = MetadataOf(image, "lampyr.integrator");
  try {
    Describe(reference);
  } catch (const Error& error) {
    throw UsageError("--reference: " + error.Text());
  }
  if (!(reference.facts.mean > 0)) throw UsageError("--reference: \"" + file.string() + "\" is black");
  // Only references made by compare have standard errors from the spread of independent renders. Variances of samples
  // are an upper bound.
  if (reference.facts.relMse && MetadataOf(image, "lampyr.compare.key").empty()) {
    reference.facts.noiseIsLimit = true;
    Image& plain = reference.image;
    for (std::string& channel : plain.channels) {
      for (const char* layer : {"variance.", "stderr."}) {
        if (channel.rfind(layer, 0) == 0) channel = "limit." + channel;
      }
    }
    reference.noise.mseError = reference.facts.mse.value_or(0);
    reference.noise.relMseError = reference.facts.relMse.value_or(0);
  }
  return reference;
}

uint64_t SeedOf(SeedUse use, uint64_t index) {
  constexpr int bits = 52;  // exactly representable in JSON and JavaScript
  return Hash(static_cast<uint64_t>(use), index) >> (64 - bits);
}

std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, const ReferenceProgress& progress) {
  std::vector<PilotRun> runs;
  // A reference should not be blurred, so photons are used only in scenes where the techniques that connect paths miss
  // light.
  const bool needsPhotons = !IntegratorHints(scene.Built().scene, "bdpt").empty();
  for (const std::string& name : IntegratorNames()) {
    if (!IntegratorRefusal(scene.Built().scene, name).empty()) continue;
    if (GathersPhotons(name, scene.Built().settings.values) && !(needsPhotons && name == "vcm")) continue;
    PilotRun run;
    run.isBlurred = GathersPhotons(name, scene.Built().settings.values);
    run.pilot.integrator = name;
    run.isHinted = !IntegratorHints(scene.Built().scene, name).empty();
    runs.push_back(run);
  }
  std::vector<MeanOfImages> images(runs.size());
  const double steps = static_cast<double>(kPilotParts) * static_cast<double>(runs.size());
  for (int part = 0; part < kPilotParts; ++part) {
    for (size_t i = 0; i < runs.size(); ++i) {
      Pilot& pilot = runs[i].pilot;
      const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& image) {
        pilot.seconds += reached.seconds;
        pilot.samplesPerPixel += reached.samplesPerPixel;
        runs[i].means.push_back(MeanValue(image));
        runs[i].blocks.push_back(BlockMeans(image));
        images[i].Add(image);
      };
      scene.Render(pilot.integrator, SeedOf(SeedUse::Pilot, static_cast<uint64_t>(part)), {seconds / kPilotParts}, {},
                   keep, [](double) {});
      progress((part * static_cast<double>(runs.size()) + static_cast<double>(i) + 1) / steps,
               "first look, " + pilot.integrator);
    }
  }
  for (size_t i = 0; i < runs.size(); ++i) {
    const Image mean = images[i].Mean();
    runs[i].pilot.mean = MeanValue(mean);
    runs[i].pilot.relMse = NoiseOf(mean, kPilotParts)->relMse;
  }
  Choose(runs);
  std::vector<Pilot> pilots;
  for (const PilotRun& run : runs) pilots.push_back(run.pilot);
  return pilots;
}

Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress) {
  // A power of two, for which Sobol points are most uniform.
  const double affordable = std::max(1.0, seconds / kReferenceParts / std::max(secondsPerSample, 1e-9));
  const int samples = 1 << static_cast<int>(std::clamp(std::round(std::log2(affordable)), 0.0, 27.0));
  Reference reference;
  MeanOfImages mean;
  double done = 0;
  for (int part = 0; part < kReferenceParts; ++part) {
    const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& image) {
      done += reached.seconds;
      mean.Add(image);
    };
    const double expected = secondsPerSample * samples;
    scene.Render(integrator, SeedOf(SeedUse::Reference, static_cast<uint64_t>(part)), {}, {samples}, keep,
                 [&](double now) {
                   const double ofPart = std::min(now / std::max(expected, 1e-9), 1.0);
                   progress((part + ofPart) / kReferenceParts, "reference by " + integrator);
                 });
  }
  reference.image = mean.Mean();
  reference.facts.origin = ComparisonReference::Origin::Made;
  reference.facts.integrator = integrator;
  reference.facts.samplesPerPixel = samples * kReferenceParts;
  reference.facts.seconds = done;
  Describe(reference);
  return reference;
}

std::string ReferenceKey(const ComparedScene& scene, const std::string& sceneHash) {
  const RenderSettings& settings = scene.Built().settings;
  uint64_t hash = 0;
  const auto add = [&](size_t, const ComparedScene::Milestone&, const Image& image) {
    for (const float value : image.data) hash = Hash(hash, std::bit_cast<uint32_t>(value));
  };
  scene.Render("bdpt", SeedOf(SeedUse::Key, 0), {}, {1}, add, [](double) {});
  const PixelRect& crop = settings.crop;
  std::string key = std::string(kVersion) + " " + sceneHash + " depth " + std::to_string(settings.MaxDepth()) + " crop";
  for (const int side : {settings.width, settings.height, crop.x0, crop.y0, crop.x1, crop.y1})
    key += " " + std::to_string(side);
  char text[32];
  std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(hash));
  return key + text;
}

void KeepReference(const Reference& reference, const std::string& key, double seconds,
                   const std::filesystem::path& file) {
  Image image = reference.image;
  const auto number = [](double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text);
  };
  image.metadata = {{"lampyr.version", kVersion},
                    {"lampyr.integrator", reference.facts.integrator},
                    {"lampyr.samplesPerPixel", std::to_string(reference.facts.samplesPerPixel)},
                    {"lampyr.compare.key", key},
                    {"lampyr.compare.seconds", number(reference.facts.seconds)},
                    {"lampyr.compare.secondsAskedFor", number(seconds)}};
  WriteExr(file, image, ExrPrecision::Float);
}

std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  Reference reference;
  try {
    reference.image = ReadImage(file);
  } catch (const Error&) {
    return std::nullopt;  // from another program, or damaged: rendered again
  }
  const auto text = [&](const char* name) { return MetadataOf(reference.image, name); };
  constexpr double rounding = 1e-6;
  const double askedFor = std::atof(text("lampyr.compare.secondsAskedFor").c_str());
  if (text("lampyr.compare.key") != key || askedFor < (1 - rounding) * seconds) return std::nullopt;
  reference.facts.origin = ComparisonReference::Origin::Cached;
  reference.facts.integrator = text("lampyr.integrator");
  reference.facts.samplesPerPixel = std::atoi(text("lampyr.samplesPerPixel").c_str());
  reference.facts.seconds = std::atof(text("lampyr.compare.seconds").c_str());
  Describe(reference);
  return reference;
}

}  // namespace lampyr
