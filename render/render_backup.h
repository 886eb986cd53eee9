// The state of a render after its last whole pass, to be restored if the next pass is cut short.
#pragma once

#include <memory>
#include <optional>

#include "film/film.h"
#include "integrators/guide/path_learning.h"
#include "integrators/guide/selection_test.h"
#include "integrators/photon/emission_learning.h"
#include "integrators/photon/photon_store.h"
#include "lights/selection/light_learning.h"

namespace lampyr {

// The parts of a render that a pass changes. Null: the render does not have that part.
struct PassState {
  Film& film;
  std::unique_ptr<LightLearning>* learning = nullptr;
  std::unique_ptr<SelectionTest>* selection = nullptr;
  std::unique_ptr<EmissionLearning>* guiding = nullptr;
  std::unique_ptr<PathLearning>* paths = nullptr;
};

// Takes as much memory as the film, and keeps it from pass to pass.
class RenderBackup {
 public:
  explicit RenderBackup(const BoundingSphere& scene) : scene_(scene) {}

  // `withFilm`: false before the first pass, when the film is empty.
  void Take(const PassState& state, bool withFilm, int threads);
  // Restores what was taken. A film that was not taken stays as the pass has left it. What was learned is restored into
  // new objects; with `keepsOld` the old ones are not destroyed, because a given-up pass still uses them.
  void Restore(const PassState& state, int threads, bool keepsOld);

 private:
  BoundingSphere scene_;
  std::optional<Film> film_;
  bool hasFilm_ = false;
  std::unique_ptr<LightLearning> learning_;
  std::unique_ptr<SelectionTest> selection_;
  std::unique_ptr<EmissionLearning> guiding_;
  std::unique_ptr<PathLearning> paths_;
};

}  // namespace lampyr
