#include "suite/filter_edges.h"

#include <cstdio>
#include <cstring>

namespace lampyr::suite {

namespace {

// Distance of neighbours, relative to the edge's own size: some hundred times the rounding of float.
constexpr double kNeighbour = 1e-5;

double Between(Rng& rng, double low, double high) {
  return low + (high - low) * static_cast<double>(rng.NextFloat());
}
Vector3d InBox(Rng& rng, double half) {
  const double x = Between(rng, -half, half), y = Between(rng, -half, half);
  return {x, y, Between(rng, -half, half)};
}
Vector3d OnSphere(Rng& rng) {
  for (;;) {
    const Vector3d v = InBox(rng, 1);
    const double squared = glm::dot(v, v);
    if (squared > 1e-2 && squared <= 1) return v / std::sqrt(squared);
  }
}

std::string Format(const char* format, double a, double b, double c) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}
std::string SayVector(const Vector3& v) {
  return Format("(%.6g %.6g %.6g)", static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

}  // namespace

std::vector<SuiteEdge> SuiteEdges(Rng& rng, int perKind) {
  std::vector<SuiteEdge> edges;
  const auto join = [&](const char* kind, const Point3d& receiver, const Point3d& light) -> SuiteEdge& {
    return edges.emplace_back(SuiteEdge{kind, receiver, light - receiver});
  };
  const auto below = [&] { return Point3d(InBox(rng, 1).x, InBox(rng, 1).x, Between(rng, -4, -1.05)); };
  const auto onLight = [&] { return Point3d(Between(rng, -0.3, 0.3), Between(rng, -0.3, 0.3), 0); };
  for (int i = 0; i < perKind; ++i) {
    join("random", InBox(rng, 3), InBox(rng, 3));
    const Point3d lit = below();
    join("in the beam", lit * Vector3d(-0.3 * lit.z, -0.3 * lit.z, 1), onLight());
    join("from a point", below(), Point3d(0.0)).isDelta = true;
    join("inside", InBox(rng, 0.5), InBox(rng, 3));
    const Point3d close = InBox(rng, 1.5);
    join("near", close, close + 1e-3 * OnSphere(rng));
    join("far", 1e4 * OnSphere(rng), onLight());
    join("behind", Point3d(InBox(rng, 1).x, InBox(rng, 1).x, Between(rng, 0.1, 3)), onLight());
    const Point3d level = below();
    join("grazing", level, level + Vector3d(3 * OnSphere(rng).x, 3 * OnSphere(rng).y, Between(rng, -1e-3, 1e-3)));
    const Vector3d upwards = OnSphere(rng);
    edges.push_back({"from infinity", below(), {0.5 * upwards.x, 0.5 * upwards.y, 1}, true, i % 2 == 0});
    edges.push_back({"from infinity, all around", InBox(rng, 2), OnSphere(rng), true, false});
  }
  for (const double z : {-0.3, -1.0, -1.5, -2.0, -30.0, 0.7}) {
    join("on the axis", {0, 0, z}, Point3d(0.0)).isDelta = true;
    edges.push_back({"along the axis, from infinity", {0, 0, z}, {0, 0, 1}, true, true});
  }
  join("at the origin", Point3d(0.0), {0.2, 0.1, 0.9});
  join("just below the origin", {0, 0, -1e-30}, {0.2, 0.1, 0.9});
  join("level with the origin", {0.4, -0.2, 0}, {1.4, 0.8, 0});
  join("towards the plane of the window", {0.1, 0.2, -2}, {0.1, 0.1, -1});
  return edges;
}

std::vector<SuiteEdge> Neighbours(const SuiteEdge& edge, Rng& rng) {
  std::vector<SuiteEdge> all = {edge};
  const double reach =
      kNeighbour * (1 + std::max({std::abs(edge.receiver.x), std::abs(edge.receiver.y), std::abs(edge.receiver.z)}));
  const double turn = kNeighbour * glm::length(edge.toLight);
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d unit(0.0);
    unit[axis] = 1;
    for (const double sign : {-1.0, 1.0}) {
      all.push_back(edge);
      all.back().receiver += sign * reach * unit;
      all.push_back(edge);
      all.back().toLight += sign * turn * unit;
    }
  }
  for (int i = 0; i < 8; ++i) {
    all.push_back(edge);
    all.back().receiver += reach * InBox(rng, 1);
    all.back().toLight += turn * InBox(rng, 1);
  }
  for (const double length : {1 - 2 * kNeighbour, 1 + 2 * kNeighbour}) {
    all.push_back(edge);
    all.back().toLight *= length;
  }
  return all;
}

bool IsSame(const Filtered& a, const Filtered& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

EdgeBatch::EdgeBatch(std::span<const SuiteEdge> edges, const Transform& placement, Rng& rng) {
  for (const SuiteEdge& edge : edges) {
    const Vector3d towards = placement.Vector(edge.toLight);
    const double distance = glm::length(towards);
    kinds.push_back(edge.kind);
    receivers.emplace_back(placement.Point(edge.receiver));
    toLights.emplace_back(towards / distance);
    distances.push_back(edge.isInfinite ? kInfinity : static_cast<float>(distance));
    pdfs.emplace_back(edge.isDelta ? 1.0f : 0.1f + 9 * rng.NextFloat());
  }
  diffuse.assign(edges.size(), Color(1.0f));
  specular.assign(edges.size(), Color(1.0f));
}

EdgeBatch EdgeBatch::Pick(std::span<const size_t> indices) const {
  EdgeBatch picked;
  for (const size_t i : indices) {
    picked.kinds.push_back(kinds[i]);
    picked.receivers.push_back(receivers[i]);
    picked.toLights.push_back(toLights[i]);
    picked.distances.push_back(distances[i]);
    picked.pdfs.push_back(pdfs[i]);
    picked.diffuse.push_back(diffuse[i]);
    picked.specular.push_back(specular[i]);
  }
  return picked;
}

std::vector<Filtered> EdgeBatch::Filter(const LightFilter& filter, const FilterContext& context) const {
  std::vector<Color> leftDiffuse = diffuse, leftSpecular = specular;
  filter.Filter(context, {static_cast<int>(Size()), receivers.data(), toLights.data(), distances.data(), pdfs.data(),
                          leftDiffuse.data(), leftSpecular.data()});
  std::vector<Filtered> left(Size());
  for (size_t i = 0; i < Size(); ++i) left[i] = {leftDiffuse[i], leftSpecular[i]};
  return left;
}

Filtered EdgeBatch::FilterOne(size_t i, const LightFilter& filter, const FilterContext& context) const {
  Filtered left{diffuse[i], specular[i]};
  filter.Filter(context, {1, &receivers[i], &toLights[i], &distances[i], &pdfs[i], &left.diffuse, &left.specular});
  return left;
}

std::string EdgeBatch::Say(size_t i) const {
  const auto distance = static_cast<double>(distances[i]);
  return std::string("edge ") + kinds[i] + ", receiver " + SayVector(receivers[i]) + ", light towards " +
         SayVector(toLights[i]) + (std::isinf(distance) ? " at infinity" : Format(" at distance %.6g", distance, 0, 0));
}

std::string Say(const Color& color) {
  return Format("(%.6g %.6g %.6g)", static_cast<double>(color.r), static_cast<double>(color.g),
                static_cast<double>(color.b));
}

}  // namespace lampyr::suite
