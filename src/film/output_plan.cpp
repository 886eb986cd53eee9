#include "film/output_plan.h"

#include <algorithm>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr size_t kMostStates = 4096;  // of user expressions; those of light groups have a few for each
constexpr size_t kMostPairs = size_t{1} << 24;

using Set = std::vector<uint32_t>;  // of positions, increasing

void Sort(Set& set) {
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

}  // namespace

// The positions of all expressions together. Before those of each expression stands one for the camera.
class OutputPlan::Compiler {
 public:
  Compiler(OutputPlan& plan, const std::vector<LightSourceName>& lights) : plan_(plan) {
    for (uint32_t layer = 0; layer < plan.layers_.size(); ++layer) Collect(layer);
    before_.resize(positions_.size());
    for (uint32_t p = 0; p < positions_.size(); ++p) {
      for (const uint32_t next : positions_[p].next) before_[next].push_back(p);
    }
    CompileFromCamera();
    CompileFromLight(lights);
    Meet();
  }

 private:
  // States by their sets of positions.
  class States {
   public:
    uint32_t Of(const Set& set) {
      const auto [found, isNew] = numbers_.emplace(set, static_cast<uint32_t>(sets_.size()));
      if (isNew) sets_.push_back(set);
      return found->second;
    }
    size_t Count() const { return sets_.size(); }
    Set At(size_t state) const { return sets_[state]; }

   private:
    std::map<Set, uint32_t> numbers_;
    std::vector<Set> sets_;
  };

  struct Position {
    uint32_t layer = 0;
    uint8_t events = 0;
    const LightSources* sources = nullptr;  // of those at which paths may end
    Set next;
  };

  void Collect(uint32_t layer) {
    const PathExpression& expression = plan_.layers_[layer].expression;
    const auto camera = static_cast<uint32_t>(positions_.size()), first = camera + 1;
    const auto moved = [&](Set set) {
      for (uint32_t& p : set) p += first;
      return set;
    };
    cameras_.push_back(camera);
    positions_.push_back({layer, 0, nullptr, moved(expression.First())});
    for (const PathExpression::Position& position : expression.Positions())
      positions_.push_back({layer, position.events, nullptr, moved(position.next)});
    for (const uint32_t last : expression.Last()) {
      const LightSources& sources = expression.Positions()[last].sources;
      const bool isGroup =
          !sources.isNegated && sources.terms.size() == 1 && sources.terms[0].kind == LightSources::Kind::InGroup;
      (isGroup ? endsOfGroups_[sources.terms[0].name] : ends_).push_back(first + last);
      positions_[first + last].sources = &sources;
    }
  }

  // The positions beyond those of `set`, `beyond` of each, that match the event.
  Set Beyond(const Set& set, size_t event, const auto& beyond) const {
    Set all;
    for (const uint32_t p : set) {
      for (const uint32_t other : beyond(p)) {
        if (positions_[other].events >> event & 1u) all.push_back(other);
      }
    }
    Sort(all);
    return all;
  }

  void Check(const States& states) const {
    if (states.Count() > kMostStates + 4 * plan_.layers_.size())
      throw Error("the expressions of layers need more than " + std::to_string(kMostStates) +
                  " states together: simplify them, or render some of them apart");
  }

  // State: the positions that the path may be at.
  void CompileFromCamera() {
    camera_.Of(cameras_);
    for (size_t state = 0; state < camera_.Count(); ++state) {
      Check(camera_);
      const Set set = camera_.At(state);
      Next next;
      for (size_t event = 0; event < kPathEvents; ++event)
        next[event] = camera_.Of(Beyond(set, event, [&](uint32_t p) -> const Set& { return positions_[p].next; }));
      plan_.fromCamera_.push_back(next);
    }
  }

  // State: the positions of the next symbol, as seen from the camera, from where the rest of the path may be matched.
  void CompileFromLight(const std::vector<LightSourceName>& lights) {
    std::map<std::pair<std::string, std::string>, uint32_t> known;  // by name and group
    const auto startOf = [&](const LightSourceName& source) {
      const auto ofGroup = endsOfGroups_.find(source.group);
      Set ends = ofGroup != endsOfGroups_.end() ? ofGroup->second : Set();
      for (const uint32_t p : ends_) {
        if (positions_[p].sources->Has(source)) ends.push_back(p);
      }
      Sort(ends);
      return light_.Of(ends);
    };
    for (const LightSourceName& light : lights) {
      const auto [found, isNew] = known.emplace(std::pair(light.name, light.group), 0);
      if (isNew) found->second = startOf(light);
      plan_.ofLight_.push_back(found->second);
    }
    plan_.ofMedia_ = startOf({"", "", true});
    for (size_t state = 0; state < light_.Count(); ++state) {
      Check(light_);
      const Set set = light_.At(state);
      Next next;
      for (size_t event = 0; event < kPathEvents; ++event)
        next[event] = light_.Of(Beyond(set, event, [&](uint32_t p) -> const Set& { return before_[p]; }));
      plan_.fromLight_.push_back(next);
    }
  }

  // The layers of each pair of states.
  void Meet() {
    const size_t pairs = camera_.Count() * light_.Count();
    if (pairs > kMostPairs)
      throw Error(
          "the expressions of layers need too many states together: simplify them, or render some of them apart");
    plan_.met_.reserve(pairs);
    std::map<Set, std::pair<uint32_t, uint32_t>> lists;
    std::vector<bool> isAt(positions_.size());
    for (size_t camera = 0; camera < camera_.Count(); ++camera) {
      const Set at = camera_.At(camera);
      for (const uint32_t p : at) isAt[p] = true;
      for (size_t light = 0; light < light_.Count(); ++light) {
        Set layers;
        for (const uint32_t next : light_.At(light)) {
          const Set& before = before_[next];
          if (std::any_of(before.begin(), before.end(), [&](uint32_t p) { return isAt[p]; }))
            layers.push_back(positions_[next].layer);
        }
        Sort(layers);
        plan_.met_.push_back(ListOf(layers, lists));
      }
      for (const uint32_t p : at) isAt[p] = false;
    }
  }
  std::pair<uint32_t, uint32_t> ListOf(const Set& layers, std::map<Set, std::pair<uint32_t, uint32_t>>& lists) {
    const auto [found, isNew] = lists.emplace(layers, std::pair(0u, 0u));
    if (isNew) {
      found->second.first = static_cast<uint32_t>(plan_.lists_.size());
      plan_.lists_.insert(plan_.lists_.end(), layers.begin(), layers.end());
      found->second.second = static_cast<uint32_t>(plan_.lists_.size());
    }
    return found->second;
  }

  OutputPlan& plan_;
  std::vector<Position> positions_;
  std::vector<Set> before_;                  // by position: those that it may come after
  Set cameras_, ends_;                       // without the ends of expressions of a light group
  std::map<std::string, Set> endsOfGroups_;  // of those
  States camera_, light_;
};

OutputPlan::OutputPlan(std::vector<OutputLayer> layers, const std::vector<LightSourceName>& lights)
    : layers_(std::move(layers)) {
  if (!layers_.empty()) Compiler(*this, lights);
}

std::vector<std::string> OutputPlan::Names() const {
  std::vector<std::string> names;
  for (const OutputLayer& layer : layers_) names.push_back(layer.name);
  return names;
}

}  // namespace lampyr
