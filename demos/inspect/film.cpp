#include "demos/inspect/film.h"

namespace still::inspect {

bool Film::stands(int frame) const {
    return frame == 0 || recording.frames[size_t(frame)].cut || sameView(frame, frame - 1);
}

bool Film::sameView(int frame, int other) const {
    const CameraFileFrame& a = recording.frames[size_t(frame)];
    const CameraFileFrame& b = recording.frames[size_t(other)];
    return a.view == b.view && a.projection == b.projection && a.scene_frame == b.scene_frame;
}

}  // namespace still::inspect
