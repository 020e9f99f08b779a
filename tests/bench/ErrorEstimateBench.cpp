// Whether the error that a render states of itself is the one it has, over scenes, samplers and seeds: the table of
// docs/error-estimate.md. Of each scene, sampler and number of samples: the median over the seeds of estimated over
// measured relMSE, the share of seeds where that is below 0.8, and the shares whose confidence interval holds the
// relMSE that is expected over all seeds, or lies below it.
//   error-estimate-bench [SEEDS] [WIDTH] [SAMPLER[,SAMPLER...]] [on|off, adaptive] [SCENE...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/Summary.h"
#include "Common/Render/Names.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/image/EstimateRatios.h"

namespace rt::test {
namespace {

app::SamplerKind samplerOf(const std::string& name) {
    for (const auto& row : app::kSamplers)
        if (row.name == name) return row.value;
    throw UsageError("sampler \"" + name + "\" is not one of " + app::joinedNames(app::kSamplers));
}

struct Campaign {
    std::uint32_t seeds = 100;
    std::uint32_t width = 48;
    std::vector<app::SamplerKind> samplers = {app::SamplerKind::Sobol};
    bool adaptive = false;
};

void printRow(const std::string& label, const std::vector<EstimatedRun>& runs) {
    const std::vector<double> measured = measuredErrors(runs);
    const auto seeds = static_cast<double>(runs.size());
    const double expected = std::accumulate(measured.begin(), measured.end(), 0.0) / seeds;
    std::vector<double> ratios;
    double low = 0, held = 0, under = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const image::RelMseEstimate& estimated = runs[i].estimated;
        ratios.push_back(estimated.value / measured[i]);
        low += ratios.back() < 0.8 ? 1 : 0;
        under += estimated.high() < expected ? 1 : 0;
        held += estimated.low() <= expected && expected <= estimated.high() ? 1 : 0;
    }
    std::printf("| %s | %.2f | %.0f %% | %.0f %% | %.0f %% |\n", label.c_str(), image::median(ratios),
                100 * low / seeds, 100 * held / seeds, 100 * under / seeds);
    std::fflush(stdout);
}

void measureScene(app::Engine& engine, const std::string& id, const Campaign& campaign) {
    const scene::SceneDesc desc = app::loadScene(id);
    const auto scene = app::compile(desc, true, true);
    engine.setScene(scene, nullptr);
    for (const app::SamplerKind sampler : campaign.samplers)
        for (const std::uint32_t spp : {16u, 64u}) {
            app::RenderSettings settings;
            settings.width = campaign.width;
            settings.height = std::max(1u, static_cast<std::uint32_t>(campaign.width / desc.render.aspect + 0.5));
            settings.spp = spp;
            settings.replicates = app::kErrorReplicates;
            settings.sampler = sampler;
            settings.adaptive = campaign.adaptive;
            printRow(id + " | " + app::nameOf(app::kSamplers, sampler) + " | " + std::to_string(spp),
                     renderSeeds(engine, *scene, settings, campaign.seeds));
        }
}

int run(const std::vector<std::string>& words) {
    Campaign campaign;
    if (words.size() > 0) campaign.seeds = static_cast<std::uint32_t>(std::atoi(words[0].c_str()));
    if (words.size() > 1) campaign.width = static_cast<std::uint32_t>(std::atoi(words[1].c_str()));
    if (words.size() > 2) {
        campaign.samplers.clear();
        std::istringstream names(words[2]);
        for (std::string name; std::getline(names, name, ',');) campaign.samplers.push_back(samplerOf(name));
    }
    if (words.size() > 3) campaign.adaptive = words[3] == "on";
    std::vector<std::string> scenes(words.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(words.size(), 4)),
                                    words.end());
    if (scenes.empty())
        for (const scene::BuiltinScene& scene : scene::builtinScenes()) scenes.emplace_back(scene.id);
    const auto engine = cpu::makeCpuEngine({});
    std::puts(
        "| scene | sampler | spp | median | below 0.8 | interval holds | interval below |\n"
        "|---|---|---|---|---|---|---|");
    for (const std::string& id : scenes) measureScene(*engine, id, campaign);
    return 0;
}

} // namespace
} // namespace rt::test

int main(int argc, char** argv) {
    try {
        return rt::test::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error-estimate-bench: %s\n", error.what());
        return 1;
    }
}
