#include <engine/frame_loop.h>

#include <cstdio>

int main() {
    still::Mesh mesh{.x = {-1, 1, 0}, .y = {-1, -1, 1}, .z = {0, 0, 0}};
    mesh.attributes.assign(3, {.nx = 0, .ny = 0, .nz = 1, .u = 0, .v = 0});
    mesh.indices = {0, 1, 2};
    mesh.parts = {{.first_triangle = 0, .triangle_count = 1, .material = 0}};

    still::Scene scene;
    scene.meshes.push_back(mesh);
    scene.materials.push_back({.diffuse = {1.0f, 0.5f, 0.1f}});
    scene.objects.push_back({.name = "triangle"});
    scene.lights.ambient = {1, 1, 1};

    still::Workers workers(2);
    still::FrameLoop loop(scene, {.width = 320, .height = 180, .subframes = 64}, workers);
    const still::FrameResult frame = loop.render(0);

    std::printf("P6 %d %d 255\n", frame.output.width, frame.output.height);
    for (int y = 0; y < frame.output.height; ++y) {
        std::fwrite(frame.output.row(y), sizeof(still::Rgb8), size_t(frame.output.width), stdout);
    }
}
