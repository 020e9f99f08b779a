#include "Common/Gui/Thumbnails.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Image/ImageIo.h"

namespace rt::gui {

namespace {

namespace fs = std::filesystem;

// By their names without ".png"; where several folders of assets have one of a name, that of the first.
std::map<std::string, fs::path> picturesOf(const std::string& folder) {
    std::map<std::string, fs::path> files;
    for (const fs::path& assets : assetFolders()) {
        std::error_code error;
        for (fs::directory_iterator entry(assets / folder, error), end; !error && entry != end; entry.increment(error))
            if (entry->path().extension() == ".png") files.try_emplace(entry->path().stem().string(), entry->path());
    }
    return files;
}

} // namespace

Thumbnails::Thumbnails(GraphicsDevice& device, VkRenderPass renderPass, const std::string& folder, std::uint32_t side)
    : device_(device),
      pass_(device, renderPass),
      side_(side),
      loading_(std::async(std::launch::async, load, folder, side)) {}

Thumbnails::~Thumbnails() {
    vkDeviceWaitIdle(device_.device());
}

Thumbnails::Sheet Thumbnails::load(const std::string& folder, std::uint32_t side) {
    Sheet sheet;
    std::vector<float> pixels;
    for (const auto& [name, file] : picturesOf(folder)) {
        try {
            const image::Image image = image::readImage(file);
            if (image.width != side || image.height != side || image.channels != 3) continue;
            sheet.places[name] = static_cast<std::uint32_t>(sheet.places.size());
            pixels.insert(pixels.end(), image.data.begin(), image.data.end());
        } catch (const Error& error) {
            logWarning(error.what()); // what it is of can be shown without
        }
    }
    if (sheet.places.empty()) return sheet;
    sheet.image = image::Image(side, side * static_cast<std::uint32_t>(sheet.places.size()));
    sheet.image.data = std::move(pixels);
    return sheet;
}

void Thumbnails::beginFrame() {
    tiles_.clear();
    if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Sheet sheet = loading_.get();
    newSheet_ = std::move(sheet.image);
    places_ = std::move(sheet.places);
}

void Thumbnails::upload(VkCommandBuffer commands) {
    if (newSheet_.width == 0) return;
    pass_.upload(commands, 0, FilmPass::Slot::Picture, newSheet_);
    newSheet_ = {};
}

bool Thumbnails::draw(const std::string& name, ImVec2 corner, float side) {
    const auto place = places_.find(name);
    if (place == places_.end()) return false;
    tiles_.push_back({this, place->second, corner, side});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCallback(
        [](const ImDrawList*, const ImDrawCmd* command) {
            const Tile& tile = *static_cast<const Tile*>(command->UserCallbackData);
            tile.owner->record(tile, command->ClipRect);
        },
        &tiles_.back());
    list.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
    return true;
}

void Thumbnails::record(const Tile& tile, const ImVec4& clip) const {
    const ImDrawData* data = ImGui::GetDrawData();
    const ImVec2 origin = data->DisplayPos, pixels = data->FramebufferScale;
    const float width = data->DisplaySize.x * pixels.x, height = data->DisplaySize.y * pixels.y;
    const float x = std::round((tile.corner.x - origin.x) * pixels.x);
    const float y = std::round((tile.corner.y - origin.y) * pixels.y);
    const float side = std::round(tile.side * pixels.x);
    const float left = std::max({x, (clip.x - origin.x) * pixels.x, 0.0f});
    const float top = std::max({y, (clip.y - origin.y) * pixels.y, 0.0f});
    const float right = std::min({x + side, (clip.z - origin.x) * pixels.x, width});
    const float bottom = std::min({y + side, (clip.w - origin.y) * pixels.y, height});
    if (!(right - left >= 1 && bottom - top >= 1)) return;
    PresentConstants constants;
    constants.scale = side / static_cast<float>(side_);
    constants.originX = x;
    constants.flags = kSmooth;
    constants.originY = y - static_cast<float>(tile.place) * side;
    const VkRect2D scissor{{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)},
                           {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}};
    pass_.draw(commands_, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}, constants, scissor);
}

} // namespace rt::gui
