// Adaptive quadrature over the unit square with its standard error, and the cells of a χ² test against it. The domain
// under test (directions of a cap, positions on a disk) is mapped to the square so that equal areas are equal measures.
//
// A quadtree is refined where its probe points differ most; the leaves are then sampled anew. Given the tree, the new
// points are independent of it. The estimate is therefore unbiased and its error is known, so that no tolerance has to
// be guessed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr::suite {

// Two integrands over the same domain: a density and the incident radiance.
struct Integrands {
  double density = 0, radiance = 0;
};

// A value with its standard error.
struct Estimate {
  double value = 0, error = 0;
};
Estimate operator+(const Estimate& a, const Estimate& b);

class AdaptiveSquare {
 public:
  using Function = std::function<Integrands(double x, double y)>;  // x, y in (0,1)

  // `measure`: measure of the domain that is mapped to the square. `hints`: points where the integrand is large. Cells
  // around them are split from the start, so that features too small for the first probes are found. Hints must be
  // independent of the points under test. At most about `budget` evaluations.
  AdaptiveSquare(double measure, std::span<const Point2d> hints, const Function& function, Rng& rng, int budget);

  Estimate Density() const { return nodes_[0].density; }
  Estimate Radiance() const { return nodes_[0].radiance; }

  // Makes disjoint cells that cover the square. Each holds at most 1/`parts` of the density, unless it cannot be split.
  size_t MakeCells(int parts);
  const std::vector<Estimate>& Cells() const { return cells_; }
  size_t CellOf(double x, double y) const;
  Point2d MiddleOf(size_t cell) const;

  // Integrals of `count` functions evaluated at shared points: new points in the same leaves.
  using Functions = std::function<void(double x, double y, std::span<double> values)>;
  std::vector<Estimate> Integrate(size_t count, const Functions& f, Rng& rng) const;

 private:
  struct Node {
    double x = 0, y = 0, size = 1;
    int firstChild = -1, cell = -1;
    bool isProbed = false;
    Estimate density, radiance;
  };

  void SplitWhereHinted(std::span<const Point2d> hints, const Function& function, Rng& rng);
  void Probe(Node& node, const Function& function, Rng& rng);
  void Measure(Node& node, const Function& function, Rng& rng) const;
  void Split(size_t index);
  void Refine(const Function& function, Rng& rng, int budget);
  static size_t ChildAt(const Node& node, double x, double y) {
    const int right = x >= node.x + 0.5 * node.size ? 1 : 0, upper = y >= node.y + 0.5 * node.size ? 2 : 0;
    return static_cast<size_t>(node.firstChild + right + upper);
  }
  size_t LeafAt(double x, double y) const;
  void LookAgainBesideTheLit(const Function& function, Rng& rng);

  double measure_;
  double totalDensity_ = 0, totalRadiance_ = 0;  // sums over the probes, to which errors are relative
  std::vector<Node> nodes_;
  std::vector<Estimate> cells_;
};

}  // namespace lampyr::suite
