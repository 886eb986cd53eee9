#include "suite/properties.h"

namespace lampyr {

const std::vector<PropertyMeaning>& PropertyMeanings() {
  static const std::vector<PropertyMeaning> meanings = {
      {"intersect",
       "Intersect must find the nearest hit in (tMin, tMax], within GetBounds; all other properties of a surface rely "
       "on it"},
      {"valid", "radiance and densities must be numbers, and not negative; radiance must be finite"},
      {"integral", "pdfDirect must integrate to the share of random numbers that give a sample"},
      {"directions", "samples must be distributed as pdfDirect says"},
      {"strata",
       "in each class of cosines at the light, near and far, as many samples must go as pdfDirect promises there"},
      {"consistency", "EvaluateSamples must give back radiance, normal and densities of a generated sample"},
      {"surface", "a sample's position, normal and density must be those of the surface that rays hit there"},
      {"one-sided", "a light whose bounds are one-sided must send nothing from its back"},
      {"irradiance", "light sampling and a quadrature over the light must give a receiver the same"},
      {"patches", "each patch must be chosen as PatchProbability says; only a light on a shape may have several"},
      {"position-error",
       "positionError must bound how far a position is off the surface, and be no larger than "
       "rounding makes it"},
      {"uvw", "uvw must be the coordinates that a ray finds there, or 0 everywhere"},
      {"emission-integral", "the densities of emission must integrate to the share of photons that are made"},
      {"emission-positions", "photons must start as pdfEmit says"},
      {"emission-directions", "photons must leave as pdfEmitDirection says"},
      {"emission-edge",
       "EvaluateSamples must give back radiance and densities of a photon, where it lands; emissionCosine must be that "
       "of its direction to the normal, 1 for points and lights at infinity"},
      {"emission-origin", "a photon's place must not depend on the random numbers of its direction"},
      {"shines-from", "a photon must light what lies beyond shinesFrom and nothing before; 0 where CanBeAimed is true"},
      {"power", "photons must carry the power that direct sampling measures on a sphere around the light"},
      {"power-estimate", "GetPowerEstimate must be the power that photons carry"},
      {"energy", "the energy of the emission bounds must be the power times importanceMultiplier"},
      {"bounds", "photons must leave within the emission bounds"},
      {"estimate", "no estimate may be 0 where a sample arrives"},
      {"segment", "no light may arrive on a segment of a ray outside of the range that the estimate gives"},
      {"multipliers", "diffuse and specular radiance must be one emission times the light's two multipliers"},
      {"camera", "a camera must see what receivers see, without the multipliers, and nothing of a delta"},
      {"bidirectional", "without `bidirectional` nothing but the densities of emission may be missing"},
      {"time", "at another time but in the same place the light must be the same"},
      {"repeat", "the same question must have the same answer, in any order and on any thread"},
      {"parameters", "a parameter that all lights have must do what it says, and nothing else"},
      {"edit", "an edited light must be, bit by bit, the one that is made afresh"},
      {"exceptions", "a light must not throw once it is made"},
      {"selection", "the probabilities of all lights must sum to 1, and none that contributes may have 0"},
  };
  return meanings;
}

std::string MeaningOf(const std::string& property) {
  for (const PropertyMeaning& row : PropertyMeanings()) {
    if (row.name == property) return row.meaning;
  }
  return "";
}

}  // namespace lampyr
