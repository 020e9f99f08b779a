#include "Common/App/Interactive/GuiSettings.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "Common/Core/AtomicFile.h"
#include "Common/Image/Film.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSettingsVersion = 1;

// Reads members of an object; leaves a target alone where the value is missing, of another type or out of range.
class Reader {
  public:
    explicit Reader(const nlohmann::json& json) : json_(json) {}

    void read(const char* key, bool& target) const {
        if (const auto* value = find(key); value != nullptr && value->is_boolean()) target = *value;
    }
    void read(const char* key, std::string& target) const {
        if (const auto* value = find(key); value != nullptr && value->is_string()) target = *value;
    }
    template <class T>
    void read(const char* key, T& target, double min, double max) const {
        const auto* value = find(key);
        if (value == nullptr || !value->is_number()) return;
        const double number = *value;
        if (number >= min && number <= max) target = static_cast<T>(number);
    }
    template <class E, std::size_t N>
    void read(const char* key, const Named<E> (&table)[N], E& target) const {
        std::string name;
        read(key, name);
        for (const auto& row : table)
            if (row.name == name) target = row.value;
    }
    const nlohmann::json* find(const char* key) const {
        if (!json_.is_object()) return nullptr;
        const auto at = json_.find(key);
        return at == json_.end() ? nullptr : &*at;
    }

  private:
    const nlohmann::json& json_;
};

void readRequest(const Reader& reader, RenderRequest& request) {
    RenderSettings& s = request.settings;
    reader.read("spp", s.spp, 1, 0x7fffffff);
    reader.read("max_depth", s.maxDepth, 1, 4096);
    reader.read("seed", s.seed, 0, 4294967295.0);
    reader.read("replicates", s.replicates, 1, 1024);
    forEachMethod([&reader](const char* key, const char*, const char*, const auto& table,
                            auto& value) { reader.read(key, table, value); },
                  s);
    reader.read("russian_roulette", s.russianRoulette);
    std::uint32_t width = 0;
    reader.read("width", width, 1, image::kMaxImageSide);
    if (width > 0) request.size.width = width;
    double aspect = 0;
    reader.read("aspect", aspect, 1.0 / image::kMaxImageSide, image::kMaxImageSide);
    if (aspect > 0) request.size.aspect = aspect;
    reader.read("one_sided_lights", request.oneSidedLights);
    reader.read("accumulate", request.accumulate);
    reader.read("samples_per_frame", request.samplesPerFrame, 0, 65536);
    reader.read("loop", request.loop);
    double seconds = 0, error = 0;
    reader.read("time_limit", seconds, 0, 1e9);
    if (seconds > 0) request.timeLimit = seconds;
    reader.read("target_error", error, 0, 1e9);
    if (error > 0) request.targetError = error;
}

Json toJson(const RenderRequest& request) {
    const RenderSettings& s = request.settings;
    Json json{{"spp", s.spp},
              {"max_depth", s.maxDepth},
              {"seed", s.seed},
              {"replicates", s.replicates},
              {"russian_roulette", s.russianRoulette},
              {"one_sided_lights", request.oneSidedLights},
              {"accumulate", request.accumulate},
              {"samples_per_frame", request.samplesPerFrame},
              {"loop", request.loop}};
    forEachMethod([&json](const char* key, const char*, const char*, const auto& table,
                          const auto& value) { json[key] = nameOf(table, value); },
                  s);
    if (request.timeLimit) json["time_limit"] = *request.timeLimit;
    if (request.targetError) json["target_error"] = *request.targetError;
    if (request.size.width) json["width"] = *request.size.width;
    if (request.size.aspect) json["aspect"] = *request.size.aspect;
    return json;
}

void readViewport(const Reader& reader, ViewportSettings& viewport) {
    reader.read("ray_tracing", viewport.rayTracing);
    reader.read("denoise", viewport.denoise);
    reader.read("auto_exposure", viewport.autoExposure);
    reader.read("exposure", viewport.exposure, -100, 100);
    reader.read("tonemap", kTonemaps, viewport.tonemap);
    if (const auto* render = reader.find("render"); render != nullptr) readRequest(Reader(*render), viewport.request);
    if (const auto* engine = reader.find("engine"); engine != nullptr) {
        const Reader e(*engine);
        e.read("kind", kGpuEngines, viewport.engine.kind);
        e.read("device", viewport.engine.device);
        e.read("policy", kPolicies, viewport.engine.policy);
        e.read("threads", viewport.engine.threads, 0, 4096);
    }
}

Json toJson(const ViewportSettings& v) {
    return {{"ray_tracing", v.rayTracing},
            {"denoise", v.denoise},
            {"auto_exposure", v.autoExposure},
            {"exposure", v.exposure},
            {"tonemap", nameOf(kTonemaps, v.tonemap)},
            {"render", toJson(v.request)},
            {"engine",
             {{"kind", nameOf(kGpuEngines, v.engine.kind)},
              {"device", v.engine.device},
              {"policy", nameOf(kPolicies, v.engine.policy)},
              {"threads", v.engine.threads}}}};
}

// As many as there may be, or one.
void readViewports(const Reader& reader, GuiSettings& settings) {
    const auto* viewports = reader.find("viewports");
    if (viewports == nullptr || !viewports->is_array()) return;
    const std::size_t count = viewports->size();
    if (count < 2 ||
        std::find(std::begin(kViewportCounts), std::end(kViewportCounts), count) == std::end(kViewportCounts))
        return;
    for (const nlohmann::json& viewport : *viewports) readViewport(Reader(viewport), settings.viewports.emplace_back());
    reader.read("focused_viewport", settings.focusedViewport, 0, static_cast<double>(count - 1));
}

// What is on or off in a window, its key in the file.
template <typename Visit, typename Settings>
void forEachToggle(const Visit& visit, Settings& settings) {
    visit("window_placed", settings.windowPlaced);
    visit("window_maximised", settings.windowMaximised);
    visit("show_race", settings.showRace);
    visit("show_panels", settings.showPanels);
    visit("show_comparison", settings.showComparison);
    visit("show_statistics", settings.showStatistics);
    visit("reload_scenes", settings.reloadScenes);
    visit("saw_first_steps", settings.sawFirstSteps);
    visit("link_cameras", settings.linkCameras);
    visit("show_gizmo", settings.showGizmo);
    visit("local_axes", settings.localAxes);
}

} // namespace

void GuiSettings::addRecent(const std::string& file) {
    removeRecent(file);
    recent.insert(recent.begin(), file);
    if (recent.size() > kMaxRecent) recent.resize(kMaxRecent);
}
void GuiSettings::removeRecent(const std::string& file) {
    recent.erase(std::remove(recent.begin(), recent.end(), file), recent.end());
}

GuiSettings parseGuiSettings(std::string_view text) {
    GuiSettings settings;
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false); // discarded where it is no JSON
    const Reader reader(json);
    reader.read("color_mode", kColorModes, settings.colorMode);
    reader.read("save_choice", kSaveChoices, settings.saveChoice);
    reader.read("gizmo", kGizmos, settings.gizmo);
    reader.read("ui_scale", settings.uiScale, kMinUiScale, kMaxUiScale);
    reader.read("font", settings.font);
    forEachToggle([&reader](const char* key, bool& value) { reader.read(key, value); }, settings);
    constexpr double kFar = 100'000;
    reader.read("window_x", settings.windowX, -kFar, kFar);
    reader.read("window_y", settings.windowY, -kFar, kFar);
    reader.read("window_width", settings.windowWidth, 1, image::kMaxImageSide);
    reader.read("window_height", settings.windowHeight, 1, image::kMaxImageSide);
    if (const auto* panels = reader.find("open_panels"); panels != nullptr && panels->is_object()) {
        for (const auto& [id, isOpen] : panels->items())
            if (isOpen.is_boolean()) settings.openPanels[id] = isOpen;
    }
    reader.read("race_seconds", settings.raceSeconds, kMinRaceSeconds, kMaxRaceSeconds);
    readViewport(reader, settings);
    readViewports(reader, settings);
    reader.read("split_x", settings.splitX, kMinSplit, kMaxSplit);
    reader.read("split_y", settings.splitY, kMinSplit, kMaxSplit);
    reader.read("save_folder", settings.saveFolder);
    reader.read("scene", settings.scene);
    if (settings.scene.empty()) settings.scene = GuiSettings().scene;
    if (const auto* recent = reader.find("recent"); recent != nullptr && recent->is_array()) {
        for (const nlohmann::json& name : *recent)
            if (name.is_string() && settings.recent.size() < kMaxRecent) settings.recent.push_back(name);
    }
    return settings;
}

std::string toText(const GuiSettings& s) {
    Json json{{"version", kSettingsVersion},
              {"color_mode", nameOf(kColorModes, s.colorMode)},
              {"save_choice", nameOf(kSaveChoices, s.saveChoice)},
              {"gizmo", nameOf(kGizmos, s.gizmo)},
              {"ui_scale", s.uiScale},
              {"font", s.font},
              {"window_x", s.windowX},
              {"window_y", s.windowY},
              {"window_width", s.windowWidth},
              {"window_height", s.windowHeight},
              {"open_panels", s.openPanels},
              {"race_seconds", s.raceSeconds},
              {"focused_viewport", s.focusedViewport},
              {"split_x", s.splitX},
              {"split_y", s.splitY},
              {"save_folder", s.saveFolder},
              {"scene", s.scene},
              {"recent", s.recent}};
    json.update(toJson(static_cast<const ViewportSettings&>(s)));
    json["viewports"] = Json::array();
    for (const ViewportSettings& viewport : s.viewports) json["viewports"].push_back(toJson(viewport));
    forEachToggle([&json](const char* key, bool value) { json[key] = value; }, s);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

GuiSettings loadGuiSettings(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return parseGuiSettings(std::string(std::istreambuf_iterator<char>(in), {}));
}

void saveGuiSettings(const std::filesystem::path& file, const GuiSettings& settings) {
    std::error_code ignored; // opening the file tells
    std::filesystem::create_directories(file.parent_path(), ignored);
    AtomicFile target(file);
    target.stream() << toText(settings);
    target.commit();
}

void override(GuiSettings& settings, const Options& options) {
    const auto given = [&options](const char* flag) { return options.given.count(flag) > 0; };
    const auto take = [&](const char* flag, auto& target, const auto& value) {
        if (given(flag)) target = value;
    };
    RenderSettings& s = settings.request.settings;
    const RenderSettings& o = options.settings;
    take("--scene", settings.scene, options.scene);
    take("--spp", s.spp, o.spp);
    take("--max-depth", s.maxDepth, o.maxDepth);
    take("--seed", s.seed, o.seed);
    take("--replicates", s.replicates, o.replicates);
    forEachMethod([&](const char* key, const char*, const char*, const auto&, auto& target,
                      const auto& value) { take(flagOf(key).c_str(), target, value); },
                  s, o);
    take("--russian-roulette", s.russianRoulette, o.russianRoulette);
    take("--one-sided-lights", settings.request.oneSidedLights, options.oneSidedLights);
    // Files that the command line asks for look as they do without a window, and the window as the files.
    const bool asksForFiles = !options.outputs.empty();
    if (given("--exposure") || asksForFiles) {
        settings.exposure = options.exposure;
        settings.autoExposure = false;
    }
    if (given("--tonemap") || asksForFiles) settings.tonemap = options.tonemap;
    if (given("--width") || given("--height") || given("--aspect")) settings.request.size = options.size;
    s.features = o.features;
    take("--time-limit", settings.request.timeLimit, options.timeLimit);
    take("--target-error", settings.request.targetError, options.targetError);
    if (!options.device.empty()) settings.engine.device = options.device;
    take("--engine", settings.engine.kind, options.gpuEngine);
    if (given("--threads")) settings.engine.threads = options.threads;
    if (given("--policy") || given("--engine")) settings.engine.policy = options.policy;
}

} // namespace rt::app
