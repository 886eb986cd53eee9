// The only source that depends on NanoVDB's header: it uses the layout of the format, but none of the code that follows
// offsets.
//
// A file is a sequence of segments: a header, a directory of grids, then the grids. A grid is a tree of three levels of
// nodes below the root (upper 32³, lower 16³, leaf 8³ voxels); the nodes of a level are an array.
#include "media/nanovdb_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <set>

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/IO.h>

namespace lampyr {

namespace {

using Root = nanovdb::NanoRoot<float>::DataType;
using Upper = nanovdb::NanoUpper<float>::DataType;
using Lower = nanovdb::NanoLower<float>::DataType;
using Leaf = nanovdb::NanoLeaf<float>::DataType;

constexpr uint32_t kFormat = 32;

// "NanoVDB" and a digit: 0, or larger in newer versions of the same format.
bool IsMagic(uint64_t magic) {
  constexpr uint64_t kName = NANOVDB_MAGIC_NUMBER & 0x00ffffffffffffff;
  return (magic & 0x00ffffffffffffff) == kName && magic >> 56 >= '0' && magic >> 56 <= '2';
}

// Reads values and runs of bytes from the front.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::span<const std::byte> Take(uint64_t count) {
    if (count > bytes_.size()) throw Error("it ends early: it is cut off, or damaged");
    const auto taken = bytes_.first(static_cast<size_t>(count));
    bytes_ = bytes_.subspan(static_cast<size_t>(count));
    return taken;
  }
  template <class T>
  T Value() {
    T value;
    std::memcpy(static_cast<void*>(&value), Take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  size_t Left() const { return bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
};

// Memory for nodes.
struct alignas(64) Block {
  std::byte bytes[64];
};

[[noreturn]] void Damaged(const std::string& what) {
  throw Error("it is damaged: " + what);
}

// A grid in memory whose arrays of nodes have been checked to lie in it.
class GridTree {
 public:
  explicit GridTree(std::span<const std::byte> bytes) : bytes_(bytes) {
    const auto& tree = *At<nanovdb::TreeData<3>>(sizeof(nanovdb::GridData), 1);
    for (size_t level = 0; level < 3; ++level) counts_[level] = tree.mNodeCount[level];
    for (size_t level = 0; level < 4; ++level) {
      if (tree.mNodeOffset[level] > bytes.size()) Damaged("nodes are outside of their grid");
      offsets_[level] = sizeof(nanovdb::GridData) + tree.mNodeOffset[level];
    }
    leaves_ = At<Leaf>(offsets_[0], counts_[0]);
    lowers_ = At<Lower>(offsets_[1], counts_[1]);
    uppers_ = At<Upper>(offsets_[2], counts_[2]);
    root_ = At<Root>(offsets_[3], 1);
    tiles_ = At<Root::Tile>(offsets_[3] + sizeof(Root), root_->mTableSize);
    for (size_t level = 0; level < 3; ++level) isTaken_[level].resize(counts_[level]);
  }

  const nanovdb::GridData& Grid() const { return *reinterpret_cast<const nanovdb::GridData*>(bytes_.data()); }
  const Root& RootNode() const { return *root_; }
  std::span<const Root::Tile> Tiles() const { return {tiles_, root_->mTableSize}; }
  size_t LeafCount() const { return counts_[0]; }
  const Leaf& LeafNode(size_t i) const { return leaves_[i]; }

  // Children, by the offset that their parent stores, relative to the parent. Each may be requested once: shared nodes
  // would make a tree larger than its file.
  const Upper& UpperOf(int64_t offset) { return uppers_[ChildIndex(root_, offset, 2, sizeof(Upper))]; }
  const Lower& LowerOf(const Upper& parent, int64_t offset) {
    return lowers_[ChildIndex(&parent, offset, 1, sizeof(Lower))];
  }
  size_t LeafIndexOf(const Lower& parent, int64_t offset) { return ChildIndex(&parent, offset, 0, sizeof(Leaf)); }

 private:
  template <class T>
  const T* At(uint64_t offset, uint64_t count) const {
    if (offset % alignof(T) != 0 || offset > bytes_.size() || count > (bytes_.size() - offset) / sizeof(T))
      Damaged("nodes are outside of their grid");
    return reinterpret_cast<const T*>(bytes_.data() + offset);
  }

  size_t ChildIndex(const void* parent, int64_t offset, size_t level, size_t size) {
    const auto from = static_cast<int64_t>(static_cast<const std::byte*>(parent) - bytes_.data());
    const auto size64 = static_cast<int64_t>(bytes_.size());
    // Neither sum overflows: all of these are below the size of memory.
    if (offset < -size64 || offset > size64) Damaged("a node refers to one outside of its grid");
    const int64_t within = from + offset - static_cast<int64_t>(offsets_[level]);
    const auto count = static_cast<int64_t>(counts_[level]);
    if (within < 0 || within % static_cast<int64_t>(size) != 0 || within / static_cast<int64_t>(size) >= count)
      Damaged("a node refers to none of the next level");
    const auto index = static_cast<size_t>(within / static_cast<int64_t>(size));
    if (isTaken_[level][index]) Damaged("two nodes refer to the same one");
    isTaken_[level][index] = true;
    return index;
  }

  std::span<const std::byte> bytes_;
  std::array<uint64_t, 4> offsets_{};
  std::array<uint64_t, 3> counts_{};
  std::array<std::vector<bool>, 3> isTaken_;
  const Leaf* leaves_ = nullptr;
  const Lower* lowers_ = nullptr;
  const Upper* uppers_ = nullptr;
  const Root* root_ = nullptr;
  const Root::Tile* tiles_ = nullptr;
};

// Copies the part of a tree that lies in the bricks of `voxels`.
class TreeCopier {
 public:
  TreeCopier(GridTree& tree, SparseVoxels& voxels) : tree_(tree), voxels_(voxels) {}

  void Copy() {
    for (size_t i = 0; i < tree_.LeafCount(); ++i)
      std::memcpy(voxels_.Brick(i), tree_.LeafNode(i).mValues, SparseVoxels::kBrickVoxels * sizeof(float));
    std::set<std::array<int, 3>> origins;
    for (const Root::Tile& tile : tree_.Tiles()) {
      const nanovdb::Coord at = Root::KeyToCoord(tile.key);
      const std::array<int, 3> origin = {at[0] >> 3, at[1] >> 3, at[2] >> 3};
      if (!origins.insert(origin).second) Damaged("two nodes are at the same place");
      if (tile.child != 0) {
        CopyUpper(tree_.UpperOf(tile.child), origin);
      } else {
        Fill(origin, kUpperBricks, tile.value);
      }
    }
  }

 private:
  // Sides of nodes in bricks.
  static constexpr int kLowerBricks = 16, kUpperBricks = 512;

  // Calls visit(n, origin) for the children of a node that touch the bricks; n is the child's number in its parent.
  template <class Visit>
  void ForChildren(const std::array<int, 3>& origin, int childSide, int log2Count, const Visit& visit) const {
    std::array<int, 3> first, last, i;
    for (int axis = 0; axis < 3; ++axis) {
      const int low = voxels_.BrickRange().min[axis] - origin[axis],
                high = voxels_.BrickRange().max[axis] - origin[axis];
      if (high < 0) return;
      first[axis] = std::max(low, 0) / childSide;
      last[axis] = std::min(high / childSide, (1 << log2Count) - 1);
    }
    for (i[0] = first[0]; i[0] <= last[0]; ++i[0]) {
      for (i[1] = first[1]; i[1] <= last[1]; ++i[1]) {
        for (i[2] = first[2]; i[2] <= last[2]; ++i[2]) {
          visit(static_cast<uint32_t>((i[0] << log2Count | i[1]) << log2Count | i[2]),
                std::array<int, 3>{origin[0] + i[0] * childSide, origin[1] + i[1] * childSide,
                                   origin[2] + i[2] * childSide});
        }
      }
    }
  }

  void CopyUpper(const Upper& upper, const std::array<int, 3>& origin) const {
    ForChildren(origin, kLowerBricks, 5, [&](uint32_t n, const std::array<int, 3>& at) {
      if (upper.mChildMask.isOn(n)) {
        CopyLower(tree_.LowerOf(upper, upper.mTable[n].child), at);
      } else {
        Fill(at, kLowerBricks, upper.mTable[n].value);
      }
    });
  }

  void CopyLower(const Lower& lower, const std::array<int, 3>& origin) const {
    ForChildren(origin, 1, 4, [&](uint32_t n, const std::array<int, 3>& at) {
      if (lower.mChildMask.isOn(n)) {
        voxels_.Place(at, tree_.LeafIndexOf(lower, lower.mTable[n].child));
      } else {
        voxels_.PlaceConstant(at, lower.mTable[n].value);
      }
    });
  }

  void Fill(const std::array<int, 3>& origin, int side, float value) const {
    if (value == tree_.RootNode().mBackground) return;  // the value of all voxels before the copy
    const IndexBox& range = voxels_.BrickRange();
    std::array<int, 3> first, last, at;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::max(origin[axis], range.min[axis]);
      last[axis] = std::min(origin[axis] + side - 1, range.max[axis]);
    }
    for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
      for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
        for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) voxels_.PlaceConstant(at, value);
      }
    }
  }

  GridTree& tree_;
  SparseVoxels& voxels_;
};

Transform IndexToMedium(const nanovdb::Map& map) {
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = map.mMatD[3 * row + column];
    matrix[3][row] = map.mVecD[row];
  }
  const Transform transform(matrix);
  if (transform.IsSingular()) throw Error("its transform from voxels to space has no inverse");
  return transform;
}

// The box of active voxels; a single voxel if the grid has none.
IndexBox BoxOf(const Root& root) {
  IndexBox box;
  if (root.mTableSize == 0 || root.mBBox.max()[0] < root.mBBox.min()[0]) return box;
  constexpr int kFarthest = 1 << 30;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = root.mBBox.min()[axis];
    box.max[axis] = root.mBBox.max()[axis];
    if (box.min[axis] > box.max[axis]) Damaged("the box of its voxels is inside out");
    if (box.min[axis] < -kFarthest || box.max[axis] > kFarthest) throw Error("it has voxels beyond an index of 2^30");
  }
  return box;
}

// Throws an Error if `packed` bytes cannot contain a grid of `size` bytes, before memory is allocated for it.
void CheckSize(nanovdb::io::Codec codec, uint64_t packed, uint64_t size) {
  constexpr uint64_t kLargestGrowth = 1100;  // of compression, which reaches 1032
  const bool isZipped = codec == nanovdb::io::Codec::ZIP;
  if (isZipped ? size / kLargestGrowth > packed : size != packed)
    Damaged("the directory gives a grid another size than it has");
}

void Unzip(std::span<const std::byte> bytes, std::span<std::byte> to) {
  ByteCursor cursor(bytes);
  const auto zipped = cursor.Take(cursor.Value<uint64_t>());
  auto size = static_cast<uLongf>(to.size());
  const int status = uncompress(reinterpret_cast<Bytef*>(to.data()), &size,
                                reinterpret_cast<const Bytef*>(zipped.data()), static_cast<uLong>(zipped.size()));
  if (status != Z_OK || size != to.size()) Damaged("its compressed data cannot be unpacked");
}

}  // namespace

struct NanoVdbReader::Entry {
  std::string name;
  nanovdb::io::Codec codec = nanovdb::io::Codec::NONE;
  nanovdb::io::MetaData metadata;
  std::span<const std::byte> bytes;  // of the grid, as the file holds it
};

NanoVdbReader::NanoVdbReader(std::span<const std::byte> bytes) {
  ByteCursor cursor(bytes);
  do {
    const auto header = cursor.Value<nanovdb::io::Header>();
    if (!IsMagic(header.magic)) {
      if (entries_.empty()) throw Error("it is no NanoVDB file: it does not start with \"NanoVDB\"");
      Damaged("what follows a grid is no grid");
    }
    if (header.version.getMajor() != kFormat) {
      throw Error("it is of format " + std::to_string(header.version.getMajor()) + " of NanoVDB, and not " +
                  std::to_string(kFormat));
    }
    const size_t first = entries_.size();
    for (int i = 0; i < header.gridCount; ++i) {
      Entry entry;
      entry.codec = header.codec;
      entry.metadata = cursor.Value<nanovdb::io::MetaData>();
      const auto name = cursor.Take(entry.metadata.nameSize);
      entry.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
      entry.name.resize(std::min(entry.name.size(), entry.name.find('\0')));
      entries_.push_back(std::move(entry));
    }
    for (size_t i = first; i < entries_.size(); ++i) entries_[i].bytes = cursor.Take(entries_[i].metadata.fileSize);
  } while (cursor.Left() > 0);
}

NanoVdbReader::~NanoVdbReader() = default;

std::vector<std::string> NanoVdbReader::Names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

std::optional<NanoVdbGrid> NanoVdbReader::Read(const std::string& name, bool mayBeNegative, MemoryBudget& memory,
                                               const FileLocation& where) const {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.name == name; });
  if (found == entries_.end()) return std::nullopt;
  const uint64_t size = found->metadata.gridSize;
  if (found->metadata.gridType != nanovdb::GridType::Float)
    throw Error("its grid \"" + name + "\" is not one of 32-bit floats");
  if (found->codec != nanovdb::io::Codec::NONE && found->codec != nanovdb::io::Codec::ZIP)
    throw Error("it is compressed by BLOSC: ZIP or no compression would be right (nanovdb_convert --zip)");
  if (size < sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>) + sizeof(Root)) Damaged("a grid is too short");
  CheckSize(found->codec, found->bytes.size(), size);
  memory.Take(static_cast<double>(size), where, "the nodes of \"" + name + "\"");
  std::vector<Block> blocks(static_cast<size_t>((size + sizeof(Block) - 1) / sizeof(Block)));
  const std::span<std::byte> grid(reinterpret_cast<std::byte*>(blocks.data()), static_cast<size_t>(size));
  if (found->codec == nanovdb::io::Codec::ZIP) {
    Unzip(found->bytes, grid);
  } else {
    std::memcpy(grid.data(), found->bytes.data(), grid.size());
  }
  GridTree tree(grid);
  const nanovdb::GridData& data = tree.Grid();
  if (!IsMagic(data.mMagic) || data.mGridType != nanovdb::GridType::Float) Damaged("a grid has another type inside");
  if (data.mGridClass != nanovdb::GridClass::FogVolume && data.mGridClass != nanovdb::GridClass::Unknown)
    throw Error("its grid \"" + name + "\" is no volume of densities (a fog volume), but a surface or points");
  NanoVdbGrid result{
      SparseVoxels(BoxOf(tree.RootNode()), tree.RootNode().mBackground, tree.LeafCount(), memory, where, name),
      IndexToMedium(data.mMap)};
  TreeCopier(tree, result.voxels).Copy();
  result.voxels.CheckValues(mayBeNegative);
  return result;
}

}  // namespace lampyr
