// A sound filter with a fault planted by a function, and counted.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "lights/filters/light_filter.h"

namespace lampyr::test {

class ForwardingFilter : public LightFilter {
 public:
  explicit ForwardingFilter(std::shared_ptr<const LightFilter> filter) : filter_(std::move(filter)) {}

  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    filter_->Filter(context, samples);
  }
  const std::vector<std::string>* GetProperty(FilterProperty property) const override {
    return filter_->GetProperty(property);
  }
  std::optional<float> GetRadianceModifier() const override { return filter_->GetRadianceModifier(); }
  bool IsIdentity() const override { return filter_->IsIdentity(); }

 protected:
  const LightFilter& Sound() const { return *filter_; }

 private:
  std::shared_ptr<const LightFilter> filter_;
};

// Empty functions leave the filter as it is.
struct FilterHooks {
  // After the sound filter has run.
  std::function<void(const FilterContext&, const FilterSamples&)> filtered;
  // In its place.
  std::function<void(const LightFilter& sound, const FilterContext&, const FilterSamples&)> instead;
  std::optional<float> modifier;
};

class PlantedFilter final : public ForwardingFilter {
 public:
  PlantedFilter(std::shared_ptr<const LightFilter> filter, FilterHooks hooks)
      : ForwardingFilter(std::move(filter)), hooks_(std::move(hooks)) {}

  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    if (hooks_.instead) return hooks_.instead(Sound(), context, samples);
    Sound().Filter(context, samples);
    if (hooks_.filtered) hooks_.filtered(context, samples);
  }
  std::optional<float> GetRadianceModifier() const override {
    return hooks_.modifier ? hooks_.modifier : Sound().GetRadianceModifier();
  }

 private:
  FilterHooks hooks_;
};

// Edges that were filtered.
inline std::atomic<uint64_t>& FilteredEdges() {
  static std::atomic<uint64_t> edges{0};
  return edges;
}

class CountedFilter final : public ForwardingFilter {
 public:
  using ForwardingFilter::ForwardingFilter;
  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    FilteredEdges().fetch_add(static_cast<uint64_t>(samples.count), std::memory_order_relaxed);
    Sound().Filter(context, samples);
  }
};

// The fault: a filter made from a correct one, or another reading of the parameters.
struct FilterPlanting {
  std::function<std::shared_ptr<const LightFilter>(std::shared_ptr<const LightFilter>)> filter;
  std::string ignored;  // a parameter that the filter does not look at; "": none
};

}  // namespace lampyr::test
