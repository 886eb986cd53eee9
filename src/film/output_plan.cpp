#include "film/output_plan.h"

#include <algorithm>
#include <bit>
#include <compare>

#include "base/error.h"

namespace lampyr {

namespace {

constexpr size_t kMostStates = 4096;  // of user expressions; those of light groups have a few for each
constexpr size_t kMostPairs = size_t{1} << 24;

}  // namespace

// Compiles the positions of all expressions together. One position for the camera precedes those of each expression.
class OutputPlan::Compiler {
  static constexpr uint32_t kWordBits = 64;

  // 64 positions of one expression, a bit each. Those of the next expression begin with a new word, so that sets are
  // sparse where there are many expressions and dense where there is a long one.
  struct Word {
    uint32_t index = 0;
    uint64_t bits = 0;
    auto operator<=>(const Word&) const = default;
  };
  using Set = std::vector<Word>;  // increasing, no word empty

  static void ForEachPosition(const Set& set, const auto& visit) {
    for (const Word& word : set) {
      for (uint64_t bits = word.bits; bits != 0; bits &= bits - 1)
        visit(word.index * kWordBits + static_cast<uint32_t>(std::countr_zero(bits)));
    }
  }

  // A set under construction.
  class Gathered {
   public:
    explicit Gathered(size_t words) : bits_(words) {}
    void Clear() {
      for (const uint32_t index : touched_) bits_[index] = 0;
      touched_.clear();
    }
    void Add(const Word& word) {
      if (bits_[word.index] == 0) touched_.push_back(word.index);
      bits_[word.index] |= word.bits;
    }
    void Add(const Set& set) {
      for (const Word& word : set) Add(word);
    }
    void Add(uint32_t position) { Add(Word{position / kWordBits, uint64_t{1} << position % kWordBits}); }
    uint64_t BitsOf(uint32_t index) const { return bits_[index]; }
    Set Whole() {
      std::sort(touched_.begin(), touched_.end());
      Set set;
      for (const uint32_t index : touched_) set.push_back({index, bits_[index]});
      return set;
    }

   private:
    std::vector<uint64_t> bits_;     // by word
    std::vector<uint32_t> touched_;  // words that are not empty
  };

 public:
  Compiler(OutputPlan& plan, const std::vector<LightSourceName>& lights)
      : plan_(plan), gathered_(CountWords(plan.layers_)) {
    const size_t words = CountWords(plan.layers_);
    layers_.reserve(words);
    matching_.reserve(words);
    next_.resize(words * kWordBits);
    before_.resize(words * kWordBits);
    for (uint32_t layer = 0; layer < plan.layers_.size(); ++layer) Collect(layer);
    for (uint32_t p = 0; p < next_.size(); ++p)
      ForEachPosition(next_[p], [&](uint32_t next) { Append(p, before_[next]); });
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
    const std::vector<Set>& All() const { return sets_; }

   private:
    std::map<Set, uint32_t> numbers_;
    std::vector<Set> sets_;
  };

  using Layers = std::vector<uint32_t>;  // increasing

  // A position at which paths of these sources may end.
  struct End {
    uint32_t position = 0;
    const LightSources* sources = nullptr;
  };

  static size_t WordsOf(const OutputLayer& layer) { return layer.expression.Positions().size() / kWordBits + 1; }
  static size_t CountWords(const std::vector<OutputLayer>& layers) {
    size_t words = 0;
    for (const OutputLayer& layer : layers) words += WordsOf(layer);
    return words;
  }

  // Adds a position behind those of a set.
  static void Append(uint32_t position, Set& set) {
    const uint32_t index = position / kWordBits;
    if (set.empty() || set.back().index != index) set.push_back({index, 0});
    set.back().bits |= uint64_t{1} << position % kWordBits;
  }

  void Collect(uint32_t layer) {
    const PathExpression& expression = plan_.layers_[layer].expression;
    const auto camera = static_cast<uint32_t>(layers_.size() * kWordBits), first = camera + 1;
    layers_.resize(layers_.size() + WordsOf(plan_.layers_[layer]), layer);
    matching_.resize(layers_.size());
    const auto setOf = [&](const std::vector<uint32_t>& positions) {
      Set set;
      for (const uint32_t p : positions) Append(first + p, set);
      return set;
    };
    Append(camera, cameras_);
    next_[camera] = setOf(expression.First());
    for (uint32_t i = 0; i < expression.Positions().size(); ++i) {
      const PathExpression::Position& position = expression.Positions()[i];
      const uint32_t p = first + i;
      next_[p] = setOf(position.next);
      for (size_t event = 0; event < kPathEvents; ++event) {
        if (position.events >> event & 1u) matching_[p / kWordBits][event] |= uint64_t{1} << p % kWordBits;
      }
    }
    for (const uint32_t last : expression.Last()) {
      const LightSources& sources = expression.Positions()[last].sources;
      const bool isGroup =
          !sources.isNegated && sources.terms.size() == 1 && sources.terms[0].kind == LightSources::Kind::InGroup;
      (isGroup ? endsOfGroups_[sources.terms[0].name] : ends_).push_back({first + last, &sources});
    }
  }

  // For each event, the positions that match it among the successors of `set` (`beyond`: successors of each position).
  std::array<Set, kPathEvents> Beyond(const Set& set, const std::vector<Set>& beyond) {
    gathered_.Clear();
    ForEachPosition(set, [&](uint32_t p) { gathered_.Add(beyond[p]); });
    std::array<Set, kPathEvents> found;
    for (const Word& word : gathered_.Whole()) {
      for (size_t event = 0; event < kPathEvents; ++event) {
        if (const uint64_t bits = word.bits & matching_[word.index][event]) found[event].push_back({word.index, bits});
      }
    }
    return found;
  }

  void Check(const States& states) const {
    if (states.Count() > kMostStates + 4 * plan_.layers_.size())
      throw Error("the expressions of layers need more than " + std::to_string(kMostStates) +
                  " states together: simplify them, or render some of them apart");
  }

  // A state is the set of positions that the path may have reached.
  void CompileFromCamera() {
    camera_.Of(cameras_);
    for (size_t state = 0; state < camera_.Count(); ++state) {
      Check(camera_);
      const Set set = camera_.At(state);
      const std::array<Set, kPathEvents> beyond = Beyond(set, next_);
      Next next;
      for (size_t event = 0; event < kPathEvents; ++event) next[event] = camera_.Of(beyond[event]);
      plan_.fromCamera_.push_back(next);
    }
  }

  // A state is the set of positions of the next symbol, as seen from the camera, from which the rest of the path
  // matches.
  void CompileFromLight(const std::vector<LightSourceName>& lights) {
    std::map<std::pair<std::string, std::string>, uint32_t> known;  // by name and group
    const auto startOf = [&](const LightSourceName& source) {
      gathered_.Clear();
      if (const auto ofGroup = endsOfGroups_.find(source.group); ofGroup != endsOfGroups_.end()) {
        for (const End& end : ofGroup->second) gathered_.Add(end.position);
      }
      for (const End& end : ends_) {
        if (end.sources->Has(source)) gathered_.Add(end.position);
      }
      return light_.Of(gathered_.Whole());
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
      const std::array<Set, kPathEvents> beyond = Beyond(set, before_);
      Next next;
      for (size_t event = 0; event < kPathEvents; ++event) next[event] = light_.Of(beyond[event]);
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
    std::map<Layers, std::pair<uint32_t, uint32_t>> lists;
    for (const Set& camera : camera_.All()) {
      gathered_.Clear();
      ForEachPosition(camera, [&](uint32_t p) { gathered_.Add(next_[p]); });
      for (const Set& light : light_.All()) {
        Layers layers;
        for (const Word& word : light) {
          const uint32_t layer = layers_[word.index];
          if (!layers.empty() && layers.back() == layer) continue;
          if (word.bits & gathered_.BitsOf(word.index)) layers.push_back(layer);
        }
        plan_.met_.push_back(ListOf(layers, lists));
      }
    }
  }
  std::pair<uint32_t, uint32_t> ListOf(const Layers& layers, std::map<Layers, std::pair<uint32_t, uint32_t>>& lists) {
    const auto [found, isNew] = lists.emplace(layers, std::pair(0u, 0u));
    if (isNew) {
      found->second.first = static_cast<uint32_t>(plan_.lists_.size());
      plan_.lists_.insert(plan_.lists_.end(), layers.begin(), layers.end());
      found->second.second = static_cast<uint32_t>(plan_.lists_.size());
    }
    return found->second;
  }

  OutputPlan& plan_;
  std::vector<uint32_t> layers_;                             // by word of positions
  std::vector<std::array<uint64_t, kPathEvents>> matching_;  // by word: the positions that match each event
  std::vector<Set> next_, before_;                           // by position: those that may come after, and before
  Set cameras_;
  std::vector<End> ends_;                                 // without those of expressions of a light group
  std::map<std::string, std::vector<End>> endsOfGroups_;  // those
  States camera_, light_;
  Gathered gathered_;
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
