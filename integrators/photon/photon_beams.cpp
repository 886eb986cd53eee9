#include "integrators/photon/photon_beams.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

void BeamList::Clear() {
  starts.clear();
  beams.clear();
  emissions.clear();
  labels.clear();
}

void BeamList::Append(const BeamList& other, uint32_t firstOrigin, uint32_t firstDensity) {
  const auto firstStart = static_cast<uint32_t>(starts.size()), firstEmission = static_cast<uint32_t>(emissions.size());
  const auto firstLabel = static_cast<uint32_t>(labels.size());
  labels.insert(labels.end(), other.labels.begin(), other.labels.end());
  for (FlightStart start : other.starts) {
    start.labels = {start.labels.first + firstLabel, start.labels.end + firstLabel};
    start.path += firstDensity;
    if (start.origin != FlightStart::kNone) start.origin += firstOrigin;
    if (start.emission != FlightStart::kNone) start.emission += firstEmission;
    starts.push_back(start);
  }
  for (PhotonBeam beam : other.beams) {
    beam.start += firstStart;
    beams.push_back(beam);
  }
  emissions.insert(emissions.end(), other.emissions.begin(), other.emissions.end());
}

namespace {

// Length of a piece in radii: its box is then as wide as it is long, unless the beam is along an axis.
constexpr double kPieceInRadii = 24;
constexpr double kMostPieces = 256;  // of a beam
constexpr double kMeanPieces = 16;   // of all beams, at most; then pieces are longer
constexpr float kMargin = 1.0001f;   // of their boxes

uint32_t CellOf(const Point3& p, const Bounds3& bounds) {
  const Vector3 extent = bounds.Diagonal();
  const float longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) return 0;
  const Vector3 at = glm::clamp((p - bounds.min) * (1023 / longest), 0.0f, 1023.0f);
  return MortonCode(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y), static_cast<uint32_t>(at.z));
}

Point3 PointOf(const FlightStart& start, float t) {
  return Point3(start.position + static_cast<double>(t) * start.direction);
}

}  // namespace

struct BeamMap::Placed {
  uint32_t cell = 0;
  Piece piece{};
  Bounds3 box;
};

size_t BeamList::BytesOfMap() const {
  // The pieces twice while they are sorted, and their boxes, which the nodes of the tree hold again.
  constexpr size_t piece = 2 * sizeof(BeamMap::Placed) + sizeof(BeamMap::Piece) + 3 * sizeof(Bounds3);
  return 2 * Bytes() + static_cast<size_t>(kMeanPieces + 1) * beams.size() * piece;
}

// The pieces of all beams, in the order of beams.
std::vector<BeamMap::Placed> BeamMap::Split() const {
  std::vector<double> wanted;
  wanted.reserve(list_.beams.size());
  double total = 0;
  for (const PhotonBeam& beam : list_.beams) {
    const FlightStart& start = StartOf(beam);
    const float least =
        std::min(radius_.BeamAt(PointOf(start, beam.step.tMin)), radius_.BeamAt(PointOf(start, beam.step.tMax)));
    const auto length = static_cast<double>(beam.step.tMax - beam.step.tMin);
    const double pieces = std::ceil(length / (kPieceInRadii * static_cast<double>(least)));
    wanted.push_back(pieces < kMostPieces ? pieces : kMostPieces);
    total += wanted.back();
  }
  const double scale = std::min(1.0, kMeanPieces * static_cast<double>(wanted.size()) / total);
  std::vector<Placed> placed;
  for (uint32_t i = 0; i < list_.beams.size(); ++i) {
    const PhotonBeam& beam = list_.beams[i];
    const int pieces = std::max(static_cast<int>(scale * wanted[i]), 1);
    const auto end = [&](int k) {
      const float length = beam.step.tMax - beam.step.tMin;
      return k == pieces ? beam.step.tMax
                         : beam.step.tMin + length * static_cast<float>(k) / static_cast<float>(pieces);
    };
    for (int k = 0; k < pieces; ++k) {
      Placed& one = placed.emplace_back();
      one.piece = {i, end(k), end(k + 1)};
      for (const float t : {one.piece.tMin, one.piece.tMax}) {
        const Point3 p = PointOf(StartOf(beam), t);
        const Vector3 reach(kMargin * radius_.BeamAt(p));
        one.box.Add(p - reach);
        one.box.Add(p + reach);
      }
    }
  }
  return placed;
}

BeamMap::BeamMap(BeamList list, const VolumeRadius& radius) : list_(std::move(list)), radius_(radius) {
  std::vector<Placed> placed = Split();
  Bounds3 all;
  for (const Placed& one : placed) all.Add(one.box);
  for (Placed& one : placed) one.cell = CellOf(one.box.Center(), all);
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.cell < b.cell; });
  std::vector<Bounds3> boxes;
  boxes.reserve(placed.size());
  pieces_.reserve(placed.size());
  for (const Placed& one : placed) {
    pieces_.push_back(one.piece);
    boxes.push_back(one.box);
  }
  tree_ = BoxTree(boxes);
}

void BeamMap::Find(const Ray& ray, const FineLine& line, float tMax, std::vector<uint32_t>& boxes,
                   std::vector<BeamCrossing>& crossings) const {
  boxes.clear();
  tree_.Find(ray, tMax, boxes);
  for (const uint32_t index : boxes) {
    const Piece& piece = pieces_[index];
    const FlightStart& start = StartOf(list_.beams[piece.beam]);
    // The nearest points of both lines.
    const Vector3d between = start.position - line.start;
    const double cosine = glm::dot(line.direction, start.direction);
    const double sineSquared = 1 - cosine * cosine;
    if (!(sineSquared > static_cast<double>(kLeastSine) * static_cast<double>(kLeastSine))) continue;
    const double along = glm::dot(between, line.direction), alongBeam = glm::dot(between, start.direction);
    const double t = (along - cosine * alongBeam) / sineSquared;
    const double tBeam = (cosine * along - alongBeam) / sineSquared;
    if (!(t >= 0 && t < static_cast<double>(tMax))) continue;
    if (!(tBeam >= static_cast<double>(piece.tMin) && tBeam < static_cast<double>(piece.tMax))) continue;
    const Point3d onRay = line.start + t * line.direction, onBeam = start.position + tBeam * start.direction;
    const Vector3d apart = onBeam - onRay;
    const float radius = radius_.BeamAt(Point3(onBeam));
    if (!(glm::dot(apart, apart) < static_cast<double>(radius) * static_cast<double>(radius))) continue;
    crossings.push_back({piece.beam, t, tBeam, radius, static_cast<float>(std::sqrt(sineSquared)), onRay, onBeam});
  }
}

size_t BeamMap::Bytes() const {
  return list_.Bytes() + pieces_.size() * sizeof(Piece) + tree_.Bytes();
}

}  // namespace lampyr
