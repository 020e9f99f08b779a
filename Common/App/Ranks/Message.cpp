#include "Common/App/Ranks/Message.h"

#include <cstring>
#include <utility>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

// Tiles, JSON, and this.
struct Tail {
    MessageKind kind = MessageKind::End;
    std::uint32_t jsonBytes = 0;
};

} // namespace

Message failureMessage(const std::exception& error) {
    const auto* const known = dynamic_cast<const Error*>(&error);
    const ExitCode code = known != nullptr ? known->code() : ExitCode::Failure;
    return {MessageKind::Failure, {{"code", static_cast<int>(code)}, {"what", error.what()}}, {}};
}

Bytes toBytes(Message message) {
    const std::string json = message.fields.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const Tail tail{message.kind, static_cast<std::uint32_t>(json.size())};
    Bytes bytes = std::move(message.tiles);
    const std::size_t tiles = bytes.size();
    bytes.resize(tiles + json.size() + sizeof tail);
    std::memcpy(bytes.data() + tiles, json.data(), json.size());
    std::memcpy(bytes.data() + tiles + json.size(), &tail, sizeof tail);
    return bytes;
}

Message toMessage(Bytes bytes) {
    Tail tail;
    const auto fail = [] { throw RenderError("a message of another rank is damaged"); };
    if (bytes.size() < sizeof tail) fail();
    const std::size_t end = bytes.size() - sizeof tail;
    std::memcpy(&tail, bytes.data() + end, sizeof tail);
    if (end < tail.jsonBytes) fail();
    const char* const json = reinterpret_cast<const char*>(bytes.data() + end - tail.jsonBytes);
    Message message{tail.kind, nlohmann::json::parse(json, json + tail.jsonBytes), {}};
    bytes.resize(end - tail.jsonBytes);
    message.tiles = std::move(bytes);
    return message;
}

nlohmann::json toJson(const EngineReport& report) {
    const RayCounts& rays = report.rays;
    const shared::Features& features = report.features;
    return {{"engine", report.engine},
            {"device", report.device},
            {"is_software", report.isSoftware},
            {"kernel", report.kernel},
            {"threads", report.threads},
            {"features", {features.scene, features.materials, features.methods}},
            {"accel_build", report.accelBuildSeconds},
            {"pipeline", report.pipelineSeconds},
            {"render_device", report.renderDeviceSeconds},
            {"longest_dispatch", report.longestDispatchSeconds},
            {"rays", {rays.camera, rays.scattered, rays.shadow, rays.edge, rays.reuse}},
            {"nonfinite", report.nonfiniteSamples},
            {"cut_off", report.cutOff},
            {"device_bytes", report.deviceBytes},
            {"light_sampling", report.lightSampling}};
}

EngineReport toReport(const nlohmann::json& json) {
    EngineReport report;
    report.engine = json.at("engine");
    report.device = json.at("device");
    report.isSoftware = json.at("is_software");
    report.kernel = json.at("kernel");
    report.threads = json.at("threads");
    const nlohmann::json& features = json.at("features");
    report.features = {features.at(0), features.at(1), features.at(2)};
    report.accelBuildSeconds = json.at("accel_build");
    report.pipelineSeconds = json.at("pipeline");
    report.renderDeviceSeconds = json.at("render_device");
    report.longestDispatchSeconds = json.at("longest_dispatch");
    const nlohmann::json& rays = json.at("rays");
    report.rays = {rays.at(0), rays.at(1), rays.at(2), rays.at(3), rays.at(4)};
    report.nonfiniteSamples = json.at("nonfinite");
    report.cutOff = json.at("cut_off");
    report.deviceBytes = json.at("device_bytes");
    report.lightSampling = json.at("light_sampling");
    return report;
}

} // namespace rt::app
