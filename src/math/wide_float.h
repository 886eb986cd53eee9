// A number of four bytes with the range of double.
#pragma once

#include <bit>
#include <cstdint>

namespace lampyr {

// A value that is 0, positive or infinite, with the exponent of a double and 21 bits of its mantissa: the relative
// error is at most 2.4e-7. For densities and volumes that are stored in millions: for lengths of 1e13, volumes exceed
// the range of float.
class WideFloat {
 public:
  WideFloat() = default;
  constexpr explicit WideFloat(double value)
      : bits_(static_cast<uint32_t>((std::bit_cast<uint64_t>(value) + kHalf) >> kDropped)) {}
  constexpr explicit operator double() const { return std::bit_cast<double>(uint64_t{bits_} << kDropped); }

 private:
  static constexpr int kDropped = 31;  // bits of the mantissa; the sign is always 0
  static constexpr uint64_t kHalf = uint64_t{1} << (kDropped - 1);

  uint32_t bits_ = 0;
};
static_assert(static_cast<double>(WideFloat(1.5)) == 1.5 && static_cast<double>(WideFloat(0.0)) == 0);

}  // namespace lampyr
