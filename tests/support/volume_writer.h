// NanoVDB files whose content is known, by the library that defines them.
#pragma once

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#define NANOVDB_USE_ZIP
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/SampleFromVoxels.h>

namespace lampyr::test {

using VolumeHandle = nanovdb::GridHandle<nanovdb::HostBuffer>;

struct Volume {
  std::string name = "density";
  nanovdb::CoordBBox box;
  std::function<float(const nanovdb::Coord&)> value;  // 0: left to the background
  nanovdb::Map map = {};                              // from indices to space; all 0: the identity
  float background = 0;
  nanovdb::GridClass gridClass = nanovdb::GridClass::FogVolume;
};

inline nanovdb::Map ScalingMap(double voxelSize, const nanovdb::Vec3d& origin) {
  nanovdb::Map map;
  map.set(voxelSize, origin, 1.0);
  return map;
}

inline VolumeHandle MakeVolume(const Volume& volume) {
  nanovdb::GridBuilder<float> builder(volume.background, volume.gridClass);
  auto accessor = builder.getAccessor();
  for (auto at = volume.box.begin(); at; ++at) {
    const float value = volume.value(*at);
    if (value != 0) accessor.setValue(*at, value);
  }
  const bool isIdentity = volume.map.mMatD[0] == 0 && volume.map.mMatD[1] == 0 && volume.map.mMatD[2] == 0;
  return builder.getHandle<>(isIdentity ? ScalingMap(1, nanovdb::Vec3d(0.0)) : volume.map, volume.name);
}

inline std::string VolumeFile(const std::vector<Volume>& volumes, nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  std::vector<VolumeHandle> handles;
  for (const Volume& volume : volumes) handles.push_back(MakeVolume(volume));
  std::ostringstream stream(std::string(4096, '\0'));  // the writer skips the place of the header, to write it last
  nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(stream, handles, codec);
  return stream.str().substr(0, static_cast<size_t>(stream.tellp()));
}

// A blob of a few bricks around the origin, with a block of equal values and empty bricks.
inline Volume SmallVolume() {
  return {"density", nanovdb::CoordBBox({-11, -5, -9}, {13, 9, 8}), [](const nanovdb::Coord& at) {
            if (at[0] > 0 && at[1] > 0 && at[2] > 0) return 0.0f;
            if (at[0] < -3) return 0.25f;
            return 0.1f + 0.01f * static_cast<float>(at[0] + 11) + 0.02f * static_cast<float>(at[1] + 5) +
                   0.003f * static_cast<float>((at[2] + 9) * (at[2] + 9));
          }};
}

}  // namespace lampyr::test
