// The lights and light filters of a scene on the desk: faders, and parameters that may be edited.
#pragma once

#include <string>
#include <vector>

#include "render/build/editable_scene.h"

namespace lampyr {

// If more lights than this have no groups, some share a fader: each layer takes 48 bytes per pixel, 96 with light
// paths.
inline constexpr size_t kMostFaders = 32;

// Gives each light a group of its own if the scene has none, so that each has a layer; if there are more than
// kMostFaders, all but the first kMostFaders - 1 share one.
void GroupLights(SceneDescription& scene);

// One layer of the picture, and the statements whose light it is.
struct Fader {
  std::string layer, label;
  std::vector<size_t> statements;
  bool hasGlow = false;  // emission of media, which no light's parameters change
};
std::vector<Fader> FadersOf(const EditableScene& scene);

enum class ParameterControl { Number, Integer, Switch, Color, Text, None };

// A parameter of a statement, for the page.
struct ShownParameter {
  const ParameterInfo* info = nullptr;
  ParameterControl control = ParameterControl::None;  // None: shown, but edited in the scene's file alone
  std::vector<double> numbers;                        // of Number, Integer, Switch (0 or 1) and Color
  std::string text;                                   // of Text and None
  bool isGiven = false, isEdited = false;             // by the scene; on the desk
};
std::vector<ShownParameter> ShownParameters(const EditableScene& scene, size_t statement);

// "spot", or the name of the statement; and its location: "stage.pbrt:12".
std::string LabelOf(const EditableScene& scene, size_t statement);
std::string PlaceOf(const EditableScene& scene, size_t statement);

// The parameter with other values, as in a statement. Throws an Error if the desk cannot edit it, or if there are too
// many or too few values.
Parameter EditedParameter(const EditableScene& scene, size_t statement, const std::string& name,
                          const std::vector<double>& numbers, const std::string& text);

// The edits that set faders into the lights: their intensity is multiplied by the largest channel of the factor of
// their layer, and their colour by the rest. `factors`: by fader. Throws an Error if a light has no such parameters.
std::vector<StatementEdit> EditsOf(const EditableScene& scene, const std::vector<Fader>& faders,
                                   const std::vector<Color>& factors);

}  // namespace lampyr
