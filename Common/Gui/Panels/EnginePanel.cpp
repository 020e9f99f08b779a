#include "Common/Gui/Panels/EnginePanel.h"

#include <algorithm>
#include <string>
#include <thread>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::EngineChoice;
using app::EngineDevice;
using app::GpuEngineKind;
using Devices = std::vector<EngineDevice>;

Devices::const_iterator find(const Devices& devices, const std::string& request) {
    return std::find_if(devices.begin(), devices.end(), [&](const EngineDevice& d) { return d.request == request; });
}

// Whether the device of the choice, which may be any, has this engine. One that was named in another way may.
bool mayHave(GpuEngineKind kind, const EngineChoice& choice, const Devices& devices) {
    if (kind == GpuEngineKind::Auto || kind == GpuEngineKind::Compute) return true; // all have
    const auto has = [kind](const EngineDevice& d) {
        return std::find(d.engines.begin(), d.engines.end(), kind) != d.engines.end();
    };
    if (const auto device = find(devices, choice.device); device != devices.end()) return has(*device);
    return std::any_of(devices.begin(), devices.end(), has);
}

void drawProcessor(EngineChoice& engine, std::uint32_t threads) {
    markNextRow(engine.policy != EngineChoice().policy);
    combo("Engine", "std::execution policy that the workers run under", app::kPolicies, engine.policy);
    const Disabled rest(engine.policy == app::Policy::Seq, "one core has one thread");
    markNextRow(engine.threads != EngineChoice().threads);
    const std::string automatic = "Auto (" + std::to_string(threads) + ")";
    inputCount("Threads", "0: as many as the processor has", engine.threads, 0, 1024, 1, automatic.c_str());
}

void drawKind(EngineChoice& engine, const app::SessionState& state, const Devices& devices) {
    markNextRow(engine.kind != EngineChoice().kind);
    row("Engine",
        "How rays are traced: through the device's ray tracing pipeline, or in compute shaders, through a tree of our "
        "own or by ray queries. Automatic takes the one that is measured to be the fastest for such a scene. The "
        "picture is the same");
    std::string shown = app::titleOf(app::kGpuEngines, engine.kind);
    const bool isKnown = state.engine == engine && !state.report.engine.empty();
    if (engine.kind == GpuEngineKind::Auto && isKnown) shown += " (" + state.report.engine + ")";
    if (!ImGui::BeginCombo("##engine", shown.c_str())) return explainDisabled();
    for (const auto& row : app::kGpuEngines) {
        if (!mayHave(row.value, engine, devices)) continue;
        if (ImGui::Selectable(row.title, row.value == engine.kind)) engine.kind = row.value;
        if (row.value == engine.kind) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
}

void drawDevice(EngineChoice& engine, const Devices& devices) {
    markNextRow(!engine.device.empty());
    row("Device", "Vulkan devices that can render");
    const auto current = find(devices, engine.device);
    const std::string shown = engine.device.empty()      ? "Best suitable"
                              : current != devices.end() ? current->name
                                                         : engine.device;
    if (!ImGui::BeginCombo("##device", shown.c_str())) return;
    const auto choose = [&](const std::string& name, const std::string& request) {
        ImGui::PushID(request.c_str());
        if (ImGui::Selectable(name.c_str(), request == engine.device)) {
            engine.device = request;
            if (!mayHave(engine.kind, engine, devices)) engine.kind = GpuEngineKind::Auto;
        }
        ImGui::PopID();
    };
    choose("Best suitable", "");
    for (const EngineDevice& device : devices)
        choose(device.name + (device.isSoftware ? " (software)" : ""), device.request);
    ImGui::EndCombo();
}

} // namespace

EngineChoice servedChoice(EngineChoice choice, const Devices& devices, const app::Options& options) {
    if (options.device.empty() && find(devices, choice.device) == devices.end()) choice.device.clear();
    const bool isAsked = options.given.count("--engine") > 0;
    if (!isAsked && !mayHave(choice.kind, choice, devices)) choice.kind = GpuEngineKind::Auto;
    return choice;
}

void drawEnginePanel(Gui& gui) {
    EngineChoice& engine = gui.settings.engine;
    if (!gui.isGpu) {
        drawProcessor(engine, std::max(1u, std::thread::hardware_concurrency()));
        return drawErrorOf(gui, app::ErrorSource::Engine);
    }
    {
        const Disabled rest(gui.state.picture.isPreview,
                            "the preview is rasterised"); // which is rasterised whatever traces rays
        drawKind(engine, gui.state, gui.devices);
    }
    drawDevice(engine, gui.devices);
    drawErrorOf(gui, app::ErrorSource::Engine);
    const Disabled rest(!gui.state.canPreview, "this device draws no preview");
    checkbox("Enable ray tracing",
             "Off: the scene as it is drawn by rasterisation, at once, lit without shadows. Rays rest meanwhile (P)",
             gui.settings.rayTracing);
}

} // namespace rt::gui
