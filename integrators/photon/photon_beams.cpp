#include "integrators/photon/photon_beams.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

void BeamList::Clear() {
  starts.clear();
  beams.clear();
  emissions.clear();
}

void BeamList::Append(const BeamList& other, uint32_t firstOrigin, uint32_t firstDensity) {
  const auto firstStart = static_cast<uint32_t>(starts.size()), firstEmission = static_cast<uint32_t>(emissions.size());
  for (FlightStart start : other.starts) {
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
constexpr float kPieceInRadii = 24;
constexpr int kMostPieces = 256;    // of a beam
constexpr float kMargin = 1.0001f;  // of their boxes

// Points of 1024 cells along each axis, by a Morton curve.
uint32_t CellOf(const Point3& p, const Bounds3& bounds) {
  const Vector3 extent = bounds.Diagonal();
  const float longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) return 0;
  const Vector3 relative = (p - bounds.min) * (1023 / longest);
  uint32_t cell = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto x = static_cast<uint32_t>(std::clamp(relative[axis], 0.0f, 1023.0f));
    for (int bit = 0; bit < 10; ++bit) cell |= (x >> bit & 1u) << (3 * bit + axis);
  }
  return cell;
}

}  // namespace

BeamMap::BeamMap(BeamList list, const VolumeRadius& radius) : list_(std::move(list)), radius_(radius) {
  struct Placed {
    uint32_t cell;
    Piece piece;
    Bounds3 box;
  };
  std::vector<Placed> placed;
  for (uint32_t i = 0; i < list_.beams.size(); ++i) {
    const PhotonBeam& beam = list_.beams[i];
    const FlightStart& start = StartOf(beam);
    const auto at = [&](double t) { return Point3(start.position + t * start.direction); };
    const float length = beam.step.tMax - beam.step.tMin;
    const float least = std::min(radius_.BeamAt(at(beam.step.tMin)), radius_.BeamAt(at(beam.step.tMax)));
    const float wanted = std::ceil(length / (kPieceInRadii * least));
    const int pieces = wanted < kMostPieces ? std::max(static_cast<int>(wanted), 1) : kMostPieces;
    for (int k = 0; k < pieces; ++k) {
      const auto ends = static_cast<float>(pieces);
      const float from = beam.step.tMin + length * static_cast<float>(k) / ends;
      const float to = k + 1 == pieces ? beam.step.tMax : beam.step.tMin + length * static_cast<float>(k + 1) / ends;
      Placed one{0, {i, from, to}, {}};
      for (const float t : {from, to}) {
        const Point3 p = at(t);
        const Vector3 reach(kMargin * radius_.BeamAt(p));
        one.box.Add(p - reach);
        one.box.Add(p + reach);
      }
      placed.push_back(one);
    }
  }
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
