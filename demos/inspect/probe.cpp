#include "demos/inspect/probe.h"

#include "postfx/denoise.h"

namespace still::inspect {

const GBuffer& Probe::draw(int frame, int width, int height, const ProbeSample& sample) {
    const Scene& scene = film_.scene;
    const FrameState state = frameStateAt(scene, film_.camera(), frame, width, height);
    const DrawList list{.meshes = scene.meshes,
                        .materials = materialsOf(scene, state),
                        .textures = scene.textures,
                        .alpha_textures = scene.alpha_textures,
                        .instances = state.instances,
                        .windings = film_.windings,
                        .lighting = state.lighting,
                        .background = scene.background};
    const FrameView view{.width = width,
                         .height = height,
                         .view_projection = state.camera.view_projection,
                         .view_projection_before = state.camera_before.view_projection,
                         .eye = glm::vec3(state.camera.eye),
                         .jitter_x_fx8 = sample.offset.x_fx8,
                         .jitter_y_fx8 = sample.offset.y_fx8,
                         .sample = sample.sample};
    const bool lit = sample.lit && scene.lights.sampled();
    PlaneSet planes = sample.planes;
    planes.normal |= lit;
    planes.albedo |= lit;
    const RasterSettings settings{.simd = simd_,
                                  .planes = planes,
                                  .mip_bias_fx8 = sample.mip_bias_fx8,
                                  .camera_motion_only = sample.camera_motion_only};
    rasterizer_.transformAndBin(list, view, settings, workers_);
    rasterizer_.rasterize(gbuffer_, workers_);
    if (lit) {
        addLight(list, view);
    }
    return gbuffer_;
}

/// One sample, as it is, like a frame loop that does not denoise.
void Probe::addLight(const DrawList& list, const FrameView& view) {
    if (!sampler_) {
        sampler_ = std::make_unique<LightSampler>();
    }
    sampler_->setUp(list, view, simd_, workers_);
    sampler_->sample(gbuffer_, light_, false, workers_);
    const LightImages& l = light_;
    remodulate(gbuffer_,
               {{l.direct_red.view(), l.direct_green.view(), l.direct_blue.view()},
                {l.indirect_red.view(), l.indirect_green.view(), l.indirect_blue.view()}},
               workers_);
}

ImageView<const uint16_t> Probe::overdraw() {
    overdraw_.resize(gbuffer_.width(), gbuffer_.height());
    rasterizer_.overdraw(overdraw_.view(), workers_);
    return overdraw_.view();
}

}  // namespace still::inspect
