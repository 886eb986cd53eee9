#include "suite/filter_maker.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "lights/filters/filter_base.h"
#include "lights/light_base.h"
#include "scene/scene_description.h"

namespace lampyr::suite {

namespace {

struct NamedFilter {
  const char *name, *type, *parameters;
};
constexpr NamedFilter kNamed[] = {
    {"suite-slot", "barn",
     "\"float width\" 1.2 \"float edge\" 0.4 \"string combineMode\" \"max\" \"float density\" 0.9"},
    {"suite-fade", "ramp", "\"float begin\" 0.5 \"float end\" 4 \"string combineMode\" \"min\""},
    {"suite-ball", "blocker",
     "\"float radius\" 1 \"float edge\" 1 \"rgb color\" [ 0.5 0.2 0.1 ] \"string combineMode\" \"screen\""},
    {"suite-tint", "intmult", "\"rgb tint\" [ 0.4 0.7 0.9 ] \"float intensity\" 1.25"},
};

SceneDescription Parse(const std::string& text, const std::filesystem::path& folder, Diagnostics& diagnostics) {
  return ParseScene("WorldBegin\n" + text + "\n", folder / "suite.pbrt", diagnostics);
}

std::string Statement(const std::string& type, const std::string& parameters) {
  return "LightFilter \"" + type + "\" " + parameters;
}

// A Transform statement, which takes the matrix column by column.
std::string Write(const Transform& transform) {
  std::string text = "Transform [";
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      char number[32];
      std::snprintf(number, sizeof number, " %.17g", transform.Matrix()[column][row]);
      text += number;
    }
  }
  return text + " ]";
}

}  // namespace

LightTransform PlacedBy(const Transform& placement) {
  return {placement.ToAffine(), placement.Inverse().ToAffine()};
}

FilterInstance FindSuiteFilter(const std::string& name, const FilterBuildContext& build, const FileLocation& where) {
  const auto named = std::find_if(std::begin(kNamed), std::end(kNamed),
                                  [&](const NamedFilter& filter) { return filter.name == name; });
  if (named == std::end(kNamed)) {
    std::vector<std::string> names;
    for (const NamedFilter& filter : kNamed) names.emplace_back(filter.name);
    throw Error(where, "the suite has no filter \"" + name + "\"" + DidYouMean(name, names));
  }
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const SceneDescription scene = Parse(Statement(named->type, named->parameters), ".", diagnostics);
  const ParameterList& parameters = scene.lightFilters.at(0).filter.parameters;
  FilterInstance instance;
  instance.filter = MakeFilter(*FindFilterType(named->type), parameters, build);
  instance.name = name;
  instance.combineMode = ReadCombineMode(parameters, "combineMode");
  return instance;
}

std::string SuiteFilterStatements() {
  std::string text;
  for (const NamedFilter& filter : kNamed) {
    text += Statement(filter.type, std::string("\"string name\" \"") + filter.name + "\" " + filter.parameters) + "\n";
  }
  return text;
}

bool FilterMaker::Has(const std::string& parameter) const {
  return std::any_of(type_.parameters.begin(), type_.parameters.end(),
                     [&](const ParameterInfo& info) { return info.name == parameter; });
}

ParameterList FilterMaker::ParametersOf(const std::string& text) const {
  return Parse(Statement(type_.name, text), folder_, diagnostics_).lightFilters.at(0).filter.parameters;
}

ParameterList FilterMaker::Parameters(const std::string& changes) const {
  ParameterList parameters = ParametersOf(block_);
  std::istringstream lines(changes);
  for (std::string line; std::getline(lines, line);) parameters = MergeParameters(parameters, ParametersOf(line));
  return parameters;
}

std::shared_ptr<const LightFilter> FilterMaker::MakeFrom(const ParameterList& parameters, const LightTransform& placed,
                                                         std::shared_ptr<const Motion> motion) const {
  FilterBuildContext build;
  build.transform = placed;
  build.motion = std::move(motion);
  build.textures = &textures_;
  build.diagnostics = &diagnostics_;
  build.find = [&](const std::string& name, const FileLocation& where) { return FindSuiteFilter(name, build, where); };
  return MakeFilter(type_, parameters, build);
}

std::shared_ptr<const LightFilter> FilterMaker::Make(const std::string& changes, const Transform& placement) const {
  return MakeFrom(Parameters(changes), PlacedBy(placement), nullptr);
}

std::shared_ptr<const LightFilter> FilterMaker::MakeMoving(const std::string& changes,
                                                           const std::shared_ptr<const Motion>& motion) const {
  const Affine open = motion->At(0);
  return MakeFrom(Parameters(changes), {open, open.Inverse()}, motion);
}

FilterInstance FilterMaker::MakeInstance(const std::string& changes, const Transform& placement) const {
  const ParameterList parameters = Parameters(changes);
  FilterInstance instance;
  instance.filter = MakeFrom(parameters, PlacedBy(placement), nullptr);
  instance.combineMode = ReadCombineMode(parameters, "combineMode");
  return instance;
}

std::shared_ptr<const LightFilter> FilterMaker::MakeByName(const std::string& changes,
                                                           const Transform& placement) const {
  const std::string text = "AttributeBegin " + Write(placement) +
                           " CoordinateSystem \"suite\" AttributeEnd\nRotate 70 1 0 1 Translate 5 -3 2\n" +
                           Statement(type_.name, "\"string coordsys\" \"suite\"");
  const LightFilterDescription description = Parse(text, folder_, diagnostics_).lightFilters.at(0);
  const ParameterList parameters = MergeParameters(Parameters(changes), description.filter.parameters);
  return MakeFrom(parameters, PlacedBy(description.placement.start), nullptr);
}

}  // namespace lampyr::suite
