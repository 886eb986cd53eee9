// The ABI that a plugin was compiled against, as a line of text in the plugin: the version, the ABI of the compiler and
// of the standard library, and the layout of all types that cross the boundary. lampyr loads only plugins with its own
// line.
//
// The line is stored in the file as an ELF note (owner "lampyr", type 1), and is read from there before any code of the
// plugin runs and before any of its symbols is looked up (plugin_file.h). A plugin for another version of lampyr is
// thus distinguished from a broken one, whatever symbols it lacks and whatever its static constructors would do.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>
#include <version>

#include "base/version.h"
#include "film/image.h"
#include "lights/emission_image.h"
#include "lights/filters/filter_base.h"
#include "lights/light_base.h"
#include "sampling/tables.h"

namespace lampyr {

// Must be incremented with every change of the interface that changes no size: a virtual function added or moved, a
// number with a new meaning.
inline constexpr int kPluginInterface = 3;

// Text assembled at compile time, padded with zeros.
struct PluginStamp {
  static constexpr uint32_t kSize = 256;
  char text[kSize] = {};
  uint32_t length = 0;

  constexpr PluginStamp& operator<<(const char* more) {
    for (; *more; ++more) text[length++] = *more;  // beyond kSize it does not compile
    return *this;
  }
  constexpr PluginStamp& operator<<(uint64_t number) {
    char digits[20] = {};
    int count = 0;
    do {
      digits[count++] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    while (count > 0) text[length++] = digits[--count];
    return *this;
  }
};

namespace plugin_internal {

// FNV-1a over sizes and alignments.
template <class... Types>
constexpr uint64_t LayoutOf() {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const uint64_t number : {uint64_t{sizeof(Types)}..., uint64_t{alignof(Types)}...}) {
    hash = (hash ^ number) * 0x100000001b3u;
  }
  return hash;
}

constexpr uint64_t kLayout =
    LayoutOf<void*, std::string, std::vector<int>, std::function<void()>, std::shared_ptr<int>, Point3, Point2d,
             Point3d, Color, Affine, Transform, Bounds3, FileLocation, Error, Parameter, ParameterList, ParameterInfo,
             TypeDescription, Diagnostics, LightTransform, LightContext, LightSample, LightHit, LightEvaluation,
             EmissionSample, EmissionBounds, SegmentEstimate, LocalRay, LocalHit, LightSettings, Light, LightBase,
             LightTint, LightBuildContext, LightType, FilterSamples, FilterInstance, FilterContext, LightFilter,
             FilterSettings, FilterBase, FilterEdge, FilterBuildContext, FilterType, Image, EmissionImage,
             Distribution1D, Distribution2D, AliasTable>();

constexpr PluginStamp MakeStamp() {
  PluginStamp stamp;
  stamp << "lampyr " << kVersion << ", plugin interface " << uint64_t{kPluginInterface};
  stamp << ", C++ ABI " << uint64_t{__GXX_ABI_VERSION};
#if defined(_GLIBCXX_RELEASE)
  stamp << ", libstdc++ with " << (_GLIBCXX_USE_CXX11_ABI ? "new" : "old") << " strings";
#if defined(_GLIBCXX_DEBUG)
  stamp << " and debug containers";
#endif
#elif defined(_LIBCPP_VERSION)
  stamp << ", libc++ " << uint64_t{_LIBCPP_VERSION};
#endif
  stamp << ", glm " << uint64_t{GLM_VERSION};
  stamp << ", layout " << kLayout;
  return stamp;
}

}  // namespace plugin_internal

inline constexpr PluginStamp kPluginStamp = plugin_internal::MakeStamp();

// The ELF note, in its layout in the file.
struct PluginNote {
  static constexpr char kOwner[8] = "lampyr";
  static constexpr uint32_t kType = 1;

  uint32_t ownerSize = 7, textSize = PluginStamp::kSize, type = kType;
  char owner[8] = "lampyr";
  char text[PluginStamp::kSize] = {};

  constexpr explicit PluginNote(const PluginStamp& stamp) {
    for (uint32_t i = 0; i < PluginStamp::kSize; ++i) text[i] = stamp.text[i];
  }
};

}  // namespace lampyr
