#include "Common/Gui/PanelImage.h"

#include <algorithm>
#include <cmath>

namespace rt::gui {

PanelImage::~PanelImage() {
    vkDeviceWaitIdle(device_.device());
}

bool PanelImage::Tile::operator==(const Tile& other) const {
    return owner == other.owner && corner.x == other.corner.x && corner.y == other.corner.y && size.x == other.size.x &&
           size.y == other.size.y && pixels == other.pixels && firstRow == other.firstRow;
}

bool PanelImage::takeChange() {
    const bool isSame = !newImage_ && tiles_ == drawn_;
    drawn_ = tiles_;
    return !isSame;
}

void PanelImage::upload(VkCommandBuffer commands, std::uint32_t frame) {
    if (!newImage_) return;
    pass_.upload(commands, frame, FilmPass::Slot::Picture, *newImage_);
    newImage_.reset();
}

void PanelImage::draw(const ImVec2& corner, const ImVec2& size, std::uint32_t pixels, std::uint32_t firstRow) {
    tiles_.push_back({this, corner, size, pixels, firstRow});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCallback(
        [](const ImDrawList*, const ImDrawCmd* command) {
            const Tile& tile = *static_cast<const Tile*>(command->UserCallbackData);
            tile.owner->record(tile, command->ClipRect);
        },
        &tiles_.back());
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

void PanelImage::record(const Tile& tile, const ImVec4& clip) const {
    const ImDrawData* data = ImGui::GetDrawData();
    const ImVec2 origin = data->DisplayPos, pixels = data->FramebufferScale;
    const float width = data->DisplaySize.x * pixels.x, height = data->DisplaySize.y * pixels.y;
    const float x = std::round((tile.corner.x - origin.x) * pixels.x);
    const float y = std::round((tile.corner.y - origin.y) * pixels.y);
    const float across = std::round(tile.size.x * pixels.x), down = std::round(tile.size.y * pixels.y);
    const float left = std::max({x, (clip.x - origin.x) * pixels.x, 0.0f});
    const float top = std::max({y, (clip.y - origin.y) * pixels.y, 0.0f});
    const float right = std::min({x + across, (clip.z - origin.x) * pixels.x, width});
    const float bottom = std::min({y + down, (clip.w - origin.y) * pixels.y, height});
    if (!(right - left >= 1 && bottom - top >= 1)) return;
    PresentConstants constants;
    constants.scale = across / static_cast<float>(tile.pixels);
    constants.originX = x;
    constants.flags = kSmooth;
    constants.originY = y - static_cast<float>(tile.firstRow) * constants.scale;
    const VkRect2D scissor{{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)},
                           {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}};
    pass_.draw(commands_, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}, constants, scissor);
}

} // namespace rt::gui
