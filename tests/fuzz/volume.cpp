// NanoVDB files: what a medium of type "nanovdb" reads.
#include <cmath>
#include <cstring>
#include <span>

#include "fuzz/target_support.h"
#include "media/nanovdb_file.h"
#include "scene/text_file.h"

namespace lampyr::fuzz {

namespace {

// A valid file with values written over it: records of an offset (4 bytes) and a value (8 bytes). Most of a file is
// tables, in which no fuzzer finds the few bytes that matter, unless they are compressed, where it finds none.
std::string Patched(std::string_view records) {
  static const std::string valid = ReadTextFile(LAMPYR_SOURCE_DIR "/tests/fuzz/files/volume.nvdb.gz", {});
  std::string bytes = valid;
  constexpr size_t kRecord = sizeof(uint32_t) + sizeof(uint64_t);
  for (; records.size() >= kRecord; records.remove_prefix(kRecord)) {
    uint32_t offset = 0;
    std::memcpy(&offset, records.data(), sizeof offset);
    if (offset + sizeof(uint64_t) > bytes.size()) continue;
    std::memcpy(&bytes[offset], records.data() + sizeof offset, sizeof(uint64_t));
  }
  return bytes;
}

void CheckVoxels(const SparseVoxels& voxels) {
  const IndexBox& box = voxels.Box();
  const GridResolution cells = MajorantResolution(voxels);
  const std::vector<float> majorants = MajorantsOf(voxels, cells, 1);
  constexpr int kPoints = 64;
  for (int i = 0; i < kPoints; ++i) {
    Point3 at;
    size_t cell = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double part = std::fmod(0.5 + 0.37 * (i + 1) * (axis + 1), 1.0);
      const auto extent = static_cast<double>(voxels.Box().Extent(axis));
      at[axis] = static_cast<float>(static_cast<double>(box.min[axis]) + part * extent);
      const auto n = static_cast<size_t>(cells[axis]);
      cell = cell * n + std::min(static_cast<size_t>(part * static_cast<double>(n)), n - 1);
    }
    const float value = voxels.Interpolate(at);
    if (!std::isfinite(value)) Fail("a value that is no number");
    // Indices beyond 2^20 are rounded by more than the margin of a cell.
    if (MaxAbsComponent(at) < 0x1p20f && value > majorants[cell]) Fail("a value above its majorant");
  }
}

}  // namespace

bool ReadVolumeFile(std::string_view bytes) {
  if (bytes.empty()) return false;
  const std::string file = bytes[0] == 'p' ? Patched(bytes.substr(1)) : std::string(bytes.substr(1));
  return AcceptErrors([&] {
    const NanoVdbReader reader(std::as_bytes(std::span(file)));
    for (const std::string& name : reader.Names()) {
      MemoryBudget memory(uint64_t{1} << 26);
      const auto grid = reader.Read(name, false, memory, {});
      if (!grid) Fail("a name without a grid");
      CheckVoxels(grid->voxels);
    }
  });
}

}  // namespace lampyr::fuzz
