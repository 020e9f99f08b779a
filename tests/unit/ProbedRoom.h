// A floor under lamps of all shapes, none of which is seen by another one, for tests of what is sampled at it.
#pragma once
#include <memory>

#include "Common/Probe/ProbeView.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/SceneCompiler.h"

namespace rt::test {

inline constexpr std::uint32_t kRoomSide = 40; // of its image, whose middle shows the floor

// A sphere, a quad, two triangles, a disk and a cylinder; `fuzz`: of a floor of metal, else it is matt.
inline scene::SceneDesc probedRoom(double fuzz = 0) {
    using namespace scene;
    SceneDesc room;
    room.id = "room";
    room.camera = camera({0, 1, 4}, {0, 0, 0}, 40);
    room.materials = {{"floor", fuzz > 0 ? metal(glm::dvec3(0.8), fuzz) : lambertian(0.5, 0.5, 0.5)},
                      {"lamp", emitter({9, 9, 9}, Sides::Both)}};
    add(room, quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, "floor"));
    add(room, sphere({2, 2, 0}, 0.7, "lamp"));
    add(room, quad({-3, 2, -1}, {2, 0, 0}, {0, 0, 2}, "lamp"));
    MeshDesc mesh;
    mesh.source =
        MeshData{{{-1, 3, -3}, {1, 3, -3}, {1, 2, -4}, {-1, 2, -4}}, {}, {}, {}, {}, {}, {{0, 1, 2}, {0, 2, 3}}};
    mesh.material = "lamp";
    mesh.light = true;
    room.objects.push_back({mesh});
    room.objects.push_back({DiskDesc{{1, 3, 2}, {0, -1, 0}, 0.6, 0, "lamp", true}});
    room.objects.push_back({CylinderDesc{{-2.5, 1, 2}, {-1, 1, 2.5}, 0.3, "lamp", true}});
    return room;
}

inline std::shared_ptr<const scene::CompiledScene> compiled(const scene::SceneDesc& desc) {
    return scene::compileScene(desc);
}

// What a window asks of the middle of the image.
inline probe::ProbeWish middleOf(const std::shared_ptr<const scene::CompiledScene>& scene) {
    probe::ProbeWish wish;
    wish.scene = scene;
    wish.rendering.width = wish.rendering.height = kRoomSide;
    wish.camera = scene->camera;
    wish.pixel = {kRoomSide / 2, kRoomSide / 2};
    return wish;
}

inline app::Options optionsFor(const app::RenderSettings& settings) {
    app::Options options;
    options.settings = settings;
    options.size = {settings.width, settings.height, {}};
    return options;
}

} // namespace rt::test
