// Records what each technique contributes to a sample, for the layers of strategies.
#pragma once

#include "film/layer_sample.h"
#include "film/splats.h"
#include "integrators/bidirectional/connected_path.h"
#include "render/settings/output_layers.h"

namespace lampyr {

// The recorder of one thread: of its samples, one after the other.
class StrategyRecorder final : public PathObserver {
 public:
  // `firstLayer`: of the film, the first one of `strategies`. `layers`: of the sample, cleared before each. `splats`:
  // receives what light paths contribute.
  StrategyRecorder(const StrategyLayers& strategies, uint32_t firstLayer, LayerSample& layers, SplatList& splats)
      : strategies_(strategies), firstLayer_(firstLayer), layers_(layers), splats_(splats) {}

  void Observe(const ConnectedPath& path) override { Add(path, strategies_.Of(path.s, path.t)); }
  void ObserveMerge(const ConnectedPath& path, const Photon&) override { Add(path, strategies_.OfMerging()); }
  void ObserveBeamMerge(const ConnectedPath& path, const BeamVertex&, uint32_t) override {
    Add(path, strategies_.OfMerging());
  }

 private:
  // `index`: of the weighted layer among those of strategies.
  void Add(const ConnectedPath& path, uint32_t index) {
    const Color weighted = path.WeightedValue();
    if (!weighted.IsValid()) return;  // left out of the picture, too
    AddTo(firstLayer_ + index, weighted, path.connection);
    // Beyond the range of float where a density nearly vanishes that the weight leaves nothing of.
    if (path.value.IsValid()) AddTo(firstLayer_ + index + 1, path.value, path.connection);
  }
  void AddTo(uint32_t layer, const Color& value, const FilmConnection* connection) {
    if (!connection) return layers_.Add(layer, value);
    splats_.AddToLayer(connection->camera.film, value, Color(1.0f), layer);
    for (int i = 0; i < connection->copies.count; ++i)
      splats_.AddToLayer(connection->copies.points[static_cast<size_t>(i)], value, Color(1.0f), layer);
  }

  const StrategyLayers strategies_;
  uint32_t firstLayer_;
  LayerSample& layers_;
  SplatList& splats_;
};

}  // namespace lampyr
