// "mix": materials (two names), amount (0.5; of the second). At each point one of the two is chosen by a hash of
// position and direction, so that the image does not depend on the order of work. "interface": no scattering.
#include <array>
#include <bit>
#include <cstdint>

#include "materials/material_makers.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

uint64_t HashVector(uint64_t seed, const Vector3& v) {
  return Hash(seed, std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y), std::bit_cast<uint32_t>(v.z));
}

class MixMaterial final : public Material {
 public:
  MixMaterial(std::array<std::shared_ptr<const Material>, 2> materials, FloatParameter amount, uint64_t salt)
      : materials_(std::move(materials)),
        amount_(std::move(amount)),
        salt_(salt),
        isInterface_(materials_[0]->IsInterface() && materials_[1]->IsInterface()),
        mayTransmit_(materials_[0]->MayTransmit() || materials_[1]->MayTransmit()),
        hasDelta_(materials_[0]->HasDelta() || materials_[1]->HasDelta()),
        isAlwaysDelta_(materials_[0]->IsAlwaysDelta() && materials_[1]->IsAlwaysDelta()),
        disperses_(materials_[0]->Disperses() || materials_[1]->Disperses()),
        hasMappedNormal_(materials_[0]->HasMappedNormal() || materials_[1]->HasMappedNormal()),
        isFibrous_(materials_[0]->IsFibrous() || materials_[1]->IsFibrous()),
        mayGatherPhotons_(materials_[0]->MayGatherPhotons() || materials_[1]->MayGatherPhotons()),
        needsParametrization_(!amount_.IsConstant() || materials_[0]->NeedsParametrization() ||
                              materials_[1]->NeedsParametrization()) {}

  Bsdf GetBsdf(const SurfacePoint& point, const Vector3& wo) const override {
    return Choose(point, wo).GetBsdf(point, wo);
  }
  std::shared_ptr<const Material> Roughened(const Roughener& roughened) const override {
    std::array<std::shared_ptr<const Material>, 2> rougher{roughened(materials_[0]), roughened(materials_[1])};
    if (rougher == materials_) return nullptr;
    return std::make_shared<MixMaterial>(std::move(rougher), amount_, salt_);
  }
  std::shared_ptr<const Material> AtWavelengths(const std::shared_ptr<const Wavelengths>&,
                                                const Tuner& tuned) const override {
    return std::make_shared<MixMaterial>(
        std::array<std::shared_ptr<const Material>, 2>{tuned(materials_[0]), tuned(materials_[1])}, amount_, salt_);
  }
  bool Disperses() const override { return disperses_; }
  bool IsInterface() const override { return isInterface_; }
  bool MayTransmit() const override { return mayTransmit_; }
  bool HasDelta() const override { return hasDelta_; }
  bool IsAlwaysDelta() const override { return isAlwaysDelta_; }
  bool HasMappedNormal() const override { return hasMappedNormal_; }
  bool IsFibrous() const override { return isFibrous_; }
  bool MayGatherPhotons() const override { return mayGatherPhotons_; }
  bool NeedsParametrization() const override { return needsParametrization_; }

 private:
  const Material& Choose(const SurfacePoint& point, const Vector3& wo) const {
    const float amount = amount_.Evaluate({point.uv, point.position, point.Ng});
    if (!(amount > 0)) return *materials_[0];
    if (amount >= 1) return *materials_[1];
    const uint64_t hash = HashVector(HashVector(salt_, point.position), wo);
    return UnitFloat(static_cast<uint32_t>(hash >> 32)) < amount ? *materials_[1] : *materials_[0];
  }

  std::array<std::shared_ptr<const Material>, 2> materials_;
  FloatParameter amount_;
  uint64_t salt_;  // from the names: nested mixes choose independently
  // Properties of both materials, cached: nested mixes that name a material twice would otherwise query it 2^depth
  // times.
  bool isInterface_, mayTransmit_, hasDelta_, isAlwaysDelta_, disperses_, hasMappedNormal_, isFibrous_,
      mayGatherPhotons_, needsParametrization_;
};

class InterfaceMaterial final : public Material {
 public:
  // For code that does not check IsInterface: transmission without deflection.
  Bsdf GetBsdf(const SurfacePoint& point, const Vector3&) const override {
    return Bsdf(Frame::FromNormal(point.Ns), point.Ng, DielectricBsdf{});
  }
  bool IsInterface() const override { return true; }
  bool MayTransmit() const override { return true; }
  bool HasDelta() const override { return true; }
  bool IsAlwaysDelta() const override { return true; }
};

}  // namespace

std::shared_ptr<const Material> MakeMix(const MaterialInput& input) {
  const std::vector<std::string> names = input.parameters.GetStrings("materials");
  if (names.size() != 2) {
    throw Error(input.parameters.WhereOf("materials"), "a \"mix\" needs the names of two materials in \"materials\"");
  }
  const FloatParameter amount = input.textures.GetFloat(input.parameters, "amount", 0.5f);
  CheckMaterialParameters(input, {"materials", "amount"});
  uint64_t salt = 0;
  for (const std::string& name : names) {
    for (const char c : name + "\n") salt = Hash(salt, static_cast<unsigned char>(c));
  }
  return std::make_shared<MixMaterial>(
      std::array<std::shared_ptr<const Material>, 2>{input.namedMaterials(names[0]), input.namedMaterials(names[1])},
      amount, salt);
}

std::shared_ptr<const Material> MakeInterface(const MaterialInput& input) {
  CheckMaterialParameters(input, {});
  return std::make_shared<InterfaceMaterial>();
}

}  // namespace lampyr
