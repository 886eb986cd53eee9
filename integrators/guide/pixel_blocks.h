// Mean brightness of blocks of pixels, to which errors are relative while single pixels are not known yet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lampyr {

// Divides an image into blocks of pixels.
class BlockLayout {
 public:
  BlockLayout(int width, int height)
      : width_(width),
        size_(std::max((std::max(width, height) + kAcross - 1) / kAcross, kLeastSize)),
        across_((width + size_ - 1) / size_),
        count_(static_cast<size_t>(across_) * static_cast<size_t>((height + size_ - 1) / size_)) {}

  size_t Count() const { return count_; }
  // `pixel`: y · width + x.
  size_t Of(uint32_t pixel) const {
    const auto x = static_cast<int>(pixel % static_cast<uint32_t>(width_)),
               y = static_cast<int>(pixel / static_cast<uint32_t>(width_));
    return static_cast<size_t>(y / size_) * static_cast<size_t>(across_) + static_cast<size_t>(x / size_);
  }

 private:
  static constexpr int kAcross = 32, kLeastSize = 4;  // blocks across the image, and pixels across a block

  int width_, size_, across_;
  size_t count_;
};

class PixelBlocks {
 public:
  // Sums over the samples of a block.
  struct Block {
    double found = 0, squares = 0, count = 0;
  };

  // The blocks of an image of width × height pixels.
  PixelBlocks(int width, int height) : layout_(width, height), blocks_(layout_.Count()) {}

  size_t Count() const { return blocks_.size(); }
  // `pixel`: y · width + x.
  size_t Of(uint32_t pixel) const { return layout_.Of(pixel); }
  const BlockLayout& Layout() const { return layout_; }
  // Adds a sample that has found this radiance: mean of the channels, W/(m² sr).
  void Add(uint32_t pixel, double found) {
    Block& block = blocks_[Of(pixel)];
    block.found += found;
    block.squares += found * found;
    ++block.count;
  }
  // 1 / brightness of each block, to which errors are relative. Dark blocks count for brighter than they are.
  std::vector<double> Scales() const {
    double found = 0, count = 0;
    for (const Block& block : blocks_) {
      found += block.found;
      count += block.count;
    }
    std::vector<double> scales(blocks_.size());
    if (!(found > 0)) return scales;
    for (size_t i = 0; i < blocks_.size(); ++i) {
      const Block& block = blocks_[i];
      scales[i] = 1 / ((block.count > 0 ? block.found / block.count : 0.0) + kDark * found / count);
    }
    return scales;
  }
  // The squared mean of a block, from pairs of different samples. 0: there are fewer than two.
  double SquaredMean(size_t index) const {
    const Block& block = blocks_[index];
    if (block.count < 2) return 0;
    return std::max(block.found * block.found - block.squares, 0.0) / (block.count * (block.count - 1));
  }
  double AllSamples() const {
    double count = 0;
    for (const Block& block : blocks_) count += block.count;
    return count;
  }

  // For files. Set: false if the blocks cannot be those of this image.
  std::span<const Block> All() const { return blocks_; }
  bool Set(std::vector<Block> blocks) {
    if (blocks.size() != blocks_.size()) return false;
    for (const Block& block : blocks) {
      const bool isSound = block.found - block.found == 0 && block.squares - block.squares == 0 && block.count >= 0 &&
                           block.count - block.count == 0;
      if (!isSound) return false;
    }
    blocks_ = std::move(blocks);
    return true;
  }

 private:
  // Brightness that is added to that of a block, in means of the image: the error of dark parts counts less.
  static constexpr double kDark = 0.1;

  BlockLayout layout_;
  std::vector<Block> blocks_;
};

}  // namespace lampyr
