// The edges that filters are asked for: between receivers and places on a light, spread over all the ways in which an
// edge can meet a filter.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lights/filters/light_filter.h"
#include "math/transform.h"
#include "sampling/rng.h"

namespace lampyr::suite {

// In the filter's own space, in double. Filters are about a unit large and look along -z.
struct SuiteEdge {
  const char* kind;
  Point3d receiver;
  Vector3d toLight;  // to the place on the light; of a light at infinity, the direction alone
  bool isInfinite = false;
  bool isDelta = false;  // of a light without a density
};

// `perKind` edges of each kind.
std::vector<SuiteEdge> SuiteEdges(Rng& rng, int perKind);
// The edge with its neighbours, which are farther from it than rounding may move it.
std::vector<SuiteEdge> Neighbours(const SuiteEdge& edge, Rng& rng);

// What is left of light.
struct Filtered {
  Color diffuse, specular;
};
bool IsSame(const Filtered& a, const Filtered& b);  // bit by bit

// Edges as filters get them, with the light that they carry: white at first.
class EdgeBatch {
 public:
  EdgeBatch() = default;
  EdgeBatch(std::span<const SuiteEdge> edges, const Transform& placement, Rng& rng);

  size_t Size() const { return receivers.size(); }
  // Those of these indices, in that order.
  EdgeBatch Pick(std::span<const size_t> indices) const;
  // What the filter leaves of the light, asked in one call, and in a call for each edge.
  std::vector<Filtered> Filter(const LightFilter& filter, const FilterContext& context) const;
  Filtered FilterOne(size_t index, const LightFilter& filter, const FilterContext& context) const;
  // The edge in words.
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
