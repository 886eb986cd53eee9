#include "lights/types/image_profile.h"

namespace lampyr {

namespace {

constexpr int kSide = 64;

// The texels [first, last) that part `index` of a side lies in, and its bounds in [0,1].
struct Span {
  int first, last;
  double low, high;
};
std::vector<Span> DivideSide(int texels) {
  std::vector<Span> spans;
  const int perTexel = (kSide + texels - 1) / texels;
  const int count = texels < kSide ? texels * perTexel : kSide;
  for (int i = 0; i < count; ++i) {
    if (texels < kSide) {
      spans.push_back({i / perTexel, i / perTexel + 1, static_cast<double>(i) / count, (i + 1.0) / count});
    } else {
      const auto at = [&](int k) { return static_cast<int>(static_cast<int64_t>(k) * texels / kSide); };
      const int first = at(i), last = at(i + 1);
      spans.push_back({first, last, static_cast<double>(first) / texels, static_cast<double>(last) / texels});
    }
  }
  return spans;
}

}  // namespace

ImageParts::ImageParts(const EmissionImage& image) {
  const std::vector<Span> columns = DivideSide(image.Width()), rows = DivideSide(image.Height());
  parts_.reserve(columns.size() * rows.size());
  for (const Span& row : rows) {
    for (const Span& column : columns) {
      double sum[3] = {0, 0, 0};
      for (int y = row.first; y < row.last; ++y) {
        for (int x = column.first; x < column.last; ++x) {
          const Color texel = image.Texel(x, y);
          sum[0] += static_cast<double>(texel.r);
          sum[1] += static_cast<double>(texel.g);
          sum[2] += static_cast<double>(texel.b);
        }
      }
      const double share = 1.0 / (static_cast<double>(row.last - row.first) * (column.last - column.first));
      parts_.push_back({{column.low, row.low},
                        {column.high, row.high},
                        {static_cast<float>(sum[0] * share), static_cast<float>(sum[1] * share),
                         static_cast<float>(sum[2] * share)}});
    }
  }
}

}  // namespace lampyr
