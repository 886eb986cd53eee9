// The layers that a render is asked for: those of light groups, and those by light path expressions, of the scene's
// Film and of the command line.
#pragma once

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
