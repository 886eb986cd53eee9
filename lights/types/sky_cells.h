// The image of a sky in 16 × 16 cells, for next-event estimation at receivers with a normal: a cell is selected by its
// share of their irradiance, a direction within it in proportion to radiance. Half of the directions that are sampled
// by radiance alone are behind the surface, and many others graze it.
//
// Scattering finds the sky, too. With as many directions sampled by scattering, by cosθ/π, as by next-event estimation,
// the balance heuristic estimates the irradiance with the sum of the two densities; that is proportional to radiance
// times cosine if a cell with the share e, and the share b of cosθ/π, is selected with the probability 2e - b
// ([Karlik19]). A lower bound keeps every cell that emits and is seen possible. Under an even sky e = b,
// and cells are selected by the cosine.
//
// The irradiance of a cell is its share of the sky's radiance times an estimate of the mean of max(0, cosθ) over the
// cell, as in light selection (selection/importance.h). Cells are selected by way of 4 × 4 blocks of 4 × 4 cells, whose
// probabilities are tabulated by normal; row and column each by its own random number, so that stratified points stay
// stratified ([Clarberg05]).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "lights/infinite_frame.h"
#include "lights/normal_cells.h"
#include "sampling/color_table.h"

namespace lampyr {

class SkyCells {
 public:
  using Directions = std::function<Vector3(const Point2&)>;

  SkyCells() = default;
  // `table`: the image, which must not be zero, sampled by radiance. `direction`: that of a point in [0,1]², unit.
  SkyCells(const ColorTable& table, const Directions& direction);

  // A texel as sampled for a receiver with a normal. ColorTable::Cell::pdf is that of `table`. `exists` is false if the
  // receiver sees nothing of the sky.
  struct Choice {
    bool exists = false;
    ColorTable::Cell texel;
    float gain = 0;  // as of Gain
  };
  Choice Sample(const ColorTable& table, const SkyReceiver& receiver, const Point2& u) const;

  // Density of the texel for a receiver with a normal, over its density in the table.
  float Gain(const SkyReceiver& receiver, int x, int y) const;

  // Estimated mean of max(0, cosθ) over the sky, or of |cosθ|, weighted by radiance.
  float MeanCosineOf(const SkyReceiver& receiver) const;

 private:
  static constexpr int kBlocks = 4, kPerBlock = 4, kSide = kBlocks * kPerBlock, kLanes = 16;

  // Sixteen cells, column by column.
  struct alignas(64) Block {
    float weight[kLanes] = {};      // share of the table's density
    float solidAngle[kLanes] = {};  // in units of π sr
    // Mean direction, weighted by density, and 1 - |mean|².
    float meanX[kLanes] = {}, meanY[kLanes] = {}, meanZ[kLanes] = {}, variance[kLanes] = {};
    float behind[kLanes] = {};  // if the normal times the mean is below this, all of it is behind the surface
  };
  struct Weights {
    alignas(64) float of[kLanes];  // proportional to the probabilities
    float rows[4];                 // sums over the columns
    float sum;

    void Sum();
    double ProbabilityOf(int lane) const { return static_cast<double>(of[lane]) / static_cast<double>(sum); }
  };
  // Blocks as seen by receivers with a normal of one cell of normals: what the probabilities are proportional to,
  // column by column, and the mean cosine over the sky, weighted by radiance.
  struct alignas(64) BlocksSeen {
    float weight[kLanes] = {};
    float cosine = 0;
  };
  struct Moments {
    double weight = 0, solidAngle = 0;  // as in Block
    // A sun may be anywhere in a part that is represented by its middle: the squared diagonal of the largest part.
    double leastVariance = 0;
    Vector3d sum{0.0};  // of directions, weighted
    void Add(double w, const Vector3d& direction) { weight += w, sum += w * direction; }
  };
  struct Pick {
    int row = 0, column = 0;
    double probability = 0;
  };
  // Directions at the corners of 8 × 8 parts of a cell, row by row.
  using Outline = std::vector<Vector3>;

  static int BlockOf(int column, int row) { return column / kPerBlock * kBlocks + row / kPerBlock; }
  static int LaneOf(int column, int row) { return column % kPerBlock * kPerBlock + row % kPerBlock; }
  Outline OutlineOf(const Directions& direction, int column, int row) const;
  void TabulateBlocks(uint32_t cell);
  Moments MomentsOfCell(const ColorTable& table, int column, int row, const Directions& direction,
                        const Outline& outline) const;
  static void Set(Block& block, int lane, const Moments& moments, const Outline& outline);
  static float Light(const Block& block, const SkyReceiver& receiver, float slack, float (&cosines)[kLanes]);
  float WeighBlocks(const SkyReceiver& receiver, Weights& weights) const;
  static void WeighCells(const Block& block, const SkyReceiver& receiver, float cosine, Weights& weights);
  static Pick PickLane(const Weights& weights, double& ux, double& uy);
  float GainOf(double probability, int column, int row) const;

  int width_ = 0, height_ = 0;
  std::array<int, kSide + 1> firstColumn_{}, firstRow_{};
  std::array<Block, kBlocks * kBlocks> cells_;
  std::vector<BlocksSeen> seen_ = std::vector<BlocksSeen>(normal_cells::kCount);  // by normal
  // Cumulated density of the rows within each column of cells, starting with 0 for each column.
  std::vector<double> strips_;
  std::array<double, size_t{kSide} * kSide> share_{};  // of a cell in the table
};

}  // namespace lampyr
