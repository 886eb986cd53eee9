// A plugin for another lampyr, as it comes from years ago: with a stamp of its own, with a class and a function that
// are no more, and with something that it does at once when it is loaded. None of that may happen.
#include <cstdint>
#include <cstdlib>

namespace lampyr {
struct LightOfYore {
  virtual ~LightOfYore();
  virtual void Shine();
};
LightOfYore* MakeLightOfYore(const char* name);
}  // namespace lampyr

__attribute__((section(".note.lampyr"), used, aligned(4))) static const struct {
  uint32_t ownerSize = 7, textSize = 44, type = 1;
  char owner[8] = "lampyr";
  char text[44] = "lampyr 0.0.1, plugin interface 0, layout 7";
} note;

namespace {

// Its table of virtual functions cannot be had: even a loader that resolves functions late fails on it.
struct Lamp : lampyr::LightOfYore {};

struct AtOnce {
  AtOnce() { std::abort(); }
} atOnce;

}  // namespace

extern "C" __attribute__((visibility("default"))) void* lampyr_plugin() {
  static Lamp lamp;
  return lampyr::MakeLightOfYore("rect") ? &lamp : nullptr;
}
