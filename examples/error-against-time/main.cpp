// Error against time of two estimators: the same scene with lights sampled and with scattering alone, at numbers of
// samples that double. The error is relMSE, the mean squared error relative to the picture's own brightness, against a
// reference of many samples with other random numbers.
//
//     ./error-against-time [TABLE.csv [SCENE]]
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <string>

#include "Common/Image/Metrics.h"
#include "Common/Render/FilmRun.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingCPU/CpuEngine.h"

namespace app = rt::app;

namespace {

struct Render {
    rt::image::Image picture;
    double seconds; // of sampling alone
};

Render render(app::Engine& engine, const rt::scene::CameraDesc& camera, app::LightSampling estimator, std::uint32_t spp,
              std::uint32_t seed) {
    app::RenderSettings settings;
    settings.width = settings.height = 100;
    settings.lightSampling = estimator;
    settings.spp = spp;
    settings.seed = seed;
    const std::atomic<bool> cancel{false};
    app::FilmRun run(engine, camera, settings);
    run.untilStopped(cancel);
    return {engine.film().resolve(), run.seconds()};
}

} // namespace

int main(int count, char** arguments) try {
    const std::string file = count > 1 ? arguments[1] : "error-against-time.csv";
    const auto scene =
        rt::scene::compileScene(rt::scene::findBuiltinScene(count > 2 ? arguments[2] : "cornell-box-lights"));
    const std::unique_ptr<app::Engine> engine = rt::cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);

    const rt::image::Image reference = render(*engine, scene->camera, app::LightSampling::Mis, 1024, 1).picture;
    std::ofstream table(file);
    table << "estimator,samples,seconds,relmse\n";
    for (const auto& [name, estimator] : {std::pair("lights and scattering (MIS)", app::LightSampling::Mis),
                                          std::pair("scattering alone", app::LightSampling::Bsdf)}) {
        std::printf("%s\n", name);
        for (std::uint32_t spp = 4; spp <= 64; spp *= 2) {
            const Render result = render(*engine, scene->camera, estimator, spp, 0);
            const double error = rt::image::compare(result.picture, reference).relmse;
            std::printf("  %3u samples  %7.3f s  relMSE %.4f\n", spp, result.seconds, error);
            table << name << ',' << spp << ',' << result.seconds << ',' << error << '\n';
        }
    }
    std::printf("%s\n", file.c_str());
    return table.good() ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
