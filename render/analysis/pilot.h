// The pilot of a render: a few thousand samples by all bidirectional techniques, at a low resolution, from which the
// error and the cost of integrators with fewer techniques are estimated ([Grittmann22]).
//
// A sample x of the technique t, with the contribution v = f / p_t before its weight w, estimates the second moment of
// an integrator that has only the techniques of some groups, weighted by the power heuristic: it adds
//   w v² Σ (n r)⁴/r / (Σ (n r)²)²,   r = p / p_t over the techniques of those groups, n the times that each counts
// (bidirectional/path_densities.h).
// So light that path tracing finds once in a million samples counts as its noise as soon as another technique finds it,
// unless a typical render is not expected to hold one such sample: then it is light that path tracing does not find.
//
// Cost is counted, not timed, so that the choice does not depend on how fast or busy a machine is. It is that of the
// whole image: a part of it (--crop) is rendered by the same integrator.
#pragma once

#include <string>
#include <vector>

#include "render/settings/render_settings.h"

namespace lampyr {

// Passes of sppm after which its blur is compared with the noise of others, which has become smaller by then.
inline constexpr double kBlurredPasses = 256;

struct PilotCandidate {
  std::string integrator;
  TechniqueCounts counts;  // of bdpt and vcm
  // Squared error relative to the picture (relMSE) per sample of a pixel, where samples are as well distributed as in a
  // render.
  double error = 0;
  double uncertainty = 0;  // standard error of `error`
  double cost = 0;         // of a sample, nanoseconds of a typical machine
  double missing = 0;      // part of the light that it cannot find
  // Growth of the noise of a sample of sppm from kTypicalPasses to kBlurredPasses, because the radius shrinks; and its
  // squared bias after kBlurredPasses, times their number. 1 and 0 for all others.
  double noiseGrowth = 1, biasError = 0;
  // Of each tile of the image, row by row: the mean over its pixels of Σ E[(w v)²] over the paths of a sample, by all
  // techniques. Without light that the camera sees itself, where further rays look for it.
  std::vector<double> secondMoments;
  std::vector<double> tileErrors;     // of each tile: its part of `error`
  std::vector<double> tileVariances;  // of each tile: squared standard error of that
  std::vector<double> tileMissing;    // of each tile: its part of `missing`
  // Error of each tile from light that only merging finds; 0 for candidates that do not merge.
  std::vector<double> tileMergedOnly;

  std::string Describe() const { return counts.Describe(integrator); }

  // Error of a picture that takes a second per pixel.
  double ErrorTimesCost() const { return (error * noiseGrowth + biasError) * cost * 1e-9; }
  // The same, if the error is larger than estimated by twice its standard error, and where photons are merged with
  // their blur. So of equals the unbiased one is chosen.
  double MostErrorTimesCost() const {
    constexpr double kBlur = 1.1, kWideBlur = 1.2;
    const double blur = counts.startsWide ? kWideBlur : integrator == "vcm" ? kBlur : 1.0;
    return ((error + 2 * uncertainty) * noiseGrowth * blur + biasError) * cost * 1e-9;
  }
};

struct RenderPilot {
  std::vector<PilotCandidate> candidates;  // empty: the pilot saw no light
  // Candidates of which all camera paths may end early. Where that pays, one of `candidates` has a mask in their place.
  std::vector<PilotCandidate> ending;
  // The candidate with the least error in equal time, of those that find all light; null if there is none.
  const PilotCandidate* Best() const;
  // The candidate with these light paths that merges everywhere or nowhere; null: none.
  const PilotCandidate* Find(const std::string& integrator, int log2LightPaths = 0) const;
};

// Pixels of the pilot on a side of a tile; the pilot has all pixels of an image with at most kMostPilotPixels.
inline constexpr int kPilotTile = 4, kMostPilotPixels = 2304;

// A part of the light that is too small to be looked for.
inline constexpr double kNegligibleLight = 1e-4;

// Deterministic for a scene, its size and its settings; not dependent on the seed and on the number of threads.
// `passes`: samples of every pixel; even, because squares of means are products of two. 0: from 4 to 28, by their cost
// and by what is known after 4, 8 and 16.
RenderPilot RunPilot(const RenderScene& scene, const RenderSettings& settings, int threads, int passes = 0);

}  // namespace lampyr
