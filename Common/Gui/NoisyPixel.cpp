#include "Common/Gui/NoisyPixel.h"

#include <algorithm>

#include "Common/Gui/Gui.h"
#include "Common/Gui/PicturePlaces.h"

namespace rt::gui {
namespace {

constexpr ImU32 kNoisyColor = IM_COL32(255, 230, 90, 255), kLineShadow = IM_COL32(0, 0, 0, 150);
constexpr float kHiddenOpacity = 0.35f, kOthersOpacity = 0.25f; // of what is hidden, and beside a path that is chosen
constexpr float kEndRadius = 4;                                 // in the window's units

std::shared_ptr<const probe::PathsState> shownState(const Gui& gui) {
    const auto state = gui.paths.state();
    const bool isShown = gui.noise.isShown && gui.noise.point && state && state->whyNot.empty();
    return isShown && gui.state.picture.image ? state : nullptr;
}

std::optional<ImVec2> noisyMark(const Gui& gui, const Rect& image) {
    const auto state = shownState(gui);
    if (!state || !state->result.result.position) return std::nullopt;
    return placeInWindow(gui, glm::dvec3(*state->result.result.position), image);
}

struct LineStyle {
    probe::Technique technique;
    float opacity;
    bool isChosen;
};

void drawPieces(ImDrawList& list, const app::ViewProjection& view, const Rect& image, const probe::PathLine& line,
                const LineStyle& style) {
    for (const bool isShadow : {true, false})
        for (const probe::PathPiece& piece : line.pieces) {
            if (isShadow && piece.isHidden) continue;
            const auto seen = view.line(glm::dvec3(piece.from), glm::dvec3(piece.to));
            if (!seen) continue;
            const float opacity = style.opacity * (piece.isHidden ? kHiddenOpacity : 1.0f);
            const float thickness = (piece.isHidden ? 1.0f : 1.8f) + (style.isChosen ? 1.0f : 0.0f);
            list.AddLine(inWindow(seen->first, image), inWindow(seen->second, image),
                         isShadow ? kLineShadow : techniqueColor(style.technique, opacity),
                         isShadow ? thickness + 2.0f : thickness);
        }
}

void drawEnds(ImDrawList& list, const Gui& gui, const Rect& image, const probe::FoundLight& found,
              const LineStyle& style) {
    const ImU32 color = techniqueColor(style.technique, style.opacity);
    if (found.bounces > 0)
        if (const auto begin = placeInWindow(gui, glm::dvec3(found.line[1].position), image))
            list.AddCircle(*begin, kEndRadius, color, 0, 1.5f);
    if (const auto end = placeInWindow(gui, glm::dvec3(found.line.back().position), image)) {
        list.AddCircleFilled(*end, kEndRadius, kLineShadow);
        list.AddCircleFilled(*end, kEndRadius - 1, color);
    }
}

} // namespace

ImU32 techniqueColor(probe::Technique technique, float opacity) {
    const probe::TechniqueColor color = probe::colorOf(technique);
    return IM_COL32(color.r, color.g, color.b, static_cast<int>(255 * std::clamp(opacity, 0.0f, 1.0f)));
}

probe::PathsWish noiseWishAt(Gui& gui, const PickedPixel& point) {
    NoisyPixel& noise = gui.noise;
    if (!noise.rendering || !gui.isHeld)
        noise.rendering = gui.state.settings; // while something is held there are drafts
    probe::PathsWish wish;
    wish.scene = gui.state.scene;
    wish.rendering = *noise.rendering;
    wish.camera = point.camera;
    const std::array<std::uint32_t, 2> size{wish.rendering.width, wish.rendering.height};
    for (std::size_t i = 0; i < 2; ++i) { // of the film, whatever was shown when it was picked
        const double place = (point.pixel[i] + 0.5) / std::max(point.size[i], 1u);
        wish.pixel[i] = std::min(static_cast<std::uint32_t>(place * size[i]), size[i] - 1);
    }
    wish.settings = noise.settings;
    wish.eye = gui.camera.camera().lookFrom;
    return wish;
}

void followNoisyPixel(Gui& gui) {
    if (!followPicker(gui, gui.noise)) {
        gui.paths.wish(std::nullopt);
        gui.noise.rendering.reset();
    }
}

bool holdNoisyPixel(Gui& gui, bool isInside, const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    if (!holdPoint(gui, gui.noise, noisyMark(gui, gui.shownImage), isInside, pixel)) return false;
    gui.noise.settings.selected.reset(); // of another pixel
    gui.noise.chosen.reset();
    return true;
}

void drawNoisyPixel(const Gui& gui, const Rect& image, const Rect& area) {
    const auto state = shownState(gui);
    if (!state) return;
    const NoisyPixel& noise = gui.noise;
    const auto& paths = state->result.paths();
    std::optional<std::size_t> chosen = noise.hovered ? noise.hovered : noise.chosen;
    if (chosen && *chosen >= paths.size()) chosen.reset(); // of an answer before
    const app::ViewProjection view = projectionOf(gui);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    if (noise.drawsPaths)
        for (auto line = state->result.lines.rbegin(); line != state->result.lines.rend(); ++line) { // brightest on top
            const probe::FoundLight& found = paths[line->path].found;
            const bool isChosen = chosen == line->path;
            const LineStyle style{found.technique, isChosen || !chosen ? 1.0f : kOthersOpacity, isChosen};
            drawPieces(list, view, image, *line, style);
            drawEnds(list, gui, image, found, style);
        }
    list.PopClipRect();
    if (const auto mark = noisyMark(gui, image)) drawPointMark(*mark, area, kNoisyColor);
}

} // namespace rt::gui
