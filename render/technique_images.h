// Images of the contribution of each technique (s,t) of bidirectional path tracing, weighted and unweighted: they show
// which technique makes a picture wrong or noisy ([Veach97 fig. 10.4]). The weighted images add up to the render.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "integrators/bidirectional/connected_path.h"

namespace lampyr {

class TechniqueImages {
 public:
  // Techniques of paths with up to this many scattering events have images of their own; those of longer paths share
  // one image.
  static constexpr int kMostEvents = 6;

  // For a render of `width` × `height` pixels in full and paths of `maxDepth` events at most.
  TechniqueImages(int width, int height, const PixelRect& crop, int maxDepth);

  TechniqueImages EmptyCopy() const;

  // Memory per pixel of the crop, bytes.
  static uint64_t BytesPerPixel(int maxDepth);

  // Records the paths of one thread's samples: StartSample, then Observe for each path.
  class Recorder final : public PathObserver {
   public:
    Recorder(TechniqueImages& images, const PixelFilter& filter, const SensorResponse& sensor);
    // `scale`: factor of what the camera path finds. Pixels outside of the crop have no camera path.
    void StartSample(int x, int y, float scale);
    void Observe(const ConnectedPath& path) override;

   private:
    friend class TechniqueImages;
    TechniqueImages* images_;
    SensorResponse sensor_;
    std::vector<SplatList> weighted_, unweighted_;  // by technique; empty where t > 1
    int x_ = 0, y_ = 0;
    float scale_ = 1;
  };

  // Adds the splats of recorders, in their order, and empties them.
  void AddSplats(const PixelFilter& filter, std::vector<Recorder>& recorders, int threads);

  struct Picture {
    std::string name;  // "s2-t3", "longer"
    Image weighted, unweighted;
  };
  // `film`: that of the render.
  std::vector<Picture> Develop(const Film& film) const;

 private:
  struct Technique {
    int s = 0, t = 0;
    std::vector<double> weighted, unweighted;  // Σ filter weight · value, three for each pixel of the crop
    std::optional<Film> weightedSplats, unweightedSplats;  // t = 1, and longer paths
  };
  Technique MakeTechnique(int s, int t) const;
  size_t IndexOf(int s, int t) const;

  int width_, height_;
  PixelRect crop_;
  int mostEvents_;
  std::vector<Technique> techniques_;  // the last is that of longer paths
};

}  // namespace lampyr
