#include "suite/adaptive_square.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

namespace lampyr::suite {

namespace {

constexpr int kFirstLevels = 5;  // 32×32 cells to begin with
constexpr int kFirstSide = 1 << kFirstLevels;
constexpr double kSmallest = 0x1p-20;  // side of a cell
constexpr int kLooks = 12;             // probes, of four points each, of a dark cell beside a lit one

// Mean and variance of four values.
struct Four {
  double mean, variance;
  explicit Four(const double (&v)[4]) : mean(0.25 * (v[0] + v[1] + v[2] + v[3])), variance(0) {
    for (const double value : v) variance += (value - mean) * (value - mean) / 3;
  }
};

}  // namespace

Estimate operator+(const Estimate& a, const Estimate& b) {
  return {a.value + b.value, std::hypot(a.error, b.error)};
}

// Evaluates one point in each quarter of a cell.
template <class Function>
static void SampleQuarters(double x, double y, double size, const Function& function, Rng& rng, double (&density)[4],
                           double (&radiance)[4]) {
  for (int i = 0; i < 4; ++i) {
    const double jx = static_cast<double>(rng.NextFloat()) + 0x1p-25,
                 jy = static_cast<double>(rng.NextFloat()) + 0x1p-25;
    const Integrands value = function(x + size * 0.5 * ((i & 1 ? 1 : 0) + jx), y + size * 0.5 * ((i & 2 ? 1 : 0) + jy));
    density[i] = value.density;
    radiance[i] = value.radiance;
  }
}

AdaptiveSquare::AdaptiveSquare(double measure, std::span<const Point2d> hints, const Function& function, Rng& rng,
                               int budget)
    : measure_(measure) {
  nodes_.reserve(static_cast<size_t>(budget) / 4 + 2000);
  nodes_.emplace_back();
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].size > 1.5 / kFirstSide) Split(i);
  }
  SplitWhereHinted(hints, function, rng);
  for (Node& node : nodes_) {
    if (node.firstChild >= 0) continue;
    if (!node.isProbed) Probe(node, function, rng);
    totalDensity_ += node.density.value;
    totalRadiance_ += node.radiance.value;
  }
  for (size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    for (int child = 0; node.firstChild >= 0 && child < 4; ++child) {
      node.density.value += nodes_[static_cast<size_t>(node.firstChild + child)].density.value;
      node.radiance.value += nodes_[static_cast<size_t>(node.firstChild + child)].radiance.value;
    }
  }
  LookAgainBesideTheLit(function, rng);
  Refine(function, rng, budget / 2);
  // Children come after their parents, so that a reverse pass has the values of all children before it sums them.
  for (size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.firstChild < 0) {
      Measure(node, function, rng);
      continue;
    }
    node.density = node.radiance = {};
    for (int child = 0; child < 4; ++child) {
      node.density = node.density + nodes_[static_cast<size_t>(node.firstChild + child)].density;
      node.radiance = node.radiance + nodes_[static_cast<size_t>(node.firstChild + child)].radiance;
    }
  }
}

// Splits cells until none holds many hints, nor hints that have a large share of the density but lie in a corner that
// the cell's probe points miss.
void AdaptiveSquare::SplitWhereHinted(std::span<const Point2d> hints, const Function& function, Rng& rng) {
  constexpr size_t kMost = 8;
  const double each = 1.0 / static_cast<double>(hints.size());
  std::vector<std::pair<size_t, std::vector<Point2d>>> open;
  std::map<size_t, std::vector<Point2d>> byLeaf;
  for (const Point2d& hint : hints) byLeaf[LeafAt(hint.x, hint.y)].push_back(hint);
  for (auto& [leaf, held] : byLeaf) open.emplace_back(leaf, std::move(held));
  while (!open.empty()) {
    const auto [index, held] = std::move(open.back());
    open.pop_back();
    if (held.empty()) continue;
    if (held.size() <= kMost || nodes_[index].size <= kSmallest) {
      Probe(nodes_[index], function, rng);
      nodes_[index].isProbed = true;
      const bool isSeen = nodes_[index].density.value >= 0.25 * each * static_cast<double>(held.size());
      if (isSeen || nodes_[index].size <= kSmallest) continue;
    }
    Split(index);
    std::vector<Point2d> parts[4];
    const Node node = nodes_[index];
    for (const Point2d& hint : held) {
      parts[ChildAt(node, hint.x, hint.y) - static_cast<size_t>(node.firstChild)].push_back(hint);
    }
    for (size_t child = 0; child < 4; ++child) {
      open.emplace_back(static_cast<size_t>(node.firstChild) + child, std::move(parts[child]));
    }
  }
}

void AdaptiveSquare::Probe(Node& node, const Function& function, Rng& rng) {
  double density[4], radiance[4];
  SampleQuarters(node.x, node.y, node.size, function, rng, density, radiance);
  const Four d(density), r(radiance);
  const double area = measure_ * node.size * node.size;
  node.density = {d.mean * area, std::sqrt(d.variance) * area};
  node.radiance = {r.mean * area, std::sqrt(r.variance) * area};
}

// Two points in each quarter: their difference gives an unbiased estimate of the error of their mean.
void AdaptiveSquare::Measure(Node& node, const Function& function, Rng& rng) const {
  double density[2][4], radiance[2][4];
  for (int i = 0; i < 2; ++i) {
    SampleQuarters(node.x, node.y, node.size, function, rng, density[i], radiance[i]);
  }
  const double area = measure_ * node.size * node.size;
  const auto mean = [&](const double(&v)[2][4]) {
    double sum = 0, squares = 0;
    for (int i = 0; i < 4; ++i) {
      sum += v[0][i] + v[1][i];
      squares += (v[0][i] - v[1][i]) * (v[0][i] - v[1][i]);
    }
    return Estimate{0.125 * sum * area, 0.125 * std::sqrt(squares) * area};
  };
  node.density = mean(density);
  node.radiance = mean(radiance);
}

void AdaptiveSquare::Split(size_t index) {
  const Node parent = nodes_[index];
  nodes_[index].firstChild = static_cast<int>(nodes_.size());
  for (int i = 0; i < 4; ++i) {
    Node child;
    child.size = 0.5 * parent.size;
    child.x = parent.x + (i & 1 ? child.size : 0);
    child.y = parent.y + (i & 2 ? child.size : 0);
    nodes_.push_back(child);
  }
}

// A dark cell beside a lit one may contain a corner of the lit region: it is probed again.
void AdaptiveSquare::LookAgainBesideTheLit(const Function& function, Rng& rng) {
  constexpr double kDark = 1e-2;  // relative to its neighbours
  std::vector<size_t> at(static_cast<size_t>(kFirstSide * kFirstSide));
  const auto cell = [&](int i, int j) -> size_t& {
    return at[static_cast<size_t>(((j + kFirstSide) % kFirstSide) * kFirstSide + (i + kFirstSide) % kFirstSide)];
  };
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].size != 1.0 / kFirstSide) continue;
    cell(static_cast<int>(nodes_[i].x * kFirstSide), static_cast<int>(nodes_[i].y * kFirstSide)) = i;
  }
  std::vector<std::pair<size_t, Integrands>> again;  // cell, and the largest values around it
  for (int j = 0; j < kFirstSide; ++j) {
    for (int i = 0; i < kFirstSide; ++i) {
      Integrands beside;
      for (int k = 0; k < 9; ++k) {
        const Node& other = nodes_[cell(i + k % 3 - 1, j + k / 3 - 1)];
        beside.density = std::max(beside.density, other.density.value);
        beside.radiance = std::max(beside.radiance, other.radiance.value);
      }
      const Node& node = nodes_[cell(i, j)];
      if (node.firstChild >= 0) continue;
      if (node.density.value < kDark * beside.density || node.radiance.value < kDark * beside.radiance) {
        again.emplace_back(cell(i, j), beside);
      }
    }
  }
  for (const auto& [index, beside] : again) {
    Node& node = nodes_[index];
    for (int i = 0; i < kLooks; ++i) {
      if (node.density.value >= kDark * beside.density && node.radiance.value >= kDark * beside.radiance) break;
      Probe(node, function, rng);
    }
  }
}

size_t AdaptiveSquare::LeafAt(double x, double y) const {
  size_t index = 0;
  while (nodes_[index].firstChild >= 0) index = ChildAt(nodes_[index], x, y);
  return index;
}

// The neighbours of a split cell are split down to its own size: an edge that leaves the cell through a corner that no
// point hit is followed there. The second coordinate is a full turn and wraps around.
void AdaptiveSquare::Refine(const Function& function, Rng& rng, int budget) {
  // A cell of large value is split even if its points agree: all of its few points may have missed a strip along its
  // edge.
  constexpr double kUnseen = 0.03;
  const auto doubt = [](const Estimate& of, double total) {
    return std::max(of.error, kUnseen * of.value) / (total > 0 ? total : 1.0);
  };
  const auto spread = [&](const Node& node) {
    return doubt(node.density, totalDensity_) + doubt(node.radiance, totalRadiance_);
  };
  std::priority_queue<std::pair<double, size_t>> open;
  const auto add = [&](size_t index) {
    const double s = spread(nodes_[index]);
    if (s > 1e-7 && nodes_[index].size > kSmallest) open.emplace(s, index);
  };
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].firstChild < 0) add(i);
  }
  int used = 4 * kFirstSide * kFirstSide;
  std::vector<size_t> toSplit;
  while (used < budget && !open.empty()) {
    toSplit.assign(1, open.top().second);
    open.pop();
    while (!toSplit.empty()) {
      const size_t index = toSplit.back();
      toSplit.pop_back();
      if (nodes_[index].firstChild >= 0) continue;
      const Node node = nodes_[index];
      Split(index);
      used += 16;
      for (int child = 0; child < 4; ++child) {
        const auto i = static_cast<size_t>(nodes_[index].firstChild + child);
        Probe(nodes_[i], function, rng);
        add(i);
      }
      for (int k = 0; k < 9; ++k) {
        const double x = node.x + node.size * (0.5 + k % 3 - 1), y = node.y + node.size * (0.5 + k / 3 - 1);
        if (x < 0 || x > 1) continue;
        const size_t neighbour = LeafAt(x, y - std::floor(y));
        if (nodes_[neighbour].size > 1.5 * node.size) toSplit.push_back(neighbour);
      }
    }
  }
}

size_t AdaptiveSquare::MakeCells(int parts) {
  cells_.clear();
  const double most = nodes_[0].density.value / parts;
  std::vector<size_t> open{0};
  while (!open.empty()) {
    const size_t index = open.back();
    open.pop_back();
    Node& node = nodes_[index];
    if (node.firstChild >= 0 && (node.density.value > most)) {
      for (int child = 0; child < 4; ++child) open.push_back(static_cast<size_t>(node.firstChild + child));
      continue;
    }
    node.cell = static_cast<int>(cells_.size());
    cells_.push_back(node.density);
  }
  return cells_.size();
}

Point2d AdaptiveSquare::MiddleOf(size_t cell) const {
  for (const Node& node : nodes_) {
    if (node.cell == static_cast<int>(cell)) return {node.x + 0.5 * node.size, node.y + 0.5 * node.size};
  }
  return Point2d(0.5);
}

size_t AdaptiveSquare::CellOf(double x, double y) const {
  size_t index = 0;
  while (nodes_[index].cell < 0) index = ChildAt(nodes_[index], x, y);
  return static_cast<size_t>(nodes_[index].cell);
}

std::vector<Estimate> AdaptiveSquare::Integrate(size_t count, const Functions& f, Rng& rng) const {
  std::vector<double> values(2 * count), sums(count, 0.0), squares(count, 0.0);
  for (const Node& node : nodes_) {
    if (node.firstChild >= 0) continue;
    const double area = measure_ * node.size * node.size;
    // Two points in each quarter, as in Measure.
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (size_t i = 0; i < 2; ++i) {
        const double jx = static_cast<double>(rng.NextFloat()) + 0x1p-25,
                     jy = static_cast<double>(rng.NextFloat()) + 0x1p-25;
        f(node.x + node.size * 0.5 * ((quarter & 1 ? 1 : 0) + jx),
          node.y + node.size * 0.5 * ((quarter & 2 ? 1 : 0) + jy), std::span(values).subspan(i * count, count));
      }
      for (size_t k = 0; k < count; ++k) {
        const double a = values[k], b = values[count + k];
        sums[k] += 0.125 * (a + b) * area;
        const double difference = 0.125 * (a - b) * area;
        squares[k] += difference * difference;
      }
    }
  }
  std::vector<Estimate> result;
  for (size_t k = 0; k < count; ++k) result.push_back({sums[k], std::sqrt(squares[k])});
  return result;
}

}  // namespace lampyr::suite
