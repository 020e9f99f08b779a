// What the user asked for: flags, environment and configuration file, checked and made consistent.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "Common/Manual/Page.h"
#include "Common/Render/Names.h"
#include "Common/Render/Settings.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

enum class Command { Render, ListScenes, ExportScene, ListDevices };

// At most two say all; settleImageSize() checks a third.
struct SizeRequest {
    std::optional<std::uint32_t> width, height; // pixels
    std::optional<double> aspect;               // width / height
    bool operator==(const SizeRequest&) const = default;
};

// Of the image, in pixels from its top left.
struct Region {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Region&) const = default;
};

// Share `number`, counted from 1, of `of` shares of the image's tiles.
struct TileShare {
    std::uint32_t number = 1, of = 1;
    bool operator==(const TileShare&) const = default;
};

// Of a sequence, the last one too.
struct FrameRange {
    std::uint32_t first = 0, last = 0;
    bool operator==(const FrameRange&) const = default;
};

struct Options {
    std::string program; // "ray-tracing-cpu" or "ray-tracing-gpu"
    Command command = Command::Render;
    bool window = false;    // of Command::Render
    bool json = false;      // of --list-scenes
    std::string exportFile; // of Command::ExportScene

    std::string scene = "cornell-box-lights"; // id or file
    std::string camera;                       // its pose as JSON; empty: the scene's
    std::string assetsBelow;                  // the folder that the scene's files must lie in; empty: anywhere
    scene::Moment moment;                     // at which an animated scene is posed
    scene::Shutter shutter;                   // about that moment
    std::optional<FrameRange> frames;         // one picture, without a number
    std::optional<std::uint32_t> frame;       // of such a sequence
    double frameRate = 24;                    // of frames, a second
    bool oneSidedLights = true;
    SizeRequest size;
    RenderSettings settings;        // complete but for width and height, which may depend on the scene
    std::optional<Region> region;   // all of the image
    std::optional<TileShare> tiles; // all of them

    std::vector<std::string> outputs;
    bool isScripted = false; // pictures and statistics are taken from memory: none of them needs a file
    float exposure = 0;      // stops
    Tonemap tonemap = Tonemap::None;
    std::vector<Aov> aovs;
    bool denoisedOnly = false;   // outputs are denoised; otherwise Aov::Denoised lies beside them
    bool denoisesByOidn = false; // by the library of OpenImageDenoise.h
    std::string reference;
    std::string stats; // "-": standard output

    std::optional<double> timeLimit;     // seconds
    std::optional<double> targetError;   // relMSE
    std::optional<double> saveEvery;     // seconds
    std::string checkpoint;              // empty: none is written
    bool keepsFinishedCheckpoint = true; // also of a render that has reached its end
    std::string resume;                  // empty: start anew

    std::uint32_t threads = 0; // 0: all
    Policy policy = Policy::Par;
    GpuEngineKind gpuEngine = GpuEngineKind::Auto;
    std::string device;      // of ray-tracing-gpu: index or part of a name; empty: the best
    bool validation = false; // check every Vulkan call: of ray-tracing-gpu, or of a window

    bool keepsUserFiles = true; // a window's settings, layout, history, references; false: none is read or written
    bool quiet = false;
    std::optional<double> progressEvery; // seconds between two lines of it, where they are no terminal's; none: 10
    bool verbose = false;
    std::string logFile;

    std::set<std::string> given; // flags that something was said about, as "--spp": a window's stored settings give way

    bool denoises() const { return denoisedOnly || wants(Aov::Denoised) || wants(Aov::DenoisedError); }
    bool wants(Aov aov) const { return std::find(aovs.begin(), aovs.end(), aov) != aovs.end(); }
};

// What a program built without a window says when one is asked for.
inline constexpr const char* kNoWindow =
    "this program was built without a window: say --output FILE, --stats FILE or --headless";
// What one says of a window when mpirun has started several.
inline constexpr const char* kNoWindowOfRanks =
    "mpirun: renders without a window: say --output FILE, --stats FILE or --headless";
inline constexpr const char* kCpuProgram = "ray-tracing-cpu";
inline constexpr const char* kGpuProgram = "ray-tracing-gpu"; // its flags differ where machines do

class FlagSet;
struct ParsedFlags;

// Reads command lines of one program: making its flags takes much longer than reading a line.
class OptionParser {
  public:
    // Environment and configuration file are looked for now. `isScripted`: see Options.
    explicit OptionParser(const std::string& program, bool isScripted = false);
    ~OptionParser();

    // Of the command line (without the program's name), else the environment, else the configuration file. Nothing is
    // returned after --help, --help-all and --version, which are answered on `out`. Throws UsageError.
    std::optional<Options> parse(std::vector<std::string> arguments, std::ostream& out);

    // What the help and the manual are made from.
    manual::Page page() const;

  private:
    const std::string program_;
    const bool isScripted_;
    const std::unique_ptr<ParsedFlags> parsed_;
    const std::unique_ptr<FlagSet> flags_;
};

// The one command line of a program.
std::optional<Options> parseOptions(const std::string& program, std::vector<std::string> arguments, std::ostream& out);

// Sets settings.width and height: 600 pixels wide and of the scene's own aspect where nothing is said. Throws
// UsageError, or InputError where the scene is to blame.
void settleImageSize(Options& options, const std::string& scene, double sceneAspect);

// The checkpoint of an output that has no other name: image.png.rtc for image.png.
std::string checkpointBeside(const std::string& output);

} // namespace rt::app
