#include "Common/Gui/Panels/SamplerMap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "Common/Core/Format.h"
#include "Common/Gui/Widgets.h"
#include "Common/Probe/ProbePicture.h"
#include "Common/Shared/Tonemap.h"

namespace rt::gui {
namespace {

constexpr float kMostHeight = 19;         // in heights of the font
constexpr std::uint32_t kImageRows = 256; // of the image, which is larger than most maps
constexpr ImU32 kEdgeColor = IM_COL32(60, 200, 180, 150), kRoundShadow = IM_COL32(0, 0, 0, 200);
constexpr ImU32 kByLights = IM_COL32(255, 140, 30, 255), kByBsdf = IM_COL32(90, 170, 255, 255);

// Where the map lies, in the window's units.
struct Plane {
    ImVec2 corner, size;
    ImVec2 at(const glm::dvec2& place) const {
        return {corner.x + static_cast<float>(place.x) * size.x, corner.y + static_cast<float>(place.y) * size.y};
    }
};

const char* unitOf(probe::Quantity quantity) {
    switch (quantity) {
        case probe::Quantity::Density:
            return "density per steradian";
        case probe::Quantity::Radiance:
            return "radiance (luminance)";
        case probe::Quantity::Product:
            return "radiance * BSDF * cosine";
        case probe::Quantity::Weight:
            break;
    }
    return "MIS weight";
}

std::string valueText(double value) {
    return formatted("%.3g", value);
}

void drawSample(ImDrawList& list, const ImVec2& place, bool isByBsdf) {
    list.AddCircleFilled(place, 2.5f, kRoundShadow, 6);
    list.AddCircleFilled(place, 1.5f, isByBsdf ? kByBsdf : kByLights, 6);
}

void drawEdges(ImDrawList& list, const Plane& plane, const probe::ProbeResult& result, const probe::DirectionMap& map) {
    for (const auto& line : result.edges) {
        std::optional<glm::dvec2> before;
        for (const shared::vec3& direction : line) {
            const auto place = map.placeOf(direction);
            const bool isAcross = place && before && std::abs(place->x - before->x) > 0.5; // the seam of the azimuth
            if (place && before && !isAcross) list.AddLine(plane.at(*before), plane.at(*place), kEdgeColor);
            before = place;
        }
    }
}

void drawUnitSquare(ImDrawList& list, const Plane& plane, const Gui& gui, const probe::ProbeResult& result) {
    list.AddRectFilled(plane.corner, plane.at({1, 1}), ImGui::GetColorU32(ImGuiCol_FrameBg));
    const std::uint32_t cells = result.settings.numbers.strata;
    if (result.settings.showsStrata)
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const double share = static_cast<double>(i) / cells;
            list.AddLine(plane.at({share, 0}), plane.at({share, 1}), kEdgeColor);
            list.AddLine(plane.at({0, share}), plane.at({1, share}), kEdgeColor);
        }
    if (!gui.sampling.showsSamples) return;
    for (const probe::Drawn& drawn : result.shown) drawSample(list, plane.at(glm::dvec2(drawn.place)), drawn.isByBsdf);
}

void drawDirections(Gui& gui, ImDrawList& list, const Plane& plane, const probe::ProbeState& state) {
    const probe::DirectionMap& map = state.result.maps.front();
    SamplerView& sampling = gui.sampling;
    const std::uint32_t columns = kImageRows * map.width() / map.height;
    if (sampling.paintedSerial != state.serial || sampling.paintedScale != sampling.scale) {
        gui.probeImage.set(probe::paint(map, sampling.scale, columns, kImageRows));
        sampling.paintedSerial = state.serial;
        sampling.paintedScale = sampling.scale;
    }
    gui.probeImage.draw(plane.corner, plane.size, columns);
    list.PushClipRect(plane.corner, plane.at({1, 1}), true);
    drawEdges(list, plane, state.result, map);
    if (sampling.showsSamples)
        for (const probe::Drawn& drawn : state.result.shown)
            if (drawn.direction)
                if (const auto place = map.placeOf(*drawn.direction))
                    drawSample(list, plane.at(*place), drawn.isByBsdf);
    list.PopClipRect();
}

// What the map says under the pointer.
void drawMapTip(const Plane& plane, const probe::ProbeResult& result) {
    if (!ImGui::IsItemHovered()) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::dvec2 place((mouse.x - plane.corner.x) / plane.size.x, (mouse.y - plane.corner.y) / plane.size.y);
    const probe::DirectionMap& map = result.maps.front();
    const auto direction = map.directionOf(place);
    if (!direction) return;
    ImGui::SetTooltip("%.4g %s\ndirection %.3f %.3f %.3f", static_cast<double>(map.values[map.cellAt(place)]),
                      unitOf(result.settings.quantity), static_cast<double>(direction->x),
                      static_cast<double>(direction->y), static_cast<double>(direction->z));
}

// Brightness goes with the root of the value, so the middle stands for a quarter of the end.
void drawMapLegend(const probe::ProbeResult& result, float scale, float width) {
    constexpr int kSteps = 64;
    const float em = ImGui::GetFontSize(), height = 0.5f * em;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (int i = 0; i < kSteps; ++i) {
        const float grey = shared::srgbEncode((static_cast<float>(i) + 0.5f) / kSteps);
        const float left = corner.x + width * static_cast<float>(i) / kSteps;
        list.AddRectFilled({left, corner.y}, {left + width / kSteps, corner.y + height},
                           ImGui::ColorConvertFloat4ToU32({grey, grey, grey, 1}));
    }
    list.AddRect(corner, {corner.x + width, corner.y + height}, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    ImGui::Dummy({width, height});
    tooltip(unitOf(result.settings.quantity));
    const double most = result.maps.front().maximum() / scale;
    const std::string ends[] = {"0", valueText(most / 4), valueText(most)};
    const float left = ImGui::GetCursorPosX();
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine(left + 0.5f * static_cast<float>(i) * (width - textWidth(ends[i])));
        ImGui::TextUnformatted(ends[i].c_str());
    }
}

} // namespace

void drawSamplerMap(Gui& gui, const probe::ProbeState& state) {
    if (state.result.maps.empty()) return;
    const probe::DirectionMap& map = state.result.maps.front();
    const bool isSquare = gui.sampling.space == SampleSpace::UnitSquare;
    const float aspect = isSquare ? 1.0f : static_cast<float>(map.width()) / static_cast<float>(map.height);
    const float room = ImGui::GetContentRegionAvail().x;
    const float height = std::floor(std::min(room / aspect, kMostHeight * ImGui::GetFontSize()));
    const Plane plane{ImGui::GetCursorScreenPos(), {std::floor(height * aspect), height}};
    ImGui::InvisibleButton("##map", plane.size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (isSquare) return drawUnitSquare(list, plane, gui, state.result);
    drawMapTip(plane, state.result);
    drawDirections(gui, list, plane, state);
    drawMapLegend(state.result, gui.sampling.scale, plane.size.x);
}

} // namespace rt::gui
