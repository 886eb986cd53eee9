#include "app/compare/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "app/compare/estimate.h"
#include "app/integrator_hints.h"
#include "base/version.h"
#include "film/metrics.h"

namespace lampyr {

namespace {

constexpr int kReferenceParts = 8;
constexpr int kPilotParts = 4;
// Seeds that no compared render has.
constexpr uint64_t kReferenceSeed = uint64_t{1} << 40, kPilotSeed = uint64_t{1} << 41;

const std::vector<std::string> kLayers = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};

// Mean of pictures, with the variance of the mean by their spread.
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
      mean.data[k / 3 * 6 + k % 3 + 3] = static_cast<float>(std::max(0.0, squares_[k] / n - shift * shift) / (n - 1));
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

// What is known of a reference by looking at it.
void Describe(Reference& reference, std::span<const double> means) {
  ComparisonReference& facts = reference.facts;
  facts.mean = MeanValue(reference.image);
  if (const auto noise = NoiseOf(reference.image)) {
    facts.mse = noise->mse;
    facts.relMse = noise->relMse;
    facts.relativeError = noise->relativeError;
  }
  if (facts.mean > 0) reference.meanError = std::sqrt(MomentsOf(means).varianceOfMean) / facts.mean;
}

std::string Percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * fraction);
  return text;
}

struct PilotRun {
  Pilot pilot;
  std::vector<double> means;
  bool isHinted = false;
};

// Whether `other` finds significantly more light than `run`.
bool FindsMore(const PilotRun& other, const PilotRun& run) {
  const Moments a = MomentsOf(other.means), b = MomentsOf(run.means);
  const double variance = a.varianceOfMean + b.varianceOfMean;
  constexpr double certain = 0.01, rounding = 1e-5;
  const double t = StudentQuantileTwoSided(certain, kPilotParts - 1);
  return a.mean - b.mean > std::max(t * std::sqrt(variance), rounding * std::abs(a.mean));
}

void Choose(std::vector<PilotRun>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const PilotRun& a, const PilotRun& b) { return a.pilot.relMse < b.pilot.relMse; });
  const bool allHinted = std::all_of(runs.begin(), runs.end(), [](const PilotRun& run) { return run.isHinted; });
  PilotRun* chosen = nullptr;
  for (PilotRun& run : runs) {
    const auto more =
        std::find_if(runs.begin(), runs.end(), [&](const PilotRun& other) { return FindsMore(other, run); });
    if (more != runs.end()) {
      const double share = MomentsOf(run.means).mean / MomentsOf(more->means).mean;
      run.pilot.note = "finds " + Percent(share) + " of the light that " + more->pilot.integrator + " finds";
    } else if (run.isHinted && !allHinted) {
      run.pilot.note = "cannot find all of the light";
    } else if (!chosen) {
      chosen = &run;
    }
  }
  if (!chosen) chosen = &runs.front();
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
  // Programs differ in where they say that a crop lies; its size is what counts.
  reference.image.offsetX = settings.crop.x0;
  reference.image.offsetY = settings.crop.y0;
  reference.facts.origin = ComparisonReference::Origin::Given;
  reference.facts.file = file.string();
  const auto known = image.metadata.find("lampyr.integrator");
  if (known != image.metadata.end()) reference.facts.integrator = known->second;
  try {
    Describe(reference, {});
  } catch (const Error& error) {
    throw UsageError("--reference: " + error.Text());
  }
  if (!(reference.facts.mean > 0)) throw UsageError("--reference: \"" + file.string() + "\" is black");
  return reference;
}

std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, const ReferenceProgress& progress) {
  std::vector<PilotRun> runs;
  std::vector<MeanOfImages> images(IntegratorNames().size());
  for (const std::string& name : IntegratorNames()) {
    PilotRun run;
    run.pilot.integrator = name;
    run.isHinted = !IntegratorHints(scene.Built().scene, name).empty();
    runs.push_back(run);
  }
  const double steps = static_cast<double>(kPilotParts) * static_cast<double>(runs.size());
  for (int part = 0; part < kPilotParts; ++part) {
    for (size_t i = 0; i < runs.size(); ++i) {
      Pilot& pilot = runs[i].pilot;
      const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& image) {
        pilot.seconds += reached.seconds;
        pilot.samplesPerPixel += reached.samplesPerPixel;
        runs[i].means.push_back(MeanValue(image));
        images[i].Add(image);
      };
      scene.Render(pilot.integrator, kPilotSeed + static_cast<uint64_t>(part), {seconds / kPilotParts}, {}, keep,
                   [](double) {});
      progress((part * static_cast<double>(runs.size()) + static_cast<double>(i) + 1) / steps,
               "first look, " + pilot.integrator);
    }
  }
  for (size_t i = 0; i < runs.size(); ++i) {
    const Image mean = images[i].Mean();
    runs[i].pilot.mean = MeanValue(mean);
    runs[i].pilot.relMse = NoiseOf(mean)->relMse;
  }
  Choose(runs);
  std::vector<Pilot> pilots;
  for (const PilotRun& run : runs) pilots.push_back(run.pilot);
  return pilots;
}

Reference MakeReference(const ComparedScene& scene, const std::string& integrator, double secondsPerSample,
                        double seconds, const ReferenceProgress& progress) {
  // A power of two: Sobol points are at their best there.
  const double affordable = std::max(1.0, seconds / kReferenceParts / std::max(secondsPerSample, 1e-9));
  const int samples = 1 << static_cast<int>(std::clamp(std::round(std::log2(affordable)), 0.0, 28.0));
  Reference reference;
  MeanOfImages mean;
  std::vector<double> means;
  double done = 0;
  for (int part = 0; part < kReferenceParts; ++part) {
    const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& image) {
      done += reached.seconds;
      means.push_back(MeanValue(image));
      mean.Add(image);
    };
    const double expected = secondsPerSample * samples;
    scene.Render(integrator, kReferenceSeed + static_cast<uint64_t>(part), {}, {samples}, keep, [&](double now) {
      const double ofPart = std::min(now / std::max(expected, 1e-9), 1.0);
      progress((part + ofPart) / kReferenceParts, "reference by " + integrator);
    });
  }
  reference.image = mean.Mean();
  reference.facts.origin = ComparisonReference::Origin::Made;
  reference.facts.integrator = integrator;
  reference.facts.samplesPerPixel = samples * kReferenceParts;
  reference.facts.seconds = done;
  Describe(reference, means);
  return reference;
}

std::string ReferenceKey(const ComparedScene& scene, const std::string& sceneHash) {
  const RenderSettings& settings = scene.Built().settings;
  uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](size_t, const ComparedScene::Milestone&, const Image& image) {
    for (const float value : image.data)
      hash = (hash ^ static_cast<uint64_t>(std::bit_cast<uint32_t>(value))) * 1099511628211u;
  };
  scene.Render("bdpt", kReferenceSeed - 1, {}, {1}, add, [](double) {});
  const PixelRect& crop = settings.crop;
  std::string key = std::string(kVersion) + " " + sceneHash + " depth " + std::to_string(settings.maxDepth) + " crop";
  for (const int side : {settings.width, settings.height, crop.x0, crop.y0, crop.x1, crop.y1})
    key += " " + std::to_string(side);
  char text[32];
  std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(hash));
  return key + text;
}

void KeepReference(const Reference& reference, const std::string& key, const std::filesystem::path& file) {
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
                    {"lampyr.compare.meanError", number(reference.meanError)}};
  WriteExr(file, image, ExrPrecision::Float);
}

std::optional<Reference> FindKeptReference(const std::filesystem::path& file, const std::string& key, double seconds) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  Reference reference;
  try {
    reference.image = ReadImage(file);
  } catch (const Error&) {
    return std::nullopt;  // of another program, or damaged: made anew
  }
  const auto& metadata = reference.image.metadata;
  const auto text = [&](const char* name) {
    const auto found = metadata.find(name);
    return found == metadata.end() ? std::string() : found->second;
  };
  const double took = std::atof(text("lampyr.compare.seconds").c_str());
  constexpr double nearly = 0.5;  // sample counts are powers of two
  if (text("lampyr.compare.key") != key || took < nearly * seconds) return std::nullopt;
  reference.facts.origin = ComparisonReference::Origin::Cached;
  reference.facts.integrator = text("lampyr.integrator");
  reference.facts.samplesPerPixel = std::atoi(text("lampyr.samplesPerPixel").c_str());
  reference.facts.seconds = took;
  Describe(reference, {});
  reference.meanError = std::atof(text("lampyr.compare.meanError").c_str());
  return reference;
}

}  // namespace lampyr
