#pragma once
// Reference pictures: ssaa:N frames, made once and kept on disk.

#include <memory>

#include "demos/stillframe/file_cache.h"
#include "engine/frame_loop.h"

namespace still::command {

struct Reference {
    Image<Rgb8> picture;
    /// Equal keys, equal pictures: frames of a scene that stands still share one.
    uint64_t key = 0;
};

/// Makes references of one scene at one size. Not for several threads at a time.
///
/// A picture's key is the hash of a cheap render of the same frame (ssaa:4 before rounding to 8
/// bits, with depth, normals and surfaces of its last sample) and of the number of samples. What a
/// key says therefore follows from pixels alone: any change of scene, camera, light, settings or
/// rasterizer that reaches the picture changes it, and nothing else does.
class ReferenceMaker {
  public:
    /// Size, camera and tone map are taken from `view`. Scene, cache and workers must outlive it.
    ReferenceMaker(const Scene& scene, const FrameSettings& view, int samples,
                   const FileCache& cache, Workers& workers);

    /// Of the frames made from now on.
    void resize(int width, int height);
    /// Which picture make() would hand out.
    uint64_t keyOf(int frame);
    Outcome<Reference> make(int frame);

  private:

    const FileCache& cache_;
    FrameSettings settings_;
    FrameLoop probe_, loop_;
};

}  // namespace still::command
