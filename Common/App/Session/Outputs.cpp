#include "Common/App/Session/Outputs.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>

#include "Common/App/Session/RenderNote.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Image/Display.h"
#include "Common/Image/ImageIo.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {
namespace {

constexpr std::uint32_t kAovSamples = 16; // of each pixel, or fewer when the render has fewer

using image::Image;

bool hasExtension(const std::filesystem::path& path, const std::string& lower) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    return extension == lower;
}

void forEachValue(Image& image, const std::function<float(float)>& change) {
    std::transform(image.data.begin(), image.data.end(), image.data.begin(), change);
}

// Into the range that the format of `path` can hold.
Image fitted(Image image, Aov aov, const std::filesystem::path& path) {
    const bool png = hasExtension(path, ".png");
    if (aov == Aov::Normal && (png || hasExtension(path, ".hdr"))) {
        forEachValue(image, [](float value) { return 0.5f * value + 0.5f; });
        if (png) forEachValue(image, [](float value) { return shared::srgbDecode(std::clamp(value, 0.0f, 1.0f)); });
    } else if (png && aov != Aov::Albedo) {
        const float most = *std::max_element(image.data.begin(), image.data.end());
        if (most > 0) forEachValue(image, [most](float value) { return value / most; });
    }
    return image;
}

std::map<Aov, Image> makeAovs(const Options& options, const image::Film& film, Engine& engine) {
    const AovRequest request{options.wants(Aov::Albedo), options.wants(Aov::Normal), options.wants(Aov::Depth)};
    std::map<Aov, Image> images;
    if (request.any()) {
        AovImages features = engine.renderAovs(request, std::min(kAovSamples, options.settings.spp));
        images = {{Aov::Albedo, std::move(features.albedo)},
                  {Aov::Normal, std::move(features.normal)},
                  {Aov::Depth, std::move(features.depth)}};
    }
    if (options.wants(Aov::Variance)) images[Aov::Variance] = film.varianceOfMean();
    if (options.wants(Aov::Samples)) images[Aov::Samples] = film.sampleCounts();
    return images;
}

void probe(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) throw RenderError(path.string() + ": is a directory");
    AtomicFile file(path); // never committed: only its temporary file comes and goes
}

} // namespace

bool isLinearFormat(const std::filesystem::path& path) {
    return hasExtension(path, ".exr") || hasExtension(path, ".hdr") || hasExtension(path, ".pfm");
}

std::filesystem::path aovPath(const std::filesystem::path& output, Aov aov) {
    const std::string name = output.stem().string() + "." + nameOf(kAovs, aov) + output.extension().string();
    return output.parent_path() / name;
}

void checkOutputs(const Options& options) {
    for (const std::string& output : options.outputs) {
        image::checkWritable(output);
        probe(output);
        for (const Aov aov : options.aovs) probe(aovPath(output, aov));
    }
    if (!options.checkpoint.empty()) probe(options.checkpoint);
    if (!options.stats.empty() && options.stats != "-") probe(options.stats);
}

OutputResult writeOutputs(const Options& options, const scene::CameraDesc& camera, const image::Film& film,
                          Engine& engine) {
    OutputResult result;
    if (options.outputs.empty()) return result;
    const std::string note = renderNote(options, camera, engine.report(), film);
    const auto write = [&result, &note](const std::filesystem::path& path, const Image& image) {
        try {
            image::writeImage(path, image, note);
            result.written.push_back(path.string());
        } catch (const Error& error) {
            result.failures.emplace_back(error.what());
        }
    };
    const Image radiance = film.resolve();
    const auto curve = static_cast<std::uint32_t>(options.tonemap);
    for (const std::filesystem::path output : options.outputs)
        write(output, hasExtension(output, ".png") ? image::toDisplay(radiance, options.exposure, curve) : radiance);
    std::map<Aov, Image> aovs;
    try {
        aovs = makeAovs(options, film, engine);
    } catch (const Error& error) { // of the engine; the picture and the statistics are not lost for that
        result.failures.emplace_back(error.what());
        return result;
    }
    for (const std::filesystem::path output : options.outputs)
        for (const Aov aov : options.aovs) write(aovPath(output, aov), fitted(aovs.at(aov), aov, output));
    return result;
}

void writeText(const std::string& file, const std::string& text) {
    if (file == "-") {
        std::cout << text << std::flush; // whether that worked is asked at the end of main
        return;
    }
    AtomicFile target(file);
    target.stream() << text;
    target.commit();
}

} // namespace rt::app
