#include "Common/Gui/ImGuiLayer.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include "Common/Gui/Fonts.h"
#include "Common/Gui/Theme.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"

#if __has_include(<backends/imgui_impl_glfw.h>)
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#else
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>
#endif

namespace rt::gui {
namespace {

void checkImGui(VkResult result) {
    vulkan::check(result, "Drawing the interface");
}

} // namespace

ImGuiLayer::ImGuiLayer(const Window& window, GraphicsDevice& device, VkRenderPass renderPass, std::uint32_t imageCount,
                       const std::filesystem::path& layoutFile)
    : window_(window.get()),
      device_(device),
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
#if IMGUI_VERSION_NUM >= 18700
    io.ConfigInputTrickleEventQueue = false; // InputQueue has seen to it, and knows what a frame has taken
#endif
    ImGui_ImplGlfw_InitForVulkan(window_, false);
    glfwSetMonitorCallback(ImGui_ImplGlfw_MonitorCallback);

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 64};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 64;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    descriptorPool_ = vulkan::create(device.device(), vkCreateDescriptorPool, info, vkDestroyDescriptorPool,
                                     "Creating a descriptor pool");
}

ImGuiLayer::~ImGuiLayer() {
    vkDeviceWaitIdle(device_.device());
    if (started_) ImGui_ImplVulkan_Shutdown();
    glfwSetMonitorCallback(nullptr);
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

// ---- style ---------------------------------------------------------------------------------------------------------

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
    drawn_.clear(); // the same places of another texture
    ImGuiStyle style;
    applyTheme(style, style_.colorMode);
#if IMGUI_VERSION_NUM >= 19280
    style.Colors[ImGuiCol_CheckboxSelectedBg] = style.Colors[ImGuiCol_FrameBg];
#endif
    style.ScaleAllSizes(style_.scale);
    ImGui::GetStyle() = style;

    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    const std::vector<FontFile>& fonts = availableFonts();
    const auto chosen =
        std::find_if(fonts.begin(), fonts.end(), [this](const FontFile& f) { return f.name == style_.font; });
    const FontFile& font = chosen != fonts.end() ? *chosen : fonts.front();
#if IMGUI_VERSION_NUM >= 19200
    const float pixels = style_.scale; // these versions see to the window's density themselves
#else
    const float pixels = style_.scale * style_.density;
    io.FontGlobalScale = 1 / style_.density;
#endif
    addFont(*io.Fonts, font, pixels);
    startRenderer();
}

// ---- docking -------------------------------------------------------------------------------------------------------

#ifdef IMGUI_HAS_DOCK

namespace {

void divide(ImGuiID space, const Rect& area, const DockShares& shares, std::span<const DockedWindow> windows) {
    constexpr int kFlags = static_cast<int>(ImGuiDockNodeFlags_DockSpace) | ImGuiDockNodeFlags_PassthruCentralNode;
    ImGui::DockBuilderAddNode(space, kFlags);
    ImGui::DockBuilderSetNodeSize(space, {area.width, area.height});
    ImGuiID center = space;
    ImGuiID side = ImGui::DockBuilderSplitNode(center, ImGuiDir_Left, shares.side, nullptr, &center);
    const ImGuiID header = ImGui::DockBuilderSplitNode(side, ImGuiDir_Up, shares.header, nullptr, &side);
    const ImGuiID first = ImGui::DockBuilderSplitNode(side, ImGuiDir_Up, shares.first, nullptr, &side);
    const ImGuiID bottom = ImGui::DockBuilderSplitNode(center, ImGuiDir_Down, shares.bottom, nullptr, &center);
    for (const DockedWindow& window : windows) {
        const ImGuiID node = window.place == DockedWindow::Place::Header  ? header
                             : window.place == DockedWindow::Place::First ? first
                             : window.place == DockedWindow::Place::Side  ? side
                                                                          : bottom;
        ImGui::DockBuilderDockWindow(window.title, node);
    }
    ImGui::DockBuilderFinish(space);
}

} // namespace

const ImGuiWindowFlags kNeverDocks = ImGuiWindowFlags_NoDocking;

std::optional<Rect> showDockSpace(const Rect& area, const DockShares& shares, std::span<const DockedWindow> windows) {
    const ImVec2 origin = ImGui::GetMainViewport()->Pos;
    const ImGuiID space = ImGui::GetID("space");
    if (ImGui::DockBuilderGetNode(space) == nullptr) divide(space, area, shares, windows);
    ImGui::SetNextWindowPos({origin.x + area.x, origin.y + area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##space", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoDocking |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoMove);
    ImGui::PopStyleVar(2);
    ImGui::DockSpace(space, {0, 0}, ImGuiDockNodeFlags_PassthruCentralNode);
    ImGui::End();
    const ImGuiDockNode* center = ImGui::DockBuilderGetCentralNode(space);
    if (center == nullptr) return area;
    return Rect{center->Pos.x - origin.x, center->Pos.y - origin.y, center->Size.x, center->Size.y};
}

#else

const ImGuiWindowFlags kNeverDocks = ImGuiWindowFlags_None;

std::optional<Rect> showDockSpace(const Rect&, const DockShares&, std::span<const DockedWindow>) {
    return std::nullopt;
}

#endif

// ---- frames --------------------------------------------------------------------------------------------------------

void closeUndrawnPopups(std::span<const InputEvent> input) {
    const bool isEscape = std::any_of(input.begin(), input.end(), [](const InputEvent& event) {
        return event.kind == InputEvent::Kind::Key && event.isDown && event.code == GLFW_KEY_ESCAPE;
    });
    if (!isEscape) return;
    auto& popups = ImGui::GetCurrentContext()->OpenPopupStack;
    while (!popups.empty() && popups.back().Window == nullptr) popups.pop_back();
}

void ImGuiLayer::beginFrame(std::span<const InputEvent> input) {
    if (!started_ || wanted_ != style_) applyStyle();
    closeUndrawnPopups(input);
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    feed_.feed(window_, input);
    ImGui::NewFrame();
}

void ImGuiLayer::dropFrame() {
    ImGui::EndFrame();
}

void ImGuiLayer::endFrame() {
    ImGui::Render();
}

namespace {

template <typename T>
void appendBytes(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void appendBytes(std::string& bytes, const ImVector<T>& values) {
    bytes.append(reinterpret_cast<const char*>(values.Data), static_cast<std::size_t>(values.size_in_bytes()));
}

// Empty where that is not all: a texture becomes another.
std::string bytesOfDrawing(const ImDrawData& data) {
    std::string bytes;
    appendBytes(bytes, data.DisplayPos);
    appendBytes(bytes, data.DisplaySize);
    appendBytes(bytes, data.FramebufferScale);
#if IMGUI_VERSION_NUM >= 19200
    if (data.Textures != nullptr)
        for (const ImTextureData* texture : *data.Textures)
            if (texture->Status != ImTextureStatus_OK) return {};
#endif
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        appendBytes(bytes, list.VtxBuffer);
        appendBytes(bytes, list.IdxBuffer);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            appendBytes(bytes, command.UserCallback);
            appendBytes(bytes, command.ClipRect);
            appendBytes(bytes, command.GetTexID());
            appendBytes(bytes, command.VtxOffset);
            appendBytes(bytes, command.IdxOffset);
            appendBytes(bytes, command.ElemCount);
        }
    }
    return bytes;
}

} // namespace

bool ImGuiLayer::takeChange() {
    const ImDrawData* const data = ImGui::GetDrawData();
    std::string now = data != nullptr ? bytesOfDrawing(*data) : std::string();
    const bool isSame = !now.empty() && now == drawn_;
    drawn_ = std::move(now);
    return !isSame;
}

void ImGuiLayer::draw(VkCommandBuffer commands) {
    if (ImDrawData* data = ImGui::GetDrawData()) ImGui_ImplVulkan_RenderDrawData(data, commands);
}

} // namespace rt::gui
