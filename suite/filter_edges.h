// Test edges for filters, between receivers and points on a light. They cover all positions of an edge relative to a
// filter.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lights/filters/light_filter.h"
#include "math/transform.h"
#include "sampling/rng.h"

namespace lampyr::suite {

// An edge in the filter's own space, in double. Filters are about one unit in size and look along -z.
struct SuiteEdge {
  const char* kind;
  Point3d receiver;
  Vector3d toLight;  // to the point on the light; only a direction for a light at infinity
  bool isInfinite = false;
  bool isDelta = false;  // of a light without a density
};

// `perKind` edges of each kind.
std::vector<SuiteEdge> SuiteEdges(Rng& rng, int perKind);
// The edge and its neighbours, which are farther away than rounding may move an edge.
std::vector<SuiteEdge> Neighbours(const SuiteEdge& edge, Rng& rng);

// Filtered light, by lobe type.
struct Filtered {
  Color diffuse, specular;
};
bool IsSame(const Filtered& a, const Filtered& b);  // bit by bit

// Edges in the form that filters take, with the light that they carry, initially white.
class EdgeBatch {
 public:
  EdgeBatch() = default;
  EdgeBatch(std::span<const SuiteEdge> edges, const Transform& placement, Rng& rng);

  size_t Size() const { return receivers.size(); }
  // The edges at `indices`, in that order.
  EdgeBatch Pick(std::span<const size_t> indices) const;
  // Filtered light: of all edges by one call (Filter), or of a single edge by its own call (FilterOne).
  std::vector<Filtered> Filter(const LightFilter& filter, const FilterContext& context) const;
  Filtered FilterOne(size_t index, const LightFilter& filter, const FilterContext& context) const;
  // Description of an edge.
  std::string Say(size_t index) const;

  std::vector<const char*> kinds;
  std::vector<Point3> receivers;
  std::vector<Vector3> toLights;
  std::vector<float> distances;
  std::vector<PdfSolidAngle> pdfs;
  std::vector<Color> diffuse, specular;
};

std::string Say(const Color& color);

}  // namespace lampyr::suite
