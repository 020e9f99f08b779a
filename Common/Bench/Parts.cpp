#include "Common/Bench/Parts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Cells.h"
#include "Common/Bench/Measurement.h"
#include "Common/Core/Error.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::bench {
namespace {

using Scene = std::shared_ptr<const scene::CompiledScene>;

scene::SceneDesc withDiffuseSurfaces(scene::SceneDesc scene) {
    for (auto& [name, material] : scene.materials) {
        if (!scene::materialType(material.kind).scatters) continue;
        scene::MaterialDesc diffuse;
        diffuse.albedo = glm::dvec3(0.73); // as of the box's walls
        diffuse.emission = material.emission;
        diffuse.emissionTexture = material.emissionTexture;
        diffuse.sides = material.sides;
        material = diffuse;
    }
    return scene;
}

// Of whole pictures, as far as `ladder` goes: a part of one would have rays of its own.
PartRow measurePart(Engines& engines, const PartsRequest& request, const Part& part, const Scene& scene,
                    const Ladder& ladder, const std::atomic<bool>& stop) {
    Config config;
    config.scene = request.scene;
    config.engine = request.engine;
    config.settings.width = request.width;
    config.settings.height =
        std::max(1u, static_cast<std::uint32_t>(std::lround(request.width / scene->defaults.aspect)));
    for (const auto& [axis, value] : part.values) findAxis(axis)->set(config, value);
    engines.clear(); // one at a time, with all of the memory
    PartRow row;
    row.part = part.name;
    app::Engine* const engine = engines.prepare(config, scene, stop);
    if (engine == nullptr) return row;
    const Run run = measure(*engine, *scene, config.settings, ladder, 0, stop);
    if (run.snapshots.empty()) return row;
    const Snapshot& done = run.snapshots.back();
    row.seconds = run.report.threads == 0 ? done.deviceSeconds : done.seconds;
    row.samples = done.samples;
    row.rays = done.rays;
    row.kernel = run.report.kernel;
    row.features = run.report.features;
    row.shaders = run.report.shaders;
    return row;
}

double raysOf(const PartRow& row) {
    return static_cast<double>(row.rays.all());
}

Table costTable(std::span<const PartRow> rows) {
    Table table{{"left out", "shadow rays / sample", "all rays / sample", "M samples/s", "M rays/s", "ps / ray",
                 "share of a sample", "share of a ray", "kernel"},
                {}};
    const auto perSample = [](const PartRow& row) { return row.seconds / static_cast<double>(row.samples); };
    const auto perRay = [](const PartRow& row) { return row.seconds / raysOf(row); };
    for (const PartRow& row : rows) {
        const double samples = static_cast<double>(row.samples);
        const bool isWhole = &row == rows.data();
        table.rows.push_back({row.part, threeDigits(static_cast<double>(row.rays.shadow) / samples),
                              threeDigits(raysOf(row) / samples), threeDigits(1e-6 / perSample(row)),
                              threeDigits(1e-6 / perRay(row)), threeDigits(1e12 * perRay(row)),
                              isWhole ? kUnknown : percent(1 - perSample(row) / perSample(rows.front())),
                              isWhole ? kUnknown : percent(1 - perRay(row) / perRay(rows.front())), row.kernel});
    }
    return table;
}

// A line a shader; a column for each of the driver's figures, in its order.
Table shaderTable(std::span<const PartRow> rows) {
    Table table{{"left out", "shader"}, {}};
    for (const PartRow& row : rows)
        for (const app::ShaderFigure& figure : row.shaders)
            if (std::find(table.header.begin(), table.header.end(), figure.name) == table.header.end())
                table.header.push_back(figure.name);
    for (const PartRow& row : rows)
        for (const app::ShaderFigure& figure : row.shaders) {
            const bool isNew =
                table.rows.empty() || table.rows.back()[0] != row.part || table.rows.back()[1] != figure.shader;
            if (isNew) {
                table.rows.emplace_back(table.header.size(), kUnknown);
                table.rows.back()[0] = row.part;
                table.rows.back()[1] = figure.shader;
            }
            const auto column = std::find(table.header.begin(), table.header.end(), figure.name);
            table.rows.back()[static_cast<std::size_t>(column - table.header.begin())] = whole(figure.value);
        }
    return table;
}

} // namespace

std::span<const Part> parts() {
    static const std::vector<Part> all{
        {"nothing", {}},
        {"choice by contribution (uniform)", {{"light_selection", "uniform"}}},
        {"strategies of lights (area)", {{"sphere_light", "area"}, {"quad_light", "area"}, {"triangle_light", "area"}}},
        {"both",
         {{"light_selection", "uniform"},
          {"sphere_light", "area"},
          {"quad_light", "area"},
          {"triangle_light", "area"}}},
        {"light sampling (BSDF alone)", {{"light_sampling", "bsdf"}}},
        {"Sobol (independent)", {{"sampler", "independent"}}},
        {"roulette", {{"russian_roulette", "off"}}},
        {"materials (all diffuse)", {}, true},
        {"rays at edges of lights", {{"edge_rays", "off"}}},
        {"path reuse", {{"path_reuse", "off"}}},
        {"all but camera rays",
         {{"max_depth", "1"}, {"light_sampling", "bsdf"}, {"edge_rays", "off"}, {"path_reuse", "off"}}},
        {"the exact mask (all features)", {{"features", "all"}}},
    };
    return all;
}

std::vector<PartRow> measureParts(Engines& engines, const PartsRequest& request, const std::atomic<bool>& stop,
                                  const std::function<void(const PartRow&)>& report) {
    if (const std::string why = engines.missing(request.engine); !why.empty())
        throw RenderError("engine " + request.engine + ": " + why);
    const scene::SceneDesc desc = app::loadScene(request.scene);
    const Scene scene = app::compile(desc, true, true);
    const Scene diffuse = app::compile(withDiffuseSurfaces(desc), true, true);
    // As many samples a pixel as take so long when nothing is left out.
    const PartRow first = measurePart(engines, request, parts().front(), scene, {{}, {request.seconds}}, stop);
    const double pixels = request.width * std::max(1.0, std::round(request.width / scene->defaults.aspect));
    const auto spp = static_cast<std::uint32_t>(std::max(1.0, static_cast<double>(first.samples) / pixels));
    std::vector<PartRow> rows;
    for (const Part& part : parts()) {
        PartRow row = measurePart(engines, request, part, part.isMaterials ? diffuse : scene, {{spp}, {}}, stop);
        if (stop || row.samples == 0) break;
        if (report) report(row);
        rows.push_back(std::move(row));
    }
    engines.clear();
    return rows;
}

Document describeParts(const PartsRequest& request, std::span<const PartRow> rows) {
    Document document{Heading{2, "What parts cost: " + request.scene + ", " + request.engine}};
    if (rows.empty()) return document;
    document.push_back(costTable(rows));
    if (Table shaders = shaderTable(rows); !shaders.rows.empty()) document.push_back(std::move(shaders));
    return document;
}

} // namespace rt::bench
