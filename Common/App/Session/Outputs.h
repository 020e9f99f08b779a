// The files a render ends with: the picture in each format, and the images beside it.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/DenoiseFilm.h"
#include "Common/Image/Film.h"
#include "Common/Render/Engine.h"

namespace rt::app {

bool isLinearFormat(const std::filesystem::path& path); // by its extension: .exr, .hdr, .pfm

// "dir/a.normal.png" for "dir/a.png" and Aov::Normal.
std::filesystem::path aovPath(const std::filesystem::path& output, Aov aov);

// Creates and removes a file beside each one that the options name, so that hours of rendering do not end with a
// directory that does not exist. Throws UsageError for an unknown image format and for files that would overwrite each
// other or what is read (DistinctFiles.h), RenderError for a place that cannot be written.
void checkOutputs(const Options& options);

struct OutputResult {
    std::optional<DenoiseFigures> denoised; // of the picture that is, or lies beside, the outputs
    std::vector<std::string> written;
    std::vector<std::string> failures; // one line each
};
// Writes all that can be written. PNG gets exposure and tone curve; what lies beside a PNG is brought into its range:
// normals as (n + 1) / 2 without transfer curve, other quantities divided by their maximum. PNG and EXR tell how they
// were made (RenderNote.h).
OutputResult writeOutputs(const Options& options, const scene::CameraDesc& camera, const image::Film& film,
                          Engine& engine);

// "-": to standard output. Throws RenderError.
void writeText(const std::string& file, const std::string& text);

} // namespace rt::app
