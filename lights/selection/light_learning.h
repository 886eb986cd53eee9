// What shadow rays find out, region by region: which clusters of emitters are occluded there, and which matter more
// than was estimated. The light tree multiplies its importances by it.
//
// A region is a cell of a grid and a main direction of the normal. For each node of the tree that is looked at from it,
// the mean square of (what a child really sends ÷ its importance) is learned: choosing by its root minimises variance
// ([Rath20 eq. 10]), and a cluster of which a part can be seen is chosen more often than by the mean. What is not known
// yet of a child is taken from its parent.
//
// Rows are found by a hash, and rows that meet share what they learn: memory is bounded, and nothing depends on who
// comes first. Sums are integers, so that they do not depend on the order of threads. What was recorded counts from the
// next Freeze on: between two of them, selection is one distribution, whose probabilities are known exactly.
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

  // The factor of a child's importance is the root of known + (1 - learned) · (the parent's factor)². All 0: nothing is
  // known.
  struct alignas(64) Row {
    float known[kWidth], learned[kWidth];
  };
  const Row& RowOf(uint32_t region, uint32_t node) const { return rows_[IndexOf(region, node)]; }

  // A child of a node sent `ratio` times its importance. From any thread.
  void Record(uint32_t region, uint32_t node, int child, double ratio);
  // All that was recorded counts from now on. While nobody selects or records.
  void Freeze();
  // Once enough is known, the time that recording takes is saved.
  void StopRecording() { isRecording_ = false; }
  bool IsRecording() const { return isRecording_; }

  // All that another one of the same scene has learned and recorded. While nobody selects or records with either.
  void CopyFrom(const LightLearning& other);

  // All that was learned and recorded. While nobody selects or records.
  void Save(ByteWriter& bytes) const;
  // Into one that has learned nothing, of the same scene. Throws an Error where this is not what has been saved.
  void Load(ByteReader& bytes);

 private:
  static size_t IndexOf(uint32_t region, uint32_t node);

  // Calls visit(row) for all rows that something was recorded in.
  template <class Visit>
  void ForUsedRows(const Visit& visit) const;

  bool isRecording_ = true;
  Point3 center_;
  float cellsPerUnit_;
  // Most rows of most scenes are never touched, and take no memory then.
  SparseArray<Row> rows_;
  SparseArray<std::atomic<uint64_t>> squares_;  // in units of 2^-24
  SparseArray<std::atomic<uint32_t>> counts_;
  SparseArray<std::atomic<uint64_t>> used_;  // a bit for each row
};

}  // namespace lampyr
