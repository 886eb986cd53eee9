// The command: reads the scene, serves the page until it is interrupted.
#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <thread>

#include "app/command_line.h"
#include "app/command_support.h"
#include "app/commands.h"
#include "app/desk/desk.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "lights/services/lighting_services.h"
#include "render/build/plugins.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

EditableScene ReadEditableScene(const DeskOptions& options, Diagnostics& diagnostics) {
  try {
    SceneDescription description = ReadScene(options.scene, diagnostics);
    GroupLights(description);
    TypeRegistry types = LoadTypes(options.plugins, &description);
    RenderOverrides overrides = options.overrides;
    overrides.threads = options.threads;
    return {std::move(description), overrides, options.robust, std::move(types), diagnostics};
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(error.Where(), error.Text());
  }
}

// Checks the memory for the films of the render, of the one before and of the next one, and for the picture: developed,
// mixed, and the one before it.
void CheckDeskMemory(const BuiltScene& scene) {
  const RenderSettings& settings = scene.settings;
  const size_t layers = scene.scene.outputs->Layers().size();
  const uint64_t pixels = static_cast<uint64_t>(settings.crop.Width()) * static_cast<uint64_t>(settings.crop.Height());
  const uint64_t planes = (3 * layers + 6) * sizeof(float);
  const uint64_t needed =
      pixels * (3 * Film::BytesPerPixel(layers, true, false, false, GathersPhotons(settings)) + 3 * planes);
  const uint64_t available = AvailableMemory();
  if (needed <= available) return;
  throw UsageError("a picture of " + std::to_string(settings.crop.Width()) + "×" +
                   std::to_string(settings.crop.Height()) + " pixels with " + std::to_string(layers) +
                   " layers takes " + FormatBytes(static_cast<double>(needed)) +
                   " of memory on the desk, and there are " + FormatBytes(static_cast<double>(available)) +
                   ": give a smaller --resolution");
}

// Keeps freed memory in the process: new films and pictures have the sizes of the old ones, and having the system clear
// a gigabyte again would take longer than a restart may.
void KeepMemory() {
  (void)mallopt(M_MMAP_MAX, 0);
  (void)mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

// Serves until a signal arrives.
void ServeUntilInterrupted(HttpServer& server, Desk& desk, const std::atomic<bool>& interrupted) {
  std::atomic<bool> hasEnded{false};
  std::thread watch([&] {
    constexpr auto kLook = std::chrono::milliseconds(50);
    // Repeated, because stopping a server that has not begun to serve has no effect.
    for (; !hasEnded.load(); std::this_thread::sleep_for(kLook)) {
      if (!interrupted.load()) continue;
      desk.End();
      server.Stop();
    }
  });
  server.Serve();
  hasEnded = true;
  watch.join();
}

}  // namespace

int RunDesk(const DeskOptions& options) {
  OutliveSurroundings();
  KeepMemory();
  Diagnostics diagnostics(options.strict ? Diagnostics::Mode::Strict : Diagnostics::Mode::Print);
  EditableScene scene = ReadEditableScene(options, diagnostics);
  CheckDeskMemory(*scene.Built());
  constexpr int kOpenEnd = 1 << 20;
  const int threads = options.threads > 0 ? options.threads : HardwareThreads();
  auto desk = std::make_unique<Desk>(scene, options.overrides.samplesPerPixel.value_or(kOpenEnd), threads);
  HttpServer server(options.port, [&desk](const HttpRequest& request) { return desk->Answer(request); });
  const std::atomic<bool>& interrupted = FinishOnInterrupt();
  std::printf("%s\n", server.Address().c_str());
  std::fflush(stdout);
  if (!options.quiet) std::fprintf(stderr, "the desk is at this address, for this machine alone; Ctrl-C ends it\n");
  ServeUntilInterrupted(server, *desk, interrupted);
  desk.reset();
  return FinishRendering([] { return kExitDone; });
}

}  // namespace lampyr
