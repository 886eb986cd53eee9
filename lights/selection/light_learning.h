// Learned light selection: factors for the importances of the light tree, from the results of shadow rays. They lower
// clusters that are occluded in a region and raise those that were underestimated there.
//
// A region is a cell of a grid and a main direction of the normal; receivers without a normal have regions of their
// own. For each node of the tree that is visited from it, the mean square of (irradiance caused by a child ÷ importance
// of the child) is learned. Selection by its root minimises the variance ([Rath20 eq. 10]); a partly visible cluster is
// selected more often than by the mean. A child without observations takes the factor of its parent.
//
// Rows are addressed by a hash, and rows that collide share their observations: memory is bounded, and the result does
// not depend on the order of insertion. Sums are integers, so that they do not depend on the order of threads. Records
// take effect at the next Freeze: between two of them, selection is one fixed distribution with known probabilities.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/large_array.h"
#include "lights/selection/importance.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

class ByteReader;
class ByteWriter;

class LightLearning {
 public:
  static constexpr int kWidth = LobeBlock::kWidth;

  explicit LightLearning(const BoundingSphere& scene);

  uint32_t RegionOf(const Receiver& receiver) const;

  // The factor of a child's importance is √(known + (1 - learned) · (factor of the parent)²). All 0: no observations.
  struct alignas(64) Row {
    float known[kWidth], learned[kWidth];
  };
  const Row& RowOf(uint32_t region, uint32_t node) const { return rows_[IndexOf(region, node)]; }

  // Records that a child of a node caused `ratio` times its importance. May be called from any thread.
  void Record(uint32_t region, uint32_t node, int child, double ratio);
  // Puts all records into effect. Not concurrently with selection or recording.
  void Freeze();
  // Ends recording, to save its time.
  void StopRecording() { isRecording_ = false; }
  bool IsRecording() const { return isRecording_; }
  // Ends recording, and forgets all. Not concurrently with selection or recording.
  void Forget();

  // Copies the state of another object of the same scene. Not concurrently with the use of either.
  void CopyFrom(const LightLearning& other);
  // Copies to `copy` the rows that have changed since the previous call. `copy` must be equal to the state of this
  // object at that call, or be what this object was copied from; it is always the same one.
  void CopyChangesTo(LightLearning& copy);

  // Saves factors and records. Not concurrently with selection or recording.
  void Save(ByteWriter& bytes) const;
  // Restores what Save has written, for the same scene. Requires that nothing is recorded yet. Throws an Error if the
  // data do not fit.
  void Load(ByteReader& bytes);

 private:
  static size_t IndexOf(uint32_t region, uint32_t node);

  // Calls visit(row) for all rows with records.
  template <class Visit>
  void ForUsedRows(const Visit& visit) const;
  void CopyRowFrom(const LightLearning& other, size_t row);

  bool isRecording_ = true;
  Point3 center_;
  float cellsPerUnit_;
  // Rows that are never accessed, which are most, take no memory.
  SparseArray<Row> rows_;
  SparseArray<std::atomic<uint64_t>> squares_;  // in units of 2^-24
  SparseArray<std::atomic<uint32_t>> counts_;
  SparseArray<std::atomic<uint64_t>> used_;     // one bit per row
  SparseArray<std::atomic<uint64_t>> changed_;  // since CopyChangesTo; one bit per row
};

}  // namespace lampyr
