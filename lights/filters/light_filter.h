// The filter interface: what changes a light's colour after the light was sampled.
//
// A filter is a factor on the edge between a place on a light and the surface that it shines on, whichever technique
// made that edge: next-event estimation, a direction of the BSDF that met the light, or a photon where it lands. It
// must therefore be a function of the edge alone (receiver, direction, distance), and not of what was sampled or how:
// all techniques then estimate the same light. (RenderMan's photons, as documented, ignore filters.)
//
// There are two classes of filters: functions of the emitted ray (gobo, a physical barn, intmult) and functions of the
// receiver (rod, blocker, ramp, analytic barns and cookies).
//
// Everything is in render space. A filter is immutable once made, and is used by many threads at once: what its
// parameters mean is digested when it is made, because it is asked billions of times.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/density.h"
#include "math/vec.h"

namespace lampyr {

// Edges between one light and receivers, `count` of each array.
struct FilterSamples {
  int count = 0;
  const Point3* receiver = nullptr;          // the surface that is lit
  const Vector3* toLight = nullptr;          // unit
  const float* distance = nullptr;           // to the light; infinite for lights at infinity
  const PdfSolidAngle* pdfDirect = nullptr;  // of the light's own sampling, without its selection; 1 for deltas
  // In and out: what the light sends to diffuse and specular lobes there.
  Color* diffuse = nullptr;
  Color* specular = nullptr;

  FilterSamples Part(int begin, int howMany) const {
    return {howMany,           receiver + begin, toLight + begin, distance + begin,
            pdfDirect + begin, diffuse + begin,  specular + begin};
  }
};

class LightFilter;

// How a filter's factor meets those of the others in a combiner: the product, the largest, the smallest, or 1 less the
// product of what each takes away.
enum class CombineMode { Multiply, Max, Min, Screen };

// A filter as the scene holds it.
struct FilterInstance {
  std::shared_ptr<const LightFilter> filter;  // null: it never changes anything
  std::string name;
  CombineMode combineMode = CombineMode::Multiply;
  uint32_t linking = 0;  // its groups, as a number that a context can look up; 0: none, it is enabled everywhere
};

// What a filter is given beside the samples.
struct FilterContext {
  float time = 0;                    // in [0,1] over the shutter
  const uint8_t* enabled = nullptr;  // by FilterInstance::linking, for the receivers of this batch; null: all but 0 off

  // Whether a filter is enabled on the receivers. Who runs other filters asks this for each of them.
  bool IsEnabled(const FilterInstance& instance) const {
    return instance.linking == 0 || (enabled && enabled[instance.linking] != 0);
  }
};

// What may be asked of a filter.
enum class FilterProperty {
  LinkingGroups,  // the groups that it belongs to: it is then off, except for receivers that subscribe to one
};

class LightFilter {
 public:
  virtual ~LightFilter() = default;

  // Changes samples.diffuse and samples.specular, which stay as they are where the filter does nothing.
  virtual void Filter(const FilterContext& context, const FilterSamples& samples) const = 0;

  // The answer to a question, or null where the filter has none.
  virtual const std::vector<std::string>* GetProperty(FilterProperty) const { return nullptr; }

  // The approximate transmittance for white light: a hint for selecting lights, which scales the light's estimate.
  // Finite. At least a tenth of the transmittance of any edge, since a light is selected in proportion to it; 0 only if
  // no edge transmits anything, since the light may then never be selected. nullopt: unknown, and the light is selected
  // as if it had no filter.
  virtual std::optional<float> GetRadianceModifier() const { return std::nullopt; }

  // Whether it never changes anything, as with a density of 0: it is then not called.
  virtual bool IsIdentity() const { return false; }
};

}  // namespace lampyr
