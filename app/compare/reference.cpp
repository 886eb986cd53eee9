#include "app/compare/reference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "app/compare/mean_of_images.h"
#include "app/compare/neighbourhood.h"
#include "base/version.h"
#include "film/image_colors.h"
#include "integrators/photon/photon_settings.h"
#include "render/settings/integrator_choice.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr int kReferenceParts = 8;
// Parts of one radius that are rendered at a time, and all parts, of an integrator that merges photons.
constexpr int kGroup = 8, kMergedParts = 32;

// Fills in the facts that follow from the image of the reference.
void Describe(Reference& reference) {
  ComparisonReference& facts = reference.facts;
  facts.mean = MeanValue(reference.image);
  if (const auto noise = NoiseOf(reference.image, reference.parts)) {
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

// Reads the parts and the blur, as written by KeepReference.
void ReadBlur(Reference& reference) {
  const std::string text = MetadataOf(reference.image, "lampyr.compare.blur");
  if (text.empty()) return;
  Blur& blur = reference.blur;
  std::istringstream(text) >> blur.relMse >> blur.relMseLimit >> blur.mseLimit >> blur.meanLimit >> blur.isFromZero;
  reference.parts = std::max(2, std::atoi(MetadataOf(reference.image, "lampyr.compare.parts").c_str()));
  reference.facts.bias = blur.RelativeError();
  reference.facts.radius = std::atof(MetadataOf(reference.image, "lampyr.compare.radius").c_str());
  reference.facts.biasIsLimit = !blur.isFromZero && *reference.facts.radius > 0;
}

}  // namespace

Reference ReadReference(const std::filesystem::path& file, const RenderSettings& settings,
                        const std::string& sceneHash) {
  Reference reference;
  try {
    reference.image = InRec709(ReadImage(file), WhiteHandling::Adapt, GamutHandling::Keep);
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
  if (const std::string rendered = MetadataOf(image, "lampyr.sceneHash");
      !rendered.empty() && !sceneHash.empty() && rendered != sceneHash)
    std::fprintf(stderr, "warning: --reference: \"%s\" was rendered from another scene, or from another state of it\n",
                 file.c_str());
  ReadBlur(reference);
  try {
    Describe(reference);
    if (reference.facts.relMse) reference.noiseOfNeighbourhoods = RelativeNoise(reference.image);
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

void MakeConsistent(Settings& values) {
  values.RemoveBias();
  for (const Setting* setting : {&photon_settings::kRadius, &photon_settings::kAlpha})
    values.Set(setting->name, setting->fallback);
}

namespace {

// Renders independent parts of a reference, all with the same number of samples.
class PartRenderer {
 public:
  PartRenderer(const ComparedScene& scene, const std::string& integrator, double secondsPerSample, double seconds,
               int parts, const ReferenceProgress& progress)
      : scene_(scene), integrator_(integrator), progress_(progress), parts_(parts) {
    // A power of two, for which Sobol points are most uniform. The samples of all parts must not exceed an int.
    constexpr int mostBits = 25;
    static_assert((int64_t{1} << mostBits) * std::max(kReferenceParts, kMergedParts) <= (int64_t{1} << 30));
    const double affordable = std::max(1.0, seconds / parts / std::max(secondsPerSample, 1e-9));
    samples_ = 1 << static_cast<int>(std::clamp(std::round(std::log2(affordable)), 0.0, double{mostBits}));
    secondsPerPart_ = std::max(secondsPerSample * samples_, 1e-9);
  }

  Image Render(uint32_t firstSample) {
    Image part;
    const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& image) {
      seconds_ += reached.seconds;
      part = ChannelsOf(image, {"R", "G", "B"});
    };
    const auto tell = [&](double now) {
      progress_((done_ + std::min(now / secondsPerPart_, 1.0)) / parts_, "reference by " + integrator_);
    };
    const uint64_t seed = SeedOf(SeedUse::Reference, static_cast<uint64_t>(done_));
    scene_.Render(integrator_, seed, {}, {samples_}, keep, tell, firstSample);
    ++done_;
    return part;
  }
  int Samples() const { return samples_; }

  // The reference of that image.
  Reference Finish(const Image& image) const {
    Reference reference;
    reference.image = image;
    reference.facts.origin = ComparisonReference::Origin::Made;
    reference.facts.integrator = integrator_;
    reference.facts.samplesPerPixel = samples_ * done_;
    reference.facts.seconds = seconds_;
    return reference;
  }

 private:
  const ComparedScene& scene_;
  std::string integrator_;
  const ReferenceProgress& progress_;
  int parts_, samples_ = 1, done_ = 0;
  double secondsPerPart_ = 0, seconds_ = 0;
};

// Parts of a reference with the same merging radii.
class Level {
 public:
  Level(uint32_t firstSample, int samples)
      : firstSample_(firstSample), radius_(RadiusOfSamples(firstSample, samples)) {}

  void Add(PartRenderer& renderer) {
    ++partsOfFold_;
    for (Image& fold : folds_) {
      const Image part = renderer.Render(firstSample_);
      all_.Add(part);
      if (partsOfFold_ == 1) {
        fold = part;
        continue;
      }
      for (size_t i = 0; i < fold.data.size(); ++i)
        fold.data[i] += (part.data[i] - fold.data[i]) / static_cast<float>(partsOfFold_);
    }
    mean_ = all_.Mean();
    noise_ = RelativeNoise(mean_);
  }

  uint32_t FirstSample() const { return firstSample_; }
  int Parts() const { return all_.Count(); }
  double Radius() const { return radius_; }
  const Image& Mean() const { return mean_; }
  // relMSE of the noise of the mean of this many parts, relative to neighbourhoods like the blur.
  double NoiseOfParts(int parts) const { return noise_ * Parts() / parts; }

  // Difference from the level of a smaller radius.
  Blur DifferenceFrom(const Level& narrow) const {
    std::vector<const Image*> first, second;
    for (const Image& fold : folds_) first.push_back(&fold);
    for (const Image& fold : narrow.folds_) second.push_back(&fold);
    return DifferenceOfRadii(first, second);
  }

 private:
  uint32_t firstSample_;
  double radius_;
  // Means without standard errors: these many pictures are most of the memory.
  std::array<Image, kGroup> folds_;
  int partsOfFold_ = 0;
  MeanOfImages all_;
  Image mean_;
  double noise_ = 0;
};

// The bias of a level, from the two nearest ones (blur.h).
Blur BlurOfLevel(const std::vector<Level>& levels, size_t index) {
  const size_t wide = std::min(index, levels.size() - 2);
  const double q = levels[wide + 1].Radius() / levels[wide].Radius();
  return levels[wide].DifferenceFrom(levels[wide + 1]).Times((index == wide ? 1 : q) / (1 - q));
}

// The mean of the levels from `first` on, by their parts.
struct Combination {
  std::vector<double> weights;
  double noise = 0;  // relMSE
  Blur blur;

  Combination(const std::vector<Level>& levels, const std::vector<Blur>& blurs, size_t first) {
    int parts = 0;
    for (size_t i = first; i < levels.size(); ++i) parts += levels[i].Parts();
    for (size_t i = 0; i < levels.size(); ++i) {
      const double weight = i < first ? 0.0 : static_cast<double>(levels[i].Parts()) / parts;
      weights.push_back(weight);
      noise += weight * weight * levels[i].NoiseOfParts(levels[i].Parts());
      if (i >= first) blur.Add(blurs[i], weight);
    }
  }
  double TotalError() const { return noise + blur.relMse; }
};

// Keeps all radii whose blur allows it: those that give the least error, noise and blur together.
Reference CombineLevels(const std::vector<Level>& levels, const PartRenderer& renderer) {
  std::vector<Blur> blurs;
  std::vector<Image> means;
  for (size_t i = 0; i < levels.size(); ++i) {
    blurs.push_back(BlurOfLevel(levels, i));
    means.push_back(levels[i].Mean());
  }
  size_t first = levels.size() - 1;
  Combination best(levels, blurs, first);
  for (size_t i = first; i-- > 0;) {
    Combination other(levels, blurs, i);
    if (other.TotalError() >= best.TotalError()) continue;
    best = std::move(other);
    first = i;
  }
  Reference reference = renderer.Finish(WeightedSum(means, best.weights));
  reference.parts = 1;
  reference.facts.samplesPerPixel = 0;
  for (size_t i = first; i < levels.size(); ++i) {
    reference.parts += levels[i].Parts() - 1;  // degrees of freedom of its noise
    reference.facts.samplesPerPixel += levels[i].Parts() * renderer.Samples();
  }
  reference.blur = best.blur;
  reference.facts.radius = levels.back().Radius();
  return reference;
}

Reference MakeMerged(PartRenderer& renderer) {
  // Such that the radius changes little within a part, and can be halved three times before 32 bits are exceeded.
  constexpr uint32_t most = 1u << 12;
  const uint32_t first = std::clamp(static_cast<uint32_t>(renderer.Samples()), kSamplesToHalfRadius, most);
  std::vector<Level> levels;
  levels.reserve(kMergedParts / kGroup);
  levels.emplace_back(first, renderer.Samples()).Add(renderer);
  const auto halve = [&] {
    levels.emplace_back(levels.back().FirstSample() * kSamplesToHalfRadius, renderer.Samples()).Add(renderer);
  };
  halve();
  for (int left = kMergedParts - 2 * kGroup; left > 0; left -= kGroup) {
    const Level& finest = levels.back();
    const bool isBelowNoise =
        BlurOfLevel(levels, levels.size() - 1).relMse <= finest.NoiseOfParts(finest.Parts() + left);
    if (isBelowNoise) {
      levels.back().Add(renderer);
    } else {
      halve();
    }
  }
  return CombineLevels(levels, renderer);
}

}  // namespace

Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress) {
  const bool merges = GathersPhotons(VariantOf(scene.Built().settings, integrator));
  PartRenderer renderer(scene, integrator, secondsPerSample, seconds, merges ? kMergedParts : kReferenceParts,
                        progress);
  Reference reference;
  if (merges) {
    reference = MakeMerged(renderer);
  } else {
    MeanOfImages mean;
    for (int part = 0; part < kReferenceParts; ++part) mean.Add(renderer.Render(0));
    reference = renderer.Finish(mean.Mean());
    reference.parts = kReferenceParts;
    reference.facts.radius = 0;
  }
  reference.facts.bias = reference.blur.RelativeError();
  reference.facts.biasIsLimit = merges && !reference.blur.isFromZero;
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
  std::string key =
      std::string(kVersion) + " blur " + sceneHash + " depth " + std::to_string(settings.MaxDepth()) + " crop";
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
  if (reference.facts.bias) {
    const Blur& blur = reference.blur;
    image.metadata["lampyr.compare.parts"] = std::to_string(reference.parts);
    image.metadata["lampyr.compare.radius"] = number(*reference.facts.radius);
    image.metadata["lampyr.compare.blur"] = number(blur.relMse) + " " + number(blur.relMseLimit) + " " +
                                            number(blur.mseLimit) + " " + number(blur.meanLimit) + " " +
                                            (blur.isFromZero ? "1" : "0");
  }
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
  ReadBlur(reference);
  Describe(reference);
  return reference;
}

}  // namespace lampyr
