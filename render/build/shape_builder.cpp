#include "render/build/shape_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/loop_subdivision.h"
#include "geometry/ply.h"

namespace lampyr {

namespace {

using Names = std::vector<std::string>;

constexpr double kDegreesToRadians = 3.14159265358979323846 / 180;

std::string Count(size_t n) {
  return std::to_string(n);
}

// Corner indices in groups of N, each checked against the number of vertices.
template <size_t N>
std::vector<std::array<uint32_t, N>> GroupIndices(const ParameterList& parameters, const std::vector<int64_t>& indices,
                                                  size_t vertexCount) {
  if (indices.size() % N != 0) {
    throw Error(parameters.WhereOf("indices"), "the number of \"indices\" must be a multiple of " + Count(N) +
                                                   ", and there are " + Count(indices.size()));
  }
  std::vector<std::array<uint32_t, N>> groups(indices.size() / N);
  for (size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < 0 || static_cast<size_t>(indices[i]) >= vertexCount) {
      throw Error(parameters.WhereOf("indices"), "index " + std::to_string(indices[i]) +
                                                     " is out of range: there are " + Count(vertexCount) +
                                                     " vertices in \"P\"");
    }
    groups[i / N][i % N] = static_cast<uint32_t>(indices[i]);
  }
  return groups;
}

// Vertices, and per-vertex data that is dropped with a warning when there is not one for each vertex, as pbrt does.
LocalMesh ReadVertices(const ParameterList& parameters, Diagnostics& diagnostics) {
  LocalMesh mesh;
  mesh.positions = parameters.GetPoint3s("P");
  if (mesh.positions.empty()) throw Error(parameters.Where(), parameters.Owner() + " needs vertices: \"point3 P\"");
  for (const Point2d& uv : parameters.GetPoint2s("uv")) mesh.uvs.push_back(Point2(uv));
  mesh.normals = parameters.GetPoint3s("N");
  const auto check = [&](const char* name, size_t count) {
    if (count == 0 || count == mesh.positions.size()) return true;
    diagnostics.Warn(parameters.WhereOf(name), std::string("\"") + name + "\" has " + Count(count) + " values for " +
                                                   Count(mesh.positions.size()) + " vertices and is not used");
    return false;
  };
  if (!check("uv", mesh.uvs.size())) mesh.uvs.clear();
  if (!check("N", mesh.normals.size())) mesh.normals.clear();
  return mesh;
}

LocalMesh ReadTriangleMesh(const ParameterList& parameters, Diagnostics& diagnostics) {
  LocalMesh mesh = ReadVertices(parameters, diagnostics);
  std::vector<int64_t> indices = parameters.GetIntegers("indices");
  if (indices.empty()) {
    if (mesh.positions.size() != 3)
      throw Error(parameters.Where(),
                  parameters.Owner() + " needs \"integer indices\" (they may be left out for a single triangle)");
    indices = {0, 1, 2};
  }
  mesh.triangles = GroupIndices<3>(parameters, indices, mesh.positions.size());
  parameters.CheckAllUsed({"S", "faceIndices"}, {"P", "indices", "N", "uv", "alpha"}, diagnostics);
  return mesh;
}

LocalMesh ReadBilinearMesh(const ParameterList& parameters, Diagnostics& diagnostics) {
  LocalMesh mesh = ReadVertices(parameters, diagnostics);
  std::vector<int64_t> indices = parameters.GetIntegers("indices");
  if (indices.empty()) {
    if (mesh.positions.size() != 4)
      throw Error(parameters.Where(),
                  parameters.Owner() + " needs \"integer indices\" (they may be left out for a single patch)");
    indices = {0, 1, 2, 3};
  }
  mesh.patches = GroupIndices<4>(parameters, indices, mesh.positions.size());
  parameters.CheckAllUsed({"faceIndices", "emissionfilename"}, {"P", "indices", "N", "uv", "alpha"}, diagnostics);
  return mesh;
}

// Memory of a triangle or patch as read, as placed, and in the intersector: a round number below the measured one.
constexpr double kBytesPerFace = 128;

// Memory of a segment of a curve as divided, here and in the intersector: a round number below the measured one.
constexpr double kBytesPerSegment = 256;

LocalMesh ReadSubdivision(const ParameterList& parameters, MemoryBudget& memory, Diagnostics& diagnostics) {
  const std::vector<Point3d> controlPoints = parameters.GetPoint3s("P");
  if (controlPoints.empty()) throw Error(parameters.Where(), parameters.Owner() + " needs vertices: \"point3 P\"");
  const std::vector<int64_t> indices = parameters.GetIntegers("indices");
  if (indices.empty()) throw Error(parameters.Where(), parameters.Owner() + " needs \"integer indices\"");
  const auto triangles = GroupIndices<3>(parameters, indices, controlPoints.size());
  const int levels = parameters.GetInteger("levels", 3);
  constexpr int maxLevels = 10;
  if (levels < 0 || levels > maxLevels)
    throw Error(parameters.WhereOf("levels"), "\"levels\" must be from 0 to " + std::to_string(maxLevels));
  const std::string scheme = parameters.GetString("scheme", "loop");
  if (scheme != "loop")
    throw Error(parameters.WhereOf("scheme"), "there is no subdivision scheme \"" + scheme + "\"; there is: loop");
  parameters.CheckAllUsed({}, {"P", "indices", "levels", "scheme", "alpha"}, diagnostics);

  const double faces = static_cast<double>(triangles.size()) * std::pow(4.0, levels);
  if (faces > 0) {
    memory.Take(faces * kBytesPerFace, parameters.WhereOf("levels"),
                std::to_string(levels) + " levels of " + Count(triangles.size()) + " faces make " +
                    Count(static_cast<size_t>(faces)) + " triangles, which");
  }
  std::vector<Point3> positions;
  for (const Point3d& p : controlPoints) positions.push_back(Point3(p));
  const SubdividedMesh subdivided = Subdivide(positions, triangles, levels, parameters.Where());
  LocalMesh mesh;
  for (const Point3& p : subdivided.positions) mesh.positions.push_back(Point3d(p));
  for (const Normal3& n : subdivided.normals) mesh.normals.push_back(Vector3d(n));
  mesh.triangles = subdivided.triangles;
  return mesh;
}

LocalMesh ReadPlyMesh(const ParameterList& parameters, MemoryBudget& memory, Diagnostics& diagnostics) {
  const std::string file = parameters.GetFile("filename");
  if (file.empty()) throw Error(parameters.Where(), parameters.Owner() + " needs \"string filename\"");
  PlyMesh ply = ReadPly(file, parameters.WhereOf("filename"));
  if (parameters.GetTextureName("displacement")) {
    diagnostics.Warn(parameters.WhereOf("displacement"),
                     "displacement of meshes is not supported; the mesh is rendered without");
  }
  parameters.CheckAllUsed({"displacement", "edgelength"}, {"filename", "alpha"}, diagnostics);
  if (ply.missingNormals > 0) {
    diagnostics.Warn(parameters.WhereOf("filename"),
                     std::to_string(ply.missingNormals) + " of the " + std::to_string(ply.normals.size()) +
                         " normals of \"" + file +
                         "\" are not finite, or beyond 1e18: the mesh is rendered without those");
  }
  // Counted for each use: the same file may be named many times.
  memory.Take(static_cast<double>(ply.triangles.size() + ply.quads.size()) * kBytesPerFace,
              parameters.WhereOf("filename"), "the faces of \"" + file + "\"");
  LocalMesh mesh;
  for (const Point3& p : ply.positions) mesh.positions.push_back(Point3d(p));
  for (const Normal3& n : ply.normals) mesh.normals.push_back(Vector3d(n));
  mesh.uvs = std::move(ply.uvs);
  mesh.triangles = std::move(ply.triangles);
  // Around the face -> p00, p10, p01, p11.
  for (const auto& quad : ply.quads) mesh.patches.push_back({quad[0], quad[1], quad[3], quad[2]});
  if (mesh.triangles.empty() && mesh.patches.empty()) {
    diagnostics.Warn(parameters.WhereOf("filename"), "\"" + file + "\" has no faces");
  }
  return mesh;
}

float Positive(const ParameterList& parameters, const std::string& name, double defaultValue) {
  const double value = parameters.GetFloat(name, defaultValue);
  if (!(value > 0)) throw Error(parameters.WhereOf(name), "\"" + name + "\" must be above 0");
  if (value < static_cast<double>(std::numeric_limits<float>::min()))  // 0 in single precision
    throw Error(parameters.WhereOf(name), "\"" + name + "\" is too small: at least 1.2e-38 is needed");
  return static_cast<float>(value);
}

Quadric ReadQuadric(Quadric::Kind kind, const ParameterList& parameters, Diagnostics& diagnostics) {
  Quadric quadric;
  quadric.kind = kind;
  quadric.radius = Positive(parameters, "radius", 1);
  const double phiMax = parameters.GetFloat("phimax", 360);
  if (!(phiMax > 0)) throw Error(parameters.WhereOf("phimax"), "\"phimax\" must be above 0 degrees");
  quadric.phiMax = phiMax >= 360 ? 2 * kPi : static_cast<float>(phiMax * kDegreesToRadians);
  Names known = {"radius", "phimax", "alpha"};
  if (kind == Quadric::Kind::Disk) {
    quadric.zMin = quadric.zMax = static_cast<float>(parameters.GetFloat("height", 0));
    quadric.innerRadius = static_cast<float>(parameters.GetFloat("innerradius", 0));
    if (quadric.innerRadius < 0 || quadric.innerRadius >= quadric.radius) {
      throw Error(parameters.WhereOf("innerradius"), "\"innerradius\" must be from 0 to below the radius");
    }
    known.insert(known.end(), {"height", "innerradius"});
  } else {
    const double defaultZ = kind == Quadric::Kind::Sphere ? double(quadric.radius) : 1;
    const double z0 = parameters.GetFloat("zmin", -defaultZ), z1 = parameters.GetFloat("zmax", defaultZ);
    quadric.zMin = static_cast<float>(std::min(z0, z1));
    quadric.zMax = static_cast<float>(std::max(z0, z1));
    if (kind == Quadric::Kind::Sphere) {
      quadric.zMin = std::clamp(quadric.zMin, -quadric.radius, quadric.radius);
      quadric.zMax = std::clamp(quadric.zMax, -quadric.radius, quadric.radius);
    }
    if (!(quadric.zMin < quadric.zMax))
      throw Error(parameters.Where(), parameters.Owner() + " is empty: \"zmin\" must be below \"zmax\"");
    known.insert(known.end(), {"zmin", "zmax"});
  }
  parameters.CheckAllUsed({}, known, diagnostics);
  return quadric;
}

CurveParameters ReadCurve(const ParameterList& parameters, Diagnostics& diagnostics) {
  CurveParameters curve;
  curve.where = parameters.Where();
  const std::string basis = parameters.GetString("basis", "bezier");
  if (basis != "bezier" && basis != "bspline")
    throw Error(parameters.WhereOf("basis"),
                "there is no curve basis \"" + basis + "\"" + DidYouMean(basis, {"bezier", "bspline"}));
  curve.basis = basis == "bezier" ? CurveParameters::Basis::Bezier : CurveParameters::Basis::BSpline;
  curve.degree = parameters.GetInteger("degree", 3);
  if (curve.degree != 2 && curve.degree != 3)
    throw Error(parameters.WhereOf("degree"), "the \"degree\" of a curve must be 2 or 3");
  const std::string type = parameters.GetString("type", "flat");
  const Names types = {"flat", "cylinder", "ribbon"};
  const auto found = std::find(types.begin(), types.end(), type);
  if (found == types.end())
    throw Error(parameters.WhereOf("type"), "there is no curve type \"" + type + "\"" + DidYouMean(type, types));
  curve.kind = static_cast<CurveSet::Kind>(found - types.begin());
  for (const Point3d& p : parameters.GetPoint3s("P")) curve.points.push_back(Point3(p));
  for (const Point3d& n : parameters.GetPoint3s("N")) curve.normals.push_back(Normal3(n));
  const double width = parameters.GetFloat("width", 1);
  curve.width0 = static_cast<float>(parameters.GetFloat("width0", width));
  curve.width1 = static_cast<float>(parameters.GetFloat("width1", width));
  parameters.CheckAllUsed({"splitdepth"}, {"P", "N", "basis", "degree", "type", "width", "width0", "width1", "alpha"},
                          diagnostics);
  return curve;
}

Bounds3d LocalBounds(const Quadric& quadric) {
  const double r = double(quadric.radius);
  Bounds3d bounds;
  bounds.Add(Point3d(-r, -r, double(quadric.zMin)));
  bounds.Add(Point3d(r, r, double(quadric.zMax)));
  return bounds;
}

void CheckPlaced(const Point3& p, const ShapeDescription& description) {
  if (IsFinite(p)) return;
  throw Error(description.shape.where,
              description.shape.parameters.Owner() +
                  " has a vertex that is not finite once it is placed: its coordinates are too large");
}

std::vector<Shape> PlaceMesh(const LocalMesh& local, const ShapeDescription& description, const Transform& toRender) {
  std::vector<Point3> positions;
  for (const Point3d& p : local.positions) {
    positions.push_back(Point3(toRender.Point(p)));
    CheckPlaced(positions.back(), description);
  }
  std::vector<Normal3> normals;
  for (const Vector3d& n : local.normals) {
    const Vector3d placed = toRender.Normal(n) * (description.reverseOrientation ? -1.0 : 1.0);
    const double length = glm::length(placed);
    normals.push_back(length > 0 ? Normal3(placed / length) : Normal3(0.0f));
  }
  const bool flip = description.reverseOrientation != toRender.SwapsHandedness();
  std::vector<Shape> shapes;
  if (!local.triangles.empty()) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = positions;
    mesh->triangles = local.triangles;
    mesh->normals = normals;
    mesh->uvs = local.uvs;
    mesh->flipNormals = flip;
    shapes.emplace_back(std::shared_ptr<const TriangleMesh>(std::move(mesh)));
  }
  if (!local.patches.empty()) {
    auto mesh = std::make_shared<BilinearMesh>();
    mesh->positions = positions;
    mesh->patches = local.patches;
    mesh->normals = normals;
    mesh->uvs = local.uvs;
    mesh->flipNormals = flip;
    shapes.emplace_back(std::shared_ptr<const BilinearMesh>(std::move(mesh)));
  }
  return shapes;
}

}  // namespace

std::optional<LocalShape> ReadShape(const ShapeDescription& description, MemoryBudget& memory,
                                    Diagnostics& diagnostics) {
  const std::string& type = description.shape.type;
  const ParameterList& parameters = description.shape.parameters;
  parameters.Find("alpha");  // marked as used here; read where the textures are known
  LocalShape local;
  local.description = &description;
  if (type == "trianglemesh") {
    local.shape = ReadTriangleMesh(parameters, diagnostics);
  } else if (type == "plymesh") {
    local.shape = ReadPlyMesh(parameters, memory, diagnostics);
  } else if (type == "loopsubdiv") {
    local.shape = ReadSubdivision(parameters, memory, diagnostics);
  } else if (type == "bilinearmesh") {
    local.shape = ReadBilinearMesh(parameters, diagnostics);
  } else if (type == "sphere") {
    local.shape = ReadQuadric(Quadric::Kind::Sphere, parameters, diagnostics);
  } else if (type == "disk") {
    local.shape = ReadQuadric(Quadric::Kind::Disk, parameters, diagnostics);
  } else if (type == "cylinder") {
    local.shape = ReadQuadric(Quadric::Kind::Cylinder, parameters, diagnostics);
  } else if (type == "curve") {
    local.shape = ReadCurve(parameters, diagnostics);
  } else {
    const Names known = {"trianglemesh", "plymesh", "loopsubdiv", "bilinearmesh",
                         "sphere",       "disk",    "cylinder",   "curve"};
    throw Error(description.shape.where, "there is no Shape \"" + type + "\"" + DidYouMean(type, known));
  }
  if (const LocalMesh* mesh = std::get_if<LocalMesh>(&local.shape)) {
    if (mesh->triangles.empty() && mesh->patches.empty()) return std::nullopt;
  }
  return local;
}

Bounds3d GetBounds(const LocalShape& shape, const Transform& toWorld) {
  Bounds3d bounds;
  if (const LocalMesh* mesh = std::get_if<LocalMesh>(&shape.shape)) {
    for (const Point3d& p : mesh->positions) bounds.Add(toWorld.Point(p));
  } else if (const Quadric* quadric = std::get_if<Quadric>(&shape.shape)) {
    const Bounds3d local = LocalBounds(*quadric);
    for (int i = 0; i < 8; ++i) bounds.Add(toWorld.Point(local.Corner(i)));
  } else {
    for (const Point3& p : std::get<CurveParameters>(shape.shape).points) bounds.Add(toWorld.Point(Point3d(p)));
  }
  return bounds;
}

std::vector<Shape> PlaceShape(const LocalShape& shape, const Transform& toRender, MemoryBudget& memory) {
  const ShapeDescription& description = *shape.description;
  if (const LocalMesh* mesh = std::get_if<LocalMesh>(&shape.shape)) return PlaceMesh(*mesh, description, toRender);
  if (!toRender.IsAffine())
    throw Error(description.shape.where, description.shape.parameters.Owner() + " cannot have a perspective transform");
  if (const Quadric* local = std::get_if<Quadric>(&shape.shape)) {
    Quadric quadric = *local;
    quadric.toRender = toRender.ToAffine();
    quadric.toObject = toRender.Inverse().ToAffine();
    quadric.flipNormals = description.reverseOrientation != toRender.SwapsHandedness();
    const Bounds3d bounds = LocalBounds(quadric);
    for (int i = 0; i < 8; ++i) CheckPlaced(Point3(toRender.Point(bounds.Corner(i))), description);
    return {quadric};
  }
  CurveParameters curve = std::get<CurveParameters>(shape.shape);
  curve.toRender = toRender;
  const size_t segments = CountDividedSegments(curve);
  memory.Take(static_cast<double>(segments) * kBytesPerSegment, description.shape.where,
              "the segments of this curve, " + Count(segments) + " where bent ones are divided,");
  return {std::make_shared<const CurveSet>(MakeCurves(curve))};
}

}  // namespace lampyr
