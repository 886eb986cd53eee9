// Time to select a light, and to evaluate the probability of a selection, among 1 … 10⁶; and to build the selector.
#include <benchmark/benchmark.h>

#include <cmath>

#include "lights/selection/light_tree.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

std::vector<ClusterBounds> SmallSquares(size_t count) {
  Rng rng(1);
  std::vector<ClusterBounds> emitters(count);
  for (ClusterBounds& emitter : emitters) {
    const Point3 center(rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f);
    emitter.box.Add(center);
    emitter.box.Add(center + 0.001f * SampleUniformSphere(rng.NextPoint2()));
    emitter.axis = SampleUniformSphere(rng.NextPoint2());
    emitter.cosThetaE = 0;
    emitter.meanNormal = emitter.axis;
    emitter.FillBox();
    emitter.intensity = std::exp(3 * rng.NextFloat()) / static_cast<float>(count);
  }
  return emitters;
}

std::vector<TreeReceiver> Receivers() {
  Rng rng(2);
  std::vector<TreeReceiver> receivers(4096);
  for (TreeReceiver& receiver : receivers) {
    receiver.position = Point3(rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f);
    receiver.normal = SampleUniformSphere(rng.NextPoint2());
  }
  return receivers;
}

EmitterChoice Select(const LightTree& tree, const TreeReceiver& receiver, double u, bool defensive) {
  LightTree::Cut cut;
  tree.Look(receiver, cut);
  return tree.Select(receiver, cut, u, defensive);
}
EmitterProbability ProbabilityOf(const LightTree& tree, const TreeReceiver& receiver, uint32_t emitter) {
  LightTree::Cut cut;
  tree.Look(receiver, cut);
  return tree.ProbabilityOf(receiver, cut, emitter);
}

void Select(benchmark::State& state) {
  const LightTree tree(SmallSquares(static_cast<size_t>(state.range(0))), 2);
  const auto receivers = Receivers();
  Rng rng(3);
  size_t i = 0;
  for (auto _ : state) {
    const TreeReceiver& receiver = receivers[i++ % receivers.size()];
    benchmark::DoNotOptimize(Select(tree, receiver, static_cast<double>(rng.NextFloat()), false));
  }
  state.counters["depth"] = tree.Depth();
  state.counters["bytesPerLight"] = static_cast<double>(tree.Bytes()) / static_cast<double>(state.range(0));
}
BENCHMARK(Select)->Name("lightTree/select")->RangeMultiplier(10)->Range(1, 1000000);

// Probabilities of lights that were selected, as for a path's hits.
void Probability(benchmark::State& state) {
  const LightTree tree(SmallSquares(static_cast<size_t>(state.range(0))), 2);
  const auto receivers = Receivers();
  Rng rng(3);
  std::vector<uint32_t> chosen;
  for (const TreeReceiver& receiver : receivers)
    chosen.push_back(Select(tree, receiver, static_cast<double>(rng.NextFloat()), false).emitter);
  size_t i = 0;
  for (auto _ : state) {
    const size_t k = i++ % receivers.size();
    benchmark::DoNotOptimize(ProbabilityOf(tree, receivers[k], chosen[k]));
  }
}
BENCHMARK(Probability)->Name("lightTree/probability")->RangeMultiplier(10)->Range(1, 1000000);

void BuildTree(benchmark::State& state) {
  const auto emitters = SmallSquares(static_cast<size_t>(state.range(0)));
  for (auto _ : state) {
    const LightTree tree(emitters, 2);
    benchmark::DoNotOptimize(tree.Depth());
  }
}
BENCHMARK(BuildTree)->Name("lightTree/build")->Arg(1000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace lampyr
