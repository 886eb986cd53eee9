#include "media/majorant_grid.h"

#include <utility>

namespace lampyr {

MajorantGrid::MajorantGrid(const Bounds3& bounds, int nx, int ny, int nz, std::vector<float> majorants,
                           const Affine& toMedium)
    : bounds_(bounds), resolution_{nx, ny, nz}, majorants_(std::move(majorants)), toMedium_(toMedium) {}

}  // namespace lampyr
