// An integral over the unit square that finds the places where it varies, with its standard error, and the cells of a
// χ² test against it. Whatever is to be tested is mapped to the square so that equal areas are equal measures:
// directions of a cap, positions on a disk.
//
// A quadtree is refined where its points differ most; the leaves are then sampled anew. Given the tree, those points
// are independent of it: the estimate is unbiased and its error is known, so that no tolerance has to be guessed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "math/vec.h"
#include "sampling/rng.h"

namespace lampyr::suite {

// Two integrands over the same domain: a density, and what arrives.
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

  // `measure`: what the whole square stands for. `hints`: where there is much, to be looked at closely from the start,
  // so that what is too small for the first points to meet is found; they must not be the points that are tested.
  // At most about `budget` evaluations.
  AdaptiveSquare(double measure, std::span<const Point2d> hints, const Function& function, Rng& rng, int budget);

  Estimate Density() const { return nodes_[0].density; }
  Estimate Radiance() const { return nodes_[0].radiance; }

  // Disjoint cells that fill the square, none with more than a `parts`-th of the density unless it cannot be divided.
  size_t MakeCells(int parts);
  const std::vector<Estimate>& Cells() const { return cells_; }
  size_t CellOf(double x, double y) const;

  // The integrals of `count` functions that share their points, by new points in the same leaves.
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
  double totalDensity_ = 0, totalRadiance_ = 0;  // of the probes: what errors are relative to
  std::vector<Node> nodes_;
  std::vector<Estimate> cells_;
};

}  // namespace lampyr::suite
