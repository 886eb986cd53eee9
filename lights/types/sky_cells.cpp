#include "lights/types/sky_cells.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;
// Tolerance of the sine of a cell's angle: of the outline, which is sampled, and of rounding.
constexpr float kMargin = 0.03f;
// Least density of a cell that emits, over the estimate of cosθ/π for it: for light that scattering finds less often
// than by cosθ/π, as by glossy lobes, and for light beside a sun of which the table by normals cannot tell that it is
// behind the surface.
constexpr float kLeast = 0.05f;
constexpr float kSmallest = 1e-30f;  // lower bound of mean cosines, which are divided by
constexpr int kParts = 8;            // parts of each side of a cell that have a direction each

// The probability of a cell over its mean cosine: (2e - b) over that, with the lower bound. `cosine`: the mean over the
// sky, weighted by radiance; half of it for transmissive receivers, which have half of b on each side.
float Need(float weight, float solidAngle, float cosine) {
  return weight > 0 ? std::max(2 * weight / cosine - solidAngle, kLeast * solidAngle) : 0.0f;
}

}  // namespace

SkyCells::SkyCells(const ColorTable& table, const Directions& direction)
    : width_(table.Width()), height_(table.Height()) {
  const auto rows = static_cast<size_t>(height_);
  for (int i = 0; i <= kSide; ++i) {
    firstColumn_[static_cast<size_t>(i)] = static_cast<int>(int64_t{i} * width_ / kSide);
    firstRow_[static_cast<size_t>(i)] = static_cast<int>(int64_t{i} * height_ / kSide);
  }
  strips_.resize((rows + 1) * kSide);
  ParallelFor(kSide, HardwareThreads(), [&](int column) {
    const auto at = static_cast<size_t>(column);
    double* strip = &strips_[at * (rows + 1)];
    for (int y = 0; y < height_; ++y)
      strip[y + 1] = strip[y] + table.ShareOfRow(y, firstColumn_[at], firstColumn_[at + 1]);
    for (int row = 0; row < kSide; ++row) {
      const Outline outline = OutlineOf(direction, column, row);
      const Moments cell = MomentsOfCell(table, column, row, direction, outline);
      share_[static_cast<size_t>(row * kSide + column)] = cell.weight;
      Set(cells_[static_cast<size_t>(BlockOf(column, row))], LaneOf(column, row), cell, outline);
    }
  });
  ParallelFor(normal_cells::kSide, HardwareThreads(), [&](int row) {
    const auto first = static_cast<uint32_t>(row * normal_cells::kSide);
    for (uint32_t normal = first; normal < first + normal_cells::kSide; ++normal) TabulateBlocks(normal);
  });
}

// Mean over the normals of a cell of them. What another normal of the cell may see counts as seen.
void SkyCells::TabulateBlocks(uint32_t cell) {
  const auto normals = normal_cells::NormalsOf(cell);
  BlocksSeen& seen = seen_[cell];
  for (const Normal3& normal : normals) {
    float cosines[kBlocks * kBlocks][kLanes], all = 0;
    for (size_t block = 0; block < cells_.size(); ++block)
      all += Light(cells_[block], {normal, false}, normal_cells::kReach, cosines[block]);
    all = std::max(all, kSmallest);
    for (size_t block = 0; block < cells_.size(); ++block) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const float need = Need(cells_[block].weight[lane], cells_[block].solidAngle[lane], all);
        seen.weight[block] += cosines[block][lane] * need / static_cast<float>(normals.size());
      }
    }
    seen.cosine += all / static_cast<float>(normals.size());
  }
}

SkyCells::Outline SkyCells::OutlineOf(const Directions& direction, int column, int row) const {
  const auto at = [](const std::array<int, kSide + 1>& first, int i, int part, int size) {
    const auto begin = static_cast<float>(first[static_cast<size_t>(i)]),
               end = static_cast<float>(first[static_cast<size_t>(i + 1)]);
    return (begin + (end - begin) * static_cast<float>(part) / kParts) / static_cast<float>(size);
  };
  Outline outline;
  for (int j = 0; j <= kParts; ++j) {
    for (int i = 0; i <= kParts; ++i)
      outline.push_back(direction({at(firstColumn_, column, i, width_), at(firstRow_, row, j, height_)}));
  }
  return outline;
}

// The mass is that of the table; directions are those of parts of the cell of at least a texel, or of points within one
// where the cell has few.
SkyCells::Moments SkyCells::MomentsOfCell(const ColorTable& table, int column, int row, const Directions& direction,
                                          const Outline& outline) const {
  const auto atX = static_cast<size_t>(column), atY = static_cast<size_t>(row);
  const int x0 = firstColumn_[atX], y0 = firstRow_[atY], across = firstColumn_[atX + 1] - x0,
            down = firstRow_[atY + 1] - y0;
  Moments cell;
  if (across == 0 || down == 0) return cell;
  const int columns = std::min(across, kParts), rows = std::min(down, kParts);
  const int pointsX = (kParts + columns - 1) / columns, pointsY = (kParts + rows - 1) / rows;
  const auto at = [](int begin, int end, int k, int points, int size) {
    const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(points);
    return (static_cast<float>(begin) + t * static_cast<float>(end - begin)) / static_cast<float>(size);
  };
  for (int j = 0; j < rows; ++j) {
    const int yBegin = y0 + j * down / rows, yEnd = y0 + (j + 1) * down / rows;
    for (int i = 0; i < columns; ++i) {
      const int xBegin = x0 + i * across / columns, xEnd = x0 + (i + 1) * across / columns;
      double mass = 0;
      for (int y = yBegin; y < yEnd; ++y) mass += table.ShareOfRow(y, xBegin, xEnd);
      for (int k = 0; k < pointsX * pointsY; ++k) {
        const Point2 uv(at(xBegin, xEnd, k % pointsX, pointsX, width_),
                        at(yBegin, yEnd, k / pointsX, pointsY, height_));
        cell.Add(mass / (pointsX * pointsY), Vector3d(direction(uv)));
      }
    }
  }
  // A cell is selected with the mass that its rows are sampled by, which differs by rounding.
  const double* strip = &strips_[atX * (static_cast<size_t>(height_) + 1)];
  const double mass = strip[y0 + down] - strip[y0];
  if (cell.weight > 0) cell.sum *= mass / cell.weight;
  cell.weight = mass;
  for (int k = 0; k < kParts * kParts; ++k) {
    const Vector3* corner = &outline[static_cast<size_t>(k / kParts * (kParts + 1) + k % kParts)];
    const Vector3d one(corner[kParts + 2] - corner[0]), other(corner[kParts + 1] - corner[1]);
    cell.solidAngle += 0.5 * glm::length(glm::cross(one, other)) / 3.14159265358979323846;
    cell.leastVariance = std::max({cell.leastVariance, glm::dot(one, one), glm::dot(other, other)});
  }
  return cell;
}

void SkyCells::Set(Block& block, int lane, const Moments& moments, const Outline& outline) {
  if (!(moments.weight > 0)) return;
  const Vector3d exact = moments.sum / moments.weight;
  const Vector3 mean(exact);
  const float length = glm::length(mean);
  float cosine = length > 0 ? 1.0f : -1.0f;
  for (const Vector3& direction : outline)
    cosine = length > 0 ? std::min(cosine, glm::dot(direction, mean) / length) : -1.0f;
  block.weight[lane] = static_cast<float>(moments.weight);
  block.solidAngle[lane] = static_cast<float>(moments.solidAngle);
  block.meanX[lane] = mean.x;
  block.meanY[lane] = mean.y;
  block.meanZ[lane] = mean.z;
  block.variance[lane] = static_cast<float>(std::max(1 - glm::dot(exact, exact), moments.leastVariance));
  // A cell of more than a hemisphere always has a part in front of the surface.
  block.behind[lane] = cosine > 0 ? -length * (std::sqrt(1 - cosine * cosine) + kMargin) : -2.0f;
}

// Estimated mean cosines over the cells of a block; their sum by weight is returned. `slack`: a cell whose normal times
// the mean is less than that below `behind` is not taken to be behind the surface.
float SkyCells::Light(const Block& block, const SkyReceiver& receiver, float slack, float (&cosines)[kLanes]) {
  const Vector3 n = receiver.normal;
  float sum = 0;
  for (int i = 0; i < kLanes; ++i) {
    const float cosine = n.x * block.meanX[i] + n.y * block.meanY[i] + n.z * block.meanZ[i];
    const float mean = MeanCosine(cosine, block.variance[i], receiver.isTransmissive);
    cosines[i] = !receiver.isTransmissive && cosine < block.behind[i] - slack ? 0.0f : mean;
  }
  for (int i = 0; i < kLanes; ++i) sum += block.weight[i] * cosines[i];
  return sum;
}

void SkyCells::Weights::Sum() {
  for (int row = 0; row < 4; ++row) rows[row] = of[row] + of[4 + row] + of[8 + row] + of[12 + row];
  sum = (rows[0] + rows[1]) + (rows[2] + rows[3]);
}

// The weights of the blocks; returns the mean cosine.
float SkyCells::WeighBlocks(const SkyReceiver& receiver, Weights& weights) const {
  const BlocksSeen& front = seen_[normal_cells::CellOf(receiver.normal)];
  const BlocksSeen* back = receiver.isTransmissive ? &seen_[normal_cells::CellOf(-receiver.normal)] : nullptr;
  // The sides have as much of the samples as of the irradiance.
  const float ofFront = back ? front.cosine : 1.0f, ofBack = back ? back->cosine : 0.0f;
  for (int i = 0; i < kLanes; ++i) weights.of[i] = ofFront * front.weight[i] + (back ? ofBack * back->weight[i] : 0.0f);
  weights.Sum();
  return front.cosine + (back ? back->cosine : 0.0f);
}

// Not inlined: the same receiver always gives the same bits.
[[gnu::noinline]] void SkyCells::WeighCells(const Block& block, const SkyReceiver& receiver, float cosine,
                                            Weights& weights) {
  float cosines[kLanes];
  Light(block, receiver, 0, cosines);
  const float own = receiver.isTransmissive ? 0.5f * cosine : cosine;
  for (int i = 0; i < kLanes; ++i) weights.of[i] = cosines[i] * Need(block.weight[i], block.solidAngle[i], own);
  weights.Sum();
}

namespace {

// Index of the weight, of four, that contains u times their sum; u is rescaled to [0,1). Without branches, which would
// be mispredicted.
int FindOfFour(const float (&weights)[4], float sum, double& u) {
  const double target = u * static_cast<double>(sum);
  const auto one = static_cast<double>(weights[0]), two = one + static_cast<double>(weights[1]),
             three = two + static_cast<double>(weights[2]);
  int found = (target >= one) + (target >= two) + (target >= three);
  const double before[4] = {0, one, two, three};
  // Rounding may leave the end beyond the last weight that is not 0.
  while (!(weights[found] > 0) && found > 0) [[unlikely]]-- found;
  u = std::clamp((target - before[found]) / static_cast<double>(weights[found]), 0.0, kBelowOne);
  return found;
}

}  // namespace

// Selects a row by uy and one of its columns by ux, which are then rescaled to [0,1). Requires a positive sum.
SkyCells::Pick SkyCells::PickLane(const Weights& weights, double& ux, double& uy) {
  Pick pick;
  pick.row = FindOfFour(weights.rows, weights.sum, uy);
  const float* of = weights.of + pick.row;
  const float ofRow[4] = {of[0], of[4], of[8], of[12]};
  pick.column = FindOfFour(ofRow, weights.rows[pick.row], ux);
  pick.probability = weights.ProbabilityOf(4 * pick.column + pick.row);
  return pick;
}

float SkyCells::GainOf(double probability, int column, int row) const {
  const double share = share_[static_cast<size_t>(row * kSide + column)];
  return share > 0 ? static_cast<float>(probability / share) : 0.0f;
}

SkyCells::Choice SkyCells::Sample(const ColorTable& table, const SkyReceiver& receiver, const Point2& u) const {
  double ux = WithMoreBits(u.x, u.y, 1, 0), uy = WithMoreBits(u.y, u.x, 2, 0);
  Choice choice;
  Weights weights;
  const float cosine = WeighBlocks(receiver, weights);
  if (!(weights.sum > 0)) return choice;
  const Pick block = PickLane(weights, ux, uy);
  const Block& chosen = cells_[static_cast<size_t>(block.column * kBlocks + block.row)];
  WeighCells(chosen, receiver, cosine, weights);
  if (!(weights.sum > 0)) return choice;
  const Pick cell = PickLane(weights, ux, uy);
  const int column = block.column * kPerBlock + cell.column, row = block.row * kPerBlock + cell.row;
  const auto atX = static_cast<size_t>(column), atY = static_cast<size_t>(row);
  const double* strip = &strips_[atX * (static_cast<size_t>(height_) + 1)];
  const int first = firstRow_[atY], end = firstRow_[atY + 1];
  const double target = strip[first] + uy * (strip[end] - strip[first]);
  // The last row that starts at or below the target; an empty one is never it, as the next starts there, too.
  const double* next = std::upper_bound(strip + first + 1, strip + end, target);
  const int y = static_cast<int>(next - strip) - 1;
  const double mass = strip[y + 1] - strip[y];
  if (!(mass > 0)) return choice;
  const double ty = std::clamp((target - strip[y]) / mass, 0.0, 1.0);
  choice.texel = table.SampleInRow(y, firstColumn_[atX], firstColumn_[atX + 1], ux);
  choice.texel.t.y = std::min(static_cast<float>(ty), kOneMinusEpsilon);
  choice.gain = GainOf(block.probability * cell.probability, column, row);
  choice.exists = true;
  return choice;
}

float SkyCells::Gain(const SkyReceiver& receiver, int x, int y) const {
  // The part with floor(i · size / kSide) <= x.
  const auto partOf = [](int at, int size) { return (kSide * (at + 1) - 1) / size; };
  const int column = partOf(x, width_), row = partOf(y, height_);
  const int block = BlockOf(column, row);
  Weights weights;
  const float cosine = WeighBlocks(receiver, weights);
  if (!(weights.of[block] > 0)) return 0;
  const double ofBlock = weights.ProbabilityOf(block);
  WeighCells(cells_[static_cast<size_t>(block)], receiver, cosine, weights);
  if (!(weights.sum > 0)) return 0;
  return GainOf(ofBlock * weights.ProbabilityOf(LaneOf(column, row)), column, row);
}

float SkyCells::MeanCosineOf(const SkyReceiver& receiver) const {
  const float front = seen_[normal_cells::CellOf(receiver.normal)].cosine;
  return receiver.isTransmissive ? front + seen_[normal_cells::CellOf(-receiver.normal)].cosine : front;
}

}  // namespace lampyr
