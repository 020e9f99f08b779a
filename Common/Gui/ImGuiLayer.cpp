#include "Common/Gui/ImGuiLayer.h"

#include <algorithm>
#include <cmath>

#include "Common/Core/Paths.h"
#include "Common/Gui/Theme.h"
#include "Common/Vulkan/Check.h"

#if __has_include(<backends/imgui_impl_glfw.h>)
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#else
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>
#endif
#ifdef IMGUI_HAS_DOCK
#include <imgui_internal.h>
#endif

namespace rt::gui {
namespace {

constexpr float kFontSize = 15;      // at scale 1
constexpr float kSideWidth = 372;    // of the fixed layout, at scale 1
constexpr float kBottomShare = 0.4f; // of the height
// Latin, dashes, arrows, mathematical signs.
constexpr ImWchar kGlyphs[] = {0x20, 0xff, 0x2010, 0x2027, 0x2190, 0x2193, 0x2212, 0x2212, 0x2248, 0x2248, 0};

void checkImGui(VkResult result) {
    vulkan::check(result, "Drawing the interface");
}

std::vector<FontFile> findFonts() {
    namespace fs = std::filesystem;
    const FontFile candidates[] = {
        {"Inter", "/usr/share/fonts/opentype/inter/Inter-Regular.otf"},
        {"DejaVu Sans", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"},
        {"DejaVu Sans", "/usr/share/fonts/TTF/DejaVuSans.ttf"},
        {"Noto Sans", "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"},
        {"Roboto", "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf"},
        {"Liberation Sans", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"},
        {"DejaVu Sans Condensed", "/usr/share/fonts/truetype/dejavu/DejaVuSansCondensed.ttf"},
        {"DejaVu Serif", "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf"},
        {"DejaVu Sans Mono", "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"},
        {"Segoe UI", "C:/Windows/Fonts/segoeui.ttf"},
        {"Arial", "C:/Windows/Fonts/arial.ttf"},
        {"Arial", "/System/Library/Fonts/Supplemental/Arial.ttf"},
    };
    std::vector<FontFile> fonts;
    for (const FontFile& font : candidates) {
        std::error_code none;
        const bool known =
            std::any_of(fonts.begin(), fonts.end(), [&](const FontFile& f) { return f.name == font.name; });
        if (!known && fs::is_regular_file(font.file, none)) fonts.push_back(font);
    }
    fonts.push_back({"ImGui", {}});
    return fonts;
}

} // namespace

const std::vector<FontFile>& availableFonts() {
    static const std::vector<FontFile> fonts = findFonts();
    return fonts;
}

ImGuiLayer::ImGuiLayer(const Window& window, GraphicsDevice& device, VkRenderPass renderPass, std::uint32_t imageCount,
                       const std::filesystem::path& layoutFile)
    : device_(device),
      renderPass_(renderPass),
      imageCount_(std::max(imageCount, 2u)),
      layoutFile_(layoutFile.string()) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.IniFilename = layoutFile_.empty() ? nullptr : layoutFile_.c_str();
#ifdef IMGUI_HAS_DOCK
    io.ConfigFlags |= ImGuiConfigFlags_DockingEnable;
#endif
    ImGui_ImplGlfw_InitForVulkan(window.get(), true);

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 64};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 64;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    vulkan::check(vkCreateDescriptorPool(device.device(), &info, nullptr, &pool), "Creating a descriptor pool");
    descriptorPool_ = {device.device(), pool, vkDestroyDescriptorPool};
}

ImGuiLayer::~ImGuiLayer() {
    vkDeviceWaitIdle(device_.device());
    if (started_) ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

// ---- style -----------------------------------------------------------------------------------------------------------

void ImGuiLayer::setStyle(const Style& style) {
    wanted_ = style;
}

void ImGuiLayer::startRenderer() {
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device_.instance();
    info.PhysicalDevice = device_.physicalDevice();
    info.Device = device_.device();
    info.QueueFamily = device_.queueFamily();
    info.Queue = device_.queue();
    info.DescriptorPool = descriptorPool_.get();
    info.MinImageCount = 2;
    info.ImageCount = imageCount_;
    info.CheckVkResultFn = checkImGui;
#if IMGUI_VERSION_NUM >= 19250
    info.ApiVersion = vulkan::kApiVersion;
    info.PipelineInfoMain.RenderPass = renderPass_;
    info.PipelineInfoMain.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
#else
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
#if IMGUI_VERSION_NUM >= 19012
    info.RenderPass = renderPass_;
#endif
#endif
#if IMGUI_VERSION_NUM >= 19012
    ImGui_ImplVulkan_Init(&info);
#else
    ImGui_ImplVulkan_Init(&info, renderPass_);
#endif
#if IMGUI_VERSION_NUM < 18984
    device_.run([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
    started_ = true;
}

// Fonts are drawn anew for each size, so that nothing is blurred; what the renderer holds of the old ones goes with it.
void ImGuiLayer::applyStyle() {
    if (started_) {
        vulkan::check(vkDeviceWaitIdle(device_.device()), "Drawing the interface");
        ImGui_ImplVulkan_Shutdown();
        started_ = false;
    }
    style_ = wanted_;
    ImGuiStyle style;
    applyTheme(style, style_.colorMode);
    style.ScaleAllSizes(style_.scale);
    ImGui::GetStyle() = style;

    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    const std::vector<FontFile>& fonts = availableFonts();
    const auto chosen =
        std::find_if(fonts.begin(), fonts.end(), [this](const FontFile& f) { return f.name == style_.font; });
    const FontFile& font = chosen != fonts.end() ? *chosen : fonts.front();
    const float size = std::round(kFontSize * style_.scale);
    if (font.file.empty() ||
        io.Fonts->AddFontFromFileTTF(font.file.string().c_str(), size, nullptr, kGlyphs) == nullptr) {
        ImFontConfig config;
        config.SizePixels = 13 * std::max(1.0f, std::round(style_.scale));
        io.Fonts->AddFontDefault(&config);
    }
    startRenderer();
}

// ---- frames ----------------------------------------------------------------------------------------------------------

void ImGuiLayer::beginFrame(std::span<const int> pressed) {
    if (!started_ || wanted_ != style_) applyStyle();
#if IMGUI_VERSION_NUM < 18700
    // A key that went down and up between two frames would not be seen; later versions queue events.
    ImGuiIO& io = ImGui::GetIO();
    for (const int key : briefKeys_) io.KeysDown[key] = false;
    briefKeys_.clear();
    for (const int key : pressed) {
        if (key < 0 || key >= IM_ARRAYSIZE(io.KeysDown) || io.KeysDown[key]) continue;
        io.KeysDown[key] = true;
        briefKeys_.push_back(key);
    }
#else
    (void)pressed;
#endif
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

#ifdef IMGUI_HAS_DOCK

Rect ImGuiLayer::layOut(std::span<const Panel> panels, const std::function<void()>& header,
                        const std::function<void()>& status) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    const ImGuiID space = ImGui::GetID("space");
    const float statusHeight = ImGui::GetFrameHeight() + 4;
    if (ImGui::DockBuilderGetNode(space) == nullptr) {
        ImGui::DockBuilderAddNode(space, ImGuiDockNodeFlags_DockSpace | ImGuiDockNodeFlags_PassthruCentralNode);
        ImGui::DockBuilderSetNodeSize(space, viewport->Size);
        ImGuiID center = space;
        const float share = std::min(0.45f, kSideWidth * style_.scale / std::max(1.0f, viewport->Size.x));
        ImGuiID side = ImGui::DockBuilderSplitNode(center, ImGuiDir_Left, share, nullptr, &center);
        const ImGuiID bottom = ImGui::DockBuilderSplitNode(center, ImGuiDir_Down, kBottomShare, nullptr, &center);
        const ImGuiID top = ImGui::DockBuilderSplitNode(side, ImGuiDir_Up, 0.16f, nullptr, &side);
        ImGui::DockBuilderDockWindow("Render control", top);
        for (const Panel& panel : panels) {
            ImGui::DockBuilderDockWindow(panel.title, panel.place == Panel::Place::Side ? side : bottom);
        }
        ImGui::DockBuilderFinish(space);
    }
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize({viewport->Size.x, std::max(1.0f, viewport->Size.y - statusHeight)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("##space", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoDocking |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoMove);
    ImGui::PopStyleVar();
    ImGui::DockSpace(space, {0, 0}, ImGuiDockNodeFlags_PassthruCentralNode);
    ImGui::End();
    if (!panels.empty()) {
        if (ImGui::Begin("Render control")) header();
        ImGui::End();
    }
    for (const Panel& panel : panels) {
        if (ImGui::Begin(panel.title)) panel.draw();
        ImGui::End();
    }
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + viewport->Size.y - statusHeight});
    ImGui::SetNextWindowSize({viewport->Size.x, statusHeight});
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoDocking | ImGuiWindowFlags_NoSavedSettings);
    status();
    ImGui::End();
    const ImGuiDockNode* center = ImGui::DockBuilderGetCentralNode(space);
    if (center == nullptr) return {0, 0, viewport->Size.x, viewport->Size.y - statusHeight};
    return {center->Pos.x - viewport->Pos.x, center->Pos.y - viewport->Pos.y, center->Size.x, center->Size.y};
}

#else

Rect ImGuiLayer::layOut(std::span<const Panel> panels, const std::function<void()>& header,
                        const std::function<void()>& status) {
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const float statusHeight = std::min(ImGui::GetTextLineHeight() + padding.y, viewport->Size.y);
    const float height = std::max(1.0f, viewport->Size.y - statusHeight);
    const bool hasSide =
        std::any_of(panels.begin(), panels.end(), [](const Panel& p) { return p.place == Panel::Place::Side; });
    const float side = hasSide ? std::min(kSideWidth * style_.scale, 0.6f * viewport->Size.x) : 0.0f;
    Rect rest{side, 0, std::max(1.0f, viewport->Size.x - side), height};

    if (hasSide) {
        ImGui::SetNextWindowPos(viewport->Pos);
        ImGui::SetNextWindowSize({side, height});
        ImGui::Begin("##side", nullptr, kFixed);
        header();
        // The panels scroll below a header that stays.
        ImGui::BeginChild("##panels", {0, 0}, false);
        for (const Panel& panel : panels) {
            if (panel.place != Panel::Place::Side) continue;
            if (ImGui::CollapsingHeader(panel.title, panel.initiallyOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0)) {
                ImGui::PushID(panel.title);
                ImGui::Indent(4 * style_.scale);
                panel.draw();
                ImGui::Unindent(4 * style_.scale);
                ImGui::PopID();
                ImGui::Spacing();
            }
        }
        ImGui::EndChild();
        ImGui::End();
    }
    for (const Panel& panel : panels) {
        if (panel.place != Panel::Place::Bottom) continue;
        const float share = std::floor(kBottomShare * height);
        rest.height -= share;
        ImGui::SetNextWindowPos({viewport->Pos.x + side, viewport->Pos.y + rest.height});
        ImGui::SetNextWindowSize({rest.width, share});
        ImGui::Begin(panel.title, nullptr, kFixed);
        panel.draw();
        ImGui::End();
    }
    ImGui::SetNextWindowPos({viewport->Pos.x, viewport->Pos.y + height});
    ImGui::SetNextWindowSize({viewport->Size.x, statusHeight});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding.x, 0.5f * padding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    status();
    ImGui::End();
    return rest;
}

#endif

void ImGuiLayer::endFrame() {
    ImGui::Render();
}

void ImGuiLayer::draw(VkCommandBuffer commands) {
    if (ImDrawData* data = ImGui::GetDrawData()) ImGui_ImplVulkan_RenderDrawData(data, commands);
}

} // namespace rt::gui
