#include "lights/types/surface_table.h"

#include <vector>

namespace lampyr {

namespace {

constexpr int kLargest = 1024;  // cells a side

int CellsFor(int texels) {
  return std::clamp(texels, 8, kLargest);
}

// Mean of the texels that a cell's bilinear lookups can touch: positive wherever the image is in the cell.
float MeanOfTexels(const EmissionImage& image, const Point2& low, const Point2& high) {
  // A texel for the lookup's own width and one for the curvature between the points that bounded the cell.
  constexpr float margin = 1.5f;
  const auto first = [](float texel, int n) {
    return std::clamp(static_cast<int>(std::floor(texel - margin)), 0, n - 1);
  };
  const auto last = [](float texel, int n) {
    return std::clamp(static_cast<int>(std::floor(texel + margin)), 0, n - 1);
  };
  const auto width = static_cast<float>(image.Width()), height = static_cast<float>(image.Height());
  const int x0 = first(low.x * width, image.Width()), x1 = last(high.x * width, image.Width());
  const int y0 = first((1 - high.y) * height, image.Height()), y1 = last((1 - low.y) * height, image.Height());
  double sum = 0;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) sum += static_cast<double>(image.Texel(x, y).Average());
  }
  return static_cast<float>(sum / (static_cast<double>(x1 - x0 + 1) * (y1 - y0 + 1)));
}

}  // namespace

std::unique_ptr<const Distribution2D> MakeSurfaceTable(const EmissionImage& image, const SurfaceTableInput& surface) {
  const int across = surface.firstIsV ? image.Height() : image.Width();
  const int along = surface.firstIsV ? image.Width() : image.Height();
  const int width = CellsFor(across), height = CellsFor(along);
  // Points per side of a cell: about one per texel.
  const int n = std::clamp((std::max(across / width, along / height)) + 2, 3, 9);
  std::vector<float> weights(static_cast<size_t>(width) * height);
  for (int cell = 0; cell < width * height; ++cell) {
    Point2 low(1.0f), high(0.0f);
    double sum = 0;
    for (int k = 0; k < n * n; ++k) {
      const Point2 within(static_cast<float>(k % n) / static_cast<float>(n - 1),
                          static_cast<float>(k / n) / static_cast<float>(n - 1));
      const Point2 square((static_cast<float>(cell % width) + within.x) / static_cast<float>(width),
                          (static_cast<float>(cell / width) + within.y) / static_cast<float>(height));
      const Point2 uv = surface.uv(square);
      low = glm::min(low, uv);
      high = glm::max(high, uv);
      sum += static_cast<double>(image.OnSurface(uv).Average());
    }
    const Point2 middle((static_cast<float>(cell % width) + 0.5f) / static_cast<float>(width),
                        (static_cast<float>(cell / width) + 0.5f) / static_cast<float>(height));
    // The points may miss a bright texel between them, or one whose light ends at the border of the cell; the mean of
    // the texels does not.
    const float mean = std::max(static_cast<float>(sum / (n * n)), MeanOfTexels(image, low, high));
    weights[static_cast<size_t>(cell)] = mean * surface.element(middle);
  }
  auto table = std::make_unique<const Distribution2D>(weights, width, height);
  return table->IsZero() ? nullptr : std::move(table);
}

}  // namespace lampyr
