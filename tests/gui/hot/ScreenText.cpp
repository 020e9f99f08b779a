#include "tests/gui/ScreenText.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <imgui.h>

#include "Common/Gui/Fonts.h"

namespace rt::test {
namespace {

constexpr double kLikeness = 0.93; // correlation of what is on the screen with the text
constexpr int kContrast = 120;     // of letters with their ground, of ten times 255

// Coverage of pixels by letters, row after row.
struct Letters {
    int width = 0, height = 0;
    std::vector<float> coverage;

    float at(int x, int y) const {
        return coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

// The letters that the interface draws with, for as long as a text is made of them.
class Atlas {
  public:
    Atlas() : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(own_);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {4096, 64};
        gui::addFont(*io.Fonts, gui::availableFonts().front(), 1);
#if IMGUI_VERSION_NUM >= 19200
        io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
#else
        io.Fonts->GetTexDataAsAlpha8(&pixels_, &width_, &height_);
#endif
    }
    ~Atlas() {
        ImGui::DestroyContext(own_);
        ImGui::SetCurrentContext(before_);
    }
    Atlas(const Atlas&) = delete;
    Atlas& operator=(const Atlas&) = delete;

    Letters draw(const std::string& text);

  private:
    float texel(int x, int y) const;
    float sample(float u, float v) const;
    void cover(const ImDrawVert& low, const ImDrawVert& high, Letters& letters) const;

    ImGuiContext *before_, *own_;
    unsigned char* pixels_ = nullptr;
    int width_ = 0, height_ = 0, bytes_ = 1; // of the atlas; of a pixel
};

float Atlas::texel(int x, int y) const {
    const int column = std::clamp(x, 0, width_ - 1), row = std::clamp(y, 0, height_ - 1);
    return static_cast<float>(pixels_[(row * width_ + column + 1) * bytes_ - 1]) / 255; // opacity is the last byte
}

// As a device filters.
float Atlas::sample(float u, float v) const {
    const float x = u * static_cast<float>(width_) - 0.5f, y = v * static_cast<float>(height_) - 0.5f;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const float right = x - std::floor(x), below = y - std::floor(y);
    return (1 - below) * ((1 - right) * texel(left, top) + right * texel(left + 1, top)) +
           below * ((1 - right) * texel(left, top + 1) + right * texel(left + 1, top + 1));
}

void Atlas::cover(const ImDrawVert& low, const ImDrawVert& high, Letters& letters) const {
    for (int y = 0; y < letters.height; ++y)
        for (int x = 0; x < letters.width; ++x) {
            const float s = (static_cast<float>(x) + 0.5f - low.pos.x) / (high.pos.x - low.pos.x);
            const float t = (static_cast<float>(y) + 0.5f - low.pos.y) / (high.pos.y - low.pos.y);
            if (!(s >= 0 && s < 1 && t >= 0 && t < 1)) continue;
            letters.coverage[static_cast<std::size_t>(y * letters.width + x)] +=
                sample(low.uv.x + s * (high.uv.x - low.uv.x), low.uv.y + t * (high.uv.y - low.uv.y));
        }
}

Letters Atlas::draw(const std::string& text) {
    ImGui::NewFrame();
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddText({0, 0}, IM_COL32_WHITE, text.c_str());
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
#if IMGUI_VERSION_NUM >= 19200
    const ImTextureData& texture = *ImGui::GetIO().Fonts->TexData;
    pixels_ = texture.Pixels;
    width_ = texture.Width;
    height_ = texture.Height;
    bytes_ = texture.BytesPerPixel;
#endif
    Letters letters;
    letters.width = static_cast<int>(std::ceil(size.x));
    letters.height = static_cast<int>(std::ceil(size.y));
    letters.coverage.resize(static_cast<std::size_t>(letters.width) * static_cast<std::size_t>(letters.height));
    for (int i = 0; i + 3 < list.VtxBuffer.Size; i += 4) cover(list.VtxBuffer[i], list.VtxBuffer[i + 2], letters);
    ImGui::EndFrame();
    return letters;
}

const Letters& lettersOf(const std::string& text) {
    static std::map<std::string, Letters> made;
    auto found = made.find(text);
    if (found == made.end()) found = made.emplace(text, Atlas().draw(text)).first;
    return found->second;
}

// Of every pixel, up to ten times 255; those of the last screenshot are kept, of which other texts are asked.
const std::vector<int>& brightnessOf(const Screenshot& shot) {
    static std::shared_ptr<const Screenshot::Pixels> pixels;
    static std::vector<int> values;
    if (pixels == shot.pixels) return values;
    pixels = shot.pixels;
    values.resize(pixels->size());
    std::transform(pixels->begin(), pixels->end(), values.begin(), [](std::uint32_t color) {
        return static_cast<int>(3 * (color >> 16 & 0xff) + 6 * (color >> 8 & 0xff) + (color & 0xff));
    });
    return values;
}

class Search {
  public:
    Search(const Screenshot& shot, const Letters& letters)
        : letters_(letters), width_(shot.width), values_(brightnessOf(shot)) {
        const float most = *std::max_element(letters.coverage.begin(), letters.coverage.end());
        for (int y = 0; y < letters.height; ++y)
            for (int x = 0; x < letters.width; ++x) {
                if (letters.at(x, y) > 0.85f * most) ink_.push_back(y * width_ + x);
                if (letters.at(x, y) < 0.02f) paper_.push_back(y * width_ + x);
            }
        thinOut(ink_);
        thinOut(paper_);
    }

    bool isAt(int x, int y) const {
        const int* const corner = &values_[static_cast<std::size_t>(y * width_ + x)];
        return hasContrast(corner) && std::abs(correlation(corner)) > kLikeness;
    }

  private:
    // To a few of them, from all over the text.
    static void thinOut(std::vector<int>& pixels) {
        constexpr std::size_t kFew = 12;
        if (pixels.size() <= kFew) return;
        for (std::size_t i = 0; i < kFew; ++i) pixels[i] = pixels[i * pixels.size() / kFew];
        pixels.resize(kFew);
    }
    // Whether some of the letters' pixels are all brighter than some of their ground, or all darker: quickly told.
    bool hasContrast(const int* corner) const {
        if (ink_.empty() || paper_.empty() || std::abs(corner[ink_[0]] - corner[paper_[0]]) <= kContrast) return false;
        int brightest = 0, darkest = 2550; // of the ground
        for (const int pixel : paper_) {
            brightest = std::max(brightest, corner[pixel]);
            darkest = std::min(darkest, corner[pixel]);
        }
        const auto isBrighter = [&](int pixel) { return corner[pixel] > brightest + kContrast; };
        const auto isDarker = [&](int pixel) { return corner[pixel] < darkest - kContrast; };
        return std::all_of(ink_.begin(), ink_.end(), isBrighter) || std::all_of(ink_.begin(), ink_.end(), isDarker);
    }
    double correlation(const int* corner) const {
        const int count = letters_.width * letters_.height;
        double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
        for (int y = 0; y < letters_.height; ++y)
            for (int x = 0; x < letters_.width; ++x) {
                const double seen = corner[y * width_ + x], wanted = letters_.at(x, y);
                a += seen, b += wanted, aa += seen * seen, bb += wanted * wanted, ab += seen * wanted;
            }
        const double spread = (aa - a * a / count) * (bb - b * b / count);
        return spread > 0 ? (ab - a * b / count) / std::sqrt(spread) : 0;
    }

    const Letters& letters_;
    int width_;
    const std::vector<int>& values_;
    std::vector<int> ink_, paper_; // some pixels of the letters and of their ground, counted from the corner
};

std::vector<Place> searchFor(const std::string& text, const Screenshot& shot, const Place& within) {
    const Letters& letters = lettersOf(text);
    std::vector<Place> places;
    if (letters.coverage.empty() || shot.pixels->empty()) return places;
    const Search search(shot, letters);
    const int right = std::min(within.right, shot.width), bottom = std::min(within.bottom, shot.height);
    const auto isKnown = [&places](int x, int y) { // one text is alike itself a pixel further
        return std::any_of(places.begin(), places.end(), [x, y](const Place& place) {
            return std::abs(place.left - x) < 4 && std::abs(place.top - y) < 4;
        });
    };
    for (int y = std::max(within.top, 0); y + letters.height <= bottom; ++y)
        for (int x = std::max(within.left, 0); x + letters.width <= right; ++x)
            if (search.isAt(x, y) && !isKnown(x, y)) places.push_back({x, y, x + letters.width, y + letters.height});
    return places;
}

} // namespace

std::vector<Place> findText(const Screenshot& shot, const std::string& text, const Place& within) {
    using Question = std::tuple<std::string, int, int, int, int>;
    static std::shared_ptr<const Screenshot::Pixels> pixels;
    static std::map<Question, std::vector<Place>> answers; // about these pixels: windows mostly stay as they are
    if (pixels != shot.pixels) answers.clear();
    pixels = shot.pixels;
    const Question question{text, within.left, within.top, within.right, within.bottom};
    auto found = answers.find(question);
    if (found == answers.end()) found = answers.emplace(question, searchFor(text, shot, within)).first;
    return found->second;
}

} // namespace rt::test
