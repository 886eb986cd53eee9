// Sampling of a ShapedFactor, and its integrals. Internal to shaping.cpp.
//
// The sphere is divided into rows in θ and columns in φ, at all kinks of the factor and more finely where it varies. A
// cell is selected by its exact integral and sampled uniformly in (m, φ), where m is the measure of the emitter's
// photons: w = 1 - cosθ, and for flat emitters sin²θ/2, dm = cosθ dw. A cone with a hard edge, on a point or a flat
// emitter, is one cell and is sampled exactly in proportion.
#pragma once

#include <functional>

#include "lights/types/shaped_factor.h"
#include "math/density.h"
#include "sampling/tables.h"

namespace lampyr {

class ShapedTable {
 public:
  // `flat`: only the hemisphere of -z emits, and density includes the cosine.
  ShapedTable(const ShapedFactor& factor, bool flat);

  bool IsDark() const { return distribution_.IsZero(); }
  Vector3 Sample(const Point2& u) const;  // requires !IsDark()
  float Density(const Vector3& local) const;
  double WidestTheta() const { return rows_.empty() ? 0 : rows_.back().theta; }
  // Solid angle (or projected solid angle) with the same integral at a constant factor.
  double EffectiveMeasure() const { return effectiveMeasure_; }

  // ∫ factor · weight dω over the emitting side; without a weight, of the cosine for flat emitters.
  Color Integrate(const ShapedFactor& factor, const std::function<double(const Vector3d&)>* weight) const;

 private:
  struct Row {  // where a row begins
    double theta = 0, w = 0, m = 0;
  };
  std::vector<Row> rows_;       // one more than there are rows
  std::vector<float> columns_;  // turns, one more than there are columns
  Distribution2D distribution_;
  std::vector<double> rowW_;     // of each row, close together for the search
  std::vector<uint16_t> guide_;  // guide table for w: the row at each of equal steps, and the last
  double stepsPerW_ = 0;
  std::vector<float> densities_;  // of each cell, per measure
  bool flat_ = false;
  double effectiveMeasure_ = 0;

  double Measure(const AxisAngle& angle) const {
    return flat_ ? 0.5 * angle.fromAxis * angle.fromZenith : angle.fromAxis;
  }
  void CutRows(const ShapedFactor& factor);
  void CutColumns(const ShapedFactor& factor);
  void SetDensities();
  void SetGuide();
  size_t RowAt(double w) const;
  void SpreadToNeighbours(std::vector<float>& cells) const;
  size_t RowCount() const { return rows_.empty() ? 0 : rows_.size() - 1; }
  size_t ColumnCount() const { return columns_.size() - 1; }
};

}  // namespace lampyr
