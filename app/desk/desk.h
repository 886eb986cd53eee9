// The lighting desk: a scene, its render, and the requests of the page.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "app/desk/desk_lights.h"
#include "app/desk/desk_session.h"
#include "app/desk/http_server.h"

namespace lampyr {

class Desk {
 public:
  // `scene` has to outlive this.
  Desk(EditableScene& scene, int mostSamples, int threads);

  // Answers a request of the page; may be called by several threads. `path`: below the token, such as "state".
  //
  //   GET  state, lights            JSON: how far the picture is; faders, and parameters of lights and filters
  //   POST picture {factors, exposure, clip, after}   width · height · 4 bytes; waits for one after `after`, if given
  //   POST pixel {factors, x, y}    JSON: its value, and half its 95 % interval where that is known
  //   POST guide {x, y}             JSON: what path guiding has learned there (render/analysis/guide_view.h)
  //   POST edit {statement, parameter, numbers | text}, reset {statement, parameter}, set {factors}
  //   POST pause {on}, keep {factors}
  //
  // A wrong request is answered with status 422 and {"message"}.
  HttpReply Answer(const HttpRequest& request);
  // Ends the render; requests that wait for it are answered.
  void End() { session_.End(); }

 private:
  class Requests;
  // Faders that were set into the lights of the render `restart`. In pictures of earlier renders they are mixed.
  struct SetFactors {
    uint64_t restart = 0;
    std::vector<Color> factors;
  };

  EditableScene& scene_;
  const std::vector<std::string> files_;  // of the scene, as it was read
  const std::string hashOfFiles_;
  const std::vector<Fader> faders_;
  std::mutex editing_;  // of scene_
  std::mutex setting_;  // of set_
  std::vector<SetFactors> set_;
  ScreenMixer mixer_;
  DeskSession session_;
};

}  // namespace lampyr
