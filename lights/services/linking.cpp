#include "lights/services/linking.h"

#include <algorithm>
#include <set>

#include "lights/filters/filter_base.h"
#include "scene/limits.h"

namespace lampyr {

namespace {

std::vector<std::string> ReadSorted(const ParameterList* parameters, const char* name) {
  if (!parameters) return {};
  std::vector<std::string> names = ReadNames(*parameters, name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

bool Has(const std::vector<std::string>& sorted, const std::string& name) {
  return std::binary_search(sorted.begin(), sorted.end(), name);
}

void WarnOfUnknown(const std::vector<std::string>& names, const FileLocation& where, const std::string& what,
                   const std::set<std::string>& known, Diagnostics& diagnostics) {
  // Every unknown name is compared with all known ones, in quadratic time.
  const bool suggests = known.size() <= limits::kSuggestedNames;
  for (const std::string& name : names) {
    if (known.contains(name)) continue;
    const std::string hint = suggests ? DidYouMean(name, {known.begin(), known.end()}) : "";
    diagnostics.Warn(where, "there is no " + what + " \"" + name + "\"" + hint);
  }
}

// Limit of the size of a linking table, rows times columns: a short file can ask for a table that exceeds any memory.
void CheckTable(size_t rows, size_t columns, const FileLocation& where) {
  if (rows <= limits::kLinks / std::max(columns, size_t{1})) return;
  throw Error(where, "the attributes \"lighting\" and \"lightfilter\" make " + std::to_string(rows) +
                         " classes of surfaces, and tell " + std::to_string(columns) +
                         " lights or filters apart: their product is more than " + std::to_string(limits::kLinks));
}

}  // namespace

LightLinking::LightLinking() : classes_(1), classIndex_{{ClassNames(), 0}}, filterGroups_(1) {}

uint32_t LightLinking::ClassOf(const ParameterList* lighting, const ParameterList* lightFilter) {
  Class wanted;
  wanted.lights = ReadSorted(lighting, "subset");
  wanted.withoutLights = ReadSorted(lighting, "excludesubset");
  wanted.filterGroups = ReadSorted(lightFilter, "subset");
  if (lighting) wanted.whereLights = lighting->WhereOf("subset");
  if (lighting) wanted.whereWithout = lighting->WhereOf("excludesubset");
  if (lightFilter) wanted.whereGroups = lightFilter->WhereOf("subset");
  const auto [entry, isNew] = classIndex_.emplace(ClassNames{wanted.lights, wanted.withoutLights, wanted.filterGroups},
                                                  static_cast<uint32_t>(classes_.size()));
  if (isNew) classes_.push_back(std::move(wanted));
  return entry->second;
}

uint32_t LightLinking::FilterKey(const std::vector<std::string>& groups) {
  std::vector<std::string> sorted = groups;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return 0;
  const auto [entry, isNew] = filterKeys_.emplace(sorted, static_cast<uint32_t>(filterGroups_.size()));
  if (isNew) filterGroups_.push_back(std::move(sorted));
  return entry->second;
}

int32_t LightLinking::Add(FilterInstance filter) {
  filters_.push_back(std::move(filter));
  return static_cast<int32_t>(filters_.size()) - 1;
}

// Lights are distinguished only by names that some class mentions, so that the table is small for any number of lights.
void LightLinking::FinishLights(std::span<const PlacedLight> lights, Diagnostics& diagnostics) {
  std::set<std::string> mentioned, known;
  for (const Class& c : classes_) {
    mentioned.insert(c.lights.begin(), c.lights.end());
    mentioned.insert(c.withoutLights.begin(), c.withoutLights.end());
  }
  excludes_ = !mentioned.empty();
  if (!excludes_) return;
  using Key = std::pair<std::string, std::string>;
  std::map<Key, uint32_t> keys;
  for (const PlacedLight& placed : lights) {
    const LightSettings& settings = placed.light->Settings();
    for (const std::string& name : {settings.name, settings.lightGroup}) {
      if (!name.empty()) known.insert(name);
    }
    const Key key(mentioned.contains(settings.name) ? settings.name : "",
                  mentioned.contains(settings.lightGroup) ? settings.lightGroup : "");
    lightKey_.push_back(keys.emplace(key, static_cast<uint32_t>(keys.size())).first->second);
  }
  lightKeys_ = keys.size();
  CheckTable(classes_.size(), lightKeys_, WhereOf(classes_.back()));
  lit_.resize(classes_.size() * lightKeys_);
  for (size_t i = 0; i < classes_.size(); ++i) {
    const Class& c = classes_[i];
    WarnOfUnknown(c.lights, c.whereLights, "light or light group", known, diagnostics);
    WarnOfUnknown(c.withoutLights, c.whereWithout, "light or light group", known, diagnostics);
    for (const auto& [key, index] : keys) {
      const bool isNamed = c.lights.empty() || Has(c.lights, key.first) || Has(c.lights, key.second);
      const bool isLit = isNamed && !Has(c.withoutLights, key.first) && !Has(c.withoutLights, key.second);
      lit_[i * lightKeys_ + index] = isLit ? 1 : 0;
    }
  }
}

FileLocation LightLinking::WhereOf(const Class& c) {
  for (const FileLocation& where : {c.whereLights, c.whereWithout, c.whereGroups}) {
    if (where.file) return where;
  }
  return {};
}

void LightLinking::FinishFilters(Diagnostics& diagnostics) {
  std::set<std::string> known;
  for (const auto& groups : filterGroups_) known.insert(groups.begin(), groups.end());
  CheckTable(classes_.size(), filterGroups_.size(), WhereOf(classes_.back()));
  enabled_.resize(classes_.size() * filterGroups_.size());
  for (size_t i = 0; i < classes_.size(); ++i) {
    const Class& c = classes_[i];
    WarnOfUnknown(c.filterGroups, c.whereGroups, "filter in the group", known, diagnostics);
    for (size_t key = 0; key < filterGroups_.size(); ++key) {
      const auto& groups = filterGroups_[key];
      const bool subscribes = std::any_of(groups.begin(), groups.end(),
                                          [&](const std::string& group) { return Has(c.filterGroups, group); });
      enabled_[i * filterGroups_.size() + key] = groups.empty() || subscribes ? 1 : 0;
    }
  }
}

void LightLinking::Finish(std::span<const PlacedLight> lights, Diagnostics& diagnostics) {
  FinishLights(lights, diagnostics);
  FinishFilters(diagnostics);
  hasFilters_ = std::any_of(lights.begin(), lights.end(), [](const PlacedLight& light) { return light.filter >= 0; });
}

LightSets LightLinking::Sets() const {
  LightSets sets;
  if (!excludes_) return sets;
  std::map<std::string, uint32_t> known;
  size_t listed = 0;
  for (size_t i = 0; i < classes_.size(); ++i) {
    const auto row = lit_.begin() + static_cast<std::ptrdiff_t>(i * lightKeys_);
    const std::string lit(row, row + static_cast<std::ptrdiff_t>(lightKeys_));
    const auto [entry, isNew] = known.emplace(lit, static_cast<uint32_t>(sets.lights.size()));
    sets.ofClass.push_back(entry->second);
    if (!isNew) continue;
    std::vector<uint32_t>& members = sets.lights.emplace_back();
    for (uint32_t light = 0; light < lightKey_.size(); ++light) {
      if (lit[lightKey_[light]]) members.push_back(light);
    }
    listed += members.size();
    if (listed > limits::kLinks) {
      throw Error(WhereOf(classes_[i]), "the sets of lights that surfaces are linked to have more than " +
                                            std::to_string(limits::kLinks) + " members in all");
    }
  }
  return sets;
}

}  // namespace lampyr
