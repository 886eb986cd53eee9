// Photons are found exactly, whatever lies where: against a search through all of them.
#include "integrators/photon/photon_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "integrators/photon/photon_store.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

// At a place; its number is its flux.
void AddPhoton(PhotonList& list, const Point3& position, size_t number) {
  PathVertex vertex;
  vertex.point.position = position;
  vertex.toPrevious = Vector3(0, 0, 1);
  vertex.diffuse = vertex.specular = Color(static_cast<float>(number));
  list.StartPath();
  list.Add(vertex, 1);
}

PhotonList ListOf(const std::vector<Point3>& positions) {
  PhotonList list;
  for (size_t i = 0; i < positions.size(); ++i) AddPhoton(list, positions[i], i);
  return list;
}

PhotonMap MapOf(const std::vector<Point3>& positions, int threads = 2) {
  const PhotonList list = ListOf(positions);
  return {std::span(&list, 1), threads};
}

std::set<size_t> NumbersOf(const PhotonMap& map, std::span<const uint32_t> found) {
  std::set<size_t> numbers;
  for (const uint32_t index : found) numbers.insert(static_cast<size_t>(map[index].flux.r));
  EXPECT_EQ(numbers.size(), found.size()) << "found twice";
  return numbers;
}

// On a floor, in a caustic and in the air, around `center`.
std::vector<Point3> Places(size_t count, const Point3& center, float size, uint64_t seed) {
  Rng rng(seed);
  std::vector<Point3> positions;
  for (size_t i = 0; i < count; ++i) {
    const float part = rng.NextFloat();
    Point3 p(rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f);
    if (part < 0.7f) p.z = -0.5f;
    if (part < 0.4f) p = Point3(0.1f * p.x, 0.1f * p.y * p.y, -0.5f);
    positions.push_back(center + size * p);
  }
  return positions;
}

double SquaredDistance(const Point3& a, const Point3& b) {
  const Vector3d d = Vector3d(a) - Vector3d(b);
  return glm::dot(d, d);
}

void ExpectExact(const std::vector<Point3>& positions, float size, uint64_t seed) {
  const PhotonMap map = MapOf(positions);
  ASSERT_EQ(positions.size(), map.Size());
  Rng rng(seed, 1);
  PhotonLookup lookup;
  for (int query = 0; query < 300; ++query) {
    const auto pick = static_cast<size_t>(rng.NextFloat() * static_cast<float>(positions.size()));
    const Point3 center = positions[std::min(pick, positions.size() - 1)] +
                          (query % 3 == 0 ? 0.0f : 0.03f) * size * SampleUniformSphere(rng.NextPoint2());
    const float radius = size * std::pow(10.0f, -3.5f + 4 * rng.NextFloat());
    const std::set<size_t> found = NumbersOf(map, map.Find(center, radius, lookup));
    // Rounding decides on the rim alone.
    const double squared = static_cast<double>(radius) * static_cast<double>(radius);
    const double rim = 1e-5 * squared + 1e-6 * static_cast<double>(size) * static_cast<double>(radius);
    for (size_t i = 0; i < positions.size(); ++i) {
      const double distance = SquaredDistance(positions[i], center);
      if (std::abs(distance - squared) <= rim) continue;
      const bool isInside = distance<squared, isFound = found.count(i)> 0;
      EXPECT_EQ(isInside, isFound) << distance / squared;
    }
  }
}

TEST(PhotonMap, FindsWhatASearchThroughAllFinds) {
  ExpectExact(Places(3000, Point3(0.0f), 1, 1), 1, 2);
}

TEST(PhotonMap, SmallAndLargeScenes) {
  ExpectExact(Places(2000, Point3(0.0f), 1e-4f, 3), 1e-4f, 4);
  ExpectExact(Places(2000, Point3(1e3f, -5e3f, 2e4f), 1e5f, 5), 1e5f, 6);
}

// Distances are of positions as they are: no precision is lost to where the scene lies.
TEST(PhotonMap, FarFromTheOrigin) {
  ExpectExact(Places(2000, Point3(1e5f, -1e5f, 1e5f), 100, 7), 100, 8);
}

// A few photons far from all others must not make the cells of the others useless, nor wrong.
TEST(PhotonMap, AFewFarAway) {
  std::vector<Point3> positions = Places(3000, Point3(0.0f), 1, 20);
  for (const float far : {1e2f, 1e4f, 1e7f, -1e7f}) positions.push_back(Point3(far, 0.5f * far, -0.3f));
  ExpectExact(positions, 1, 21);
}

// Lookups that find few photons are the grid's, those that find many are the tree's. The grid's are exact, also for a
// photon that is on the rim by the next number, and where rounding is a large part of the radius.
TEST(PhotonGrid, FindsWhatASearchThroughAllFinds) {
  for (const float offset : {0.0f, 100.0f, 1e4f}) {
    const std::vector<Point3> positions = Places(20000, Point3(offset), 1, 22);
    const MortonFrame frame(Point3(offset - 0.5f), 1);
    std::vector<SortItem> sorted;
    for (uint32_t i = 0; i < positions.size(); ++i) sorted.push_back({frame.CodeOf(positions[i]), i});
    std::sort(sorted.begin(), sorted.end(), [](const SortItem& a, const SortItem& b) { return a.cell < b.cell; });
    std::vector<Point3> inOrder;
    for (const SortItem& item : sorted) inOrder.push_back(positions[item.item]);
    const PhotonGrid grid(frame, sorted, inOrder);
    Rng rng(23);
    std::vector<uint32_t> found;
    std::vector<float> distances;
    int answered = 0, onRims = 0;
    const auto expectExact = [&](const Point3& center, float radius) {
      std::set<uint32_t> expected;
      for (uint32_t i = 0; i < inOrder.size(); ++i) {
        if (LengthSquared(inOrder[i] - center) < radius * radius) expected.insert(i);
      }
      EXPECT_EQ(std::set<uint32_t>(found.begin(), found.end()), expected) << offset << ", radius " << radius;
      EXPECT_EQ(found.size(), expected.size());
      for (size_t i = 0; i < found.size(); ++i) EXPECT_EQ(distances[i], LengthSquared(inOrder[found[i]] - center));
    };
    for (int query = 0; query < 1500; ++query) {
      const Point3 center = inOrder[static_cast<size_t>(rng.NextFloat() * 19999)];
      EXPECT_FALSE(grid.Find(center, 0.5f, found, distances));
      const float radius = 0.002f + 0.008f * rng.NextFloat();
      if (!grid.Find(center, radius, found, distances)) continue;
      ++answered;
      expectExact(center, radius);
      const float rim = std::sqrt(*std::max_element(distances.begin(), distances.end()));
      for (const float near : {rim, std::nextafter(rim, 1.0f)}) {
        if (rim > 0 && grid.Find(center, near, found, distances)) expectExact(center, near), ++onRims;
      }
    }
    EXPECT_GT(answered, 600) << "all but those in the caustic";
    EXPECT_GT(onRims, 300);
  }
}

TEST(PhotonGrid, WhatIsNoNumberFindsNothing) {
  const PhotonMap map = MapOf(Places(1000, Point3(0.0f), 1, 24));
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  PhotonLookup lookup;
  for (const Point3& center : {Point3(nan), Point3(0, nan, 0), Point3(infinity, 0, 0), Point3(0, 0, -infinity)})
    EXPECT_TRUE(map.Find(center, 0.1f, lookup).empty());
  EXPECT_TRUE(map.Find(Point3(0.0f), nan, lookup).empty());
}

TEST(PhotonMap, NoPhotons) {
  PhotonLookup lookup;
  const PhotonMap none;
  EXPECT_TRUE(none.Find(Point3(0.0f), 1, lookup).empty());
  const PhotonMap empty = MapOf({});
  EXPECT_TRUE(empty.IsEmpty());
  EXPECT_TRUE(empty.Find(Point3(0.0f), std::numeric_limits<float>::max(), lookup).empty());
}

TEST(PhotonMap, OnePhoton) {
  const PhotonMap map = MapOf({Point3(1, 2, 3)});
  PhotonLookup lookup;
  EXPECT_EQ(1u, map.Find(Point3(1, 2, 3), 1e-6f, lookup).size());
  EXPECT_EQ(1u, map.Find(Point3(1, 2, 4), 1.001f, lookup).size());
  EXPECT_TRUE(map.Find(Point3(1, 2, 4), 0.999f, lookup).empty());
  EXPECT_TRUE(map.Find(Point3(1, 2, 3), 0, lookup).empty());
}

TEST(PhotonMap, AMillionInOnePlace) {
  const PhotonMap map = MapOf(std::vector<Point3>(1000000, Point3(1, 2, 3)));
  PhotonLookup lookup;
  EXPECT_EQ(1000000u, map.Find(Point3(1, 2, 3), 1e-3f, lookup).size());
  EXPECT_TRUE(map.Find(Point3(1, 2, 3.1f), 1e-3f, lookup).empty());
}

TEST(PhotonMap, ARadiusLargerThanTheScene) {
  const PhotonMap map = MapOf(Places(5000, Point3(0.0f), 1, 9));
  PhotonLookup lookup;
  for (const float radius : {10.0f, 1e6f, 1e18f, std::numeric_limits<float>::infinity()})
    EXPECT_EQ(5000u, NumbersOf(map, map.Find(Point3(0.3f), radius, lookup)).size());
}

// One of them would spoil FLANN's search for all others.
TEST(PhotonMap, WhatIsNoNumberIsLeftOutAndCounted) {
  std::vector<Point3> positions = Places(100, Point3(0.0f), 1, 10);
  positions[17].y = std::numeric_limits<float>::quiet_NaN();
  positions[50].x = std::numeric_limits<float>::infinity();
  const PhotonMap map = MapOf(positions);
  EXPECT_EQ(98u, map.Size());
  EXPECT_EQ(2u, map.Rejected());
  PhotonLookup lookup;
  EXPECT_EQ(98u, map.Find(Point3(0.0f), 10, lookup).size());
}

// Sums over photons are in the order in which they are found.
TEST(PhotonMap, ThreadsAndListsDoNotMatter) {
  const std::vector<Point3> positions = Places(50000, Point3(0.0f), 1, 13);
  const PhotonList whole = ListOf(positions);
  std::vector<PhotonList> parts(7);
  for (size_t i = 0; i < positions.size(); ++i) AddPhoton(parts[i * 7 / positions.size()], positions[i], i);
  const PhotonMap one(std::span(&whole, 1), 1), many(parts, 4);
  PhotonLookup a, b;
  Rng rng(14);
  for (int i = 0; i < 200; ++i) {
    const Point3 center(rng.NextFloat() - 0.5f, rng.NextFloat() - 0.5f, -0.5f);
    const std::span<const uint32_t> fromOne = one.Find(center, 0.05f, a), fromMany = many.Find(center, 0.05f, b);
    ASSERT_TRUE(std::equal(fromOne.begin(), fromOne.end(), fromMany.begin(), fromMany.end()));
    for (const uint32_t index : fromOne) ASSERT_EQ(one[index].flux, many[index].flux);
  }
}

TEST(PhotonMap, KeepsWhatAPhotonCarries) {
  PathVertex vertex;
  vertex.toPrevious = Vector3(0, 0, 1);
  vertex.diffuse = Color(1, 2, 3);
  vertex.specular = Color(4, 5, 6);
  vertex.weight = {{0, 3}, {0.25, 2}};
  const SubpathDensities densities{2, 0};  // of the vertex: 1/2² = 0.25
  vertex.previousSolidAnglePerArea = {0.5};
  PhotonList list;
  list.StartPath();
  list.Add(vertex, 3);
  const PhotonMap map(std::span(&list, 1), 1);
  const PartialWeight weight = map[0].weight.At(densities, map[0].depth);
  EXPECT_EQ(0, weight.ends.last);
  EXPECT_EQ(3, weight.ends.earlier);
  EXPECT_EQ(0.25, weight.connections.last);
  EXPECT_EQ(2, weight.connections.earlier);
  EXPECT_DOUBLE_EQ(0.5 * 11, map[0].PreviousReverse(SolidAngleDensity(11)).value);
  EXPECT_EQ(Color(1, 2, 3), map[0].flux);
  EXPECT_EQ(Color(4, 5, 6), map.SpecularFlux(map[0]));
  EXPECT_EQ(3u, map[0].depth);
  EXPECT_TRUE(map.PathOf(map[0]).empty()) << "densities were not kept";
}

// Densities of a photon's own path, from the light to the photon: also if a path stored no photon, or not at each
// vertex.
TEST(PhotonMap, KeepsTheDensitiesOfPaths) {
  std::vector<PhotonList> lists(3);
  PathVertex vertex;
  vertex.toPrevious = Vector3(0, 0, 1);
  int path = 0;
  for (PhotonList& list : lists) {
    for (const size_t vertices : {2, 5, 3}) {
      std::vector<SubpathDensities> densities(vertices);
      for (size_t i = 0; i < vertices; ++i) densities[i].forward = 10 * path + static_cast<double>(i);
      list.StartPath();
      for (size_t depth = 1; depth <= vertices && vertices != 3; depth += 2) {
        vertex.point.position = Point3(static_cast<float>(path), static_cast<float>(depth), 0);
        list.Add(vertex, depth);
      }
      list.KeepDensities({}, densities);
      ++path;
    }
  }
  const PhotonMap map(lists, 2);
  ASSERT_EQ(12u, map.Size());
  PhotonLookup lookup;
  for (int of = 0; of < path; ++of) {
    for (int depth = 1; depth <= 5; depth += 2) {
      const auto found = map.Find(Point3(static_cast<float>(of), static_cast<float>(depth), 0), 0.4f, lookup);
      if (of % 3 == 2 || (of % 3 == 0 && depth > 1)) {
        EXPECT_TRUE(found.empty());
        continue;
      }
      ASSERT_EQ(1u, found.size());
      const auto densities = map.PathOf(map[found[0]]);
      ASSERT_EQ(static_cast<size_t>(depth), densities.size());
      for (int i = 0; i < depth; ++i) EXPECT_EQ(10 * of + i, densities[static_cast<size_t>(i)].forward);
    }
  }
}

TEST(PhotonMap, KeepsTheLabelsAndAsMuchOfTheDepthAsItCan) {
  PhotonList list;
  list.StartPath();
  PathVertex vertex;
  vertex.toPrevious = Vector3(0, 0, 1);
  const std::pair<size_t, uint32_t> photons[] = {{1, 0}, {7, 65534}, {65535, 1}, {65536, 2}, {1u << 20, 3}};
  for (const auto& [depth, label] : photons) {
    vertex.point.position.x = static_cast<float>(label);
    const PathLabel labels[] = {{label, Color(0.25f)}, {label + 1, Color(0.75f)}};
    list.Add(vertex, depth, std::span<const PathLabel>(labels).first(label % 2 + 1));
  }
  const PhotonMap map(std::span(&list, 1), 1);
  for (const auto& [depth, label] : photons) {
    PhotonLookup lookup;
    const auto found = map.Find(Point3(static_cast<float>(label), 0, 0), 0.4f, lookup);
    ASSERT_EQ(found.size(), 1u) << label;
    const auto labels = map.LabelsOf(found[0]);
    ASSERT_EQ(labels.size(), label % 2 + 1);
    for (uint32_t i = 0; i < labels.size(); ++i) {
      EXPECT_EQ(labels[i].state, label + i);
      EXPECT_EQ(labels[i].share, Color(i == 0 ? 0.25f : 0.75f));
    }
    EXPECT_EQ(map[found[0]].depth, std::min<size_t>(depth, 65535));
  }
}

TEST(PackedNormal, IsNearTheNormal) {
  Rng rng(15);
  for (int i = 0; i < 100000; ++i) {
    const Normal3 n = SampleUniformSphere(rng.NextPoint2());
    EXPECT_LT(glm::length(PackedNormal(n).Unpack() - n), 7e-5f);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      Normal3 n(0.0f);
      n[axis] = sign;
      EXPECT_EQ(n, PackedNormal(n).Unpack());
    }
  }
}

std::vector<PhotonList> PathsOf(size_t lists, size_t pathsInEach, size_t photonsOnEach) {
  std::vector<PhotonList> result(lists);
  PathVertex vertex;
  vertex.toPrevious = Vector3(0, 0, 1);
  for (PhotonList& list : result) {
    for (size_t path = 0; path < pathsInEach; ++path) {
      list.StartPath();
      for (size_t i = 0; i < photonsOnEach; ++i) list.Add(vertex, 1);
    }
  }
  return result;
}

// By the angle of the normals, which are stored without their lengths.
TEST(Photon, LiesOnASurfaceByItsNormal) {
  Rng rng(12);
  int on = 0, decided = 0;
  for (int i = 0; i < 20000; ++i) {
    const Normal3 a = SampleUniformSphere({rng.NextFloat(), rng.NextFloat()});
    const Normal3 b = SampleUniformSphere({rng.NextFloat(), rng.NextFloat()});
    Photon photon;
    photon.normal = PackedNormal(a);
    const float cosine = std::abs(glm::dot(a, b));
    if (std::abs(cosine - 0.8f) < 2e-4f) continue;  // as exact as the stored normal
    ++decided;
    on += photon.IsOnSurface(b, Vector3(0.0f), 0.1f);
    ASSERT_EQ(cosine > 0.8f, photon.IsOnSurface(b, Vector3(0.0f), 0.1f)) << cosine;
  }
  EXPECT_GT(decided, 19900);
  EXPECT_NEAR(0.2, static_cast<double>(on) / decided, 0.015) << "the cosine is uniform";
}

// On a sphere of any radius, and not on the next of two sheets, whichever way their normals point.
TEST(Photon, LiesOnOneOfTwoSheets) {
  Rng rng(13);
  for (int i = 0; i < 20000; ++i) {
    const Normal3 a = SampleUniformSphere({rng.NextFloat(), rng.NextFloat()});
    const Frame frame = Frame::FromNormal(a);
    const float angle = 0.6f * rng.NextFloat(), azimuth = 6.28f * rng.NextFloat();
    const Normal3 b =
        frame.ToWorld({std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)});
    const float radius = std::exp(10 * rng.NextFloat() - 5);
    Photon photon;
    photon.normal = PackedNormal(i % 2 ? b : -b);
    const Vector3 chord = radius * (b - a);
    EXPECT_TRUE(photon.IsOnSurface(a, chord, 1e-3f * radius)) << radius << " " << angle;
    const float gap = radius * (0.02f + rng.NextFloat());
    const Vector3 toNext = chord + gap * b;
    const float bent = 0.25f * std::sin(angle) * glm::length(toNext);  // by which the distance may be larger
    EXPECT_FALSE(photon.IsOnSurface(a, toNext, 0.9f * gap - bent)) << gap;
    EXPECT_TRUE(photon.IsOnSurface(a, toNext, 1.1f * gap)) << gap;
  }
}

TEST(PhotonUse, AddsTheContributionsOfAPath) {
  PhotonUse use({2, 0, 2, 1}, std::vector<PathOrigin>(3));
  std::vector<PhotonUse::Contribution> first = {{0, 0.5f}, {1, 4.0f}, {2, 0.25f}};
  use.Add(first);
  std::vector<PhotonUse::Contribution> second = {{2, 1.0f}, {3, 0.0f}, {1, 1e30f}};
  use.Add(second);
  use.Add({});
  EXPECT_EQ(4.0 + 0x1p16, use.Sum(0)) << "a contribution without bounds is clamped";
  EXPECT_EQ(0.0, use.Sum(1));
  EXPECT_EQ(1.75, use.Sum(2));
}

TEST(PhotonStore, KeepsToItsMemory) {
  for (const size_t lists : {1, 3, 8}) {
    PhotonSettings settings;
    settings.radius = 1;
    settings.mostBytes = 1000 * PhotonStore::BytesPerPhoton();
    PhotonStore store(settings, 4800);
    std::vector<PhotonList> taken = PathsOf(lists, 4800 / lists, 7);
    store.Take(taken);
    EXPECT_FALSE(store.HasRoom());
    store.Finish(0);
    const PhotonPass& pass = store.Open(0, 2);
    EXPECT_EQ(142, pass.lightPaths) << "whole paths, the same however they were cut into lists";
    EXPECT_EQ(994u, pass.map->Size());
    EXPECT_TRUE(store.HasRoom()) << "for the next pass";
  }
}

TEST(PhotonStore, KeepsItsFirstPathWhateverItTakes) {
  for (const uint64_t bytes : {uint64_t{1}, 6 * PhotonStore::BytesPerPhoton()}) {
    PhotonSettings settings;
    settings.radius = 1;
    settings.mostBytes = bytes;
    PhotonStore store(settings, 30);
    std::vector<PhotonList> taken = PathsOf(3, 10, 7);
    taken.insert(taken.begin(), PhotonList());
    store.Take(taken);
    EXPECT_FALSE(store.HasRoom());
    taken = PathsOf(1, 10, 7);
    store.Take(taken);
    store.Finish(0);
    const PhotonPass& pass = store.Open(0, 2);
    EXPECT_EQ(1, pass.lightPaths);
    EXPECT_EQ(7u, pass.map->Size());
  }
}

TEST(PhotonStore, PassesFollowEachOther) {
  PhotonSettings settings;
  settings.radius = 2;
  settings.alpha = 0.5;
  PhotonStore store(settings, 10);
  EXPECT_FALSE(store.IsFor(0));
  std::vector<PhotonList> taken = PathsOf(1, 10, 2);
  store.Take(taken);
  store.Finish(15);
  EXPECT_TRUE(store.IsFor(15));
  EXPECT_FALSE(store.IsFor(14));
  const PhotonPass& pass = store.Open(15, 1);
  EXPECT_FLOAT_EQ(1, pass.radius);  // 2 · 16^(-1/4)
  EXPECT_EQ(10, pass.lightPaths);
  EXPECT_EQ(20u, pass.map->Size());
  EXPECT_EQ(&pass, &store.Open(15, 1)) << "it is made once";
  EXPECT_EQ(1u, store.Statistics().passes);
  EXPECT_FALSE(store.IsFor(16));
}

// Lists whose memory is used again hold nothing of the pass before.
TEST(PhotonStore, EveryPassHasItsOwnPhotons) {
  PhotonSettings settings;
  settings.radius = 1;
  PhotonStore store(settings, 100);
  std::vector<PhotonList> lists;
  for (const size_t photons : {7, 2, 5}) {
    const uint32_t next = static_cast<uint32_t>(photons);
    for (int part = 0; part < 2; ++part) {
      lists.resize(4);
      std::vector<PhotonList> traced = PathsOf(4, 5, photons);
      for (size_t i = 0; i < traced.size(); ++i) {
        ASSERT_EQ(0u, lists[i].Paths());
        ASSERT_TRUE(lists[i].Photons().empty());
        lists[i] = std::move(traced[i]);
      }
      store.Take(lists);
    }
    store.Finish(next);
    const PhotonPass& pass = store.Open(next, 1);
    EXPECT_EQ(40, pass.lightPaths);
    EXPECT_EQ(40 * photons, pass.map->Size());
  }
}

}  // namespace
}  // namespace lampyr
