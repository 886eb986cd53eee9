// The pdf consistency suite: statistical evidence that the three techniques of a light agree. It runs over the
// registry, over a plugin's type or over a single light, and prints nothing itself.
//
// Properties, by their names in the results (properties.h explains them to authors whose light fails one):
//
//   integral             pdfDirect integrates to the probability that a sample exists, 1 where the light is all visible
//   directions           χ² of sampled points (or directions, at infinity) against pdfDirect
//   strata               the same by classes of the cosine at the light, from receivers very near and very far, grazing
//                        and edge-on, where few samples fall
//   consistency          EvaluateSamples on a generated sample gives back radiance, normal and all densities
//   surface              a sample's normal, position and density agree with the shape, evaluated apart from the light;
//                        its solidAngleToArea is that of its place
//   one-sided            nothing leaves a one-sided surface at its back
//   irradiance           by light sampling = by quadrature over the surface
//   patches              each is chosen with PatchProbability; a light that is its own surface has one
//   position-error       bounds the distance of a position from the surface, and is no larger than rounding can make it
//   uvw                  the coordinates of a ray's hit there; a uniform light may leave them at 0
//   emission-integral    the densities of emission integrate to 1
//   emission-positions   χ² of photons against pdfEmit; emission-directions: against pdfEmitDirection, and moments
//   emission-edge        a photon's densities are those that EvaluateSamples gives for that edge, and its
//                        emissionCosine is that of its direction (1 for points and lights at infinity)
//   emission-origin      a photon's place does not depend on its direction, even on a dark one
//   shines-from          a photon lights points beyond shinesFrom and none before; it is 0 if CanBeAimed is true
//   power                by emission = by direct sampling on an enclosing sphere
//   power-estimate       GetPowerEstimate, as exact as light.h requires
//   energy               of the bounds: the power estimate times importanceMultiplier
//   bounds               photons leave within GetEmissionBounds
//   estimate             no estimate is 0 at a receiver that a sample reaches
//   segment              no light arrives on a segment of a ray outside of the range that the light's estimate gives,
//                        also without an end; χ² of equiangular distances in it from points of the light (the density
//                        of these is pdfEmit: emission-positions)
//   multipliers          diffuse and specular parts are one emission, each times the light's multiplier
//   camera               a camera sees what receivers see, and nothing of a delta
//   bidirectional        without it only the densities of emission are missing: all else is compared bit by bit
//   time                 nothing depends on it except the placement, which is given
//   repeat               the same query gives the same result: in another order, on another thread, on two at once, at
//                        the end
//   exceptions           nothing is thrown once the light is made
//   parameters           those of all lights (intensity, exposure, …, cameraVisible) have their documented effect
//   edit                 an edited light equals one made afresh, bit by bit, for each parameter of its type
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lights/light_type.h"
#include "suite/emitter_model.h"

namespace lampyr {

struct SuiteResult {
  std::string light, property, caseName;
  bool isProbability = false;  // statistic is a p-value that must exceed the threshold; else an error that must not
  double statistic = 0, threshold = 0;
  bool passed = false;
  std::string words;  // worst location, expected and found values there; may be empty
};

class SuiteReport {
 public:
  void AddProbability(const std::string& light, const std::string& property, const std::string& caseName, double pValue,
                      const std::string& words = "");
  void AddError(const std::string& light, const std::string& property, const std::string& caseName, double error,
                double tolerance, const std::string& words = "");
  void Add(const SuiteReport& other);
  // Number of errors above their tolerance plus number of p-values below `p`.
  size_t CountDoubtful(double p) const;
  // Merges a second run on the same light, from other receivers and with other random numbers. For each error above its
  // tolerance, and each p-value below `doubtful`, the better of the two results is kept. A defect shows in both runs. A
  // sample that happens to lie on the edge of a texel, or a quadrature that misses a narrow feature and underestimates
  // its error, does not recur in the same case.
  void Confirm(const SuiteReport& again, double doubtful);
  // Judges the p-values at a family-wise level over all results that were added.
  std::vector<SuiteResult> Finish(double familyWise);

 private:
  std::vector<SuiteResult> results_;
};

// Groups of properties that CheckLight checks.
enum SuiteParts : unsigned {
  kContractPart = 1,    // bidirectional, time, repeat
  kAttributePart = 2,   // patches, shines-from, position-error, energy, uvw
  kDensityPart = 4,     // all that compares densities with samples and with each other
  kStrataPart = 8,      // strata: a second or so for each light
  kDirectionPart = 16,  // emission-directions, with many photons
  kParameterPart = 32,  // edit, parameters: of types, not of single lights
  kSegmentPart = 64,    // segment
  kAllParts = 127
};

struct SuiteOptions {
  int samples = 3000;  // per receiver
  int photons = 8000;  // per light and transform
  double familyWise = 1e-3;
  uint64_t seed = 1;
  int threads = 1;  // of RunPdfSuite; the results are the same with any number
  unsigned parts = kAllParts;
  int effort = 1;         // multiplies the number of points that a quadrature may take
  int caseEvery = 1;      // of RunPdfSuite: every n-th placed light
  int thoroughEvery = 1;  // of RunPdfSuite: every n-th of the thorough cases
  int editEvery = 1;  // of RunPdfSuite: every n-th sample block of a type, from the first on, is edited by each of its
                      // parameters; the others by a few
  // Called repeatedly with the completed fraction, one call at a time. May be empty.
  std::function<void(double fraction)> progress;
};

// A light under test at its placement.
struct SuiteSubject {
  const Light* light = nullptr;
  LightContext context;                 // transform and scene; bidirectional
  const EmitterModel* model = nullptr;  // area lights on a shape; those that are their own surface have none
  bool isPowerExact = true;             // GetPowerEstimate is a closed form here
  // The light's parameters "diffuse" and "specular": samples, evaluations and photons carry the emission times them.
  double diffuseMultiplier = 1, specularMultiplier = 1;
  // True to run the strata and direction parts as well, which takes some seconds: densities where few samples fall, and
  // the directions of photons at fine resolution.
  bool isThorough = true;
  double powerError = 6e-4;  // relative standard error of the power; five times that is below half a per cent
  std::string name, caseName;
};

// Inputs from which a light was made, for comparing an edited light with one made afresh.
struct SuiteOrigin {
  const LightType* type = nullptr;
  const ParameterList* parameters = nullptr;
  const LightBuildContext* build = nullptr;
  std::vector<ParameterList> changes;  // each is merged over the parameters
};

// Checks all properties of one placed light.
void CheckLight(const SuiteSubject& subject, const SuiteOptions& options, SuiteReport& report);

// All sample blocks of the types × shapes × transforms × receivers. `scratch` is an existing folder for images.
std::vector<SuiteResult> RunPdfSuite(const std::vector<LightType>& types, const std::filesystem::path& scratch,
                                     const SuiteOptions& options);

}  // namespace lampyr
