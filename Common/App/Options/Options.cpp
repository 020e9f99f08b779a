#include "Common/App/Options/Options.h"

#include <limits>

#include "Common/App/Options/Description.h"
#include "Common/App/Options/FlagSet.h"
#include "Common/App/Options/MotionFlags.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Image/Film.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {

// What the flags say before it is made consistent.
struct ParsedFlags {
    Options options;
    bool listScenes = false;
    bool listDevices = false;
    bool headless = false;
    bool window = false;
    bool denoise = false; // beside the raw picture
    std::string engine;
};

namespace {

constexpr std::uint32_t kMaxSpp = 0x7fffffff;
constexpr std::uint32_t kMaxDepth = 4096;
constexpr std::uint32_t kMaxReplicates = 1024;
constexpr std::uint32_t kMaxThreads = 4096;
constexpr std::uint32_t kMaxShares = 1u << 20;
constexpr const char* kNoValue = ""; // of a flag that may have one
constexpr double kMaxAspect = image::kMaxImageSide;

// Flags that a window keeps in its settings, beside those of forEachMethod().
constexpr const char* kStoredFlags[] = {
    "--scene",    "--width",      "--height",           "--aspect",           "--spp",        "--max-depth",
    "--seed",     "--replicates", "--one-sided-lights", "--russian-roulette", "--time-limit", "--target-error",
    "--exposure", "--tonemap",    "--threads",          "--policy",           "--engine"};

// ---- the flags -----------------------------------------------------------------------------------------------------

void addScene(FlagSet& flags, ParsedFlags& parsed) {
    Options& options = parsed.options;
    flags.group("Scene");
    flags
        .add("--scene", "SCENE", "id of --list-scenes, a .json scene, an .obj, .gltf, .glb or .pbrt file",
             [&options](const std::string& flag, const std::string& text) {
                 if (text.empty())
                     refuseValue(flag, text,
                                 "an id of --list-scenes, a .json scene, an .obj, .gltf, .glb or .pbrt file");
                 options.scene = text;
             })
        ->default_str(options.scene);
    flags.add("--camera", "POSE",
              "in place of the scene's, as a window copies it: JSON of look_from, look_at, ...; or the name of one "
              "of the scene's cameras",
              [&options](const std::string& flag, const std::string& text) {
                  if (text.empty()) refuseValue(flag, text, "a pose as JSON, or the name of a camera");
                  if (isPose(text)) (void)poseOf(text, {}); // the scene may say the rest
                  options.camera = text;
              });
    flags.addFile("--assets-below", "DIR", options.assetsBelow, "no file of the scene may lie elsewhere");
    flags.addSwitch("--list-scenes", parsed.listScenes, "print ids and titles and exit")->configurable(false);
    flags.addSwitch("--json", options.json, "with --list-scenes: as JSON")->configurable(false);
    flags.addFile("--export-scene", "F.json|.glb|.gltf", options.exportFile, "write the scene as a file and exit")
        ->configurable(false);
    flags.addChoice("--one-sided-lights", kOnOff, options.oneSidedLights, "lights emit from their front face only");
}

void addImage(FlagSet& flags, Options& options) {
    RenderSettings& settings = options.settings;
    flags.group("Image");
    flags.addWhole("--width", options.size.width, 1, image::kMaxImageSide, "pixels")->default_str("600");
    flags.addWhole("--height", options.size.height, 1, image::kMaxImageSide, "pixels; width / aspect");
    flags.add("--aspect", "A", "width / height; 1 or the scene's own",
              [&options](const std::string& flag, const std::string& text) {
                  options.size.aspect =
                      parseReal(flag, text, 1 / kMaxAspect, kMaxAspect, "a number from 1/16384 to 16384");
              });
    flags.addWhole("--spp,--samples", settings.spp, 1, kMaxSpp, "samples per pixel")->default_str("100");
    flags
        .addWhole("--max-depth", settings.maxDepth, 1, kMaxDepth,
                  "path vertices after the camera; a notice tells where it darkens the picture by more than 1 %")
        ->default_str("50");
    flags.addWhole("--seed", settings.seed, 0, std::numeric_limits<std::uint32_t>::max(), "same seed, same image")
        ->default_str("0");
    flags
        .addWhole("--replicates", settings.replicates, 1, kMaxReplicates,
                  "independent scramblings, for honest error bars")
        ->default_str("1");
}

void addPart(FlagSet& flags, Options& options) {
    flags.group("Image");
    flags.add("--region", "X,Y,W,H", "render this part; the rest of the image is 0",
              [&options](const std::string& flag, const std::string& text) {
                  const std::vector<std::string> parts = parseList(flag, text);
                  if (parts.size() != 4) refuseValue(flag, text, "X,Y,W,H in pixels");
                  constexpr std::uint32_t kMax = image::kMaxImageSide;
                  options.region = Region{parseWhole(flag, parts[0], 0, kMax), parseWhole(flag, parts[1], 0, kMax),
                                          parseWhole(flag, parts[2], 1, kMax), parseWhole(flag, parts[3], 1, kMax)};
              });
    flags.add("--tiles", "I/N",
              "render the I-th of N shares of the image into a checkpoint for ray-tracing-image merge",
              [&options](const std::string& flag, const std::string& text) {
                  const std::size_t slash = text.find('/');
                  if (slash == std::string::npos) refuseValue(flag, text, "I/N, as 1/8 to 8/8");
                  const std::uint32_t of = parseWhole(flag, text.substr(slash + 1), 1, kMaxShares);
                  options.tiles = TileShare{parseWhole(flag, text.substr(0, slash), 1, of), of};
              });
}

void addEstimator(FlagSet& flags, RenderSettings& settings) {
    flags.group("Estimator");
    forEachMethod([&flags](const char* key, const char*, const char* help, const auto& table,
                           auto& value) { flags.addChoice(flagOf(key), table, value, help); },
                  settings);
    flags.addChoice("--russian-roulette", kOnOff, settings.russianRoulette, "end dim paths early, unbiased");
    flags.add("--features", "LIST|auto|all", "force the feature mask: a superset of what the scene needs",
              [&settings](const std::string&, const std::string& text) {
                  settings.features.reset();
                  if (text != "auto") settings.features = parseFeatures(text);
              });
}

void addDenoise(FlagSet& flags, ParsedFlags& parsed) {
    flags
        .add("--denoise", "on|off|only|oidn",
             "also write a picture with less noise, as NAME.denoised.EXT; only: in place of the raw one; oidn: by Open "
             "Image Denoise 2, where it is installed, to compare; implies an even number of --replicates",
             [&parsed](const std::string& flag, const std::string& text) {
                 const bool isOn = text == kNoValue || text == "on" || text == "true";
                 const bool isOff = text == "off" || text == "false"; // true, false: as files say it of switches
                 if (!isOn && !isOff && text != "only" && text != "oidn")
                     refuseValue(flag, text, "nothing, on, off, only or oidn");
                 parsed.denoise = isOn || text == "oidn";
                 parsed.options.denoisesByOidn = text == "oidn";
                 parsed.options.denoisedOnly = text == "only";
             })
        ->expected(0, 1);
}

void addOutput(FlagSet& flags, ParsedFlags& parsed) {
    Options& options = parsed.options;
    flags.group("Output");
    flags.addFiles("--output,-o,--outfile", "F.png|.exr|.hdr|.pfm", options.outputs,
                   ".png: for display, .exr .hdr .pfm: linear; repeatable");
    flags
        .add("--exposure", "E", "stops, for PNG",
             [&options](const std::string& flag, const std::string& text) {
                 options.exposure = static_cast<float>(parseReal(flag, text, -100, 100, "a number from -100 to 100"));
             })
        ->default_str("0");
    flags.addChoice("--tonemap", kTonemaps, options.tonemap,
                    "for PNG; none clamps, neutral is the curve that windows begin with, agx a filmic one");
    std::string aovs;
    for (const auto& row : kAovs) aovs += (aovs.empty() ? "" : ",") + std::string(row.name);
    flags.add("--aov", aovs,
              "write these images as well, as NAME.albedo.EXT; wide: of what is seen through "
              "mirrors and clear glass",
              [&options](const std::string& flag, const std::string& text) {
                  options.aovs = {};
                  for (const std::string& name : parseList(flag, text)) {
                      const Aov aov = parseChoice(flag, name, kAovs);
                      if (!options.wants(aov)) options.aovs.push_back(aov);
                  }
              });
    addDenoise(flags, parsed);
    flags.addFile("--reference", "F.exr|.hdr|.pfm|.png", options.reference,
                  "linear image; its error figures go to the statistics");
    flags.addFile("--stats", "F.json", options.stats, "statistics as JSON; -: standard output");
}

void addDuration(FlagSet& flags, Options& options) {
    flags.group("Duration");
    flags.addSeconds("--time-limit", options.timeLimit,
                     "stop after so long, or at --spp; even where it is not reached, strata come in rounds of 256");
    flags.add("--target-error", "E",
              "stop when the estimated relMSE is surely below (95 %), or at --spp; "
              "implies --replicates 4",
              [&options](const std::string& flag, const std::string& text) {
                  options.targetError =
                      parseReal(flag, text, 1e-30, 1e30, "a relative squared error from 1e-30 to 1e30");
              });
    flags.addSeconds("--save-every", options.saveEvery, "write a checkpoint every so often");
    flags.addFile("--checkpoint", "F.rtc", options.checkpoint, "its file, also written at the end; OUTPUT.rtc");
    flags.addFile("--resume", "F.rtc", options.resume, "go on from a checkpoint as if never stopped")
        ->configurable(false);
}

void addProcessor(FlagSet& flags, ParsedFlags& parsed) {
    flags.group("Machine");
    flags.addWhole("--threads", parsed.options.threads, 0, kMaxThreads, "0: all; RT_THREADS")->default_str("0");
    flags.readEnvironment("--threads", "RT_THREADS");
    flags.addChoice("--policy", kPolicies, parsed.options.policy, "std::execution policy");
    flags.add("--engine", "multi|single", "single: short for --policy seq",
              [&parsed](const std::string& flag, const std::string& text) {
                  if (text != "multi" && text != "single") refuseValue(flag, text, "multi or single");
                  parsed.engine = text;
              });
    flags.addSwitch("--validation", parsed.options.validation,
                    "check every Vulkan call of the window; a message makes exit code 1");
    for (const char* flag : {"--device", "--list-devices"}) flags.refuse(flag, "a flag of ray-tracing-gpu");
}

void addDevice(FlagSet& flags, ParsedFlags& parsed) {
    flags.group("Machine");
    flags.add("--device", "N|TEXT", "Vulkan device by index or part of its name; RT_DEVICE",
              [&parsed](const std::string& flag, const std::string& text) {
                  if (text.empty()) refuseValue(flag, text, "an index of --list-devices or part of a name");
                  parsed.options.device = text;
              });
    flags.readEnvironment("--device", "RT_DEVICE");
    flags.addSwitch("--list-devices", parsed.listDevices, "print devices, and why one is unsuitable, and exit")
        ->configurable(false);
    flags.addSwitch("--validation", parsed.options.validation, "check every Vulkan call; a message makes exit code 1");
    flags.addChoice("--engine", kGpuEngines, parsed.options.gpuEngine,
                    "Vulkan's ray tracing pipeline, or compute shaders, with a tree of our own or with ray queries; "
                    "auto: the fastest, by measurement");
    for (const char* flag : {"--threads", "--policy"}) flags.refuse(flag, "a flag of ray-tracing-cpu");
}

void addProgram(FlagSet& flags, ParsedFlags& parsed) {
    flags.group("Program");
    flags.addSwitch("--headless", parsed.headless, "no window; implied by --output, --stats and --time-limit");
    flags.addSwitch(
        "--window", parsed.window,
        "a window, which is the default, even with --output, --stats, --time-limit: files are written when the "
        "first render ends or the window closes, images again by F12");
    flags.addSwitch("--quiet,-q", parsed.options.quiet, "no progress");
    flags.addSeconds("--progress-every", parsed.options.progressEvery,
                     "between two lines of progress where standard error is no terminal; 10");
    flags.addSwitch("--verbose,-v", parsed.options.verbose, "log more; RT_LOG=trace|debug|info|warn|error|off");
    flags.addFile("--log-file", "F", parsed.options.logFile, "write the log to a file as well");
}

// ---- what goes together --------------------------------------------------------------------------------------------

void settleCommand(const FlagSet& flags, ParsedFlags& parsed) {
    Options& options = parsed.options;
    if (options.json && !parsed.listScenes) throw UsageError("--json: only with --list-scenes");
    if (parsed.listScenes && !options.exportFile.empty()) throw UsageError("--export-scene: contradicts --list-scenes");
    if (parsed.listScenes) options.command = Command::ListScenes;
    if (!options.exportFile.empty()) options.command = Command::ExportScene;
    if (parsed.listDevices) options.command = Command::ListDevices;
    if (options.command != Command::Render) return;
    if (parsed.headless && parsed.window) throw UsageError("--window: contradicts --headless");
    const bool implied = options.isScripted || !options.outputs.empty() || flags.given("--stats") ||
                         flags.given("--time-limit") || options.tiles;
    options.window = parsed.window || (!parsed.headless && !implied);
    if (!options.window) return;
    for (const char* flag : {"--checkpoint", "--resume", "--save-every", "--region", "--tiles"})
        if (flags.given(flag)) throw UsageError(std::string(flag) + ": not with a window; use --headless");
}

void settleDenoise(const FlagSet& flags, ParsedFlags& parsed) {
    Options& options = parsed.options;
    const bool hasPicture = options.isScripted || !options.outputs.empty();
    const bool canDenoise = !options.window && !options.tiles && hasPicture && options.settings.spp >= 2;
    // What a configuration file says of all renders holds for those that can.
    if (flags.isFromFile("--denoise") && !canDenoise)
        parsed.denoise = options.denoisedOnly = options.denoisesByOidn = false;
    if (parsed.denoise && !options.wants(Aov::Denoised)) options.aovs.push_back(Aov::Denoised);
    if (options.denoisedOnly && options.wants(Aov::Denoised))
        throw UsageError("--denoise only: is the output itself; not with --aov denoised");
    if (!options.denoises()) return;
    if (options.window) throw UsageError("--denoise: not with a window; use --headless");
    if (options.tiles)
        throw UsageError("--denoise: not with --tiles; ray-tracing-image denoise takes the checkpoint that they make");
    if (!hasPicture) throw UsageError("--denoise: needs --output");
    if (!options.denoisesByOidn) return;
    if (options.targetError) throw UsageError("--denoise oidn: not with --target-error: it does not tell its error");
    if (options.wants(Aov::DenoisedError))
        throw UsageError("--denoise oidn: not with --aov denoised-error: it does not tell its error");
}

// Replicates and second moments that somebody reads; whether the number of samples is known in advance.
void settleErrorEstimate(Options& options) {
    RenderSettings& settings = options.settings;
    if (options.targetError) settings.replicates = std::max(settings.replicates, kErrorReplicates);
    if (settings.adaptive && settings.sampler == SamplerKind::Stratified)
        throw UsageError(
            "--adaptive on: not with --sampler stratified, whose strata are made for one number of samples");
    if (isAdaptive(settings) && settings.replicates > 1 && settings.replicates % 2 != 0)
        throw UsageError("--replicates " + std::to_string(settings.replicates) +
                         ": must be even with --adaptive on, which makes two halves of them");
    if (options.denoises()) {
        if (settings.spp < 2) throw UsageError("--denoise: needs two halves of the samples: --spp 2 or more");
        settings.replicates = std::max(settings.replicates + settings.replicates % 2, 2u);
    }
    settleReplicates(settings);
    if (settings.replicates > settings.spp)
        throw UsageError("--replicates " + std::to_string(settings.replicates) + ": must be at most --spp " +
                         std::to_string(settings.spp));
    const bool read = options.isScripted || !options.stats.empty() || options.wants(Aov::Variance);
    settings.secondMoments = read && settings.replicates < 2; // otherwise the replicates tell
    settings.sppIsKnown = !options.timeLimit && !options.targetError;
}

void settleFiles(Options& options) {
    if (!options.aovs.empty() && options.outputs.empty() && !options.isScripted)
        throw UsageError("--aov: needs --output");
    if (options.settings.adaptive && (options.region || options.tiles))
        throw UsageError(
            "--adaptive on: not with --region or --tiles, as its plan needs a pilot of the whole image; mpirun shares "
            "that out too");
    if (options.targetError && (options.region || options.tiles))
        throw UsageError("--target-error: is that of a whole image; not with --region or --tiles");
    if ((!options.saveEvery && !options.tiles) || !options.checkpoint.empty()) return;
    if (!options.resume.empty())
        options.checkpoint = options.resume;
    else if (!options.outputs.empty())
        options.checkpoint = checkpointBeside(options.outputs.front());
    else
        throw UsageError((options.tiles ? "--tiles" : "--save-every") +
                         std::string(": needs --checkpoint or --output"));
}

void settlePolicy(const FlagSet& flags, ParsedFlags& parsed) {
    Policy& policy = parsed.options.policy;
    if (parsed.engine.empty()) return;
    const bool single = parsed.engine == "single";
    if (flags.given("--policy") && single != (policy == Policy::Seq))
        throw UsageError("--policy " + nameOf(kPolicies, policy) + ": contradicts --engine " + parsed.engine);
    if (single) policy = Policy::Seq;
}

void settleValidation(const ParsedFlags& parsed) {
    const Options& options = parsed.options;
    if (options.program != kGpuProgram && options.validation && !options.window)
        throw UsageError("--validation: a flag of ray-tracing-gpu, or of a window");
}

} // namespace

OptionParser::OptionParser(const std::string& program, bool isScripted)
    : program_(program),
      isScripted_(isScripted),
      parsed_(std::make_unique<ParsedFlags>()),
      flags_(std::make_unique<FlagSet>(program, std::string("Path tracer on the ") +
                                                    (program == kGpuProgram ? "GPU" : "CPU") +
                                                    ". Any two of --width, --height, --aspect give the size.")) {
    addScene(*flags_, *parsed_);
    addMotion(*flags_, parsed_->options);
    addImage(*flags_, parsed_->options);
    addPart(*flags_, parsed_->options);
    addEstimator(*flags_, parsed_->options.settings);
    addOutput(*flags_, *parsed_);
    addDuration(*flags_, parsed_->options);
    program == kGpuProgram ? addDevice(*flags_, *parsed_) : addProcessor(*flags_, *parsed_);
    addProgram(*flags_, *parsed_);
    describeProgram(*flags_, program);
}

OptionParser::~OptionParser() = default;

manual::Page OptionParser::page() const {
    return flags_->page();
}

std::optional<Options> OptionParser::parse(std::vector<std::string> arguments, std::ostream& out) {
    ParsedFlags& parsed = *parsed_;
    const FlagSet& flags = *flags_;
    parsed = {};
    parsed.options.program = program_;
    parsed.options.isScripted = isScripted_;
    if (!flags_->parse(std::move(arguments), out)) return std::nullopt;

    parsed.options.keepsUserFiles = !flags.given("--no-config");
    settleCommand(flags, parsed);
    settleDenoise(flags, parsed);
    settleErrorEstimate(parsed.options);
    settleFiles(parsed.options);
    settleShutter(parsed.options);
    settleFrames(flags, parsed.options);
    settlePolicy(flags, parsed);
    settleValidation(parsed);
    const auto note = [&](const std::string& flag) {
        if (flags.given(flag)) parsed.options.given.insert(flag);
    };
    for (const char* flag : kStoredFlags) note(flag);
    forEachMethod([&note](const char* key, const char*, const char*, const auto&, const auto&) { note(flagOf(key)); },
                  parsed.options.settings);
    return parsed.options;
}

std::optional<Options> parseOptions(const std::string& program, std::vector<std::string> arguments, std::ostream& out) {
    return OptionParser(program).parse(std::move(arguments), out);
}

std::string checkpointBeside(const std::string& output) {
    return output + ".rtc";
}

} // namespace rt::app
