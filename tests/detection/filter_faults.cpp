// The table of wrong filters.
#include <limits>

#include "detection/faults.h"
#include "detection/subjects.h"

namespace lampyr::test {

namespace {

FilterPlanting Hooked(const FilterHooks& hooks) {
  return {[hooks](std::shared_ptr<const LightFilter> filter) -> std::shared_ptr<const LightFilter> {
            return std::make_shared<PlantedFilter>(std::move(filter), hooks);
          },
          ""};
}

using OnEdge = std::function<void(const FilterContext&, const FilterSamples&, int i)>;
FilterPlanting AfterEach(const OnEdge& change) {
  FilterHooks hooks;
  hooks.filtered = [change](const FilterContext& context, const FilterSamples& samples) {
    for (int i = 0; i < samples.count; ++i) change(context, samples, i);
  };
  return Hooked(hooks);
}

std::vector<FilterFault> MakeFilterFaults() {
  std::vector<FilterFault> faults;
  const auto add = [&](const std::string& name, const std::string& subject, FilterPlanting planting,
                       const std::string& what) {
    faults.push_back({name, subject, what, std::move(planting), ""});
  };
  add("filter-negative", "blocker", AfterEach([](const FilterContext&, const FilterSamples& s, int i) {
        s.diffuse[i] = s.diffuse[i] - Color(0.02f) * s.diffuse[i].Max() - Color(1e-3f);
      }),
      "what is left of light is a little below 0 in shadow");
  add("filter-nan-at-one-place", "ramp", AfterEach([](const FilterContext&, const FilterSamples& s, int i) {
        if (s.toLight[i].x > 0.97f) s.specular[i].b = std::numeric_limits<float>::quiet_NaN();
      }),
      "NaN for directions along one axis");
  add("filter-of-time", "intmult", AfterEach([](const FilterContext& context, const FilterSamples& s, int i) {
        s.diffuse[i] *= 1 + 0.5f * context.time;
      }),
      "a filter that stays depends on the shutter time");
  add("filter-first-of-batch", "barn", AfterEach([](const FilterContext&, const FilterSamples& s, int i) {
        if (i == 3) s.diffuse[i] *= 1.5f;
      }),
      "the fourth edge of a batch is brighter");

  add(
      "filter-batch-shares-factor", "ramp",
      [] {
        FilterHooks hooks;
        hooks.instead = [](const LightFilter& sound, const FilterContext& context, const FilterSamples& samples) {
          // Each edge gets the distance of the batch's first.
          for (int i = 0; i < samples.count; ++i) {
            FilterSamples one = samples.Part(i, 1);
            one.receiver = samples.receiver;
            sound.Filter(context, one);
          }
        };
        return Hooked(hooks);
      }(),
      "all edges of a batch are filtered as if they ended at the first one's receiver");

  add(
      "filter-every-other-call", "intmult",
      [] {
        const auto calls = std::make_shared<std::atomic<uint64_t>>(0);
        return AfterEach([calls](const FilterContext&, const FilterSamples& s, int i) {
          s.specular[i] *= calls->fetch_add(1) % 2 == 0 ? 1.1f : 0.9f;
        });
      }(),
      "every other edge is brighter, the mean being right");
  faults.push_back(
      {"filter-density-ignored", "blocker", "the density is not looked at", {{}, "density"}, "\"float density\" 0.5 "});
  faults.push_back(
      {"filter-invert-ignored", "barn", "invert is not looked at", {{}, "invert"}, "\"bool invert\" true "});
  faults.push_back({"filter-diffuse-ignored",
                    "ramp",
                    "the strength for diffuse lobes is not looked at",
                    {{}, "diffuse"},
                    "\"float diffuse\" 0.3 "});
  add(
      "filter-modifier-0", "blocker",
      [] {
        FilterHooks hooks;
        hooks.modifier = 0.0f;
        return Hooked(hooks);
      }(),
      "GetRadianceModifier says that nothing gets through");
  add("filter-of-pdf", "intmult", AfterEach([](const FilterContext&, const FilterSamples& s, int i) {
        s.diffuse[i] *= 1 + 0.1f / (1 + s.pdfDirect[i].value);
      }),
      "the factor depends on the density of the light's sampling");
  add("filter-only-where-bright", "barn", AfterEach([](const FilterContext&, const FilterSamples& s, int i) {
        if (s.diffuse[i].Max() < 1e-2f) s.diffuse[i] = Color(0.0f);
      }),
      "what is dark is taken to be black");
  add("filter-lobes-swapped", "intmult",
      AfterEach([](const FilterContext&, const FilterSamples& s, int i) { std::swap(s.diffuse[i], s.specular[i]); }),
      "diffuse and specular are exchanged");
  add(
      "filter-infinite-as-near", "blocker",
      [] {
        FilterHooks hooks;
        hooks.instead = [](const LightFilter& sound, const FilterContext& context, const FilterSamples& samples) {
          for (int i = 0; i < samples.count; ++i) {
            if (samples.distance[i] < std::numeric_limits<float>::max()) sound.Filter(context, samples.Part(i, 1));
          }
        };
        return Hooked(hooks);
      }(),
      "light from infinity is not filtered");
  return faults;
}

}  // namespace

const std::vector<FilterFault>& FilterFaults() {
  static const std::vector<FilterFault> faults = MakeFilterFaults();
  return faults;
}

}  // namespace lampyr::test
