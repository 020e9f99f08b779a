#include "Common/Tools/Image/PathsCommand.h"

#include <string>

#include <nlohmann/json.hpp>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "Common/Probe/PathsReport.h"
#include "Common/Render/RenderParams.h"
#include "Common/Tools/Image/ProbeCommand.h"

namespace rt::tools {

void runPaths(const ImageArguments& arguments, std::ostream& out) {
    const PathsArguments& asked = arguments.paths;
    if (!arguments.output.empty()) image::checkWritable(arguments.output);
    app::Options options;
    options.settings = asked.settings;
    app::settleReplicates(options.settings);
    applyPixel(asked, options);
    const bool isSelected = asked.sample != PathsArguments::kNoSample;
    if (isSelected && asked.sample >= asked.settings.spp)
        throw UsageError("--sample " + std::to_string(asked.sample) + ": must be below --spp, " +
                         std::to_string(asked.settings.spp));
    const probe::SceneFormulas scene(app::compile(app::SceneRequest{asked.scene, true, asked.camera}), options, 0.0);
    const app::RenderSettings& settings = scene.options().settings;
    const auto pixel = pixelOf(asked.pixel, settings);

    probe::PathsSettings wanted{settings.spp, asked.listed, {}};
    if (isSelected) wanted.selected = asked.sample;
    probe::PathsRun run(scene, scene.compiled()->camera, pixel[0], pixel[1], wanted);
    while (!run.isDone()) run.advance();
    const probe::PathsResult result = run.result();
    const probe::PathsPlace place{scene.compiled()->id, pixel, settings};
    if (!arguments.output.empty()) image::writeImage(arguments.output, probe::stripOf(result));
    if (asked.json)
        out << probe::figuresOf(result, place).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << '\n';
    else
        out << probe::textOf(result, place);
}

} // namespace rt::tools
