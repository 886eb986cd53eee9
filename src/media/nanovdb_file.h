// Reader of NanoVDB files of format 32 (OpenVDB 8 and later): grids of floats, plain or compressed by ZIP. Nothing in
// the file is trusted: every offset is checked before it is followed, and memory is counted before it is taken.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/transform.h"
#include "media/sparse_voxels.h"

namespace lampyr {

// A grid of a file, copied out of it.
struct NanoVdbGrid {
  SparseVoxels voxels;
  Transform indexToMedium;  // voxels' values are at whole indices
};

class NanoVdbReader {
 public:
  // Reads the directory of grids. Throws an Error without a place if the bytes are not those of such a file.
  explicit NanoVdbReader(std::span<const std::byte> bytes);
  ~NanoVdbReader();

  // Names of the grids in order; there may be equal ones.
  std::vector<std::string> Names() const;

  // The first grid of the name; nullopt if there is none. Throws Errors, without a place where the file is wrong, and
  // at `where` where it needs more than is left of `memory`.
  std::optional<NanoVdbGrid> Read(const std::string& name, bool mayBeNegative, MemoryBudget& memory,
                                  const FileLocation& where) const;

 private:
  struct Entry;
  std::vector<Entry> entries_;
};

}  // namespace lampyr
