#include "lights/selection/emission_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/selection/importance_lanes.h"
#include "lights/selection/light_selector.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

namespace {

// Minimum number of photons of a component: fewer do not determine where further photons arrive.
constexpr size_t kFewest = 16;
constexpr size_t kFewestOfLight = 4;  // for the only component of a light
// Smallest sine of the angle that a component subtends: relative precision of a direction in float and of the distance
// of a line from a point. Smaller components are enlarged to it.
constexpr float kSmallestSine = 0x1p-13f;
constexpr float kSmallestSquare = std::numeric_limits<float>::min();

// A contiguous range of photons, to be divided.
struct Cell {
  size_t first = 0, count = 0;
  double contribution = 0, secondMoment = 0;
  double unguidedDensity = 0;  // mean over the photons
  Bounds3 box;
  Point3 center{0.0f};
  float radius = 0;

  // Relative probability of aiming at this cell.
  double Weight() const {
    return std::sqrt(unguidedDensity * static_cast<double>(kPi) * static_cast<double>(radius) *
                     static_cast<double>(radius) * secondMoment);
  }
};

Cell CellOf(std::span<const UsefulPhoton> photons, size_t first, size_t count, float smallest) {
  Cell cell;
  cell.first = first;
  cell.count = count;
  const std::span<const UsefulPhoton> inside = photons.subspan(first, count);
  for (const UsefulPhoton& photon : inside) {
    cell.contribution += photon.contribution;
    cell.secondMoment += photon.secondMoment;
    cell.unguidedDensity += photon.unguidedDensity / static_cast<double>(count);
    cell.box.Add(photon.firstHit);
  }
  cell.center = cell.box.Center();
  float squared = 0;
  for (const UsefulPhoton& photon : inside) squared = std::max(squared, LengthSquared(photon.firstHit - cell.center));
  // The outermost of n samples lie inside the region that they sample.
  const float margin = 1 + 2 / static_cast<float>(count);
  cell.radius = std::max(margin * std::sqrt(squared), smallest);
  return cell;
}

// Splits at half the contribution along the longest axis; returns the number of photons on the first side.
size_t DivideCell(std::span<UsefulPhoton> photons, const Cell& cell) {
  const Vector3 extent = cell.box.Diagonal();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::span<UsefulPhoton> own = photons.subspan(cell.first, cell.count);
  std::stable_sort(own.begin(), own.end(), [axis](const UsefulPhoton& a, const UsefulPhoton& b) {
    return a.firstHit[axis] < b.firstHit[axis];
  });
  double sum = 0;
  size_t count = 0;
  while (count < own.size() && sum < 0.5 * cell.contribution) sum += own[count++].contribution;
  return std::clamp(count, kFewest, cell.count - kFewest);
}

}  // namespace

EmissionGuide::EmissionGuide(std::span<const UsefulPhoton> photons, std::span<const PlacedLight> lights,
                             const LightSelector& unguided, const BoundingSphere& scene)
    : lights_(lights), unguided_(unguided), indices_(lights.size()) {
  const auto unguidedOf = [&](uint32_t light) {
    return static_cast<double>(unguided.Probability({}, light, kAnyPatch).value);
  };
  std::vector<UsefulPhoton> sorted;
  for (const UsefulPhoton& photon : photons) {
    if (photon.contribution > 0 && photon.secondMoment > 0 && unguidedOf(photon.light) > 0) sorted.push_back(photon);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const UsefulPhoton& a, const UsefulPhoton& b) { return a.light < b.light; });
  std::vector<double> weights;
  double total = 0;
  for (size_t first = 0; first < sorted.size();) {
    Entry entry;
    entry.light = sorted[first].light;
    double squared = 0;
    size_t end = first;
    while (end < sorted.size() && sorted[end].light == entry.light) squared += sorted[end++].secondMoment;
    double weight = std::sqrt(squared);
    if (end - first >= kFewestOfLight && lights[entry.light].light->CanBeAimed()) {
      const std::span<UsefulPhoton> own = std::span(sorted).subspan(first, end - first);
      weight = std::min(weight, AddTargets(own, kSmallestSine * scene.radius, entry));
    }
    indices_[entry.light] = static_cast<uint32_t>(entries_.size() + 1);
    entries_.push_back(entry);
    weights.push_back(weight * std::sqrt(unguidedOf(entry.light)));
    total += weights.back();
    first = end;
  }
  std::vector<float> relative;
  for (const double weight : weights) relative.push_back(static_cast<float>(weight / total));
  table_ = AliasTable(relative);
  for (Entry& entry : entries_) {
    if (entry.targets == 0) continue;
    const double aimed = kGuided * LearnedProbability(entry.light);
    entry.share = static_cast<float>(aimed / static_cast<double>(Probability(entry.light).value));
  }
}

// Divides the cell of largest weight first. Returns the sum of weights.
double EmissionGuide::AddTargets(std::span<UsefulPhoton> photons, float smallest, Entry& entry) {
  std::vector<Cell> cells{CellOf(photons, 0, photons.size(), smallest)};
  while (cells.size() < kMaxComponents) {
    size_t widest = cells.size();
    for (size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].count < 2 * kFewest || !(cells[i].radius > smallest)) continue;
      if (widest == cells.size() || cells[i].Weight() > cells[widest].Weight()) widest = i;
    }
    if (widest == cells.size()) break;
    const Cell cell = cells[widest];
    const size_t count = DivideCell(photons, cell);
    cells[widest] = CellOf(photons, cell.first, count, smallest);
    cells.push_back(CellOf(photons, cell.first + count, cell.count - count, smallest));
  }
  double sum = 0;
  for (const Cell& cell : cells) sum += cell.Weight();
  entry.targets = static_cast<int>(cells.size());
  entry.firstBlock = static_cast<uint32_t>(blocks_.size());
  entry.blocks = static_cast<uint32_t>((cells.size() + kWidth - 1) / kWidth);
  blocks_.resize(blocks_.size() + entry.blocks);
  for (size_t i = 0; i < cells.size(); ++i) {
    Block& block = blocks_[entry.firstBlock + i / kWidth];
    const size_t lane = i % kWidth;
    block.x[lane] = cells[i].center.x;
    block.y[lane] = cells[i].center.y;
    block.z[lane] = cells[i].center.z;
    block.radius[lane] = cells[i].radius;
    block.weight[lane] = static_cast<float>(cells[i].Weight() / sum);
  }
  return sum;
}

const EmissionGuide::Entry* EmissionGuide::EntryOf(uint32_t light) const {
  const uint32_t index = indices_[light];
  return index == 0 ? nullptr : &entries_[index - 1];
}

double EmissionGuide::LearnedProbability(uint32_t light) const {
  const uint32_t index = indices_[light];
  return index == 0 || table_.IsZero() ? 0.0 : static_cast<double>(table_.Probability(index - 1).value);
}

PdfDiscrete EmissionGuide::Probability(uint32_t light) const {
  const PdfDiscrete unguided = unguided_.Probability({}, light, kAnyPatch);
  if (table_.IsZero()) return unguided;
  return PdfDiscrete(
      static_cast<float>((1 - kGuided) * static_cast<double>(unguided.value) + kGuided * LearnedProbability(light)));
}

float EmissionGuide::Share(uint32_t light) const {
  const Entry* entry = EntryOf(light);
  return entry ? entry->share : 0.0f;
}

EmissionGuide::Choice EmissionGuide::Select(double u) const {
  Choice choice;
  if (table_.IsZero() || u >= kGuided) {
    LightChoices choices;
    const double x = table_.IsZero() ? u : (u - kGuided) / (1 - kGuided);
    unguided_.Select({}, std::clamp(x, 0.0, 0x1.fffffffffffffp-1), choices);
    if (choices.count == 0) return choice;
    choice.light = choices.of[0].light;
  } else {
    const AliasTable::Result result = table_.Sample(u / kGuided);
    const Entry& entry = entries_[result.index];
    choice.light = entry.light;
    if (entry.targets > 0) {
      float left = result.u;
      int target = 0;
      const auto weightOf = [&](int i) { return blocks_[entry.firstBlock + i / kWidth].weight[i % kWidth]; };
      while (target + 1 < entry.targets && left >= weightOf(target)) left -= weightOf(target++);
      choice.target = target;
    }
  }
  choice.probability = Probability(choice.light);
  choice.exists = true;
  return choice;
}

EmissionGuide::Target EmissionGuide::TargetOf(const Choice& choice) const {
  const Entry& entry = *EntryOf(choice.light);
  const Block& block = blocks_[entry.firstBlock + static_cast<uint32_t>(choice.target) / kWidth];
  const int lane = choice.target % kWidth;
  return {Point3(block.x[lane], block.y[lane], block.z[lane]), block.radius[lane]};
}

// Not inlined, so that the density of a photon has the same bits in every technique.
[[gnu::noinline]] PdfSolidAngle EmissionGuide::DirectionDensity(uint32_t light, const Point3& from,
                                                                const Vector3& direction) const {
  const Entry* entry = EntryOf(light);
  if (!entry) return PdfSolidAngle(0);
  Lanes sum = 0.0f;
  for (uint32_t i = entry->firstBlock; i < entry->firstBlock + entry->blocks; ++i) {
    const Block& block = blocks_[i];
    const Lanes x = Load(block.x) - from.x, y = Load(block.y) - from.y, z = Load(block.z) - from.z;
    const Lanes squared = x * x + y * y + z * z;
    const Lanes radius = Load(block.radius);
    const Lanes reach = simd::max(radius * radius, kSmallestSine * kSmallestSine * squared);
    const Lanes cx = y * direction.z - z * direction.y, cy = z * direction.x - x * direction.z,
                cz = x * direction.y - y * direction.x;
    const auto isInside = squared <= reach;
    const auto isMissed =
        x * direction.x + y * direction.y + z * direction.z <= 0.0f || cx * cx + cy * cy + cz * cz > reach;
    const Lanes sine2 = simd::min(reach / simd::max(squared, Lanes(kSmallestSquare)), Lanes(1.0f));
    const Lanes oneMinusCosine = sine2 / (1.0f + simd::sqrt(1.0f - sine2));
    Lanes density = 1.0f / (2 * kPi * simd::max(oneMinusCosine, Lanes(1e-30f)));
    where(isMissed, density) = 0.0f;
    where(isInside, density) = Lanes(0.25f * kInvPi);
    sum += Load(block.weight) * density;
  }
  return PdfSolidAngle(simd::reduce(sum));
}

Vector3 EmissionGuide::SampleDirection(const Choice& choice, const Point3& from, const Point2& u) const {
  const Target target = TargetOf(choice);
  const Vector3 way = target.center - from;
  const float squared = LengthSquared(way);
  const float reach = std::max(Sqr(target.radius), Sqr(kSmallestSine) * squared);
  if (squared <= reach) return SampleUniformSphere(u);
  const Frame frame = Frame::FromNormal(way / std::sqrt(squared));
  return glm::normalize(frame.ToWorld(SampleUniformCone(u, OneMinusCosFromSinSquared(reach / squared))));
}

float EmissionGuide::Reach(const Choice& choice, const Point3& from) const {
  const Target target = TargetOf(choice);
  return std::max(glm::distance(target.center, from), target.radius);
}

[[gnu::noinline]] PdfArea EmissionGuide::LineDensity(uint32_t light, const Point3& on, const Vector3& direction) const {
  const Entry* entry = EntryOf(light);
  if (!entry) return PdfArea(0);
  Lanes sum = 0.0f;
  for (uint32_t i = entry->firstBlock; i < entry->firstBlock + entry->blocks; ++i) {
    const Block& block = blocks_[i];
    const Lanes x = Load(block.x) - on.x, y = Load(block.y) - on.y, z = Load(block.z) - on.z;
    const Lanes cx = y * direction.z - z * direction.y, cy = z * direction.x - x * direction.z,
                cz = x * direction.y - y * direction.x;
    const Lanes reach = simd::max(Load(block.radius) * Load(block.radius), Lanes(kSmallestSquare));
    Lanes density = Load(block.weight) / (kPi * reach);
    where(cx * cx + cy * cy + cz * cz > reach, density) = 0.0f;
    sum += density;
  }
  return PdfArea(simd::reduce(sum));
}

Point3 EmissionGuide::SampleLine(const Choice& choice, const Vector3& direction, const Point2& u) const {
  const Target target = TargetOf(choice);
  const Frame frame = Frame::FromNormal(direction);
  const Point2 disk = SampleConcentricDisk(u) * target.radius;
  return target.center + frame.x * disk.x + frame.y * disk.y;
}

float EmissionGuide::AimedDensity(uint32_t light, const Point3& on, const Vector3& direction) const {
  return IsAtInfinity(lights_[light].light->Kind()) ? LineDensity(light, on, direction).value
                                                    : DirectionDensity(light, on, direction).value;
}

double EmissionGuide::Gain(uint32_t light, const Point3& on, const Vector3& direction, double own) const {
  const auto unguided = static_cast<double>(unguided_.Probability({}, light, kAnyPatch).value);
  if (table_.IsZero() || !(unguided > 0) || !(own > 0)) return 1;
  double aimed = 1;
  if (Share(light) > 0) aimed = static_cast<double>(AimedDensity(light, on, direction)) / own;
  return 1 - kGuided + kGuided * LearnedProbability(light) / unguided * aimed;
}

int EmissionGuide::ComponentCount() const {
  int count = 0;
  for (const Entry& entry : entries_) count += entry.targets;
  return count;
}

}  // namespace lampyr
