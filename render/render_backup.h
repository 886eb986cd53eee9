// The state of a render after its last whole pass, for the case that the next pass is cut short.
#pragma once

#include <memory>
#include <optional>

#include "film/film.h"
#include "integrators/photon/emission_learning.h"
#include "integrators/photon/photon_store.h"
#include "lights/selection/light_learning.h"
#include "render/technique_images.h"

namespace lampyr {

// What of a render its passes change. Null: the render has none of it.
struct PassState {
  Film& film;
  TechniqueImages* techniques = nullptr;
  std::unique_ptr<LightLearning>* learning = nullptr;
  std::unique_ptr<EmissionLearning>* guiding = nullptr;
};

// Its memory, as much as the film takes, is kept from pass to pass.
class RenderBackup {
 public:
  explicit RenderBackup(const BoundingSphere& scene) : scene_(scene) {}

  // `withFilm`: false before the first pass, when the film is empty.
  void Take(const PassState& state, bool withFilm, int threads);
  // The film as it was taken; where it was not, it stays as the pass has left it. What was learned is put into objects
  // of its own; `keepsOld`: the old ones are not destroyed, because a pass that was given up uses them.
  void Restore(const PassState& state, int threads, bool keepsOld);

 private:
  BoundingSphere scene_;
  std::optional<Film> film_;
  bool hasFilm_ = false;
  std::optional<TechniqueImages> techniques_;
  std::unique_ptr<LightLearning> learning_;
  std::unique_ptr<EmissionLearning> guiding_;
};

}  // namespace lampyr
