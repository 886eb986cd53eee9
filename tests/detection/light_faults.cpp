// The table of wrong lights. Each is a sound light with one fault, of the kinds that renderers have had.
#include <cmath>
#include <limits>
#include <mutex>

#include "detection/faults.h"
#include "detection/subjects.h"
#include "lights/light_base.h"
#include "lights/mixed_light.h"
#include "lights/wrong_light.h"

namespace lampyr::test {

namespace {

Planting Wrong(Fault fault) {
  return [fault](std::shared_ptr<const Light> light) { return std::make_unique<WrongLight>(std::move(light), fault); };
}
Planting Hooked(const LightHooks& hooks) {
  return
      [hooks](std::shared_ptr<const Light> light) { return std::make_unique<PlantedLight>(std::move(light), hooks); };
}

// An edge between a receiver and a point of the light.
struct Edge {
  Vector3 toLight;
  float cosine, distance;  // at the light
};

// Values that samples and evaluations both report.
using OnEdge = std::function<void(const LightCall&, const Edge&, Color& diffuse, Color& specular, PdfSolidAngle& pdf)>;
LightHooks OfEdges(const OnEdge& change) {
  LightHooks hooks;
  hooks.sample = [change](const LightCall& call, std::optional<LightSample>& s) {
    if (!s) return;
    const Edge edge{s->direction, AbsDot(s->normal, s->direction), s->distance};
    change(call, edge, s->diffuse, s->specular, s->pdfDirect);
  };
  hooks.evaluation = [change](const LightCall& call, const LightHit& hit, std::optional<LightEvaluation>& e) {
    if (!e) return;
    const Edge edge{hit.direction, AbsDot(hit.normal, hit.direction), hit.distance};
    change(call, edge, e->diffuse, e->specular, e->pdfDirect);
  };
  return hooks;
}
Planting PdfTimes(const std::function<float(const LightCall&, const Edge&)>& factor) {
  return Hooked(OfEdges([factor](const LightCall& call, const Edge& edge, Color&, Color&, PdfSolidAngle& pdf) {
    pdf = pdf * factor(call, edge);
  }));
}
Planting RadianceTimes(const std::function<float(const LightCall&, const Edge&)>& factor) {
  return Hooked(OfEdges([factor](const LightCall& call, const Edge& edge, Color& d, Color& s, PdfSolidAngle&) {
    d *= factor(call, edge);
    s *= factor(call, edge);
  }));
}

// pdfEmitDirection, everywhere that it is reported.
Planting EmitDirectionTimes(const std::function<float(const Vector3& outward)>& factor) {
  LightHooks hooks;
  hooks.sample = [factor](const LightCall&, std::optional<LightSample>& s) {
    if (s) s->pdfEmitDirection = s->pdfEmitDirection * factor(-s->direction);
  };
  hooks.evaluation = [factor](const LightCall&, const LightHit& hit, std::optional<LightEvaluation>& e) {
    if (e) e->pdfEmitDirection = e->pdfEmitDirection * factor(-hit.direction);
  };
  hooks.photon = [factor](const LightCall&, std::optional<EmissionSample>& p) {
    if (p) p->pdfEmitDirection = p->pdfEmitDirection * factor(p->direction);
  };
  return Hooked(hooks);
}

using OnSample = std::function<void(const LightCall&, LightSample&)>;
LightHooks OfSamples(const OnSample& change) {
  LightHooks hooks;
  hooks.sample = [change](const LightCall& call, std::optional<LightSample>& s) {
    if (s) change(call, *s);
  };
  return hooks;
}
using OnPhoton = std::function<void(const LightCall&, EmissionSample&)>;
LightHooks OfPhotons(const OnPhoton& change) {
  LightHooks hooks;
  hooks.photon = [change](const LightCall& call, std::optional<EmissionSample>& p) {
    if (p) change(call, *p);
  };
  return hooks;
}

Planting PositionError(float error) {
  LightHooks hooks = OfSamples([error](const LightCall&, LightSample& s) { s.positionError = Vector3(error); });
  hooks.photon = [error](const LightCall&, std::optional<EmissionSample>& p) {
    if (p) p->positionError = Vector3(error);
  };
  return Hooked(hooks);
}
Planting Energy(float energy) {
  LightHooks hooks;
  hooks.bounds = [energy](const LightCall&, std::optional<EmissionBounds>& b) {
    if (b) b->energy = energy;
  };
  return Hooked(hooks);
}

// Size of the light: half the diagonal of its box.
float SizeOf(const LightCall& call) {
  const auto bounds = call.sound.GetEmissionBounds(call.context);
  return bounds ? 0.5f * glm::length(bounds->box.Diagonal()) : 1.0f;
}

template <class Record>
void Swap(Record& record) {
  std::swap(record.diffuse, record.specular);
}

// Remembers from call to call.
struct Memory {
  std::mutex lock;
  uint64_t calls = 0;
  Point2 u{0.5f};
};

std::vector<LightFault> MakeLightFaults() {
  std::vector<LightFault> faults;
  const auto add = [&](const std::string& name, const std::string& subject, Planting planting,
                       const std::string& what) {
    faults.push_back({name, subject, what, std::move(planting), {}, ""});
  };
  const auto isPlain = [](const LightCall& call) { return !call.context.bidirectional; };

  // Faults in values that only some integrators use.
  add("half-unless-bidirectional", "rect",
      RadianceTimes([=](const LightCall& c, const Edge&) { return isPlain(c) ? 0.5f : 1.0f; }),
      "half the radiance where densities of emission are not asked for");
  add("pdf-unless-bidirectional", "disk",
      PdfTimes([=](const LightCall& c, const Edge&) { return isPlain(c) ? 1.1f : 1.0f; }),
      "pdfDirect 10 % too high where densities of emission are not asked for");
  add(
      "two-patches", "rect",
      [] {
        LightHooks hooks;
        hooks.patches = 2;
        return Hooked(hooks);
      }(),
      "a light that is its own surface claims two patches, each with probability 1");

  // Numbers that no density holds.
  add("shines-from-far", "disk", Hooked(OfPhotons([](const LightCall&, EmissionSample& p) { p.shinesFrom = 1e9f; })),
      "photons light nothing nearer than 1e9");
  add("position-error-0", "disk", PositionError(0), "positionError is 0");
  add("position-error-1e3", "rect", PositionError(1e3f), "positionError is 1e3");
  add("energy-0", "rect", Energy(0), "EmissionBounds::energy is 0");
  add("energy-1e-6", "spot", Energy(1e-6f), "EmissionBounds::energy is 1e-6");
  add("uvw-swapped", "rect", Hooked(OfSamples([](const LightCall&, LightSample& s) { std::swap(s.uvw.x, s.uvw.y); })),
      "u and v of samples are exchanged, on a light without a texture");
  add("uvw-photon-constant", "disk",
      Hooked(OfPhotons([](const LightCall&, EmissionSample& p) { p.uvw = Point3(0.25f, 0.25f, 0); })),
      "photons say the same uv wherever they start, on a light without a texture");

  // Time, and what happened before.
  add("radiance-of-time", "disk",
      RadianceTimes([](const LightCall& c, const Edge&) { return 1 - 0.5f * c.context.time; }),
      "radiance depends on the shutter time of a light that stays as it is");
  add("photons-of-time", "spot", Hooked(OfPhotons([](const LightCall& c, EmissionSample& p) {
        p.diffuse *= 1 + c.context.time;
        p.specular *= 1 + c.context.time;
      })),
      "photons carry more at the end of the shutter");
  add(
      "every-other-call", "rect",
      [] {
        const auto memory = std::make_shared<Memory>();
        return Hooked(OfSamples([memory](const LightCall&, LightSample& s) {
          const std::scoped_lock lock(memory->lock);
          const float factor = ++memory->calls % 2 == 0 ? 1.2f : 0.8f;
          s.diffuse *= factor;
          s.specular *= factor;
        }));
      }(),
      "every other sample is brighter, the mean being right");
  add(
      "u-of-last-call", "sun",
      [] {
        const auto memory = std::make_shared<Memory>();
        LightHooks hooks;
        hooks.sample = [memory](const LightCall& call, std::optional<LightSample>& s) {
          LightContext last = call.context;
          {
            const std::scoped_lock lock(memory->lock);
            std::swap(last.u, memory->u);
          }
          s = call.sound.GenerateSamples(last, call.P);
        };
        return Hooked(hooks);
      }(),
      "a sample is made by the random numbers of the call before");
  add(
      "first-calls-dark", "point",
      [] {
        const auto memory = std::make_shared<Memory>();
        return Hooked(OfPhotons([memory](const LightCall&, EmissionSample& p) {
          const std::scoped_lock lock(memory->lock);
          if (++memory->calls % 64 != 0) return;
          p.diffuse *= 0.5f;
          p.specular *= 0.5f;
        }));
      }(),
      "one photon in 64 carries half, whatever its random numbers are");

  // pdfDirect where few samples go.
  add("pdf-grazing-3%", "rect",
      PdfTimes([](const LightCall&, const Edge& e) { return e.cosine < 0.2f ? 1.03f : 1.0f; }),
      "pdfDirect 3 % too high where the light's cosine is below 0.2");
  add("pdf-edge-on-x2", "disk",
      PdfTimes([](const LightCall&, const Edge& e) { return e.cosine < 0.01f ? 2.0f : 1.0f; }),
      "pdfDirect twice too high where the light's cosine is below 0.01");
  add("pdf-far-5%", "rect",
      PdfTimes([](const LightCall& c, const Edge& e) { return e.distance > 150 * SizeOf(c) ? 1.05f : 1.0f; }),
      "pdfDirect 5 % too high beyond 150 sizes of the light");
  add("pdf-near-20%", "disk",
      PdfTimes([](const LightCall& c, const Edge& e) { return e.distance < 0.05f * SizeOf(c) ? 1.2f : 1.0f; }),
      "pdfDirect 20 % too high nearer than 0.05 sizes of the light");
  add("pdf-1%", "sun", Wrong(Fault::PdfOffByOnePercent), "pdfDirect 1 % too high");
  add("pdf-1%-area", "square", Wrong(Fault::PdfOffByOnePercent), "pdfDirect 1 % too high");
  add("pdf-cosine-forgotten", "rect", Wrong(Fault::CosineForgotten), "pdfDirect lacks the light's cosine");
  add(
      "pdf-per-area", "disk",
      [] {
        LightHooks hooks = OfSamples([](const LightCall&, LightSample& s) {
          s.pdfDirect = s.pdfDirect * (AbsDot(s.normal, s.direction) / Sqr(s.distance));
        });
        hooks.evaluation = [](const LightCall&, const LightHit& hit, std::optional<LightEvaluation>& e) {
          if (e) e->pdfDirect = e->pdfDirect * (AbsDot(hit.normal, hit.direction) / Sqr(hit.distance));
        };
        return Hooked(hooks);
      }(),
      "pdfDirect is per area");
  add("pdf-of-the-origin", "portal", Wrong(Fault::PdfOfTheOrigin), "pdfDirect is that of the light's own origin");
  add("pdf-0-is-1", "dome", Hooked(OfEdges([](const LightCall&, const Edge&, Color&, Color&, PdfSolidAngle& pdf) {
        if (pdf.IsZero()) pdf = PdfSolidAngle(1);
      })),
      "a density of 0, of black texels, is said to be 1");
  add("pdf-sine-forgotten", "dome", PdfTimes([](const LightCall&, const Edge& e) {
        return 1.5707963f * std::sqrt(std::max(1 - Sqr(e.toLight.y), 1e-6f));
      }),
      "pdfDirect of an image lacks the sine of its latitude");

  // Samples.
  add("never-sampled", "dome", Wrong(Fault::ZeroWhereItEmits), "one half of the directions is never sampled");
  add("never-sampled-area", "rect", Wrong(Fault::ZeroWhereItEmits), "one half of the surface is never sampled");
  add("other-radiance", "disk", Wrong(Fault::OtherRadiance), "evaluations are 1 % brighter than samples");
  add("leaks-behind", "rect", Wrong(Fault::LeaksBehind), "a one-sided light shines to its back where rays hit it");
  add("solid-angle-to-area", "disk", Wrong(Fault::SolidAngleToAreaWrong), "solidAngleToArea lacks the cosine");
  add("frame-not-turned", "disk", Wrong(Fault::FrameNotTurned), "samples lie as if the light were not turned");
  add("nan-at-one-place", "rect", Hooked(OfSamples([](const LightCall& c, LightSample& s) {
        if (c.context.u.x < 2e-4f) s.diffuse.r = std::numeric_limits<float>::quiet_NaN();
      })),
      "NaN in one sample of 5000");
  add("negative-at-one-place", "spot", Hooked(OfSamples([](const LightCall& c, LightSample& s) {
        if (c.P.x > c.context.transform->toRender.translation.x && c.P.y > c.context.transform->toRender.translation.y)
          s.specular.g = -s.specular.g;
      })),
      "a negative channel for receivers in one quadrant");
  add("falloff-1.98", "point", Hooked(OfSamples([](const LightCall&, LightSample& s) {
        const float factor = std::pow(s.distance, 0.02f);
        s.diffuse *= factor;
        s.specular *= factor;
      })),
      "intensity falls off with distance to the power 1.98");

  // Diffuse and specular, camera, parameters.
  add(
      "lobes-swapped", "spot",
      [] {
        LightHooks hooks = OfSamples([](const LightCall&, LightSample& s) { Swap(s); });
        hooks.evaluation = [](const LightCall&, const LightHit&, std::optional<LightEvaluation>& e) {
          if (e) Swap(*e);
        };
        hooks.photon = [](const LightCall&, std::optional<EmissionSample>& p) {
          if (p) Swap(*p);
        };
        return Hooked(hooks);
      }(),
      "diffuse and specular are exchanged");
  add("specular-forgotten-in-photons", "rect", Wrong(Fault::SpecularForgottenInPhotons),
      "photons carry the diffuse multiplier for both kinds of lobe");
  add("camera-1%", "rect", Wrong(Fault::CameraSeesMore), "the camera sees 1 % more than receivers");
  add(
      "camera-visible-ignored", "hidden disk",
      [] {
        LightHooks hooks;
        hooks.camera = [](const LightCall& call, const LightHit& hit) {
          const auto e = call.sound.EvaluateSamples(call.context, hit, hit.position - hit.direction);
          return e ? e->diffuse * 2.0f : Color(0.0f);
        };
        return Hooked(hooks);
      }(),
      "the camera sees a light that it should not see");
  faults.push_back({"exposure-ignored", "disk", "the exposure is not looked at", {}, {}, "exposure"});
  faults.push_back({"intensity-ignored", "rect", "the intensity is not looked at", {}, {}, "intensity"});

  // Photons.
  add("emit-ripple-5%", "rect",
      EmitDirectionTimes([](const Vector3& w) { return 1 + 0.05f * std::sin(40 * w.x) * std::cos(25 * w.y); }),
      "pdfEmitDirection has a ripple of 5 %");
  add("emit-tilt-1%", "disk", EmitDirectionTimes([](const Vector3& w) { return 1 + 0.01f * w.x; }),
      "pdfEmitDirection is tilted by 1 %");
  add("emit-1%", "spot", Wrong(Fault::DirectionDensityOff), "pdfEmitDirection 1 % too high");
  add("emit-not-cosine", "disk", Wrong(Fault::EmissionNotCosine), "pdfEmitDirection is said to be uniform");
  add("emit-position-5%", "dome", Wrong(Fault::EmitDensityOff), "pdfEmit 5 % too high");
  add("photon-frame-not-turned", "spot", Wrong(Fault::PhotonFrameNotTurned),
      "photons leave as if the light were not turned");
  add("disk-not-rotated", "sun", Wrong(Fault::DiskNotRotated),
      "photons from infinity start on a disk that does not face their direction");
  add("disk-about-the-light", "dome", Hooked(OfPhotons([](const LightCall& c, EmissionSample& p) {
        p.position += c.context.transform->toRender.translation - c.context.scene.center;
      })),
      "photons from infinity start around the light's own place, not the scene's centre");
  add("photons-from-one-half", "rect", Wrong(Fault::PhotonsNotWhereTheyEmit), "one half of the light sends no photons");
  add("dark-photons-are-none", "disk", Wrong(Fault::DarkPhotonsAreNone), "no photon at grazing directions");
  add("place-depends-on-direction", "rect", Wrong(Fault::PlaceDependsOnDirection),
      "a photon's place depends on its direction");
  add("half-into-itself", "rect", Hooked(OfPhotons([](const LightCall& c, EmissionSample& p) {
        p.diffuse *= 2.0f;
        p.specular *= 2.0f;
        if (c.context.uDirection.x < 0.5f) p.direction = glm::reflect(p.direction, p.normal);
      })),
      "half of the photons go into the light, and all carry twice");
  add(
      "photons-backwards", "spot",
      [](std::shared_ptr<const Light> light) {
        LightHooks hooks;
        hooks.photon = [](const LightCall&, std::optional<EmissionSample>& p) {
          if (p && p->emissionCosine > 0 && p->pdfEmitDirection.value > 0) p->direction = p->normal = -p->direction;
        };
        return std::make_unique<PlantedLight>(std::move(light), hooks);
      },
      "photons leave against the cone");

  // Patches, estimates, bounds.
  add("patch-choice-forgotten", "square", Wrong(Fault::PatchChoiceForgotten),
      "each of two patches is said to be chosen always");
  add("power-x2", "sun", Wrong(Fault::PowerOffByTwo), "GetPowerEstimate is twice too high");
  add(
      "power-of-wrong-area", "rect",
      [] {
        LightHooks hooks;
        hooks.power = [](const LightCall& c) { return c.sound.GetPowerEstimate(c.context) * 0.95f; };
        return Hooked(hooks);
      }(),
      "GetPowerEstimate is 5 % too low");
  add("box-too-small", "rect", Wrong(Fault::BoxTooSmall), "photons leave outside of the emission bounds");
  add("cone-too-narrow", "spot", Wrong(Fault::ConeTooNarrow), "photons leave outside of the bounds' cone");
  add("estimate-is-0", "disk", Wrong(Fault::EstimateIsZero), "the estimate at a point is 0");
  add("segment-is-missed", "point", Wrong(Fault::SegmentIsMissed), "the estimate along a segment finds nothing");
  add("segment-ends-early", "rect", Wrong(Fault::SegmentEndsEarly), "the lit part of a segment ends too early");
  add("segment-cut-too-short", "spot", Wrong(Fault::SegmentCutTooShort),
      "a segment through the cone is cut 3 % too short");
  add("segment-without-end-is-missed", "disk", Wrong(Fault::SegmentWithoutEndIsMissed),
      "a segment without an end is taken for none");

  // Edits.
  add("edit-keeps-everything", "rect", {}, "an edited light is the one before");
  faults.back().edited = [](std::shared_ptr<const Light>, std::shared_ptr<const Light> before) {
    return std::make_unique<ForwardingLight>(std::move(before));
  };
  add("edit-keeps-photons", "disk", {}, "photons of an edited light are those of the one before");
  faults.back().edited = [](std::shared_ptr<const Light> edited, std::shared_ptr<const Light> before) {
    return std::make_unique<MixedLight>(std::move(edited), std::move(before), Part::PhotonColor);
  };
  add("edit-keeps-table", "dome", {}, "an edited sky is sampled by the table of the one before");
  faults.back().edited = [](std::shared_ptr<const Light> edited, std::shared_ptr<const Light> before) {
    return std::make_unique<MixedLight>(std::move(edited), std::move(before), Part::DirectPdf);
  };
  add("edit-keeps-power", "spot", {}, "an edited light has the power of the one before");
  faults.back().edited = [](std::shared_ptr<const Light> edited, std::shared_ptr<const Light> before) {
    return std::make_unique<MixedLight>(std::move(edited), std::move(before), Part::Power);
  };
  return faults;
}

}  // namespace

const std::vector<LightFault>& LightFaults() {
  static const std::vector<LightFault> faults = MakeLightFaults();
  return faults;
}

}  // namespace lampyr::test
