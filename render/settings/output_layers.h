// The layers that a render is asked for: those of light groups, and those by light path expressions, of the scene's
// Film and of the command line.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/output_plan.h"

namespace lampyr {

class LightingServices;

// Layers of what a pixel sees first, and of its samples; they hold no light (docs/layers.md).
struct PixelLayer {
  const char* name;
  std::vector<std::string> channels;
};
const std::vector<PixelLayer>& PixelLayers();
// Null: none of that name. Spaces, '-', '_' and capitals in names make no difference.
const PixelLayer* FindPixelLayer(const std::string& name);
inline constexpr const char* kSamplesLayer = "samples";
inline constexpr const char* kErrorLayer = "relative error";
inline constexpr const char* kBiasLayer = "bias";
// True for those of the samples of a pixel.
bool IsOfSamples(const PixelLayer& layer);
inline constexpr const char* kObjectMatte = "crypto object";
inline constexpr const char* kMaterialMatte = "crypto material";

// Name of a layer that stands for those of StrategyLayers.
inline constexpr const char* kStrategies = "strategies";

// Layers of what each technique (s,t) contributes where paths of both sides are connected: s vertices of a light
// subpath, t of a camera subpath ([Veach97 fig. 10.4]). There are two of each, "weighted.s2-t3" and "unweighted.s2-t3".
// The weighted ones add up to the picture; the others show where the weights hold noise back.
class StrategyLayers {
 public:
  // Techniques of paths with up to this many scattering events have layers of their own; those of longer paths share
  // two, "weighted.longer" and "unweighted.longer".
  static constexpr int kMostEvents = 6;

  // For paths of `maxDepth` events at most. `merges`: photons are merged, with the layers "weighted.merged" and
  // "unweighted.merged".
  StrategyLayers(int maxDepth, bool merges) : mostEvents_(std::min(maxDepth, kMostEvents)), merges_(merges) {}

  std::vector<std::string> Names() const;
  // Index in Names of the weighted layer of a technique, which the unweighted one follows.
  uint32_t Of(int s, int t) const;
  uint32_t OfMerging() const { return 2 * (Connecting() + 1); }

 private:
  // Techniques of paths with n events come after the 2 + 3 + … + (n + 1) of shorter paths.
  uint32_t Connecting() const { return static_cast<uint32_t>((mostEvents_ + 1) * (mostEvents_ + 4) / 2); }

  int mostEvents_;
  bool merges_;
};

struct LayerRequest {
  OutputLayer layer;
  FileLocation where;  // of the parameter of Film; empty: of the command line
};

// Reads NAME=EXPRESSION, the name of a known expression (NamedExpressions), or NAME=KNOWN; a known one may be followed
// by <L.'light'>, which leaves the paths from there. Throws a located Error; UsageError without a place.
LayerRequest ParseLayer(const std::string& text, const FileLocation& where = {});

// The plan of the layers of light groups, in their order, and then of those that were asked for. Throws as ParseLayer
// if two have the same name, or a light is named that the scene does not have.
std::shared_ptr<const OutputPlan> MakeOutputPlan(const LightingServices& lighting,
                                                 const std::vector<LayerRequest>& requests);

}  // namespace lampyr
