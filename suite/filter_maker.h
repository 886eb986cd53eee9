// Makes the filters under test: a sample block with overriding parameters, at any placement. Besides the images of
// suite_inputs.h a sample block of a filter that runs others may name these filters:
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

// The filter `name` of the list above. Throws an Error at `where` for any other name.
FilterInstance FindSuiteFilter(const std::string& name, const FilterBuildContext& build, const FileLocation& where);

// Scene statements that declare all of them by name.
std::string SuiteFilterStatements();

// Makes filters from one sample block. For use by one thread.
class FilterMaker {
 public:
  FilterMaker(const FilterType& type, std::string block, const std::filesystem::path& folder)
      : type_(type), block_(std::move(block)), folder_(folder) {}

  const FilterType& Type() const { return type_; }
  // True if the type's parameter table has `parameter`. All built-in filters have the common ones.
  bool Has(const std::string& parameter) const;
  // The block's parameters overridden by `changes`, line by line; a later line takes precedence over those above it.
  ParameterList Parameters(const std::string& changes) const;

  std::shared_ptr<const LightFilter> Make(const std::string& changes, const Transform& placement) const;
  // A moving filter; its placement at shutter open is the first of the motion.
  std::shared_ptr<const LightFilter> MakeMoving(const std::string& changes,
                                                const std::shared_ptr<const Motion>& motion) const;
  // The filter with its combineMode, as a scene holds it.
  FilterInstance MakeInstance(const std::string& changes, const Transform& placement) const;
  // Placed by scene text: the statement stands elsewhere and names `placement` as its coordinate system.
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
