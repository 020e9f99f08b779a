#include "RayTracingGPU/EngineRates.h"

#include <bit>
#include <cstdint>
#include <span>

#include <nlohmann/json.hpp>

#include "Common/Accel/GpuBvh.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Core/ReadFile.h"
#include "Common/Render/Names.h"

namespace rt::gpu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr std::uint64_t kLargestFile = 1u << 20;
constexpr std::size_t kMaxKeys = 1000; // a user's scenes hardly fall into so many classes

bool isEngine(const std::string& name) {
    for (const auto& row : app::kGpuEngines)
        if (row.name == name && row.value != app::GpuEngineKind::Auto) return true;
    return false;
}

// An object of objects of rates by engine; whatever the file holds else, an empty one.
Json readRates(const fs::path& file) {
    std::error_code ignored;
    if (file.empty() || !fs::is_regular_file(file, ignored)) return Json::object();
    try {
        const std::vector<std::byte> bytes = readFile(file, kLargestFile);
        const auto* const text = reinterpret_cast<const char*>(bytes.data());
        const Json json = Json::parse(text, text + bytes.size(), nullptr, false);
        if (json.is_object() && json.value("version", Json()) == kVersion && json.value("rates", Json()).is_object())
            return json["rates"];
    } catch (const Error&) {
    }
    return Json::object();
}

std::vector<app::EngineRate> ratesIn(const Json& all, const std::string& key) {
    std::vector<app::EngineRate> rates;
    const auto found = all.find(key);
    if (found == all.end() || !found->is_object()) return rates;
    for (const auto& [engine, rate] : found->items()) {
        if (!isEngine(engine) || !rate.is_number() || !(rate.get<double>() >= 0)) return {};
        rates.push_back({engine, rate.get<double>()});
    }
    return rates;
}

std::uint32_t sizeClass(const scene::CompiledScene& scene) {
    const std::size_t primitives = scene.spheres.size() + scene.quads.size() + scene.triangles.size() +
                                   scene.rounds.size() + scene.instances.size();
    if (scene.instances.empty() && primitives <= accel::GpuBvhSettings().maxLinear) return 0;
    return static_cast<std::uint32_t>(std::bit_width(primitives));
}

} // namespace

std::string ratesKey(const vulkan::VulkanContext& context, const scene::CompiledScene& scene) {
    const vulkan::DeviceLimits& limits = context.limits();
    const std::string device = std::to_string(limits.vendor) + ":" + std::to_string(limits.deviceId) + ":" +
                               context.info().name + ":" + context.info().driver;
    return hexText(hashBytes(std::as_bytes(std::span(device)))) + "-" + hexText(scene.features.scene) +
           hexText(scene.features.materials) + "-" + std::to_string(sizeClass(scene));
}

std::vector<app::EngineRate> EngineRates::find(const std::string& key) const {
    return ratesIn(readRates(file_), key);
}

std::vector<app::EngineRate> EngineRates::keep(const std::string& key,
                                               const std::vector<app::EngineRate>& rates) const {
    if (file_.empty()) return rates;
    Json all = readRates(file_);
    if (auto others = ratesIn(all, key); !others.empty()) return others;
    if (all.size() >= kMaxKeys) all = Json::object();
    Json own = Json::object();
    for (const app::EngineRate& rate : rates) own[rate.engine] = rate.raysPerSecond;
    all[key] = std::move(own);
    try {
        fs::create_directories(file_.parent_path());
        AtomicFile out(file_);
        out.stream() << Json{{"version", kVersion}, {"rates", std::move(all)}}.dump(1) << "\n";
        out.commit();
    } catch (const std::exception& error) {
        logDebug(std::string("the engines' rates were not saved: ") + error.what());
    }
    return rates;
}

fs::path engineRatesFile() {
    const fs::path folder = userCacheFolder();
    return folder.empty() ? folder : folder / "engine-rates.json";
}

} // namespace rt::gpu
