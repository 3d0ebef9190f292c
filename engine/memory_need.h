#pragma once
// Amounts of memory: what is needed, what is allowed, and how a person reads them.

#include <cstdint>
#include <string>

#include "engine/frame_loop.h"
#include "engine/result.h"
#include "engine/scene.h"

namespace still {

/// "512 bytes", "1.5 MB", "14.2 GB", by powers of 1024; rounded up.
std::string bytesText(uint64_t bytes);

/// What a scene takes: meshes and textures.
uint64_t sceneMemoryBytes(const Scene& scene);

/// What a FrameLoop takes for pixels, known before it exists. There is more, which depends on the
/// frame: the triangles in each tile, and trees of light that is sampled.
uint64_t frameMemoryBytes(const FrameSettings& settings, bool light_is_sampled);

/// sceneMemoryBytes() and `loops` times frameMemoryBytes() against what is allowed; the Error names
/// the size, too.
Result<void> checkFrameMemory(const std::string& name, const Scene& scene,
                              const FrameSettings& settings, uint64_t allowed_bytes, int loops = 1);

/// An Error "NAME: needs about 14.2 GB of memory, 4.0 GB are allowed (--max-memory)" when it does.
Result<void> checkMemory(const std::string& name, uint64_t needed_bytes, uint64_t allowed_bytes);

}  // namespace still
