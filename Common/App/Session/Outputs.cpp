#include "Common/App/Session/Outputs.h"

#include <algorithm>
#include <iostream>
#include <limits>

#include "Common/App/Session/Attempt.h"
#include "Common/App/Session/DistinctFiles.h"
#include "Common/App/Session/ImagePart.h"
#include "Common/App/Session/RenderNote.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Image/Display.h"
#include "Common/Image/FilmRows.h"
#include "Common/Image/ImageIo.h"
#include "Common/Shared/Tonemap.h"

namespace rt::app {
namespace {

using image::ImageRows;

bool hasExtension(const std::filesystem::path& path, const std::string& lower) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    return extension == lower;
}

float largestValue(const ImageRows& image) {
    float maximum = -std::numeric_limits<float>::infinity();
    std::vector<float> row(image.rowValues());
    for (std::uint32_t y = 0; y < image.height; ++y) {
        image.read(y, row);
        maximum = std::max(maximum, *std::max_element(row.begin(), row.end()));
    }
    return maximum;
}

// Into the range that the format of `path` can hold.
ImageRows fitted(const ImageRows& image, Aov aov, const std::filesystem::path& path) {
    const bool png = hasExtension(path, ".png");
    if ((aov == Aov::Normal || aov == Aov::WideNormal) && (png || hasExtension(path, ".hdr"))) {
        ImageRows positive = mapped(image, [](float value) { return 0.5f * value + 0.5f; });
        if (!png) return positive;
        return mapped(positive, [](float value) { return shared::srgbDecode(std::clamp(value, 0.0f, 1.0f)); });
    }
    if (png && aov != Aov::Albedo && aov != Aov::WideAlbedo && aov != Aov::Denoised)
        if (const float maximum = largestValue(image); maximum > 0)
            return mapped(image, [maximum](float value) { return value / maximum; });
    return image;
}

// Of the film, or of what the engine made; both must outlive the rows.
ImageRows rowsOf(Aov aov, const image::Film& film, const AovImages& features, const image::Denoised& denoised) {
    switch (aov) {
        case Aov::Denoised:
            return denoised.picture;
        case Aov::DenoisedError:
            return denoised.error;
        case Aov::Albedo:
            return features.albedo;
        case Aov::Normal:
            return features.normal;
        case Aov::Depth:
            return features.depth;
        case Aov::WideAlbedo:
            return features.wide.albedo;
        case Aov::WideNormal:
            return features.wide.normal;
        case Aov::WideDepth:
            return features.wide.depth;
        case Aov::Emission:
            return features.emission;
        case Aov::Variance:
            return varianceRows(film);
        case Aov::Samples:
            break;
    }
    return sampleCountRows(film);
}

bool isOfDenoiser(Aov aov) {
    return aov == Aov::Denoised || aov == Aov::DenoisedError;
}

// Rather than of the film.
bool isFeature(Aov aov) {
    return aov != Aov::Variance && aov != Aov::Samples && !isOfDenoiser(aov);
}

AovRequest featuresFor(const Options& options) {
    AovRequest request{{options.wants(Aov::Albedo), options.wants(Aov::Normal), options.wants(Aov::Depth)}};
    request.wide = {options.wants(Aov::WideAlbedo), options.wants(Aov::WideNormal), options.wants(Aov::WideDepth)};
    request.emission = options.wants(Aov::Emission);
    return request;
}

void probe(const std::filesystem::path& path) {
    std::error_code ignored; // what cannot be looked at cannot be written either
    if (std::filesystem::is_directory(path, ignored)) throw RenderError(path.string() + ": is a directory");
    if (std::filesystem::is_fifo(path, ignored)) return; // whose reader would take a probe for all there is
    AtomicFile file(path);                               // never committed: only its temporary file comes and goes
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
    for (const std::string& output : options.outputs) image::checkWritable(output);
    checkDistinctFiles(options);
    for (const std::string& output : options.outputs) {
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
    std::string note;
    attempt(result.failures, "the pictures do not say how they were made",
            [&] { note = renderNote(options, camera, engine.report(), film); });
    const auto write = [&result, &note](const std::filesystem::path& path, const auto& makeRows) {
        const auto action = [&] { image::writeImage(path, makeRows(), note); };
        if (attempt(result.failures, "cannot write " + path.string(), action)) result.written.push_back(path.string());
    };
    const auto shown = [&options](const ImageRows& radiance, const std::filesystem::path& path) {
        const auto curve = static_cast<std::uint32_t>(options.tonemap);
        return hasExtension(path, ".png") ? image::toDisplay(radiance, options.exposure, curve) : radiance;
    };
    image::Denoised denoised;
    const auto filter = [&] {
        if (!options.denoises()) return;
        FilmDenoiser denoiser(options, engine);
        denoised = denoiser.denoise(film);
        result.denoised = denoiser.figures();
    };
    const bool isFiltered = attempt(result.failures, "the picture cannot be denoised", filter);
    for (const std::filesystem::path output : options.outputs)
        write(output, [&] { // raw rather than nothing
            const bool isRaw = !options.denoisedOnly || !isFiltered;
            return shown(isRaw ? withinRegion(meanRows(film), options.region) : ImageRows(denoised.picture), output);
        });

    AovImages features;
    const auto writeAovs = [&](bool ofFeatures) {
        for (const std::filesystem::path output : options.outputs)
            for (const Aov aov : options.aovs) {
                if (isFeature(aov) != ofFeatures || (isOfDenoiser(aov) && !isFiltered)) continue;
                write(aovPath(output, aov), [&] {
                    const ImageRows rows = withinRegion(rowsOf(aov, film, features, denoised), options.region);
                    return aov == Aov::Denoised ? shown(rows, output) : fitted(rows, aov, output);
                });
            }
    };
    writeAovs(false); // before features take the memory that these need
    const AovRequest request = featuresFor(options);
    const auto renderFeatures = [&] {
        if (request.any()) features = engine.renderAovs(request, std::min(kAovSamples, options.settings.spp));
    };
    if (attempt(result.failures, "features of surfaces cannot be made", renderFeatures)) writeAovs(true);
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
