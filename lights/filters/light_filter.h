// The filter interface: a filter scales the light on an edge between a light and a surface.
//
// A filter is a factor on the edge between a point on a light and the surface that it lights, whichever technique found
// the edge: next-event estimation, BSDF sampling, or the first hit of a photon. It must therefore be a function of the
// edge alone (receiver, direction, distance), so that all techniques estimate the same light. (RenderMan's photons, as
// documented, ignore filters.)
//
// There are two classes of filters: functions of the emitted ray (gobo, a physical barn, intmult) and functions of the
// receiver (rod, blocker, ramp, analytic barns and cookies).
//
// Everything is in render space. A filter is immutable and is used by many threads at once. Precompute what its
// parameters imply in the factory: it is evaluated billions of times.
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
  // In and out: the light for diffuse and specular lobes.
  Color* diffuse = nullptr;
  Color* specular = nullptr;

  FilterSamples Part(int begin, int howMany) const {
    return {howMany,           receiver + begin, toLight + begin, distance + begin,
            pdfDirect + begin, diffuse + begin,  specular + begin};
  }
};

class LightFilter;

// Operation by which a combiner merges the factors f_i of its filters: Π f_i, max f_i, min f_i, or 1 - Π (1 - f_i).
enum class CombineMode { Multiply, Max, Min, Screen };

// A filter in the scene.
struct FilterInstance {
  std::shared_ptr<const LightFilter> filter;  // null: it has no effect
  std::string name;
  CombineMode combineMode = CombineMode::Multiply;
  // Key of its linking groups, an index of FilterContext::enabled. 0: none; it is enabled everywhere.
  uint32_t linking = 0;
};

// Arguments of a filter besides the samples.
struct FilterContext {
  float time = 0;                    // in [0,1] over the shutter
  const uint8_t* enabled = nullptr;  // by FilterInstance::linking, for the receivers of this batch; null: all but 0 off

  // True if a filter is enabled on the receivers. A filter that applies others tests this for each of them.
  bool IsEnabled(const FilterInstance& instance) const {
    return instance.linking == 0 || (enabled && enabled[instance.linking] != 0);
  }
};

// Properties that a filter may report.
enum class FilterProperty {
  LinkingGroups,  // its linking groups: it is enabled only on receivers that subscribe to one of them
};

class LightFilter {
 public:
  virtual ~LightFilter() = default;

  // Scales samples.diffuse and samples.specular in place.
  virtual void Filter(const FilterContext& context, const FilterSamples& samples) const = 0;

  // The value of a property; null: not available.
  virtual const std::vector<std::string>* GetProperty(FilterProperty) const { return nullptr; }

  // Approximate transmittance for white light, which scales the light's estimate in light selection. Finite; at least a
  // tenth of the transmittance of any edge, because lights are selected in proportion to it; 0 only if no edge
  // transmits anything, because the light may then never be selected. nullopt: unknown; selection ignores the filter.
  virtual std::optional<float> GetRadianceModifier() const { return std::nullopt; }

  // True if it has no effect, as with a density of 0; it is then not called.
  virtual bool IsIdentity() const { return false; }
};

}  // namespace lampyr
