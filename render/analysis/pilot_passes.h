// Passes of an integrator over the pilot's pixels.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "film/pixel_filter.h"
#include "integrators/photon/photon_pass.h"
#include "integrators/photon/photon_store.h"
#include "render/analysis/pilot_records.h"

namespace lampyr::pilot {

inline constexpr int kChunks = 8;
inline constexpr uint64_t kSeed = 0x9e3779b97f4a7c15;

// Records of the samples of a pass, besides their counts. All may be empty or null.
struct Noted {
  std::span<Recorder> recorders = {};  // of the paths; one for each chunk
  // Difference between the lights that next-event estimation chooses, by pixel, times the filter weight of the sample.
  std::vector<LightSpread>* spreads = nullptr;
  std::vector<double>* values = nullptr;  // by pixel: what the sample adds to it
  std::vector<double>* biases = nullptr;  // the same of SampleContext::mergeBias
  std::span<PathRecords> paths = {};      // records of camera paths; one for each chunk
};

class PilotPasses {
 public:
  PilotPasses(const RenderScene& scene, const RenderSettings& settings, const Grid& grid, int threads)
      : scene_(scene),
        settings_(settings),
        grid_(grid),
        threads_(threads),
        filter_(settings.filter),
        photons_(kChunks) {}

  // Traces the photons of a pass; where the integrator gathers none, it has none.
  PassCounts TracePhotons(const Integrator& integrator, PhotonStore& store, uint32_t pass);
  // One sample of every pixel. A pixel of the pilot covers several pixels of the image, of which passes 2i and 2i + 1
  // sample the same one: differences between pixels of the image are not noise.
  PassCounts Trace(const Integrator& integrator, uint32_t pass, const PhotonPass* gather, const Noted& noted = {});

 private:
  float Time(uint32_t pass) const;
  // `count`: of the pixels, or more, with further rows.
  template <class Body>
  PassCounts ForEachPixel(int count, const Body& body);

  const RenderScene& scene_;
  const RenderSettings& settings_;
  const Grid& grid_;
  int threads_;
  PixelFilter filter_;
  std::vector<PhotonList> photons_;
};

// An integrator for the pilot. `fewer`: pixels of the film for each of the pilot's.
std::unique_ptr<Integrator> Make(const char* name, const RenderScene& scene, const RenderSettings& settings,
                                 double fewer, const TechniqueCounts* counts = nullptr);

// The photon settings of an integrator; the number of light paths, if it is set, is divided by `fewer`.
PhotonSettings PhotonsOfPilot(const Integrator& integrator, double fewer);

// Radius of the pilot's merging, in radii of the first pass of a render. The pilot has fewer light paths by the factor
// `fewer`; a lookup within the larger radius finds as many photons as in the render.
double WiderRadius(double fewer, double alpha);
// The radius is that of the average pass of so many.
inline constexpr double kTypicalPasses = 64;

}  // namespace lampyr::pilot
