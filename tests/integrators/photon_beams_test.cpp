// Photons in media are found exactly, whatever lies where: against a search through all of them.
#include "integrators/photon/photon_beams.h"

#include <gtest/gtest.h>

#include <map>

#include "integrators/photon/beam_search.h"
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace lampyr {
namespace {

Point3 PointIn(Rng& rng, float size) {
  const float x = rng.NextFloat(), y = rng.NextFloat(), z = rng.NextFloat();
  return size * (Point3(x, y, z) - Point3(0.5f));
}

// From within or without, of any direction; now and then along an axis, and through the middle of what there is.
Ray RayOf(Rng& rng, int i) {
  Ray ray;
  ray.origin = PointIn(rng, 3);
  ray.direction = SampleUniformSphere({rng.NextFloat(), rng.NextFloat()});
  if (i % 4 == 0) ray.direction = glm::normalize(PointIn(rng, 0.3f) - ray.origin);
  if (i % 8 == 1) ray.direction = Vector3(i % 16 == 1 ? 1.0f : 0.0f, i % 16 == 1 ? 0.0f : -1.0f, 0.0f);
  return ray;
}

TEST(BeamSearch, FindsTheBallsThatASearchThroughAllFinds) {
  Rng rng(3);
  for (const size_t count : {size_t{1}, size_t{8}, size_t{9}, size_t{700}}) {
    std::vector<VolumePhoton> balls(count);
    for (VolumePhoton& ball : balls) {
      ball.position = PointIn(rng, rng.NextFloat() < 0.5f ? 2.0f : 0.2f);
      ball.radius = 0.1f * rng.NextFloat();
    }
    const BeamSearch search(balls);
    size_t found = 0;
    for (int i = 0; i < 400; ++i) {
      const Ray ray = RayOf(rng, i);
      const float tMax = i % 3 == 0 ? rng.NextFloat() * 3 : kInfinity;
      std::vector<uint32_t> boxes, expected, indices;
      std::vector<BeamHit> hits;
      search.Find(balls, ray, tMax, 100, boxes, hits);
      for (const BeamHit& hit : hits) indices.push_back(hit.index);
      for (uint32_t k = 0; k < count; ++k) {
        const Vector3d to = Vector3d(balls[k].position) - Vector3d(ray.origin);
        const double t = glm::dot(to, Vector3d(ray.direction));
        const double distance = glm::length(to - t * Vector3d(ray.direction));
        if (std::abs(distance - static_cast<double>(balls[k].radius)) < 1e-5) continue;  // rounding decides
        if (t < 0 || t >= static_cast<double>(tMax) || distance > static_cast<double>(balls[k].radius)) continue;
        expected.push_back(100 + k);
      }
      for (const uint32_t index : expected)
        EXPECT_EQ(std::count(indices.begin(), indices.end(), index), 1) << "of " << count;
      EXPECT_LE(indices.size(), expected.size() + 1);
      EXPECT_TRUE(std::is_sorted(indices.begin(), indices.end()));
      found += expected.size();
    }
    EXPECT_GT(found, count / 8);
  }
}

BeamList Flights(Rng& rng, size_t count) {
  BeamList list;
  for (size_t i = 0; i < count; ++i) {
    FlightStart start;
    start.position = Point3d(PointIn(rng, 2));
    start.direction = Vector3d(SampleUniformSphere({rng.NextFloat(), rng.NextFloat()}));
    if (i % 5 == 0) start.direction = Vector3d(0, 0, 1);
    // In two media, with a gap.
    for (const float from : {0.0f, 0.7f}) {
      PhotonBeam beam;
      beam.step.tMin = from;
      beam.step.tMax = from + 0.6f * rng.NextFloat();
      beam.start = static_cast<uint32_t>(list.starts.size());
      list.beams.push_back(beam);
    }
    list.starts.push_back(start);
  }
  return list;
}

// The parameters t and s of the nearest points of start + t·a and other + s·b, by the two equations that say that the
// way between them is perpendicular to both.
std::pair<double, double> NearestOf(const FineLine& line, const FlightStart& start) {
  const Vector3d &a = line.direction, &b = start.direction, way = start.position - line.start;
  const double ab = glm::dot(a, b), determinant = 1 - ab * ab;
  return {(glm::dot(way, a) - ab * glm::dot(way, b)) / determinant,
          (ab * glm::dot(way, a) - glm::dot(way, b)) / determinant};
}

TEST(BeamMap, FindsTheCrossingsThatASearchThroughAllFinds) {
  Rng rng(5);
  for (const double slope : {0.0, 0.01}) {
    VolumeRadius radius;
    radius.constant = 0.02;
    radius.perLength = slope;
    radius.eye = Point3(0, 0, 2);
    const VolumeRadius scaled = radius.Scaled(0.7);
    const BeamList list = Flights(rng, 300);
    const BeamMap map(list, scaled);
    size_t found = 0;
    for (int i = 0; i < 600; ++i) {
      const Ray ray = RayOf(rng, i);
      const float tMax = i % 3 == 0 ? rng.NextFloat() * 3 : kInfinity;
      const FineLine line{Point3d(ray.origin), Vector3d(ray.direction)};
      std::vector<uint32_t> boxes;
      std::vector<BeamCrossing> crossings;
      map.Find(ray, line, tMax, boxes, crossings);
      std::map<uint32_t, BeamCrossing> byBeam;
      for (const BeamCrossing& crossing : crossings)
        EXPECT_TRUE(byBeam.emplace(crossing.beam, crossing).second) << "found twice";
      for (uint32_t k = 0; k < list.beams.size(); ++k) {
        const PhotonBeam& beam = list.beams[k];
        const FlightStart& start = list.starts[beam.start];
        const auto [t, s] = NearestOf(line, start);
        const Point3d here = line.start + t * line.direction;
        const double apart = glm::distance(here, start.position + s * start.direction);
        const Point3d there = start.position + s * start.direction;
        const double width = 0.7 * 0.7 * (0.02 + slope * glm::distance(there, Point3d(radius.eye)));
        const bool isThere = t >= 0 && t < static_cast<double>(tMax) && s >= static_cast<double>(beam.step.tMin) &&
                             s < static_cast<double>(beam.step.tMax) && apart < width;
        if (std::abs(apart - width) < 1e-6) continue;  // rounding decides
        ASSERT_EQ(byBeam.count(k), isThere ? 1u : 0u) << "ray " << i << ", beam " << k;
        if (!isThere) continue;
        ++found;
        EXPECT_NEAR(byBeam[k].t, t, 1e-9);
        EXPECT_NEAR(byBeam[k].tBeam, s, 1e-9);
        EXPECT_NEAR(static_cast<double>(byBeam[k].radius), width, 1e-6);
        EXPECT_NEAR(static_cast<double>(byBeam[k].sine), glm::length(glm::cross(line.direction, start.direction)),
                    1e-6);
      }
    }
    EXPECT_GT(found, 100u);
  }
}

}  // namespace
}  // namespace lampyr
