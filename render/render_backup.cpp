#include "render/render_backup.h"

namespace lampyr {

void RenderBackup::Take(const PassState& state, bool withFilm, int threads) {
  hasFilm_ = withFilm;
  if (withFilm) {
    if (!film_) film_.emplace(state.film.EmptyCopy());
    film_->CopyFrom(state.film, threads);
  }
  // State that no longer records does not change, so it is not copied again.
  LightLearning* learning = state.learning ? state.learning->get() : nullptr;
  if (learning && (learning->IsRecording() || (learning_ && learning_->IsRecording()))) {
    if (!learning_) learning_ = std::make_unique<LightLearning>(scene_);
    learning->CopyChangesTo(*learning_);
    selection_ = std::make_unique<SelectionTest>(**state.selection);
  }
  const EmissionLearning* guiding = state.guiding ? state.guiding->get() : nullptr;
  if (guiding && (guiding->IsRecording() || (guiding_ && guiding_->IsRecording())))
    guiding_ = std::make_unique<EmissionLearning>(*guiding);
  const PathLearning* paths = state.paths ? state.paths->get() : nullptr;
  if (paths && (paths->IsRecording() || (paths_ && paths_->IsRecording())))
    paths_ = std::make_unique<PathLearning>(*paths);
}

void RenderBackup::Restore(const PassState& state, int threads, bool keepsOld) {
  if (hasFilm_) state.film.CopyFrom(*film_, threads);
  if (learning_) {
    if (keepsOld) {
      (void)state.learning->release();
      (void)state.selection->release();
    }
    *state.learning = std::make_unique<LightLearning>(scene_);
    (*state.learning)->CopyFrom(*learning_);
    *state.selection = std::make_unique<SelectionTest>(*selection_);
  }
  if (guiding_) {
    if (keepsOld) (void)state.guiding->release();
    *state.guiding = std::make_unique<EmissionLearning>(*guiding_);
  }
  if (paths_) {
    if (keepsOld) (void)state.paths->release();
    *state.paths = std::make_unique<PathLearning>(*paths_);
  }
}

}  // namespace lampyr
