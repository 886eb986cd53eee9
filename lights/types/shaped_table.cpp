#include "lights/types/shaped_table.h"

#include <array>
#include <queue>

#include "sampling/warp.h"

namespace lampyr {

namespace {

struct Node {
  double x, weight;  // in [-1, 1]; weights sum to 2
};
constexpr std::array<Node, 4> kGauss4 = {{{-0.8611363115940526, 0.3478548451374538},
                                          {-0.3399810435848563, 0.6521451548625461},
                                          {0.3399810435848563, 0.6521451548625461},
                                          {0.8611363115940526, 0.3478548451374538}}};
constexpr std::array<Node, 2> kGauss2 = {{{-0.5773502691896257, 1}, {0.5773502691896257, 1}}};

constexpr size_t kMostRows = 256;  // beyond those that the knots make
constexpr size_t kFewestColumns = 64;
constexpr float kSmallestCell = 1e-37f;

float LargestChannel(const ShapedFactor& factor, double theta, float turns) {
  return factor.At(AxisAngle::Of(theta), [turns] { return turns; }).Max();
}

}  // namespace

ShapedTable::ShapedTable(const ShapedFactor& factor, bool flat) : flat_(flat) {
  CutRows(factor);
  if (rows_.empty()) return;
  CutColumns(factor);
  const size_t rows = RowCount(), columns = ColumnCount();
  std::vector<float> cells(rows * columns);
  double sum = 0, squares = 0;
  for (size_t j = 0; j < rows; ++j) {
    const double middle = 0.5 * (rows_[j].theta + rows_[j + 1].theta);
    const double half = 0.5 * (rows_[j + 1].theta - rows_[j].theta), width = rows_[j + 1].m - rows_[j].m;
    for (size_t i = 0; i < columns; ++i) {
      const float c = columns_[i], share = columns_[i + 1] - c;
      double mass = 0;
      for (const Node& node : kGauss4) {
        const double theta = middle + half * node.x;
        const double measure = half * node.weight * std::sin(theta) * (flat ? std::cos(theta) : 1);
        for (const Node& across : kGauss2) {
          const float turns = c + share * static_cast<float>(0.5 * (1 + across.x));
          mass += 0.5 * measure * static_cast<double>(LargestChannel(factor, theta, turns));
          if (columns == 1) break;
        }
      }
      mass *= (columns == 1 ? 2 : 1) * static_cast<double>(share);
      cells[j * columns + i] = static_cast<float>(mass / width);
      sum += mass;
      squares += mass * mass / (width * static_cast<double>(share));
    }
  }
  if (!(sum > 0)) return;
  effectiveMeasure_ = 2 * kPiExact * sum * sum / squares;
  // From the mean of a cell to its integral, scaled into the range of float. Any cell that emits stays above 0.
  const double whole = static_cast<double>(factor.Largest()) * (rows_.back().m - rows_.front().m);
  for (size_t j = 0; j < rows; ++j) {
    const double scale = (rows_[j + 1].m - rows_[j].m) / whole;
    for (size_t i = 0; i < columns; ++i) {
      float& cell = cells[j * columns + i];
      if (cell > 0) cell = std::max(static_cast<float>(static_cast<double>(cell) * scale), kSmallestCell);
    }
  }
  SpreadToNeighbours(cells);
  distribution_ = Distribution2D(cells, static_cast<int>(columns), static_cast<int>(rows));
  SetDensities();
  SetGuide();
}

// Halves the rows in which the factor varies most, until the variation is small or the maximum number of rows is
// reached.
void ShapedTable::CutRows(const ShapedFactor& factor) {
  std::vector<double> knots = factor.ThetaKnots();
  if (flat_) {
    const bool reachesHorizon = !knots.empty() && knots.back() > 0.5 * kPiExact;
    std::erase_if(knots, [](double theta) { return theta > 0.5 * kPiExact; });
    if (reachesHorizon && !knots.empty() && knots.back() < 0.5 * kPiExact) knots.push_back(0.5 * kPiExact);
  }
  if (knots.size() < 2) return;
  std::vector<float> around = {0};
  if (factor.Profile() && !factor.Profile()->IsSymmetric()) {
    const std::vector<float>& planes = factor.Profile()->TurnsKnots();
    around.clear();
    for (size_t i = 0; i < planes.size(); i += 1 + planes.size() / 32) around.push_back(planes[i]);
  }
  const auto measure = [this](double theta) { return Measure(AxisAngle::Of(theta)); };
  struct Cut {
    double change, from, to;
    bool operator<(const Cut& other) const { return change < other.change; }
  };
  const auto toCut = [&](double from, double to) {
    double change = 0;
    for (const float turns : around) {
      float low = kInfinity, high = 0;
      for (const double t : {0.02, 0.25, 0.5, 0.75, 0.98}) {
        const float value = LargestChannel(factor, from + t * (to - from), turns);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      change = std::max(change, static_cast<double>(high - low));
    }
    return Cut{change * (measure(to) - measure(from)), from, to};
  };
  std::priority_queue<Cut> cuts;
  double whole = 0;
  for (size_t i = 0; i + 1 < knots.size(); ++i) {
    const Cut cut = toCut(knots[i], knots[i + 1]);
    whole += cut.change;
    cuts.push(cut);
  }
  const size_t most = cuts.size() + kMostRows;
  while (cuts.size() < most && cuts.top().change > 1e-6 * whole) {
    const Cut cut = cuts.top();
    const double middle = 0.5 * (cut.from + cut.to);
    cuts.pop();
    cuts.push(toCut(cut.from, middle));
    cuts.push(toCut(middle, cut.to));
  }
  std::vector<double> bounds = {knots.back()};
  for (; !cuts.empty(); cuts.pop()) bounds.push_back(cuts.top().from);
  std::sort(bounds.begin(), bounds.end());
  for (const double theta : bounds) {
    const AxisAngle angle = AxisAngle::Of(theta);
    const Row row{theta, angle.fromAxis, Measure(angle)};
    // Rows too narrow to have a positive measure are dropped.
    if (rows_.empty() || row.m > rows_.back().m) rows_.push_back(row);
  }
  if (rows_.size() < 2) rows_.clear();
}

void ShapedTable::SetDensities() {
  const size_t rows = RowCount(), columns = ColumnCount();
  for (size_t j = 0; j < rows; ++j) {
    rowW_.push_back(rows_[j].w);
    const auto perRow =
        static_cast<float>(1 / (2 * kPiExact * static_cast<double>(rows) * (rows_[j + 1].m - rows_[j].m)));
    for (size_t i = 0; i < columns; ++i) {
      const Point2 cell((static_cast<float>(i) + 0.5f) / static_cast<float>(columns),
                        (static_cast<float>(j) + 0.5f) / static_cast<float>(rows));
      const float perColumn = 1 / (static_cast<float>(columns) * (columns_[i + 1] - columns_[i]));
      densities_.push_back(distribution_.Density(cell) * perRow * perColumn);
    }
  }
}

void ShapedTable::CutColumns(const ShapedFactor& factor) {
  columns_ = {0};
  if (factor.Profile() && !factor.Profile()->IsSymmetric()) {
    const std::vector<float>& planes = factor.Profile()->TurnsKnots();
    const size_t parts = (kFewestColumns + planes.size() - 2) / (planes.size() - 1);
    for (size_t i = 0; i + 1 < planes.size(); ++i) {
      for (size_t k = 1; k <= parts; ++k) {
        const float t = static_cast<float>(k) / static_cast<float>(parts);
        const float turns = k == parts ? planes[i + 1] : planes[i] + t * (planes[i + 1] - planes[i]);
        if (turns > columns_.back()) columns_.push_back(turns);
      }
    }
  } else {
    columns_.push_back(1);
  }
}

// Rounding may find a direction on the border of two cells in either of them, so cells next to one that emits get a
// positive density.
void ShapedTable::SpreadToNeighbours(std::vector<float>& cells) const {
  const size_t rows = RowCount(), columns = ColumnCount();
  const std::vector<float> before = cells;
  for (size_t j = 0; j < rows; ++j) {
    for (size_t i = 0; i < columns; ++i) {
      if (before[j * columns + i] > 0) continue;
      float largest = 0;
      for (const size_t y : {j > 0 ? j - 1 : j, j, std::min(j + 1, rows - 1)}) {
        for (const size_t x : {(i + columns - 1) % columns, i, (i + 1) % columns})
          largest = std::max(largest, before[y * columns + x]);
      }
      if (largest > 0) cells[j * columns + i] = std::max(1e-5f * largest, kSmallestCell);
    }
  }
}

Vector3 ShapedTable::Sample(const Point2& u) const {
  const Point2 at = distribution_.Sample(u).uv;
  const float y = at.y * static_cast<float>(RowCount()), x = at.x * static_cast<float>(ColumnCount());
  const size_t j = std::min(static_cast<size_t>(y), RowCount() - 1);
  const size_t i = std::min(static_cast<size_t>(x), ColumnCount() - 1);
  const double t = static_cast<double>(std::clamp(y - static_cast<float>(j), 0.0f, 1.0f));
  const double m = rows_[j].m + t * (rows_[j + 1].m - rows_[j].m);
  const float turns = columns_[i] + std::clamp(x - static_cast<float>(i), 0.0f, 1.0f) * (columns_[i + 1] - columns_[i]);
  // sin²θ = w (2 - w), and 2m of flat emitters.
  const double sinSquared = flat_ ? 2 * m : m * (2 - m);
  const double cosine = flat_ ? std::sqrt(std::max(1 - sinSquared, 0.0)) : 1 - m;
  const float sine = static_cast<float>(std::sqrt(std::max(sinSquared, 0.0)));
  const Vector2 around = CosSinTurns(turns);
  return {sine * around.x, sine * around.y, static_cast<float>(-cosine)};
}

void ShapedTable::SetGuide() {
  const size_t steps = 4 * RowCount();
  stepsPerW_ = static_cast<double>(steps) / (rows_.back().w - rows_.front().w);
  size_t row = 0;
  for (size_t k = 0; k <= steps; ++k) {
    const double w = rows_.front().w + static_cast<double>(k) / stepsPerW_;
    while (row + 1 < RowCount() && rowW_[row + 1] <= w) ++row;
    guide_.push_back(static_cast<uint32_t>(row));
  }
}

// The last row that begins at or below w.
size_t ShapedTable::RowAt(double w) const {
  const auto step = static_cast<size_t>((w - rowW_.front()) * stepsPerW_);
  // One step more on either side, for rounding of the index of the step.
  const size_t last = guide_.size() - 1;
  size_t j = guide_[std::min(step > 0 ? step - 1 : 0, last)];
  for (size_t count = guide_[std::min(step + 2, last)] + 1 - j; count > 1;) {
    const size_t half = count / 2;
    j += static_cast<size_t>(rowW_[j + half] <= w) * half;
    count -= half;
  }
  return j;
}

float ShapedTable::Density(const Vector3& local) const {
  if (IsDark() || (flat_ && local.z >= 0)) return 0;
  const double w = AxisAngle::Of(Vector3d(local)).fromAxis;
  if (w < rows_.front().w || w > rows_.back().w) return 0;
  const size_t j = RowAt(w);
  size_t i = 0;
  if (ColumnCount() > 1) {
    const float turns = TurnsOf(local);
    for (size_t count = ColumnCount(); count > 1;) {
      const size_t half = count / 2;
      i += static_cast<size_t>(columns_[i + half] <= turns) * half;
      count -= half;
    }
  }
  const float density = densities_[j * ColumnCount() + i];
  return flat_ ? density * -local.z : density;
}

Color ShapedTable::Integrate(const ShapedFactor& factor, const std::function<double(const Vector3d&)>* weight) const {
  if (rows_.empty()) return Color(0.0f);
  // Without a profile nothing depends on φ but the weight.
  const size_t parts = weight && ColumnCount() == 1 ? kFewestColumns : 1;
  double sum[3] = {0, 0, 0};
  for (size_t j = 0; j < RowCount(); ++j) {
    const double middle = 0.5 * (rows_[j].theta + rows_[j + 1].theta);
    const double half = 0.5 * (rows_[j + 1].theta - rows_[j].theta);
    for (const Node& node : kGauss4) {
      const double theta = middle + half * node.x, sine = std::sin(theta), cosine = std::cos(theta);
      for (size_t i = 0; i < ColumnCount() * parts; ++i) {
        const double begin = static_cast<double>(columns_[i / parts]);
        const double share = (static_cast<double>(columns_[i / parts + 1]) - begin) / static_cast<double>(parts);
        for (const Node& across : kGauss2) {
          const double turns = begin + share * (static_cast<double>(i % parts) + 0.5 * (1 + across.x));
          const Color value = factor.At(AxisAngle::Of(theta), [turns] { return static_cast<float>(turns); });
          const double phi = 2 * kPiExact * turns;
          const double factorOfWeight = weight
                                            ? (*weight)(Vector3d(sine * std::cos(phi), sine * std::sin(phi), -cosine))
                                        : flat_ ? cosine
                                                : 1;
          const double area = half * node.weight * sine * kPiExact * share * across.weight * factorOfWeight;
          sum[0] += area * static_cast<double>(value.r);
          sum[1] += area * static_cast<double>(value.g);
          sum[2] += area * static_cast<double>(value.b);
        }
      }
    }
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

}  // namespace lampyr
