// A render of Cornell Box Lights by an engine of its own.
#pragma once
#include <memory>
#include <utility>

#include "Common/App/Session/SceneSource.h"
#include "Common/Render/Engine.h"

namespace rt::test {

struct BoxRender {
    std::shared_ptr<const scene::CompiledScene> scene = app::compile(app::loadScene("cornell-box-lights"), true);
    std::unique_ptr<app::Engine> engine;

    BoxRender(const app::RenderSettings& settings, std::unique_ptr<app::Engine> made) : engine(std::move(made)) {
        engine->setScene(scene, nullptr);
        engine->reset(scene->camera, settings);
    }
    const image::Film& finish(const app::Budget& budget = {}) {
        while (!engine->renderSome(budget).finished) {
        }
        return engine->film();
    }
};

} // namespace rt::test
