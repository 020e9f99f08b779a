#include "Common/App/Session/Frames.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>

#include "Common/App/Options/MotionFlags.h"
#include "Common/App/Session/Outputs.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

bool isThere(const fs::path& file) {
    std::error_code none;
    return fs::exists(file, none);
}

std::string numbered(const std::string& file, std::uint32_t frame) {
    constexpr std::size_t kDigits = 4;
    std::string number = std::to_string(frame);
    number.insert(0, kDigits - std::min(number.size(), kDigits), '0');
    const fs::path path(file);
    fs::path name = path.stem();
    name += "." + number;
    name += path.extension();
    return (path.parent_path() / name).string();
}

} // namespace

Options optionsOfFrame(const Options& sequence, std::uint32_t frame) {
    Options options = sequence;
    options.frames.reset();
    options.frame = frame;
    options.moment.time += frame / sequence.frameRate;
    options.moment.isAsked = true;
    settleInstant(options);
    for (std::string& output : options.outputs) output = numbered(output, frame);
    if (!options.stats.empty()) options.stats = numbered(options.stats, frame);
    options.checkpoint = checkpointBeside(options.outputs.front());
    options.keepsFinishedCheckpoint = false;
    if (isThere(options.checkpoint)) options.resume = options.checkpoint;
    return options;
}

bool isRendered(const Options& frame) {
    if (isThere(frame.checkpoint) || (!frame.stats.empty() && !isThere(frame.stats))) return false;
    return std::all_of(frame.outputs.begin(), frame.outputs.end(), [&frame](const std::string& output) {
        const auto isBeside = [&output](Aov aov) { return isThere(aovPath(output, aov)); };
        return isThere(output) && std::all_of(frame.aovs.begin(), frame.aovs.end(), isBeside);
    });
}

void removeCheckpoint(const Options& frame) {
    std::error_code none;
    fs::remove(frame.checkpoint, none);
}

} // namespace rt::app
