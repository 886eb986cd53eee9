// See loop_subdivision.h. A half-edge h = 3·face + k runs from the face's corner k to the next; its twin runs back in
// the neighbouring face. Refinement computes the twins of the children without searching.
#include "geometry/loop_subdivision.h"

#include <numeric>
#include <span>
#include <string>

namespace lampyr {

namespace {

using Face = std::array<uint32_t, 3>;
constexpr uint32_t kNone = 0xffffffffu;
constexpr double kTwoPi = 2 * 3.14159265358979323846;

uint32_t Next(uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
uint32_t Previous(uint32_t h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

struct Mesh {
  std::vector<Point3d> positions;
  std::vector<Face> faces;
  std::vector<uint32_t> twins;  // by half-edge; kNone at the boundary

  uint32_t From(uint32_t h) const { return faces[h / 3][h % 3]; }
  uint32_t To(uint32_t h) const { return From(Next(h)); }
  uint32_t HalfEdges() const { return static_cast<uint32_t>(twins.size()); }
};

void CheckInput(const std::vector<Point3>& positions, const std::vector<Face>& faces, int levels,
                const FileLocation& where) {
  if (levels < 0) throw Error(where, "loopsubdiv: the number of levels is negative");
  constexpr double kMostFaces = 1 << 28;
  if (static_cast<double>(faces.size()) * std::pow(4.0, levels) > kMostFaces) {
    throw Error(where, "loopsubdiv: " + std::to_string(levels) + " levels of " + std::to_string(faces.size()) +
                           " faces make more than 268 million triangles");
  }
  for (size_t i = 0; i < positions.size(); ++i) {
    if (!IsFinite(positions[i])) throw Error(where, "loopsubdiv: vertex " + std::to_string(i) + " is not finite");
  }
  for (size_t i = 0; i < faces.size(); ++i) {
    const Face& f = faces[i];
    if (std::max({f[0], f[1], f[2]}) >= positions.size()) {
      throw Error(where, "loopsubdiv: face " + std::to_string(i) + " has an index beyond the " +
                             std::to_string(positions.size()) + " vertices");
    }
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
      throw Error(where, "loopsubdiv: face " + std::to_string(i) + " has the same vertex twice");
    }
  }
}

// Joins the half edges of one edge. Where more than two faces share it, each is joined to the first free one before it
// that runs the other way, in the order of the faces: published meshes have such edges, and renderers accept them.
void PairHalfEdges(Mesh& mesh, std::span<const std::pair<uint64_t, uint32_t>> halfEdges, const FileLocation& where) {
  // All free half edges, from `next` on, run the same way.
  std::vector<uint32_t> free;
  size_t next = 0;
  for (const auto& [edge, b] : halfEdges) {
    if (next == free.size() || mesh.From(free[next]) == mesh.From(b)) {
      free.push_back(b);
      continue;
    }
    const uint32_t a = free[next++];
    mesh.twins[a] = b;
    mesh.twins[b] = a;
  }
  const uint32_t first = halfEdges[0].second;
  if (halfEdges.size() == 2 && mesh.twins[first] == kNone) {
    throw Error(where, "loopsubdiv: the faces at the edge between vertices " + std::to_string(mesh.From(first)) +
                           " and " + std::to_string(mesh.To(first)) + " are wound in opposite directions");
  }
}

void FindTwins(Mesh& mesh, const FileLocation& where) {
  mesh.twins.assign(3 * mesh.faces.size(), kNone);
  std::vector<std::pair<uint64_t, uint32_t>> edges;  // by their two vertices
  edges.reserve(mesh.twins.size());
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    const auto [low, high] = std::minmax({mesh.From(h), mesh.To(h)});  // a list: values, not references
    edges.emplace_back((static_cast<uint64_t>(low) << 32) | high, h);
  }
  std::sort(edges.begin(), edges.end());
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].first == edges[begin].first) ++end;
    PairHalfEdges(mesh, std::span(edges).subspan(begin, end - begin), where);
  }
}

// Gives every fan of faces around a vertex a vertex of its own, and drops vertices without faces.
void SeparateFans(Mesh& mesh) {
  std::vector<uint32_t> root(mesh.twins.size());  // union-find over the corners of faces; corner h is at From(h)
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&root](uint32_t c) {
    while (root[c] != c) c = root[c] = root[root[c]];
    return c;
  };
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    const uint32_t twin = mesh.twins[h];
    if (twin == kNone || twin < h) continue;
    root[find(h)] = find(Next(twin));
    root[find(Next(h))] = find(twin);
  }
  // Numbered in the order of the control vertices, so that equal input gives equal output.
  std::vector<uint32_t> roots;
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    if (find(h) == h) roots.push_back(h);
  }
  std::stable_sort(roots.begin(), roots.end(), [&](uint32_t a, uint32_t b) { return mesh.From(a) < mesh.From(b); });
  std::vector<uint32_t> number(mesh.twins.size());
  std::vector<Point3d> positions;
  for (const uint32_t r : roots) {
    number[r] = static_cast<uint32_t>(positions.size());
    positions.push_back(mesh.positions[mesh.From(r)]);
  }
  std::vector<Face> faces(mesh.faces.size());
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) faces[h / 3][h % 3] = number[find(h)];
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
}

// Weight of each neighbour of an interior vertex ([Warren95]).
double RingWeight(uint32_t valence) {
  return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence);
}

// Sums over all neighbours of a vertex, and over those along the boundary.
struct Neighbourhood {
  std::vector<Point3d> sums, boundarySums;
  std::vector<uint32_t> valences;
  std::vector<bool> isBoundary;
};

Neighbourhood GetNeighbourhood(const Mesh& mesh) {
  const size_t count = mesh.positions.size();
  Neighbourhood n{std::vector<Point3d>(count, Point3d(0.0)), std::vector<Point3d>(count, Point3d(0.0)),
                  std::vector<uint32_t>(count, 0), std::vector<bool>(count, false)};
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    if (mesh.twins[h] != kNone && mesh.twins[h] < h) continue;
    const uint32_t a = mesh.From(h), b = mesh.To(h);
    n.sums[a] += mesh.positions[b];
    n.sums[b] += mesh.positions[a];
    ++n.valences[a];
    ++n.valences[b];
    if (mesh.twins[h] == kNone) {
      n.boundarySums[a] += mesh.positions[b];
      n.boundarySums[b] += mesh.positions[a];
      n.isBoundary[a] = n.isBoundary[b] = true;
    }
  }
  return n;
}

// Blends every vertex with its neighbours; `interior(valence)` and `boundary` are the weights of one neighbour.
template <class InteriorWeight>
std::vector<Point3d> Blend(const Mesh& mesh, const InteriorWeight& interior, double boundary) {
  const Neighbourhood n = GetNeighbourhood(mesh);
  std::vector<Point3d> blended(mesh.positions.size());
  for (size_t i = 0; i < blended.size(); ++i) {
    const double weight = n.isBoundary[i] ? boundary : interior(n.valences[i]);
    const double total = weight * (n.isBoundary[i] ? 2 : n.valences[i]);
    blended[i] = mesh.positions[i] * (1 - total) + (n.isBoundary[i] ? n.boundarySums[i] : n.sums[i]) * weight;
  }
  return blended;
}

Point3d EdgePoint(const Mesh& mesh, uint32_t h) {
  const Point3d ends = mesh.positions[mesh.From(h)] + mesh.positions[mesh.To(h)];
  const uint32_t twin = mesh.twins[h];
  if (twin == kNone) return ends * 0.5;
  return ends * 0.375 + (mesh.positions[mesh.From(Previous(h))] + mesh.positions[mesh.From(Previous(twin))]) * 0.125;
}

// Children of face f: 4f + k at corner k (corner, its edge's point, the previous edge's point), 4f + 3 in the middle.
Mesh Refine(const Mesh& mesh) {
  Mesh fine;
  fine.positions = Blend(mesh, RingWeight, 1.0 / 8);
  std::vector<uint32_t> edgePoints(mesh.twins.size());
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    const uint32_t twin = mesh.twins[h];
    if (twin != kNone && twin < h) {
      edgePoints[h] = edgePoints[twin];
    } else {
      edgePoints[h] = static_cast<uint32_t>(fine.positions.size());
      fine.positions.push_back(EdgePoint(mesh, h));
    }
  }
  fine.faces.resize(4 * mesh.faces.size());
  fine.twins.resize(4 * mesh.twins.size());
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    const uint32_t face = h / 3, k = h % 3, child = 4 * face + k, middle = 4 * face + 3;
    const uint32_t before = Previous(h);
    fine.faces[child] = {mesh.From(h), edgePoints[h], edgePoints[before]};
    fine.faces[middle][k] = edgePoints[h];
    const uint32_t twin = mesh.twins[h], twinBefore = mesh.twins[before];
    const auto childAt = [](uint32_t corner) { return 3 * (4 * (corner / 3) + corner % 3); };
    fine.twins[3 * child] = twin == kNone ? kNone : childAt(Next(twin)) + 2;
    fine.twins[3 * child + 1] = 3 * middle + (k + 2) % 3;
    fine.twins[3 * child + 2] = twinBefore == kNone ? kNone : childAt(twinBefore);
    fine.twins[3 * middle + (k + 2) % 3] = 3 * child + 1;
  }
  return fine;
}

// The neighbours of From(start) counter-clockwise; at a boundary, from end to end, where `start` has no twin.
void GetRing(const Mesh& mesh, uint32_t start, std::vector<Point3d>& ring) {
  ring.clear();
  uint32_t h = start;
  do {
    ring.push_back(mesh.positions[mesh.To(h)]);
    const uint32_t incoming = Previous(h);
    if (mesh.twins[incoming] == kNone) {
      ring.push_back(mesh.positions[mesh.From(incoming)]);
      return;
    }
    h = mesh.twins[incoming];
  } while (h != start);
}

// Tangents of the limit surface by the masks of [Hoppe94]; their cross product points against the winding.
Vector3d InteriorNormal(const std::vector<Point3d>& ring) {
  Vector3d s(0.0), t(0.0);
  for (size_t j = 0; j < ring.size(); ++j) {
    const double angle = kTwoPi * static_cast<double>(j) / static_cast<double>(ring.size());
    s += ring[j] * std::cos(angle);
    t += ring[j] * std::sin(angle);
  }
  return glm::cross(t, s);
}

Vector3d BoundaryNormal(const Point3d& p, const std::vector<Point3d>& ring) {
  const size_t count = ring.size();
  const Vector3d along = ring[count - 1] - ring[0];
  Vector3d inwards;
  if (count == 2) {
    inwards = ring[0] + ring[1] - p * 2.0;
  } else if (count == 3) {
    inwards = ring[1] - p;
  } else if (count == 4) {
    inwards = (ring[1] + ring[2]) * 2.0 - ring[0] - ring[3] - p * 2.0;
  } else {
    const double theta = 0.5 * kTwoPi / static_cast<double>(count - 1);
    inwards = (ring[0] + ring[count - 1]) * -std::sin(theta);
    for (size_t k = 1; k + 1 < count; ++k) {
      inwards += ring[k] * ((2 - 2 * std::cos(theta)) * std::sin(static_cast<double>(k) * theta));
    }
  }
  return glm::cross(along, inwards);
}

// Also against the winding; used for vertices whose tangents vanish.
Vector3d FaceNormal(const Mesh& mesh, uint32_t h) {
  const Point3d& p = mesh.positions[mesh.From(h)];
  return glm::cross(mesh.positions[mesh.From(Previous(h))] - p, mesh.positions[mesh.To(h)] - p);
}

std::vector<Normal3> LimitNormals(const Mesh& mesh) {
  std::vector<uint32_t> starts(mesh.positions.size(), kNone);
  for (uint32_t h = 0; h < mesh.HalfEdges(); ++h) {
    uint32_t& start = starts[mesh.From(h)];
    if (start == kNone || mesh.twins[h] == kNone) start = h;
  }
  std::vector<Normal3> normals(starts.size());
  std::vector<Point3d> ring;
  for (size_t i = 0; i < starts.size(); ++i) {
    GetRing(mesh, starts[i], ring);
    const bool boundary = mesh.twins[starts[i]] == kNone;
    Vector3d normal = boundary ? BoundaryNormal(mesh.positions[i], ring) : InteriorNormal(ring);
    if (!(glm::dot(normal, normal) > 0)) normal = FaceNormal(mesh, starts[i]);
    const double length = glm::length(normal);
    normals[i] = length > 0 ? Normal3(normal / length) : Normal3(0, 0, 1);
  }
  return normals;
}

}  // namespace

SubdividedMesh Subdivide(const std::vector<Point3>& positions, const std::vector<Face>& triangles, int levels,
                         const FileLocation& where) {
  CheckInput(positions, triangles, levels, where);
  Mesh mesh;
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.faces = triangles;
  FindTwins(mesh, where);
  SeparateFans(mesh);
  for (int i = 0; i < levels; ++i) mesh = Refine(mesh);

  const auto limitWeight = [](uint32_t valence) { return 1.0 / (valence + 3.0 / (8.0 * RingWeight(valence))); };
  // At boundaries pbrt-v4's 1/5, for the same picture at the same level; the true limit of the rule above has 1/6.
  const std::vector<Point3d> limit = Blend(mesh, limitWeight, 1.0 / 5);
  SubdividedMesh result;
  result.positions.reserve(limit.size() + 1);  // the intersector reads past the last vertex
  for (const Point3d& p : limit) result.positions.emplace_back(p);
  result.normals = LimitNormals(mesh);
  result.triangles = std::move(mesh.faces);
  return result;
}

}  // namespace lampyr
