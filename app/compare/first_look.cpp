#include "app/compare/first_look.h"

#include <algorithm>
#include <cmath>

#include "app/compare/blur.h"
#include "app/compare/estimate.h"
#include "app/compare/mean_of_images.h"
#include "app/compare/neighbourhood.h"
#include "app/compare/reference.h"
#include "base/progress.h"
#include "film/metrics.h"
#include "render/analysis/pilot.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

// At the error probability of one block of one pair of integrators, a t-test of four parts requires a difference of 150
// standard errors, and one of eight 17.
constexpr int kPilotParts = 8;

// Means of the whole picture and of the blocks of a grid over it, for each part of a pilot.
struct PilotRun {
  Pilot pilot;
  std::vector<double> means;
  std::vector<std::vector<double>> blocks;
  bool isHinted = false;
  double missing = 0;               // fraction of the light that it is known to miss
  bool isBlurred = false;           // by photons
  std::vector<Image> wide, narrow;  // of the parts, if it is blurred: at two radii
  double ratioOfRadii = 0.5;
  bool isBlurFromZero = false;  // significantly

  // relMSE of noise and blur.
  double TotalError() const { return pilot.relMse + pilot.bias * pilot.bias; }
  // Total error that is certain of a render `longer` times as long: noise falls, blur hardly does. In short pilots the
  // estimate of a blur may be noise, which is no reason to do without light.
  double CertainErrorOf(double longer) const {
    return pilot.relMse / longer + (isBlurFromZero ? pilot.bias * pilot.bias : 0.0);
  }
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

// True if `a` is significantly brighter than `b`, with an error probability `byChance`, by the t-test for means of
// different variances [Welch47]. `least`: smaller differences do not count.
bool IsBrighter(std::span<const double> a, std::span<const double> b, double byChance, double least) {
  const Moments first = MomentsOf(a), second = MomentsOf(b);
  const double difference = first.mean - second.mean;
  if (!(difference > least)) return false;
  const double variance = first.varianceOfMean + second.varianceOfMean;
  if (!(variance > 0)) return true;
  const double share = first.varianceOfMean / variance, other = 1 - share;
  const double degrees = (static_cast<double>(a.size()) - 1) / (share * share + other * other);
  return difference > StudentQuantileTwoSided(byChance, degrees) * std::sqrt(variance);
}

// A blurred picture is brighter next to bright areas; larger blocks average this out.
constexpr int kSideOfBlurredBlock = 4;

// Means of a block of `side` × `side` cells of the grid, for each part.
std::vector<double> PartsOfBlock(const PilotRun& run, int block, int side) {
  const int across = kGrid / side;
  std::vector<double> values;
  for (const std::vector<double>& part : run.blocks) {
    double sum = 0;
    for (int i = 0; i < side * side; ++i) {
      const int x = block % across * side + i % side, y = block / across * side + i / side;
      sum += part[static_cast<size_t>(y * kGrid + x)];
    }
    values.push_back(sum / (side * side));
  }
  return values;
}

// True if `other` finds significantly more light than `run`, in the whole picture or in a block of it; each of the two
// questions has the error probability `byChance`.
bool FindsMore(const PilotRun& other, const PilotRun& run, double byChance) {
  constexpr double kRounding = 1e-5;
  const double scale = MomentsOf(other.means).mean;
  if (IsBrighter(other.means, run.means, byChance, kRounding * scale)) return true;
  const int side = other.isBlurred || run.isBlurred ? kSideOfBlurredBlock : 1, across = kGrid / side;
  // In a block where only the tail of the pixel filter receives light, integrators that do not splat may find nothing
  // at all.
  const double least = kNegligibleLight * scale * across * across;
  for (int block = 0; block < across * across; ++block) {
    if (IsBrighter(PartsOfBlock(other, block, side), PartsOfBlock(run, block, side),
                   SidakRate(byChance, across * across), least))
      return true;
  }
  return false;
}

// An upper estimate of the light that `run` may miss: its relative differences from `complete`, as a mean square over
// blocks. They include the noise of both, so that the expectation is not below the missing light.
double LightThatMayBeMissing(const PilotRun& run, const PilotRun& complete) {
  constexpr int across = kGrid / kSideOfBlurredBlock;
  const double floor = 1e-3 * MomentsOf(complete.means).mean;
  double sum = 0;
  for (int block = 0; block < across * across; ++block) {
    const double all = MomentsOf(PartsOfBlock(complete, block, kSideOfBlurredBlock)).mean;
    const double found = MomentsOf(PartsOfBlock(run, block, kSideOfBlurredBlock)).mean;
    if (all > floor) sum += std::pow((all - found) / all, 2);
  }
  return sum / (across * across);
}

// Notes that a pilot misses light, or may miss some. Returns false if there is nothing to note.
bool NoteFlaw(PilotRun& run, const std::vector<PilotRun>& runs, bool allBlack, bool allHinted) {
  constexpr double byChance = 1e-3;  // of all pairs of integrators
  const auto pairs = static_cast<int>(runs.size() * (runs.size() - 1) / 2);
  const double byChanceOfPair = SidakRate(byChance, pairs);
  run.pilot.isFlawed = true;
  if (!(run.pilot.mean > 0) && !allBlack) {
    run.pilot.note = "finds no light";
    return true;
  }
  const PilotRun* more = nullptr;  // the brightest of those that find more
  for (const PilotRun& other : runs) {
    if ((!more || other.pilot.mean > more->pilot.mean) && FindsMore(other, run, byChanceOfPair)) more = &other;
  }
  if (more) {
    const double share = MomentsOf(run.means).mean / MomentsOf(more->means).mean;
    run.pilot.note = "finds less light than " + more->pilot.integrator +
                     ", in some part of the picture or in all of it (" + FormatPercent(share) + ")";
    return true;
  }
  if (run.isHinted && !allHinted) {
    run.pilot.note = "cannot find all of the light";
    return true;
  }
  run.pilot.isFlawed = false;
  return false;
}

// The least advantage, as a ratio of relative errors, for which blur is accepted.
constexpr double kWorthBlur = 3;

// The largest ratio of squared errors that is accepted of a reference with all light, over one that is known to miss
// some. Errors are relative to the reference: where it lacks light, they are many times too large for all integrators
// that find it.
constexpr double kWorthLight = 4;

// The better of the best integrator that does not blur and the best that does, for a render `longer` times as long as
// theirs; null: none. Notes the reason.
PilotRun* ChooseBetween(PilotRun* sharp, PilotRun* blurred, double longer) {
  if (!blurred) return sharp;
  if (!sharp) {
    blurred->pilot.note = "finds light that the others miss; what it blurs is measured";
    return blurred;
  }
  if (sharp->isHinted && !blurred->isHinted) {
    const bool isKnown = sharp->missing > kNegligibleLight;
    // The mean square of what pixels lack is at least the square of what the picture lacks.
    const double missing =
        std::max(LightThatMayBeMissing(*sharp, *blurred), isKnown ? sharp->missing * sharp->missing : 0.0);
    if ((isKnown ? kWorthLight : 1.0) * (sharp->pilot.relMse / longer + missing) > blurred->CertainErrorOf(longer)) {
      sharp->pilot.isFlawed = true;
      sharp->pilot.note = isKnown ? "cannot find all light: it misses " + FormatPercent(sharp->missing)
                                  : "cannot find all light, and may miss " + FormatPercent(std::sqrt(missing)) +
                                        " of a part of the picture";
      blurred->pilot.note =
          std::string("finds light that the others ") + (isKnown ? "" : "may ") + "miss; what it blurs is measured";
      return blurred;
    }
  }
  const double ratio = std::sqrt(blurred->TotalError() / sharp->TotalError());
  const std::string error = "its error, noise and blur, is " + FormatPercent(ratio) + " of that of " +
                            sharp->pilot.integrator + " in the same time";
  if (kWorthBlur * ratio < 1) {
    sharp->pilot.note = "finds all light, with more noise than " + blurred->pilot.integrator + " has noise and blur";
    blurred->pilot.note = error;
    return blurred;
  }
  blurred->pilot.note = "blurs: " + error;
  return sharp;
}

void Choose(std::vector<PilotRun>& runs, double longer) {
  std::sort(runs.begin(), runs.end(),
            [](const PilotRun& a, const PilotRun& b) { return a.TotalError() < b.TotalError(); });
  const bool allHinted =
      std::all_of(runs.begin(), runs.end(), [](const PilotRun& run) { return run.isHinted || run.isBlurred; });
  const bool allBlack = std::none_of(runs.begin(), runs.end(), [](const PilotRun& run) { return run.pilot.mean > 0; });
  PilotRun *sharp = nullptr, *blurred = nullptr;
  for (PilotRun& run : runs) {
    if (NoteFlaw(run, runs, allBlack, allHinted)) continue;
    PilotRun*& best = run.isBlurred ? blurred : sharp;
    if (!best) best = &run;
  }
  PilotRun* chosen = ChooseBetween(sharp, blurred, longer);
  if (!chosen) {
    chosen = &*std::max_element(runs.begin(), runs.end(),
                                [](const PilotRun& a, const PilotRun& b) { return a.pilot.mean < b.pilot.mean; });
  }
  chosen->pilot.chosen = true;
}

std::vector<PilotRun> Candidates(const BuiltScene& built) {
  std::vector<PilotRun> runs;
  const auto add = [&](const std::string& name) {
    const RenderSettings settings = VariantOf(built.settings, name);
    if (!IntegratorRefusal(built.scene, settings.integrator).empty()) return;
    PilotRun run;
    run.pilot.integrator = name;
    run.isBlurred = GathersPhotons(settings);
    run.isHinted = !IntegratorHints(built.scene, settings.integrator).empty();
    runs.push_back(run);
  };
  // Candidates that gather photons: vcm, which has all techniques, and "auto", which may have left out useless ones.
  for (const std::string& name : IntegratorNames()) {
    if (name == "vcm" || !GathersPhotons(name, built.settings.values)) add(name);
  }
  if (built.settings.counts && GathersPhotons(built.settings)) add(kAuto);
  return runs;
}

// Notes the light that, by the pilot of "auto", some of the integrators cannot find.
void NoteMissingLight(const ComparedScene& scene, std::vector<PilotRun>& runs) {
  const auto isIt = [&](bool PilotRun::*flag) {
    return std::any_of(runs.begin(), runs.end(), [&](const PilotRun& run) { return run.*flag; });
  };
  if (!isIt(&PilotRun::isHinted) || !isIt(&PilotRun::isBlurred)) return;
  const RenderPilot known = RunPilot(scene.Built().scene, scene.Built().settings, scene.Threads());
  for (PilotRun& run : runs)
    if (const PilotCandidate* candidate = known.Find(run.pilot.integrator)) run.missing = candidate->missing;
}

// Renders a part of a pilot; for an integrator that blurs, half of it at half the radius.
Image RenderPart(const ComparedScene& scene, PilotRun& run, int part, double seconds) {
  Image image;
  const auto render = [&](double time, uint32_t firstSample, uint64_t seed) {
    double radius = 1;
    const auto keep = [&](size_t, const ComparedScene::Milestone& reached, const Image& reachedImage) {
      run.pilot.seconds += reached.seconds;
      run.pilot.samplesPerPixel += reached.samplesPerPixel;
      radius = RadiusOfSamples(firstSample, reached.samplesPerPixel);
      image = ChannelsOf(reachedImage, {"R", "G", "B"});
    };
    scene.Render(
        run.pilot.integrator, SeedOf(SeedUse::Pilot, seed), {time}, {}, keep, [](double) {}, firstSample);
    return radius;
  };
  const auto index = static_cast<uint64_t>(part);
  if (!run.isBlurred) {
    render(seconds, 0, index);
    return image;
  }
  const double wide = render(seconds / 2, kSamplesToHalfRadius, index);
  run.wide.push_back(image);
  const double narrow = render(seconds / 2, kSamplesToHalfRadius * kSamplesToHalfRadius, kPilotParts + index);
  run.narrow.push_back(image);
  run.ratioOfRadii = narrow / wide;
  MeanOfImages both;
  both.Add(run.wide.back());
  both.Add(run.narrow.back());
  return both.Mean();
}

// Fills in the blur of the mean of pictures at both radii.
void EstimateBlur(PilotRun& run) {
  std::vector<const Image*> wide, narrow;
  for (const Image& image : run.wide) wide.push_back(&image);
  for (const Image& image : run.narrow) narrow.push_back(&image);
  const double q = run.ratioOfRadii;
  const Blur blur = DifferenceOfRadii(wide, narrow).Times(0.5 * (1 + q) / (1 - q));
  run.pilot.bias = std::sqrt(blur.relMse);
  run.isBlurFromZero = blur.isFromZero;
}

}  // namespace

std::vector<Pilot> FlyPilots(const ComparedScene& scene, double seconds, double referenceSeconds,
                             const ReferenceProgress& progress) {
  std::vector<PilotRun> runs = Candidates(scene.Built());
  NoteMissingLight(scene, runs);
  std::vector<MeanOfImages> images(runs.size());
  const double steps = static_cast<double>(kPilotParts) * static_cast<double>(runs.size());
  for (int part = 0; part < kPilotParts; ++part) {
    for (size_t i = 0; i < runs.size(); ++i) {
      const Image image = RenderPart(scene, runs[i], part, seconds / kPilotParts);
      runs[i].means.push_back(MeanValue(image));
      runs[i].blocks.push_back(BlockMeans(image));
      images[i].Add(image);
      progress((part * static_cast<double>(runs.size()) + static_cast<double>(i) + 1) / steps,
               "first look, " + runs[i].pilot.integrator);
    }
  }
  for (size_t i = 0; i < runs.size(); ++i) {
    const Image mean = images[i].Mean();
    runs[i].pilot.mean = MeanValue(mean);
    runs[i].pilot.relMse = RelativeNoise(mean);
    if (runs[i].isBlurred && runs[i].pilot.mean > 0) EstimateBlur(runs[i]);
  }
  Choose(runs, std::max(referenceSeconds / seconds, 1.0));
  std::vector<Pilot> pilots;
  for (const PilotRun& run : runs) pilots.push_back(run.pilot);
  return pilots;
}

}  // namespace lampyr
