#pragma once
// Where frames go.

#include <memory>
#include <string>

#include "demos/stillframe/interruption.h"
#include "demos/stillframe/name_pattern.h"
#include "demos/stillframe/outcome.h"
#include "demos/stillframe/picture.h"

namespace still::command {

/// Takes frames in order. One that is destroyed before finish() leaves no half-written file.
class Sink {
  public:
    virtual ~Sink() = default;
    virtual Outcome<void> add(int frame, const Picture& picture) = 0;
    virtual Outcome<void> finish() = 0;
};

/// Standard output gets a PNG, or Y4M when there are several frames.
enum class SinkKind { none, standard_output, png, apng, gif, mp4, y4m };

/// By the name's extension; "-" is standard output, an empty name none.
Outcome<SinkKind> sinkKind(const std::string& output);

struct SinkSettings {
    SinkKind kind = SinkKind::none;
    NamePattern name;  ///< unused by none and standard_output
    int first_frame = 0;
    int frames = 1;
    int width = 0, height = 0;
    int fps = 30;
};

/// Whether it can take pictures with alpha.
bool keepsAlpha(SinkKind kind);

/// Opens what can be opened before the first frame, so that errors come early.
Outcome<std::unique_ptr<Sink>> openSink(const SinkSettings& settings, Interruption& interruption);

}  // namespace still::command
