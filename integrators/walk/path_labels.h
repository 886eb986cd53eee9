// Labels of paths, for layers by light path expressions (film/output_plan.h).
//
// A vertex may scatter by a diffuse and by a glossy lobe at once, and the path then belongs to both expressions in
// part. So a subpath carries several states of the automaton, each with its share of the throughput. The shares are
// exact, and the picture does not depend on them.
#pragma once

#include <span>
#include <vector>

#include "film/output_plan.h"
#include "materials/scattering.h"
#include "math/vec.h"

namespace lampyr {

struct Vertex;  // vertex.h

// A state of a subpath, and the share of the throughput that has it.
struct PathLabel {
  uint32_t state = 0;
  Color share{1.0f};
};

class PathLabels {
 public:
  void Set(uint32_t state) { all_.assign(1, {state, Color(1.0f)}); }
  void Clear() { all_.clear(); }
  void Add(uint32_t state, const Color& share);
  std::span<const PathLabel> All() const { return all_; }

 private:
  std::vector<PathLabel> all_;
};

// A scattering event, and what either kind of lobe scatters, up to a common factor.
struct ScatteringParts {
  PathEvent ofDiffuse = PathEvent::DiffuseReflection, ofSpecular = PathEvent::SpecularReflection;
  Color diffuse, specular;
};
// The event between the previous vertex and `direction`.
ScatteringParts PartsOf(const Vertex& vertex, const Vector3& direction, bool isDelta, const Color& diffuse,
                        const Color& specular);

// The labels after an event of those that arrived at its vertex. `mode`: Radiance for camera subpaths, Importance for
// light subpaths.
void LabelsAfter(const OutputPlan& plan, TransportMode mode, std::span<const PathLabel> arrived,
                 const ScatteringParts& event, PathLabels& after);

// A layer's share of a path.
struct LayerShare {
  uint32_t layer = 0;
  Color share{1.0f};
};
// The layers of a path whose subpaths have these labels. A layer may occur more than once. Valid until the next call in
// the thread.
std::span<const LayerShare> SharesOf(const OutputPlan& plan, std::span<const PathLabel> camera,
                                     std::span<const PathLabel> light);

}  // namespace lampyr
