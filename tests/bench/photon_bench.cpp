// Photon lookups: the map against a hash grid that is made for the one radius, what a map takes in time and memory, and
// samples per second of the integrators that gather photons.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "integrators/photon/photon_map.h"
#include "sampling/rng.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// On the walls of a box of size 1; nine tenths of them in a caustic where `isCaustic`.
std::vector<Point3> Places(size_t count, bool isCaustic, uint64_t seed) {
  Rng rng(seed);
  std::vector<Point3> positions;
  for (size_t i = 0; i < count; ++i) {
    Point3 p(rng.NextFloat(), rng.NextFloat(), rng.NextFloat());
    const int wall = static_cast<int>(6 * rng.NextFloat()) % 6;
    p[wall / 2] = wall % 2 ? 1.0f : 0.0f;
    if (isCaustic && rng.NextFloat() < 0.9f) p = Point3(0.1f * p.x, 0.6f * p.y, 0);
    positions.push_back(p);
  }
  return positions;
}

PhotonList ListOf(const std::vector<Point3>& positions) {
  PhotonList list;
  PathVertex vertex;
  vertex.toPrevious = Vector3(0, 0, 1);
  vertex.diffuse = vertex.specular = Color(1.0f);
  list.StartPath();
  for (const Point3& p : positions) {
    vertex.point.position = p;
    list.Add(vertex, 1);
  }
  return list;
}

// The work of a lookup: a sum over the photons' flux.
double Gather(const Photon& photon) {
  return static_cast<double>(photon.flux.r) *
             photon.PreviousReverse(SolidAngleDensity(static_cast<double>(photon.toPrevious.z))).value +
         static_cast<double>(photon.normal.Unpack().z);
}

// Cells of twice the radius, eight of which a lookup visits; photons are kept cell by cell.
class HashGrid {
 public:
  HashGrid(const PhotonMap& map, const std::vector<Point3>& positions, float radius)
      : radius_(radius), cellSize_(2 * radius), starts_(positions.size() + 1) {
    std::vector<uint32_t> cells;
    for (const Point3& p : positions) {
      cells.push_back(CellOf(glm::floor(p / cellSize_)));
      ++starts_[cells.back() + 1];
    }
    for (size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    positions_.resize(positions.size());
    photons_.resize(positions.size());
    for (size_t i = 0; i < positions.size(); ++i) {
      const uint32_t at = next[cells[i]]++;
      positions_[at] = positions[i];
      photons_[at] = map[0];
    }
  }
  template <class Visit>
  void Find(const Point3& center, const Visit& visit) const {
    const Vector3 cell = center / cellSize_, base = glm::floor(cell - 0.5f);
    uint32_t visited[8];
    int count = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const uint32_t own = CellOf(base + Vector3(corner & 1, corner >> 1 & 1, corner >> 2));
      if (std::find(visited, visited + count, own) != visited + count) continue;
      visited[count++] = own;
      for (uint32_t i = starts_[own]; i < starts_[own + 1]; ++i) {
        if (LengthSquared(positions_[i] - center) < radius_ * radius_) visit(photons_[i]);
      }
    }
  }

 private:
  uint32_t CellOf(const Vector3& cell) const {
    const auto x = static_cast<uint32_t>(static_cast<int32_t>(cell.x)),
               y = static_cast<uint32_t>(static_cast<int32_t>(cell.y)),
               z = static_cast<uint32_t>(static_cast<int32_t>(cell.z));
    return (x * 73856093u ^ y * 19349663u ^ z * 83492791u) % static_cast<uint32_t>(starts_.size() - 1);
  }

  float radius_, cellSize_;
  std::vector<uint32_t> starts_;
  std::vector<Point3> positions_;
  std::vector<Photon> photons_;
};

constexpr size_t kQueries = 1 << 16;

// The radius within which so many photons are found on average.
float RadiusFor(const PhotonMap& map, const std::vector<Point3>& queries, double wanted) {
  float low = 1e-5f, high = 1;
  PhotonLookup lookup;
  for (int step = 0; step < 30; ++step) {
    const float middle = std::sqrt(low * high);
    double found = 0;
    for (size_t i = 0; i < 1000; ++i) found += static_cast<double>(map.Find(queries[i * 64], middle, lookup).size());
    (found / 1000 < wanted ? low : high) = middle;
  }
  return high;
}

void Lookup(benchmark::State& state, bool usesGrid) {
  const auto count = static_cast<size_t>(state.range(0));
  const bool isCaustic = state.range(2) != 0;
  const std::vector<Point3> positions = Places(count, isCaustic, 1), queries = Places(kQueries, isCaustic, 2);
  const PhotonList list = ListOf(positions);
  const PhotonMap map(std::span(&list, 1), 2);
  const float radius = RadiusFor(map, queries, static_cast<double>(state.range(1)));
  const HashGrid grid(map, positions, radius);
  PhotonLookup lookup;
  size_t i = 0, found = 0;
  double sum = 0;
  for (auto _ : state) {
    const Point3& center = queries[i++ % kQueries];
    if (usesGrid) {
      grid.Find(center, [&](const Photon& photon) {
        sum += Gather(photon);
        ++found;
      });
    } else {
      const std::span<const uint32_t> indices = map.Find(center, radius, lookup);
      for (const uint32_t index : indices) sum += Gather(map[index]);
      found += indices.size();
    }
    benchmark::DoNotOptimize(sum);
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(i);
  state.counters["bytesPerPhoton"] = static_cast<double>(map.Bytes()) / static_cast<double>(count);
}
void Arguments(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"photons", "found", "caustic"});
  for (const int64_t isCaustic : {0, 1}) {
    for (const int64_t found : {1, 3, 10, 50, 200}) bench->Args({1000000, found, isCaustic});
  }
  bench->Args({10000000, 50, 0});
}
BENCHMARK_CAPTURE(Lookup, map, false)->Name("photons/lookup/map")->Apply(Arguments);
BENCHMARK_CAPTURE(Lookup, grid, true)->Name("photons/lookup/grid")->Apply(Arguments);

void BuildMap(benchmark::State& state) {
  const PhotonList list = ListOf(Places(static_cast<size_t>(state.range(0)), false, 1));
  for (auto _ : state) {
    const PhotonMap map(std::span(&list, 1), 2);
    benchmark::DoNotOptimize(map.Size());
  }
}
BENCHMARK(BuildMap)->Name("photons/build")->Arg(500000)->Arg(10000000)->Unit(benchmark::kMillisecond)->UseRealTime();

// A box, open to the camera, with a mirror ball and a light in its ceiling, as the small research renderers have it.
constexpr const char* kMirrorBox = R"(LookAt 0 -3.35 1  0 0 1  0 0 1
Camera "perspective" "float fov" 42
Film "rgb" "integer xresolution" 512 "integer yresolution" 512
PixelFilter "box"
Integrator "vcm" "integer maxdepth" 9 "float radius" 0.0052
WorldBegin
Material "diffuse" "rgb reflectance" [0.73 0.73 0.73]
Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]
Shape "bilinearmesh" "point3 P" [-1 -1 2  -1 1 2  1 -1 2  1 1 2]
Shape "bilinearmesh" "point3 P" [-1 1 0  1 1 0  -1 1 2  1 1 2]
Material "diffuse" "rgb reflectance" [0.65 0.06 0.06]
Shape "bilinearmesh" "point3 P" [-1 -1 0  -1 1 0  -1 -1 2  -1 1 2]
Material "diffuse" "rgb reflectance" [0.12 0.45 0.15]
Shape "bilinearmesh" "point3 P" [1 -1 0  1 -1 2  1 1 0  1 1 2]
AttributeBegin
Material "conductor" "rgb reflectance" [0.95 0.95 0.95] "float roughness" 0
Translate 0 0.1 0.7 Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
Material "diffuse" "rgb reflectance" [0 0 0]
AreaLightSource "diffuse" "rgb L" [25 22 18]
Shape "bilinearmesh" "point3 P" [-0.25 -0.25 1.995  -0.25 0.25 1.995  0.25 -0.25 1.995  0.25 0.25 1.995]
AttributeEnd
)";

// Thousands of samples per second of CPU time, light paths, maps and lookups included; and the part of the wall time
// that maps are built in.
void MirrorBox(benchmark::State& state, const std::string& integrator) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  RenderOverrides overrides;
  overrides.integrator = integrator;
  const BuiltScene built =
      BuildScene(ParseScene(kMirrorBox, "mirror-box.pbrt", diagnostics), overrides, true, diagnostics);
  constexpr int samplesPerPixel = 8;
  RenderOutcome outcome;
  double cpu = 0;
  for (auto _ : state) {
    const std::clock_t start = std::clock();
    const Rendered rendered = RenderBuilt(built, samplesPerPixel, 2);
    cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    outcome = rendered.outcome;
    state.SetIterationTime(cpu);
  }
  state.counters["kSamplesPerCpuSecond"] = 512.0 * 512 * samplesPerPixel / cpu / 1e3;
  if (!outcome.photons) return;
  state.counters["buildShare"] = outcome.photons->buildSeconds / outcome.seconds;
  state.counters["bytesPerPhoton"] =
      static_cast<double>(outcome.photons->mostBytes) / static_cast<double>(outcome.photons->mostPhotons);
  state.counters["photonsPerPass"] = static_cast<double>(outcome.photons->mostPhotons);
}
BENCHMARK_CAPTURE(MirrorBox, bdpt, "bdpt")->Name("photons/mirrorBox/bdpt")->Iterations(2)->UseManualTime();
BENCHMARK_CAPTURE(MirrorBox, sppm, "sppm")->Name("photons/mirrorBox/sppm")->Iterations(2)->UseManualTime();
BENCHMARK_CAPTURE(MirrorBox, vcm, "vcm")->Name("photons/mirrorBox/vcm")->Iterations(2)->UseManualTime();

}  // namespace
}  // namespace lampyr::test
