#include "geometry/crossing_order.h"

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>

namespace lampyr {

void SortByDistance(std::vector<Crossing>& crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.t, a.entering, a.instance, a.primitive, a.patch) <
           std::tie(b.t, b.entering, b.instance, b.primitive, b.patch);
  });
}

namespace {

// The medium in front of the surface, as seen from the ray; kSameMedium: any.
int32_t MediumBefore(const SceneTables& tables, const Crossing& crossing) {
  const PrimitiveRecord& record = tables.primitives[crossing.primitive];
  if (crossing.medium == kSameMedium) return kSameMedium;
  return crossing.entering ? record.outsideMedium : record.insideMedium;
}

bool Follows(int32_t before, int32_t medium) {
  return before == medium || before == kSameMedium;
}

// The medium in front of a group of coincident crossings, none of which has been passed, and which `next` follows
// (null: nothing): the medium from which one of them starts and to which no other leads. If each is led to, they form a
// cycle, and the medium is the one behind it. If nothing is behind it, the ray touches an edge of a single shape from
// outside.
std::optional<int32_t> FindStart(const SceneTables& tables, std::span<const Crossing> group, const Crossing* next) {
  for (const Crossing& crossing : group) {
    const int32_t before = MediumBefore(tables, crossing);
    if (before != kSameMedium && std::none_of(group.begin(), group.end(), [&](const Crossing& other) {
          return &other != &crossing && other.medium == before;
        }))
      return before;
  }
  if (next && MediumBefore(tables, *next) != kSameMedium) return MediumBefore(tables, *next);
  const Crossing& first = group.front();
  if (std::all_of(group.begin(), group.end(), [&](const Crossing& other) {
        return other.primitive == first.primitive && other.instance == first.instance;
      }))
    return tables.primitives[first.primitive].outsideMedium;
  return std::nullopt;
}

void OrderGroup(const SceneTables& tables, std::optional<int32_t> medium, std::span<Crossing> group) {
  std::vector<double> distances;
  for (const Crossing& crossing : group) distances.push_back(crossing.t);
  for (size_t i = 0; i < group.size(); ++i) {
    const auto rest = group.begin() + static_cast<std::ptrdiff_t>(i);
    const auto next = std::find_if(rest, group.end(), [&](const Crossing& crossing) {
      return !medium || Follows(MediumBefore(tables, crossing), *medium);
    });
    if (next != group.end()) std::rotate(rest, next, next + 1);
    if (rest->medium != kSameMedium) medium = rest->medium;
    rest->t = distances[i];
  }
}

// Drops the duplicates of crossings at an edge that two triangles or patches share; returns the new end.
size_t DropDoubled(size_t begin, size_t end, std::vector<Crossing>& crossings) {
  for (size_t i = begin + 1; i < end;) {
    const Crossing crossing = crossings[i];
    const auto at = crossings.begin() + static_cast<std::ptrdiff_t>(i);
    const bool isDoubled =
        crossing.medium != kSameMedium &&
        std::any_of(crossings.begin() + static_cast<std::ptrdiff_t>(begin), at, [&](const Crossing& other) {
          return other.primitive == crossing.primitive && other.instance == crossing.instance &&
                 other.entering == crossing.entering;
        });
    if (isDoubled) {
      crossings.erase(at);
      --end;
    } else {
      ++i;
    }
  }
  return end;
}

}  // namespace

void OrderCoincident(const SceneTables& tables, double largest, std::vector<Crossing>& crossings) {
  constexpr double kRounding = 32 * 0x1p-23;  // error of a distance, in units of the coordinates on the way
  std::optional<int32_t> medium;
  for (size_t begin = 0, end = 0; begin < crossings.size(); begin = end) {
    end = begin + 1;
    while (end < crossings.size() &&
           crossings[end].t - crossings[end - 1].t <= kRounding * (crossings[end].t + largest))
      ++end;
    end = DropDoubled(begin, end, crossings);
    const std::span<Crossing> group(crossings.data() + begin, end - begin);
    if (group.size() > 1) {
      if (!medium) medium = FindStart(tables, group, end < crossings.size() ? &crossings[end] : nullptr);
      OrderGroup(tables, medium, group);
    }
    if (group.back().medium != kSameMedium) medium = group.back().medium;
  }
}

}  // namespace lampyr
