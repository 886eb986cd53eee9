// Reader of NanoVDB files of format 32 (OpenVDB 8 and later): grids of floats, plain or compressed by ZIP. Files are
// not trusted: every offset is checked before it is followed, and memory is counted before it is allocated.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/transform.h"
#include "media/sparse_voxels.h"

namespace lampyr {

// A grid, copied from a file.
struct NanoVdbGrid {
  SparseVoxels voxels;
  Transform indexToMedium;  // voxels' values are at whole indices
};

class NanoVdbReader {
 public:
  // Reads the directory of grids. Throws an Error without a location if the bytes are not those of a NanoVDB file.
  explicit NanoVdbReader(std::span<const std::byte> bytes);
  ~NanoVdbReader();

  // Names of the grids in order; names may occur more than once.
  std::vector<std::string> Names() const;

  // The first grid of the name; nullopt if there is none. Throws Errors: without a location if the file is invalid, and
  // at `where` if the grid exceeds the rest of `memory`.
  std::optional<NanoVdbGrid> Read(const std::string& name, bool mayBeNegative, MemoryBudget& memory,
                                  const FileLocation& where) const;

 private:
  struct Entry;
  std::vector<Entry> entries_;
};

}  // namespace lampyr
