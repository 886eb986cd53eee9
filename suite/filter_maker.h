// Makes the filters that the suite asks: a sample block with changes laid over it, at any place. What a sample block
// may name beside the images of suite_inputs.h are these filters, for those that run others:
//
//   suite-slot   barn, taken as maximum     suite-ball   blocker, taken as screen
//   suite-fade   ramp, taken as minimum     suite-tint   intmult, multiplied
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "lights/filters/filter_type.h"
#include "math/transform.h"
#include "textures/texture_library.h"

namespace lampyr::suite {

// The filter of that name, of those above. Throws an Error at `where` for any other.
FilterInstance FindSuiteFilter(const std::string& name, const FilterBuildContext& build, const FileLocation& where);

// All of them as a scene has them: statements, with their names.
std::string SuiteFilterStatements();

// Of one sample block. For one thread.
class FilterMaker {
 public:
  FilterMaker(const FilterType& type, std::string block, const std::filesystem::path& folder)
      : type_(type), block_(std::move(block)), folder_(folder) {}

  const FilterType& Type() const { return type_; }
  // Whether the type's table has a parameter of that name, as all built-in filters have it.
  bool Has(const std::string& parameter) const;
  // The block's parameters with `changes` laid over them, line by line: a later one goes before those above it.
  ParameterList Parameters(const std::string& changes) const;

  std::shared_ptr<const LightFilter> Make(const std::string& changes, const Transform& placement) const;
  // One that moves; its place at shutter open is the motion's first.
  std::shared_ptr<const LightFilter> MakeMoving(const std::string& changes,
                                                const std::shared_ptr<const Motion>& motion) const;
  // As a scene holds it: with how combiners take it.
  FilterInstance MakeInstance(const std::string& changes, const Transform& placement) const;
  // Placed by a scene's text, in which it stands elsewhere and names `placement` as its coordinate system.
  std::shared_ptr<const LightFilter> MakeByName(const std::string& changes, const Transform& placement) const;

 private:
  ParameterList ParametersOf(const std::string& text) const;
  std::shared_ptr<const LightFilter> MakeFrom(const ParameterList& parameters, const LightTransform& placed,
                                              std::shared_ptr<const Motion> motion) const;

  const FilterType& type_;
  std::string block_;
  std::filesystem::path folder_;
  mutable Diagnostics diagnostics_{Diagnostics::Mode::Collect};
  TextureLibrary textures_{{}, Transform(), diagnostics_};
};

LightTransform PlacedBy(const Transform& placement);

}  // namespace lampyr::suite
