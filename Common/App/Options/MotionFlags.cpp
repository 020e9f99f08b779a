#include "Common/App/Options/MotionFlags.h"

#include <algorithm>
#include <string>

#include "Common/App/Options/OptionValues.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

constexpr double kLongestTime = 1e9; // as the largest number of a scene
constexpr const char* kShutterForm = "OPEN,CLOSE in seconds from -1e9 to 1e9, OPEN at most CLOSE, as 0,0.02";
constexpr std::uint32_t kLastFrame = 9'999'999;

FrameRange parseFrames(const std::string& flag, const std::string& text) {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos) refuseValue(flag, text, "A..B, as 0..47");
    FrameRange range;
    range.first = parseWhole(flag, text.substr(0, dots), 0, kLastFrame);
    range.last = parseWhole(flag, text.substr(dots + 2), range.first, kLastFrame);
    return range;
}

scene::Shutter parseShutter(const std::string& flag, const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) refuseValue(flag, text, kShutterForm);
    const auto seconds = [&](const std::string& part) {
        return parseReal(flag, part, -kLongestTime, kLongestTime, kShutterForm);
    };
    const scene::Shutter shutter{seconds(text.substr(0, comma)), seconds(text.substr(comma + 1))};
    if (shutter.open > shutter.close) refuseValue(flag, text, kShutterForm);
    return shutter;
}

} // namespace

void addMotion(FlagSet& flags, Options& options) {
    flags.group("Motion");
    flags
        .add("--time", "T", "seconds; poses an animated scene",
             [&options](const std::string& flag, const std::string& text) {
                 options.moment.time = parseReal(flag, text, 0, kLongestTime, "seconds from 0 to 1e9");
                 options.moment.isAsked = options.moment.isWhole = true;
             })
        ->default_str("0");
    flags.add("--animation", "NAME", "which of the scene's animations; the first",
              [&options](const std::string& flag, const std::string& text) {
                  if (text.empty()) refuseValue(flag, text, "the name of one of the scene's animations");
                  options.moment.animation = text;
              });
    flags
        .add("--shutter", "OPEN,CLOSE",
             "motion blur: light is gathered from OPEN to CLOSE, in seconds after --time, or before it where they are "
             "below 0; the mean of many poses",
             [&options](const std::string& flag, const std::string& text) {
                 options.shutter = parseShutter(flag, text);
             })
        ->default_str("0,0")
        ->configurable(false);
    flags
        .add("--frames", "A..B",
             "a sequence NAME.0001.EXT: frame N is N frames after --time; frames that are there stay, and one that was "
             "interrupted goes on",
             [&options](const std::string& flag, const std::string& text) { options.frames = parseFrames(flag, text); })
        ->configurable(false);
    flags
        .add("--frame-rate", "R", "frames a second of --frames",
             [&options](const std::string& flag, const std::string& text) {
                 options.frameRate = parseReal(flag, text, 1e-3, 1e6, "frames a second, from 0.001 to 1e6");
             })
        ->default_str("24");
}

void settleInstant(Options& options) {
    if (options.shutter == scene::Shutter() || options.shutter.isOpen()) return;
    options.moment.time = std::max(options.moment.time + options.shutter.open, 0.0); // before which nothing moves
    options.moment.isAsked = true;
    options.shutter = {};
}

void settleShutter(Options& options) {
    if (!options.frames) settleInstant(options);
    if (!options.shutter.isOpen()) return;
    if (options.isScripted) throw UsageError("--shutter: not in a script, whose scenes are of one instant");
    if (options.command != Command::Render) throw UsageError("--shutter: only to render; --time poses a scene");
    if (options.settings.adaptive)
        throw UsageError("--adaptive on: not with --shutter, whose poses take equally many samples of all pixels");
}

void settleFrames(const FlagSet& flags, const Options& options) {
    if (!options.frames) return;
    if (options.isScripted) throw UsageError("--frames: not in a script, which makes one picture; say --time");
    if (options.command != Command::Render) throw UsageError("--frames: only to render");
    if (options.window) throw UsageError("--frames: not with a window; use --output or --headless");
    if (options.outputs.empty()) throw UsageError("--frames: needs --output");
    if (options.stats == "-") throw UsageError("--frames: --stats must be a file, of which each frame has its own");
    for (const char* flag : {"--checkpoint", "--resume", "--tiles"})
        if (flags.given(flag)) throw UsageError(std::string(flag) + ": not with --frames, which goes on by itself");
}

} // namespace rt::app
