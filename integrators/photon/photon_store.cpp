#include "integrators/photon/photon_store.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lampyr {

uint64_t PhotonStore::BytesPerPhoton(bool withUse) {
  constexpr uint64_t pointer = sizeof(void*), position = 3 * sizeof(float), tree = 2 * position + pointer + 16;
  constexpr uint64_t grid = 12;  // up to a slot per photon
  const uint64_t use = withUse ? PhotonUse::kMostBytesPerPhoton + sizeof(PathOrigin) + sizeof(uint32_t) : 0;
  return sizeof(TracedPhoton) + sizeof(Photon) + 2 * sizeof(SortItem) + pointer + tree + grid + use;
}

PhotonStore::PhotonStore(const PhotonSettings& settings, uint64_t pixels, EmissionLearning* learning)
    : settings_(settings),
      learning_(learning),
      lightPaths_(settings.lightPaths > 0 ? settings.lightPaths : pixels),
      perPhoton_(BytesPerPhoton(learning != nullptr)),
      // Photons and densities are counted in 32 bits.
      most_(std::min(settings.mostBytes > 0 ? settings.mostBytes : std::numeric_limits<uint64_t>::max(),
                     sizeof(SubpathDensities) * std::numeric_limits<uint32_t>::max())) {}

void PhotonStore::Take(std::vector<PhotonList>& lists) {
  for (PhotonList& list : lists) {
    if (hasRoom_ && bytes_ + list.Bytes(perPhoton_) <= most_) {
      paths_ += list.Paths();
      Keep(list);
      continue;
    }
    if (hasRoom_) {
      paths_ += list.KeepPaths(most_ - bytes_, perPhoton_, paths_ == 0 ? 1 : 0);
      Keep(list);
      hasRoom_ = false;
    }
    list.Clear();
  }
}

void PhotonStore::Keep(PhotonList& list) {
  bytes_ += list.Bytes(perPhoton_);
  PhotonList empty;
  if (!spare_.empty()) {
    empty = std::move(spare_.back());
    spare_.pop_back();
  }
  waiting_.push_back(std::exchange(list, std::move(empty)));
}

void PhotonStore::EndGathering() {
  if (!open_.use) return;
  learning_->Learn(*open_.use);
  open_.use.reset();
}

void PhotonStore::Finish(uint32_t next) {
  EndGathering();
  isTaken_ = true;
  pass_ = next;
}

const PhotonPass& PhotonStore::Open(uint32_t pass, int threads, double scale) {
  if (open_.map && open_.pass == pass) return open_;
  open_ = PhotonPass();
  open_.pass = pass;
  open_.lightPaths = static_cast<double>(std::max<uint64_t>(paths_, 1));
  if (!(scale > 0)) scale = RadiusScale(pass, settings_.alpha, settings_.startsWide);
  open_.radiusScale = static_cast<float>(scale);
  open_.radius = static_cast<float>(settings_.radius * scale);
  std::vector<uint32_t> origins;
  const bool wantsUse = WantsOrigins();
  open_.volume = settings_.volume.Scaled(scale);
  open_.map = std::make_shared<PhotonMap>(waiting_, threads, wantsUse ? &origins : nullptr, open_.volume);
  if (wantsUse) open_.use = MakeUse(std::move(origins));
  Clear();
  const PhotonMap& map = *open_.map;
  ++statistics_.passes;
  statistics_.photons += map.Size();
  statistics_.mostPhotons = std::max<uint64_t>(statistics_.mostPhotons, map.Size());
  statistics_.mostBytes = std::max<uint64_t>(statistics_.mostBytes, map.Bytes());
  statistics_.rejected += map.Rejected();
  statistics_.buildSeconds += map.BuildSeconds();
  if (statistics_.passes == 1) statistics_.firstRadius = static_cast<double>(open_.radius);
  statistics_.lastRadius = static_cast<double>(open_.radius);
  return open_;
}

// Null if the photons were traced before origins were recorded.
std::shared_ptr<PhotonUse> PhotonStore::MakeUse(std::vector<uint32_t> origins) const {
  std::vector<PathOrigin> all;
  size_t count = 0;
  for (const PhotonList& list : waiting_) count += list.Origins().size();
  all.reserve(count);
  for (const PhotonList& list : waiting_) all.insert(all.end(), list.Origins().begin(), list.Origins().end());
  return all.empty() ? nullptr : std::make_shared<PhotonUse>(std::move(origins), std::move(all));
}

void PhotonStore::Clear() {
  for (PhotonList& list : waiting_) {
    list.Clear();
    spare_.push_back(std::move(list));
  }
  waiting_.clear();
  bytes_ = paths_ = 0;
  hasRoom_ = true;
  isTaken_ = false;
}

}  // namespace lampyr
