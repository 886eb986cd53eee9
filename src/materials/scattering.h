// Results of a BSDF: a value with its densities, and a sampled direction. Conventions: materials/bsdf.h.
#pragma once

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

// The transported quantity: radiance (paths from the camera) or importance (paths from the lights).
enum class TransportMode { Radiance, Importance };

struct BsdfEvaluation {
  Color diffuse, specular;  // f, split by lobe: a light may send different radiance to each
  PdfSolidAngle pdfForward, pdfReverse;

  Color Sum() const { return diffuse + specular; }
};

// False if the path is absorbed. Functions that return one use the same variable in every return statement, so that it
// is constructed in the caller's storage (NRVO): copying what was just written field by field stalls on store
// forwarding.
struct BsdfSample {
  Vector3 wi{0.0f};
  // f · |cosθi| / pdf, split by lobe; computed without the division where it cancels.
  Color weightDiffuse, weightSpecular;
  PdfSolidAngle pdfForward, pdfReverse;  // for a delta: discrete probabilities of the lobe
  bool isDelta = false;
  bool isTransmission = false;
  // The direction is that to which the light of one lane of the Color is refracted. The others, which are refracted
  // elsewhere, have weight 0. Also set if the light of the lane is not refracted, in which case the sample is false.
  bool isDispersion = false;
  float eta = 1;  // η on wi's side over η on wo's side for transmission; 1 otherwise

  Color Weight() const { return weightDiffuse + weightSpecular; }
  explicit operator bool() const { return pdfForward.value > 0; }
};

}  // namespace lampyr
